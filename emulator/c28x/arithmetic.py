"""Arithmetic of the C28x that Python does not do by itself: float32, truncating division, conversions, dividers.

Values are plain Python ints (always within the range of their type) and floats: those of 32 bits are always exactly a
float32, with denormals flushed; those of 64 bits are Python's own.  Sources: CPU and the FPU supplement as gathered
under SOURCES; ISO C 6.5.
"""

from __future__ import annotations

import math
import operator
import struct
from collections.abc import Callable
from typing import Any, Final

#: Smallest normal float32; the FPU flushes anything smaller to zero.
TINY: Final = 2.0**-126
COMPARE: Final[dict[str, Callable[[Any, Any], bool]]] = {
    "<": operator.lt, ">": operator.gt, "<=": operator.le, ">=": operator.ge, "==": operator.eq, "!=": operator.ne,
}  # fmt: skip
_CELL: Final = memoryview(bytearray(4)).cast("f")


def f32(value: float) -> float:
    """`value` rounded to float32, nearest even, denormals flushed to +0 (the sign of a flushed zero: CHOICE).

    Veltkamp's splitting (Dekker, Numerische Mathematik 18, 1971) with 2**29 + 1 leaves 24 of a double's 53 bits, in
    three machine operations.  Near zero, near overflow and for NaN, the C conversion of `_CELL` rounds; every call
    writes `_CELL` before it reads it.  The constants are written as literals, which saves their look-up.
    """
    spread = value * 536870913.0
    rounded = spread - (spread - value)
    if 2.0**-125 <= rounded < 2.0**128 or -(2.0**128) < rounded <= -(2.0**-125):
        return rounded
    _CELL[0] = value
    rounded = _CELL[0]
    if rounded >= 2.0**-126 or not rounded:
        return rounded
    return 0.0 if -(2.0**-126) < rounded < 2.0**-126 else rounded


def float_bits(value: float) -> int:
    """The 32-bit pattern of a float32."""
    return int.from_bytes(struct.pack("<f", f32(value)), "little") if value == value else 0x7FC00000


def bits_float(bits: int) -> float:
    """The float32 of a 32-bit pattern (denormal patterns are kept: loads do not flush)."""
    return float(struct.unpack("<f", bits.to_bytes(4, "little"))[0])


def double_bits(value: float) -> int:
    """The 64-bit pattern of an IEEE double."""
    return int.from_bytes(struct.pack("<d", value), "little") if value == value else 0x7FF8000000000000


def bits_double(bits: int) -> float:
    """The IEEE double of a 64-bit pattern."""
    return float(struct.unpack("<d", bits.to_bytes(8, "little"))[0])


def divide_int(a: int, b: int) -> int:
    """C division: truncates toward zero.  `b` must not be 0."""
    quotient = abs(a) // abs(b)
    return quotient if (a < 0) == (b < 0) else -quotient


def modulo_int(a: int, b: int) -> int:
    """C remainder: has the sign of `a`.  `b` must not be 0."""
    return a - b * divide_int(a, b)


def divide_ieee(a: float, b: float) -> float:
    """Correctly rounded float32 quotient; x/0 is infinite, 0/0 NaN."""
    return f32(divide_double(a, b))


def divide_double(a: float, b: float) -> float:
    """Correctly rounded quotient of two doubles; x/0 is infinite, 0/0 NaN."""
    if b == 0.0:
        if a == 0.0 or a != a:
            return math.nan
        return math.copysign(math.inf, a) * math.copysign(1.0, b)
    return a / b


def reciprocal_seed(b: float) -> float:
    """The 8-bit estimate of 1/b that starts the iteration (EINVF32): ±0 gives ±infinity, infinity gives 0."""
    if b == 0.0:
        return math.copysign(math.inf, b)
    if math.isinf(b) or b != b:
        return 0.0
    mantissa, exponent = math.frexp(abs(b))  # mantissa in [0.5, 1)
    top = int((mantissa * 2.0 - 1.0) * 128.0)
    estimate = math.floor(32768 / (128 + top) + 0.5) / 256.0
    return f32(math.copysign(math.ldexp(estimate, 1 - exponent), b))


def divide_newton_raphson(a: float, b: float) -> float:
    """The quotient as the chip's run-time library computes it: seed, two Newton-Raphson steps, one product.

    Each step rounds; there is no final correction, so about half of the quotients differ from IEEE by up to 3 ulp.
    It reproduces published hardware results: see tests/emulator/c28x/test_arithmetic.py.
    """
    y = reciprocal_seed(b)
    if y == 0.0:
        return 0.0
    if math.isinf(y):
        return math.copysign(math.inf, a) * math.copysign(1.0, y)
    for _ in range(2):
        y = f32(y * f32(2.0 - f32(y * b)))
    return f32(a * y)


DIVIDERS: Final[dict[str, Callable[[float, float], float]]] = {
    "ieee": divide_ieee,
    "nr": divide_newton_raphson,
}


def saturate(value: float, low: int, high: int) -> int:
    """Float to int, truncated and clamped; NaN counts as +infinity.

    CHOICE: negative to unsigned giving 0 was observed on hardware, the upper clamp was not.
    """
    if value != value or value >= high + 1.0:
        return high
    if value <= low - 1.0:
        return low
    return int(value)


def low_bits(value: float, low: int, high: int) -> int:
    """Float to int: the low bits of a 32-bit conversion.  NaN and values outside the range of `long` give 0.

    A value above that range is clamped to 32 unsigned bits first where the target is unsigned.  An 8-bit target with a
    32-bit library conversion does so (its conversion gives 0x80000000 for all values out of range).  It is used to
    compare with test vectors that were computed on such a target.
    """
    wide = 0 if value != value or not -2147483648.0 <= value < 2147483648.0 else int(value)
    if low == 0 and value == value and value >= 2147483648.0:
        wide = saturate(value, 0, (1 << 32) - 1)
    span = high - low + 1
    wide &= span - 1
    return wide - span if wide > high else wide


FLOAT_TO_INT: Final[dict[str, Callable[[float, int, int], int]]] = {
    "saturate": saturate,
    "low16": low_bits,
}
