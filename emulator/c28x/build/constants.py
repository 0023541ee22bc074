"""Constants: the type that C gives a literal; folding, but only of operations with a defined result."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from dataclasses import replace
from typing import Final

from emulator.c28x.arithmetic import divide_int, f32, modulo_int
from emulator.c28x.ctypes import (
    CHAR,
    FLOAT,
    INT,
    LLONG,
    LONG,
    UINT,
    ULLONG,
    ULONG,
    Double64,
    FloatType,
    IntType,
)  # fmt: skip
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import (
    Binary,
    Compare,
    Conditional,
    Const,
    Convert,
    Expr,
    Logic,
    Not,
    String,
    Unary,
    Where,
)  # fmt: skip

#: The types that an integer constant may have, in order: by suffix, decimal or not (ISO C99 6.4.4.1; a decimal constant
#: may be unsigned long, as in C89, which the compiler of this chip follows by default).
_DECIMAL: Final[dict[str, tuple[IntType, ...]]] = {
    "": (INT, LONG, ULONG, LLONG, ULLONG), "u": (UINT, ULONG, ULLONG), "l": (LONG, ULONG, LLONG, ULLONG),
    "ul": (ULONG, ULLONG), "ll": (LLONG, ULLONG), "ull": (ULLONG,),
}  # fmt: skip
_OTHER: Final = {**_DECIMAL, "": (INT, UINT, LONG, ULONG, LLONG, ULLONG)}


def integer(value: int, where: Where, *, decimal: bool = True, suffix: str = "") -> Const:
    """An integer constant: the first type that holds it.  `suffix` is "", u, l, ul, ll or ull."""
    for ctype in (_DECIMAL if decimal else _OTHER)[suffix]:
        if ctype.low <= value <= ctype.high:
            return Const(ctype, value, where=where)
    raise SourceError.at(where, f"the constant does not fit into 64 bits: at most {ULLONG.high}")


def character(value: int, where: Where) -> Const:
    """A character constant is an int."""
    return Const(INT, INT.wrap(value), where=where)


def floating(value: float, where: Where, ctype: FloatType = FLOAT) -> Const:
    """A floating constant of type `ctype`.  Raises SourceError for one that is too large."""
    rounded = value if isinstance(ctype, Double64) else f32(value)
    if math.isinf(rounded):
        most = "1.7976931348623157e308" if isinstance(ctype, Double64) else "3.4028235e38"
        raise SourceError.at(where, f"the constant does not fit into a {ctype}: at most {most}")
    return Const(ctype, rounded, where=where)


def string(text: str, where: Where) -> String:
    """A string literal: its value is the address of its first character."""
    return String(CHAR.pointer, text, where=where)


def constant_value(expr: Expr) -> int | float | None:
    """The value of an expression that is constant at translation time, else None.  Handles comparisons and `?:` too."""
    folded = fold(expr)
    match folded:
        case Const():
            return folded.value
        case Not(operand=operand):
            return _not(constant_value(operand))
        case Compare(op=op, left=left, right=right):
            a, b = constant_value(left), constant_value(right)
            return None if a is None or b is None else int(_COMPARISONS[op](a, b))
        case Logic(op=op, operands=operands):
            for part in operands:
                value = constant_value(part)
                if value is None or bool(value) == (op == "or"):
                    return None if value is None else int(bool(value))
            return int(op == "and")
        case Conditional(test=test, then=then, otherwise=otherwise):
            chosen = constant_value(test)
            return None if chosen is None else constant_value(then if chosen else otherwise)
        case Convert(operand=operand) | Unary(operand=operand):
            value = constant_value(operand)
            return None if value is None else _again(replace(folded, operand=Const(operand.ctype, value)))
        case Binary(left=left, right=right):
            a, b = constant_value(left), constant_value(right)
            if a is None or b is None:
                return None
            return _again(replace(folded, left=Const(left.ctype, a), right=Const(right.ctype, b)))
    return None


def _not(value: int | float | None) -> int | None:
    return None if value is None else int(not value)


def _again(known: Expr) -> int | float | None:
    """The value of an operation whose operands are known numbers; None if it has none."""
    folded = fold(known)
    return folded.value if isinstance(folded, Const) else _wrapped(known)


def _wrapped(known: Expr) -> int | None:
    """The value of an operation whose result does not fit its type; None if neither C nor the compiler defines it.

    Unsigned types wrap (ISO C99 6.2.5).  `2 << 14` is undefined in an int of 16 bits, but the compiler keeps its bits
    with a warning, and TI's headers write the upper bits of a register so.
    """
    match known:
        case Unary(ctype=IntType() as ctype, op="-", operand=Const(value=int(value))) if not ctype.low:
            return ctype.wrap(-value)
        case Binary(ctype=IntType() as ctype, op="<<", left=Const(value=int(a)), right=Const(value=int(b))) if (
            0 <= b < ctype.bits and (not ctype.low or 0 <= a << b < 1 << ctype.bits)
        ):
            return ctype.wrap(a << b)
        case Binary(ctype=IntType() as ctype, op="+" | "-" | "*" as op, left=Const(value=int(a)), right=Const(value=b)):
            return None if ctype.low else ctype.wrap(int({"+": a + b, "-": a - b, "*": a * b}[op]))
    return None


def why_no_constant(expr: Expr) -> str | None:
    """Why a constant expression has no value: an operation divides by 0 or does not fit its type; None: no such one."""
    match expr:
        case Convert(operand=operand):
            return why_no_constant(operand)
        case Binary(left=left, right=right):
            below = why_no_constant(left) or why_no_constant(right)
            a, b = constant_value(left), constant_value(right)
            if below or a is None or b is None or constant_value(expr) is not None:
                return below
            if expr.op in "/%" and b == 0:
                return f"{a} {expr.op} 0 divides by zero"
            if isinstance(expr.ctype, IntType):
                return f"{a} {expr.op} {b} leaves {expr.ctype}, which has {expr.ctype.bits} bits: write {a}L"
    return None


_COMPARISONS: Final[dict[str, Callable[[float, float], bool]]] = {
    "==": operator.eq, "!=": operator.ne, "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge,
}  # fmt: skip


def fold(expr: Expr) -> Expr:
    """Fold conversions and arithmetic of constants that have a defined result; return anything else unchanged."""
    folded = _fold(expr)
    if isinstance(folded, Const) and folded is not expr:
        folded.source = expr
        folded.where = expr.where
    return folded


def _fold(expr: Expr) -> Expr:
    match expr:
        case Convert(ctype=IntType() as ctype, operand=Const(ctype=IntType(), value=int(value))):
            return Const(ctype, ctype.wrap(value))
        case Convert(ctype=Double64() as ctype, operand=Const(value=value)):
            return Const(ctype, float(value))
        case Binary(ctype=Double64() as ctype, op="+" | "-" | "*" as op, left=Const(value=x), right=Const(value=y)):
            return Const(ctype, {"+": x + y, "-": x - y, "*": x * y}[op])
        case Binary(ctype=Double64() as ctype, op="/", left=Const(value=x), right=Const(value=y)) if y != 0:
            return Const(ctype, x / y)
        case Convert(ctype=FloatType() as ctype, operand=Const(value=value)):
            return Const(ctype, f32(float(value)))
        case Convert(ctype=IntType() as ctype, operand=Const(ctype=FloatType(), value=value)) if (
            ctype.low - 1 < value < ctype.high + 1
        ):
            return Const(ctype, int(value))
        case Unary(ctype=IntType() as ctype, op="~", operand=Const(value=int(value))):
            return Const(ctype, ctype.wrap(~value))
        case Unary(ctype=FloatType() as ctype, op="-", operand=Const(value=value)):
            return Const(ctype, -value)
        case Unary(ctype=IntType() as ctype, op="-", operand=Const(value=int(value))) if (
            ctype.low <= -value <= ctype.high
        ):
            return Const(ctype, -value)
        case Binary(ctype=IntType() as ctype, op=op, left=Const(value=int(a)), right=Const(value=int(b))):
            if op in ("<<", ">>") and not 0 <= b < ctype.bits:
                return expr
            if op in "/%" and b != 0 and not (a == ctype.low and b == -1):
                return Const(ctype, divide_int(a, b) if op == "/" else modulo_int(a, b))
            results = {"+": a + b, "-": a - b, "*": a * b, "&": a & b, "|": a | b, "^": a ^ b}
            if op in ("<<", ">>"):
                results[op] = a << b if op == "<<" else a >> b
            result = results.get(op)
            if result is not None and ctype.low <= result <= ctype.high:
                return Const(ctype, result)
        case Binary(ctype=FloatType() as ctype, op="/", left=Const(value=x), right=Const(value=y)) if y != 0:
            # The compiler folds with IEEE division, whatever the chip's own divider does.
            return Const(ctype, f32(x / y))
        case Binary(ctype=FloatType() as ctype, op=op, left=Const(value=x), right=Const(value=y)) if op in "+-*":
            return Const(ctype, f32({"+": x + y, "-": x - y, "*": x * y}[op]))
    return expr
