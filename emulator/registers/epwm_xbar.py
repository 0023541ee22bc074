"""ePWM X-BAR registers: what TRIP4, 5 and 7 to 12 of the ePWM modules are made of.

Offsets and fields: HDR F2837xS_epwm_xbar.h, struct EPWM_XBAR_REGS; write protection: TRM, EPWM_XBAR_REGS.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import RW, W1S, At, Block, F, Register, W
from emulator.registers.xbar_mux import MuxConfig0To15, MuxConfig16To31, MuxEnable


class TRIP4MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for TRIP4.  TRM ePWM X-BAR registers; HDR TRIP4MUX0TO15CFG_BITS."""


class TRIP4MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for TRIP4.  TRM ePWM X-BAR registers; HDR TRIP4MUX16TO31CFG_BITS."""


class TRIP4MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make TRIP4.  TRM ePWM X-BAR registers; HDR TRIP4MUXENABLE_BITS."""


class TRIP5MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for TRIP5.  TRM ePWM X-BAR registers; HDR TRIP5MUX0TO15CFG_BITS."""


class TRIP5MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for TRIP5.  TRM ePWM X-BAR registers; HDR TRIP5MUX16TO31CFG_BITS."""


class TRIP5MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make TRIP5.  TRM ePWM X-BAR registers; HDR TRIP5MUXENABLE_BITS."""


class TRIP7MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for TRIP7.  TRM ePWM X-BAR registers; HDR TRIP7MUX0TO15CFG_BITS."""


class TRIP7MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for TRIP7.  TRM ePWM X-BAR registers; HDR TRIP7MUX16TO31CFG_BITS."""


class TRIP7MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make TRIP7.  TRM ePWM X-BAR registers; HDR TRIP7MUXENABLE_BITS."""


class TRIP8MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for TRIP8.  TRM ePWM X-BAR registers; HDR TRIP8MUX0TO15CFG_BITS."""


class TRIP8MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for TRIP8.  TRM ePWM X-BAR registers; HDR TRIP8MUX16TO31CFG_BITS."""


class TRIP8MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make TRIP8.  TRM ePWM X-BAR registers; HDR TRIP8MUXENABLE_BITS."""


class TRIP9MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for TRIP9.  TRM ePWM X-BAR registers; HDR TRIP9MUX0TO15CFG_BITS."""


class TRIP9MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for TRIP9.  TRM ePWM X-BAR registers; HDR TRIP9MUX16TO31CFG_BITS."""


class TRIP9MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make TRIP9.  TRM ePWM X-BAR registers; HDR TRIP9MUXENABLE_BITS."""


class TRIP10MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for TRIP10.  TRM ePWM X-BAR registers; HDR TRIP10MUX0TO15CFG_BITS."""


class TRIP10MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for TRIP10.  TRM ePWM X-BAR registers; HDR TRIP10MUX16TO31CFG_BITS."""


class TRIP10MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make TRIP10.  TRM ePWM X-BAR registers; HDR TRIP10MUXENABLE_BITS."""


class TRIP11MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for TRIP11.  TRM ePWM X-BAR registers; HDR TRIP11MUX0TO15CFG_BITS."""


class TRIP11MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for TRIP11.  TRM ePWM X-BAR registers; HDR TRIP11MUX16TO31CFG_BITS."""


class TRIP11MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make TRIP11.  TRM ePWM X-BAR registers; HDR TRIP11MUXENABLE_BITS."""


class TRIP12MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for TRIP12.  TRM ePWM X-BAR registers; HDR TRIP12MUX0TO15CFG_BITS."""


class TRIP12MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for TRIP12.  TRM ePWM X-BAR registers; HDR TRIP12MUX16TO31CFG_BITS."""


class TRIP12MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make TRIP12.  TRM ePWM X-BAR registers; HDR TRIP12MUXENABLE_BITS."""


class TRIPOUTINV(Register, bits=32, eallow=True):
    """Inversion.  TRM ePWM X-BAR registers; HDR TRIPOUTINV_BITS."""
    TRIP12 = F(7, RW, 0, "TRIP12 is inverted")
    TRIP11 = F(6, RW, 0, "TRIP11 is inverted")
    TRIP10 = F(5, RW, 0, "TRIP10 is inverted")
    TRIP9  = F(4, RW, 0, "TRIP9 is inverted")
    TRIP8  = F(3, RW, 0, "TRIP8 is inverted")
    TRIP7  = F(2, RW, 0, "TRIP7 is inverted")
    TRIP5  = F(1, RW, 0, "TRIP5 is inverted")
    TRIP4  = F(0, RW, 0, "TRIP4 is inverted")


class TRIPLOCK(Register, bits=32, eallow=True):
    """Lock, set only with the key, until a reset.  TRM ePWM X-BAR registers; HDR TRIPLOCK_BITS."""
    KEY  = F(31, 16, W,   0, "0x5A5A, or the write is ignored")
    LOCK = F(0,      W1S, 0, "the other registers that configure are locked")


class EPwmXbarRegs(Block, struct="EPWM_XBAR_REGS"):
    """ePWM X-BAR.  HDR struct EPWM_XBAR_REGS."""
    TRIP4MUX0TO15CFG   = At(0x00, TRIP4MUX0TO15CFG)
    TRIP4MUX16TO31CFG  = At(0x02, TRIP4MUX16TO31CFG)
    TRIP5MUX0TO15CFG   = At(0x04, TRIP5MUX0TO15CFG)
    TRIP5MUX16TO31CFG  = At(0x06, TRIP5MUX16TO31CFG)
    TRIP7MUX0TO15CFG   = At(0x08, TRIP7MUX0TO15CFG)
    TRIP7MUX16TO31CFG  = At(0x0A, TRIP7MUX16TO31CFG)
    TRIP8MUX0TO15CFG   = At(0x0C, TRIP8MUX0TO15CFG)
    TRIP8MUX16TO31CFG  = At(0x0E, TRIP8MUX16TO31CFG)
    TRIP9MUX0TO15CFG   = At(0x10, TRIP9MUX0TO15CFG)
    TRIP9MUX16TO31CFG  = At(0x12, TRIP9MUX16TO31CFG)
    TRIP10MUX0TO15CFG  = At(0x14, TRIP10MUX0TO15CFG)
    TRIP10MUX16TO31CFG = At(0x16, TRIP10MUX16TO31CFG)
    TRIP11MUX0TO15CFG  = At(0x18, TRIP11MUX0TO15CFG)
    TRIP11MUX16TO31CFG = At(0x1A, TRIP11MUX16TO31CFG)
    TRIP12MUX0TO15CFG  = At(0x1C, TRIP12MUX0TO15CFG)
    TRIP12MUX16TO31CFG = At(0x1E, TRIP12MUX16TO31CFG)
    TRIP4MUXENABLE     = At(0x20, TRIP4MUXENABLE)
    TRIP5MUXENABLE     = At(0x22, TRIP5MUXENABLE)
    TRIP7MUXENABLE     = At(0x24, TRIP7MUXENABLE)
    TRIP8MUXENABLE     = At(0x26, TRIP8MUXENABLE)
    TRIP9MUXENABLE     = At(0x28, TRIP9MUXENABLE)
    TRIP10MUXENABLE    = At(0x2A, TRIP10MUXENABLE)
    TRIP11MUXENABLE    = At(0x2C, TRIP11MUXENABLE)
    TRIP12MUXENABLE    = At(0x2E, TRIP12MUXENABLE)
    TRIPOUTINV         = At(0x38, TRIPOUTINV)
    TRIPLOCK           = At(0x3E, TRIPLOCK)
