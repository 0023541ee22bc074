"""Defects of numbers in other idioms: members of structures, helper functions, conditional expressions, constants."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Pair

PAIRS: Final = (
    Pair(
        "sign-lost",
        "a member that a conditional expression limits",
        (("Duty", (-3,)),),
        """
class MOTOR(struct):
    duty: uint16
Motor: MOTOR = (0,)
def Set(m: ptr[MOTOR], error: int16) -> void:
    m.duty = error * 8  # <-
    m.duty = 1000 if m.duty > 1000 else m.duty
def Duty(error: int16) -> uint16:
    Set(addressof(Motor), error)
    return Motor.duty
""",
        """
class MOTOR(struct):
    duty: uint16
Motor: MOTOR = (0,)
def Set(m: ptr[MOTOR], error: int16) -> void:
    m.duty = error * 8 if error > 0 else 0
    m.duty = 1000 if m.duty > 1000 else m.duty
def Duty(error: int16) -> uint16:
    Set(addressof(Motor), error)
    return Motor.duty
""",
    ),
    Pair(
        "unsigned-wrap",
        "a member that is stepped below 0, and limited",
        (("Down", (3,)), ("Down", (3,))),
        """
class SLIDER(struct):
    level: uint16
    top: uint16
    place: uint16
Slider: SLIDER = (4, 100, 0)
def Down(by: uint16) -> uint16:
    Slider.level -= by  # <-
    if Slider.level > Slider.top:
        Slider.level = Slider.top
    return Slider.level
""",
        """
class SLIDER(struct):
    level: uint16
    top: uint16
    place: uint16
Slider: SLIDER = (4, 100, 0)
def Down(by: uint16) -> uint16:
    Slider.level -= Slider.level if Slider.level < by else by
    if Slider.level > Slider.top:
        Slider.level = Slider.top
    Slider.place -= 1  # a ring goes down from 0 to its last element
    if Slider.place > 7:
        Slider.place = 7
    return Slider.level
""",
    ),
    Pair(
        "narrowed",
        "a clock divided by a count that is too small, without a cast",
        (("Speed", (600,)),),
        """
class STATE(struct):
    rpm: uint16
State: STATE = (0,)
def Speed(count: uint32) -> uint16:
    State.rpm = 60000000 / count  # <-
    return State.rpm
""",
        """
class STATE(struct):
    rpm: uint16
State: STATE = (0,)
def Speed(count: uint32) -> uint16:
    State.rpm = 60000000 / count if count > 1000 else 60000
    return State.rpm
""",
    ),
    Pair(
        "widened-late",
        "a difference in one branch of a conditional expression",
        (("Add", (0, 3, 4)),),
        """
Total: int32 = 0
def Add(off: int16, wanted: uint16, actual: uint16) -> int32:
    Total += int32(0 if off else wanted * 30000 + actual)  # <-
    return Total
""",
        """
Total: int32 = 0
def Add(off: int16, wanted: uint16, actual: uint16) -> int32:
    Total += 0 if off else int32(wanted) * 30000 + actual
    return Total
""",
    ),
    Pair(
        "float-argument",
        "volts are passed for a code, through a pointer to a function",
        (("Use", (2.5,)),),
        """
Code: uint16 = 0
def Set(code: uint16) -> void:
    Code = code
Output: funcptr[void, uint16] = Set
def Use(volts: float32) -> uint16:
    Output(volts)  # <-
    return Code
""",
        """
Code: uint16 = 0
def Set(code: uint16) -> void:
    Code = code
Output: funcptr[void, uint16] = Set
def Use(volts: float32) -> uint16:
    Output(uint16(volts))
    return Code
""",
    ),
    Pair(
        "sign-extended",
        "a shift register in a structure",
        (("Feed", (0x31,)),),
        """
class CRC(struct):
    bits: int16
Crc: CRC = (-1,)
def Feed(octet: uint16) -> int16:
    Crc.bits ^= octet
    Crc.bits = (Crc.bits >> 1) ^ 0xA001 if Crc.bits & 1 else Crc.bits >> 1  # <-
    return Crc.bits
""",
        """
class CRC(struct):
    bits: uint16
Crc: CRC = (0xFFFF,)
def Feed(octet: uint16) -> int16:
    Crc.bits ^= octet
    Crc.bits = (Crc.bits >> 1) ^ 0xA001 if Crc.bits & 1 else Crc.bits >> 1
    return int16(Crc.bits)
""",
    ),
    Pair(
        "sign-lost",
        "a word of two octets that a function widens without its sign",
        (("Take", (0x7C, 0xFC)),),
        """
def Word(low: uint16, high: uint16) -> int32:
    word: int32 = low | high << 8
    return word
Rpm: int32 = 0
def Take(low: uint16, high: uint16) -> int16:
    Rpm = Word(low, high)  # <-
    return 1 if Rpm < -3000 else 0
""",
        """
def Word(low: uint16, high: uint16) -> int32:
    word: int32 = low | high << 8
    return word
Rpm: int32 = 0
Count: int32 = 0
def Take(low: uint16, high: uint16) -> int16:
    Rpm = int16(Word(low, high))
    Count = Word(low, high)
    return 1 if Rpm < -3000 or Count > 64000 else 0
""",
    ),
    Pair(
        "fields-overlap",
        "a negative number below the constants of a frame",
        (("Frame", (-5,)),),
        """
def Frame(speed: int16) -> uint32:
    return uint32(3) << 24 | uint32(2) << 16 | uint32(speed)  # <-
""",
        """
def Frame(speed: int16) -> uint32:
    return uint32(3) << 24 | uint32(2) << 16 | uint32(uint16(speed))
def Marked(word: uint32) -> uint32:
    return word | 0x10000
""",
    ),
    Pair(
        "write-to-constant",
        "a table that is const is calibrated",
        (("Calibrate", ()),),
        """
Gains: const[array[int16, 3]] = (1, 2, 3)
def Add(gains: ptr[int16], by: int16) -> void:
    gains[1] += by  # <-
def Calibrate() -> int16:
    Add(cast(ptr[int16], Gains), 2)
    return Gains[1]
""",
        """
Gains: array[int16, 3] = (1, 2, 3)
def Add(gains: ptr[int16], by: int16) -> void:
    gains[1] += by
def Calibrate() -> int16:
    Add(Gains, 2)
    return Gains[1]
""",
    ),
)
