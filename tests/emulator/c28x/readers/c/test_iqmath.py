"""The IQmath library as a C program has it: its header, its functions by name, what the compiler has of it.

What the functions compute is tested in `tests/emulator/c28x/test_iq_arithmetic.py`.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.c28x import iq_arithmetic as iq
from tests.emulator.c28x.readers.c.workshop import CWorkshop, refused, run_c

HEAD = '#include "IQmathLib.h"\n'
ONE = 2**24


def value(expression: str, before: str = "", result: str = "long", **more: Any) -> Any:
    """What an expression is, of x and y, in C; nothing is found."""
    shop = CWorkshop(f"{before}{HEAD}{result} f(_iq x, _iq y) {{ return {expression}; }}\n")
    found = shop.call("f", more.get("x", 0), more.get("y", 0))
    assert shop.rules() == []
    return found


@pytest.mark.parametrize(
    ("expression", "number"),
    [
        # A constant is truncated towards 0; 0.1 is the float 13421773 / 2**27, which is 1677721.6 / 2**24.
        ("_IQ(1.0)", ONE), ("_IQ(-0.5)", -ONE // 2), ("_IQ(0.1)", 1677721), ("_IQ(-0.1)", -1677721),
        ("_IQ(3)", 3 * ONE),
        ("_IQ1(1.75)", 3), ("_IQ30(-2)", -(2**31)), ("_IQ15(0.8) - _IQ16(0.4)", 0),
        # Other formats: bits go, or zeros come.
        ("_IQtoIQ20(_IQ(-1.0) - 1)", -(2**20) - 1), ("_IQtoIQ28(_IQ(1.5))", 3 << 27),
        ("_IQ30toIQ(_IQ30(1.5))", 3 << 23),
        ("_IQ15toIQ(_IQ15(0.25))", 1 << 22), ("_IQtoQ15(_IQ(0.75))", 24576), ("_Q15toIQ(-24576)", -3 << 22),
        ("_IQtoIQ24(5)", 5), ("_IQtoQ1(_IQ(1.5))", 3), ("_Q1toIQ(3)", 3 << 23), ("_IQ1toIQ(3)", 3 << 23),
        # Products: 2.5 * -1.5 = -3.75; -1 unit * 1.0 stays; half a unit goes down, and up with rounding.
        ("_IQmpy(_IQ(2.5), _IQ(-1.5))", -15 << 22), ("_IQmpy(-1, _IQ(1.0))", -1), ("_IQmpy(-1, _IQ(0.5))", -1),
        ("_IQrmpy(-1, _IQ(0.5))", 0), ("_IQrmpy(3, _IQ(0.5))", 2), ("_IQ8mpy(_IQ8(2.0), 3)", 6),
        ("_IQrsmpy(_IQ(100.0), _IQ(-100.0))", -(2**31)),
        ("_IQ20rsmpy(_IQ20(100.0), _IQ20(100.0))", 2**31 - 1),
        ("_IQmpyI32(_IQ(0.5), 3)", 3 << 23), ("_IQmpyI32int(_IQ(-0.75), 10)", -7),
        ("_IQmpyI32frac(_IQ(-0.75), 10)", -ONE // 2),
        # Q30 times Q28 is Q58, 34 bits more than Q24: 1.5 * 2.25 = 3.375.
        ("_IQmpyIQX(_IQ30(1.5), 30, _IQ28(2.25), 28)", 27 << 21),
        ("_IQ20mpyIQX(_IQ30(1.5), 30, _IQ28(2.25), 28)", 27 << 17),
        ("_IQmpyIQX(_IQ2(10.0), 2, _IQ1(3.0), 1)", 30 << 24), ("__IQxmpy(1L << 20, 1L << 20, -4)", 16),
        ("__IQxmpy(1L << 20, 1L << 20, 0)", 256), ("__IQmpy(7L, -1L, 0)", -7),
        ("_IQmpy4(_IQ(1.0))", 4 * ONE), ("_IQmpy64(_IQ(-1.0))", -64 * ONE), ("_IQdiv2(3)", 1), ("_IQdiv64(-1)", -1),
        ("_IQdiv(_IQ(1.0), _IQ(3.0))", 5592405), ("_IQ15div(_IQ15(3.0), _IQ15(2.0))", 49152),
        ("_IQsat(_IQ(2.0), _IQ(1.0), _IQ(-1.0))", ONE), ("_IQsat(_IQ(-2.0), _IQ(1.0), _IQ(-1.0))", -ONE),
        ("_IQint(_IQ(-3.75))", -3), ("_IQfrac(_IQ(-3.75))", -3 << 22), ("_IQabs(_IQ(-1.5))", 3 << 23),
        ("_IQsqrt(_IQ(9.0))", 3 * ONE), ("_IQisqrt(_IQ(0.25))", 2 * ONE), ("_IQmag(_IQ(3.0), _IQ(4.0))", 5 * ONE),
        ("_IQsinPU(_IQ(0.25))", ONE), ("_IQcosPU(_IQ(0.5))", -ONE),
        # 26353589 / (2 pi) is 4194303.96: truncated, and the rest of a turn.
        ("_IQatan2PU(_IQ(-1.0), _IQ(0.0))", ONE - 4194303),
        ("_IQlog(_IQ(1.0))", 0), ("_IQexp(0)", ONE), ("__IQ(-2.5f, 4)", -40),
        ('_atoIQ("-1.5")', -3 << 23), ('_atoIQ10("1.5")', 1536), ("MAX_IQ_POS", 2**31 - 1), ("MIN_IQ_NEG", -1),
        ("QG + Q7", 31),
    ],
)  # fmt: skip
def test_each_macro_by_hand(expression: str, number: int) -> None:
    assert value(expression) == number


@pytest.mark.parametrize(
    ("expression", "exact"),
    [
        ("_IQsin(_IQ(1.0))", math.sin(1)), ("_IQcos(_IQ(-2.0))", math.cos(2)), ("_IQasin(_IQ(0.5))", math.asin(0.5)),
        ("_IQacos(_IQ(-0.75))", math.acos(-0.75)), ("_IQatan(_IQ(2.0))", math.atan(2)),
        ("_IQatan2(_IQ(-1.0), _IQ(-2.0))", math.atan2(-1, -2)), ("_IQexp(_IQ(1.5))", math.exp(1.5)),
        ("_IQlog(_IQ(7.0))", math.log(7)),
    ],
)  # fmt: skip
def test_functions_of_angles(expression: str, exact: float) -> None:
    assert abs(value(expression) - exact * ONE) <= 4


def test_a_number_becomes_a_float() -> None:
    assert value("_IQtoF(_IQ(1.5))", result="float") == 1.5
    assert value("_IQ30toF(3L << 28)", result="float") == 0.75
    assert value("_IQtoF(_IQ(-1.0))", result="float") == -1.0 + 2.0**-24  # the library takes the complement


@pytest.mark.parametrize(("before", "q"), [
    ("#define GLOBAL_Q 18\n", 18), ("#define GLOBAL_Q (20)\n", 20), ("#define GLOBAL_Q Q10\n#define Q10 10\n", 10),
    ("#define GLOBAL_Q 1\n", 1), ("#define GLOBAL_Q 30\n", 30),
])  # fmt: skip
def test_a_program_chooses_its_format(before: str, q: int) -> None:
    assert value("_IQ(0.5)", before) == 1 << q - 1
    assert value("_IQmpy(x, y)", before, x=3 << q - 1, y=1 << q - 1) == (3 << q) // 4
    assert value("_IQdiv(x, y)", before, x=1 << q - 1, y=1 << q) == 1 << q - 1
    assert value("_IQtoIQ15(x)", before, x=1 << q) == 1 << 15
    assert value("_IQtoF(x)", before, "float", x=1 << q) == 1.0
    assert value("_IQatan(x)", before, x=0) == 0


longs = st.integers(-(2**31), 2**31 - 1)


@given(a=longs, b=longs)
@settings(max_examples=150, deadline=None)
def test_products_and_quotients_of_C_are_those_of_fractions(a: int, b: int) -> None:
    found = _shop.call("products", a, b)
    exact = Fraction(a * b, 2**20)
    assert _shop.call("rounded", a, b) == max(-(2**31), min(math.floor(exact + Fraction(1, 2)), 2**31 - 1))
    assert (found - math.floor(exact)) % 2**32 == 0
    assert -(2**31) <= found < 2**31
    assert _shop.call("quotients", a, b) == iq.divide(a, b, 20)


_shop = CWorkshop(
    f"#define GLOBAL_Q 20\n{HEAD}_iq products(_iq a, _iq b) {{ return _IQmpy(a, b); }}\n"
    "_iq rounded(_iq a, _iq b) { return _IQrsmpy(a, b); }\n_iq quotients(_iq a, _iq b) { return _IQdiv(a, b); }\n"
)


def test_constants_initialise_objects() -> None:
    text = HEAD + """
        typedef struct { _iq gain; _iq15 limit; } PART;
        PART part = { _IQ(0.25), _IQ15(-1.5) };
        _iq table[] = { _IQ(1), _IQ(2.5), _IQtoIQ20(_IQ(1.0)) };
        long f(void) { return part.gain + part.limit + table[0] + table[1] + table[2]; }
    """
    assert run_c(text, "f") == ONE // 4 - 49152 + ONE + 5 * ONE // 2 + 2**20


def test_a_constant_of_64_bits_is_as_exact_as_the_compilers() -> None:
    # 0.1 * 2**30 is 107374182.4; of the float 0.1, 13421773 / 2**27, it is 107374184.
    assert value("_IQ30(0.1L)") == 107374182
    assert value("_IQ30(-0.1L)") == -107374182
    assert value("_IQ30(0.1)") == 107374184
    assert value("_IQ30(1.0L / 3)") == 357913941  # 2**30 / 3 = 357913941.33
    assert value("_IQ(0.1L + x)", x=2) == 35232153  # 2.1 * 2**24 is 35232153.6
    before = "float half(float f) { return f * 0.5L + (f > 0.1L ? 0.25L : f); }\n"
    assert value("(long)(8 * half(2.0f)) + (long)sizeof(float)", before) == 10 + 2


def test_a_function_has_an_address() -> None:
    text = HEAD + """
        long twice(long (*of)(long a, long b), long a, long b) { return 2 * of(a, b); }
        long f(void) { return twice(_IQ10div, 1024, 2048); }
    """
    assert run_c(text, "f") == 1024


def test_a_number_is_printed_into_a_buffer() -> None:
    text = HEAD + """
        char text[12];
        int f(void) { return _IQtoa(text, "%3.4f", _IQ(-1.625)); }
    """
    shop = CWorkshop(text)
    assert shop.call("f") == 0
    data = shop.linked.objects["drv.text"].data
    assert "".join(map(chr, data[: data.index(0)])) == "-1.625"
    assert shop.rules() == []


def test_a_product_that_does_not_fit_is_found_where_it_is_made() -> None:
    shop = CWorkshop(HEAD + """_iq f(_iq a)
{
    _iq b = _IQmpy(a, a);
    return b;
}
""")
    assert shop.call("f", 10 * ONE) == 100 * ONE
    # 20 * 20 = 400, which is 16 modulo 128 * 2: 400 - 384
    assert shop.call("f", 20 * ONE) == iq.wrap32(400 * ONE) == -112 * ONE
    (finding,) = shop.findings
    assert (finding.rule, finding.object, finding.place.line) == ("overflow", "__IQmpy", 4)
    assert "does not fit 32 bits" in finding.message


def test_saturation_is_no_finding() -> None:
    assert value("_IQrsmpy(x, x) - _IQdiv(x, 0)", x=-20 * ONE) == 0
    assert value("_IQdiv(x, 1)", x=-20 * ONE) == -(2**31)


def test_floats_take_the_place_of_the_format() -> None:
    before = "#define MATH_TYPE 1\n"
    assert value("_IQmpy(_IQ(2.5f), _IQ15(-1.5f))", before, "float") == -3.75
    assert value("_IQsqrt(_IQdiv(_IQ(9.0), 4)) + _IQtoF(_IQfrac(_IQ(2.25)))", before, "float") == 1.75
    assert value("_IQint(_IQmpyI32(_IQ(2.25), 2)) + _IQtoQ15(0.5f)", before) == 4 + 16384
    several = "_IQsat(_IQ(2.0), 1.0f, -1.0f) + _IQmag(3.0f, 4.0f) + _IQatan2PU(-1.0f, 0.0f)"
    assert value(several, before, "float") == 6.75


# A header of the user's own

OWN = """
#define GLOBAL_Q 16
typedef long _iq;
#define _IQ(A) ((long)((A) * 65536.0L))
#define _IQmpy(A, B) __IQmpy(A, B, GLOBAL_Q)
#define _IQsat(A, Pos, Neg) __IQsat(A, Pos, Neg)
extern long _IQ16div(long A, long B);
#define _IQdiv(A, B) _IQ16div(A, B)
"""
PROGRAM = """#include "IQmathLib.h"
_iq f(_iq a) { return _IQdiv(_IQmpy(a, _IQ(1.5)), _IQ(3.0)); }
"""


def test_a_header_of_the_programs_own_is_read_in_the_place_of_ours() -> None:
    shop = CWorkshop({"drv.c": PROGRAM, "IQmathLib.h": OWN})
    assert shop.call("f", 1 << 16) == 1 << 15
    for spelling in ("<IQmathLib.h>", '"iqmathlib.H"'):
        text = PROGRAM.replace('"IQmathLib.h"', spelling)
        assert CWorkshop({"drv.c": text, "IQmathLib.h": OWN}).call("f", 1 << 16) == 1 << 15


def test_a_function_of_the_programs_own_takes_the_librarys_place() -> None:
    own = PROGRAM + "long _IQ24div(long A, long B) { return A - B; }\n"
    assert CWorkshop(own).call("f", 2 * ONE) == 0


def test_what_the_library_has_not_is_not_there() -> None:
    # An arc sine of Q30 would not fit its format: pi / 2 is beyond 2 only for -2, but the library ends at 29.
    with pytest.raises(Exception, match="_IQ30asin"):
        CWorkshop(HEAD + "long f(long a) { return _IQ30asin(a); }\n")
    assert "__IQmpy" in refused(HEAD + "long f(long a) { return __IQmpy(a, a); }\n")[2]


# Time


def cycles(expression: str) -> int:
    shop = CWorkshop(f"{HEAD}_iq f(_iq x, _iq y) {{ return {expression}; }}\n")
    before = shop.clock.now
    shop.call("f", ONE, ONE)
    return shop.clock.now - before


def test_a_function_takes_the_benchmark_of_the_library_and_a_product_its_instructions() -> None:
    # With two arguments that are loaded: a division takes 70 cycles with call and return, from tables in ROM; a
    # product the four instructions of the compiler's.
    nothing = cycles("x + y") - 2  # an addition of longs
    assert cycles("_IQdiv(x, y)") - nothing == 70
    assert cycles("_IQmpy(x, y)") - nothing == 4
    assert cycles("_IQsin(x)") - cycles("x") == 47
    assert cycles("_IQint(x)") - cycles("x") == 16  # a call takes no less here; the benchmark says 15
