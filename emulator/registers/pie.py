"""PIE control registers at 0x0CE0 (unprotected; only the vector table is).

Offsets and fields: HDR F2837xS_piectrl.h.  PIEIERx stands at 2x, PIEIFRx at 2x + 1, x = 1..12.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import RW, W1C, At, Block, F, R, Register


class PIECTRL(Register):
    """PIE enable and last vector fetched.  TRM PIE registers; HDR PIECTRL_BITS."""
    PIEVECT = F(15, 1, R,  0, "address of the vector fetched last, bits 15:1")
    ENPIE   = F( 0,    RW, 0, "vectors come from the PIE")


class PIEACK(Register):
    """Group acknowledge: a set bit holds back its group.  TRM PIE registers; HDR PIEACK_BITS."""
    ACK12 = F(11, W1C, 0, "group 12")
    ACK11 = F(10, W1C, 0, "group 11")
    ACK10 = F( 9, W1C, 0, "group 10")
    ACK9  = F( 8, W1C, 0, "group 9")
    ACK8  = F( 7, W1C, 0, "group 8")
    ACK7  = F( 6, W1C, 0, "group 7")
    ACK6  = F( 5, W1C, 0, "group 6")
    ACK5  = F( 4, W1C, 0, "group 5")
    ACK4  = F( 3, W1C, 0, "group 4")
    ACK3  = F( 2, W1C, 0, "group 3")
    ACK2  = F( 1, W1C, 0, "group 2")
    ACK1  = F( 0, W1C, 0, "group 1")


class PIEIERx(Register):
    """Enables of the sixteen interrupts of a group.  TRM PIE registers; HDR PIEIER1_BITS."""
    INTx16 = F(15, RW, 0, "enable INTx.16")
    INTx15 = F(14, RW, 0, "enable INTx.15")
    INTx14 = F(13, RW, 0, "enable INTx.14")
    INTx13 = F(12, RW, 0, "enable INTx.13")
    INTx12 = F(11, RW, 0, "enable INTx.12")
    INTx11 = F(10, RW, 0, "enable INTx.11")
    INTx10 = F( 9, RW, 0, "enable INTx.10")
    INTx9  = F( 8, RW, 0, "enable INTx.9")
    INTx8  = F( 7, RW, 0, "enable INTx.8")
    INTx7  = F( 6, RW, 0, "enable INTx.7")
    INTx6  = F( 5, RW, 0, "enable INTx.6")
    INTx5  = F( 4, RW, 0, "enable INTx.5")
    INTx4  = F( 3, RW, 0, "enable INTx.4")
    INTx3  = F( 2, RW, 0, "enable INTx.3")
    INTx2  = F( 1, RW, 0, "enable INTx.2")
    INTx1  = F( 0, RW, 0, "enable INTx.1")


class PIEIFRx(Register):
    """Flags of the sixteen interrupts of a group.  TRM PIE registers; HDR PIEIFR1_BITS."""
    INTx16 = F(15, RW, 0, "INTx.16 latched")
    INTx15 = F(14, RW, 0, "INTx.15 latched")
    INTx14 = F(13, RW, 0, "INTx.14 latched")
    INTx13 = F(12, RW, 0, "INTx.13 latched")
    INTx12 = F(11, RW, 0, "INTx.12 latched")
    INTx11 = F(10, RW, 0, "INTx.11 latched")
    INTx10 = F( 9, RW, 0, "INTx.10 latched")
    INTx9  = F( 8, RW, 0, "INTx.9 latched")
    INTx8  = F( 7, RW, 0, "INTx.8 latched")
    INTx7  = F( 6, RW, 0, "INTx.7 latched")
    INTx6  = F( 5, RW, 0, "INTx.6 latched")
    INTx5  = F( 4, RW, 0, "INTx.5 latched")
    INTx4  = F( 3, RW, 0, "INTx.4 latched")
    INTx3  = F( 2, RW, 0, "INTx.3 latched")
    INTx2  = F( 1, RW, 0, "INTx.2 latched")
    INTx1  = F( 0, RW, 0, "INTx.1 latched")


class PieCtrlRegs(Block, struct="PIE_CTRL_REGS"):
    """PIE control.  HDR struct PIE_CTRL_REGS."""
    PIECTRL  = At(0x00, PIECTRL)
    PIEACK   = At(0x01, PIEACK)
    PIEIER1  = At(0x02, PIEIERx)
    PIEIFR1  = At(0x03, PIEIFRx)
    PIEIER2  = At(0x04, PIEIERx)
    PIEIFR2  = At(0x05, PIEIFRx)
    PIEIER3  = At(0x06, PIEIERx)
    PIEIFR3  = At(0x07, PIEIFRx)
    PIEIER4  = At(0x08, PIEIERx)
    PIEIFR4  = At(0x09, PIEIFRx)
    PIEIER5  = At(0x0A, PIEIERx)
    PIEIFR5  = At(0x0B, PIEIFRx)
    PIEIER6  = At(0x0C, PIEIERx)
    PIEIFR6  = At(0x0D, PIEIFRx)
    PIEIER7  = At(0x0E, PIEIERx)
    PIEIFR7  = At(0x0F, PIEIFRx)
    PIEIER8  = At(0x10, PIEIERx)
    PIEIFR8  = At(0x11, PIEIFRx)
    PIEIER9  = At(0x12, PIEIERx)
    PIEIFR9  = At(0x13, PIEIFRx)
    PIEIER10 = At(0x14, PIEIERx)
    PIEIFR10 = At(0x15, PIEIFRx)
    PIEIER11 = At(0x16, PIEIERx)
    PIEIFR11 = At(0x17, PIEIFRx)
    PIEIER12 = At(0x18, PIEIERx)
    PIEIFR12 = At(0x19, PIEIFRx)
