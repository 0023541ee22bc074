"""The bench of tacho.c: a fan at ePWM1, with a tachometer of four pulses a turn at GPIO24."""

from __future__ import annotations

from math import exp
from typing import Final

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US
from hil.board import Board

#: The fan moves each 0.1 ms.
STEP: Final = 100 * CYCLES_PER_US
RPM_AT_FULL_DUTY: Final = 6000.0
TIME_CONSTANT_S: Final = 0.02
PULSES_PER_TURN: Final = 4


class Fan:
    """A fan of the first order."""

    def __init__(self, board: Board) -> None:
        self._board = board
        self.rpm = self._phase = 0.0
        self._power = board.pwm_outputs["GPIO0"]
        self._pin = board.pins[24]
        self._pin.drive("tacho", 0)
        self.stuck = False
        board.clock.after(STEP, self._step)

    def block(self) -> None:
        """Something holds the fan."""
        self.stuck = True

    def _step(self) -> None:
        share = 1.0 - exp(-1e-4 / TIME_CONSTANT_S)
        self.rpm = 0.0 if self.stuck else self.rpm + (RPM_AT_FULL_DUTY * self._power.duty - self.rpm) * share
        halves = self.rpm / 60.0 * PULSES_PER_TURN * 2.0 * 1e-4
        before = self._phase
        self._phase += halves
        if int(self._phase) != int(before):
            part = (int(self._phase) - before) / halves
            self._board.clock.after(max(1, round(part * STEP)), self._edge)
        self._board.clock.after(STEP, self._step)

    def _edge(self) -> None:
        self._pin.drive("tacho", 1 - self._pin.level)


class Bench(Board):
    """The fan is held from 0.5 s on."""

    def solder(self) -> None:
        """Connect the fan."""
        fan = self.add("fan", Fan(self), pins={"POWER": "GPIO0", "TACHO": "GPIO24"})
        self.clock.after(500 * CYCLES_PER_MS, fan.block)
