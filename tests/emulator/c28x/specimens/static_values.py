"""Specimens of what `static_values` shows: conditions, constants, divisions, signs."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import static_pair

PAIRS: Final = (
    static_pair(
        "constant-condition",
        "a range as in mathematics",
        """
def Inside(d: float32) -> int16:
    if (25 < d) < 90:  # <-
        return 1
    return 0
""",
        """
def Inside(d: float32) -> int16:
    if 25 < d and d < 90:
        return 1
    return 0
""",
        ("Inside", (30.0,)),
    ),
    static_pair(
        "constant-condition",
        "counting an unsigned down to below zero",
        """
def Down(n: uint16) -> uint16:
    sum: uint16 = 0
    while n >= 0:  # <-
        sum = sum + n
        if sum > 100:
            return 0
        n -= 1
    return sum
""",
        """
def Down(n: uint16) -> uint16:
    sum: uint16 = 0
    while n > 0:
        sum = sum + n
        n -= 1
    return sum
""",
        ("Down", (4,)),
    ),
    static_pair(
        "constant-condition",
        "an int is never above 40000",
        """
def Full(x: int16) -> int16:
    if x > 40000:  # <-
        return 1
    return 0
""",
        """
def Full(x: uint16) -> int16:
    if x > 40000:
        return 1
    return 0
""",
        ("Full", (5,)),
    ),
    static_pair(
        "constant-condition",
        "or where and is meant",
        """
def Known(mode: int16) -> int16:
    if mode != 1 or mode != 2:  # <-
        return 0
    return 1
""",
        """
def Known(mode: int16) -> int16:
    if mode != 1 and mode != 2:
        return 0
    return 1
""",
        ("Known", (1,)),
    ),
    static_pair(
        "constant-condition",
        "a limit below its lower end",
        """
def Band(x: int16) -> int16:
    if x > 100 and x < 50:  # <-
        return 1
    return 0
""",
        """
def Band(x: int16) -> int16:
    if x > 50 and x < 100:
        return 1
    return 0
""",
        ("Band", (60,)),
    ),
    static_pair(
        "assignment-loses",
        "a gain with a fraction in an int",
        """
def Gain(x: int16) -> int16:
    k: int16 = 0.75  # <-
    return k * x
""",
        """
def Gain(x: int16) -> int16:
    k: float32 = 0.75
    return int16(k * x)
""",
        ("Gain", (4,)),
    ),
    static_pair(
        "assignment-loses",
        "a file-scope limit that does not fit",
        """
Limit: int16 = 50000  # <-
def Get() -> int16:
    return Limit
""",
        """
Limit: uint16 = 50000
def Get() -> uint16:
    return Limit
""",
        ("Get", ()),
    ),
    static_pair(
        "integer-division-in-float",
        "one half that is zero",
        """
def Kinetic(m: float32, v: float32) -> float32:
    return 1 / 2 * m * v * v  # <-
""",
        """
def Kinetic(m: float32, v: float32) -> float32:
    return 1.0 / 2 * m * v * v
""",
        ("Kinetic", (1.0, 2.0)),
    ),
    static_pair(
        "float-equality",
        "a target that is never met exactly",
        """
def Arrived(x: float32, target: float32) -> int16:
    return x == target  # <-
""",
        """
def Arrived(x: float32, target: float32) -> int16:
    return fabs(x - target) < 0.001
""",
        ("Arrived", (1.0, 1.0)),
    ),
    static_pair(
        "sign-compare",
        "a difference that may be negative",
        """
def Room(size: uint16, used: int16) -> int16:
    left: int16
    left = 10 - used
    if left > size:  # <-
        return 0
    return 1
""",
        """
def Room(size: int16, used: int16) -> int16:
    left: int16
    left = 10 - used
    if left > size:
        return 0
    return 1
""",
        ("Room", (5, 3)),
    ),
    static_pair(
        "octet",
        "bits of an object counted with eight",
        """
def Bits() -> int16:
    return int16(sizeof(float32) * 8)  # <-
""",
        """
BITS_PER_WORD = 16
def Bits() -> int16:
    return int16(sizeof(float32) * BITS_PER_WORD)
""",
        ("Bits", ()),
    ),
    static_pair(
        "mixed-logic",
        "a mask compared before it masks",
        """
READY = 0x10
def Ready(flags: uint16) -> int16:
    if flags & (READY == READY):  # <-
        return 1
    return 0
""",
        """
READY = 0x10
def Ready(flags: uint16) -> int16:
    if (flags & READY) == READY:
        return 1
    return 0
""",
        ("Ready", (0x10,)),
    ),
    static_pair(
        "sign-compare",
        "a character compared with minus one",
        """
def Nothing(c: uchar) -> int16:
    return 1 if c == -1 else 0  # <-
""",
        """
def Nothing(c: uchar) -> int16:
    return 1 if c == 0xFF else 0
""",
        ("Nothing", (0xFF,)),
    ),
    static_pair(
        "integer-division-in-float",
        "a factor of one half in integers",
        """
def Half(x: int16) -> int16:
    return x * (1 / 2)  # <-
""",
        """
def Half(x: int16) -> int16:
    return x / 2
""",
        ("Half", (9,)),
    ),
)
