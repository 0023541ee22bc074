"""Correct drivers that keep data: buffers, lists, tables, texts.  Results: published check values, or by hand."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Driver

DRIVERS: Final = (
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
