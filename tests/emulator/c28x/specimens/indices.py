"""Specimens of indices outside an array, or wrapped into it."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Pair

PAIRS: Final = (
    Pair(
        "index",
        "the element before the first one, unsigned index",
        (("Smooth", ()),),
        """
v: array[float32, 6] = (1, 2, 3, 4, 5, 6)
def Smooth() -> float32:
    i: uint16
    s: float32 = 0
    for i in range(6):
        s += v[i] - v[i - 1]  # <-
    return s
""",
        """
v: array[float32, 6] = (1, 2, 3, 4, 5, 6)
def Smooth() -> float32:
    i: uint16
    s: float32 = 0
    for i in range(1, 6):
        s += v[i] - v[i - 1]
    return s
""",
    ),
    Pair(
        "index",
        "one element too many is written",
        (("Clear", ()),),
        """
N = 8
Table: array[int16, 8]
def Clear() -> int16:
    i: int16 = 0
    while i <= N:
        Table[i] = 0  # <-
        i += 1
    return Table[0]
""",
        """
N = 8
Table: array[int16, 8]
def Clear() -> int16:
    i: int16 = 0
    while i < N:
        Table[i] = 0
        i += 1
    return Table[0]
""",
    ),
    Pair(
        "index",
        "the inner subscript of a matrix leaves its row",
        (("Trace", ()),),
        """
M: array[array[int16, 3], 2] = ((1, 2, 3), (4, 5, 6))
def Trace() -> int16:
    r: int16
    c: int16
    s: int16 = 0
    for r in range(2):
        for c in range(4):
            if r + c < 4:
                s += M[r][c]  # <-
    return s
""",
        """
M: array[array[int16, 3], 2] = ((1, 2, 3), (4, 5, 6))
def Trace() -> int16:
    r: int16
    c: int16
    s: int16 = 0
    for r in range(2):
        for c in range(3):
            s += M[r][c]
    return s
""",
    ),
    Pair(
        "index",
        "rows and columns are exchanged in a local matrix",
        (("Fill", ()),),
        """
def Fill() -> int16:
    m: array[array[int16, 4], 2]
    r: int16
    c: int16
    for r in range(2):
        for c in range(4):
            m[r][c] = 0
    for r in range(4):
        for c in range(2):
            m[r][c] = r  # <-
    return m[1][1]
""",
        """
def Fill() -> int16:
    m: array[array[int16, 4], 2]
    r: int16
    c: int16
    for r in range(2):
        for c in range(4):
            m[r][c] = 0
    for r in range(2):
        for c in range(4):
            m[r][c] = r
    return m[1][1]
""",
    ),
    Pair(
        "unsigned-wrap-index",
        "the place before the first one in a ring of ten",
        (("Previous", (0,)),),
        """
Ring: array[int16, 10] = (0, 1, 2, 3, 4, 5, 6, 7, 8, 9)
def Previous(head: uint16) -> int16:
    return Ring[(head - 1) % 10]  # <-
""",
        """
Ring: array[int16, 10] = (0, 1, 2, 3, 4, 5, 6, 7, 8, 9)
def Previous(head: uint16) -> int16:
    return Ring[(head + 9) % 10]
""",
    ),
    Pair(
        "unsigned-wrap-index",
        "a product wraps and lies inside by luck",
        (("At", (300, 220)),),
        """
Map: array[int16, 512] = (7,)
def At(row: uint16, width: uint16) -> int16:
    return Map[row * width]  # <-
""",
        """
Map: array[int16, 512] = (7,)
def At(row: uint16, width: uint16) -> int16:
    place: uint32
    place = uint32(row) * width
    if place >= 512:
        return 0
    return Map[uint16(place)]
""",
    ),
)
