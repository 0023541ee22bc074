"""Buffered DAC registers (DAC-A, B, C).

Offsets and fields: HDR F2837xS_dac.h, struct DAC_REGS; protection and reset values: TRM, buffered DAC registers.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import RW, W1S, At, Block, F, R, Register, W


class DACREV(Register):
    """Revision.  TRM DAC registers; HDR DACREV_BITS."""
    REV = F(7, 0, R, 0, "revision")


class DACCTL(Register, eallow=True):
    """Control.  TRM DAC registers; HDR DACCTL_BITS."""
    SYNCSEL   = F(7, 4, RW, 0, "ePWM whose EPWMSYNCPER loads DACVALA", modelled=False)
    LOADMODE  = F(2,    RW, 0, "DACVALA is loaded: 0 with SYSCLK, 1 with EPWMSYNCPER", modelled=False)
    DACREFSEL = F(0,    RW, 0, "reference: 0 VDAC, 1 VREFHI")


class DACVALA(Register):
    """Active code.  TRM DAC registers; HDR DACVALA_BITS."""
    DACVALA = F(11, 0, R, 0, "code at the output")


class DACVALS(Register):
    """Shadow code.  TRM DAC registers; HDR DACVALS_BITS."""
    DACVALS = F(11, 0, RW, 0, "next code")


class DACOUTEN(Register, eallow=True):
    """Output enable.  TRM DAC registers; HDR DACOUTEN_BITS."""
    DACOUTEN = F(0, RW, 0, "1 = the pin is driven")


class DACLOCK(Register, eallow=True):
    """Locks; set only with the key, cleared by a reset.  TRM DAC registers; HDR DACLOCK_BITS."""
    KEY      = F(15, 12, W,   0, "0xA, or the write is ignored")
    DACOUTEN = F(2,      W1S, 0, "lock DACOUTEN")
    DACVAL   = F(1,      W1S, 0, "lock DACVALS")
    DACCTL   = F(0,      W1S, 0, "lock DACCTL")


class DACTRIM(Register, eallow=True):
    """Trim.  TRM DAC registers; HDR DACTRIM_BITS."""
    OFFSET_TRIM = F(7, 0, RW, 0, "offset", modelled=False)


class DacRegs(Block, struct="DAC_REGS"):
    """Buffered DAC.  HDR struct DAC_REGS."""
    DACREV   = At(0x00, DACREV)
    DACCTL   = At(0x01, DACCTL)
    DACVALA  = At(0x02, DACVALA)
    DACVALS  = At(0x03, DACVALS)
    DACOUTEN = At(0x04, DACOUTEN)
    DACLOCK  = At(0x05, DACLOCK)
    DACTRIM  = At(0x06, DACTRIM)
