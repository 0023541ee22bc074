"""The muxes that the ePWM X-BAR and the Output X-BAR have for each of their outputs.

Fields: HDR F2837xS_epwm_xbar.h and F2837xS_output_xbar.h.  What a mux chooses from: `../peripherals/xbar_mux.py`.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import RW, F, Register


class MuxConfig0To15(Register, bits=32, eallow=True):
    """The choices of muxes 0 to 15."""
    MUX15 = F(31, 30, RW, 0, "signal of mux 15")
    MUX14 = F(29, 28, RW, 0, "signal of mux 14")
    MUX13 = F(27, 26, RW, 0, "signal of mux 13")
    MUX12 = F(25, 24, RW, 0, "signal of mux 12")
    MUX11 = F(23, 22, RW, 0, "signal of mux 11")
    MUX10 = F(21, 20, RW, 0, "signal of mux 10")
    MUX9  = F(19, 18, RW, 0, "signal of mux 9")
    MUX8  = F(17, 16, RW, 0, "signal of mux 8")
    MUX7  = F(15, 14, RW, 0, "signal of mux 7")
    MUX6  = F(13, 12, RW, 0, "signal of mux 6")
    MUX5  = F(11, 10, RW, 0, "signal of mux 5")
    MUX4  = F( 9,  8, RW, 0, "signal of mux 4")
    MUX3  = F( 7,  6, RW, 0, "signal of mux 3")
    MUX2  = F( 5,  4, RW, 0, "signal of mux 2")
    MUX1  = F( 3,  2, RW, 0, "signal of mux 1")
    MUX0  = F( 1,  0, RW, 0, "signal of mux 0")


class MuxConfig16To31(Register, bits=32, eallow=True):
    """The choices of muxes 16 to 31."""
    MUX31 = F(31, 30, RW, 0, "signal of mux 31")
    MUX30 = F(29, 28, RW, 0, "signal of mux 30")
    MUX29 = F(27, 26, RW, 0, "signal of mux 29")
    MUX28 = F(25, 24, RW, 0, "signal of mux 28")
    MUX27 = F(23, 22, RW, 0, "signal of mux 27")
    MUX26 = F(21, 20, RW, 0, "signal of mux 26")
    MUX25 = F(19, 18, RW, 0, "signal of mux 25")
    MUX24 = F(17, 16, RW, 0, "signal of mux 24")
    MUX23 = F(15, 14, RW, 0, "signal of mux 23")
    MUX22 = F(13, 12, RW, 0, "signal of mux 22")
    MUX21 = F(11, 10, RW, 0, "signal of mux 21")
    MUX20 = F( 9,  8, RW, 0, "signal of mux 20")
    MUX19 = F( 7,  6, RW, 0, "signal of mux 19")
    MUX18 = F( 5,  4, RW, 0, "signal of mux 18")
    MUX17 = F( 3,  2, RW, 0, "signal of mux 17")
    MUX16 = F( 1,  0, RW, 0, "signal of mux 16")


class MuxEnable(Register, bits=32, eallow=True):
    """Which muxes are part of the output."""
    MUX31 = F(31, RW, 0, "mux 31 is part of the output")
    MUX30 = F(30, RW, 0, "mux 30 is part of the output")
    MUX29 = F(29, RW, 0, "mux 29 is part of the output")
    MUX28 = F(28, RW, 0, "mux 28 is part of the output")
    MUX27 = F(27, RW, 0, "mux 27 is part of the output")
    MUX26 = F(26, RW, 0, "mux 26 is part of the output")
    MUX25 = F(25, RW, 0, "mux 25 is part of the output")
    MUX24 = F(24, RW, 0, "mux 24 is part of the output")
    MUX23 = F(23, RW, 0, "mux 23 is part of the output")
    MUX22 = F(22, RW, 0, "mux 22 is part of the output")
    MUX21 = F(21, RW, 0, "mux 21 is part of the output")
    MUX20 = F(20, RW, 0, "mux 20 is part of the output")
    MUX19 = F(19, RW, 0, "mux 19 is part of the output")
    MUX18 = F(18, RW, 0, "mux 18 is part of the output")
    MUX17 = F(17, RW, 0, "mux 17 is part of the output")
    MUX16 = F(16, RW, 0, "mux 16 is part of the output")
    MUX15 = F(15, RW, 0, "mux 15 is part of the output")
    MUX14 = F(14, RW, 0, "mux 14 is part of the output")
    MUX13 = F(13, RW, 0, "mux 13 is part of the output")
    MUX12 = F(12, RW, 0, "mux 12 is part of the output")
    MUX11 = F(11, RW, 0, "mux 11 is part of the output")
    MUX10 = F(10, RW, 0, "mux 10 is part of the output")
    MUX9  = F( 9, RW, 0, "mux 9 is part of the output")
    MUX8  = F( 8, RW, 0, "mux 8 is part of the output")
    MUX7  = F( 7, RW, 0, "mux 7 is part of the output")
    MUX6  = F( 6, RW, 0, "mux 6 is part of the output")
    MUX5  = F( 5, RW, 0, "mux 5 is part of the output")
    MUX4  = F( 4, RW, 0, "mux 4 is part of the output")
    MUX3  = F( 3, RW, 0, "mux 3 is part of the output")
    MUX2  = F( 2, RW, 0, "mux 2 is part of the output")
    MUX1  = F( 1, RW, 0, "mux 1 is part of the output")
    MUX0  = F( 0, RW, 0, "mux 0 is part of the output")
