"""Specimens of integers that overflow, wrap, are cut or lose their sign."""

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
        "a level goes below 0, and is limited to the top",
        (("Step", ()), ("Step", ())),
        """
Level: uint16 = 16
Limits: uint16 = 0
def Step() -> uint16:
    Level -= 10  # <-
    if Level >= 256:
        Level = 256
        Limits += 1
    return Level
""",
        """
Level: uint16 = 16
Limits: uint16 = 0
def Step() -> uint16:
    if Level < 10:
        Level = 0
    else:
        Level -= 10
    if Level >= 256:
        Level = 256
        Limits += 1
    return Level
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
        "a scaled reading: a product in 16 bits, shifted down; a hash is meant so",
        (("Millivolts", (3000,)),),
        """
Slot: uint16 = 0
def Millivolts(raw: uint16) -> uint16:
    Slot = raw * 40503 >> 8
    return raw * 20000 >> 12  # <-
""",
        """
Slot: uint16 = 0
def Millivolts(raw: uint16) -> uint16:
    Slot = raw * 40503 >> 8
    return uint16(uint32(raw) * 20000 >> 12)
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
        "widened-late",
        "a number in a text that is larger than an int",
        (("Sum", ()),),
        """
from emulator.c28x.rts import atoi
def Number(text: ptr[char]) -> int32:
    return atoi(text)  # <-
def Sum() -> int32:
    return Number("450") + Number("70000")
""",
        """
from emulator.c28x.rts import atoi, atol
def Number(text: ptr[char]) -> int32:
    return atol(text)
def Small(text: ptr[char]) -> int16:
    return atoi(text)
def Sum() -> int32:
    whole: int32 = atoi("-32768")
    Small("70000")
    return Number("450") + Number("70000") + whole
""",
    ),
    Pair(
        "sign-extended",
        "a check sum is returned as an int",
        (("Right", (0xBEEF, 0xBEEF)), ("Right", (0x1234, 0x1234))),
        """
def Sum(word: uint16) -> int16:
    return word
def Right(word: uint16, sent: int32) -> int16:
    if sent != Sum(word):  # <-
        return 0
    return 1
""",
        """
def Sum(word: uint16) -> uint16:
    return word
def Right(word: uint16, sent: int32) -> int16:
    if sent != Sum(word):
        return 0
    return 1
""",
    ),
    Pair(
        "sign-extended",
        "a cast in front of a comparison",
        (("Right", (0xBEEF, 0xBEEF)),),
        """
def Right(sent: int32, own: uint16) -> int16:
    if int16(sent) == int32(own):  # <-
        return 1
    return 0
""",
        """
def Same(sent: int32, angle: int16) -> int16:
    if int16(sent) == int32(angle):
        return 1
    return 0
def Right(sent: int32, own: uint16) -> int16:
    Same(-100, -100)
    Same(65436, -100)
    if uint16(sent) == own:
        return 1
    return 0
""",
    ),
    Pair(
        "sign-lost",
        "a negative output is limited as an unsigned one",
        (("Duty", (-3,)),),
        """
FULL = 2000
def Duty(error: int16) -> uint16:
    duty: uint16 = error * 8  # <-
    if duty > FULL:
        duty = FULL
    return duty
""",
        """
FULL = 2000
def Duty(error: int16) -> uint16:
    duty: int16 = error * 8
    if duty < 0:
        duty = 0
    if duty > FULL:
        duty = FULL
    return uint16(duty)
""",
    ),
    Pair(
        "sign-lost",
        "an unsigned parameter is limited",
        (("Duty", (-3,)),),
        """
def Limit(value: uint32, high: int16) -> int16:
    if value > high:
        return high
    return int16(value)
def Duty(error: int32) -> int16:
    return Limit(error, 900)  # <-
""",
        """
def Index(value: uint32, high: uint32) -> int16:
    if value > high:
        return -1
    return int16(value)
def Duty(error: int32) -> int16:
    return Index(error, 900)
""",
    ),
    Pair(
        "sign-lost",
        "a word of two octets that is widened without its sign",
        (("Take", (0x7C, 0xFC)), ("Take", (0x10, 0x01))),
        """
wanted: int16 = 0
def Take(low: uint16, high: uint16) -> int16:
    rpm: int32
    rpm = low | high << 8  # <-
    if rpm >= -3000 and rpm <= 3000:
        wanted = int16(rpm)
    return wanted
""",
        """
wanted: int16 = 0
def Take(low: uint16, high: uint16) -> int16:
    rpm: int16
    count: int32
    rpm = int16(low | high << 8)
    count = low | high << 8
    if rpm >= -3000 and rpm <= 3000:
        wanted = rpm
    if count < 0 or count > 60000:
        wanted = 0
    return wanted
""",
    ),
    Pair(
        "sign-lost",
        "an octet that is taken without its sign",
        (("Take", (0xF6,)), ("Take", (20,))),
        """
cold: uint16 = 0
def Take(octet: uint16) -> int16:
    degrees: int16
    degrees = octet & 0xFF  # <-
    if degrees < -5:
        cold += 1
    return degrees
""",
        """
cold: uint16 = 0
def Take(octet: uint16) -> int16:
    degrees: int16
    degrees = octet & 0xFF
    if degrees > 127:
        degrees -= 256
    if degrees < -5:
        cold += 1
    return degrees
""",
    ),
    Pair(
        "sign-lost",
        "two signed numbers that are compared as words",
        (("Put", (-40,)), ("Lamp", (10,)), ("Put", (30,)), ("Lamp", (10,))),
        """
words: array[uint16, 4] = (0, 0, 0, 0)
def Put(value: int16) -> int16:
    words[1] = uint16(value)
    return value
def Lamp(limit: int16) -> int16:
    if words[1] > uint16(limit):  # <-
        return 1
    return 0
""",
        """
words: array[uint16, 4] = (0, 0, 0, 0)
counts: array[uint16, 4] = (0, 0, 0, 0)
def Put(value: int16) -> int16:
    words[1] = uint16(value)
    counts[1] = 40000
    return value
def Lamp(limit: int16) -> int16:
    if counts[1] < uint16(limit):
        return 2
    if int16(words[1]) > limit:
        return 1
    return 0
""",
    ),
    Pair(
        "sign-lost",
        "a signed word in an unsigned member",
        (("Take", (0xFFF6,)),),
        """
class raw(struct):
    x: uint16
    y: uint16
Raw: raw = (0, 0)
def Store(r: ptr[raw], word: uint16) -> void:
    r.y = int16(word)  # <-
def Rate(r: ptr[raw]) -> float32:
    return r.y / float32(32.8)
def Take(word: uint16) -> float32:
    Store(addressof(Raw), word)
    return Rate(addressof(Raw))
""",
        """
class raw(struct):
    x: uint16
    y: int16
Raw: raw = (0, 0)
def Store(r: ptr[raw], word: uint16) -> void:
    r.x = int16(word)
    r.y = int16(word)
def Rate(r: ptr[raw]) -> float32:
    return r.y / float32(32.8) + float32(int16(r.x))
def Take(word: uint16) -> float32:
    Store(addressof(Raw), word)
    return Rate(addressof(Raw))
""",
    ),
    Pair(
        "sign-lost",
        "a signed word of a sensor in an unsigned object",
        (("Celsius", (0xFF38,)),),
        """
Word: uint16 = 0
def Celsius(word: uint16) -> float32:
    Word = int16(word)  # <-
    return Word * float32(0.0625)
""",
        """
Word: uint16 = 0
def Celsius(word: uint16) -> float32:
    Word = int16(word ^ 0x6000)  # 0x9F38, in the upper half of an unsigned range
    return Word * float32(0.0625)
""",
    ),
    Pair(
        "sign-lost",
        "a cast before the product is widened",
        (("Width", (-1024,)),),
        """
def Width(position: int16) -> int32:
    return 15000 - uint16(position) * int32(5000) / 2048  # <-
""",
        """
def Width(position: int16) -> int32:
    word: uint32 = uint32(uint16(position)) | uint32(1) << 16
    return 15000 - int32(int16(word & 0xFFFF)) * 5000 / 2048
""",
    ),
    Pair(
        "sign-lost",
        "a cast before a division",
        (("Half", (-10,)),),
        """
def Half(position: int16) -> uint16:
    return uint16(position) / 2  # <-
""",
        """
def Half(position: int16) -> uint16:
    if position < 0:
        position = -position
    return uint16(position) / 2
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
        "widened-late",
        "a reading below its zero, with a cast; the time since a stamp wraps as it is meant",
        (("Pressure", (700,)), ("Pressure", (511,)), ("Age", (3,))),
        """
Stamp: uint16 = 65530
def Pressure(raw: uint16) -> int32:
    return int32(uint16(raw - 512)) * 375 / 64  # <-
def Age(now: uint16) -> int32:
    return int32(uint16(now - Stamp)) * 5
""",
        """
Stamp: uint16 = 65530
def Pressure(raw: uint16) -> int32:
    return (int32(raw) - 512) * 375 / 64
def Age(now: uint16) -> int32:
    return int32(uint16(now - Stamp)) * 5
""",
    ),
    Pair(
        "widened-late",
        "an offset is taken away in 16 bits, and the rest becomes a float; a test of a range may wrap",
        (("Volts", (2040,)), ("Letter", (60,))),
        """
def Volts(raw: uint16) -> float32:
    return float32(uint16(raw - 2048)) * 0.001  # <-
def Letter(c: uint16) -> int16:
    return 1 if uint16(c - 65) < 26 else 0
""",
        """
def Volts(raw: uint16) -> float32:
    return float32(int16(raw - 2048)) * 0.001
def Letter(c: uint16) -> int16:
    return 1 if uint16(c - 65) < 26 else 0
""",
    ),
    Pair(
        "sign-lost",
        "the way of a wheel in 16 bits without a sign; the time between two edges has none",
        (("Turn", (1000,)), ("Turn", (995,)), ("Lap", (70000,))),
        """
Before: uint32 = 990
Edge: uint32 = 5000
Moved: uint16 = 0
def Turn(count: uint32) -> float32:
    Moved = uint16(count - Before)  # <-
    Before = count
    return float32(Moved) * 0.25
def Lap(now: uint32) -> float32:
    width: uint16
    width = uint16(now - Edge)
    Edge = now
    return float32(width)
""",
        """
Before: uint32 = 990
Edge: uint32 = 5000
Moved: int16 = 0
def Turn(count: uint32) -> float32:
    Moved = int16(count - Before)
    Before = count
    return float32(Moved) * 0.25
def Lap(now: uint32) -> float32:
    width: uint16
    width = uint16(now - Edge)
    Edge = now
    return float32(width)
""",
    ),
    Pair(
        "sign-lost",
        "a load cell sends 24 bits, and pulls; a time of 24 bits goes round",
        (("Run", ()),),
        """
Cell: array[uint16, 15] = (0, 7, 200, 0, 5, 9, 0, 3, 1, 255, 254, 40, 255, 250, 17)
Clock: array[uint16, 15] = (255, 240, 0, 255, 250, 0, 0, 1, 0, 0, 9, 0, 0, 30, 0)
Pull: int32 = 0
At: int32 = 0
def Run() -> int32:
    i: int16
    word: uint32
    for i in range(0, 15, 3):
        word = uint32(Cell[i]) << 16
        word |= uint32(Cell[i + 1]) << 8
        word |= Cell[i + 2]
        Pull = int32(word) - 1000  # <-
        At = int32(Clock[i]) << 16 | int32(Clock[i + 1]) << 8 | int32(Clock[i + 2])
    return Pull
""",
        """
Cell: array[uint16, 15] = (0, 7, 200, 0, 5, 9, 0, 3, 1, 255, 254, 40, 255, 250, 17)
Clock: array[uint16, 15] = (255, 240, 0, 255, 250, 0, 0, 1, 0, 0, 9, 0, 0, 30, 0)
Pull: int32 = 0
At: int32 = 0
def Run() -> int32:
    i: int16
    word: uint32
    for i in range(0, 15, 3):
        word = uint32(Cell[i]) << 16
        word |= uint32(Cell[i + 1]) << 8
        word |= Cell[i + 2]
        if word & 0x800000:
            word |= 0xFF000000
        Pull = int32(word) - 1000
        At = int32(Clock[i]) << 16 | int32(Clock[i + 1]) << 8 | int32(Clock[i + 2])
    return Pull
""",
    ),
    Pair(
        "sign-lost",
        "a balance of 24 bits in one expression; one that never goes below 0 has no sign",
        (("Run", ()),),
        """
Raw: array[uint16, 15] = (0, 7, 200, 0, 5, 9, 0, 3, 1, 255, 254, 40, 255, 250, 17)
Sum: int32 = 0
def Run() -> int32:
    i: int16
    for i in range(0, 15, 3):
        Sum += int32(Raw[i]) << 16 | int32(Raw[i + 1]) << 8 | int32(Raw[i + 2])  # <-
    return Sum
""",
        """
Raw: array[uint16, 15] = (0, 7, 200, 0, 5, 9, 0, 3, 1, 240, 254, 40, 130, 250, 17)
Sum: int32 = 0
def Run() -> int32:
    i: int16
    for i in range(0, 15, 3):
        Sum += int32(Raw[i]) << 16 | int32(Raw[i + 1]) << 8 | int32(Raw[i + 2])
    return Sum
""",
    ),
    Pair(
        "sign-extended",
        "a checksum is shifted with its sign",
        (("Check", (0x81,)), ("Check", (0x17,))),
        """
Crc: int16 = 0
def Check(octet: uint16) -> int16:
    i: uint16
    Crc ^= octet
    for i in range(8):
        if Crc & 1:
            Crc = int16((Crc >> 1) ^ 0x8408)  # <-
        else:
            Crc >>= 1
    return Crc
""",
        """
Crc: uint16 = 0
def Check(octet: uint16) -> int16:
    i: uint16
    Crc ^= octet
    for i in range(8):
        if Crc & 1:
            Crc = (Crc >> 1) ^ 0x8408
        else:
            Crc >>= 1
    return int16(Crc)
""",
    ),
    Pair(
        "sign-extended",
        "a generator of 32 bits; a mask takes the copies of the sign away",
        (("Next", ()), ("Next", ()), ("Next", ())),
        """
Noise: int32 = -17
def Next() -> int16:
    bit: int16
    bit = int16(Noise & 1)
    Noise >>= 1  # <-
    if bit:
        Noise = int32(uint32(Noise) ^ 0xB4000000)
    return bit
""",
        """
Noise: int32 = -17
def Next() -> int16:
    bit: int16
    bit = int16(Noise & 1)
    Noise = (Noise >> 1) & 0x7FFFFFFF
    if bit:
        Noise = int32(uint32(Noise) ^ 0xB4000000)
    return bit
""",
    ),
    Pair(
        "fields-overlap",
        "a count of four digits in a field of eight bits",
        (("Frame", (3, 300, 1)),),
        """
def Frame(mode: uint16, count: uint16, kind: uint16) -> uint32:
    return uint32(mode) | uint32(count) << 8 | uint32(kind) << 16  # <-
""",
        """
def Frame(mode: uint16, count: uint16, kind: uint16) -> uint32:
    return uint32(mode) | uint32(count & 0xFF) << 8 | uint32(kind) << 16
""",
    ),
    Pair(
        "fields-overlap",
        "a negative number is widened into the field above it",
        (("Word", (-5, 9)),),
        """
def Word(offset: int16, gain: uint16) -> uint32:
    word: uint32
    word = uint32(offset) | uint32(gain) << 16  # <-
    return word
""",
        """
def Word(offset: int16, gain: uint16) -> uint32:
    word: uint32
    word = uint32(uint16(offset)) | uint32(gain) << 16
    return word
""",
    ),
    Pair(
        "fields-overlap",
        "a word of octets of which one has more bits",
        (("Use", (0x1F2, 0x33)),),
        """
def Word(low: uint16, high: uint16) -> uint16:
    return low | high << 8  # <-
def Use(low: uint16, high: uint16) -> uint16:
    return Word(low, high)
""",
        """
Flags: uint16 = 0
Octets: array[uint16, 2]
def Smear(x: uint16) -> uint16:
    x |= x << 4
    x |= x << 8
    return x
def Turned(x: uint16) -> uint16:
    return x << 5 | x >> 11
def Marked(x: uint16) -> uint16:
    Flags |= 0x120
    return Flags | x << 8
def Spread(x: uint16) -> uint16:
    x = (x | x << 4) & 0x0F0F
    x = (x | x << 2) & 0x3333
    return (x | x << 1) & 0x5555
def Both(a: uint16, b: uint16) -> uint16:
    return Spread(a) | Spread(b) << 1
def Pictures(a: uint16, b: uint16) -> uint16:
    return a | b << 3
def Kept(word: uint16, field: uint16) -> uint16:
    return (word & 0xF0F0) | field << 8
def Moved(octet: uint16) -> uint16:
    Octets[0] = 0x1F2
    Octets[0] |= octet << 8
    return Octets[0]
def Use(low: uint16, high: uint16) -> uint16:
    Smear(low)
    Turned(low)
    Marked(high)
    Both(0xFF, 0xFF)
    Pictures(low, low)
    Kept(0xFFFF, 0xF1)
    Moved(high)
    return (low & 0xFF) | high << 8
""",
    ),
)
