"""protocol.c: frames to and from the console.  Sources: TFG section 3.1.4, annex 1."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.c28x.rts import atof
from emulator.sysbios.headers import Swi_Handle, System_sprintf
from firmware_model.board_support.xbee import (
    Init_XBee,
    Install_Received_Frame_Action,
    Read_Frame,
    Receive_Frames,
    Received_Frame,
    Send_Frame,
)
from firmware_model.robot_types import ORDER, REFERENCE, ODOMETRY_Trayect

Begin_Frame: const[char] = "#"
End_Frame: const[char] = "\r"

Aux_Frame: array[char, 80]


# protocol.c: Init_Protocol
def Init_Protocol(action: Swi_Handle) -> void:

    Init_XBee()
    Receive_Frames(Begin_Frame, End_Frame)
    Install_Received_Frame_Action(action)


# protocol.c: Received_Order
def Received_Order() -> char:
    return Received_Frame()


# protocol.c: Read_Order
def Read_Order(data: ptr[char]) -> void:

    Read_Frame(data)


# protocol.c: Send_ODO_Trayect
def Send_ODO_Trayect(dataT: ptr[ODOMETRY_Trayect]) -> void:

    j: int16 = 0
    n: int16 = 0

    Aux_Frame[0] = Begin_Frame
    Aux_Frame[1] = "O"
    Aux_Frame[2] = "D"
    Aux_Frame[3] = "O"
    Aux_Frame[4] = " "

    j = 5

    n = System_sprintf(Aux_Frame + j, "%d", int16(dataT.X))

    j += n
    Aux_Frame[j] = ","
    j += 1

    n = System_sprintf(Aux_Frame + j, "%d", int16(dataT.Y))
    j += n
    Aux_Frame[j] = ","
    j += 1

    n = System_sprintf(Aux_Frame + j, "%d", int16(dataT.tita))
    j += n
    Aux_Frame[j] = ","
    j += 1

    n = System_sprintf(Aux_Frame + j, "%d", int16(dataT.df * 10.0))
    j += n

    Aux_Frame[j] = ","
    j += 1

    n = System_sprintf(Aux_Frame + j, "%d", int16(dataT.dr * 10.0))
    j += n
    Aux_Frame[j] = ","
    j += 1

    n = System_sprintf(Aux_Frame + j, "%d", int16(dataT.dl * 10.0))
    j += n
    Aux_Frame[j] = "\n"  # as in C: line feed before carriage return
    Aux_Frame[j + 1] = End_Frame

    Send_Frame(Aux_Frame, j + 2)


# protocol.c: Interpret_Order
def Interpret_Order(data: ptr[char]) -> ORDER:

    if data[0] == Begin_Frame and data[1] == "S" and data[2] == "T" and data[3] == "O" and data[4] == "P":
        return ORDER.O_STOP
    elif data[0] == Begin_Frame and data[1] == "M" and data[2] == "I" and data[3] == "S" and data[4] == "N":
        return ORDER.O_MISSION
    elif data[0] == Begin_Frame and data[1] == "T" and data[2] == "E" and data[3] == "L" and data[4] == "E":
        return ORDER.O_TELEMANIPULATION
    elif data[0] == Begin_Frame and data[1] == "S" and data[2] == "E" and data[3] == "T" and data[4] == "R":
        return ORDER.O_SETR
    elif data[0] == Begin_Frame and data[1] == "C" and data[2] == "A" and data[3] == "L" and data[4] == "B":
        return ORDER.O_CALIBRATION
    elif data[0] == Begin_Frame and data[1] == "I" and data[2] == "N" and data[3] == "I" and data[4] == "T":
        return ORDER.O_INITIALITATION
    else:
        return ORDER.O_ERROR


# protocol.c: Obtain_Reference
def Obtain_Reference(data: ptr[char], ref: ptr[REFERENCE]) -> void:

    j: int16

    ref.V = atof(data + 5)
    j = Move_to_comma(5, data)
    ref.W = atof(data + j + 1)


# protocol.c: Move_to_comma
def Move_to_comma(i: int16, data: ptr[char]) -> int16:

    j: int16

    j = i + 1
    while data[j] != ",":  # as in C: no bound
        j += 1
    return j
