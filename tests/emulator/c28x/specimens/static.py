"""Specimens of what the typed tree shows."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Pair


def pair(rule: str, name: str, defect: str, correct: str, *calls: tuple[str, tuple[float, ...]]) -> Pair:
    """A pair whose finding is static."""
    return Pair(rule, name, calls, defect, correct, how="static")


PAIRS: Final = (
    pair(
        "maybe-uninitialised",
        "one branch sets no value",
        """
def Limit(x: int16) -> int16:
    y: int16
    if x > 10:
        y = 10
    elif x > 0:
        y = x
    return y  # <-
""",
        """
def Limit(x: int16) -> int16:
    y: int16
    if x > 10:
        y = 10
    elif x > 0:
        y = x
    else:
        y = 0
    return y
""",
        ("Limit", (5,)),
    ),
    pair(
        "maybe-uninitialised",
        "a search that may find nothing",
        """
v: array[int16, 4] = (1, 2, 3, 4)
def Find(x: int16) -> int16:
    i: int16
    place: int16
    for i in range(4):
        if v[i] == x:
            place = i
    return place  # <-
""",
        """
v: array[int16, 4] = (1, 2, 3, 4)
def Find(x: int16) -> int16:
    i: int16
    place: int16
    found: int16 = 0
    for i in range(4):
        if v[i] == x:
            place = i
            found = 1
    if found:
        return place
    return -1
""",
        ("Find", (3,)),
    ),
    pair(
        "maybe-uninitialised",
        "a loop that may not turn",
        """
def Last(n: int16) -> int16:
    i: int16
    x: int16
    for i in range(n):
        x = i * 2
    return x  # <-
""",
        """
def Last(n: int16) -> int16:
    i: int16
    x: int16
    x = 0
    for i in range(n):
        x = i * 2
    return x
""",
        ("Last", (3,)),
    ),
    pair(
        "missing-return",
        "the last case returns nothing",
        """
def Sign(x: int16) -> int16:
    if x > 0:
        return 1
    if x < 0:
        return -1  # <-
""",
        """
def Sign(x: int16) -> int16:
    if x > 0:
        return 1
    if x < 0:
        return -1
    return 0
""",
        ("Sign", (5,)),
    ),
    pair(
        "switch-no-default",
        "a mode that no case knows",
        """
def Speed(mode: int16) -> float32:
    v: float32
    match mode:  # <-
        case 0:
            v = 0.0
        case 1:
            v = 0.5
    return v
""",
        """
def Speed(mode: int16) -> float32:
    v: float32
    match mode:
        case 0:
            v = 0.0
        case 1:
            v = 0.5
        case _:
            v = 0.0
    return v
""",
        ("Speed", (1,)),
    ),
    pair(
        "dead-store",
        "a filtered value is thrown away",
        """
def Filter(x: float32, old: float32) -> float32:
    y: float32
    y = 0.9 * old + 0.1 * x  # <-
    y = x
    return y
""",
        """
def Filter(x: float32, old: float32) -> float32:
    y: float32
    y = 0.9 * old + 0.1 * x
    return y
""",
        ("Filter", (1.0, 2.0)),
    ),
    pair(
        "dead-store",
        "a parameter is changed to return a value",
        """
def Next(x: int16, step: int16) -> int16:
    x = x + step  # <-
    return step
""",
        """
def Next(x: int16, step: int16) -> int16:
    x = x + step
    return x
""",
        ("Next", (1, 2)),
    ),
    pair(
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
    pair(
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
    pair(
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
    pair(
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
    pair(
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
    pair(
        "unreachable",
        "a statement behind the return",
        """
Busy: int16 = 1
def Stop() -> int16:
    return 1
    Busy = 0  # <-
""",
        """
Busy: int16 = 1
def Stop() -> int16:
    Busy = 0
    return 1
""",
        ("Stop", ()),
    ),
    pair(
        "unreachable",
        "a case that stands there twice",
        """
def Turn(order: int16) -> int16:
    r: int16
    match order:
        case 1:
            r = 10
        case 2:
            r = 20
        case 1:
            r = 30  # <-
        case _:
            r = 0
    return r
""",
        """
def Turn(order: int16) -> int16:
    r: int16
    match order:
        case 1:
            r = 10
        case 2:
            r = 20
        case 3:
            r = 30
        case _:
            r = 0
    return r
""",
        ("Turn", (1,)),
    ),
    pair(
        "never-called",
        "an initialisation is forgotten",
        """
Gain: float32 = 0
def Init() -> void:  # <-
    Gain = 2.0
def main() -> int16:
    return int16(Gain)
""",
        """
Gain: float32 = 0
def Init() -> void:
    Gain = 2.0
def main() -> int16:
    Init()
    return int16(Gain)
""",
        ("main", ()),
    ),
    pair(
        "unused-parameter",
        "the timeout is ignored",
        """
Ready: int16 = 1
def Wait(timeout: int16) -> int16:  # <-
    return Ready
""",
        """
Ready: int16 = 1
def Wait(timeout: int16) -> int16:
    return Ready if timeout > 0 else 0
""",
        ("Wait", (1,)),
    ),
    pair(
        "unused-object",
        "a local that was forgotten",
        """
def Sum(a: int16, b: int16) -> int16:
    result: int16  # <-
    return a + b
""",
        """
def Sum(a: int16, b: int16) -> int16:
    result: int16
    result = a + b
    return result
""",
        ("Sum", (1, 2)),
    ),
    pair(
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
    pair(
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
    pair(
        "hidden-name",
        "a parameter hides the object that is meant",
        """
Speed: float32 = 0
def Set(Speed: float32) -> float32:  # <-
    return Speed
def Get() -> float32:
    return Speed
""",
        """
Speed: float32 = 0
def Set(speed: float32) -> float32:
    Speed = speed
    return Speed
def Get() -> float32:
    return Speed
""",
        ("Set", (1.0,)),
    ),
    pair(
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
    pair(
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
    pair(
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
    pair(
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
    pair(
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
    pair(
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
    pair(
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
