"""Specimens of memory defects."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Pair

PAIRS: Final = (
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
    Pair(
        "pointer-outside",
        "a pointer walks past the terminator",
        (("Find", ()),),
        """
Text: array[char, 4] = "ab"
Next: array[char, 4] = "x,y"
def Find() -> int16:
    p: ptr[char]
    n: int16 = 0
    p = Text
    while p[0] != ',':  # <-
        p += 1
        n += 1
    return n
""",
        """
Text: array[char, 4] = "ab"
def Find() -> int16:
    p: ptr[char]
    n: int16 = 0
    p = Text
    while p[0] != ',' and p[0] != 0:
        p += 1
        n += 1
    return n
""",
    ),
    Pair(
        "pointer-outside",
        "a float taken apart into four characters",
        (("Send", ()),),
        """
Speed: float32 = 1.5
Out: array[uint16, 4]
def Send() -> uint16:
    p: ptr[uchar]
    i: int16
    p = cast(ptr[uchar], addressof(Speed))
    for i in range(4):
        Out[i] = p[i]  # <-
    return Out[0]
""",
        """
Speed: float32 = 1.5
Out: array[uint16, 4]
def Send() -> uint16:
    p: ptr[uint16]
    i: int16
    p = cast(ptr[uint16], addressof(Speed))
    for i in range(2):
        Out[2 * i] = p[i] & 0xFF
        Out[2 * i + 1] = p[i] >> 8
    return Out[0]
""",
    ),
    Pair(
        "null-dereference",
        "a pointer that nobody has set",
        (("Tick", ()),),
        """
Counter: ptr[int16] = NULL
def Tick() -> int16:
    Counter[0] = 1  # <-
    return Counter[0]
""",
        """
Count: int16 = 0
Counter: ptr[int16] = NULL
def Tick() -> int16:
    Counter = addressof(Count)
    Counter[0] = 1
    return Counter[0]
""",
    ),
    Pair(
        "null-dereference",
        "a lookup that finds nothing",
        (("Gain", (9,)),),
        """
class ENTRY(struct):
    key: int16
    gain: int16
Entries: array[ENTRY, 2] = ((1, 10), (2, 20))
def Find(key: int16) -> ptr[ENTRY]:
    i: int16
    for i in range(2):
        if Entries[i].key == key:
            return addressof(Entries[i])
    return NULL
def Gain(key: int16) -> int16:
    return Find(key).gain  # <-
""",
        """
class ENTRY(struct):
    key: int16
    gain: int16
Entries: array[ENTRY, 2] = ((1, 10), (2, 20))
def Find(key: int16) -> ptr[ENTRY]:
    i: int16
    for i in range(2):
        if Entries[i].key == key:
            return addressof(Entries[i])
    return NULL
def Gain(key: int16) -> int16:
    e: ptr[ENTRY]
    e = Find(key)
    return e.gain if e != NULL else 0
""",
    ),
    Pair(
        "write-to-constant",
        "a string literal is changed",
        (("Mark", ()),),
        """
def Mark() -> int16:
    p: ptr[char]
    p = "idle"
    p[0] = 'I'  # <-
    return p[1]
""",
        """
Label: array[char, 8] = "idle"
def Mark() -> int16:
    p: ptr[char]
    p = Label
    p[0] = 'I'
    return p[1]
""",
    ),
    Pair(
        "odd-access",
        "a long inside a stream of words",
        (("Get", ()),),
        """
Stream: array[uint16, 6] = (1, 2, 3, 4, 5, 6)
def Get() -> int32:
    p: ptr[int32]
    p = cast(ptr[int32], addressof(Stream[1]))
    return p[0]  # <-
""",
        """
Stream: array[uint16, 6] = (1, 2, 3, 4, 5, 6)
def Get() -> int32:
    return int32(uint32(Stream[2]) << 16 | Stream[1])
""",
    ),
    Pair(
        "memcpy-octets",
        "four octets a float",
        (("Copy", ()),),
        """
Samples: array[float32, 6] = (1, 2, 3, 4, 5, 6)
Sorted: array[float32, 6]
def Copy() -> float32:
    memcpy(Sorted, Samples, 4 * 6)  # <-
    return Sorted[5]
""",
        """
Samples: array[float32, 6] = (1, 2, 3, 4, 5, 6)
Sorted: array[float32, 6]
def Copy() -> float32:
    memcpy(Sorted, Samples, sizeof(Samples))
    return Sorted[5]
""",
    ),
    Pair(
        "memcpy-octets",
        "the octets of one float",
        (("Pack", ()),),
        """
Angle: float32 = 0.5
Frame: array[char, 16]
def Pack() -> int16:
    memcpy(Frame, addressof(Angle), 4)  # <-
    return Frame[1]
""",
        """
Angle: float32 = 0.5
Frame: array[char, 16]
def Pack() -> int16:
    memcpy(Frame, addressof(Angle), sizeof(float32))
    return Frame[1]
""",
    ),
    Pair(
        "memcpy-outside",
        "a block longer than its target",
        (("Load", ()),),
        """
Source: array[int16, 10] = (1, 2, 3, 4, 5, 6, 7, 8, 9, 10)
Target: array[int16, 7]
After: int16 = 0
def Load() -> int16:
    memcpy(Target, Source, 10)  # <-
    return Target[0] + After
""",
        """
Source: array[int16, 10] = (1, 2, 3, 4, 5, 6, 7, 8, 9, 10)
Target: array[int16, 7]
After: int16 = 0
def Load() -> int16:
    memcpy(Target, Source, 7)
    return Target[0] + After
""",
    ),
    Pair(
        "dangling-pointer",
        "a function returns the address of its local",
        (("Use", ()),),
        """
def Make() -> ptr[int16]:
    v: array[int16, 3]
    v[0] = 7
    v[1] = 8
    v[2] = 9
    return v
def Use() -> int16:
    p: ptr[int16]
    p = Make()
    return p[1]  # <-
""",
        """
Store: array[int16, 3]
def Make() -> ptr[int16]:
    Store[0] = 7
    Store[1] = 8
    Store[2] = 9
    return Store
def Use() -> int16:
    p: ptr[int16]
    p = Make()
    return p[1]
""",
    ),
    Pair(
        "dangling-pointer",
        "a file-scope pointer to a buffer that has gone",
        (("Start", ()), ("Send", ())),
        """
Data: ptr[char] = NULL
def Start() -> void:
    text: array[char, 3] = "ok"
    Data = text
def Send() -> int16:
    return Data[0]  # <-
""",
        """
Text: array[char, 3] = "ok"
Data: ptr[char] = NULL
def Start() -> void:
    Data = Text
def Send() -> int16:
    return Data[0]
""",
    ),
)
