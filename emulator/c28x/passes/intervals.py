"""Bounds of integer expressions: what the type, the constants and what is known of some locals prove."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.tree import (
    Binary,
    Compare,
    Conditional,
    Const,
    Convert,
    Expr,
    Interval,
    Load,
    Logic,
    LValue,
    Not,
    Variable,
)  # fmt: skip

Ranges = Mapping[Variable, Interval]

#: Operators for which wrapping commutes with computing.
RING: Final = ("+", "-", "*")
#: Bits of the longest integer: a shift by as many, or more, has no value that C defines.
LONGEST: Final = 64


def interval(e: Expr, ranges: Ranges) -> Interval:
    """Bounds of an integer expression; `ranges` says what is known of locals."""
    return bounds(e, ranges, lambda operand: interval(operand, ranges))


def bounds(e: Expr, ranges: Ranges, of: Callable[[Expr], Interval]) -> Interval:
    """Bounds of an integer expression; `of` gives those of its operands."""
    ctype = e.ctype
    assert isinstance(ctype, IntType)
    low, high = ctype.low, ctype.high
    match e:
        case Const(value=int(value)):
            return (value, value)
        case Load(lvalue=LValue(root=Variable() as root, indices=[], bits=None)) if root in ranges:
            return ranges[root]
        case Load(lvalue=LValue(bits=field)) if field is not None:
            half = 1 << field.width - 1
            return (-half, half - 1) if ctype.signed else (0, 2 * half - 1)
        case Compare() | Logic() | Not():
            return (0, 1)
        case Convert(operand=operand) if isinstance(operand.ctype, IntType):
            inner = of(operand)
            return inner if low <= inner[0] and inner[1] <= high else (low, high)
        case Conditional(then=then, otherwise=otherwise):
            (a, b), (c, d) = of(then), of(otherwise)
            return (min(a, c), max(b, d))
        case Binary(op=op, left=left, right=right):
            result = combine(op, of(left), of(right))
            return result if result is not None and low <= result[0] and result[1] <= high else (low, high)
    return (low, high)


def combine(op: str, left: Interval, right: Interval) -> Interval | None:
    """Bounds of the mathematical result of `left op right`, before any wrap; None: not known."""
    (a, b), (c, d) = left, right
    match op:
        case "+":
            return (a + c, b + d)
        case "-":
            return (a - d, b - c)
        case "*":
            products = (a * c, a * d, b * c, b * d)
            return (min(products), max(products))
        case "&" if c >= 0:
            return (0, min(b, d) if a >= 0 else d)
        case "&" if a >= 0:
            return (0, b)
        case "|" | "^" if a >= 0 and c >= 0:
            return (0, (1 << max(b, d).bit_length()) - 1)
        case ">>" if c == d >= 0:
            return (a >> c, b >> c)
        case "<<" if 0 <= c == d < LONGEST:
            return (a << c, b << c)
        case "/" if c == d > 0 and a >= 0:
            return (a // c, b // c)
        case "%" if c == d > 0 and a >= 0:
            return (0, min(b, c - 1))
    return None
