"""Specimens of counts and stamps that wrap, switches without a case, numbers that are cut on their way."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Pair

#: An interrupt routine counts ticks; `After(n)` lets n of them pass.
_TICKS: Final = """
Ticks: volatile[uint16] = 65500
@interrupt
def Tick() -> void:
    Ticks += 1
Vector: funcptr = Tick
def After(n: uint16) -> void:
    i: uint16
    for i in range(n):
        Vector()
"""


def _ticks(source: str) -> str:
    mark = "End" if "End" in source else "Last"
    return f"{_TICKS}{mark}: uint16 = 0{source}"


PAIRS: Final = (
    Pair(
        "stamp-compare",
        "the end of an interval compared as a number",  # 65500 + 50 is 14, and 65510 lies above it
        (("Use", ()),),
        _ticks("""
def Over() -> uint16:
    if Ticks >= End:  # <-
        return 1
    return 0
def Use() -> uint16:
    over: uint16
    End = Ticks + 20
    After(10)
    over = Over()
    End = Ticks + 50
    return over + Over()
"""),
        _ticks("""
def Over() -> uint16:
    if int16(Ticks - End) >= 0:
        return 1
    return 0
def Use() -> uint16:
    over: uint16
    End = Ticks + 20
    After(10)
    over = Over()
    End = Ticks + 50
    return over + Over()
"""),
    ),
    Pair(
        "stamp-compare",
        "an end that is only met by chance",  # looked at 3 before it and 4 behind it
        (("Use", ()),),
        _ticks("""
def Over() -> uint16:
    if End == Ticks:  # <-
        return 1
    return 0
def Use() -> uint16:
    over: uint16
    End = Ticks + 10
    After(7)
    over = Over()
    After(7)
    return over + Over()
"""),
        _ticks("""
def Over() -> uint16:
    if End == Ticks:
        return 1
    return 0
def Use() -> uint16:
    over: uint16
    End = Ticks + 10
    After(7)
    over = Over()
    After(3)
    over = over + Over()
    After(7)
    return over + Over()
"""),
    ),
    Pair(
        "stamp-compare",
        "more than half of the counter has passed",  # 40000 counts are -25536
        (("Use", ()),),
        _ticks("""
def Late() -> uint16:
    if int16(Ticks - Last) > 300:  # <-
        return 1
    return 0
def Use() -> uint16:
    Last = Ticks
    After(40000)
    return Late()
"""),
        _ticks("""
def Late() -> uint16:
    if uint16(Ticks - Last) > 300:
        return 1
    return 0
def Use() -> uint16:
    Last = Ticks
    After(40000)
    return Late()
"""),
    ),
    Pair(
        "stamp-compare",
        "a wrap that is looked for",
        (("Use", ()),),
        _ticks("""
Late: uint16 = 0
def Since() -> uint16:
    now: uint16 = Ticks
    if now < Last:  # <-
        Late = 1
    return Late
def Use() -> uint16:
    late: uint16
    Last = Ticks
    late = Since()
    After(100)
    return late + Since()
"""),
        _ticks("""
def Since() -> uint16:
    now: uint16 = Ticks
    if now < Last:
        return uint16(65535 - Last) + now + 1
    return now - Last
def Use() -> uint16:
    late: uint16
    Last = Ticks
    late = Since()
    After(100)
    return late + Since()
"""),
    ),
    Pair(
        "unsigned-wrap",
        "a count of two that misses 0",
        (("Wait", (5,)),),
        """
def Wait(patience: uint16) -> uint16:
    turns: uint16 = 0
    while patience != 0:
        patience -= 2  # <-
        turns += 1
        if turns == 9:
            return turns
    return turns
""",
        """
def Wait(patience: uint16) -> uint16:
    turns: uint16 = 0
    while patience > 1:
        patience -= 2
        turns += 1
        if turns == 9:
            return turns
    return turns
""",
    ),
    Pair(
        "unsigned-wrap",
        "stamps of 16 bits subtracted in 32",
        (("Use", ()),),
        """
Runtime: uint32 = 30
def Add(now: uint16, last: uint16) -> void:
    Runtime += uint32(now) - last  # <-
def Use() -> uint32:
    Add(65530, 65520)
    Add(5, 65530)
    return Runtime
""",
        """
Runtime: uint32 = 30
Window: uint32 = 5000
def Add(now: uint16, last: uint16) -> void:
    Runtime += uint16(now - last)
def Move(new: uint16, old: uint16) -> void:
    Window += uint32(new) - old
def Use() -> uint32:
    Add(65530, 65520)
    Add(5, 65530)
    Move(100, 4000)
    return Runtime
""",
    ),
    Pair(
        "unsigned-wrap",
        "a product is stored in 16 bits and used wider",
        (("Energy", (300, 400)),),
        """
def Energy(volts: uint16, amps: uint16) -> float32:
    power: uint16
    power = volts * amps  # <-
    return power * 0.5
""",
        """
def Energy(volts: uint16, amps: uint16) -> float32:
    power: uint32
    power = uint32(volts) * amps
    return power * 0.5
""",
    ),
    Pair(
        "unsigned-wrap",
        "bits are shifted out before the division",
        (("Scaled", (5000,)),),
        """
def Scaled(code: uint16) -> uint16:
    return (code << 4) / 10  # <-
""",
        """
def Scaled(code: uint16) -> uint16:
    return uint16((uint32(code) << 4) / 10)
""",
    ),
    Pair(
        "narrowed",
        "a clock divided by a rate, cut to 16 bits",
        (("Interval", (400,)), ("Interval", (6000,))),
        """
CLOCK = 200000000
def Interval(rate: uint16) -> uint16:
    counts: uint16 = uint16(uint32(CLOCK) / rate)  # <-
    return counts
""",
        """
CLOCK = 200000000
def Interval(rate: uint16) -> uint16:
    counts: uint32 = uint32(CLOCK) / rate
    if counts > 65535:
        return 65535
    return uint16(counts)
""",
    ),
    Pair(
        "narrowed",
        "a product that a cast cuts",  # 2929 * 14 is 41006
        (("Way", (2929,)),),
        """
def Way(millivolts: uint16) -> int32:
    return int16(millivolts * 14)  # <-
""",
        """
def Way(millivolts: uint16) -> int32:
    return int16(millivolts * 11)
""",
    ),
    Pair(
        "narrowed",
        "a product in Q15 whose top is lost",  # -1 by -1 is 1, which Q15 does not have
        (("Product", (-32768, -32768)),),
        """
def Product(a: int16, b: int16) -> int16:
    return int16(int32(a) * b >> 15)  # <-
""",
        """
def Product(a: int16, b: int16) -> int16:
    c: int32
    c = int32(a) * b >> 15
    return 32767 if c > 32767 else int16(c)
""",
    ),
    Pair(
        "float-argument",
        "volts are passed for a code",
        (("Use", (2.5,)),),
        """
Code: uint16 = 0
def Set(code: uint16) -> void:
    Code = code
def Use(volts: float32) -> uint16:
    Set(volts)  # <-
    return Code
""",
        """
Code: uint16 = 0
def Set(code: uint16) -> void:
    Code = code
def Use(volts: float32) -> uint16:
    i: int16
    for i in range(9):
        Set(i * volts * 4095 / 3000)
    return Code
""",
    ),
    Pair(
        "memcpy-outside",
        "a text longer than its member",
        (("Use", ()),),
        """
class MOTOR(struct):
    name: array[char, 4]
    limit: int16
Motor: MOTOR = ("", 7)
def Rename(to: ptr[char], name: ptr[char]) -> void:
    strcpy(to, name)  # <-
def Use() -> int16:
    Rename(Motor.name, "belt")
    return Motor.limit
""",
        """
class MOTOR(struct):
    name: array[char, 4]
    limit: int16
Motor: MOTOR = ("", 7)
def Rename(to: ptr[char], name: ptr[char]) -> void:
    strcpy(to, name)
def Use() -> int16:
    Rename(Motor.name, "arm")
    return Motor.limit
""",
    ),
    Pair(
        "pointer-outside",
        "a text in a member without an end",
        (("Use", ()),),
        """
class MOTOR(struct):
    name: array[char, 4]
    limit: int16
Motor: MOTOR = ("", 7)
def Use() -> int16:
    strncpy(Motor.name, "belt", 4)
    return int16(strlen(Motor.name))  # <-
""",
        """
class MOTOR(struct):
    name: array[char, 4]
    limit: int16
Motor: MOTOR = ("", 7)
def Use() -> int16:
    strncpy(Motor.name, "belt", 3)
    Motor.name[3] = 0
    return int16(strlen(Motor.name))
""",
    ),
    Pair(
        "unsigned-wrap",
        "a sum that outlives its function wraps, and a copy of it is divided",
        (("Sample", (40000,)), ("Sample", (30000,)), ("Begin", ()), ("Octets", (40000,))),
        """
Sum: uint16 = 0
Count: uint16 = 0
Whole: uint32 = 0
def Sample(level: uint16) -> uint32:
    Sum += level  # <-
    Count += 1
    if Count >= 4:
        Whole = Sum
        Sum = 0
        Count = 0
    return Whole / 4
def Begin() -> uint16:
    return 0
def Octets(level: uint16) -> uint16:
    return level
""",
        """
Sum: uint32 = 0
Check: uint16 = 0
Ticks: uint16 = 0
Phase: uint16 = 0
Count: uint16 = 0
Whole: uint32 = 0
def Sample(level: uint16) -> uint32:
    Sum += level
    Check += level
    Ticks += 40000
    Count += 1
    if Count >= 4:
        Whole = Sum
        Sum = 0
        Count = 0
    return Whole / 4 + Ticks / 1000
def Tone(step: uint16) -> float32:
    Phase += step
    return Phase * 0.0001
def Begin() -> float32:
    Phase = 0
    Tone(40000)
    return Tone(40000)
def Octets(level: uint16) -> uint16:
    Check = 0
    Ticks = 0
    Sample(level)
    return (Check >> 8) + (Check & 0xFF)
""",
    ),
)
