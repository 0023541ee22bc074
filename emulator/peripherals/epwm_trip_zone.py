"""The trip zone of an ePWM module: one-shot trips forced by software.

Modelled: TZFRC.OST, TZFLG.OST and INT, TZCLR, TZCTL.TZA and TZB, TZEINT.OST.
Not modelled: trip inputs and digital compare events as sources, cycle-by-cycle trips.  A tripped output in high
    impedance is shown as low and reported (CHOICE: what the pin sees then hangs on the board).
Sources: TRM ePWM, trip-zone submodule.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.cpu import Cpu
from emulator.registers.core import F
from emulator.registers.epwm import EPwmRegs
from emulator.registers.epwm_trip import TZCLR, TZCTL, TZFLG, TZFRC

_OUTPUTS: Final[tuple[F, F]] = (TZCTL.TZA, TZCTL.TZB)
_HIGH_IMPEDANCE: Final = 0
_HIGH: Final = 1
_UNTOUCHED: Final = 3


class TripZone:
    """The TZ registers.  `changed()` is called when an output may have been tripped or released."""

    __slots__ = ("_changed", "_control", "_cpu", "_flags", "_interrupt", "_names", "_regs")

    def __init__(self, cpu: Cpu, regs: EPwmRegs, names: tuple[str, str], changed: Callable[[], None],
                 interrupt: Callable[[], None]) -> None:  # fmt: skip
        self._cpu = cpu
        self._regs = regs
        self._names = names
        self._changed = changed
        self._interrupt = interrupt
        self._flags = regs.registers["TZFLG"]
        self._control = regs.registers["TZCTL"]
        regs.bind("TZCTL", write=self._write_TZCTL)
        regs.bind("TZEINT", write=self._write_TZEINT)
        regs.bind("TZFRC", write=self._write_TZFRC)
        regs.bind("TZCLR", write=self._write_TZCLR)

    def level(self, output: int) -> int | None:
        """The level forced on output 0 (A) or 1 (B); None if the trip zone leaves it alone."""
        if not self._flags.value & TZFLG.OST.mask:
            return None
        action = self._action(output)
        return None if action == _UNTOUCHED else int(action == _HIGH)

    def _action(self, output: int) -> int:
        field = _OUTPUTS[output]
        return (self._control.value & field.mask) >> field.lo

    def _update(self) -> None:
        self._changed()
        if not self._flags.value & TZFLG.OST.mask:
            return
        for output, name in enumerate(self._names):
            if self._action(output) == _HIGH_IMPEDANCE:
                self._cpu.findings.report(
                    "unmodelled", f"{name} is tripped to high impedance: it is shown as low", object=name
                )

    def _gate_interrupt(self) -> None:
        flags = self._flags
        if not flags.value & TZFLG.INT.mask and flags.value & self._regs.TZEINT.value & TZFLG.OST.mask:
            flags.value |= TZFLG.INT.mask
            self._interrupt()

    def _write_TZCTL(self, word: int, lanes: int) -> None:
        self._control.store(word)
        self._update()

    def _write_TZEINT(self, word: int, lanes: int) -> None:
        self._regs.TZEINT.store(word)
        self._gate_interrupt()

    def _write_TZFRC(self, word: int, lanes: int) -> None:
        if word & TZFRC.OST.mask:
            self._flags.value |= TZFLG.OST.mask
            self._update()
            self._gate_interrupt()

    def _write_TZCLR(self, word: int, lanes: int) -> None:
        self._regs.TZCLR.store(word)
        self._flags.value &= ~(word & (TZFLG.INT.mask | TZFLG.OST.mask))
        if word & TZCLR.OST.mask:
            self._update()
        self._gate_interrupt()
