"""Float32 and integer arithmetic against numpy's fixed-width types and against published hardware results."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.arithmetic import (
    TINY,
    bits_float,
    divide_ieee,
    divide_int,
    divide_newton_raphson,
    f32,
    float_bits,
    low_bits,
    modulo_int,
    saturate,
)  # fmt: skip

singles = st.floats(width=32, allow_nan=False)


def numpy_f32(value: float) -> float:
    """numpy's float32 with denormals flushed: the independent model."""
    with np.errstate(all="ignore"):
        x = float(np.float32(value))
    return 0.0 if x != 0.0 and abs(x) < TINY else x


@given(st.floats(allow_nan=False))
def test_f32_rounds_like_numpy_and_flushes_denormals(x: float) -> None:
    assert numpy_f32(x) == f32(x)


@given(st.integers(1 << 23, (1 << 24) - 1), st.integers(-155, 105), st.integers(-2, 2), st.sampled_from([-1, 1]))
def test_f32_halfway_between_two_float32_is_the_even_one(mantissa: int, exponent: int, beside: int, sign: int) -> None:
    """And on either side of the middle the nearer one, from denormals to overflow."""
    x = sign * math.ldexp((2 * mantissa + 1 << 28) + beside, exponent - 29)
    assert numpy_f32(x) == f32(x)


def test_f32_keeps_nan_and_infinity() -> None:
    assert math.isnan(f32(math.nan))
    assert f32(1e300) == math.inf


@given(singles, singles)
def test_one_operation_in_double_then_rounded_is_float32_arithmetic(a: float, b: float) -> None:
    a, b = numpy_f32(a), numpy_f32(b)
    with np.errstate(all="ignore"):
        x, y = np.float32(a), np.float32(b)
        for ours, theirs in ((f32(a + b), x + y), (f32(a - b), x - y), (f32(a * b), x * y), (divide_ieee(a, b), x / y)):
            expected = numpy_f32(float(theirs))
            assert ours == expected or (math.isnan(ours) and math.isnan(expected))


@given(st.integers(0, 0xFFFFFFFF))
def test_bits_and_float_are_inverse_for_normal_numbers(bits: int) -> None:
    value = bits_float(bits)
    if math.isfinite(value) and (abs(value) >= TINY or value == 0):
        assert float_bits(value) == bits


# Published results of the chip (E2E 559480, TI bug EXT_EP-10879, E2E 681834, E2E 379945): IEEE fits none of them.
@pytest.mark.parametrize(
    ("a", "b", "quotient"),
    [
        (0x3F52B7DB, 0x3F7FFFFF, 0x3F52B7DD),
        (0x3F8041A2, 0x3F7FBE77, 0x3F80627F),
        (float_bits(66.0), float_bits(1.1), 0x426FFFFF),
    ],
)
def test_newton_raphson_division_gives_the_quotients_seen_on_hardware(a: int, b: int, quotient: int) -> None:
    assert float_bits(divide_newton_raphson(bits_float(a), bits_float(b))) == quotient
    assert float_bits(divide_ieee(bits_float(a), bits_float(b))) != quotient


def test_newton_raphson_division_loses_the_timer_count_seen_on_hardware() -> None:
    # (Uint32)(200e6 / 1e3 - 1) was 199998 on the chip; exact arithmetic gives 199999.
    assert int(f32(divide_newton_raphson(200e6, 1e3) - 1.0)) == 199998
    assert int(f32(divide_ieee(200e6, 1e3) - 1.0)) == 199999


def test_newton_raphson_seventeen_by_seventeen_truncates_to_zero() -> None:
    assert int(divide_newton_raphson(17.0, 17.0)) == 0


@given(singles, singles)
def test_newton_raphson_stays_within_four_ulp_of_ieee(a: float, b: float) -> None:
    a, b = f32(a), f32(b)
    exact = divide_ieee(a, b)
    # Where the seed or the quotient under- or overflows the iteration has nothing to refine.
    if b == 0 or not 2.0**-60 < abs(b) < 2.0**60 or not 2.0**-60 < abs(a) < 2.0**60 or not math.isfinite(exact):
        return
    ulp = math.ldexp(1.0, math.frexp(exact)[1] - 24)
    assert abs(divide_newton_raphson(a, b) - exact) <= 4 * ulp


def test_division_by_zero_is_infinite_and_zero_by_zero_nan() -> None:
    assert divide_ieee(1.0, 0.0) == math.inf
    assert divide_ieee(-1.0, 0.0) == -math.inf
    assert math.isnan(divide_ieee(0.0, 0.0))


@given(st.integers(-32768, 32767), st.integers(-32768, 32767).filter(bool))
def test_integer_division_truncates_toward_zero_and_the_remainder_has_the_dividends_sign(a: int, b: int) -> None:
    assert divide_int(a, b) == math.trunc(a / b)
    assert modulo_int(a, b) == math.fmod(a, b)


@given(st.floats(-1e6, 1e6, width=32))
def test_saturation_truncates_inside_and_clamps_outside(x: float) -> None:
    assert saturate(x, -32768, 32767) == min(max(math.trunc(x), -32768), 32767)
    # Observed on hardware (E2E 538952): a negative float becomes unsigned 0.
    assert saturate(x, 0, 65535) == min(max(math.trunc(x), 0), 65535)


@given(st.floats(-2e9, 2e9, width=32))
def test_low_bits_are_those_of_the_32_bit_conversion(x: float) -> None:
    assert low_bits(x, -32768, 32767) == int(np.int64(math.trunc(x)).astype(np.int16))
