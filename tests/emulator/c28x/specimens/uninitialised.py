"""Specimens of objects that are read before they are written."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Pair

PAIRS: Final = (
    Pair(
        "uninitialised",
        "a structure is copied of which nothing was written",
        (("Load", (0,)),),
        """
class SETTINGS(struct):
    gain: int16
    offset: int16
Settings: SETTINGS = [1, 0]
def Read(out: ptr[SETTINGS], there: int16) -> void:
    if there:
        out.gain = 7
def Load(there: int16) -> int16:
    read: SETTINGS
    Read(addressof(read), there)
    Settings = read  # <-
    return 1
""",
        """
class SETTINGS(struct):
    gain: int16
    offset: int16
Settings: SETTINGS = [1, 0]
def Read(out: ptr[SETTINGS], there: int16) -> int16:
    out.gain = 7
    return there
def Load(there: int16) -> int16:
    read: SETTINGS
    if Read(addressof(read), there):
        return 0
    Settings = read
    return Settings.gain
""",
    ),
    Pair(
        "uninitialised",
        "accumulator without a start value",
        (("Mean", ()),),
        """
data: array[float32, 4] = (1, 2, 3, 4)
def Mean() -> float32:
    sum: float32
    i: int16
    for i in range(4):
        sum += data[i]  # <-
    return sum / 4
""",
        """
data: array[float32, 4] = (1, 2, 3, 4)
def Mean() -> float32:
    sum: float32 = 0
    i: int16
    for i in range(4):
        sum += data[i]
    return sum / 4
""",
    ),
    Pair(
        "uninitialised",
        "one element of a local table is left out",
        (("Peak", ()),),
        """
def Peak() -> int16:
    w: array[int16, 4]
    i: int16
    best: int16 = 0
    for i in range(1, 4):
        w[i] = i * 2
    for i in range(4):
        if w[i] > best:  # <-
            best = w[i]
    return best
""",
        """
def Peak() -> int16:
    w: array[int16, 4]
    i: int16
    best: int16 = 0
    for i in range(4):
        w[i] = i * 2
    for i in range(4):
        if w[i] > best:
            best = w[i]
    return best
""",
    ),
    Pair(
        "uninitialised",
        "a member of a structure is never set",
        (("Step", ()),),
        """
class PID(struct):
    kp: float32
    ki: float32
    integral: float32
def Run(p: ptr[PID], e: float32) -> float32:
    p.integral = p.integral + e * p.ki  # <-
    return p.kp * e + p.integral
def Step() -> float32:
    c: PID
    c.kp = 2.0
    c.ki = 0.5
    return Run(addressof(c), 1.0)
""",
        """
class PID(struct):
    kp: float32
    ki: float32
    integral: float32
def Run(p: ptr[PID], e: float32) -> float32:
    p.integral = p.integral + e * p.ki
    return p.kp * e + p.integral
def Step() -> float32:
    c: PID
    c.kp = 2.0
    c.ki = 0.5
    c.integral = 0.0
    return Run(addressof(c), 1.0)
""",
    ),
    Pair(
        "uninitialised",
        "strlen of a buffer that nobody filled",
        (("Length", ()),),
        """
Buffer: array[char, 8]
def Length() -> uint16:
    return uint16(strlen(Buffer))  # <-
""",
        """
Buffer: array[char, 8]
def Length() -> uint16:
    Buffer[0] = 'o'
    Buffer[1] = 'k'
    Buffer[2] = 0
    return uint16(strlen(Buffer))
""",
    ),
    Pair(
        "uninitialised",
        "a number is read from a buffer whose end is not set",
        (("Value", ()),),
        """
Text: array[char, 6]
def Value() -> float32:
    Text[0] = '4'
    Text[1] = '2'
    return atof(Text)  # <-
""",
        """
Text: array[char, 6]
def Value() -> float32:
    Text[0] = '4'
    Text[1] = '2'
    Text[2] = 0
    return atof(Text)
""",
    ),
    Pair(
        "uninitialised",
        "memcpy from a table that was never written",
        (("Save", ()),),
        """
Now: array[float32, 3]
Old: array[float32, 3] = (0, 0, 0)
def Save() -> float32:
    memcpy(Old, Now, sizeof(Now))  # <-
    return Old[0] * 0
""",
        """
Now: array[float32, 3]
Old: array[float32, 3] = (0, 0, 0)
def Save() -> float32:
    Now[0] = 1.0
    Now[1] = 2.0
    Now[2] = 3.0
    memcpy(Old, Now, sizeof(Now))
    return Old[2]
""",
    ),
    Pair(
        "uninitialised",
        "a local of a loop is meant to keep its value",
        (("Count", ()),),
        """
def Count() -> int16:
    i: int16
    total: int16 = 0
    for i in range(3):
        n: int16
        if i == 0:
            n = 5
        total += n  # <-
    return total
""",
        """
def Count() -> int16:
    i: int16
    total: int16 = 0
    for i in range(3):
        n: int16
        n = 5
        total += n
    return total
""",
    ),
)
