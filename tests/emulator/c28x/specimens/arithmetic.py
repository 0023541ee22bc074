"""Specimens of arithmetic defects."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Pair

PAIRS: Final = (
    Pair(
        "overflow",
        "a sum of samples in 16 bits",
        (("Offset", ()),),
        """
def Offset() -> int16:
    sum: int16 = 0
    i: int16
    for i in range(100):
        sum += 400  # <-
    return sum / 100
""",
        """
def Offset() -> int16:
    sum: int32 = 0
    i: int16
    for i in range(100):
        sum += 400
    return int16(sum / 100)
""",
    ),
    Pair(
        "overflow",
        "the magnitude of the most negative number",
        (("Magnitude", (-32768,)),),
        """
def Magnitude(x: int16) -> int16:
    return -x if x < 0 else x  # <-
""",
        """
def Magnitude(x: int16) -> int16:
    if x == -32768:
        return 32767
    return -x if x < 0 else x
""",
    ),
    Pair(
        "widened-late",
        "a product of ints stored in a long",
        (("Area", (400, 300)),),
        """
def Area(a: int16, b: int16) -> int32:
    r: int32
    r = a * b  # <-
    return r
""",
        """
def Area(a: int16, b: int16) -> int32:
    r: int32
    r = int32(a) * b
    return r
""",
    ),
    Pair(
        "widened-late",
        "an unsigned difference goes to float",
        (("Volts", (2000,)),),
        """
def Volts(adc: uint16) -> float32:
    return (adc - 2048) * 0.001  # <-
""",
        """
def Volts(adc: uint16) -> float32:
    return (int16(adc) - 2048) * 0.001
""",
    ),
    Pair(
        "widened-late",
        "an unsigned product compared with a long",
        (("Late", (700, 100)),),
        """
def Late(ticks: uint16, us: uint16) -> int16:
    return 1 if ticks * us > 50000 else 0  # <-
""",
        """
def Late(ticks: uint16, us: uint16) -> int16:
    return 1 if uint32(ticks) * us > 50000 else 0
""",
    ),
    Pair(
        "widened-late",
        "milliseconds from seconds for a long argument",
        (("Wait", (60,)),),
        """
Until: int32 = 0
def Arm(ms: int32) -> void:
    Until = ms
def Wait(s: int16) -> int32:
    Arm(s * 1000)  # <-
    return Until
""",
        """
Until: int32 = 0
def Arm(ms: int32) -> void:
    Until = ms
def Wait(s: int16) -> int32:
    Arm(int32(s) * 1000)
    return Until
""",
    ),
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
        "narrowed",
        "a long result kept in an int",
        (("Distance", (40000,)),),
        """
def Distance(counts: int32) -> int16:
    mm: int16
    mm = counts * 2  # <-
    return mm / 2
""",
        """
def Distance(counts: int32) -> int16:
    mm: int32
    mm = counts * 2
    return int16(mm / 8)
""",
    ),
    Pair(
        "unsigned-wrap",
        "half the distance between two readings",
        (("Middle", (100, 140)),),
        """
def Middle(a: uint16, b: uint16) -> uint16:
    return b + (a - b) / 2  # <-
""",
        """
def Middle(a: uint16, b: uint16) -> uint16:
    return a + (b - a) / 2 if b > a else b + (a - b) / 2
""",
    ),
    Pair(
        "unsigned-wrap",
        "how far a reading has moved",
        (("Moved", (500, 510)),),
        """
def Moved(now: uint16, before: uint16) -> int16:
    return 1 if now - before > 5 else 0  # <-
""",
        """
def Moved(now: uint16, before: uint16) -> int16:
    return 1 if (now > before and now - before > 5) or (before > now and before - now > 5) else 0
""",
    ),
    Pair(
        "sign-compare",
        "an error code compared with a size",
        (("Accept", (-1, 8)),),
        """
def Accept(n: int16, size: uint16) -> int16:
    if n < size:  # <-
        return 1
    return 0
""",
        """
def Accept(n: int16, size: uint16) -> int16:
    if n < 0 or uint16(n) < size:
        return 1
    return 0
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
        "shift-range",
        "a mask for bit 16 of an int",
        (("Mask", (20,)),),
        """
def Mask(bit: uint16) -> uint32:
    return 1 << bit  # <-
""",
        """
def Mask(bit: uint16) -> uint32:
    return uint32(1) << bit
""",
    ),
    Pair(
        "octet",
        "a checksum that never wraps at 256",
        (("Sum", ()),),
        """
Frame: array[uchar, 4] = (200, 100, 50, 25)
def Sum() -> int16:
    sum: uchar = 0
    i: int16
    for i in range(4):
        sum += Frame[i]  # <-
    return sum
""",
        """
Frame: array[uchar, 4] = (200, 100, 50, 25)
def Sum() -> int16:
    sum: uchar = 0
    i: int16
    for i in range(4):
        sum = (sum + Frame[i]) & 0xFF
    return sum
""",
    ),
    Pair(
        "octet",
        "a cast is meant to cut the high half",
        (("Low", (0x1234,)),),
        """
def Low(w: uint16) -> uint16:
    return uchar(w)  # <-
""",
        """
def Low(w: uint16) -> uint16:
    return w & 0xFF
""",
    ),
    Pair(
        "octet",
        "a register of eight bits with a sign",
        (("Degrees", (0xF6,)),),
        """
def Degrees(raw: uint16) -> int16:
    t: schar
    t = schar(raw)  # <-
    return 25 + t
""",
        """
def Degrees(raw: uint16) -> int16:
    t: int16
    t = int16(raw & 0xFF)
    if t > 127:
        t -= 256
    return 25 + t
""",
    ),
    Pair(
        "octet",
        "CRC-8 shifts out of the octet",
        (("Crc", ()),),
        """
Message: array[uchar, 3] = (1, 2, 3)
def Crc() -> int16:
    crc: uchar = 0
    i: int16
    k: int16
    for i in range(3):
        crc = crc ^ Message[i]
        for k in range(8):
            if crc & 0x80:
                crc = (crc << 1) ^ 0x07  # <-
            else:
                crc = crc << 1
    return crc
""",
        """
Message: array[uchar, 3] = (1, 2, 3)
def Crc() -> int16:
    crc: uchar = 0
    i: int16
    k: int16
    for i in range(3):
        crc = crc ^ Message[i]
        for k in range(8):
            if crc & 0x80:
                crc = ((crc << 1) ^ 0x07) & 0xFF
            else:
                crc = (crc << 1) & 0xFF
    return crc
""",
    ),
    Pair(
        "octet",
        "the complement of an octet",
        (("Inverted", (0x0F,)),),
        """
def Inverted(b: uchar) -> int16:
    c: uchar
    c = ~b  # <-
    return c
""",
        """
def Inverted(b: uchar) -> int16:
    c: uchar
    c = ~b & 0xFF
    return c
""",
    ),
    Pair(
        "octet",
        "a received character asked for its sign",
        (("Step", (0xFE,)),),
        """
def Step(c: char) -> int16:
    if c < 0:  # <-
        return -1
    return 1
""",
        """
def Step(c: char) -> int16:
    if c & 0x80:
        return -1
    return 1
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
        "unsigned-wrap",
        "a sum of readings is divided further down",
        (("Mean", ()),),
        """
v: array[uint16, 4] = (40000, 40000, 40000, 40000)
def Mean() -> uint16:
    s: uint16 = 0
    i: int16
    for i in range(4):
        s += v[i]  # <-
    return s / 4
""",
        """
v: array[uint16, 4] = (40000, 40000, 40000, 40000)
def Mean() -> uint16:
    s: uint32 = 0
    i: int16
    for i in range(4):
        s += v[i]
    return uint16(s / 4)
""",
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
    Pair(
        "octet",
        "a sequence number that is to begin anew at 256",
        (("Next", ()),),
        """
Sequence: uchar = 255
def Next() -> int16:
    Sequence += 1  # <-
    return Sequence
""",
        """
Sequence: uchar = 255
def Next() -> int16:
    Sequence = (Sequence + 1) & 0xFF
    return Sequence
""",
    ),
)
