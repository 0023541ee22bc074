"""Correct code for one construct of C each: structures, arrays, pointers, texts."""

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
