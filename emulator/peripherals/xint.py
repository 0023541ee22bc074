"""One external interrupt, XINT1 to XINT5: edges of its input give interrupts.

Modelled: ENABLE, POLARITY (0 falling, 1 rising, 3 both); the counter of XINT1 to XINT3, which counts SYSCLK cycles
since the last edge that interrupted, and wraps at 16 bits.  It stops while the interrupt is disabled and then continues
from its value, because only such an edge or a reset clears it.
Not modelled: the cycles of synchronisation between a pin and the module.
Time: no event; the pulse comes in the cycle of the edge, the counter is computed when it is read.
CHOICE: POLARITY = 2 is falling like 0, as in manuals of the family; TI's driver library names 0, 1 and 3 only.
CHOICE: an edge that comes while the interrupt is disabled is not remembered (TI: a disabled source has no effect).
Sources: TRM external interrupts; HDR F2837xS_xint.h.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.clock import Clock
from emulator.registers.core import ALL
from emulator.registers.xint import XintRegs

#: XINTxCR
ENABLE: Final = 0x0001
#: POLARITY of XINTxCR
RISING: Final = 1
BOTH: Final = 3


class Xint:
    """External interrupt `number` over its registers; `pulse` is its line to the PIE.

    `listen(on)` is called when the module begins (or ceases) to need the edges of its input.
    """

    def __init__(self, clock: Clock, regs: XintRegs, number: int, pulse: Callable[[], None],
                 listen: Callable[[bool], None] = lambda _on: None) -> None:  # fmt: skip
        self._clock, self._pulse, self._listen = clock, pulse, listen
        self._control = regs.registers[f"XINT{number}CR"]
        #: The counter stood at `_count` at `_since`.
        self._count = 0
        self._since = clock.now
        regs.bind(f"XINT{number}CR", write=self._write_XINTxCR)
        if number <= 3:
            regs.bind(f"XINT{number}CTR", read=self._read_XINTxCTR)

    def edge(self, level: int) -> None:
        """The input has changed to `level`."""
        control = self._control.value
        if not control & ENABLE:
            return
        polarity = control >> 2 & 3
        if polarity == BOTH or (polarity == RISING) == (level == 1):
            self._count, self._since = 0, self._clock.now
            self._pulse()

    def _write_XINTxCR(self, word: int, lanes: int = ALL) -> None:
        self._count, self._since = self._read_XINTxCTR(), self._clock.now
        before = self._control.value & ENABLE
        self._control.store(word, lanes)
        if before != self._control.value & ENABLE:
            self._listen(not before)

    def _read_XINTxCTR(self) -> int:
        passed = self._clock.now - self._since if self._control.value & ENABLE else 0
        return self._count + passed & 0xFFFF
