"""Specimens of divisions, of floats that do not fit or are no numbers."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Pair

PAIRS: Final = (
    Pair(
        "remainder-lost",
        "a ratio of counts",
        (("Ratio", (3, 4)),),
        """
def Ratio(a: int16, b: int16) -> float32:
    r: float32
    r = a / b  # <-
    return r
""",
        """
def Ratio(a: int16, b: int16) -> float32:
    r: float32
    r = float32(a) / b
    return r
""",
    ),
    Pair(
        "remainder-lost",
        "a rate in coarse units; in fine ones nothing is missed",
        (("Rate", (30011,)),),
        """
def Rate(counts: int16) -> float32:
    r: float32
    r = counts / 7000  # <-
    return r
""",
        """
def Rate(counts: int16) -> float32:
    r: float32
    r = counts / 70
    return r
""",
    ),
    Pair(
        "remainder-lost",
        "a speed whose unit is too coarse; one that was large before it fell",
        (("Speed", (700000,)), ("Speed", (41881986,))),
        """
def Speed(period: uint32) -> float32:
    r: float32
    r = uint32(3000000) / period  # <-
    return r
""",
        """
def Speed(period: uint32) -> float32:
    r: float32
    r = uint32(3000000000) / period
    return r
""",
    ),
    Pair(
        "remainder-lost",
        "a code is divided by its full scale before it is scaled; whole pages of 4096 words",
        (("Angle", (1000,)), ("Angle", (2730,))),
        """
Pages: uint32 = 0
def Angle(code: uint16) -> int16:
    degrees: int16
    degrees = int16(uint32(code) / 4095 * 120) - 60  # <-
    return degrees
""",
        """
Pages: uint32 = 0
def Angle(code: uint16) -> int16:
    degrees: int16
    degrees = int16(uint32(code) * 120 / 4095) - 60
    Pages = uint32(code) / 4096 * 4096
    Pages = Pages + uint32(code) / 1000 * 3
    return degrees
""",
    ),
    Pair(
        "remainder-lost",
        "a float is cut before it is scaled; digits are taken apart so",
        (("Show", (21.75,)),),
        """
Tenths: uint16 = 0
Digit: int16 = 0
def Show(celsius: float32) -> uint16:
    Tenths = uint16(celsius) * 10  # <-
    return Tenths
""",
        """
Tenths: uint16 = 0
Digit: int16 = 0
def Show(celsius: float32) -> uint16:
    Tenths = uint16(celsius * 10.0)
    Digit = int16(celsius * 10.0) - int16(celsius) * 10
    return Tenths
""",
    ),
    Pair(
        "remainder-lost",
        "a measured float is cut in front of its unit; whole ones lose nothing",
        (("Set", (2.5,)), ("Set", (3.0,))),
        """
Period: uint32 = 0
def Set(seconds: float32) -> uint32:
    Period = uint32(uint16(seconds)) * 1000  # <-
    return Period
""",
        """
Period: uint32 = 0
def Set(seconds: float32) -> uint32:
    whole: float32
    whole = 4.0 if seconds < 4.0 else 5.0
    Period = uint32(uint16(whole)) * 1000
    return Period
""",
    ),
    Pair(
        "float-to-int",
        "a temperature beyond the range of int",
        (("Scale", (900.0,)),),
        """
def Scale(t: float32) -> int16:
    return int16(t * 100.0)  # <-
""",
        """
def Scale(t: float32) -> int16:
    return int16(t * 10.0)
""",
    ),
    Pair(
        "division-by-zero",
        "a period that was not measured yet",
        (("Speed", (0,)),),
        """
def Speed(period: uint16) -> uint16:
    return 60000 / period  # <-
""",
        """
def Speed(period: uint16) -> uint16:
    if period == 0:
        return 0
    return uint16(60000 / period)
""",
    ),
    Pair(
        "division-by-zero",
        "a float distance of zero",
        (("Inverse", (0.0,)),),
        """
def Inverse(d: float32) -> float32:
    return 1.0 / d  # <-
""",
        """
def Inverse(d: float32) -> float32:
    return 1.0 / d if d > 0.01 else 100.0
""",
    ),
    Pair(
        "nan",
        "infinity minus infinity",
        (("Noise", (3e38,)),),
        """
def Noise(x: float32) -> float32:
    y: float32
    y = x * 10.0  # <-
    return y - y
""",
        """
def Noise(x: float32) -> float32:
    y: float32
    y = x * 0.1
    return y - y
""",
        watch=True,
    ),
    Pair(
        "nan-output",
        "a quotient without a value reaches the shared state",
        (("Update", (0.0,)),),
        """
Rate: float32 = 0
def Update(dt: float32) -> float32:
    Rate = 0.0 / dt  # <-
    return dt
""",
        """
Rate: float32 = 0
def Update(dt: float32) -> float32:
    if dt > 0.0:
        Rate = 1.0 / dt
    return dt
""",
        watch=True,
    ),
    Pair(
        "remainder-lost",
        "a percentage",
        (("Percent", (30, 40)),),
        """
def Percent(part: int16, whole: int16) -> int16:
    return part / whole * 100  # <-
""",
        """
def Percent(part: int16, whole: int16) -> int16:
    return int16(int32(part) * 100 / whole)
""",
    ),
)
