"""Correct code for one construct of C each: operators, constants, conversions."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Driver

DRIVERS: Final = (
    Driver(
        "enum expr",
        "f",
        (((), 9),),
        """
class E(enum):
    A = -1
    B = 1 << 3
    C = B + 2
    N = 3
v: array[int16, E.N]
w: array[int16, E.N * 2 - 1]
def f() -> int16:
    e: E = E.C
    v[0] = e
    w[4] = E.A
    return v[0] + w[4]
""",
    ),
    Driver(
        "sizeof ratio",
        "f",
        (((), 15),),
        """
v: array[int16, 5] = (1, 2, 3, 4, 5)
def f() -> int16:
    i: int16
    s: int16 = 0
    for i in range(sizeof(v) / sizeof(v[0])):
        s += v[i]
    return s
""",
    ),
    Driver(
        "while sizeof",
        "f",
        (((), 15.0),),
        """
v: array[float32, 5] = (1, 2, 3, 4, 5)
def f() -> float32:
    i: uint16 = 0
    s: float32 = 0
    while i < sizeof(v) / sizeof(float32):
        s += v[i]
        i += 1
    return s
""",
    ),
    Driver(
        "compound ops",
        "f",
        (((), 88),),
        """
def f() -> int16:
    x: uint16 = 0xF0
    x |= 0x0F
    x &= ~0x3C
    x ^= 1
    x <<= 2
    x >>= 1
    x %= 100
    return int16(x)
""",
    ),
    Driver(
        "char arith",
        "f",
        (((), 123),),
        """
s: array[char, 4] = "7b"
def hexv(c: char) -> int16:
    if c >= '0' and c <= '9':
        return c - '0'
    if c >= 'a' and c <= 'f':
        return c - 'a' + 10
    return -1
def f() -> int16:
    return hexv(s[0]) * 16 + hexv(s[1])
""",
    ),
    Driver(
        "math",
        "f",
        (((), 22.0),),
        """
def f() -> float32:
    return floor(2.7) + ceil(2.1) + sqrt(16.0) + pow(2.0, 3.0) + fmod(7.0, 4.0) + labs(-2)
""",
    ),
    Driver(
        "uint32 mix",
        "f",
        (((), 2882343476),),
        """
def f() -> uint32:
    a: uint16 = 0xABCD
    b: uint16 = 0x1234
    return (uint32(a) << 16) | b
""",
    ),
    Driver(
        "float32 cast int pun",
        "f",
        (((), 1065353216),),
        """
x: float32 = 1.0
def f() -> uint32:
    p: ptr[uint32]
    p = cast(ptr[uint32], addressof(x))
    return p[0]
""",
    ),
    Driver(
        "neg shift right",
        "f",
        (((-9,), -3),),
        """
def f(x: int16) -> int16:
    return x >> 2
""",
    ),
    Driver(
        "ulong wrap compare",
        "f",
        (((20,), 1),),
        """
t0: uint32 = 0xFFFFFFF0
def f(now: uint32) -> int16:
    return 1 if now - t0 >= 32 else 0
""",
    ),
    Driver(
        "uint wrap timeout",
        "f",
        (((50, 65500), 0),),
        """
def f(now: uint16, start: uint16) -> int16:
    return 1 if uint16(now - start) > 100 else 0
""",
    ),
    Driver(
        "uint wrap timeout no cast",
        "f",
        (((50, 65500), 0),),
        """
def f(now: uint16, start: uint16) -> int16:
    return 1 if now - start > 100 else 0
""",
    ),
    Driver(
        "parity & masks",
        "f",
        (((4660,), 1),),
        """
def f(x: uint16) -> uint16:
    x ^= x >> 8
    x ^= x >> 4
    return (0x6996 >> (x & 0xF)) & 1
""",
    ),
    Driver(
        "seq number uchar",
        "f",
        (((), 44),),
        """
seq: uchar = 0
def f() -> int16:
    i: int16
    for i in range(300):
        seq = (seq + 1) & 0xFF
    return seq
""",
    ),
    Driver(
        "deg",
        "f",
        (((90.0,), 0.0),),
        """
PI = 3.14159265
def f(d: float32) -> float32:
    r: float32
    r = d * PI / 180.0
    return r * 0
""",
    ),
    Driver(
        "hex const assign",
        "f",
        (((), -1),),
        """
def f() -> int16:
    x: int16 = 0xFF00
    return x >> 8
""",
    ),
    Driver(
        "bit15",
        "f",
        (((15,), 32768),),
        """
def f(n: uint16) -> uint16:
    return 1 << n
""",
    ),
    Driver(
        "running average float int mix",
        "f",
        (((), 1.5),),
        """
n: int16 = 0
acc: float32 = 0
def f() -> float32:
    i: int16
    for i in range(4):
        acc += i
        n += 1
    return acc / n
""",
    ),
    Driver(
        "percent int",
        "f",
        (((700, 1000), 70),),
        """
def f(a: uint16, total: uint16) -> uint16:
    return uint16(uint32(a) * 100 / total)
""",
    ),
)
