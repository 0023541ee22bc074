"""line_fifo.c: lines of text over SCI-A's FIFO, collected in a buffer until the line feed, without blocking."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, GpioCtrlRegs, SciaRegs

LENGTH = 24

Line: array[char, LENGTH]
Used: uint16 = 0
Complete: uint16 = 0


# line_fifo.c: Init_Line
def Init_Line() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1
    GpioCtrlRegs.GPCGMUX2.bit.GPIO84 = 1
    GpioCtrlRegs.GPCGMUX2.bit.GPIO85 = 1
    GpioCtrlRegs.GPCMUX2.bit.GPIO84 = 1
    GpioCtrlRegs.GPCMUX2.bit.GPIO85 = 1
    GpioCtrlRegs.GPCQSEL2.bit.GPIO85 = 3
    EDIS()
    SciaRegs.SCICTL1.all = 0x0000
    SciaRegs.SCICCR.all = 0x0007
    SciaRegs.SCIHBAUD.all = 0x02
    SciaRegs.SCILBAUD.all = 0x8A
    SciaRegs.SCIFFTX.all = 0xC000
    SciaRegs.SCIFFRX.all = 0x0000
    SciaRegs.SCIFFTX.all = 0xE040
    SciaRegs.SCIFFRX.all = 0x6050
    SciaRegs.SCICTL1.all = 0x0023


# line_fifo.c: Poll_Line
def Poll_Line() -> uint16:
    c: uint16
    while SciaRegs.SCIFFRX.bit.RXFFST > 0 and Complete == 0:
        c = SciaRegs.SCIRXBUF.all & 0xFF
        if c == 10:
            Line[Used] = 0
            Complete = 1
        elif Used < LENGTH - 1:
            Line[Used] = c
            Used += 1
    return Complete


# line_fifo.c: Take_Line
def Take_Line(to: ptr[char]) -> uint16:
    i: uint16 = 0
    while Line[i] != 0:
        to[i] = Line[i]
        i += 1
    to[i] = 0
    Used = 0
    Complete = 0
    return i


# line_fifo.c: Send_Line
def Send_Line(text: ptr[char]) -> void:
    while text[0] != 0:
        while SciaRegs.SCIFFTX.bit.TXFFST >= 16:
            pass
        SciaRegs.SCITXBUF.all = text[0] & 0xFF
        text += 1
