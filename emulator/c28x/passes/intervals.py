"""Pass `intervals`: the bounds of each integer.

They follow from types, constants and counting loops.  One walk stores on the nodes: `Expr.bounds`, `Binary.exact`, and
for a `For`, whether a Python loop does the same (`plain`, `trips`), else its `test`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from emulator.c28x.ctypes import INT, IntType, usual
from emulator.c28x.tree import (
    Binary,
    Compare,
    Conditional,
    Const,
    Convert,
    Expr,
    For,
    Interval,
    Load,
    Logic,
    LValue,
    Not,
    Stmt,
    Unary,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned_variables, blocks, observable, own_nodes, parts, variables

Ranges = Mapping[Variable, Interval]

#: Operators for which wrapping the operands or the result gives the same.
RING: Final = ("+", "-", "*")
#: Bits of the longest integer: C does not define a shift by as many or more.
LONGEST: Final = 64


def annotate_bounds(body: list[Stmt], ranges: Ranges | None = None) -> None:
    """Store the bounds of all expressions of `body` on them; `ranges`: known bounds of counting locals."""
    known = ranges or {}
    for s in body:
        _bound(own_nodes(s), known)
        if isinstance(s, For):
            _count(s, known)
        else:
            for inner in blocks(s):
                annotate_bounds(inner, known)


def bounds_of(e: Expr) -> Interval:
    """The bounds that the walk has found."""
    assert e.bounds is not None
    return e.bounds


def _bound(nodes: list[Any], ranges: Ranges) -> None:
    """Store the bounds of expressions; each is before its operands."""
    for e in reversed(nodes):
        if isinstance(e, Expr) and isinstance(e.ctype, IntType):
            if isinstance(e, Binary):
                e.exact = combine(e.op, bounds_of(e.left), bounds_of(e.right))
            e.bounds = bounds(e, ranges, bounds_of)


def _count(s: For, ranges: Ranges) -> None:
    """Decide how a counting loop is written, and store the bounds of its variable within it."""
    root = s.counter
    assert isinstance(root.ctype, IntType)
    match s.start, s.stop:
        case Const(value=int(first)), Const(value=int(last)):
            s.trips = range(first, last, s.step)
    s.plain = _runs_alone(s, root) and _counts_plainly(s, root.ctype)
    if s.plain:
        (low, high), (stop_low, stop_high) = bounds_of(s.start), bounds_of(s.stop)
        within = (low, max(low, stop_high - 1)) if s.step > 0 else (min(high, stop_low + 1), high)
        annotate_bounds(s.body, {**ranges, root: within})
        return
    common = usual(root.ctype, s.stop.ctype)
    variable = Convert(common, Load(root.ctype, s.variable, where=s.where), where=s.where)
    stop = Convert(common, s.stop, where=s.stop.where)
    s.test = Compare(INT, "<" if s.step > 0 else ">", variable, stop, where=s.where)
    _bound(parts(s.test), ranges)
    annotate_bounds(s.body, ranges)


def _runs_alone(s: For, root: Variable) -> bool:
    """Whether only the loop itself changes its variable, and nothing changes its bound."""
    changed = assigned_variables(s.body)
    used = variables(parts(s.stop))
    return (
        root.plain and root not in changed and not observable(s.stop)
        and root not in used and not any(v in changed or (v.in_memory and v.escapes) for v in used)
    )  # fmt: skip


def _counts_plainly(s: For, ctype: IntType) -> bool:
    """Whether conversions in the test do not matter, and the variable can hold its value after the loop."""
    if not isinstance(s.stop.ctype, IntType):
        return False
    common = usual(ctype, s.stop.ctype)
    assert isinstance(common, IntType)
    (start_low, _), (stop_low, stop_high) = bounds_of(s.start), bounds_of(s.stop)
    if min(start_low, stop_low) < common.low:
        return False
    if s.trips is not None:
        return not s.trips or ctype.low <= s.trips[-1] + s.step <= ctype.high
    return stop_high + s.step - 1 <= ctype.high if s.step > 0 else stop_low + s.step + 1 >= ctype.low


def interval(e: Expr, ranges: Ranges) -> Interval:
    """Bounds of an integer expression; `ranges`: known bounds of locals."""
    return bounds(e, ranges, lambda operand: interval(operand, ranges))


def bounds(e: Expr, ranges: Ranges, of: Callable[[Expr], Interval]) -> Interval:
    """Bounds of an integer expression; `ranges`: known bounds of locals, `of` returns those of an operand."""
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
        case Unary(op="~", operand=operand) if not ctype.signed:
            a, b = of(operand)
            return (high - b, high - a)
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
