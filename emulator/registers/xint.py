"""External interrupt registers at 0x7070 (unprotected): XINT1 to XINT5, whose pins the Input X-BAR chooses.

Offsets and fields: HDR F2837xS_xint.h; write protection: TRM, XINT_REGS.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import RW, At, Block, F, R, Register, Word


class XINTxCR(Register):
    """Configuration of one external interrupt.  TRM XINT registers; HDR XINT1CR_BITS."""
    POLARITY = F(3, 2, RW, 0, "edge that interrupts: 0, 2 falling, 1 rising, 3 both")
    ENABLE   = F(0,    RW, 0, "the interrupt is enabled")


class XintRegs(Block, struct="XINT_REGS"):
    """External interrupts.  HDR struct XINT_REGS."""
    XINT1CR  = At(0x00, XINTxCR)
    XINT2CR  = At(0x01, XINTxCR)
    XINT3CR  = At(0x02, XINTxCR)
    XINT4CR  = At(0x03, XINTxCR)
    XINT5CR  = At(0x04, XINTxCR)
    XINT1CTR = Word(0x08, R, 0, text="SYSCLK cycles since the last edge that interrupted")
    XINT2CTR = Word(0x09, R, 0, text="SYSCLK cycles since the last edge that interrupted")
    XINT3CTR = Word(0x0A, R, 0, text="SYSCLK cycles since the last edge that interrupted")
