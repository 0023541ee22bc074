"""Specimens of what `static_values` shows: conditions, constants, divisions, signs."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import static_pair

PAIRS: Final = (
    static_pair(
        "stamp-compare",
        "the end of a time wraps before its 16-bit counter does",
        """
Ticks: volatile[uint16] = 0
Last: uint16 = 0
def Tick() -> void:
    Ticks += 1
Vector: funcptr = Tick
def Seen() -> void:
    Vector()
    Last = Ticks
def Fresh() -> int16:
    return Ticks < uint16(Last + 20)  # <-
""",
        """
Ticks: volatile[uint16] = 0
Last: uint16 = 0
def Tick() -> void:
    Ticks += 1
Vector: funcptr = Tick
def Seen() -> void:
    Vector()
    Last = Ticks
def Fresh() -> int16:
    return uint16(Ticks - Last) < 20
""",
    ),
    static_pair(
        "stamp-compare",
        "the end of a time wraps before its 16-bit counter does, which counts on and on",
        """
Ticks: volatile[uint16] = 0
End: uint16 = 0
def Tick() -> void:
    Ticks += 1
Vector: funcptr = Tick
def Begin(length: uint16) -> void:
    Vector()
    End = Ticks + length
def Over() -> int16:
    if Ticks >= End:  # <-
        return 1
    return 0
""",
        """
Ticks: volatile[uint16] = 0
End: uint16 = 0
def Tick() -> void:
    if Ticks < 60000:
        Ticks += 1
Vector: funcptr = Tick
def Begin(length: uint16) -> void:
    Vector()
    End = Ticks + length
def Over() -> int16:
    if Ticks >= End:
        return 1
    return 0
""",
    ),
    static_pair(
        "stamp-compare",
        "a stamp of 32 bits is kept in 16, and compared with 32",
        """
class JOB(struct):
    next: uint32
    late: uint16
Ticks: volatile[uint32] = 0
Job: JOB
def Tick() -> void:
    Ticks += 1
Vector: funcptr = Tick
def After() -> void:
    Vector()
def Due() -> int16:
    now: uint16 = Ticks  # <-
    if int32(now - Job.next) >= 0:
        Job.late += 1
    return Job.late
""",
        """
class JOB(struct):
    next: uint32
    late: uint16
Ticks: volatile[uint32] = 0
Job: JOB
def Tick() -> void:
    Ticks += 1
Vector: funcptr = Tick
def After() -> void:
    Vector()
def Due() -> int16:
    now: uint32 = Ticks
    if int32(now - Job.next) >= 0:
        Job.late += 1
    return Job.late
""",
    ),
    static_pair(
        "stamp-compare",
        "a stamp of 32 bits is kept in 16",
        """
class JOB(struct):
    next: uint32
    late: uint16
Ticks: volatile[uint32] = 0
Job: JOB
def Tick() -> void:
    Ticks += 1
Vector: funcptr = Tick
def After() -> void:
    Vector()
def Due() -> int16:
    now: uint16 = Ticks  # <-
    if int32(now - Job.next) >= 0:
        Job.late += 1
    return Job.late
""",
        """
class JOB(struct):
    next: uint32
    late: uint16
Ticks: volatile[uint32] = 0
Job: JOB
def Tick() -> void:
    Ticks += 1
Vector: funcptr = Tick
def After() -> void:
    Vector()
def Due() -> int16:
    now: uint16 = Ticks
    if int16(now - uint16(Job.next)) >= 0:
        Job.late += 1
    return Job.late
""",
    ),
    static_pair(
        "own-copy",
        "the last position is stored before the difference is taken",
        """
Last: int32 = 0
Turns: int32 = 0
def Speed(now: int32) -> int32:
    moved: int32
    Last = now
    Turns += 1
    moved = now - Last  # <-
    return moved
""",
        """
Last: int32 = 0
Turns: int32 = 0
def Speed(now: int32) -> int32:
    moved: int32
    moved = now - Last
    Last = now
    now -= 1
    Turns = now - Last
    return moved
""",
        ("Speed", (7,)),
    ),
    static_pair(
        "own-copy",
        "the level is taken over before its change is used; a search in a condition finds another level",
        """
Level: float32 = 0.0
Rise: float32 = 0.0
def Take(level: float32, calm: int16) -> int16:
    Level = level
    if calm:
        Rise = level - Level  # <-
    return int16(Rise)
""",
        """
Level: float32 = 2.0
Rise: float32 = 0.0
Depth: int16 = 0
def Found(level: ptr[float32], try_: int16) -> int16:
    if try_ < 2:
        return 0
    level[0] = float32(try_) * 4.0
    return 1
def Lowered(try_: int16) -> int16:
    Depth -= try_
    return Depth
def Take(try_: int16, calm: int16) -> int16:
    level: float32 = Level
    depth: int16
    if calm and Found(addressof(level), try_) and level - Level > 1.0:
        Rise = level - Level
    level = Level
    if Found(addressof(level), try_):
        Rise += level - Level
        Level = level
    depth = Depth
    if Lowered(try_) < 0:
        Rise += float32(depth - Depth)
    begun: int16 = try_
    while begun - try_ < 3:
        try_ -= 1
    level = Level
    while level - Level < 3.0 and Found(addressof(level), 9):
        pass
    return int16(Rise)
""",
        ("Take", (5, 1)),
    ),
    static_pair(
        "stamp-compare",
        "a time since a stamp that no statement sets",
        """
Ticks: volatile[uint16] = 0
Last: uint16 = 0
def Tick() -> void:
    Ticks += 1
Vector: funcptr = Tick
def Seen() -> void:
    Vector()
def Late() -> int16:
    return uint16(Ticks - Last) > 100  # <-
""",
        """
Ticks: volatile[uint16] = 0
Last: uint16 = 0
FIRST: const[uint16] = 5
def Tick() -> void:
    Ticks += 1
Vector: funcptr = Tick
def Seen() -> void:
    Vector()
    Last = Ticks
def Late() -> int16:
    return uint16(Ticks - Last) > 100 or uint16(Ticks - FIRST) == 7
""",
    ),
    static_pair(
        "constant-condition",
        "a counter that each pass begins anew",
        """
total: int32 = 0
taken: uint16 = 0
offset: int16 = 0
def Calibrate(raw: int16) -> int16:
    total = 0
    taken = 0
    total += raw
    taken += 1
    if taken >= 64:  # <-
        offset = int16(total / 64)
    return offset
""",
        """
total: int32 = 0
taken: uint16 = 0
offset: int16 = 0
fast: uint16 = 0
length: uint16 = 0
out: array[int16, 4]
def Begin() -> int16:
    total = 0
    taken = 0
    return 0
def Calibrate(raw: int16) -> int16:
    fast = 1
    if fast == 1:
        total += raw
        taken += 1
    if taken >= 64:
        offset = int16(total / 64)
        taken = 0
        taken += Begin()
        if taken == 0:
            total = 0
    length = 0
    out[length] = raw
    length += 1
    if length >= 4:
        return 0
    return offset
""",
        ("Calibrate", (7,)),
    ),
    static_pair(
        "constant-condition",
        "a range as in mathematics",
        """
def Inside(d: float32) -> int16:
    if (25 < d) < 90:  # <-
        return 1
    return 0
""",
        """
def Inside(d: float32) -> int16:
    if 25 < d and d < 90:
        return 1
    return 0
""",
        ("Inside", (30.0,)),
    ),
    static_pair(
        "constant-condition",
        "counting an unsigned down to below zero",
        """
def Down(n: uint16) -> uint16:
    sum: uint16 = 0
    while n >= 0:  # <-
        sum = sum + n
        if sum > 100:
            return 0
        n -= 1
    return sum
""",
        """
def Down(n: uint16) -> uint16:
    sum: uint16 = 0
    while n > 0:
        sum = sum + n
        n -= 1
    return sum
""",
        ("Down", (4,)),
    ),
    static_pair(
        "constant-condition",
        "an int is never above 40000",
        """
def Full(x: int16) -> int16:
    if x > 40000:  # <-
        return 1
    return 0
""",
        """
def Full(x: uint16) -> int16:
    if x > 40000:
        return 1
    return 0
""",
        ("Full", (5,)),
    ),
    static_pair(
        "constant-condition",
        "or where and is meant",
        """
def Known(mode: int16) -> int16:
    if mode != 1 or mode != 2:  # <-
        return 0
    return 1
""",
        """
def Known(mode: int16) -> int16:
    if mode != 1 and mode != 2:
        return 0
    return 1
""",
        ("Known", (1,)),
    ),
    static_pair(
        "constant-condition",
        "a limit below its lower end",
        """
def Band(x: int16) -> int16:
    if x > 100 and x < 50:  # <-
        return 1
    return 0
""",
        """
def Band(x: int16) -> int16:
    if x > 50 and x < 100:
        return 1
    return 0
""",
        ("Band", (60,)),
    ),
    static_pair(
        "assignment-loses",
        "a gain with a fraction in an int",
        """
def Gain(x: int16) -> int16:
    k: int16 = 0.75  # <-
    return k * x
""",
        """
def Gain(x: int16) -> int16:
    k: float32 = 0.75
    return int16(k * x)
""",
        ("Gain", (4,)),
    ),
    static_pair(
        "assignment-loses",
        "a file-scope limit that does not fit",
        """
Limit: int16 = 50000  # <-
def Get() -> int16:
    return Limit
""",
        """
Limit: uint16 = 50000
def Get() -> uint16:
    return Limit
""",
        ("Get", ()),
    ),
    static_pair(
        "integer-division-in-float",
        "one half that is zero",
        """
def Kinetic(m: float32, v: float32) -> float32:
    return 1 / 2 * m * v * v  # <-
""",
        """
def Kinetic(m: float32, v: float32) -> float32:
    return 1.0 / 2 * m * v * v
""",
        ("Kinetic", (1.0, 2.0)),
    ),
    static_pair(
        "float-equality",
        "a target that is never met exactly",
        """
def Arrived(x: float32, target: float32) -> int16:
    return x == target  # <-
""",
        """
def Arrived(x: float32, target: float32) -> int16:
    return fabs(x - target) < 0.001
""",
        ("Arrived", (1.0, 1.0)),
    ),
    static_pair(
        "sign-compare",
        "a difference that may be negative",
        """
def Room(size: uint16, used: int16) -> int16:
    left: int16
    left = 10 - used
    if left > size:  # <-
        return 0
    return 1
""",
        """
def Room(size: int16, used: int16) -> int16:
    left: int16
    left = 10 - used
    if left > size:
        return 0
    return 1
""",
        ("Room", (5, 3)),
    ),
    static_pair(
        "sign-compare",
        "an unsigned set point held against a negative limit",
        """
LEAST = -40
def Allowed(ready: int16, high: uint16, low: uint16) -> int16:
    asked: uint16 = high << 8 | low
    if ready and asked >= LEAST and asked < 90:  # <-
        return 1
    return 0
""",
        """
LEAST = -40
def Allowed(ready: int16, high: uint16, low: uint16) -> int16:
    asked: int16 = high << 8 | low
    if ready and asked >= LEAST and asked < 90:
        return 1
    return 0
""",
        ("Allowed", (1, 0, 20)),
    ),
    static_pair(
        "constant-condition",
        "the band between two limits is turned inside out",
        """
Level: int16 = 40
Pump: int16 = 0
def Step(middle: int16) -> int16:
    global Pump
    if Level < middle + 8:
        Pump = 1
    elif Level > middle - 8:  # <-
        Pump = 0
    return Pump
""",
        """
Level: int16 = 40
Pump: int16 = 0
def Step(middle: int16) -> int16:
    global Pump
    if Level < middle - 8:
        Pump = 1
    elif Level > middle + 8:
        Pump = 0
    return Pump
""",
        ("Step", (40,)),
    ),
    static_pair(
        "table-short",
        "a table without a row for the last word",
        """
Pins: volatile[uint16] = 0x50
Heights: array[int16, 3] = (4, 9, 16)
def Word() -> uint16:
    return Pins >> 4 & 3
def Height() -> int16:
    word: uint16 = Word()
    return Heights[word]  # <-
""",
        """
Pins: volatile[uint16] = 0x50
Heights: array[int16, 3] = (4, 9, 16)
def Word() -> uint16:
    return Pins >> 4 & 3
def Height() -> int16:
    word: uint16 = Word()
    if word == 3:
        return 0
    return Heights[word]
""",
        ("Height", ()),
    ),
    static_pair(
        "table-short",
        "the elements of a table are counted, and the rows are meant",
        """
Shades: array[array[int16, 2], 3] = ((1, 2), (3, 4), (5, 6))
class LAMP(struct):
    shade: uint16
    level: uint16
Lamp: LAMP = (0, 0)
def Next() -> None:
    Lamp.shade = (Lamp.shade + 1) % (sizeof(Shades) / sizeof(Shades[0][0]))
def Show() -> int16:
    return Shades[Lamp.shade][1]  # <-
""",
        """
Shades: array[array[int16, 2], 3] = ((1, 2), (3, 4), (5, 6))
class LAMP(struct):
    shade: uint16
    level: uint16
Lamp: LAMP = (0, 0)
def Next() -> None:
    Lamp.shade = (Lamp.shade + 1) % (sizeof(Shades) / sizeof(Shades[0]))
def Show() -> int16:
    return Shades[Lamp.shade][1]
""",
        ("Show", ()),
    ),
    static_pair(
        "table-short",
        "a count that is set back one step too late",
        """
Pans: array[int16, 4] = (1, 2, 3, 4)
_point: uint16 = 0
def Pan() -> int16:
    global _point
    pan: int16 = Pans[_point]  # <-
    _point += 1
    if _point > 4:
        _point = 0
    return pan
""",
        """
Pans: array[int16, 4] = (1, 2, 3, 4)
_point: uint16 = 0
def Pan() -> int16:
    global _point
    pan: int16 = Pans[_point]
    _point += 1
    if _point >= 4:
        _point = 0
    return pan
""",
        ("Pan", ()),
    ),
    static_pair(
        "table-short",
        "a table of texts that lacks the one of a state",
        """
Pins: volatile[uint16] = 1
Shown: volatile[char] = 0
State: int16 = 0
Names: const[array[ptr[const[char]], 2]] = ("OFF", "ON")
def _enter(state: int16) -> void:
    global State
    State = state
def _report() -> void:
    text: ptr[const[char]] = Names[State]  # <-
    Shown = text[0]
def main() -> int16:
    while 1:
        if Pins == 0:
            _enter(0)
        elif Pins == 1:
            _enter(1)
        else:
            _enter(2)
        _report()
""",
        """
Pins: volatile[uint16] = 1
Shown: volatile[char] = 0
State: int16 = 0
Names: const[array[ptr[const[char]], 3]] = ("OFF", "ON", "FAULT")
def _enter(state: int16) -> void:
    global State
    State = state
def _report() -> void:
    text: ptr[const[char]] = Names[State]
    Shown = text[0]
def main() -> int16:
    while 1:
        if Pins == 0:
            _enter(0)
        elif Pins == 1:
            _enter(1)
        else:
            _enter(2)
        _report()
""",
    ),
    static_pair(
        "narrowed",
        "a limit that the type behind it cannot hold",
        """
Period_ms: uint16 = 1000
def Set(number: int32) -> uint16:
    global Period_ms
    if number > 0 and number <= 100000:  # <-
        Period_ms = uint16(number)
    return Period_ms
""",
        """
Period_ms: uint16 = 1000
def Set(number: int32) -> uint16:
    global Period_ms
    if number > 0 and number <= 60000:
        Period_ms = uint16(number)
    return Period_ms
""",
        ("Set", (500,)),
    ),
    static_pair(
        "widened-late",
        "a limit times a factor, in 16 bits",
        """
Rest_ms: uint32 = 0
def Start(seconds: uint16) -> uint32:
    global Rest_ms
    if seconds <= 3600:
        Rest_ms = seconds * 1000  # <-
    return Rest_ms
""",
        """
Rest_ms: uint32 = 0
def Start(seconds: uint16) -> uint32:
    global Rest_ms
    if seconds <= 65:
        Rest_ms = seconds * 1000
    return Rest_ms
""",
        ("Start", (60,)),
    ),
    static_pair(
        "octet",
        "bits of an object counted with eight",
        """
def Bits() -> int16:
    return int16(sizeof(float32) * 8)  # <-
""",
        """
BITS_PER_WORD = 16
def Bits() -> int16:
    return int16(sizeof(float32) * BITS_PER_WORD)
""",
        ("Bits", ()),
    ),
    static_pair(
        "mixed-logic",
        "a mask compared before it masks",
        """
READY = 0x10
def Ready(flags: uint16) -> int16:
    if flags & (READY == READY):  # <-
        return 1
    return 0
""",
        """
READY = 0x10
def Ready(flags: uint16) -> int16:
    if (flags & READY) == READY:
        return 1
    return 0
""",
        ("Ready", (0x10,)),
    ),
    static_pair(
        "sign-compare",
        "a character compared with minus one",
        """
def Nothing(c: uchar) -> int16:
    return 1 if c == -1 else 0  # <-
""",
        """
def Nothing(c: uchar) -> int16:
    return 1 if c == 0xFF else 0
""",
        ("Nothing", (0xFF,)),
    ),
    static_pair(
        "integer-division-in-float",
        "a factor of one half in integers",
        """
def Half(x: int16) -> int16:
    return x * (1 / 2)  # <-
""",
        """
def Half(x: int16) -> int16:
    return x / 2
""",
        ("Half", (9,)),
    ),
    static_pair(
        "self-assignment",
        "a limit that is not taken over",
        """
class MOTOR(struct):
    limit: int16
Motor: MOTOR = (5,)
def Set_Limit(limit: int16) -> int16:
    Motor.limit = Motor.limit  # <-
    return Motor.limit + limit
""",
        """
class MOTOR(struct):
    limit: int16
Motor: MOTOR = (5,)
def Set_Limit(limit: int16) -> int16:
    Motor.limit = limit
    return Motor.limit
""",
        ("Set_Limit", (3,)),
    ),
    static_pair(
        "float-magnitude",
        "the whole part of a deviation",
        """
from emulator.c28x.rts import abs
def Deviation(a: float32, b: float32) -> float32:
    return abs(a - b)  # <-
""",
        """
from emulator.c28x.rts import fabs
def Deviation(a: float32, b: float32) -> float32:
    return fabs(a - b)
""",
        ("Deviation", (1.0, 1.75)),
    ),
    static_pair(
        "memcpy-outside",
        "a name that is cleared beyond its end",
        """
class MOTOR(struct):
    name: array[char, 4]
    limit: int16
    gain: int16
Motor: MOTOR = ((1, 2, 3, 4), 5, 6)
def Clear() -> int16:
    memset(Motor.name, 0, 5)  # <-
    return Motor.limit + Motor.name[0] + Motor.gain
""",
        """
class MOTOR(struct):
    name: array[char, 4]
    limit: int16
    gain: int16
Motor: MOTOR = ((1, 2, 3, 4), 5, 6)
def Clear() -> int16:
    memset(Motor.name, 0, 4)
    return Motor.limit + Motor.name[0] + Motor.gain
""",
        ("Clear", ()),
    ),
    static_pair(
        "dangling-pointer",
        "a function returns the address of its own text",
        """
def Text(speed: uint16) -> ptr[char]:
    text: array[char, 2]
    text[0] = speed
    text[1] = 0
    return text  # <-
""",
        """
Kept: array[char, 2]
def Text(speed: uint16) -> ptr[char]:
    Kept[0] = speed
    Kept[1] = 0
    return Kept
""",
        ("Text", (5,)),
    ),
    static_pair(
        "memcpy-octets",
        "two octets for each word of an array",
        """
SHOTS = 3
Shots: array[uint16, SHOTS] = (1, 2, 3)
Kept: array[uint16, SHOTS]
def Keep() -> None:
    memcpy(Kept, Shots, 2 * SHOTS)  # <-
def Last() -> uint16:
    return Kept[2]
""",
        """
SHOTS = 3
Shots: array[uint16, SHOTS] = (1, 2, 3)
Kept: array[uint16, SHOTS]
def Keep() -> None:
    memcpy(Kept, Shots, sizeof(Kept))
def Last() -> uint16:
    return Kept[2]
""",
        ("Keep", ()),
    ),
    static_pair(
        "sizeof-pointer",
        "a structure of which two words are cleared",
        """
class MOTOR(struct):
    limits: array[int16, 6]
Motor: MOTOR = ((1, 2, 3, 4, 5, 6),)
def Reset(motor: ptr[MOTOR]) -> void:
    memset(motor, 0, sizeof(motor))  # <-
def Use() -> int16:
    Reset(addressof(Motor))
    return Motor.limits[5]
""",
        """
class MOTOR(struct):
    limits: array[int16, 6]
Motor: MOTOR = ((1, 2, 3, 4, 5, 6),)
def Reset(motor: ptr[MOTOR]) -> void:
    memset(motor, 0, sizeof(MOTOR))
def Use() -> int16:
    Reset(addressof(Motor))
    return Motor.limits[5]
""",
        ("Use", ()),
    ),
    static_pair(
        "self-assignment",
        "a member behind a pointer",
        """
class MOTOR(struct):
    limit: int16
Motor: MOTOR = (7,)
def Set(motor: ptr[MOTOR], limit: int16) -> int16:
    motor.limit = motor.limit  # <-
    return limit
def Use() -> int16:
    return Set(addressof(Motor), 3)
""",
        """
class MOTOR(struct):
    limit: int16
Motor: MOTOR = (7,)
def Set(motor: ptr[MOTOR], limit: int16) -> int16:
    if limit < 0:
        motor.limit = motor.limit
    else:
        motor.limit = limit
    return limit
def Use() -> int16:
    return Set(addressof(Motor), 3)
""",
        ("Use", ()),
    ),
    static_pair(
        "constant-condition",
        "a local that is only counted up is never below zero",
        """
def Found(wanted: int16) -> int16:
    n: int16 = 0
    i: int16
    for i in range(5):
        if i * i == wanted:
            n += 1
    if n < 0:  # <-
        return -1
    return n
""",
        """
def Found(wanted: int16) -> int16:
    n: int16 = -1
    i: int16
    for i in range(5):
        if i * i == wanted:
            n += 1
    if n < 0:
        return -1
    return n
""",
        ("Found", (3,)),
    ),
    static_pair(
        "constant-condition",
        "a pointer is held against NULL too late",
        """
v: array[int16, 2] = (1, 2)
def First(p: ptr[int16]) -> int16:
    first: int16 = p[0]
    if p == NULL:  # <-
        return 0
    return first
def Use() -> int16:
    return First(v)
""",
        """
v: array[int16, 2] = (1, 2)
def First(p: ptr[int16]) -> int16:
    if p == NULL or p[0] == 9:
        return 0
    return p[0]
def Use() -> int16:
    return First(v)
""",
        ("Use", ()),
    ),
    static_pair(
        "unsigned-wrap",
        "an interval in ticks that 16 bits do not hold",
        """
def Interval() -> uint16:
    return uint16(400) * uint16(195)  # <-
""",
        """
def Interval() -> uint16:
    return uint16(300) * uint16(195)
""",
        ("Interval", ()),
    ),
    static_pair(
        "limits-crossed",
        "a minus that is missing in the lower limit",
        """
def Clamp(x: int16) -> int16:
    if x > 100:
        x = 100
    if x < 100:  # <-
        x = -100
    return x
""",
        """
def Clamp(x: int16) -> int16:
    if x > 100:
        x = 100
    if x < -100:
        x = -100
    return x
""",
        ("Clamp", (7,)),
    ),
    static_pair(
        "digit-code",
        "the code of a digit in place of its value",
        """
def Append(value: uint16, c: uint16) -> uint16:
    if c >= 48 and c <= 57:
        value = value * 10 + c  # <-
    return value
""",
        """
def Append(value: uint16, c: uint16) -> uint16:
    if c >= 48 and c <= 57:
        value = value * 10 + (c - 48)
    return value
""",
        ("Append", (1, 49)),
    ),
    static_pair(
        "mask-gaps",
        "a ring of twelve",
        """
TAIL_SIZE = 12
def Next(i: uint16) -> uint16:
    return (i + 1) & (TAIL_SIZE - 1)  # <-
""",
        """
TAIL_SIZE = 16
def Next(i: uint16) -> uint16:
    return (i + 1) & (TAIL_SIZE - 1)
""",
        ("Next", (3,)),
    ),
    static_pair(
        "overflow",
        "a product of constants in a case that never comes",
        """
LIMIT_S = 1800
def Late(ms: uint32, state: uint16) -> int16:
    if state == 7:
        return ms > LIMIT_S * 1000  # <-
    return 0
""",
        """
LIMIT_S = 1800
def Late(ms: uint32, state: uint16) -> int16:
    if state == 7:
        return ms > uint32(LIMIT_S) * 1000
    return 0
""",
        ("Late", (5, 1)),
    ),
    static_pair(
        "shift-range",
        "octets are joined in 16 bits, in a branch that never comes",
        """
def Joined(high: uint16, low: uint16, whole: int16) -> uint32:
    if whole:
        return high << 16 | low  # <-
    return low
""",
        """
def Joined(high: uint16, low: uint16, whole: int16) -> uint32:
    if whole:
        return uint32(high) << 16 | low
    return low
""",
        ("Joined", (1, 2, 0)),
    ),
    static_pair(
        "echo-not-halved",
        "there and back",
        """
def Sonar(echo_us: uint32) -> uint16:
    return uint16(echo_us * 343 / 1000)  # <-
""",
        """
def Sonar(echo_us: uint32) -> uint16:
    return uint16(echo_us * 343 / 2000)
""",
        ("Sonar", (5800,)),
    ),
    static_pair(
        "runs-away",
        "a feed-forward and an error of opposite signs",
        """
KFF: const[float32] = 0.4
KP: const[float32] = 0.8
def Output(wanted: float32, speed: float32) -> float32:
    return KFF * wanted + KP * (speed - wanted)  # <-
""",
        """
KFF: const[float32] = 0.4
KP: const[float32] = 0.8
def Output(wanted: float32, speed: float32) -> float32:
    return KFF * wanted + KP * (wanted - speed)
""",
        ("Output", (1.0, 0.5)),
    ),
    static_pair(
        "angle-unwrapped",
        "the long way round",
        """
Heading: float32 = 0.0
Wanted: float32 = 0.0
Turn: float32 = 0.0
def Wrap(angle: float32) -> float32:
    if angle > 180.0:
        return angle - 360.0
    if angle < -180.0:
        return angle + 360.0
    return angle
def Drive(turn: float32) -> None:
    Turn = turn
def Step(rate: float32, wanted: float32) -> None:
    Wanted = wanted
    Heading = Wrap(Heading + rate)
    error: float32 = Wanted - Heading  # <-
    turn: float32 = error * 0.02
    Drive(turn)
""",
        """
Heading: float32 = 0.0
Wanted: float32 = 0.0
Turn: float32 = 0.0
def Wrap(angle: float32) -> float32:
    if angle > 180.0:
        return angle - 360.0
    if angle < -180.0:
        return angle + 360.0
    return angle
def Drive(turn: float32) -> None:
    Turn = turn
def Step(rate: float32, wanted: float32) -> None:
    Wanted = wanted
    Heading = Wrap(Heading + rate)
    error: float32 = Wrap(Wanted - Heading)
    turn: float32 = error * 0.02
    Drive(turn)
""",
        ("Step", (1.0, 2.0)),
    ),
)
