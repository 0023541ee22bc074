"""The functions of C's library that our headers have as C: what ISO C 7.12, 7.20 and 7.21 say of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.memory import NULL
from emulator.c28x.readers.c.library_text import TEXT
from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import CWorkshop

HEAD = """\
#include <math.h>
#include <stdlib.h>
#include <string.h>
static int up(const void *a, const void *b)
{
    long x = *(const long *)a, y = *(const long *)b;
    return x < y ? -1 : x > y;
}
typedef struct { float f; const char *name; int (*fn)(int); long long w; int odd; } record;
static int one(int x) { return x + 1; }
static int two(int x) { return x + 2; }
static int by_f(const void *a, const void *b)
{
    float x = ((const record *)a)->f, y = ((const record *)b)->f;
    return (x > y) - (x < y);
}
"""


def holds(body: str) -> list[str]:
    """The rules of what is found where a body that ends in `return CONDITION;` gives 1."""
    workshop = CWorkshop(f"{HEAD}int f(void)\n{{\n    char *end;\n    (void)end;\n    {body}\n}}\n")
    assert workshop.call("f") == 1, body
    return workshop.rules()


@pytest.mark.parametrize(
    "body",
    [
        # 7.20.1.4: blanks, sign, base by prefix; the end behind the last digit, at the text itself if there is none.
        'return strtol(" \\t-12,", &end, 10) == -12 && *end == \',\';',
        'return strtol("0x7fg", &end, 0) == 127 && *end == \'g\';',
        'return strtol("077", 0, 0) == 63 && strtol("Zz", 0, 36) == 35 * 36 + 35 && strtol("0x10", 0, 16) == 16;',
        'const char *t = "zz"; return strtol(t, &end, 10) == 0 && end == t;',
        # p8: beyond the type its ends; the least long is none beyond.
        'return strtol("2147483648", 0, 10) == 2147483647L && strtol("-2147483648", 0, 10) == -2147483647L - 1;',
        'return strtol("-99999999999", 0, 10) == -2147483647L - 1;',
        'return strtoul("4294967295", 0, 10) == 4294967295UL && strtoul("4294967296", 0, 10) == 4294967295UL;',
        # p5: a minus negates in the type.
        'return strtoul("-1", 0, 10) == 4294967295UL;',
        # 7.20.2: the same numbers after the same seed; without one, as after srand(1).  By hand: 1103515245 + 12345 =
        # 1103527590, divided by 65536 is 16838.
        "int a = rand(), b; srand(1); b = rand(); return a == b && a == 16838;",
        # 7.20.5.2: in rising order by the user's comparison, whatever the elements are.
        "long v[4] = { 100000L, -7, 5, 65536L }; qsort(v, 4, sizeof v[0], up); "
        "return v[0] == -7 && v[1] == 5 && v[2] == 65536L && v[3] == 100000L;",
        'record r[3] = { { 3, "c", one, 3, 3 }, { 1, "a", two, 1L << 20, 1 }, { 2, "b", one, 2, 2 } }; '
        "qsort(r, 3, sizeof r[0], by_f); "
        "return r[0].fn(1) == 3 && r[0].w == 1L << 20 && *r[2].name == 'c' && r[1].odd == 2;",
        # 7.20.5.1: the element that is equal, or null.
        "long v[3] = { -7, 5, 65536L }, k = 5, no = 6; "
        "return bsearch(&k, v, 3, sizeof k, up) == v + 1 && bsearch(&no, v, 3, sizeof k, up) == 0;",
        # C99 7.12.12: of a number and a NaN, the number.
        "union { unsigned long word; float f; } u; float n; u.word = 0x7FC00000UL; n = u.f; "
        "return fminf(2.0f, -3.0f) == -3 && fmaxf(2.0f, -3.0f) == 2 && fmaxf(n, 1.0f) == 1.0f && "
        "fmax(1.0, n) == 1.0f && fminf(n, 1.0f) == 1.0f && fminf(1.0f, n) == 1.0f && fminf(n, n) != fminf(n, n);",
        # C99 7.12.9: halves away from zero, also for the float below a half and for whole ones; towards zero.
        "return roundf(2.5f) == 3.0f && roundf(-2.5f) == -3.0f && roundf(0.49999997f) == 0 && "
        "round(8388609.0) == 8388609.0f && roundf(-0.4f) == 0;",
        "return truncf(2.7f) == 2.0f && trunc(-2.7) == -2.0f && lroundf(-70000.5f) == -70001 && lround(0.5) == 1;",
        # 7.21.5
        'return strspn("aab", "a") == 2 && strcspn("xyz,", ",;") == 3 && strcspn("xyz", ",") == 3;',
        'return *strpbrk("abc", "cb") == \'b\' && strpbrk("abc", "x") == 0;',
        # 7.21.5.8: tokens between any number of marks; null behind the last, and again.
        'char s[] = " a,b;;c "; char *a = strtok(s, " ,;"), *b = strtok(0, ",;"), *c = strtok(0, " ;"); '
        "return *a == 'a' && a[1] == 0 && *b == 'b' && b[1] == 0 && *c == 'c' && c[1] == 0 && !strtok(0, \" \") "
        '&& !strtok(0, " ");',
    ],
)  # fmt: skip
def test_a_function_does_what_the_standard_says(body: str) -> None:
    assert holds(body) == []


def test_a_null_pointer_is_found_where_the_function_is_called() -> None:
    workshop = CWorkshop("#include <stdlib.h>\nlong f(char *t)\n{\n    return strtol(t, 0, 10);\n}\n")
    workshop.call("f", NULL)
    assert {(f.rule, str(f.place)) for f in workshop.findings} == {("null-dereference", "f (drv.c:4:5)")}


def test_the_test_for_a_nan_is_no_comparison_of_floats(tmp_path: Path) -> None:
    """Neither the program's own, nor that of our fmin; a comparison of two floats is one."""
    file = tmp_path / "nan.c"
    lines = ("#include <math.h>", "int no(float x) { return x != x; }", "float low(float x) { return fminf(x, 1.0f); }")
    file.write_text("\n".join((*lines, "int same(float x, float y) { return x == y; }", "")), "utf-8")
    found = [f for f in Build([str(file)]).compiled.findings if f.rule == "float-equality"]
    assert [f.place.line for f in found if f.place is not None] == [4]


OWN = """\
#include <math.h>
#include <stdlib.h>
static float fminf(float a, float b) { return a < b ? a + 10.0f : b + 10.0f; }
int round(float x);
int round(float x) { return (int)(x + 7.5f); }
int rand(void) { return 4; }
int f(void) { return fminf(2.0f, 1.0f) == 11.0f && round(1.0f) == 8 && rand() == 4 && fmaxf(1.0f, 2.0f) == 2.0f; }
"""


@pytest.mark.parametrize("abi", ["coff", "eabi"])
def test_a_program_may_have_its_own(abi: str, tmp_path: Path) -> None:
    file = tmp_path / "own.c"
    file.write_text(OWN, "utf-8")
    assert Build([str(file)], abi=abi).image().call("own.f", []) == 1


def test_every_function_stands_under_its_own_name() -> None:
    for functions in TEXT.values():
        for name, text in functions.items():
            assert f" {name}(" in text or f"*{name}(" in text
