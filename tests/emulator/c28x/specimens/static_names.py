"""Specimens of what `static_names` shows: values, objects and functions that nobody uses, names that hide."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import static_pair

PAIRS: Final = (
    static_pair(
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
    static_pair(
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
    static_pair(
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
    static_pair(
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
    static_pair(
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
    static_pair(
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
)
