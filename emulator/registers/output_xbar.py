"""Output X-BAR registers: what OUTPUTXBAR1 to 8 are made of.

Offsets and fields: HDR F2837xS_output_xbar.h, struct OUTPUT_XBAR_REGS; write protection: TRM, OUTPUT_XBAR_REGS.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import R0W1, RW, W1S, At, Block, F, R, Register, W
from emulator.registers.xbar_mux import MuxConfig0To15, MuxConfig16To31, MuxEnable


class OUTPUT1MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for OUTPUT1.  TRM Output X-BAR registers; HDR OUTPUT1MUX0TO15CFG_BITS."""


class OUTPUT1MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for OUTPUT1.  TRM Output X-BAR registers; HDR OUTPUT1MUX16TO31CFG_BITS."""


class OUTPUT1MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make OUTPUT1.  TRM Output X-BAR registers; HDR OUTPUT1MUXENABLE_BITS."""


class OUTPUT2MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for OUTPUT2.  TRM Output X-BAR registers; HDR OUTPUT2MUX0TO15CFG_BITS."""


class OUTPUT2MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for OUTPUT2.  TRM Output X-BAR registers; HDR OUTPUT2MUX16TO31CFG_BITS."""


class OUTPUT2MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make OUTPUT2.  TRM Output X-BAR registers; HDR OUTPUT2MUXENABLE_BITS."""


class OUTPUT3MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for OUTPUT3.  TRM Output X-BAR registers; HDR OUTPUT3MUX0TO15CFG_BITS."""


class OUTPUT3MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for OUTPUT3.  TRM Output X-BAR registers; HDR OUTPUT3MUX16TO31CFG_BITS."""


class OUTPUT3MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make OUTPUT3.  TRM Output X-BAR registers; HDR OUTPUT3MUXENABLE_BITS."""


class OUTPUT4MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for OUTPUT4.  TRM Output X-BAR registers; HDR OUTPUT4MUX0TO15CFG_BITS."""


class OUTPUT4MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for OUTPUT4.  TRM Output X-BAR registers; HDR OUTPUT4MUX16TO31CFG_BITS."""


class OUTPUT4MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make OUTPUT4.  TRM Output X-BAR registers; HDR OUTPUT4MUXENABLE_BITS."""


class OUTPUT5MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for OUTPUT5.  TRM Output X-BAR registers; HDR OUTPUT5MUX0TO15CFG_BITS."""


class OUTPUT5MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for OUTPUT5.  TRM Output X-BAR registers; HDR OUTPUT5MUX16TO31CFG_BITS."""


class OUTPUT5MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make OUTPUT5.  TRM Output X-BAR registers; HDR OUTPUT5MUXENABLE_BITS."""


class OUTPUT6MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for OUTPUT6.  TRM Output X-BAR registers; HDR OUTPUT6MUX0TO15CFG_BITS."""


class OUTPUT6MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for OUTPUT6.  TRM Output X-BAR registers; HDR OUTPUT6MUX16TO31CFG_BITS."""


class OUTPUT6MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make OUTPUT6.  TRM Output X-BAR registers; HDR OUTPUT6MUXENABLE_BITS."""


class OUTPUT7MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for OUTPUT7.  TRM Output X-BAR registers; HDR OUTPUT7MUX0TO15CFG_BITS."""


class OUTPUT7MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for OUTPUT7.  TRM Output X-BAR registers; HDR OUTPUT7MUX16TO31CFG_BITS."""


class OUTPUT7MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make OUTPUT7.  TRM Output X-BAR registers; HDR OUTPUT7MUXENABLE_BITS."""


class OUTPUT8MUX0TO15CFG(MuxConfig0To15, bits=32, eallow=True):
    """Signals of muxes 0 to 15 for OUTPUT8.  TRM Output X-BAR registers; HDR OUTPUT8MUX0TO15CFG_BITS."""


class OUTPUT8MUX16TO31CFG(MuxConfig16To31, bits=32, eallow=True):
    """Signals of muxes 16 to 31 for OUTPUT8.  TRM Output X-BAR registers; HDR OUTPUT8MUX16TO31CFG_BITS."""


class OUTPUT8MUXENABLE(MuxEnable, bits=32, eallow=True):
    """Muxes that make OUTPUT8.  TRM Output X-BAR registers; HDR OUTPUT8MUXENABLE_BITS."""


class OUTPUTLATCH(Register, bits=32):
    """Latches.  TRM Output X-BAR registers; HDR OUTPUTLATCH_BITS."""
    OUTPUT8 = F(7, R, 0, "OUTPUT8 was high")
    OUTPUT7 = F(6, R, 0, "OUTPUT7 was high")
    OUTPUT6 = F(5, R, 0, "OUTPUT6 was high")
    OUTPUT5 = F(4, R, 0, "OUTPUT5 was high")
    OUTPUT4 = F(3, R, 0, "OUTPUT4 was high")
    OUTPUT3 = F(2, R, 0, "OUTPUT3 was high")
    OUTPUT2 = F(1, R, 0, "OUTPUT2 was high")
    OUTPUT1 = F(0, R, 0, "OUTPUT1 was high")


class OUTPUTLATCHCLR(Register, bits=32):
    """Clears of the latches.  TRM Output X-BAR registers; HDR OUTPUTLATCHCLR_BITS."""
    OUTPUT8 = F(7, R0W1, 0, "clear the latch of OUTPUT8")
    OUTPUT7 = F(6, R0W1, 0, "clear the latch of OUTPUT7")
    OUTPUT6 = F(5, R0W1, 0, "clear the latch of OUTPUT6")
    OUTPUT5 = F(4, R0W1, 0, "clear the latch of OUTPUT5")
    OUTPUT4 = F(3, R0W1, 0, "clear the latch of OUTPUT4")
    OUTPUT3 = F(2, R0W1, 0, "clear the latch of OUTPUT3")
    OUTPUT2 = F(1, R0W1, 0, "clear the latch of OUTPUT2")
    OUTPUT1 = F(0, R0W1, 0, "clear the latch of OUTPUT1")


class OUTPUTLATCHFRC(Register, bits=32):
    """Sets of the latches.  TRM Output X-BAR registers; HDR OUTPUTLATCHFRC_BITS."""
    OUTPUT8 = F(7, R0W1, 0, "set the latch of OUTPUT8")
    OUTPUT7 = F(6, R0W1, 0, "set the latch of OUTPUT7")
    OUTPUT6 = F(5, R0W1, 0, "set the latch of OUTPUT6")
    OUTPUT5 = F(4, R0W1, 0, "set the latch of OUTPUT5")
    OUTPUT4 = F(3, R0W1, 0, "set the latch of OUTPUT4")
    OUTPUT3 = F(2, R0W1, 0, "set the latch of OUTPUT3")
    OUTPUT2 = F(1, R0W1, 0, "set the latch of OUTPUT2")
    OUTPUT1 = F(0, R0W1, 0, "set the latch of OUTPUT1")


class OUTPUTLATCHENABLE(Register, bits=32, eallow=True):
    """Use of the latches.  TRM Output X-BAR registers; HDR OUTPUTLATCHENABLE_BITS."""
    OUTPUT8 = F(7, RW, 0, "OUTPUT8 is its latch")
    OUTPUT7 = F(6, RW, 0, "OUTPUT7 is its latch")
    OUTPUT6 = F(5, RW, 0, "OUTPUT6 is its latch")
    OUTPUT5 = F(4, RW, 0, "OUTPUT5 is its latch")
    OUTPUT4 = F(3, RW, 0, "OUTPUT4 is its latch")
    OUTPUT3 = F(2, RW, 0, "OUTPUT3 is its latch")
    OUTPUT2 = F(1, RW, 0, "OUTPUT2 is its latch")
    OUTPUT1 = F(0, RW, 0, "OUTPUT1 is its latch")


class OUTPUTINV(Register, bits=32, eallow=True):
    """Inversion.  TRM Output X-BAR registers; HDR OUTPUTINV_BITS."""
    OUTPUT8 = F(7, RW, 0, "OUTPUT8 is inverted")
    OUTPUT7 = F(6, RW, 0, "OUTPUT7 is inverted")
    OUTPUT6 = F(5, RW, 0, "OUTPUT6 is inverted")
    OUTPUT5 = F(4, RW, 0, "OUTPUT5 is inverted")
    OUTPUT4 = F(3, RW, 0, "OUTPUT4 is inverted")
    OUTPUT3 = F(2, RW, 0, "OUTPUT3 is inverted")
    OUTPUT2 = F(1, RW, 0, "OUTPUT2 is inverted")
    OUTPUT1 = F(0, RW, 0, "OUTPUT1 is inverted")


class OUTPUTLOCK(Register, bits=32, eallow=True):
    """Lock, set only with the key, until a reset.  TRM Output X-BAR registers; HDR OUTPUTLOCK_BITS."""
    KEY  = F(31, 16, W,   0, "0x5A5A, or the write is ignored")
    LOCK = F(0,      W1S, 0, "the other registers that configure are locked")


class OutputXbarRegs(Block, struct="OUTPUT_XBAR_REGS"):
    """Output X-BAR.  HDR struct OUTPUT_XBAR_REGS."""
    OUTPUT1MUX0TO15CFG  = At(0x00, OUTPUT1MUX0TO15CFG)
    OUTPUT1MUX16TO31CFG = At(0x02, OUTPUT1MUX16TO31CFG)
    OUTPUT2MUX0TO15CFG  = At(0x04, OUTPUT2MUX0TO15CFG)
    OUTPUT2MUX16TO31CFG = At(0x06, OUTPUT2MUX16TO31CFG)
    OUTPUT3MUX0TO15CFG  = At(0x08, OUTPUT3MUX0TO15CFG)
    OUTPUT3MUX16TO31CFG = At(0x0A, OUTPUT3MUX16TO31CFG)
    OUTPUT4MUX0TO15CFG  = At(0x0C, OUTPUT4MUX0TO15CFG)
    OUTPUT4MUX16TO31CFG = At(0x0E, OUTPUT4MUX16TO31CFG)
    OUTPUT5MUX0TO15CFG  = At(0x10, OUTPUT5MUX0TO15CFG)
    OUTPUT5MUX16TO31CFG = At(0x12, OUTPUT5MUX16TO31CFG)
    OUTPUT6MUX0TO15CFG  = At(0x14, OUTPUT6MUX0TO15CFG)
    OUTPUT6MUX16TO31CFG = At(0x16, OUTPUT6MUX16TO31CFG)
    OUTPUT7MUX0TO15CFG  = At(0x18, OUTPUT7MUX0TO15CFG)
    OUTPUT7MUX16TO31CFG = At(0x1A, OUTPUT7MUX16TO31CFG)
    OUTPUT8MUX0TO15CFG  = At(0x1C, OUTPUT8MUX0TO15CFG)
    OUTPUT8MUX16TO31CFG = At(0x1E, OUTPUT8MUX16TO31CFG)
    OUTPUT1MUXENABLE    = At(0x20, OUTPUT1MUXENABLE)
    OUTPUT2MUXENABLE    = At(0x22, OUTPUT2MUXENABLE)
    OUTPUT3MUXENABLE    = At(0x24, OUTPUT3MUXENABLE)
    OUTPUT4MUXENABLE    = At(0x26, OUTPUT4MUXENABLE)
    OUTPUT5MUXENABLE    = At(0x28, OUTPUT5MUXENABLE)
    OUTPUT6MUXENABLE    = At(0x2A, OUTPUT6MUXENABLE)
    OUTPUT7MUXENABLE    = At(0x2C, OUTPUT7MUXENABLE)
    OUTPUT8MUXENABLE    = At(0x2E, OUTPUT8MUXENABLE)
    OUTPUTLATCH         = At(0x30, OUTPUTLATCH)
    OUTPUTLATCHCLR      = At(0x32, OUTPUTLATCHCLR)
    OUTPUTLATCHFRC      = At(0x34, OUTPUTLATCHFRC)
    OUTPUTLATCHENABLE   = At(0x36, OUTPUTLATCHENABLE)
    OUTPUTINV           = At(0x38, OUTPUTINV)
    OUTPUTLOCK          = At(0x3E, OUTPUTLOCK)
