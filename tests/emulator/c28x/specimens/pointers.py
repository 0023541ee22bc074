"""Specimens of pointers and blocks: outside, null, dangling, to constants, odd, counted in octets."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Pair

PAIRS: Final = (
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
        "called-as-another",
        "a handler that wants an argument, called without one",
        (("Run", ()),),
        """
HANDLER = funcptr[int16]
def _Scaled(by: int16) -> int16:
    return 3 * by
def Run() -> int16:
    handler: HANDLER
    handler = cast(HANDLER, _Scaled)
    return handler()  # <-
""",
        """
HANDLER = funcptr[int16, int16]
def _Scaled(by: int16) -> int16:
    return 3 * by
def Run() -> int16:
    handler: HANDLER
    handler = _Scaled
    return handler(2)
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
