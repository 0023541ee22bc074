"""Correct drivers that compute: check sums, fixed point, controllers.  Results: published check values, or by hand."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Driver

DRIVERS: Final = (
    Driver(
        "CRC-16/CCITT-FALSE of 123456789",
        "Crc",
        (((), 0x29B1),),
        """
Text: array[char, 10] = "123456789"
def Crc() -> uint16:
    crc: uint16 = 0xFFFF
    i: int16
    k: int16
    for i in range(9):
        crc ^= uint16(Text[i]) << 8
        for k in range(8):
            if crc & 0x8000:
                crc = (crc << 1) ^ 0x1021
            else:
                crc = crc << 1
    return crc
""",
    ),
    Driver(
        "CRC-32 of 123456789",
        "Crc",
        (((), 0xCBF43926),),
        """
Text: array[char, 10] = "123456789"
def Crc() -> uint32:
    crc: uint32 = 0xFFFFFFFF
    i: int16
    k: int16
    for i in range(9):
        crc ^= uint32(Text[i])
        for k in range(8):
            crc = (crc >> 1) ^ 0xEDB88320 if crc & 1 else crc >> 1
    return ~crc
""",
    ),
    Driver(
        "Fletcher-16 of abcde",
        "Sum",
        (((), 0xC8F0),),
        """
Text: array[char, 6] = "abcde"
def Sum() -> uint16:
    low: uint16 = 0
    high: uint16 = 0
    p: ptr[char]
    p = Text
    while p[0] != 0:
        low = (low + p[0]) % 255
        high = (high + low) % 255
        p += 1
    return (high << 8) | low
""",
    ),
    Driver(
        # Q15: 0.5 * 0.5 = 0.25 = 8192; -1 * 0.5 = -16384; saturating sum 32767
        "fixed point Q15",
        "Mul",
        (((16384, 16384), 8192), ((-32768, 16384), -16384)),
        """
def Mul(a: int16, b: int16) -> int16:
    p: int32
    p = int32(a) * b
    p = (p + 0x4000) >> 15
    if p > 32767:
        p = 32767
    return int16(p)
""",
    ),
    Driver(
        # ((1 2)(3 4)) * ((5 6)(7 8)) = ((19 22)(43 50)); trace 69
        "matrices",
        "Trace",
        (((), 69),),
        """
A: const[array[array[int16, 2], 2]] = ((1, 2), (3, 4))
B: const[array[array[int16, 2], 2]] = ((5, 6), (7, 8))
def Trace() -> int16:
    C: array[array[int16, 2], 2]
    i: int16
    j: int16
    k: int16
    for i in range(2):
        for j in range(2):
            C[i][j] = 0
            for k in range(2):
                C[i][j] += A[i][k] * B[k][j]
    return C[0][0] + C[1][1]
""",
    ),
    Driver(
        # the counter wraps between 65530 and 5: 11 counts
        "elapsed counts of a 16-bit timer",
        "Elapsed",
        (((5, 65530), 11.0), ((100, 90), 10.0)),
        """
def Elapsed(now: uint16, then: uint16) -> float32:
    dt: float32
    dt = uint16(now - then) * 1.0
    return dt
""",
    ),
    Driver(
        # 16807 * 1 mod 2^31-1, twice: the published second value 282475249
        "minimal standard random numbers by Schrage",
        "Next",
        (((), 282475249),),
        """
Seed: int32 = 1
def Next() -> int32:
    i: int16
    hi: int32
    lo: int32
    for i in range(2):
        hi = Seed / 127773
        lo = Seed % 127773
        Seed = 16807 * lo - 2836 * hi
        if Seed <= 0:
            Seed += 2147483647
    return Seed
""",
    ),
    Driver(
        # kp e + ki sum e, integral held at 10: 2*3 + 0.5*3 = 7.5
        "PI controller with limits and a structure of state",
        "Step",
        (((3.0,), 7.5), ((100.0,), 50.0)),
        """
class PI(struct):
    kp: float32
    ki: float32
    integral: float32
    low: float32
    high: float32
Wheel: PI = (2.0, 0.5, 0.0, -50.0, 50.0)
def Limit(x: float32, low: float32, high: float32) -> float32:
    return low if x < low else (high if x > high else x)
def Step(e: float32) -> float32:
    c: ptr[PI]
    c = addressof(Wheel)
    c.integral = Limit(c.integral + c.ki * e, -10.0, 10.0)
    return Limit(c.kp * e + c.integral, c.low, c.high)
""",
    ),
    Driver(
        # mean of 10 20 30 40 is 25, in 16 bits with a long sum
        "moving average in integers",
        "Mean",
        (((), 25000),),
        """
N = 4
Window: array[int16, 4] = (0, 0, 0, 0)
At: uint16 = 0
Sum: int32 = 0
def Add(x: int16) -> int16:
    Sum -= Window[At]
    Window[At] = x
    Sum += x
    At += 1
    if At == N:
        At = 0
    return int16(Sum / N)
def Mean() -> int16:
    i: int16
    m: int16 = 0
    for i in range(1, 5):
        m = Add(i * 10000 if i < 4 else 32000) - (0 if i < 4 else -2000)
    return m
""",
    ),
    Driver(
        # 12 bits, two octets little-endian with sign: 0xFF38 = -200
        "two octets to a signed word",
        "Axis",
        (((0x38, 0xFF), -200), ((0xC8, 0x00), 200)),
        """
def Axis(low: uchar, high: uchar) -> int16:
    w: uint16
    w = uint16(high) << 8 | low
    return int16(w)
""",
    ),
    Driver(
        # 5! and gcd(54, 24)
        "recursion",
        "Both",
        (((5, 54, 24), 126),),
        """
def Factorial(n: int16) -> int16:
    if n <= 1:
        return 1
    return n * Factorial(n - 1)
def Gcd(a: int16, b: int16) -> int16:
    return a if b == 0 else Gcd(b, a % b)
def Both(n: int16, a: int16, b: int16) -> int16:
    return Factorial(n) + Gcd(a, b)
""",
    ),
    Driver(
        # low-pass y += (x - y)/8 in Q4
        "a filter with a shift",
        "Filter",
        (((160,), 20), ((160,), 37)),
        """
y: int32 = 0
def Filter(x: int16) -> int16:
    y = y + (((int32(x) << 4) - y) >> 3)
    return int16(y >> 4)
""",
    ),
    Driver(
        # bits: 0b1011 has three; reversed in 4 bits 0b1101
        "bits",
        "Bits",
        (((0x000B,), 3 * 256 + 13),),
        """
def Bits(x: uint16) -> uint16:
    n: uint16 = 0
    r: uint16 = 0
    i: uint16
    for i in range(16):
        if x & (1 << i):
            n += 1
    for i in range(4):
        r = r << 1 | (x >> i & 1)
    return n * 256 + r
""",
    ),
    Driver(
        # degrees wrapped into -180..180
        "an angle brought into range",
        "Wrap",
        (((190.0,), -170.0), ((-540.0,), -180.0), ((10.0,), 10.0)),
        """
def Wrap(a: float32) -> float32:
    while a > 180.0:
        a -= 360.0
    while a < -180.0:
        a += 360.0
    return a
""",
    ),
    Driver(
        # table between points: at 15 between (10, 100) and (20, 300): 200
        "interpolation in a table",
        "Look",
        (((15,), 200), ((5,), 100), ((99,), 500)),
        """
class ROW(struct):
    x: int16
    y: int16
Rows: const[array[ROW, 3]] = ((10, 100), (20, 300), (40, 500))
def Look(x: int16) -> int16:
    i: int16
    a: ptr[ROW]
    b: ptr[ROW]
    if x <= Rows[0].x:
        return Rows[0].y
    for i in range(1, 3):
        if x < Rows[i].x:
            a = addressof(Rows[i - 1])
            b = addressof(Rows[i])
            return a.y + int16(int32(b.y - a.y) * (x - a.x) / (b.x - a.x))
    return Rows[2].y
""",
    ),
)
