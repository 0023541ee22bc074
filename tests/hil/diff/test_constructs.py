"""Every construct that both languages have: the same few lines in both give equal trees, and do the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.diff.trees import compare_trees
from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import CWorkshop
from tests.emulator.c28x.workshop import Workshop

HEADER = "from emulator.c28x.language import *\n"

#: What -> C-shaped Python, C, a function with its arguments, and its value as C gives it.
CONSTRUCTS = {
    "a float of 64 bits": (
        """
class sample(struct):
    number: int16
    value: float64
last: sample
def half(x: float64) -> float64:
    return x / 2
def f(x: int32) -> int32:
    last.value = float64(x) + 1
    return int32(half(last.value * 3)) + sizeof(last)
""",
        """
struct sample { int number; long double value; };
struct sample last;
long double half(long double x) { return x / 2; }
long f(long x)
{
    last.value = (long double)x + 1;
    return (long)half(last.value * 3) + sizeof(last);
}
""",
        ("f", (20000001,), 30000009),  # 30000003, which a float does not hold, and 6 words
    ),
    "a structure as a parameter is a copy": (
        """
class point(struct):
    x: int16
    y: int16
def changed(p: point) -> int16:
    p.x = 7
    return p.x
def f() -> int16:
    p: point = (1, 2)
    return changed(p) * 10 + p.x
""",
        """
struct point { int x; int y; };
int changed(struct point p) { p.x = 7; return p.x; }
int f(void) { struct point p = {1, 2}; return changed(p) * 10 + p.x; }
""",
        ("f", (), 71),  # 7 in the callee, 1 is left here
    ),
    "a structure as a result, its member, a structure assigned": (
        """
class point(struct):
    x: int16
    y: int16
def made(x: int16, y: int16) -> point:
    p: point
    p.x = x
    p.y = y
    return p
def f() -> int16:
    p: point = made(1, 2)
    q: point
    q = p
    p.x = 5
    q = made(q.x, made(3, 4).y)
    return q.x * 100 + q.y * 10 + p.x
""",
        """
struct point { int x; int y; };
struct point made(int x, int y) { struct point p; p.x = x; p.y = y; return p; }
int f(void)
{
    struct point p = made(1, 2);
    struct point q;
    q = p;
    p.x = 5;
    q = made(q.x, made(3, 4).y);
    return q.x * 100 + q.y * 10 + p.x;
}
""",
        ("f", (), 145),  # q.x was copied before p.x became 5
    ),
    "a structure made of its members where it is used": (
        """
class point(struct):
    x: int16
    y: int16
    z: int16
def sum_of(p: point) -> int16:
    return p.x + 10 * p.y + 100 * p.z
def f(n: int16) -> int16:
    return sum_of(point(1, n)) + sum_of(point(z=2, x=n)) + point(4, 5).y
""",
        """
struct point { int x; int y; int z; };
int sum_of(struct point p) { return p.x + 10 * p.y + 100 * p.z; }
int f(int n)
{
    return sum_of((struct point){1, n}) + sum_of((struct point){.z = 2, .x = n}) + (struct point){4, 5}.y;
}
""",
        ("f", (3,), 239),  # 31 + 203 + 5
    ),
    "members and elements by name or number, and what is left out is 0": (
        """
class point(struct):
    x: int16
    y: int16
class line(struct):
    ends: array[point, 2]
    width: int16
GREEN = 1
v: array[int16, 5] = {4: 1, GREEN: 2}
w: array[int16] = (3, 4, 5)
text: array[char] = "ab"
l: line = line(ends=(point(y=6), point(7, 8)), width=9)
m: array[point] = {2: point(1, 2)}
def f() -> int16:
    return v[4] + v[1] + v[0] + l.ends[0].y * 10 + l.ends[1].x + l.ends[0].x + l.width + m[2].y
def g() -> int16:
    return sizeof(w) * 100 + sizeof(text) * 10 + sizeof(m)
""",
        """
#define GREEN 1
struct point { int x; int y; };
struct line { struct point ends[2]; int width; };
int v[5] = {[4] = 1, [GREEN] = 2};
int w[] = {3, 4, 5};
char text[] = "ab";
struct line l = {.ends = {{.y = 6}, {7, 8}}, .width = 9};
struct point m[] = {[2] = {1, 2}};
int f(void) { return v[4] + v[1] + v[0] + l.ends[0].y * 10 + l.ends[1].x + l.ends[0].x + l.width + m[2].y; }
int g(void) { return sizeof(w) * 100 + sizeof(text) * 10 + sizeof(m); }
""",
        ("f", (), 81),  # 1 + 2 + 0 + 60 + 7 + 0 + 9 + 2
    ),
    "lists of locals": (
        """
class point(struct):
    x: int16
    y: int16
def f(n: int16) -> int16:
    v: array[int16, 4] = {2: n}
    w: array[array[int16, 2], 2] = ((1, n), (3,))
    p: point = point(y=n)
    q: array[point, 2] = (p, point(5, 6))
    return v[2] + v[3] + w[0][1] + w[1][1] + p.x + p.y + q[0].y + q[1].x
""",
        """
struct point { int x; int y; };
int f(int n)
{
    int v[4] = {[2] = n};
    int w[2][2] = {{1, n}, {3}};
    struct point p = {.y = n};
    struct point q[2] = {p, {5, 6}};
    return v[2] + v[3] + w[0][1] + w[1][1] + p.x + p.y + q[0].y + q[1].x;
}
""",
        ("f", (2,), 13),  # 2 + 0 + 2 + 0 + 0 + 2 + 2 + 5
    ),
    "a union": (
        """
class both(union):
    l: int32
    w: array[uint16, 2]
class number(union):
    f: float32
    u: uint32
u: number = number(u=0x40400000)
def f() -> uint16:
    b: both
    b.l = 0x12345678
    return b.w[1]
def g(x: float32) -> uint32:
    n: number
    c: number
    n.f = x
    c = n
    return c.u
def h() -> float32:
    return u.f
""",
        """
union both { long l; unsigned int w[2]; };
union number { float f; unsigned long u; };
union number u = {.u = 0x40400000};
unsigned int f(void) { union both b; b.l = 0x12345678; return b.w[1]; }
unsigned long g(float x) { union number n; union number c; n.f = x; c = n; return c.u; }
float h(void) { return u.f; }
""",
        ("g", (1.5,), 0x3FC00000),  # 1.5 in IEEE single precision
    ),
    "bit-fields": (
        """
class flags(struct):
    a: Annotated[uint16, bits(3)]
    b: Annotated[int16, bits(5)]
    rest: Annotated[uint16, bits(0)]
    c: Annotated[uint16, bits(9)]
    n: int16
start: flags = (9, -1, 5)
def f(x: uint16) -> int16:
    f: flags = flags(a=9)
    f.a = x
    f.b = 31
    f.a += 2
    f.c = f.a
    return f.a * 100 + f.b * 10 + f.c
def g() -> int16:
    return start.a * 100 + start.b * 10 + start.c + sizeof(flags)
""",
        """
struct flags { unsigned int a : 3; int b : 5; unsigned int : 0; unsigned int c : 9; int n; };
struct flags start = {9, -1, 5};
int f(unsigned int x)
{
    struct flags f = {.a = 9};
    f.a = x;
    f.b = 31;
    f.a += 2;
    f.c = f.a;
    return f.a * 100 + f.b * 10 + f.c;
}
int g(void) { return start.a * 100 + start.b * 10 + start.c + sizeof(struct flags); }
""",
        ("g", (), 98),  # 9 in 3 bits is 1, -1, then 5 in a new word: 100 - 10 + 5, and 3 words
    ),
    "do": (
        """
def f(n: int16) -> int16:
    turns: int16 = 0
    sum: int16 = 0
    while do(n > 0):
        turns += 1
        n -= 1
        if turns == 2:
            continue
        sum += turns
    return turns * 10 + sum
""",
        """
int f(int n)
{
    int turns = 0;
    int sum = 0;
    do {
        turns++;
        n--;
        if (turns == 2)
            continue;
        sum += turns;
    } while (n > 0);
    return turns * 10 + sum;
}
""",
        ("f", (3,), 34),  # three turns, 1 + 3
    ),
    "the body of do runs once at least, and its test may call": (
        """
calls: int16 = 0
def more(n: int16) -> int16:
    global calls
    calls += 1
    return n < 2
def f() -> int16:
    n: int16 = 0
    while do(more(n) and n != 9):
        n += 1
    return n * 10 + calls
""",
        """
int calls = 0;
int more(int n) { calls += 1; return n < 2; }
int f(void) { int n = 0; do n += 1; while (more(n) && n != 9); return n * 10 + calls; }
""",
        ("f", (), 22),
    ),
    "cases that fall through": (
        """
def f(x: int16) -> int16:
    r: int16 = 0
    match x:
        case 1:
            r += 1
            fallthrough()
        case 2 | 3:
            r += 2
        case 4:
            fallthrough()
        case _:
            r += 4
    return r
""",
        """
int f(int x)
{
    int r = 0;
    switch (x) {
    case 1:
        r += 1;
    case 2: case 3:
        r += 2;
        break;
    case 4:
        ;
    default:
        r += 4;
    }
    return r;
}
""",
        ("f", (1,), 3),
    ),
    "a case beside the default": (
        """
def f(x: int16) -> int16:
    match x:
        case 1:
            return 5
        case 2 | _:
            return 6
""",
        "int f(int x) { switch (x) { case 1: return 5; case 2: default: return 6; } }\n",
        ("f", (9,), 6),
    ),
    "static locals": (
        """
def counter() -> int16:
    n: static[int16] = 0
    table: static[const[array[int16, 3]]] = (10, 20, 30)
    n += 1
    return table[n - 1]
def other() -> int16:
    n: static[int16] = 100
    n += 1
    return n
def f() -> int16:
    counter()
    other()
    return counter() + other()
""",
        """
int counter(void)
{
    static int n = 0;
    static const int table[3] = {10, 20, 30};
    n += 1;
    return table[n - 1];
}
int other(void) { static int n = 100; n += 1; return n; }
int f(void) { counter(); other(); return counter() + other(); }
""",
        ("f", (), 122),  # 20 + 102
    ),
    "an assignment within an expression": (
        """
level: int16 = 0
def next_level() -> int16:
    global level
    level += 1
    return level
def f(limit: int16) -> int16:
    n: int16
    last: int16 = 0
    m: int16
    while (n := next_level()) < limit:
        last = n
    if (m := last + 1) > 2 and (n := m) == limit:
        last = (n := n + 1) * 2
    return last + n + m
""",
        """
int level = 0;
int next_level(void) { level += 1; return level; }
int f(int limit)
{
    int n;
    int last = 0;
    int m;
    while ((n = next_level()) < limit)
        last = n;
    if ((m = last + 1) > 2 && (n = m) == limit)
        last = (n = n + 1) * 2;
    return last + n + m;
}
""",
        ("f", (3,), 15),  # last 2, m 3, n 3 + 1, last 8: 8 + 4 + 3
    ),
    "tables of functions": (
        """
def one(n: int16) -> int16:
    return n + 1
def two(n: int16) -> int16:
    return n * 2
table: array[funcptr[int16, int16], 2] = (one, two)
class entry(struct):
    name: ptr[char]
    run: funcptr[int16, int16]
entries: array[entry] = (entry("one", one), entry(run=two))
idle: funcptr[ptr[char]]
def f(n: int16) -> int16:
    chosen: funcptr[int16, int16] = table[1]
    return chosen(n) + table[0](n) + entries[1].run(n)
""",
        """
int one(int n) { return n + 1; }
int two(int n) { return n * 2; }
int (*table[2])(int) = {one, two};
struct entry { char *name; int (*run)(int); };
struct entry entries[] = {{"one", one}, {.run = two}};
char *(*idle)(void);
int f(int n) { int (*chosen)(int) = table[1]; return chosen(n) + table[0](n) + entries[1].run(n); }
""",
        ("f", (5,), 26),  # 10 + 6 + 10
    ),
    "64-bit integers": (
        """
total: uint64 = 0x100000000
def f(n: int32) -> int64:
    wide: int64 = int64(n) * n
    wide -= 1
    return wide >> 4
def g() -> uint64:
    return total / 3
""",
        """
unsigned long long total = 0x100000000;
long long f(long n) { long long wide = (long long)n * n; wide -= 1; return wide >> 4; }
unsigned long long g(void) { return total / 3; }
""",
        ("f", (1 << 20,), (2**40 - 1) >> 4),
    ),
    "const and volatile": (
        """
flag: volatile[uint16] = 1
limit: const[uint16] = 7
table: array[const[int16], 2] = (1, 2)
def f(n: const[int16]) -> int16:
    twice: const[int16] = n + n
    i: volatile[int16] = 0
    i = twice
    return i + limit + table[1] + flag
""",
        """
volatile unsigned int flag = 1;
const unsigned int limit = 7;
const int table[2] = {1, 2};
int f(const int n)
{
    const int twice = n + n;
    volatile int i = 0;
    i = twice;
    return i + limit + table[1] + flag;
}
""",
        ("f", (4,), 18),  # 8 + 7 + 2 + 1
    ),
    "enumerations, casts between pointers and numbers, sizes": (
        """
class mode(enum):
    IDLE = 0
    RUN = 5
words: array[uint16, 4] = (1, 2, 3, 4)
def f(m: mode) -> uint16:
    p: ptr[uint16] = addressof(words[1])
    address: uint32 = uint32(p)
    q: ptr[uint32] = cast(ptr[uint32], addressof(words))
    if m == mode.RUN:
        p = p + 1
    return p[0] * 100 + uint16(q[0] >> 16) * 10 + (uint32(p) - address)
""",
        """
enum mode { IDLE = 0, RUN = 5 };
unsigned int words[4] = {1, 2, 3, 4};
unsigned int f(enum mode m)
{
    unsigned int *p = &words[1];
    unsigned long address = (unsigned long)p;
    unsigned long *q = (unsigned long *)&words;
    if (m == RUN)
        p = p + 1;
    return p[0] * 100 + (unsigned int)(q[0] >> 16) * 10 + ((unsigned long)p - address);
}
""",
        ("f", (5,), 321),
    ),
    "a for that is no count is a while": (
        """
def f(n: int16) -> int16:
    i: int16
    k: int16 = 0
    i = 0
    while i <= n:
        k += i
        i += 2
    return k
""",
        "int f(int n) { int i; int k = 0; for (i = 0; i <= n; i += 2) k += i; return k; }\n",
        ("f", (6,), 12),
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", CONSTRUCTS)
def test_both_languages_give_equal_trees(tmp_path: Path, what: str) -> None:
    python, c, _ = CONSTRUCTS[what]
    (tmp_path / "drv.py").write_text(HEADER + python)
    (tmp_path / "drv.c").write_text(c)
    port, own = (Build([str(tmp_path / f"drv.{suffix}")]) for suffix in ("py", "c"))
    found = compare_trees(port.compiled, own.compiled, ["drv"])
    assert [str(d) for d in found.differences] == []
    assert found.equal


@pytest.mark.parametrize("what", CONSTRUCTS)
@pytest.mark.parametrize("watched", [False, True], ids=["plain", "watched"])
def test_both_languages_do_what_c_says(what: str, watched: bool) -> None:
    python, c, (function, arguments, value) = CONSTRUCTS[what]
    ported = Workshop(python, header=HEADER, watch=watched)
    assert getattr(ported, function)(*arguments) == value
    own = CWorkshop(c, watch=watched)
    assert own.call(function, *arguments) == value
    assert ported.rules() == own.rules()
