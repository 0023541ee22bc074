"""The ePWM X-BAR: TRIP4, 5 and 7 to 12, which every ePWM module has.

Modelled: the muxes of each output (`xbar_mux.py`, with the signals that are not modelled), TRIPOUTINV, TRIPLOCK with
    its key.
Time: none; a trip changes in the cycle of its signal.
Sources: TRM X-BAR; HDR F2837xS_epwm_xbar.h.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

from emulator.cpu import Cpu
from emulator.peripherals.xbar_mux import KEY, XbarOutput, report_locked
from emulator.registers.core import ALL
from emulator.registers.epwm_xbar import EPwmXbarRegs
from emulator.signals import Level, Wire

#: The trips, in the order of their bits in TRIPOUTINV.
TRIPS: Final = (4, 5, 7, 8, 9, 10, 11, 12)


class EPwmXbar:
    """The X-BAR over its registers; `trips[n]` has the level of TRIPn."""

    __slots__ = ("_cpu", "_outputs", "_regs", "trips")

    def __init__(
        self, cpu: Cpu, regs: EPwmXbarRegs, signals: Mapping[str, Level], *, used: Callable[[str], None]
    ) -> None:
        self._cpu, self._regs = cpu, regs
        self.trips = {n: Wire(f"TRIP{n}") for n in TRIPS}
        self._outputs = {
            n: XbarOutput(
                cpu, regs, f"TRIP{n}", "CTRIP", signals, changed=partial(self._follow, n), locked=self._locked,
                used=used,
            )
            for n in TRIPS
        }  # fmt: skip
        regs.bind("TRIPOUTINV", write=self._write_TRIPOUTINV)
        regs.bind("TRIPLOCK", write=self._write_TRIPLOCK)

    def _follow(self, n: int) -> None:
        inverted = self._regs.registers["TRIPOUTINV"].value >> TRIPS.index(n) & 1
        self.trips[n].drive("X-BAR", self._outputs[n].level ^ inverted)

    def _locked(self, name: str, word: int) -> bool:
        registers = self._regs.registers
        locked = bool(registers["TRIPLOCK"].value & 1)
        if locked:
            report_locked(self._cpu, registers[name].path, "TRIPLOCK", word)
        return locked

    def _write_TRIPOUTINV(self, word: int, lanes: int = ALL) -> None:
        if not self._locked("TRIPOUTINV", word):
            self._regs.registers["TRIPOUTINV"].store(word, lanes)
            for n in TRIPS:
                self._follow(n)

    def _write_TRIPLOCK(self, word: int, lanes: int = ALL) -> None:
        if word >> 16 == KEY:
            self._regs.registers["TRIPLOCK"].store(word, lanes)
