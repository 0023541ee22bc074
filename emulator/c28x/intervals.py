"""Bounds of integer expressions: what the type, the constants and what is known of some locals prove."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.tree import (
    Binary,
    Compare,
    Conditional,
    Const,
    Convert,
    Expr,
    Load,
    Logic,
    LValue,
    Not,
    Variable,
)  # fmt: skip

Interval = tuple[int, int]
Ranges = Mapping[Variable, Interval]

#: Operators for which wrapping commutes with computing.
RING: Final = ("+", "-", "*")


def combine(op: str, left: Interval, right: Interval) -> Interval:
    """Bounds of `left op right` for +, - and *."""
    (a, b), (c, d) = left, right
    if op == "+":
        return (a + c, b + d)
    if op == "-":
        return (a - d, b - c)
    products = (a * c, a * d, b * c, b * d)
    return (min(products), max(products))


def interval(e: Expr, ranges: Ranges) -> Interval:
    """Bounds of an integer expression; `ranges` says what is known of locals."""
    ctype = e.ctype
    assert isinstance(ctype, IntType)
    whole = (ctype.low, ctype.high)
    match e:
        case Const(value=int(value)):
            return (value, value)
        case Load(lvalue=LValue(root=Variable() as root, indices=[])) if root in ranges:
            return ranges[root]
        case Compare() | Logic() | Not():
            return (0, 1)
        case Convert(operand=operand) if isinstance(operand.ctype, IntType):
            inner = interval(operand, ranges)
            return inner if whole[0] <= inner[0] and inner[1] <= whole[1] else whole
        case Conditional(then=then, otherwise=otherwise):
            (a, b), (c, d) = interval(then, ranges), interval(otherwise, ranges)
            return (min(a, c), max(b, d))
        case Binary():
            bounds = exact(e, ranges)
            return bounds if bounds is not None and whole[0] <= bounds[0] and bounds[1] <= whole[1] else whole
    return whole


def exact(e: Binary, ranges: Ranges) -> Interval | None:
    """Bounds of the mathematical result, before any wrap."""
    (a, b), (c, d) = interval(e.left, ranges), interval(e.right, ranges)
    match e.op:
        case op if op in RING:
            return combine(op, (a, b), (c, d))
        case "&" if c >= 0:
            return (0, min(b, d) if a >= 0 else d)
        case "&" if a >= 0:
            return (0, b)
        case "|" | "^" if a >= 0 and c >= 0:
            return (0, (1 << max(b, d).bit_length()) - 1)
        case ">>" if c == d >= 0:
            return (a >> c, b >> c)
        case "<<" if c == d >= 0:
            return (a << c, b << c)
        case "/" if c == d > 0 and a >= 0:
            return (a // c, b // c)
        case "%" if c == d > 0 and a >= 0:
            return (0, min(b, c - 1))
    return None
