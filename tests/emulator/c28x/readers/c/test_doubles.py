"""Floats of 64 bits: `long double`, and `double` under the EABI.  They compute as Python's own numbers do."""

from __future__ import annotations

import math
import operator
from typing import Any, Final

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.arithmetic import f32
from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION, float_division
from emulator.c28x.passes import costs
from tests.emulator.c28x.readers.c.workshop import CWorkshop, findings_of, run_c
from tests.emulator.c28x.test_typed_text import as_methods

DOUBLES: Final = st.floats(allow_nan=False, allow_infinity=False, width=64)
TEXT: Final = """
long double added(long double a, long double b) { return a + b; }
long double less(long double a, long double b) { return a - b; }
long double times(long double a, long double b) { return a * b; }
long double divided(long double a, long double b) { return a / b; }
int compared(long double a, long double b) { return (a < b) | (a == b) << 1 | (a >= b) << 2 | (a != b) << 3; }
float single(long double a) { return a; }
long double of_long(long a) { return a; }
long double of_unsigned(unsigned long long a) { return a; }
long double of_float(float a) { return -a; }
long whole(long double a) { return (long)a; }
unsigned int words[4];
unsigned int word(long double a, int i) { *(long double *)words = a; return words[i]; }
long double from_words(unsigned int a, unsigned int b, unsigned int c, unsigned int d)
{
    union { unsigned int w[4]; long double value; } u;
    u.w[0] = a; u.w[1] = b; u.w[2] = c; u.w[3] = d;
    return u.value;
}
"""


@pytest.fixture(scope="module")
def shops() -> list[CWorkshop]:
    """The functions of `TEXT`: plain, watched, and as methods with typed variables."""
    with as_methods():
        methods = CWorkshop(TEXT)
    return [CWorkshop(TEXT), CWorkshop(TEXT, watch=True), methods]


@given(a=DOUBLES, b=DOUBLES)
def test_arithmetic_is_that_of_ieee_doubles(shops: list[CWorkshop], a: float, b: float) -> None:
    for shop in shops:
        for name, of in (("added", operator.add), ("less", operator.sub), ("times", operator.mul)):
            assert shop.call(name, a, b) == of(a, b) or math.isnan(of(a, b))
        if b:
            assert shop.call("divided", a, b) == a / b
        assert shop.call("compared", a, b) == (a < b) | (a == b) << 1 | (a >= b) << 2 | (a != b) << 3
        assert shop.call("of_float", f32(a)) == -f32(a)
        assert shop.call("single", a) == f32(a)


@given(a=DOUBLES)
def test_four_words_hold_all_of_it(shops: list[CWorkshop], a: float) -> None:
    for shop in shops:
        words = [shop.call("word", a, i) for i in range(4)]
        assert shop.call("from_words", *words) == a


@given(whole=st.integers(-(2**31), 2**31 - 1), wide=st.integers(0, 2**64 - 1))
def test_integers_become_doubles_and_back(shops: list[CWorkshop], whole: int, wide: int) -> None:
    for shop in shops:
        assert shop.call("of_long", whole) == whole
        assert shop.call("whole", float(whole)) == whole
        assert shop.call("of_unsigned", wide) == float(wide)


def test_a_division_by_zero_and_a_number_that_no_long_holds_are_told() -> None:
    shop = CWorkshop(TEXT, watch=True)
    assert shop.call("divided", -1.0, 0.0) == -math.inf
    assert shop.call("whole", 2.0**31) == 2**31 - 1
    assert shop.call("whole", -(2.0**31)) == -(2**31)
    assert shop.rules() == ["division-by-zero", "nan", "float-to-int"]


DELAY: Final = """
#define DEVICE_SYSCLK_FREQ 200000000UL
#define DEVICE_DELAY_US(x) wait(((((long double)(x)) / (1000000.0L / (long double)DEVICE_SYSCLK_FREQ)) - 9.0L) / 5.0L)
static unsigned long waited;
static void wait(unsigned long count) { waited = count; }
unsigned long variable(unsigned int us) { DEVICE_DELAY_US(us); return waited; }
unsigned long constant(void) { DEVICE_DELAY_US(1000); return waited; }
"""


def test_the_delay_of_driverlib_takes_a_variable() -> None:
    for abi in ("coff", "eabi"):
        shop = CWorkshop(DELAY, abi=abi, static=True)
        assert shop.call("variable", 1000) == shop.call("constant") == 39998
        assert shop.call("variable", 60000) == int((60000 / (1000000.0 / 200000000.0) - 9.0) / 5.0)
        assert shop.rules() == []


def test_operations_take_the_time_of_library_functions() -> None:
    text = "long double f(long double a, long double b) { return a %s b; }\n"
    text += "float g(float a, float b) { return a %s b; }\n"
    for op, cycles in costs.DOUBLE_OP.items():
        shop = CWorkshop(text % (op, op))
        shop.call("f", 3.0, 2.0)
        wide = shop.clock.now
        shop.call("g", 3.0, 2.0)
        single = shop.clock.now - wide
        in_hardware = float_division(DEFAULT_FLOAT_DIVISION).cycles if op == "/" else costs.FLOAT_OP
        assert wide - single == cycles - in_hardware


def test_never_written_ones_have_the_fill_that_was_asked_for() -> None:
    text = "long double x;\nint same(void) { return x == x; }\nint nothing(void) { return x == 0; }\n"
    assert CWorkshop(text).call("nothing") == 1
    assert CWorkshop(text, fill="nan").call("same") == 0
    assert CWorkshop(text, fill="ones").call("same") == 0
    assert CWorkshop(text, fill="random:3").call("nothing") == 0


# Printing, and the arguments that no parameter receives


def printed(text: str, abi: str, x: float = 0.1) -> tuple[str, list[str]]:
    """What `f(x)` prints into `out`, and the rules of what was found."""
    head = "#include <stdio.h>\n#include <stdarg.h>\nchar out[60] = { 0 };\nint at(int i) { return out[i]; }\n"
    shop = CWorkshop(head + text, abi=abi, static=True)
    length = shop.call("f", x)
    return "".join(chr(shop.call("at", i)) for i in range(length)), shop.rules()


@pytest.mark.parametrize("abi", ["coff", "eabi"])
def test_printf_takes_four_words_for_a_long_double(abi: str) -> None:
    text = 'int f(long double x) { return sprintf(out, "%d %.17Lg %ld", 1, x, 70000L); }\n'
    assert printed(text, abi) == ("1 0.10000000000000001 70000", [])


def test_printf_takes_a_double_as_the_abi_has_it() -> None:
    text = 'int f(double x) { float y = (float)x; return sprintf(out, "%.10f %.10f %d", x, y, 5); }\n'
    assert printed(text, "coff", f32(0.1)) == ("0.1000000015 0.1000000015 5", [])
    assert printed(text, "eabi", 0.1) == ("0.1000000000 0.1000000015 5", [])


def test_a_list_of_arguments_hands_doubles_on() -> None:
    text = """
    static int show(char *form, ...)
    {
        va_list list;
        int length;
        va_start(list, form);
        if (va_arg(list, long double) < 2.5L)
            return 0;
        length = vsprintf(out, form, list);
        va_end(list);
        return length;
    }
    int f(long double x) { return show("%.3Lf %.3f", 2.5L, x, 0.25f); }
    """
    for abi in ("coff", "eabi"):
        assert printed(text, abi) == ("0.100 0.250", [])


@pytest.mark.parametrize(
    ("abi", "call", "rules"),
    [
        ("coff", '"%f", x', ["varargs-type"]),
        ("eabi", '"%f", x', []),
        ("coff", '"%Lf", y', ["varargs-type"]),
        ("eabi", '"%Lf", y', []),
        ("coff", '"%d", x', ["varargs-type"]),
    ],
)
def test_a_format_that_reads_another_float_is_told(abi: str, call: str, rules: list[str]) -> None:
    text = f"int f(long double x, float y) {{ return sprintf(o, {call}) + (x > y); }}\n"
    shop = CWorkshop(f"#include <stdio.h>\nchar o[40];\n{text}", abi=abi, static=True)
    assert shop.rules() == rules


# EABI


def test_a_constant_without_a_suffix_is_a_double() -> None:
    text = "int f(void) { return (int)sizeof(1.0) * 10 + (int)sizeof(1.0f); }\nint g(float x) { return x == 0.1; }\n"
    for abi, sizes, same in (("coff", 22, 1), ("eabi", 42, 0)):
        shop = CWorkshop(text, abi=abi)
        assert (shop.call("f"), shop.call("g", f32(0.1))) == (sizes, same)


def test_the_functions_of_math_h_have_the_width_of_their_type() -> None:
    text = """
    #include <math.h>
    #include <stdlib.h>
    #include <float.h>
    double of_double(double x) { return sin(x) + round(x) + fmax(x, 0.0); }
    double of_float(float x) { return sinf(x) + roundf(x) + fmaxf(x, 0.0f); }
    double of_long(long double x) { return sinl(x) + roundl(x) + fmaxl(x, 0.0L); }
    double read(void) { return atof("0.1"); }
    int digits(void) { return DBL_DIG * 100 + LDBL_DIG; }
    """
    x = 0.7
    wide = math.sin(x) + 1.0 + x
    shop = CWorkshop(text, abi="eabi")
    assert shop.call("of_double", x) == shop.call("of_long", x) == wide
    narrow = f32(x)
    assert shop.call("of_float", narrow) == f32(f32(f32(math.sin(narrow)) + 1.0) + narrow)
    assert (shop.call("read"), shop.call("digits")) == (0.1, 1515)
    shop = CWorkshop(text)
    assert shop.call("of_double", narrow) == f32(f32(f32(math.sin(narrow)) + 1.0) + narrow)
    assert (shop.call("read"), shop.call("digits")) == (f32(0.1), 615)


def test_strtof_and_strtod_of_COFF_are_floats() -> None:
    text = """#include <stdlib.h>
float f(void)
{
    char *end;
    return strtof("2.5x", &end) + strtod("1.25", 0) + (*end == 'x') + sizeof(strtod("1", 0));
}
"""
    assert CWorkshop(text).call("f") == 6.75


def test_strtold_says_where_a_number_ends() -> None:
    text = """#include <stdlib.h>
    long double value;
    int f(void)
    {
        char *end;
        char *text = "-2.5e1x";
        value = strtold(text, &end);
        return (int)value * 10 + (int)(end - text) + (strtold("x", 0) == 0.0L);
    }
    """
    assert run_c(text, "f") == -243


def test_a_cut_fraction_of_a_long_double_is_meant_and_that_of_a_double_is_not() -> None:
    rules: dict[str, Any] = {
        text: [rule for rule, _ in findings_of(f"int f(void) {{ int a = {text}; return a; }}\n")]
        for text in ("2.5L * 3", "2.5")
    }
    assert rules == {"2.5L * 3": [], "2.5": ["assignment-loses"]}
