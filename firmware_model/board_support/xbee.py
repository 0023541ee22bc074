"""XBee.c: frames over the XBee on SCI-C, both ways by interrupt.

CHOICE: GPIO89 TX and GPIO90 RX (BoosterPack pins 4 and 3, multiplexer 6) at 9600 8N1, BRR 650.

Reception: the characters from the begin mark to the end mark, both included, are collected; a begin mark inside a
frame starts it anew; a frame longer than the buffer, or one with a line error in it, is dropped up to the next begin
mark.  A complete frame replaces the last one, read or not, and posts the action.  Read_Frame gives it with a NUL
behind its end mark.

After a break nothing arrives until SWRESET is pulsed.  That resets the transmitter too, so it is done by the next
Send_Frame that finds the transmitter empty: in this robot within 250 ms.

Transmission: Send_Frame keeps the pointer and returns; the interrupt feeds the 16-word FIFO.  So the caller must leave
the frame alone until it has left (28 ms for 27 characters), and a second call before that replaces the rest, but for
the characters that are in FIFO and shifter already.
Sources: TRM SCI chapter, XB (serial data), TFG section 3.1.4, annex 1.
"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.c28x.rts import memcpy
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, GpioCtrlRegs, ScicRegs
from emulator.sysbios.headers import Hwi_create, Hwi_disable, Hwi_restore, Swi_Handle, Swi_post, UArg

SCIC_RX_INT = 92  # PIE 8.5
SCIC_TX_INT = 93  # PIE 8.6
SCI_HBAUD_9600 = 0x02  # LSPCLK 50 MHz / ((650 + 1) * 8)
SCI_LBAUD_9600 = 0x8A

FRAME_SIZE = 80
FIFO_DEPTH = 16

First: char
Last: char
Received_Action: Swi_Handle = NULL

Rx_Frame: array[char, FRAME_SIZE]
Rx_Length: int16 = 0
Rx_Inside: char = 0

Frame: array[char, FRAME_SIZE]
Frame_Length: int16 = 0
Frame_Complete: char = 0

Tx_Data: ptr[char] = NULL
Tx_Count: int16 = 0


# XBee.c: Init_XBee
def Init_XBee() -> void:

    EALLOW()
    CpuSysRegs.PCLKCR7.bit.SCI_C = 1
    GpioCtrlRegs.GPCMUX2.bit.GPIO89 = 0
    GpioCtrlRegs.GPCMUX2.bit.GPIO90 = 0
    GpioCtrlRegs.GPCGMUX2.bit.GPIO89 = 1
    GpioCtrlRegs.GPCGMUX2.bit.GPIO90 = 1
    GpioCtrlRegs.GPCMUX2.bit.GPIO89 = 2
    GpioCtrlRegs.GPCMUX2.bit.GPIO90 = 2
    GpioCtrlRegs.GPCPUD.bit.GPIO90 = 0
    GpioCtrlRegs.GPCQSEL2.bit.GPIO90 = 3
    EDIS()

    ScicRegs.SCICTL1.all = 0x0000
    ScicRegs.SCICCR.all = 0x0007  # one stop bit, no parity, 8 bits
    ScicRegs.SCICTL2.all = 0x0000
    ScicRegs.SCIHBAUD.all = SCI_HBAUD_9600
    ScicRegs.SCILBAUD.all = SCI_LBAUD_9600
    ScicRegs.SCIFFTX.all = 0xC040  # FIFO on, both halves held in reset
    ScicRegs.SCIFFRX.all = 0x4040
    ScicRegs.SCIFFCT.all = 0x0000
    ScicRegs.SCIFFTX.all = 0xE040  # transmit interrupt at an empty FIFO, still disabled
    ScicRegs.SCIFFRX.all = 0x6061  # receive interrupt at one character, enabled

    Hwi_create(SCIC_RX_INT, XBee_Receive, NULL, NULL)
    Hwi_create(SCIC_TX_INT, XBee_Transmit, NULL, NULL)

    ScicRegs.SCICTL1.all = 0x0023  # SWRESET released, TXENA, RXENA


# XBee.c: Receive_Frames
def Receive_Frames(first: char, last: char) -> void:
    First = first
    Last = last


# XBee.c: Install_Received_Frame_Action
def Install_Received_Frame_Action(action: Swi_Handle) -> void:
    Received_Action = action


# XBee.c: Received_Frame
def Received_Frame() -> char:
    return Frame_Complete


# XBee.c: Read_Frame
def Read_Frame(data: ptr[char]) -> void:
    key: uint16

    key = Hwi_disable()
    memcpy(data, Frame, Frame_Length)
    data[Frame_Length] = 0
    Frame_Complete = 0
    Hwi_restore(key)


# XBee.c: Send_Frame
def Send_Frame(data: ptr[char], n: int16) -> void:
    key: uint16

    if ScicRegs.SCIRXST.bit.RXERROR == 1 and ScicRegs.SCICTL2.bit.TXEMPTY == 1:
        ScicRegs.SCICTL1.bit.SWRESET = 0  # ends a break too; with nothing in the shifter no character is lost
        ScicRegs.SCICTL1.bit.SWRESET = 1

    key = Hwi_disable()
    Tx_Data = data
    Tx_Count = n
    Hwi_restore(key)
    ScicRegs.SCIFFTX.bit.TXFFIENA = 1


# XBee.c: XBee_Receive
def XBee_Receive(arg: UArg) -> void:
    c: uint16

    if ScicRegs.SCIFFRX.bit.RXFFOVF == 1:  # characters are lost
        Rx_Inside = 0
        ScicRegs.SCIFFRX.bit.RXFFOVRCLR = 1

    while ScicRegs.SCIFFRX.bit.RXFFST != 0:
        c = ScicRegs.SCIRXBUF.all

        if c & 0xC000:  # this character came with a framing or parity error
            Rx_Inside = 0
        else:
            c = c & 0x00FF

            if c == First:
                Rx_Inside = 1
                Rx_Length = 0

            if Rx_Inside == 1:
                if Rx_Length == FRAME_SIZE - 1:
                    Rx_Inside = 0
                else:
                    Rx_Frame[Rx_Length] = c
                    Rx_Length += 1
                    if c == Last:
                        memcpy(Frame, Rx_Frame, Rx_Length)
                        Frame_Length = Rx_Length
                        Frame_Complete = 1
                        Rx_Inside = 0
                        if Received_Action != NULL:
                            Swi_post(Received_Action)

    ScicRegs.SCIFFRX.bit.RXFFINTCLR = 1


# XBee.c: XBee_Transmit
def XBee_Transmit(arg: UArg) -> void:

    while Tx_Count > 0 and ScicRegs.SCIFFTX.bit.TXFFST < FIFO_DEPTH:
        ScicRegs.SCITXBUF.all = Tx_Data[0] & 0x00FF
        Tx_Data += 1
        Tx_Count -= 1

    if Tx_Count == 0:
        ScicRegs.SCIFFTX.bit.TXFFIENA = 0
    ScicRegs.SCIFFTX.bit.TXFFINTCLR = 1
