"""What checked code reports, with place, object, value; and that correct code is silent."""

from __future__ import annotations

import pytest

from emulator.c28x.runtime import EndlessPoll, UninitialisedRead
from tests.emulator.c28x.workshop import Workshop

ACCUMULATE = """
# us.c: total
def total(v: ptr[float32], n: uchar) -> float32:
    result: float32
    i: uchar
    for i in range(n):
        result += v[i]
    return result
data: array[float32, 3] = (1, 2, 3)
def f() -> float32:
    return total(data, 3)
"""


def test_an_uninitialised_accumulator_is_reported_once_with_declaration_line_and_path() -> None:
    w = Workshop(ACCUMULATE)
    assert w.f() == 6.0
    w.f()
    (finding,) = w.findings
    # The header has two lines and the source starts with an empty one: declared on line 6, read on line 9.
    assert (finding.rule, finding.object, finding.count) == ("uninitialised", "drv.total.result", 2)
    assert finding.place is not None
    assert (finding.place.line, finding.place.function, finding.place.c_file) == (9, "total", "us.c")
    assert "drv.py:6" in finding.declaration
    assert [place.function for place in finding.call_path] == ["total", "f"]


@pytest.mark.parametrize(
    ("fill", "expected"), [("zero", 6.0), ("random:1", None), ("random:2", None)], ids=["zero", "random:1", "random:2"]
)
def test_the_fill_decides_what_the_accumulator_held(fill: str, expected: float | None) -> None:
    first, second = Workshop(ACCUMULATE, fill=fill).f(), Workshop(ACCUMULATE, fill=fill).f()
    assert first == second
    if expected is not None:
        assert first == expected


def test_fill_nan_and_ones_poison_the_sum() -> None:
    for fill in ("nan", "ones"):
        assert Workshop(ACCUMULATE, fill=fill).f() != Workshop(ACCUMULATE, fill=fill).f()  # NaN


def test_fill_stack_leaves_the_last_result_in_the_frame() -> None:
    w = Workshop(ACCUMULATE, fill="stack")
    # Each call starts from what the one before left at the same place: 6, 12, 18.
    assert [w.f(), w.f(), w.f()] == [6.0, 12.0, 18.0]


def test_fill_trap_raises_at_the_line() -> None:
    w = Workshop(ACCUMULATE, fill="trap")
    with pytest.raises(UninitialisedRead, match=r"drv\.total\.result"):
        w.f()


def test_the_unsigned_index_below_zero_is_65535_and_is_named() -> None:
    source = "v: array[float32, 12]\ndef f() -> float32:\n    i: uchar = 0\n    return v[i - 1]\n"
    w = Workshop(source)
    w.f()
    assert w.rules() == ["index"]
    assert "v[65535]" in next(iter(w.findings)).message


def test_a_signed_index_below_zero_hits_the_neighbour() -> None:
    source = "a: int16 = 5\nv: array[int16, 2] = (1, 2)\ndef f(i: int16) -> int16:\n    v[i] = 9\n    return a\n"
    w = Workshop(source)
    assert w.f(-1) == 9
    (finding,) = w.findings
    assert "drv.a" in finding.message


def test_a_null_pointer_reads_and_writes_address_zero_and_is_shared() -> None:
    source = """
p: ptr[float32] = NULL
q: ptr[float32] = NULL
def f() -> float32:
    p[0] = 1.5
    return q[0]
"""
    w = Workshop(source)
    assert w.f() == 1.5
    assert w.rules() == ["null-dereference", "null-dereference"]
    assert w.memory.load("float32", 0) == 1.5


def test_a_pointer_that_walks_out_of_its_object_is_reported_with_what_it_hits() -> None:
    source = """
a: array[char, 2] = (1, 2)
b: array[char, 2] = (3, 4)
def f() -> char:
    p: ptr[char]
    p = a
    p += 3
    return p[0]
"""
    w = Workshop(source)
    assert w.f() == 4
    (finding,) = w.findings
    assert finding.rule == "pointer-outside"
    assert "drv.b[1]" in finding.message


def test_float_to_int_out_of_range_follows_the_policy_and_is_reported() -> None:
    source = "def f(x: float32) -> int16:\n    return int16(x)\ndef g(x: float32) -> uint16:\n    return x\n"
    w = Workshop(source)
    assert (w.f(40000.0), w.g(-2.0), w.f(-3.9)) == (32767, 0, -3)
    assert w.rules() == ["float-to-int", "float-to-int"]
    assert Workshop(source, float_to_int="low16").f(40000.0) == 40000 - 65536


def test_division_by_zero_and_a_shift_out_of_range_are_reported() -> None:
    source = """
def f(a: int16, b: int16) -> int16:
    return a / b
def g(a: float32) -> float32:
    return 1 / a
def h(n: int16) -> int16:
    return 1 << n
"""
    w = Workshop(source)
    w.f(1, 0)
    w.g(0.0)
    w.h(16)
    assert w.rules() == ["division-by-zero", "division-by-zero", "shift-range"]


def test_an_odd_32_bit_access_uses_the_even_address() -> None:
    source = """
v: array[uint16, 6] = (0, 0, 0, 0x3f80, 0, 0)
def f() -> float32:
    p: ptr[uint16]
    p = v
    p += 3
    return cast(ptr[float32], p)[0]
"""
    w = Workshop(source)
    # Words 2 and 3 are 0x0000 and 0x3f80: 1.0.  Word 3 is odd, because the array stands at an even address.
    assert w.linked.objects["drv.v"].base % 2 == 0
    assert w.f() == 1.0
    assert "odd-access" in w.rules()


def test_a_poll_that_nothing_can_end_is_an_error_not_a_hang() -> None:
    w = Workshop("flag: int16 = 0\ndef f() -> None:\n    while flag == 0:\n        pass\n")
    with pytest.raises(EndlessPoll, match=r"drv\.flag"):
        w.f()
    assert w.rules() == ["endless-poll"]


def test_a_stack_that_is_too_small_is_reported() -> None:
    w = Workshop("def f() -> int16:\n    v: array[int16, 300]\n    v[0] = 1\n    return v[0]\n")
    w.cpu.sp, w.cpu.stack_limit = 0x9000, 0x9000 + 255
    w.f()
    assert w.rules() == ["stack-overflow"]
    assert w.cpu.sp == 0x9000


def test_correct_code_is_silent() -> None:
    source = """
class P(struct):
    x: float32
    k: int16
g: P = (0, 0)
def mean(v: ptr[float32], n: uchar) -> float32:
    result: float32 = 0
    i: uchar
    for i in range(n):
        result += v[i]
    return result / n
def f(flag: int16) -> float32:
    v: array[float32, 4]
    best: int16
    p: P
    i: uchar
    for i in range(4):
        v[i] = i
        if i > 0 and v[i - 1] > v[i]:
            v[i] = 0
    if flag:
        best = 1
    else:
        best = 2
    p.x = mean(v, 4)
    p.k = best
    g = p
    return g.x + g.k
"""
    for fill in ("zero", "nan", "stack"):
        w = Workshop(source, fill=fill)
        # (0+1+2+3)/4 + 1
        assert w.f(1) == 2.5
        assert w.rules() == []


def test_an_arithmetic_finding_shows_the_expression_and_its_value() -> None:
    source = """
total: int16 = 32000
step: array[int16, 2] = (500, 1000)
def f(x: float32) -> int16:
    total += step[1]
    return x * 2.0 + 1
"""
    w = Workshop(source)
    w.f(40000.0)
    overflow, conversion = w.findings
    assert (overflow.object, overflow.value) == ("total + step[1]", 33000)
    assert (conversion.object, conversion.value) == ("x * 2 + 1", 80001.0)


@pytest.mark.parametrize(
    ("statement", "given", "rules", "kept"),
    [
        ("n += u", 2767, [], 32767),
        ("n += u", 2768, ["narrowed"], -32768),
        ("n = u + n", 40000, ["narrowed"], 4464),
        ("n -= u", 65535, ["narrowed"], 30001),
        ("n = int16(n + u)", 5000, [], -30536),
        ("n = -5\n    n += u", 10, [], 5),
        ("n = u", 40000, [], -25536),
        ("n = u - Since", 10, [], -90),
        ("n = n + (u << 8)", 0x80, [], -2768),
    ],
    ids=["just fits", "one too many", "the other way round", "difference", "cast", "negative", "pattern", "interval",
         "put together of octets"],
)  # fmt: skip
def test_an_unsigned_sum_that_an_int_cannot_hold(statement: str, given: int, rules: list[str], kept: int) -> None:
    shop = Workshop(
        f"Since: uint16 = 100\n\ndef run(u: uint16) -> int16:\n    n: int16 = 30000\n    {statement}\n    return n\n"
    )
    # Modulo 2^16: 32768 is -32768, 70000 is 4464, 30000 - 65535 = -35535 is 30001, 30000 + 0x8000 is -2768.
    assert shop.run(given) == kept
    assert shop.rules() == rules
