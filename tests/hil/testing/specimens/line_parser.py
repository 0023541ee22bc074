"""line_parser.c: SCI-A by polling, a ring of received characters and a parser of lines `SET n value`."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.c28x.rts import atoi, memset, strlen
from emulator.device_h import CpuSysRegs, EALLOW, EDIS, GpioCtrlRegs, SciaRegs

RING = 32
LINE = 24
SLOTS = 4

Ring: array[char, RING]
Head: uint16 = 0
Tail: uint16 = 0
Lost: uint16 = 0
Line: array[char, LINE]
Length: uint16 = 0
Values: array[int16, SLOTS]


# line_parser.c: Serial_Init
def Serial_Init() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1
    GpioCtrlRegs.GPCGMUX2.bit.GPIO84 = 1
    GpioCtrlRegs.GPCGMUX2.bit.GPIO85 = 1
    GpioCtrlRegs.GPCMUX2.bit.GPIO84 = 1
    GpioCtrlRegs.GPCMUX2.bit.GPIO85 = 1
    EDIS()
    SciaRegs.SCICCR.all = 0x0007
    SciaRegs.SCIHBAUD.all = 0x02
    SciaRegs.SCILBAUD.all = 0x8A
    SciaRegs.SCIFFTX.all = 0xE040
    SciaRegs.SCIFFRX.all = 0x6040
    SciaRegs.SCICTL1.all = 0x0023
    Head = 0
    Tail = 0
    Length = 0
    memset(Values, 0, sizeof(Values))


# line_parser.c: Serial_Poll
def Serial_Poll() -> void:
    c: char
    next: uint16
    if SciaRegs.SCIRXST.bit.RXERROR:
        SciaRegs.SCICTL1.bit.SWRESET = 0
        SciaRegs.SCICTL1.bit.SWRESET = 1
        return
    while SciaRegs.SCIFFRX.bit.RXFFST > 0:
        c = SciaRegs.SCIRXBUF.all & 0xFF
        next = (Head + 1) % RING
        if next == Tail:
            Lost += 1
        else:
            Ring[Head] = c
            Head = next


# line_parser.c: Serial_Send
def Serial_Send(text: ptr[char]) -> void:
    while text[0]:
        while SciaRegs.SCIFFTX.bit.TXFFST >= 16:
            pass
        SciaRegs.SCITXBUF.all = text[0]
        text += 1


# line_parser.c: Is_Digit
def Is_Digit(c: char) -> uint16:
    return c >= "0" and c <= "9"


# line_parser.c: Execute
def Execute() -> int16:
    slot: uint16
    value: int16
    if Length < 7 or Line[0] != "S" or Line[1] != "E" or Line[2] != "T" or Line[3] != " ":
        return -1
    if not Is_Digit(Line[4]) or Line[5] != " ":
        return -2
    slot = Line[4] - "0"
    if slot >= SLOTS:
        return -3
    value = atoi(addressof(Line[6]))
    Values[slot] = value
    return 0


# line_parser.c: Serial_Handle
def Serial_Handle() -> uint16:
    c: char
    handled: uint16 = 0
    while Tail != Head:
        c = Ring[Tail]
        Tail = (Tail + 1) % RING
        if c == "\r":
            Line[Length] = 0
            if Execute() == 0:
                Serial_Send("OK\r")
                handled += 1
            else:
                Serial_Send("ERR\r")
            Length = 0
        elif Length < LINE - 1:
            Line[Length] = c
            Length += 1
    return handled


# line_parser.c: Line_Length
def Line_Length() -> uint16:
    return uint16(strlen(Line))
