"""Correct code for one construct of C each: what the translator must take, silently and rightly."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Driver

DRIVERS: Final = (
    Driver(
        "self ref struct",
        "f",
        (((), 3),),
        """
class NODE(struct):
    v: int16
    next: ptr[NODE]
a: NODE = (1, NULL)
b: NODE = (2, addressof(a))
def f() -> int16:
    return b.next.v + b.v
""",
    ),
    Driver(
        "fwd struct",
        "f",
        (((), 4),),
        """
class A(struct):
    b: ptr[B]
class B(struct):
    x: int16
y: B = (4,)
z: A = (addressof(y),)
def f() -> int16:
    return z.b.x
""",
    ),
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
        "case char",
        "f",
        (((70,), 1),),
        """
def f(c: char) -> int16:
    match c:
        case 'F':
            return 1
        case 'a' | 'b':
            return 2
        case _:
            return 0
""",
    ),
    Driver(
        "case neg",
        "f",
        (((-1,), 1),),
        """
def f(c: int16) -> int16:
    match c:
        case -1:
            return 1
        case 0x10:
            return 2
        case _:
            return 0
""",
    ),
    Driver(
        "fn ptr typedef",
        "f",
        (((), 9),),
        """
CB = funcptr[int16, int16]
class H(struct):
    id: int16
    cb: CB
def twice(x: int16) -> int16:
    return 2 * x
hs: array[H, 2] = ((1, twice), (2, NULL))
def run(c: CB, x: int16) -> int16:
    if c != NULL:
        return c(x)
    return -1
def f() -> int16:
    p: ptr[H]
    p = hs
    return hs[0].cb(4) + run(p[1].cb, 3) + run(p.cb, 1)
""",
    ),
    Driver(
        "struct copy init",
        "f",
        (((), 8),),
        """
class P(struct):
    x: int16
    y: int16
g: P = (1, 2)
def f() -> int16:
    c: P = g
    c.x = 5
    return c.x + c.y + g.x
""",
    ),
    Driver(
        "2d param",
        "f",
        (((), 15),),
        """
m: array[array[int16, 3], 2] = ((1, 2, 3), (4, 5, 6))
def s(rows: array[array[int16, 3], 2]) -> int16:
    i: int16
    t: int16 = 0
    for i in range(3):
        t += rows[1][i]
    return t
def f() -> int16:
    return s(m)
""",
    ),
    Driver(
        "ptr2ptr",
        "f",
        (((), 2),),
        """
a: int16 = 1
b: int16 = 2
def pick(p: ptr[ptr[int16]], w: int16) -> void:
    p[0] = addressof(a) if w else addressof(b)
def f() -> int16:
    q: ptr[int16]
    pick(addressof(q), 0)
    return q[0]
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
        "nested cond",
        "f",
        (((1, 5, 3), 5),),
        """
def f(a: int16, b: int16, c: int16) -> int16:
    return (a if a > c else c) if a > b else (b if b > c else c)
""",
    ),
    Driver(
        "do while",
        "f",
        (((), 12),),
        """
def f() -> int16:
    n: int16 = 0
    while 1:
        n += 3
        if not (n < 10):
            break
    return n
""",
    ),
    Driver(
        "ptr walk struct",
        "f",
        (((), 11.0),),
        """
class P(struct):
    x: int16
    y: float32
ps: array[P, 3] = ((1, 0.5), (2, 1.5), (3, 2.5))
def f() -> float32:
    p: ptr[P]
    s: float32 = 0
    p = ps
    while p < ps + 3:
        s += p.y * p.x
        p += 1
    return s
""",
    ),
    Driver(
        "neg index ptr",
        "f",
        (((), 2),),
        """
v: array[int16, 3] = (1, 2, 3)
def f() -> int16:
    p: ptr[int16]
    p = addressof(v[2])
    return p[-1]
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
        "strings",
        "f",
        (((), 46),),
        """
b: array[char, 12]
def f() -> int16:
    strcpy(b, "ab")
    strcat(b, "cd")
    return int16(strlen(b)) * 10 + (1 if strcmp(b, "abcd") == 0 else 0) + abs(-5)
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
        "global struct arr member",
        "f",
        (((), 16),),
        """
class T(struct):
    d: array[int16, 4]
    n: int16
t: array[T, 2]
def f() -> int16:
    i: int16
    j: int16
    s: int16 = 0
    for i in range(2):
        t[i].n = 0
        for j in range(4):
            t[i].d[j] = i + j
            t[i].n += 1
    for i in range(2):
        for j in range(t[i].n):
            s += t[i].d[j]
    return s
""",
    ),
    Driver(
        "uint loop down",
        "f",
        (((), 45),),
        """
def f() -> int16:
    i: int16
    s: int16 = 0
    for i in range(9, -1, -1):
        s += i
    return s
""",
    ),
    Driver(
        "void ptr",
        "f",
        (((), 4),),
        """
class C(struct):
    n: int16
c: C = (3,)
def work(arg: ptr[void]) -> int16:
    p: ptr[C]
    p = cast(ptr[C], arg)
    p.n += 1
    return p.n
def f() -> int16:
    return work(addressof(c))
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
        "const ptr const",
        "f",
        (((), 6),),
        """
TABLE: const[array[uint16, 3]] = (1, 2, 3)
def s(p: ptr[const[uint16]], n: int16) -> uint16:
    i: int16
    t: uint16 = 0
    for i in range(n):
        t += p[i]
    return t
def f() -> uint16:
    return s(TABLE, 3)
""",
    ),
    Driver(
        "global counter in for",
        "f",
        (((), 6),),
        """
k: int16 = 0
def f() -> int16:
    s: int16 = 0
    for k in range(3):
        s += k
    return s + k
""",
    ),
    Driver(
        "ifexp call",
        "f",
        (((), 2),),
        """
def g(x: int16) -> int16:
    return x + 1
def f() -> int16:
    return g(1) if g(0) else g(5)
""",
    ),
    Driver(
        "multi return enum",
        "f",
        (((), 1),),
        """
class R(enum):
    OK = 0
    ERR = 1
def g(x: int16) -> R:
    return R.OK if x else R.ERR
def f() -> int16:
    r: R
    r = g(1)
    if r == R.OK:
        return 1
    return 0
""",
    ),
    Driver(
        "bool expr assign",
        "f",
        (((1, 2), 1),),
        """
def f(a: int16, b: int16) -> int16:
    ok: int16
    ok = a > 0 and b > 0
    ok = not ok
    return ok + (a == 1) + (b != 2)
""",
    ),
    Driver(
        "ptr cond",
        "f",
        (((), 0),),
        """
v: array[int16, 2] = (1, 2)
def g(p: ptr[int16]) -> int16:
    if p:
        return p[0]
    if not p:
        return -1
    return 0
def f() -> int16:
    return g(NULL) + g(v)
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
        "nested struct ptr chain",
        "f",
        (((), 3.0),),
        """
class I(struct):
    v: array[float32, 2]
class O(struct):
    i: I
    p: ptr[I]
o: O
def f() -> float32:
    o.i.v[0] = 1.0
    o.i.v[1] = 2.0
    o.p = addressof(o.i)
    return o.p.v[1] + o.i.v[0]
""",
    ),
    Driver(
        "array of ptr struct",
        "f",
        (((), 3),),
        """
class S(struct):
    a: int16
x: S = (1,)
y: S = (2,)
tab: array[ptr[S], 2] = (addressof(x), addressof(y))
def f() -> int16:
    i: int16
    s: int16 = 0
    for i in range(2):
        s += tab[i].a
        tab[i].a = 0
    return s + x.a
""",
    ),
    Driver(
        "addressof member elem",
        "f",
        (((), 23),),
        """
class S(struct):
    d: array[int16, 3]
s: S = ((1, 2, 3),)
def inc(p: ptr[int16]) -> void:
    p[0] += 1
def f() -> int16:
    inc(addressof(s.d[1]))
    inc(s.d)
    return s.d[0] * 10 + s.d[1]
""",
    ),
    Driver(
        "sibling block locals",
        "f",
        (((), 3),),
        """
def f() -> int16:
    s: int16 = 0
    i: int16
    for i in range(2):
        t: int16 = i
        s += t
    for i in range(2):
        t: int16 = i * 2
        s += t
    return s
""",
    ),
    Driver(
        "an error path with break",
        "f",
        (((20,), -2),),
        """
def f(x: int16) -> int16:
    err: int16 = 0
    while 1:
        if x < 0:
            err = -1
            break
        if x > 10:
            err = -2
            break
        break
    return err
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
        "string compare loop",
        "f",
        (((), 10),),
        """
def eq(a: ptr[char], b: ptr[char]) -> int16:
    while a[0] == b[0]:
        if a[0] == 0:
            return 1
        a += 1
        b += 1
    return 0
def f() -> int16:
    return eq("MISN", "MISN") * 10 + eq("MISN", "STOP")
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
    Driver(
        "local fn ptr",
        "f",
        (((0,), 4),),
        """
def a() -> int16:
    return 1
def b() -> int16:
    return 2
def f(x: int16) -> int16:
    g: funcptr[int16]
    if x:
        g = a
    else:
        g = b
    return g() + g()
""",
    ),
    Driver(
        "early return in switch",
        "f",
        (((1,), 20),),
        """
class M(enum):
    A = 0
    B = 1
def f(m: M) -> int16:
    match m:
        case M.A:
            return 10
        case M.B:
            return 20
    return 0
""",
    ),
    Driver(
        "mutual recursion",
        "f",
        (((), 1),),
        """
def even(n: int16) -> int16:
    return 1 if n == 0 else odd(n - 1)
def odd(n: int16) -> int16:
    return 0 if n == 0 else even(n - 1)
def f() -> int16:
    return even(10)
""",
    ),
    Driver(
        "struct w struct array init",
        "f",
        (((), 6.0),),
        """
class V(struct):
    x: float32
    y: float32
class POLY(struct):
    n: int16
    pts: array[V, 3]
tri: const[POLY] = (3, ((0, 0), (4, 0), (0, 3)))
def f() -> float32:
    a: float32 = 0
    i: int16
    j: int16
    for i in range(tri.n):
        j = (i + 1) % tri.n
        a += tri.pts[i].x * tri.pts[j].y - tri.pts[j].x * tri.pts[i].y
    return a / 2
""",
    ),
)
