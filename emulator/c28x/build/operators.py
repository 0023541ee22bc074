"""Operators on typed operands: arithmetic, comparisons, logic, choice, steps, and assignments used as values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

from emulator.c28x.build.constants import fold
from emulator.c28x.build.conversions import ADDRESSES, condition, convert, promoted
from emulator.c28x.build.depth import shallow
from emulator.c28x.build.effects import arguments, evaluated_once
from emulator.c28x.build.places import Place, complete, value_of
from emulator.c28x.build.scope import DEEP_NESTING, Builder
from emulator.c28x.build.statements import assign, evaluate
from emulator.c28x.ctypes import (
    INT,
    LONG,
    VOID,
    BlockType,
    CType,
    FloatType,
    IntType,
    PointerType,
    StructType,
    is_arithmetic,
    promote,
    usual,
)  # fmt: skip
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import (
    Assign,
    Binary,
    Compare,
    Conditional,
    Const,
    Declare,
    Expr,
    If,
    Load,
    Logic,
    LValue,
    Not,
    Null,
    PointerAdd,
    PointerDifference,
    Stmt,
    Unary,
    Variable,
    Where,
)  # fmt: skip

#: After so many folded constants, a constant no longer records what it was folded from.
_LONG: Final = 40
BINARY: Final = frozenset({"+", "-", "*", "/", "%", "<<", ">>", "&", "|", "^"})
COMPARISONS: Final = frozenset({"==", "!=", "<", "<=", ">", ">="})


def unary(b: Builder, op: str, operand: Expr, where: Where) -> Expr:
    """`-x`, `+x` or `~x` after the integer promotions."""
    if op == "~" and isinstance(operand.ctype, IntType):
        ctype = promote(operand.ctype)
        return fold(Unary(ctype, "~", convert(b, operand, ctype), where=where))
    if op in "+-" and is_arithmetic(operand.ctype):
        converted = promoted(b, operand)
        return converted if op == "+" else fold(Unary(converted.ctype, "-", converted, where=where))
    raise SourceError.at(where, f"{op} does not apply to a {operand.ctype}")


def logical_not(b: Builder, operand: Expr, where: Where) -> Expr:
    """`!x`."""
    return Not(INT, condition(operand), where=where)


def binary(b: Builder, op: str, left: Expr, right: Expr, where: Where) -> Expr:
    """`left op right` with C's conversions."""
    if isinstance(left.ctype, PointerType):
        if op == "-" and isinstance(right.ctype, PointerType):
            return PointerDifference(LONG, _sized(left, where), right, where=where)
        if op in "+-" and isinstance(right.ctype, IntType):
            return PointerAdd(left.ctype, _sized(left, where), right, negative=op == "-", where=where)
    if isinstance(right.ctype, PointerType) and op == "+" and isinstance(left.ctype, IntType):
        return PointerAdd(right.ctype, _sized(right, where), left, where=where)
    if not is_arithmetic(left.ctype) or not is_arithmetic(right.ctype):
        raise SourceError.at(where, f"{left.ctype} {op} {right.ctype} is not C")
    if op in ("<<", ">>"):
        if not isinstance(left.ctype, IntType) or not isinstance(right.ctype, IntType):
            raise SourceError.at(where, f"{op} is for integers")
        return fold(Binary(promote(left.ctype), op, promoted(b, left), promoted(b, right), where=where))
    ctype = usual(left.ctype, right.ctype)
    if op in ("%", "&", "|", "^") and isinstance(ctype, FloatType):
        raise SourceError.at(where, f"{op} is for integers")
    return fold(Binary(ctype, op, convert(b, left, ctype), convert(b, right, ctype), where=where))


def row(
    b: Builder, builds: Sequence[Callable[[], Expr]], steps: Sequence[tuple[str, Where]]
) -> Expr:  # fmt: skip
    """A chain of operators, such as a sum of many terms: `((a + b) + c) < d`.  Operands go from left to right."""
    b.deep |= len(steps) > DEEP_NESTING
    result, *rest = arguments(b, builds)
    for i, ((op, where), right) in enumerate(zip(steps, rest, strict=True), 1):
        combine = compare if op in COMPARISONS else binary
        result = combine(b, op, shallow(b, result), right, where)
        if i % _LONG == 0 and isinstance(result, Const):
            result = Const(result.ctype, result.value, where=where)  # without what it was folded from
    return result


def _sized(pointer: Expr, where: Where) -> Expr:
    """`pointer`, if arithmetic on it is possible.  Raises SourceError if its target has no size."""
    assert isinstance(pointer.ctype, PointerType)
    target = pointer.ctype.target
    if isinstance(target, BlockType) or (isinstance(target, StructType) and not target.members):
        raise SourceError.at(where, f"a {pointer.ctype} has no next one: the size of {target} is not known")
    return pointer


def compare(b: Builder, op: str, left: Expr, right: Expr, where: Where) -> Expr:
    """A comparison with C's conversions."""
    if is_arithmetic(left.ctype) and is_arithmetic(right.ctype):
        ctype = usual(left.ctype, right.ctype)
        return Compare(INT, op, convert(b, left, ctype), convert(b, right, ctype), where=where)
    left, right = _null(b, left, right), _null(b, right, left)
    if isinstance(left.ctype, ADDRESSES) and isinstance(right.ctype, ADDRESSES):
        return Compare(INT, op, left, right, where=where)
    raise SourceError.at(where, f"{left.ctype} {op} {right.ctype} is not C")


def _null(b: Builder, value: Expr, other: Expr) -> Expr:
    """`value`, or the null pointer if it is a constant 0 that is compared with a pointer."""
    if isinstance(value, Const) and value.value == 0 and isinstance(other.ctype, ADDRESSES):
        return Null(other.ctype, where=value.where)
    if b.remarks_pointers and isinstance(value.ctype, IntType) and isinstance(other.ctype, ADDRESSES):
        return convert(b, value, other.ctype)
    return value


def logic(b: Builder, op: str, builds: Sequence[Callable[[], Expr]], where: Where) -> Expr:
    """`and` / `or`.  An operand with effects is evaluated in a branch of its own."""
    values: list[Expr] = []
    for i, build in enumerate(builds):
        effects, value = b.collect_effects(build)
        condition(value)
        if effects and i:
            return _logic_in_steps(b, op, values, (effects, value), builds[i + 1 :], where)
        b.out.extend(effects)
        if not i and isinstance(value, Logic) and value.op == op:
            values.extend(value.operands)
        else:
            values.append(value)
    return Logic(INT, op, values, where=where)


def _logic_in_steps(
    b: Builder, op: str, values: list[Expr], last: tuple[list[Stmt], Expr], rest: Sequence[Callable[[], Expr]],
    where: Where,
) -> Expr:  # fmt: skip
    """`values op last op rest`, where `last` has effects: they happen only if `values` do not decide the result."""
    effects, value = last
    so_far = Logic(INT, op, values, where=where) if len(values) > 1 else Not(INT, Not(INT, values[0]), where=where)
    place = b.temporary(so_far, where)
    with b.collect() as branch:
        b.out.extend(effects)
        others = logic(b, op, [lambda: value, *rest], where) if rest else Not(INT, Not(INT, value), where=where)
        b.emit(Assign(where, place, others))
    undecided: Expr = Load(INT, place, where=where)
    b.emit(If(where, undecided if op == "and" else Not(INT, undecided, where=where), branch, []))
    return Load(INT, place, where=where)


def conditional(
    b: Builder, test: Expr, then: Callable[[], Expr], otherwise: Callable[[], Expr], where: Where
) -> Expr:  # fmt: skip
    """`test ? then : otherwise`: one of the two is evaluated, with its effects."""
    condition(test)
    first, a = b.collect_effects(then)
    second, c = b.collect_effects(otherwise)
    ctype = _common(b, a, c, where)
    a, c = convert(b, a, ctype), convert(b, c, ctype)
    if ctype == VOID:
        for effects, value in ((first, a), (second, c)):
            with b.collect() as branch:
                evaluate(b, value)
            effects.extend(branch)
        b.emit(If(where, test, first, second))
        return Const(VOID, 0, where=where)
    if not first and not second:
        return Conditional(ctype, test, a, c, where=where)
    place = b.unset(ctype, where)
    assert isinstance(place.root, Variable)
    b.emit(Declare(where, place.root, None))
    b.emit(If(where, test, [*first, Assign(where, place, a)], [*second, Assign(where, place, c)]))
    return Load(ctype, place, where=where)


def _common(b: Builder, a: Expr, c: Expr, where: Where) -> CType:
    """The type of a choice between two values."""
    if is_arithmetic(a.ctype) and is_arithmetic(c.ctype):
        return usual(a.ctype, c.ctype)
    if VOID in (a.ctype, c.ctype):
        return VOID
    if isinstance(a, Null) or (isinstance(a, Const) and isinstance(c.ctype, ADDRESSES)):
        return c.ctype
    if isinstance(a.ctype, PointerType) and isinstance(c.ctype, PointerType) and c.ctype.target == VOID:
        return c.ctype if not isinstance(c, Null) else a.ctype
    return a.ctype


def combined(b: Builder, op: str, place: Place, value: Expr, where: Where) -> None:
    """`place op= value` as a statement."""
    place = complete(evaluated_once(b, place))
    result = binary(b, op, value_of(b, place), value, where)
    assign(b, place, result, where)


def step(b: Builder, op: str, place: Place, where: Where, *, before: bool) -> Expr:
    """`++x`, `x++`, `--x` or `x--` as a value; `before`: the value after the step."""
    place = complete(evaluated_once(b, place))
    old = value_of(b, place)
    if not before:
        old = b.saved(old)
    new = binary(b, op, old, Const(INT, 1, where=where), where)
    if before:
        return assigned(b, place, new, where)
    assign(b, place, new, where)
    return old


def assigned(b: Builder, place: Place, value: Expr, where: Where) -> Expr:
    """`place = value` as a value: what the object holds after it."""
    place = complete(place)
    converted = value if isinstance(place.ctype, StructType) else convert(b, value, place.ctype)
    plain = isinstance(place, LValue) and isinstance(place.root, Variable) and place.bits is None
    if plain and not place.root.volatile and not place.indices:  # type: ignore[union-attr]
        assign(b, place, converted, where)
        return value_of(b, place)
    if not isinstance(converted, Const) and not isinstance(place.ctype, StructType):
        converted = b.saved(converted)
    assign(b, place, converted, where)
    if isinstance(place, LValue) and place.bits is not None and isinstance(converted, Const):
        assert isinstance(place.ctype, IntType)
        return replace(converted, value=place.ctype.wrap(int(converted.value)))
    return converted
