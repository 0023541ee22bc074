"""Correct code for one construct of C each: branches, loops, functions."""

from __future__ import annotations

from typing import Final

from tests.emulator.c28x.specimens import Driver

DRIVERS: Final = (
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
)
