"""Comparator subsystem registers (CMPSS1 to 8).

Offsets and fields: HDR F2837xS_cmpss.h, struct CMPSS_REGS; protection and reset values: TRM, CMPSS registers.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import R0W1, RW, W1S, At, Block, F, R, Register, Word


class COMPCTL(Register, eallow=True):
    """Comparator control.  TRM CMPSS registers; HDR COMPCTL_BITS."""
    COMPDACE     = F(15,     RW, 0, "comparators and DACs are on")
    ASYNCLEN     = F(14,     RW, 0, "the asynchronous level goes into the latched output of the low comparator too")
    CTRIPOUTLSEL = F(13, 12, RW, 0, "CTRIPOUTL: 0 asynchronous, 1 synchronous, 2 filtered, 3 latched")
    CTRIPLSEL    = F(11, 10, RW, 0, "CTRIPL: 0 asynchronous, 1 synchronous, 2 filtered, 3 latched")
    COMPLINV     = F( 9,     RW, 0, "the low comparator is inverted")
    COMPLSOURCE  = F( 8,     RW, 0, "negative input of the low comparator: 0 DAC, 1 pin")
    ASYNCHEN     = F( 6,     RW, 0, "the asynchronous level goes into the latched output of the high comparator too")
    CTRIPOUTHSEL = F( 5,  4, RW, 0, "CTRIPOUTH: 0 asynchronous, 1 synchronous, 2 filtered, 3 latched")
    CTRIPHSEL    = F( 3,  2, RW, 0, "CTRIPH: 0 asynchronous, 1 synchronous, 2 filtered, 3 latched")
    COMPHINV     = F( 1,     RW, 0, "the high comparator is inverted")
    COMPHSOURCE  = F( 0,     RW, 0, "negative input of the high comparator: 0 DAC, 1 pin")


class COMPHYSCTL(Register, eallow=True):
    """Hysteresis.  TRM CMPSS registers; HDR COMPHYSCTL_BITS."""
    COMPHYS = F(2, 0, RW, 0, "hysteresis: 0 none, 1 to 4 times the typical one")


class COMPSTS(Register):
    """Status.  TRM CMPSS registers; HDR COMPSTS_BITS."""
    COMPLLATCH = F(9, R, 0, "latched output of the low comparator's filter")
    COMPLSTS   = F(8, R, 0, "output of the low comparator's filter")
    COMPHLATCH = F(1, R, 0, "latched output of the high comparator's filter")
    COMPHSTS   = F(0, R, 0, "output of the high comparator's filter")


class COMPSTSCLR(Register, eallow=True):
    """Clears of the latches.  TRM CMPSS registers; HDR COMPSTSCLR_BITS."""
    LSYNCCLREN = F(10, RW,   0, "EPWMSYNCPER clears COMPLLATCH")
    LLATCHCLR  = F( 9, R0W1, 0, "clear COMPLLATCH")
    HSYNCCLREN = F( 2, RW,   0, "EPWMSYNCPER clears COMPHLATCH")
    HLATCHCLR  = F( 1, R0W1, 0, "clear COMPHLATCH")


class COMPDACCTL(Register, eallow=True):
    """DAC control.  TRM CMPSS registers; HDR COMPDACCTL_BITS."""
    FREESOFT    = F(15, 14, RW, 0, "emulation halt (no debugger halts this CPU)")
    SWLOADSEL   = F( 7,     RW, 0, "DACxVALA is loaded: 0 with SYSCLK, 1 with EPWMSYNCPER")
    RAMPLOADSEL = F( 6,     RW, 0, "RAMPSTS goes back to: 0 RAMPMAXREFA, 1 RAMPMAXREFS")
    SELREF      = F( 5,     RW, 0, "reference: 0 VDDA, 1 VDAC")
    RAMPSOURCE  = F( 4,  1, RW, 0, "whose EPWMSYNCPER: ePWM number less one")
    DACSOURCE   = F( 0,     RW, 0, "DACHVALA is: 0 DACHVALS, 1 the ramp")


class _DacValue(Register):
    """A code of a DAC."""
    DACVAL = F(11, 0, RW, 0, "code")


class DACHVALS(_DacValue):
    """Shadow code of the high comparator's DAC.  TRM CMPSS registers; HDR DACHVALS_BITS."""


class DACLVALS(_DacValue):
    """Shadow code of the low comparator's DAC.  TRM CMPSS registers; HDR DACLVALS_BITS."""


class DACHVALA(Register):
    """Active code of the high comparator's DAC.  TRM CMPSS registers; HDR DACHVALA_BITS."""
    DACVAL = F(11, 0, R, 0, "code at the comparator")


class DACLVALA(Register):
    """Active code of the low comparator's DAC.  TRM CMPSS registers; HDR DACLVALA_BITS."""
    DACVAL = F(11, 0, R, 0, "code at the comparator")


class RAMPDLYA(Register):
    """Active delay of the ramp.  TRM CMPSS registers; HDR RAMPDLYA_BITS."""
    DELAY = F(12, 0, R, 0, "SYSCLK from EPWMSYNCPER to the first step down")


class RAMPDLYS(Register):
    """Shadow delay of the ramp.  TRM CMPSS registers; HDR RAMPDLYS_BITS."""
    DELAY = F(12, 0, RW, 0, "next delay")


class _FilterControl(Register, eallow=True):
    """A digital filter."""
    FILINIT = F(15,    R0W1, 0, "all samples become the filter's input")
    THRESH  = F(13, 9, RW,   0, "samples that a change of the output wants, less one")
    SAMPWIN = F( 8, 4, RW,   0, "samples in the window, less one")


class CTRIPLFILCTL(_FilterControl, eallow=True):
    """Filter of the low comparator.  TRM CMPSS registers; HDR CTRIPLFILCTL_BITS."""


class CTRIPHFILCTL(_FilterControl, eallow=True):
    """Filter of the high comparator.  TRM CMPSS registers; HDR CTRIPHFILCTL_BITS."""


class _FilterClock(Register, eallow=True):
    """The sample clock of a digital filter."""
    CLKPRESCALE = F(9, 0, RW, 0, "SYSCLK from sample to sample, less one")


class CTRIPLFILCLKCTL(_FilterClock, eallow=True):
    """Sample clock of the low comparator's filter.  TRM CMPSS registers; HDR CTRIPLFILCLKCTL_BITS."""


class CTRIPHFILCLKCTL(_FilterClock, eallow=True):
    """Sample clock of the high comparator's filter.  TRM CMPSS registers; HDR CTRIPHFILCLKCTL_BITS."""


class COMPLOCK(Register, eallow=True):
    """Locks, set until a reset.  TRM CMPSS registers; HDR COMPLOCK_BITS."""
    CTRIP      = F(3, W1S, 0, "lock CTRIPxFILCTL and CTRIPxFILCLKCTL")
    DACCTL     = F(2, W1S, 0, "lock COMPDACCTL")
    COMPHYSCTL = F(1, W1S, 0, "lock COMPHYSCTL")
    COMPCTL    = F(0, W1S, 0, "lock COMPCTL")


class CmpssRegs(Block, struct="CMPSS_REGS"):
    """Comparator subsystem.  HDR struct CMPSS_REGS."""
    COMPCTL         = At(0x00, COMPCTL)
    COMPHYSCTL      = At(0x01, COMPHYSCTL)
    COMPSTS         = At(0x02, COMPSTS)
    COMPSTSCLR      = At(0x03, COMPSTSCLR)
    COMPDACCTL      = At(0x04, COMPDACCTL)
    DACHVALS        = At(0x06, DACHVALS)
    DACHVALA        = At(0x07, DACHVALA)
    RAMPMAXREFA     = Word(0x08, R,  0, text="active start of the ramp")
    RAMPMAXREFS     = Word(0x0A, RW, 0, text="next start of the ramp")
    RAMPDECVALA     = Word(0x0C, R,  0, text="active step of the ramp")
    RAMPDECVALS     = Word(0x0E, RW, 0, text="next step of the ramp")
    RAMPSTS         = Word(0x10, R,  0, text="the ramp now")
    DACLVALS        = At(0x12, DACLVALS)
    DACLVALA        = At(0x13, DACLVALA)
    RAMPDLYA        = At(0x14, RAMPDLYA)
    RAMPDLYS        = At(0x15, RAMPDLYS)
    CTRIPLFILCTL    = At(0x16, CTRIPLFILCTL)
    CTRIPLFILCLKCTL = At(0x17, CTRIPLFILCLKCTL)
    CTRIPHFILCTL    = At(0x18, CTRIPHFILCTL)
    CTRIPHFILCLKCTL = At(0x19, CTRIPHFILCLKCTL)
    COMPLOCK        = At(0x1A, COMPLOCK)
