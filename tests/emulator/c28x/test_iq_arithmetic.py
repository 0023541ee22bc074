"""Fixed-point arithmetic of the IQmath library against exact fractions and real functions."""

from __future__ import annotations

import math
import struct
from fractions import Fraction

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from emulator.c28x import iq_arithmetic as iq

LOW, HIGH = -(2**31), 2**31 - 1
longs = st.integers(LOW, HIGH) | st.sampled_from([LOW, LOW + 1, -1, 0, 1, HIGH])
formats = st.integers(1, 30)
ONE = 2**24


def floor_of(value: Fraction) -> int:
    return math.floor(value)


def modular(value: int) -> int:
    """The number of 32 bits that is congruent."""
    return (value - LOW) % 2**32 + LOW


def clipped(value: int) -> int:
    return sorted((LOW, value, HIGH))[1]


# Products: 64 bits shifted by Q; rounded by half a unit; limited to 32 bits.


@given(a=longs, b=longs, q=formats)
def test_products_are_those_of_fractions(a: int, b: int, q: int) -> None:
    exact = Fraction(a * b, 2**q)
    assert iq.multiply(a, b, q) == modular(floor_of(exact))
    assert iq.saturated_product(a, b, q) == clipped(floor_of(exact + Fraction(1, 2)))


@given(a=longs, b=longs, q=formats)
def test_parts_are_taken_of_the_magnitude(a: int, b: int, q: int) -> None:
    # What has no magnitude in 32 bits counts as the greatest number: the library's absolute value saturates.
    sign = lambda *values: -1 if sum(value < 0 for value in values) % 2 else 1  # noqa: E731
    magnitude = Fraction(min(abs(a), HIGH), 2**q)
    assert iq.whole_part(a, q) == sign(a) * floor_of(magnitude)
    assert iq.fraction(a, q) == sign(a) * (magnitude % 1) * 2**q
    product = magnitude * min(abs(b), HIGH)
    assert iq.fraction_of_product(a, b, q) == sign(a, b) * (product % 1) * 2**q
    whole = sign(a, b) * modular(floor_of(product))
    assert iq.whole_part_of_product(a, b, q) == clipped(whole)


# 3.5 = 58720256 / 2**24, by hand: integer part 3, fraction 0.5; times -3 is -10.5.
def test_parts_by_hand() -> None:
    assert (iq.whole_part(58720256, 24), iq.fraction(58720256, 24)) == (3, ONE // 2)
    assert (iq.whole_part(-58720256, 24), iq.fraction(-58720256, 24)) == (-3, -ONE // 2)
    assert (iq.whole_part_of_product(58720256, -3, 24), iq.fraction_of_product(58720256, -3, 24)) == (-10, -ONE // 2)


# Quotients and roots.  Two Newton steps leave a reciprocal of 1 to 2 with less than four units of 2**-29 to the exact
# one (each truncation takes one unit or two): 2**-27 of the result, and half a unit for the rounding.


@given(a=longs, b=longs, q=formats)
@example(a=HIGH, b=-1, q=1)
@example(a=LOW, b=-(2**30), q=30)
def test_quotients_are_close_and_saturate(a: int, b: int, q: int) -> None:
    if b == 0:
        assert iq.divide(a, b, q) == HIGH  # by 0: the greatest number
        return
    exact = Fraction(a, b) * 2**q
    off = abs(iq.divide(a, b, q) - min(max(exact, LOW), HIGH))
    assert off <= Fraction(51, 100) + abs(exact) / 2**27


@given(a=st.integers(-(2**24), 2**24), b=st.integers(1, 2**31 - 1))
def test_small_quotients_are_rounded(a: int, b: int) -> None:
    # |quotient| < 2**24: the reciprocal's error is an eighth of a unit.
    exact = Fraction(a, b) * 2**10
    assume(abs(exact) < 2**24)
    assert abs(iq.divide(a, b, 10) - exact) <= Fraction(5, 8)


@pytest.mark.parametrize(("a", "b", "quotient"), [
    (ONE, 3 * ONE, 5592405), (-ONE, 3 * ONE, -5592405), (200, 625, 5368709), (0, -7, 0), (7, 0, HIGH), (-7, 0, HIGH),
    (HIGH, 1, HIGH), (HIGH, -1, LOW), (LOW, -1, HIGH),
])  # fmt: skip
def test_quotients_by_hand(a: int, b: int, quotient: int) -> None:
    # 2**24 / 3 = 5592405.33; 200 / 625 * 2**24 = 5368709.12
    assert iq.divide(a, b, 24) == quotient


def test_a_great_quotient_has_the_error_of_its_reciprocal() -> None:
    # 6516 / 29 in Q23 is 1884833438.9: the reciprocal of 29 / 32, 1.1034 in Q29, is 2 units too great.
    assert iq.divide(-6516, -29, 23) == 1884833445


@given(a=st.integers(1, HIGH), q=formats)
def test_roots_are_close(a: int, q: int) -> None:
    root = math.sqrt(a * 2**q)  # of the value a / 2**q, in Q
    assert abs(iq.square_root(a, q) - root) <= 0.51 + root / 2**26
    inverse = math.sqrt(2.0 ** (3 * q) / a)
    assert abs(iq.inverse_square_root(a, q) - min(inverse, HIGH)) <= 0.51 + inverse / 2**26


@given(a=longs, b=longs)
def test_the_magnitude_is_close_and_the_same_in_every_format(a: int, b: int) -> None:
    exact = min(math.hypot(a, b), HIGH)
    assert abs(iq.magnitude(a, b, 1) - exact) <= 1.01 + exact / 2**26
    assert iq.magnitude(a, b, 1) == iq.magnitude(a, b, 30)


def test_roots_by_hand() -> None:
    assert [iq.square_root(n * n * ONE, 24) for n in range(1, 11)] == [n * ONE for n in range(1, 11)]
    assert iq.square_root(2 * ONE, 24) == round(math.sqrt(2) * ONE)
    assert iq.inverse_square_root(4 * ONE, 24) == ONE // 2
    assert iq.magnitude(3 * ONE, -4 * ONE, 24) == 5 * ONE
    # What has no root, and a result beyond the format: 1 / sqrt(2**-24) = 4096 in Q24.
    assert [f(a, 24) for f in (iq.square_root, iq.inverse_square_root) for a in (0, -1, LOW)] == [0] * 6
    assert iq.inverse_square_root(1, 24) == HIGH
    assert iq.magnitude(LOW, LOW, 24) == HIGH
    assert iq.magnitude(0, 0, 24) == 0


# Sine and cosine: 29 bits (the library's sources), truncated to the format.


@given(a=longs, q=formats)
def test_sine_and_cosine_of_turns(a: int, q: int) -> None:
    angle = Fraction(min(abs(a), HIGH), 2**q) % 1
    radians = math.tau * float(angle)
    wanted = (math.copysign(1, a) * math.sin(radians), math.cos(radians))
    for found, exact in zip((iq.sine_of_turns(a, q), iq.cosine_of_turns(a, q)), wanted, strict=True):
        assert abs(found - exact * 2**q) <= 1.01 + 2.0 ** (q - 28)


@given(q=st.integers(1, 29), part=st.floats(-1, 1))
def test_sine_and_cosine_of_radians(q: int, part: float) -> None:
    a = round(part * min(HIGH, 2 * math.pi * 2**q))
    for found, exact in ((iq.sine(a, q), math.sin(a / 2**q)), (iq.cosine(a, q), math.cos(a / 2**q))):
        # The steps in a radian have 31 bits: the angle of a turn is 2**-28 off at most.
        assert abs(found - exact * 2**q) <= 1.01 + 2.0 ** (q - 27)


def test_the_sine_of_a_step_of_the_table_is_the_tables() -> None:
    # 512 steps in a turn: nothing is between, so the value is the nearest one of Q30.
    for k in range(512):
        assert iq.sine_of_turns(k << 15, 24) == math.floor(math.sin(math.tau * k / 512) * 2**30 + 0.5) >> 6
    assert iq.sine_of_turns(1 << 27, 30) == 759250125  # an eighth: 2**30 / sqrt(2) = 759250124.99
    assert iq.cosine_of_turns(-(1 << 23), 24) == -ONE


# Arc functions.  A parabola through three points of a 64th: the third derivative of the arc tangent is at most 2,
# so it is less than 2 / 6 * 2 * (1 / 128)**3 / 5.2 = 2**-23.9 off.


@given(y=longs, x=longs, q=st.integers(1, 29))
def test_the_angle_of_two_coordinates(y: int, x: int, q: int) -> None:
    assume((x, y) != (0, 0))
    exact = math.atan2(y, x)
    assert abs(iq.arc_tangent(y, x, q) - exact * 2**q) <= 3.5 + 2.0 ** (q - 23)
    turns = exact / math.tau + (y < 0)
    assert abs(iq.arc_tangent_turns(y, x, q) - turns * 2**q) <= 2.5 + 2.0 ** (q - 25)


@pytest.mark.parametrize(("y", "x", "angle"), [
    (0, 0, 0), (0, ONE, 0), (ONE, 0, 26353589), (0, -ONE, 52707179), (-ONE, 0, -26353589), (ONE, ONE, 13176794),
])  # fmt: skip
def test_angles_by_hand(y: int, x: int, angle: int) -> None:
    # pi / 2 in Q24 is 26353589.27; pi is 2 times the 26353589 of the table, pi / 4 is 13176794.6
    assert abs(iq.arc_tangent(y, x, 24) - angle) <= 1


@example(part=536807087, q=29)
@example(part=2**29 - 1, q=29)
@given(part=st.integers(-(2**29), 2**29), q=st.integers(1, 29))
def test_arc_sine_and_arc_cosine(part: int, q: int) -> None:
    a = part >> 29 - q
    # A Taylor polynomial of degree 4 a 64th beside its point: f5 / 5! * 2**-30 is 2**-27.6 at a half; doubled beyond,
    # where the arc sine of the root of half the distance to one is taken: its half loses a bit of Q29.
    half = (1 - abs(a) / 2**q) / 2
    lost = 2.4 * (math.sqrt(half) - math.sqrt(max(half - 2**-30, 0)))
    assert abs(iq.arc_sine(a, q) - math.asin(a / 2**q) * 2**q) <= 1.01 + (2**-23 + lost) * 2**q
    assert abs(iq.arc_cosine(a, q) - math.acos(a / 2**q) * 2**q) <= 2.01 + (2**-23 + lost) * 2**q


@given(a=st.integers(-(4 * ONE), 4 * ONE))
def test_the_exponential(a: int) -> None:
    # e**x for |x| < 1 has 27 bits or so in Q24; each of up to three squarings doubles the error.
    exact = math.exp(a / ONE) * ONE
    assert abs(iq.exponential(a, 24) - exact) <= 2 + 8 * exact / ONE


def test_the_exponential_ends_with_its_format() -> None:
    # ln(127.99999994) = 4.85203: what is more counts as that; in Q24 its power is 2**31 - 1, but for the squarings.
    assert iq.exponential(HIGH, 24) == iq.exponential(81403560, 24) != iq.exponential(81403559, 24)
    assert iq.exponential(LOW, 24) <= 1


@given(a=st.integers(1, HIGH), q=st.integers(1, 30))
def test_the_logarithm(a: int, q: int) -> None:
    exact = math.log(a / 2**q) * 2**q
    assume(LOW < exact < HIGH)
    assert abs(iq.logarithm(a, q) - exact) <= 1.01 + 2.0 ** (q - 26)


def test_the_logarithm_of_nothing_is_the_least_number() -> None:
    assert [iq.logarithm(a, 24) for a in (0, -1, LOW)] == [LOW] * 3
    assert iq.logarithm(ONE, 24) == 0


# Numbers


@given(a=longs, q=formats)
def test_a_float_has_the_upper_24_bits(a: int, q: int) -> None:
    (value,) = struct.unpack("<f", iq.to_float_bits(a, q).to_bytes(4, "little"))
    # Truncated: not beyond the number, and closer to it than a unit of its last place.  Of a negative number the
    # complement is taken, which is a unit of the format less.
    exact = a / 2**q
    assert abs(value) <= abs(exact)
    if a:
        assert abs(value - exact) <= 2.0 ** (math.frexp(exact)[1] - 24)
        assert math.copysign(1, value) == math.copysign(1, a)


def test_floats_by_hand() -> None:
    bits = [iq.to_float_bits(a, 24) for a in (0, ONE, 3 * ONE // 2, -ONE, -3 * ONE // 2)]
    # -1.0 is 0xFF000000: its complement is 0x00FFFFFF, 24 ones, which is the float above -1.
    assert bits == [0, 0x3F800000, 0x3FC00000, 0xBF7FFFFF, 0xBFBFFFFF]


@pytest.mark.parametrize(("text", "number"), [
    ("12.5", 209715200), ("-12.5", -209715200), ("0", 0), ("", 0), ("3", 3 * ONE), ("3.", 3 * ONE), (".25", ONE // 4),
    ("-0.5", -ONE // 2), ("128", HIGH), ("-128", LOW), ("-200.7", LOW), ("1e3", 0), (" 1", 0), ("+1", 0), ("1.2.3", 0),
    ("--1", 0), ("1.-2", 0), ("4294967297", ONE),
])  # fmt: skip
def test_texts(text: str, number: int) -> None:
    # The integer part has 32 bits: 2**32 + 1 is 1.
    assert iq.from_text(text, 24) == number


@given(whole=st.integers(0, 127), digits=st.text("0123456789", min_size=1, max_size=14))
def test_a_text_has_nine_digits_behind_the_point(whole: int, digits: str) -> None:
    exact = (whole + Fraction(int(digits[:9]), 10 ** len(digits[:9]))) * ONE
    assert abs(iq.from_text(f"{whole}.{digits}", 24) - min(exact, HIGH)) <= 1


@pytest.mark.parametrize(("form", "number", "text"), [
    ("%3.4f", 12 * ONE + ONE // 2, (0, "12.500")), ("%3.4f", -(12 * ONE) - ONE // 2, (0, "-12.500")),
    ("%2.2f", -12 * ONE, (1, "-1.0")), ("%1.1F", ONE, (0, "1.")), ("%1.0f", ONE, (0, "1")), ("%1.f", ONE, (0, "1")),
    ("%2.9f", ONE // 3, (0, "0.33333331")), ("%12.2f", ONE, (2, "")), ("2.2f", ONE, (2, "")), ("%.2f", ONE, (2, "")),
    ("%2.2d", ONE, (2, "")), ("%4.4f", LOW, (2, "")),
])  # fmt: skip
def test_numbers_as_texts(form: str, number: int, text: tuple[int, str]) -> None:
    # The width behind the point counts the point; 5592405 / 2**24 = 0.33333331346.
    assert iq.to_text(form, number, 24) == text
