"""C as projects for TI's compiler have it: what C99 or that compiler takes, and what each of it means."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.symbols import SourceError
from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import CWorkshop


def test_an_unsigned_initial_value_wraps() -> None:
    # ISO C99 6.2.5: unsigned types never overflow. -1U = 0xFFFF; 4055344126L is unsigned long by C89, whose negative is
    # 2^32 - 4055344126 = 239623170; 0xFFFF + 2U = 1; 3 of the four bits of the field b stay of 0xFFF3.
    text = """
    unsigned a = -1U;
    unsigned long b = -4055344126L;
    unsigned c = 0xFFFFU + 2;
    struct { unsigned b : 4; unsigned long w; } s = { -13U, 0UL - 2 };
    int compared = 3 > 2, chosen = 0 ? 1 : 7, both = 1 && 0;
    unsigned f(int n)
    {
        switch (n) {
            case 0: return a;
            case 1: return b == 239623170UL;
            case 2: return c;
            case 3: return s.b;
            case 4: return s.w == 0xFFFFFFFEUL;
            default: return compared * 100 + chosen * 10 + both;
        }
    }
    """
    shop = CWorkshop(text)
    assert [shop.call("f", n) for n in range(6)] == [0xFFFF, 1, 1, 3, 1, 170]
    assert not list(shop.findings)


def test_the_upper_bits_of_a_register_are_shifted_as_the_compiler_does() -> None:
    # 2 << 14 = 0x8000 and 3 << 14 = 0xC000: -32768 and -16384 as an int of 16 bits.
    text = """
    typedef enum { NONE = 0 << 14, ONE = 1 << 14, TWO = 2 << 14, THREE = 3 << 14 } mode_t;
    int f(mode_t m) { switch (m) { case TWO: return 2; case THREE: return 3; default: return m; } }
    """
    shop = CWorkshop(text)
    assert [shop.call("f", m) for m in (0, 0x4000, -0x8000, -0x4000)] == [0, 0x4000, 2, 3]


def test_a_definition_with_types_behind_the_list() -> None:
    text = """
    static unsigned sum(), twice();
    unsigned f(void)
    {
        static const char three[] = { 1, 2, 4 };
        return sum(three, 3) + twice(8);
    }
    static unsigned sum(at, n)
        const char *at;
        unsigned n;
    {
        unsigned total = 0;
        while (n-- > 0) total += *at++;
        return total;
    }
    static unsigned twice(x) { return 2 * x; }
    """
    assert CWorkshop(text).call("f") == 7 + 16


def test_an_enumeration_may_be_named_before_it_is_defined() -> None:
    text = """
    typedef enum colour colour_t;
    struct lamp { colour_t now; };
    enum colour { RED = 4, GREEN };
    int f(colour_t c) { struct lamp l; l.now = c; return l.now == GREEN; }
    """
    shop = CWorkshop(text)
    assert [shop.call("f", c) for c in (4, 5)] == [0, 1]


def test_names_may_hold_a_dollar() -> None:
    text = """
    float FS$$DIV(float a, float b);
    int a$ = 3;
    static int $next(int $) { static int n$; n$++; return $ + n$; }
    int f$(int p$1) { int $l = p$1 + a$; return $next($l); }
    """
    shop = CWorkshop(text)
    assert [shop.call("f$", 10), shop.call("f$", 10)] == [14, 15]


def test_an_inline_function_of_a_header_belongs_to_every_file() -> None:
    header = "inline int twice(int x) { return 2 * x; }\n"
    shop = CWorkshop({
        "a.c": header + "int f(int x) { return twice(x); }\n",
        "b.c": header + "int g(int x) { return twice(x) + 1; }\n",
    })
    assert (shop.call("f", 4), shop.call("g", 4)) == (8, 9)


@pytest.mark.parametrize(
    "text",
    [
        "unsigned *const at = &state;\nint f(void) { return *at; }\n",
        "unsigned *f(void) { return &state; }\n",
        "void f(void) { state = 3; }\n",
        "struct row { unsigned *at; };\nstruct row rows[] = { { &state } };\n",
    ],
)
def test_an_object_that_no_file_defines_is_told_where_it_is_named(tmp_path: Path, text: str) -> None:
    (tmp_path / "state.h").write_text("extern unsigned state;\n")
    (tmp_path / "a.c").write_text('#include "state.h"\n' + text)
    with pytest.raises(SourceError, match=r"a\.c:\d+:\d+: state is declared extern, and no file defines it: name "):
        Build([str(tmp_path / "a.c")])


def test_what_sizeof_names_need_not_be_defined(tmp_path: Path) -> None:
    (tmp_path / "row.h").write_text("extern int row[7];\n")
    (tmp_path / "a.c").write_text('#include "row.h"\nunsigned f(void) { return sizeof row + sizeof row[0]; }\n')
    assert Build([str(tmp_path / "a.c")]).image().call("a.f", []) == 8


def test_a_header_beside_the_file_goes_before_that_of_the_library(tmp_path: Path) -> None:
    (tmp_path / "math.h").write_text("#include <math.h>\ntypedef struct { float x, y; } vec_t;\n")
    (tmp_path / "a.c").write_text('#include "math.h"\nfloat f(vec_t *v) { return sqrt(v->x * v->x + v->y * v->y); }\n')
    (tmp_path / "b.c").write_text("#include <math.h>\nfloat g(float x) { return fabs(x); }\n")
    assert Build([str(tmp_path / "a.c"), str(tmp_path / "b.c")]).image().call("b.g", [-2.0]) == 2.0
