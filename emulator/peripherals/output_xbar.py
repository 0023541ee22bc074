"""The Output X-BAR: what the pins OUTPUTXBAR1 to OUTPUTXBAR8 show.

Modelled: the muxes of each output (`xbar_mux.py`, with the signals that are not modelled), OUTPUTLATCH with its clear
    and force, OUTPUTLATCHENABLE, OUTPUTINV, OUTPUTLOCK with its key.
Time: none; an output changes in the cycle of its signal.
CHOICE: the muxes set a latch before the inversion.  A latch that is cleared while its muxes are high is set again.
Sources: TRM X-BAR; HDR F2837xS_output_xbar.h.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

from emulator.cpu import Cpu
from emulator.peripherals.xbar_mux import KEY, XbarOutput, report_locked
from emulator.registers.core import ALL
from emulator.registers.output_xbar import OutputXbarRegs
from emulator.signals import Level

OUTPUTS: Final = 8


class OutputXbar:
    """The X-BAR over its registers; `put[n - 1](level)` is called at the changes of OUTPUTXBARn."""

    __slots__ = ("_cpu", "_levels", "_outputs", "_put", "_regs")

    def __init__(
        self, cpu: Cpu, regs: OutputXbarRegs, signals: Mapping[str, Level], *, put: list[Callable[[int], None]],
        used: Callable[[str], None],
    ) -> None:  # fmt: skip
        self._cpu, self._regs, self._put = cpu, regs, put
        #: The levels that `put` was last called with.
        self._levels = [0] * OUTPUTS
        self._outputs = [
            XbarOutput(
                cpu, regs, f"OUTPUT{n}", "CTRIPOUT", signals, changed=partial(self._follow, n - 1),
                locked=self._locked, used=used,
            )
            for n in range(1, OUTPUTS + 1)
        ]  # fmt: skip
        for name in ("OUTPUTLATCHENABLE", "OUTPUTINV"):
            regs.bind(name, write=partial(self._write, name))
        regs.bind("OUTPUTLATCHCLR", write=self._write_OUTPUTLATCHCLR)
        regs.bind("OUTPUTLATCHFRC", write=self._write_OUTPUTLATCHFRC)
        regs.bind("OUTPUTLOCK", write=self._write_OUTPUTLOCK)

    def level(self, n: int) -> int:
        """The level of OUTPUTXBARn."""
        return self._levels[n - 1]

    def _follow(self, i: int) -> None:
        registers = self._regs.registers
        latch, level = registers["OUTPUTLATCH"], self._outputs[i].level
        latch.value |= level << i
        if registers["OUTPUTLATCHENABLE"].value >> i & 1:
            level = latch.value >> i & 1
        level ^= registers["OUTPUTINV"].value >> i & 1
        if level != self._levels[i]:
            self._levels[i] = level
            self._put[i](level)

    def _follow_all(self) -> None:
        for i in range(OUTPUTS):
            self._follow(i)

    def _locked(self, name: str, word: int) -> bool:
        registers = self._regs.registers
        locked = bool(registers["OUTPUTLOCK"].value & 1)
        if locked:
            report_locked(self._cpu, registers[name].path, "OUTPUTLOCK", word)
        return locked

    def _write(self, name: str, word: int, lanes: int = ALL) -> None:
        if not self._locked(name, word):
            self._regs.registers[name].store(word, lanes)
            self._follow_all()

    def _write_OUTPUTLATCHCLR(self, word: int, lanes: int = ALL) -> None:
        self._regs.registers["OUTPUTLATCH"].value &= ~word
        self._follow_all()

    def _write_OUTPUTLATCHFRC(self, word: int, lanes: int = ALL) -> None:
        self._regs.registers["OUTPUTLATCH"].value |= word & (1 << OUTPUTS) - 1
        self._follow_all()

    def _write_OUTPUTLOCK(self, word: int, lanes: int = ALL) -> None:
        if word >> 16 == KEY:
            self._regs.registers["OUTPUTLOCK"].store(word, lanes)
