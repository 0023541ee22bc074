"""Constants: the type that C gives a literal, and folding where nothing can go wrong."""

from __future__ import annotations

from emulator.c28x.arithmetic import divide_int, f32, modulo_int
from emulator.c28x.ctypes import INT, LONG, UINT, ULONG, FloatType, IntType
from emulator.c28x.tree import Binary, Const, Convert, Expr, Unary


def constant_type(value: int, hexadecimal: bool) -> IntType:
    """The type of an integer constant without suffix (ISO C 6.4.4.1 on a 16-bit int)."""
    for ctype in (INT, UINT, LONG, ULONG) if hexadecimal else (INT, LONG, ULONG):
        if ctype.low <= value <= ctype.high:
            return ctype
    return ULONG


def fold(expr: Expr) -> Expr:
    """Fold conversions and arithmetic of constants where nothing can go wrong; anything else stays."""
    folded = _fold(expr)
    if isinstance(folded, Const) and folded is not expr:
        folded.source = expr
    return folded


def _fold(expr: Expr) -> Expr:
    match expr:
        case Convert(ctype=IntType() as ctype, operand=Const(ctype=IntType(), value=int(value))):
            return Const(ctype, ctype.wrap(value))
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
