"""The bench of speed_loop.c: a DC motor with its encoder and its current, and a PC that orders speeds."""

from __future__ import annotations

from functools import partial
from math import exp
from typing import Final

from emulator.clock import CYCLES_PER_MS
from hil.board import Board

#: Each 0.5 ms the motor moves.
STEP: Final = CYCLES_PER_MS // 2
RPM_AT_FULL_DUTY: Final = 4000.0
TIME_CONSTANT_S: Final = 0.05
COUNTS_PER_TURN: Final = 1000
#: (ms, rpm): what the PC orders from when on, each 20 ms.
ORDERS: Final = ((60, 900), (150, 2800), (250, -1200), (350, 1000), (620, 0))
RUN_MS: Final = 700
#: From when to when something blocks the motor, in ms.
BLOCKED: Final = (400, 500)


class Motor:
    """A motor of the first order on two outputs of an ePWM; its encoder has 250 lines."""

    def __init__(self, board: Board) -> None:
        self._board = board
        self._rpm = self._angle = 0.0
        self._moved_at = 0
        self._forward, self._backward = board.pwm_outputs["GPIO0"], board.pwm_outputs["GPIO1"]
        self._wire = board.encoder_pins[20, 21]
        board.clock.after(STEP, self._step)

    def _step(self) -> None:
        now = self._board.clock.now
        duty = self._forward.duty - self._backward.duty
        blocked = BLOCKED[0] <= now / CYCLES_PER_MS < BLOCKED[1]
        share = 1.0 - exp(-0.5e-3 / TIME_CONSTANT_S)
        self._rpm = 0.0 if blocked else self._rpm + (RPM_AT_FULL_DUTY * duty - self._rpm) * share
        before = int(self._angle)
        self._angle += self._rpm / 60.0 * COUNTS_PER_TURN * 0.5e-3
        self._wire.move(int(self._angle) - before, self._moved_at, now)
        self._moved_at = now
        self._board.clock.after(STEP, self._step)

    def volts(self, cycles: int) -> float:
        """The shunt amplifier: 1.5 V without current."""
        duty = self._forward.duty - self._backward.duty
        return 1.5 + 0.8 * (duty - self._rpm / RPM_AT_FULL_DUTY)


class Bench(Board):
    """The motor at ePWM1, eQEP1 and ADCINA2, and the PC at SCI-B."""

    vrefhi_v = 3.0

    def solder(self) -> None:
        """Connect all of it."""
        self.on_adc("motor", Motor(self), adc="A", channel=2)
        pc = self.to_pc(tx_gpio=18, rx_gpio=19, baud=38400)
        for ms in range(ORDERS[0][0], RUN_MS, 20):
            rpm = max(order for order in ORDERS if order[0] <= ms)[1]
            octets = bytes((rpm & 0xFF, rpm >> 8 & 0xFF))
            self.clock.after(ms * CYCLES_PER_MS, partial(pc.feed, octets))
