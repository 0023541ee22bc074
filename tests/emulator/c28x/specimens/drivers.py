"""Correct drivers of many shapes.  Results: published check values, or worked out by hand beside the source."""

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
        # 12 samples pushed into 8 places less one: the first 7 stay; 1+2+..+7
        "ring buffer with a mask",
        "Run",
        (((), 28),),
        """
SIZE = 8
class RING(struct):
    head: uint16
    tail: uint16
    data: array[int16, 8]
Rx: RING = (0, 0)
def Put(r: ptr[RING], x: int16) -> int16:
    next: uint16
    next = (r.head + 1) & (SIZE - 1)
    if next == r.tail:
        return 0
    r.data[r.head] = x
    r.head = next
    return 1
def Get(r: ptr[RING], x: ptr[int16]) -> int16:
    if r.head == r.tail:
        return 0
    x[0] = r.data[r.tail]
    r.tail = (r.tail + 1) & (SIZE - 1)
    return 1
def Run() -> int16:
    i: int16
    x: int16
    sum: int16 = 0
    for i in range(1, 13):
        Put(addressof(Rx), i)
    while Get(addressof(Rx), addressof(x)):
        sum += x
    return sum
""",
    ),
    Driver(
        # 7 is pressed long enough at the third sample, released at the sixth
        "debouncer as a state machine",
        "Run",
        (((), 21),),
        """
class STATE(enum):
    IDLE = 0
    MAYBE = 1
    PRESSED = 2
State: STATE = 0
Count: uint16 = 0
Levels: const[array[int16, 10]] = (0, 1, 1, 1, 1, 0, 0, 1, 0, 0)
def Step(level: int16) -> int16:
    out: int16
    match State:
        case STATE.IDLE:
            out = 0
            if level:
                State = STATE.MAYBE
                Count = 1
        case STATE.MAYBE:
            out = 1
            if not level:
                State = STATE.IDLE
            elif Count >= 2:
                State = STATE.PRESSED
            else:
                Count += 1
        case STATE.PRESSED:
            out = 10
            if not level:
                State = STATE.IDLE
    return out
def Run() -> int16:
    i: int16
    sum: int16 = 0
    for i in range(10):
        sum += Step(Levels[i])
    return sum - 2
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
        # median of 9 2 7 4 5 by insertion sort: 5
        "median by insertion sort over a pointer",
        "Median",
        (((), 5.0),),
        """
v: array[float32, 5] = (9, 2, 7, 4, 5)
def Sort(p: ptr[float32], n: uint16) -> void:
    i: uint16
    j: uint16
    x: float32
    for i in range(1, n):
        x = p[i]
        j = i
        while j > 0 and p[j - 1] > x:
            p[j] = p[j - 1]
            j -= 1
        p[j] = x
def Median() -> float32:
    w: array[float32, 5]
    memcpy(w, v, sizeof(v))
    Sort(w, 5)
    return w[5 / 2]
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
        # 3 + 4, 3 - 4, 3 * 4
        "table of functions",
        "Apply",
        (((0, 3, 4), 7), ((1, 3, 4), -1), ((2, 3, 4), 12)),
        """
def Plus(a: int16, b: int16) -> int16:
    return a + b
def Minus(a: int16, b: int16) -> int16:
    return a - b
def Times(a: int16, b: int16) -> int16:
    return a * b
Table: array[funcptr[int16, int16, int16], 3] = (Plus, Minus, Times)
def Apply(what: uint16, a: int16, b: int16) -> int16:
    if what > 2:
        return 0
    return Table[what](a, b)
""",
    ),
    Driver(
        # 1 + 2 + 3 along the list
        "linked list",
        "Sum",
        (((), 6),),
        """
class NODE(struct):
    value: int16
    next: ptr[void]
First: ptr[NODE] = NULL
Pool: array[NODE, 4]
Used: uint16 = 0
def Add(x: int16) -> void:
    n: ptr[NODE]
    if Used >= 4:
        return
    n = addressof(Pool[Used])
    Used += 1
    n.value = x
    n.next = First
    First = n
def Sum() -> int16:
    n: ptr[NODE]
    s: int16 = 0
    i: int16
    for i in range(1, 4):
        Add(i)
    n = First
    while n != NULL:
        s += n.value
        n = cast(ptr[NODE], n.next)
    return s
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
        "a number in text and back",
        "Back",
        (((-32768,), -32768), ((0,), 0), ((1207,), 1207)),
        """
Text: array[char, 8]
def Write(x: int16) -> void:
    digits: array[char, 6]
    n: uint16 = 0
    i: uint16
    p: ptr[char]
    m: uint16
    p = Text
    if x < 0:
        p[0] = '-'
        p += 1
        m = uint16(-int32(x))
    else:
        m = uint16(x)
    while 1:
        digits[n] = char('0' + m % 10)
        n += 1
        m = m / 10
        if m == 0:
            break
    i = n
    while i > 0:
        i -= 1
        p[0] = digits[i]
        p += 1
    p[0] = 0
def Read() -> int16:
    p: ptr[char]
    sign: int16 = 1
    x: int32 = 0
    p = Text
    if p[0] == '-':
        sign = -1
        p += 1
    while p[0] >= '0' and p[0] <= '9':
        x = x * 10 + (p[0] - '0')
        p += 1
    return int16(sign * x)
def Back(x: int16) -> int16:
    Write(x)
    return Read()
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
        "binary search",
        "Find",
        (((7,), 3), ((8,), -1), ((1,), 0), ((20,), 6)),
        """
Sorted: const[array[int16, 7]] = (1, 3, 5, 7, 9, 11, 20)
def Find(x: int16) -> int16:
    low: int16 = 0
    high: int16 = 6
    while low <= high:
        middle: int16
        middle = (low + high) / 2
        if Sorted[middle] == x:
            return middle
        if Sorted[middle] < x:
            low = middle + 1
        else:
            high = middle - 1
    return -1
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
        # commas at 4 and 9
        "fields of a frame",
        "Field",
        (((0,), 12.5), ((1,), -3.0), ((2,), 7.0)),
        """
Frame: array[char, 16] = "12.5,-3,7"
def Skip(p: ptr[char], n: int16) -> ptr[char]:
    while n > 0 and p[0] != 0:
        if p[0] == ',':
            n -= 1
        p += 1
    return p
def Field(n: int16) -> float32:
    return atof(Skip(Frame, n))
""",
    ),
    Driver(
        # pointers to pointers, a table of strings: longest of "no", "maybe", "yes" is 5
        "table of strings",
        "Longest",
        (((), 5),),
        """
Names: array[ptr[char], 3] = ("no", "maybe", "yes")
def Longest() -> int16:
    i: int16
    n: int16
    best: int16 = 0
    for i in range(3):
        n = int16(strlen(Names[i]))
        if n > best:
            best = n
    return best
""",
    ),
    Driver(
        # swap through pointers, difference of pointers
        "pointers in and out",
        "Work",
        (((), 213),),
        """
def Swap(a: ptr[int16], b: ptr[int16]) -> void:
    t: int16
    t = a[0]
    a[0] = b[0]
    b[0] = t
def Range(v: ptr[int16], n: int16, low: ptr[int16], high: ptr[int16]) -> int16:
    p: ptr[int16]
    low[0] = high[0] = v[0]
    p = v + 1
    while p < v + n:
        if p[0] < low[0]:
            low[0] = p[0]
        if p[0] > high[0]:
            high[0] = p[0]
        p += 1
    return int16(p - v)
def Work() -> int16:
    v: array[int16, 3] = (2, 1, 3)
    a: int16
    b: int16
    n: int16
    n = Range(v, 3, addressof(a), addressof(b))
    Swap(addressof(v[0]), addressof(v[1]))
    return v[1] * 100 + a * 10 + n + b - 3
""",
    ),
    Driver(
        # structures copied, arrays of structures, nested structures
        "structures in structures",
        "Path",
        (((), 25.0),),
        """
class POINT(struct):
    x: float32
    y: float32
class LEG(struct):
    start: POINT
    end: POINT
    speed: int16
Legs: array[LEG, 2] = (((0, 0), (3, 4), 2), ((3, 4), (3, 4), 1))
def Square(l: ptr[LEG]) -> float32:
    dx: float32
    dy: float32
    dx = l.end.x - l.start.x
    dy = l.end.y - l.start.y
    return dx * dx + dy * dy
def Path() -> float32:
    copy: LEG
    i: int16
    sum: float32 = 0
    for i in range(2):
        copy = Legs[i]
        sum += Square(addressof(copy))
        Legs[i].speed += 1
    return sum
""",
    ),
    Driver(
        "a flag that guards a value",
        "Choose",
        (((0, 5), -1), ((1, 5), 5)),
        """
def Choose(valid: int16, x: int16) -> int16:
    best: int16
    if valid:
        best = x
    if valid:
        return best
    return -1
""",
    ),
    Driver(
        # at least one turn
        "a loop that turns at least once",
        "Digits",
        (((0,), 1), ((99,), 2), ((30000,), 5)),
        """
def Digits(x: int16) -> int16:
    n: int16 = 0
    last: int16
    more: int16 = 1
    while more:
        n += 1
        x = x / 10
        last = x
        more = x != 0
    return n + last
""",
    ),
    Driver(
        "a switch with every constant of its enumeration",
        "Gain",
        (((0,), 1.0), ((1,), 2.0), ((2,), 4.0)),
        """
class SENSOR(enum):
    LEFT = 0
    FRONT = 1
    RIGHT = 2
def Gain(s: SENSOR) -> float32:
    g: float32
    match s:
        case SENSOR.LEFT:
            g = 1.0
        case SENSOR.FRONT:
            g = 2.0
        case SENSOR.RIGHT:
            g = 4.0
    return g
""",
    ),
    Driver(
        # continue and break, a value from the first hit
        "continue and break",
        "First",
        (((2,), 4), ((50,), -1)),
        """
v: array[int16, 6] = (1, -1, 3, -5, 4, 6)
def First(limit: int16) -> int16:
    i: int16
    found: int16 = -1
    for i in range(6):
        if v[i] < 0 or v[i] % 2:
            continue
        if v[i] > limit:
            found = v[i]
            break
    return found
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
    Driver(
        # memset, then a queue of messages in a two-dimensional array; 'b' + length 2
        "messages in rows",
        "Run",
        (((), 100),),
        """
Rows: array[array[char, 6], 3]
def Push(n: uint16, text: ptr[char]) -> void:
    i: uint16 = 0
    while text[i] != 0 and i < 5:
        Rows[n][i] = text[i]
        i += 1
    Rows[n][i] = 0
def Run() -> int16:
    memset(Rows, 0, sizeof(Rows))
    Push(0, "a")
    Push(1, "bc")
    Push(2, "toolong")
    return Rows[1][0] + int16(strlen(Rows[1])) + (0 if Rows[2][5] == 0 else 1000)
""",
    ),
    Driver(
        # nested switch and conditional expressions; orders 'F' 2 -> 20, 'S' -> 0, other -> -1
        "orders by character",
        "Order",
        (((70, 2), 20), ((83, 2), 0), ((88, 2), -1), ((70, 9), 99)),
        """
FORWARD = 'F'
def Order(c: char, n: int16) -> int16:
    r: int16 = -1
    match c:
        case 70:
            match n:
                case 1 | 2 | 3:
                    r = n * 10
                case _:
                    r = 99
        case 83:
            r = 0
    return r
""",
    ),
)
