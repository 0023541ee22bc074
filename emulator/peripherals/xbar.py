"""The X-BAR flags: which signals of the ePWM and Output X-BARs have been high.

Modelled: XBARFLG1 (comparators), INPUT1 to INPUT6 and ECAP1.OUT to ECAP6.OUT of XBARFLG2, and their clears.
Not modelled: the other flags, which stay 0, because their signals do.
Time: none; a flag is set in the cycle of its signal.
CHOICE: a flag is set while its signal is high, so a clear in that time sets it again.
CHOICE: the flag of an INPUT or an eCAP is set only after a mux of an X-BAR has selected the signal, or XBARFLG2 or
    XBARCLR2 was accessed.  Before that no program needs the flags, and every edge of GPIO0, which is the pin of all
    inputs out of reset, would cost time.
Sources: TRM X-BAR; HDR F2837xS_xbar.h.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Final

from emulator.registers.core import ALL
from emulator.registers.xbar import XBARFLG1, XBARFLG2, XbarRegs
from emulator.signals import Level

#: Some clears have other names in TI's header than their flags.  They lie at the same bits, which is what counts here.
_FLAGS: Final = {name.replace("_", "."): ("XBARFLG1", field.mask) for name, field in XBARFLG1.fields.items()} | {
    name.replace("_", "."): ("XBARFLG2", field.mask)
    for name, field in XBARFLG2.fields.items() if name.startswith(("INPUT", "ECAP"))
}  # fmt: skip
_LATER: Final = tuple(name for name in _FLAGS if name.startswith(("INPUT", "ECAP")))


class XbarFlags:
    """The flags over their registers.  `signals` are the modelled ones."""

    __slots__ = ("_followed", "_regs", "_signals")

    def __init__(self, regs: XbarRegs, signals: Mapping[str, Level]) -> None:
        self._regs, self._signals = regs, signals
        self._followed: set[str] = set()
        for name in _FLAGS:
            if name not in _LATER:
                self.follow(name)
        regs.bind("XBARFLG2", read=self._read_XBARFLG2)
        for n in (1, 2, 3):
            regs.bind(f"XBARCLR{n}", write=partial(self._write_XBARCLRn, n))

    def follow(self, name: str) -> None:
        """Set the flag of a signal from now on."""
        if name in _FLAGS and name not in self._followed:
            self._followed.add(name)
            self._signals[name].changed.connect(partial(self._on_level, name))
            self._on_level(name, self._signals[name].level)

    def _on_level(self, name: str, level: int) -> None:
        if level:
            register, mask = _FLAGS[name]
            self._regs.registers[register].value |= mask

    def _follow_later(self) -> None:
        for name in _LATER:
            self.follow(name)

    def _set_again(self) -> None:
        for name in self._followed:
            self._on_level(name, self._signals[name].level)

    def _read_XBARFLG2(self) -> int:
        self._follow_later()
        return self._regs.registers["XBARFLG2"].value

    def _write_XBARCLRn(self, n: int, word: int, lanes: int = ALL) -> None:
        if n == 2:
            self._follow_later()
        self._regs.registers[f"XBARFLG{n}"].value &= ~word
        self._set_again()
