"""protocol.c with its defects corrected, each where its id stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.c28x.language import *
from emulator.c28x.rts import atof, fabs
from emulator.sysbios.headers import System_sprintf, Task_sleep
from firmware_model.board_support.xbee import Send_Frame
from firmware_model.corrections.xbee import Frame_Leaving
from firmware_model.protocol import Begin_Frame, End_Frame
from firmware_model.robot_types import ORDER, REFERENCE, ODOMETRY_Trayect

if TYPE_CHECKING:
    from firmware_model.protocol import Aux_Frame

# A frame of 48 characters at 9600 baud takes 50 ms.
MOST_WAIT_MS = 60
TWO_PI: const[float32] = 6.2831853
# What the robot does: TFG 3.2.3.
V_MAX: const[float32] = 0.3
W_MAX: const[float32] = 1.57
ORDER_MOST = 80
Checked: char = 0  # an order with a right check has come


# protocol.c: Send_ODO_Trayect
def Send_ODO_Trayect(dataT: ptr[ODOMETRY_Trayect]) -> void:

    j: int16 = 0
    n: int16 = 0

    if FIXED("PROTO-frame-rewritten"):
        while Frame_Leaving() and n < MOST_WAIT_MS:
            Task_sleep(1)
            n += 1
    Aux_Frame[0] = Begin_Frame
    Aux_Frame[1] = "O"
    Aux_Frame[2] = "D"
    Aux_Frame[3] = "O"
    Aux_Frame[4] = " "

    j = 5

    n = System_sprintf(Aux_Frame + j, "%d", Whole(dataT.X) if FIXED("PROTO-coordinate-range") else int16(dataT.X))

    j += n
    Aux_Frame[j] = ","
    j += 1

    n = System_sprintf(Aux_Frame + j, "%d", Whole(dataT.Y) if FIXED("PROTO-coordinate-range") else int16(dataT.Y))
    j += n
    Aux_Frame[j] = ","
    j += 1

    n = System_sprintf(Aux_Frame + j, "%d", Near_Radian(dataT.tita) if FIXED("PROTO-angle-unit") else int16(dataT.tita))
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
    Aux_Frame[j] = "\n"
    Aux_Frame[j + 1] = End_Frame

    Send_Frame(Aux_Frame, j + 2)


# protocol.c: Send_ODO_Trayect
def Whole(millimetres: float32) -> int16:
    if millimetres > 32767.0:
        return 32767
    if millimetres < -32767.0:
        return -32767
    return int16(millimetres)


# protocol.c: Send_ODO_Trayect
def Near_Radian(radians: float32) -> int16:
    # Of the angles that are the same but for whole turns one lies near a whole number: 113 turns are 709.99994 rad, so
    # that the best of 113 is at most 0.0045 rad off.
    turns: int16
    nearest: int16
    best: int16 = 0
    rest: float32 = radians - TWO_PI * int32(radians / TWO_PI)
    turned: float32
    least: float32 = 1

    if rest < 0:
        rest = rest + TWO_PI
    for turns in range(113):
        turned = rest + TWO_PI * turns
        nearest = int16(turned + 0.5)
        if fabs(turned - nearest) < least:
            least = fabs(turned - nearest)
            best = nearest
    return best


# protocol.c: Interpret_Order
def Interpret_Order(data: ptr[char]) -> ORDER:

    if FIXED("PROTO-damage-unseen"):
        if Damaged(data):
            return ORDER.O_ERROR
    if FIXED("PROTO-order-prefix"):
        if data[0] == Begin_Frame and not (data[1] == "S" and data[2] == "E"):
            if not Ends_After_Name(data):
                return ORDER.O_ERROR
    if FIXED("PROTO-numbers-unchecked"):
        if data[0] == Begin_Frame and data[1] == "S" and data[2] == "E":
            if not Holds_Two_Numbers(data):
                return ORDER.O_ERROR
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


# protocol.c: Interpret_Order
def Ends_After_Name(data: ptr[char]) -> char:
    j: int16

    for j in range(1, 5):
        if data[j] == 0 or data[j] == End_Frame:
            return 0
    if FIXED("PROTO-damage-unseen"):
        return data[5] == End_Frame or data[5] == "*"
    else:
        return data[5] == End_Frame


# protocol.c: Interpret_Order
def Damaged(data: ptr[char]) -> char:
    j: int16 = 1
    sum: uint16 = 0

    while data[j] != "*" and data[j] != End_Frame and data[j] != 0 and j < ORDER_MOST:
        sum = sum ^ data[j]
        j += 1
    if data[j] == "*":
        if Digit(data[j + 1]) * 16 + Digit(data[j + 2]) != sum or data[j + 3] != End_Frame:
            return 1
        Checked = 1
        return 0
    return Checked and not (data[1] == "S" and data[2] == "T" and data[3] == "O" and data[4] == "P")


# protocol.c: Interpret_Order
def Digit(c: char) -> uint16:
    if c >= "0" and c <= "9":
        return c - "0"
    if c >= "A" and c <= "F":
        return c - "A" + 10
    return 0x100  # more than any sum


# protocol.c: Interpret_Order
def Holds_Two_Numbers(data: ptr[char]) -> char:
    j: int16

    for j in range(3, 5):
        if data[j] == 0 or data[j] == End_Frame:
            return 0
    j = After_Number(data, 5)
    if j == 0 or data[j] != ",":
        return 0
    j = After_Number(data, j + 1)
    if FIXED("PROTO-damage-unseen"):
        return j != 0 and (data[j] == End_Frame or data[j] == "*")
    else:
        return j != 0 and data[j] == End_Frame


# protocol.c: Interpret_Order
def After_Number(data: ptr[char], j: int16) -> int16:
    digits: int16 = 0

    if data[j] == "-" or data[j] == "+":
        j += 1
    while data[j] >= "0" and data[j] <= "9":
        j += 1
        digits += 1
    if data[j] == ".":
        j += 1
        while data[j] >= "0" and data[j] <= "9":
            j += 1
            digits += 1
    return j if digits else 0


# protocol.c: Obtain_Reference
def Obtain_Reference(data: ptr[char], ref: ptr[REFERENCE]) -> void:

    j: int16

    ref.V = atof(data + 5)
    j = Move_to_comma(5, data)
    if FIXED("PROTO-comma-missing"):
        if data[j] != ",":
            ref.W = 0.0
        else:
            ref.W = atof(data + j + 1)
    else:
        ref.W = atof(data + j + 1)
    if FIXED("PROTO-reference-range"):
        ref.V = Within(ref.V, V_MAX)
        ref.W = Within(ref.W, W_MAX)


# protocol.c: Obtain_Reference
def Within(value: float32, limit: float32) -> float32:
    if value > limit:
        return limit
    if value < -limit:
        return -limit
    return value


# protocol.c: Move_to_comma
def Move_to_comma(i: int16, data: ptr[char]) -> int16:

    j: int16

    j = i + 1
    if FIXED("PROTO-comma-missing"):
        while data[j] != "," and data[j] != End_Frame and data[j] != 0:
            j += 1
    else:
        while data[j] != ",":
            j += 1
    return j
