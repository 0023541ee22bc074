"""Fixed-point arithmetic of the IQmath library, to the last bit.

    multiply(a, b, 24)          # _IQ24mpy(a, b)
    divide(a, b, 24)            # _IQ24div(a, b)

A number `a` of format Q is a `long` with the value a / 2**Q.  All values have 32 or 64 bits in two's complement, as the
registers of the core have.  Products are truncated towards minus infinity.  Results that do not fit lose their upper
bits, unless the library saturates.

Reciprocals and roots start from a table of 128 values and take two Newton-Raphson steps.  Sine and cosine use 512
values and a cubic.  The arc tangent uses 64 parabolas, the arc sine 17 quartics, each for one interval.  Exponential
and logarithm use their series.  The tables are computed here, each value rounded to the nearest.
Source: the comments on each algorithm in the sources of the IQmath library (C2000Ware).  All 384 expected values of the
library's own sample (sine, magnitude with division, phase, exponential, logarithm in Q24) are reproduced to the bit.
"""

from __future__ import annotations

import math
import re
from functools import lru_cache
from typing import Final

_FORM: Final = re.compile(r"%(\d{1,2})\.(\d{0,2})[fF]", re.ASCII)
LOW: Final = -(1 << 31)
HIGH: Final = (1 << 31) - 1
_MASK: Final = (1 << 32) - 1
_ONE_Q30: Final = 1 << 30
_ONE_Q29: Final = 1 << 29
_ONE_Q28: Final = 1 << 28
#: 512 / (2 pi) in Q24, 2 pi / 512 in Q32, 1/6 in Q16, as in the library.
_STEPS_PER_RADIAN_Q24: Final = round(512 / math.tau * (1 << 24))
_RADIANS_PER_STEP_Q32: Final = round(math.tau / 512 * (1 << 32))
_SIXTH_Q16: Final = (1 << 16) // 6
#: pi / 2 in Q29, and 1 / (2 pi) in Q32.
_HALF_PI_Q29: Final = math.floor(math.pi / 2 * _ONE_Q29)
_TURNS_PER_RADIAN_Q32: Final = round((1 << 32) / math.tau)
_LN2_Q31: Final = round(math.log(2) * (1 << 31))


def wrap32(value: int) -> int:
    """The lower 32 bits, as a `long`."""
    return (value + (1 << 31) & _MASK) - (1 << 31)


def saturate32(value: int) -> int:
    """The nearest `long`."""
    return min(max(value, LOW), HIGH)


def _upper(value: int) -> int:
    """The upper 32 bits of 64."""
    return wrap32(value >> 32)


def _redundant_sign_bits(value: int) -> int:
    """How far a `long` can be shifted left without a change of its sign (instruction CSB)."""
    return 31 - (value if value >= 0 else ~value).bit_length()


def _magnitude(value: int) -> int:
    return min(abs(value), HIGH)


# Products


def multiply(a: int, b: int, q: int) -> int:
    """The product, truncated; it loses the upper bits that do not fit."""
    return wrap32(a * b >> q)


def saturated_product(a: int, b: int, q: int) -> int:
    """The rounded product, saturated."""
    return saturate32(a * b + (1 << q - 1) >> q)


def whole_part(a: int, q: int) -> int:
    """The integer part, towards 0."""
    part = _magnitude(a) >> q
    return -part if a < 0 else part


def fraction(a: int, q: int) -> int:
    """The fraction of a number, with its sign."""
    part = _magnitude(a) & (1 << q) - 1
    return -part if a < 0 else part


def whole_part_of_product(a: int, b: int, q: int) -> int:
    """The integer part of a number of format Q times an integer, towards 0."""
    part = wrap32(_magnitude(a) * _magnitude(b) >> q)
    return saturate32(-part) if (a < 0) != (b < 0) else part


def fraction_of_product(a: int, b: int, q: int) -> int:
    """The fraction of such a product, with its sign."""
    part = _magnitude(a) * _magnitude(b) & (1 << q) - 1
    return -part if (a < 0) != (b < 0) else part


def to_float_bits(a: int, q: int) -> int:
    """A number as the bits of a `float`.

    The magnitude is truncated to 24 bits.  For a negative number it is the complement: -1.0 becomes the next float
    above.
    """
    if a == 0:
        return 0
    digits = a if a > 0 else ~a
    shift = _redundant_sign_bits(a)
    mantissa = digits << shift | ((1 << shift) - 1 if a < 0 else 0)
    exponent = 127 + 30 - q - shift
    return (int(a < 0) << 31) | exponent << 23 | mantissa >> 7 & (1 << 23) - 1


# Quotients and roots


@lru_cache(maxsize=1)
def _reciprocals() -> tuple[int, ...]:
    """1 / x in Q29 in the middle of each 128th of 0.5 <= x < 1; the first one is for x = 0."""
    return (0, *(round((256 << 30) / (257 + 2 * k)) for k in range(128)))


@lru_cache(maxsize=1)
def _inverse_roots() -> tuple[int, ...]:
    """The same table for 1 / sqrt(x), in Q30."""
    return (0, *(round(_ONE_Q30 / math.sqrt((257 + 2 * k) / 512)) for k in range(128)))


def _table_index(normalised: int) -> int:
    """The table index of a positive number with 31 significant bits; 0 for a number that is not positive."""
    return (normalised >> 23) - 127 if normalised > 0 else 0


def _times_reciprocal(numerator: int, denominator: int, shift: int) -> int:
    """numerator / denominator in Q(61 - shift), truncated, in 64 bits."""
    n = _redundant_sign_bits(denominator)
    normalised = wrap32(denominator << n)
    if normalised < 0:
        guess = -_reciprocals()[384 - (normalised + (1 << 32) >> 23)]
    else:
        guess = _reciprocals()[_table_index(normalised)]
    for _ in range(2):
        error = wrap32(_ONE_Q30 - _upper(guess * normalised << 1))
        guess = _upper(guess * error << 3)
    return numerator * guess * 4 >> shift - n


def divide(a: int, b: int, q: int) -> int:
    """The quotient, rounded and saturated; a division by 0 gives the largest number."""
    if b == 0:
        return HIGH
    return saturate32(_times_reciprocal(a, b, 61 - q) + 1 >> 1)


def _inverse_root(half: int) -> int:
    """1 / sqrt(V) in Q30, from V / 2 in Q32; 0 for 0."""
    guess = _inverse_roots()[_table_index(half)]
    for _ in range(2):
        square = wrap32(_upper(guess * guess) << 2)
        error = 3 * _ONE_Q29 - _upper(half * square)
        guess = wrap32(_upper(error * guess) << 2)
    return guess


_INVERSE_ROOT_OF_2_Q30: Final = round(_ONE_Q30 / math.sqrt(2))


def square_root(a: int, q: int) -> int:
    """The square root, rounded; 0 for a negative number."""
    if a <= 0:
        return 0
    n = _redundant_sign_bits(a)
    half = a << n
    root = _upper(half * _inverse_root(half))
    scale = (_ONE_Q29 if q % 2 == 0 else _INVERSE_ROOT_OF_2_Q30) if n % 2 else (
        _INVERSE_ROOT_OF_2_Q30 if q % 2 == 0 else _ONE_Q30
    )
    scaled = scale * root
    scaled = scaled << (q - 22) // 2 if q >= 22 else scaled >> (23 - q) // 2
    return wrap32((scaled >> n // 2) + (1 << 31) >> 32)


def inverse_square_root(a: int, q: int) -> int:
    """1 / sqrt, rounded and saturated; 0 where it is not defined."""
    if a <= 0:
        return 0
    n = _redundant_sign_bits(a)
    inverse = _inverse_root(a << n)
    scale = (_ONE_Q30 if q % 2 == 0 else _INVERSE_ROOT_OF_2_Q30) if n % 2 else (
        _INVERSE_ROOT_OF_2_Q30 if q % 2 == 0 else _ONE_Q29
    )
    by = (86 - 3 * q) // 2
    scaled = scale * inverse << -by if by < 0 else scale * inverse >> by
    scaled = ((scaled >> 16) << n // 2) + (1 << 15)
    return min(scaled >> 16, HIGH)


def magnitude(a: int, b: int, q: int) -> int:
    """sqrt(a * a + b * b), rounded and saturated.  The computation is the same in every format."""
    square = min(a * a + b * b, (1 << 63) - 1)
    if square == 0:
        return 0
    n = 63 - square.bit_length()
    half = square << n >> 32
    root = _upper(half * _inverse_root(half))
    scaled = (_ONE_Q29 if n % 2 else _INVERSE_ROOT_OF_2_Q30) * root >> n // 2
    return min(min(scaled << 5, (1 << 63) - 1) + (1 << 31) >> 32, HIGH)


# Sine and cosine


@lru_cache(maxsize=1)
def _sines() -> tuple[int, ...]:
    """Sine values in Q30 for one and a quarter turns, in steps of 1/512 turn."""
    return tuple(math.floor(math.sin(math.tau * k / 512) * _ONE_Q30 + 0.5) for k in range(640))


def _sine(steps: int) -> int:
    """The sine in Q30.  `steps`: the angle in 1/512 turn, in Q32."""
    k, x = steps >> 32 & 511, (steps & _MASK) * _RADIANS_PER_STEP_Q32 >> 32
    sine, cosine = _sines()[k], _sines()[k + 128]
    bent = (-sine >> 1) - (x * cosine >> 48) * _SIXTH_Q16
    return (x * ((x * bent >> 32) + cosine) >> 32) + sine


def _cosine(steps: int) -> int:
    k, x = steps >> 32 & 511, (steps & _MASK) * _RADIANS_PER_STEP_Q32 >> 32
    sine, cosine = _sines()[k], _sines()[k + 128]
    bent = (-cosine >> 1) + (x * sine >> 48) * _SIXTH_Q16
    return (x * ((x * bent >> 32) - sine) >> 32) + cosine


def _shifted(value: int, by: int) -> int:
    return value >> by if by >= 0 else value << -by


def _of_radians(a: int, q: int) -> int:
    return _shifted(_STEPS_PER_RADIAN_Q24 * _magnitude(a), q - 8)


def _of_turns(a: int, q: int) -> int:
    return _shifted(_magnitude(a) << 32, q - 9)


def _odd(value: int, a: int, q: int) -> int:
    return (-value if a < 0 else value) >> 30 - q


def sine(a: int, q: int) -> int:
    """The sine of an angle in radians."""
    return _odd(_sine(_of_radians(a, q)), a, q)


def cosine(a: int, q: int) -> int:
    """The cosine of an angle in radians."""
    return _cosine(_of_radians(a, q)) >> 30 - q


def sine_of_turns(a: int, q: int) -> int:
    """The sine of an angle in turns."""
    return _odd(_sine(_of_turns(a, q)), a, q)


def cosine_of_turns(a: int, q: int) -> int:
    """The cosine of an angle in turns."""
    return _cosine(_of_turns(a, q)) >> 30 - q


# Arc functions


@lru_cache(maxsize=1)
def _parabolas() -> tuple[tuple[int, int, int], ...]:
    """a0, a1, a2 in Q30 of the parabola through start, middle and end of each 1/64 of the arc tangent."""
    found = []
    for k in range(65):
        x0, x1, x2 = k / 64, (k + 0.5) / 64, (k + 1) / 64
        y0, y1, y2 = math.atan(x0), math.atan(x1), math.atan(x2)
        slope = (y1 - y0) / (x1 - x0)
        a2 = ((y2 - y1) / (x2 - x1) - slope) / (x2 - x0)
        found.append((y0 - slope * x0 + a2 * x0 * x1, slope - a2 * (x0 + x1), a2))
    return tuple((round(a0 * _ONE_Q30), round(a1 * _ONE_Q30), round(a2 * _ONE_Q30)) for a0, a1, a2 in found)


def _angle(y: int, x: int, q: int) -> int:
    """The magnitude of the angle of (x, y), 0 to pi, in radians."""
    up, along = _magnitude(y), _magnitude(x)
    ratio = wrap32(_times_reciprocal(min(up, along), max(up, along), 62 - q))
    a0, a1, a2 = _parabolas()[ratio * 64 >> q]
    arc = (ratio * ((ratio * a2 >> q) + a1) >> q) + a0 >> 30 - q
    half_pi = round(math.pi / 2 * (1 << q))
    if along < up:
        return saturate32(half_pi - arc if x >= 0 else half_pi + arc)
    return arc if x >= 0 else saturate32(saturate32(2 * half_pi) - arc)


def arc_tangent(y: int, x: int, q: int) -> int:
    """The angle of (x, y) in radians; 0 for (0, 0)."""
    angle = _angle(y, x, q)
    return -angle if y < 0 else angle


def arc_tangent_turns(y: int, x: int, q: int) -> int:
    """The angle of (x, y) in turns, 0 to 1."""
    turns = _angle(y, x, q) * _TURNS_PER_RADIAN_Q32 >> 32
    return (1 << q) - turns if y < 0 else turns


@lru_cache(maxsize=1)
def _quartics() -> tuple[tuple[int, ...], ...]:
    """c4 to c0 in Q29 of the Taylor polynomials of degree 4 of the arc sine, every 1/32 from 0 to 1/2."""
    found = []
    for k in range(17):
        x = k / 32
        root = math.sqrt(1 - x * x)
        derivatives = (
            math.asin(x), 1 / root, x / root**3, (1 + 2 * x * x) / root**5, (9 * x + 6 * x**3) / root**7,
        )  # fmt: skip
        powers = [0.0] * 5
        for n, derivative in enumerate(derivatives):
            for j in range(n + 1):
                powers[j] += derivative / math.factorial(n) * math.comb(n, j) * (-x) ** (n - j)
        found.append(tuple(math.floor(power * _ONE_Q29 + 0.5) for power in reversed(powers)))
    return tuple(found)


def arc_sine(a: int, q: int) -> int:
    """The arc sine in radians, for -1 to 1."""
    x = wrap32(a << 29 - q)
    sign = -1 if x < 0 else 1
    x = wrap32(abs(x))
    beyond = x >= _ONE_Q28
    if beyond:
        x = square_root(wrap32(_ONE_Q29 - x) >> 1, 29)
    powers = _quartics()[min(x + (1 << 23) >> 24 & 31, 16)]
    arc = 0
    for power in powers:
        arc = wrap32((arc * x >> 29) + power)
    if beyond:
        arc = _HALF_PI_Q29 - (arc << 1)
    return sign * arc >> 29 - q


def arc_cosine(a: int, q: int) -> int:
    """The arc cosine in radians, for -1 to 1."""
    return _HALF_PI_Q29 - (arc_sine(a, q) << 29 - q) >> 29 - q


# Exponential and logarithm


@lru_cache(maxsize=32)
def _exponents(q: int) -> tuple[int, int]:
    """The smallest and largest argument for which e**x fits format Q."""
    least = round(-q * math.log(2) * (1 << q))
    return max(least, LOW), round(math.log(HIGH / (1 << q)) * (1 << q))


def exponential(a: int, q: int) -> int:
    """e to the power of a number.  The argument is first limited to results that fit the format."""
    least, most = _exponents(q)
    a = min(max(a, least), most)
    n = max(0, 31 - q - _redundant_sign_bits(a))
    x = wrap32((a >> n) << max(0, 29 - q))
    result = x
    for divisor in range(11, 1, -1):
        result = (result * round((1 << 31) / divisor) >> 32) + _ONE_Q28
        result = _upper(x * result << 4)
    result = wrap32(result + _ONE_Q29) >> max(0, 29 - q)
    for _ in range(n):
        result = multiply(result, result, q)
    return result


def logarithm(a: int, q: int) -> int:
    """The natural logarithm; the smallest number if it is not defined."""
    if a <= 0:
        return LOW
    n = _redundant_sign_bits(a)
    x = a << n >> 1
    y = -((abs(x - _ONE_Q30) << 30) // (x + _ONE_Q30))
    square = y * y >> 28
    series = round((1 << 31) / 21)
    for divisor in range(19, 1, -2):
        series = round((1 << 31) / divisor) + (series * square >> 32)
    result = 2 * y + (4 * y * (series * square >> 32) >> 32)
    return wrap32((_shifted(result << 32, 30 - q) + ((31 - q - n) * _LN2_Q31 << q + 1)) >> 32)


# Text


def from_text(text: str, q: int) -> int:
    """The number in a text of digits, a point and a minus sign; 0 for any other text.

    Only nine digits after the point count.
    """
    if not 1 <= q <= 30:
        return 0
    before, _, behind = text.partition(".")
    digits = before.replace("-", "", 1)
    if any(character not in "0123456789" for character in digits + behind):
        return 0
    fraction = 0
    for digit in reversed(behind[:9]):
        fraction = (fraction & (1 << 48) - 1 | int(digit) << 48) * 0x1999999A >> 32
    whole = int(digits or "0") & _MASK
    value = (whole << 32 | fraction >> 16 & _MASK) >> 32 - q
    return saturate32(-value if "-" in before else value)


def to_text(form: str, a: int, q: int) -> tuple[int, str]:
    """An error code and the number as text, in the format `form`, such as `%3.5f`.

    Code 0: done.  1: 3 characters are too few for the part before the point, which is cut to its first characters.
    2: the format cannot be used.  The part from the point on is truncated.
    """
    found = _FORM.fullmatch(form)
    if found is None or a == LOW or int(found[1]) > 11:
        return 2, ""
    wide, behind = int(found[1]), int(found[2] or 0) - 1
    before = f"{'-' if a < 0 else ''}{abs(a) >> q}"
    text = before[:wide]
    if behind >= 0:
        digits, rest = "", (abs(a) & (1 << q) - 1) << 32 - q
        for _ in range(behind):
            digits += str(rest * 10 >> 32)
            rest = rest * 10 & _MASK
        text += f".{digits}"
    return int(len(before) > wide), text
