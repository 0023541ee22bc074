"""spi.c: SPI-A as the gyro's master, one byte at a time.

CHOICE: the pins are those of the banner of GYRO.c (GPIO58 SIMO, GPIO59 SOMI, GPIO60 CLK, multiplexer 15); GPIO61 is
the chip select as a plain output, because a transfer of several bytes keeps it low.  CHOICE: mode 3 at 1 MHz, 8 bits,
no FIFO, polled, which gives TaskGYRO its 43 microseconds.  Sources: TRM SPI chapter, L3G section on SPI, TFG annex 1.
"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, GpioCtrlRegs, GpioDataRegs, SpiaRegs

HIGH = 1
LOW = 0

SPI_BRR_1MHZ = 49  # LSPCLK 50 MHz / (49 + 1)


# spi.c: Init_SPIA
def Init_SPIA() -> void:

    EALLOW()
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1

    GpioCtrlRegs.GPBMUX2.bit.GPIO58 = 0
    GpioCtrlRegs.GPBMUX2.bit.GPIO59 = 0
    GpioCtrlRegs.GPBMUX2.bit.GPIO60 = 0
    GpioCtrlRegs.GPBGMUX2.bit.GPIO58 = 3
    GpioCtrlRegs.GPBGMUX2.bit.GPIO59 = 3
    GpioCtrlRegs.GPBGMUX2.bit.GPIO60 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO58 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO59 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO60 = 3
    GpioCtrlRegs.GPBQSEL2.bit.GPIO58 = 3
    GpioCtrlRegs.GPBQSEL2.bit.GPIO59 = 3
    GpioCtrlRegs.GPBQSEL2.bit.GPIO60 = 3

    GpioDataRegs.GPBSET.bit.GPIO61 = 1
    GpioCtrlRegs.GPBMUX2.bit.GPIO61 = 0
    GpioCtrlRegs.GPBGMUX2.bit.GPIO61 = 0
    GpioCtrlRegs.GPBDIR.bit.GPIO61 = 1
    EDIS()

    SpiaRegs.SPICCR.bit.SPISWRESET = 0
    SpiaRegs.SPICCR.bit.SPICHAR = 7
    SpiaRegs.SPICCR.bit.CLKPOLARITY = 1
    SpiaRegs.SPICTL.bit.CLK_PHASE = 0
    SpiaRegs.SPICTL.bit.MASTER_SLAVE = 1
    SpiaRegs.SPICTL.bit.TALK = 1
    SpiaRegs.SPICTL.bit.SPIINTENA = 0
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = SPI_BRR_1MHZ
    SpiaRegs.SPICCR.bit.SPISWRESET = 1


# spi.c: Set_CS
def Set_CS(level: uchar) -> void:
    if level == LOW:
        GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1
    else:
        GpioDataRegs.GPBSET.bit.GPIO61 = 1


# spi.c: SPI_transfer
def SPI_transfer(data: uchar) -> uchar:
    SpiaRegs.SPITXBUF = data << 8  # a character of 8 bits leaves from bit 15 down
    while SpiaRegs.SPISTS.bit.INT_FLAG == 0:
        pass
    return SpiaRegs.SPIRXBUF & 0xFF  # above bit 7 stand leftovers of the shift register
