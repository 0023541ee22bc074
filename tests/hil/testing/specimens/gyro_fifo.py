"""gyro_fifo.c: the L3G4200D on SPI-A through the SPI's FIFO, one burst a reading, when STATUS_REG says there is one."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, DelayUs, GpioCtrlRegs, GpioDataRegs, SpiaRegs

READ = 0x80
MULTI = 0x40
WHO_AM_I = 0x0F
CTRL_REG1 = 0x20
CTRL_REG4 = 0x23
STATUS_REG = 0x27
OUT_Z_L = 0x2C
ZDA = 0x04

Answer: array[uint16, 3]


# gyro_fifo.c: Init_SPI
def Init_SPI() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1
    GpioCtrlRegs.GPBGMUX2.bit.GPIO58 = 3
    GpioCtrlRegs.GPBGMUX2.bit.GPIO59 = 3
    GpioCtrlRegs.GPBGMUX2.bit.GPIO60 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO58 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO59 = 3
    GpioCtrlRegs.GPBMUX2.bit.GPIO60 = 3
    GpioDataRegs.GPBSET.bit.GPIO61 = 1
    GpioCtrlRegs.GPBDIR.bit.GPIO61 = 1
    EDIS()
    SpiaRegs.SPICCR.bit.SPISWRESET = 0
    SpiaRegs.SPICCR.bit.SPICHAR = 7
    SpiaRegs.SPICCR.bit.CLKPOLARITY = 1
    SpiaRegs.SPICTL.bit.CLK_PHASE = 0
    SpiaRegs.SPICTL.bit.MASTER_SLAVE = 1
    SpiaRegs.SPICTL.bit.TALK = 1
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = 9
    SpiaRegs.SPIFFTX.all = 0xE040
    SpiaRegs.SPIFFRX.all = 0x6040
    SpiaRegs.SPICCR.bit.SPISWRESET = 1


# gyro_fifo.c: Burst
def Burst(command: uint16, data: uint16, count: uint16) -> void:
    i: uint16
    GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1
    SpiaRegs.SPITXBUF = command << 8
    for i in range(1, count):
        SpiaRegs.SPITXBUF = data << 8
    while SpiaRegs.SPIFFRX.bit.RXFFST < count:
        pass
    GpioDataRegs.GPBSET.bit.GPIO61 = 1
    for i in range(count):
        Answer[i] = SpiaRegs.SPIRXBUF & 0xFF


# gyro_fifo.c: Init_Gyro
def Init_Gyro() -> int16:
    i: uint16
    Init_SPI()
    Burst(READ | WHO_AM_I, 0, 2)
    if Answer[1] != 0xD3:
        return 0
    Burst(CTRL_REG4, 0x80, 2)
    Burst(CTRL_REG1, 0x0C, 2)
    for i in range(15):
        DelayUs(20000)
    return 1


# gyro_fifo.c: Read_Z
def Read_Z(rate: ptr[int16]) -> int16:
    Burst(READ | STATUS_REG, 0, 2)
    if (Answer[1] & ZDA) == 0:
        return 0
    Burst(READ | MULTI | OUT_Z_L, 0, 3)
    rate[0] = int16(Answer[1] | Answer[2] << 8)
    return 1


# gyro_fifo.c: Millidegrees
def Millidegrees(rate: int16) -> int32:
    return int32(rate) * 35 / 4
