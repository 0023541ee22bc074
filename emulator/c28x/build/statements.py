"""Statements: assignment, declarations with a value, loops, switch labels, return."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from emulator.c28x.build.conversions import condition, convert
from emulator.c28x.build.places import PINT, Place, complete
from emulator.c28x.build.scope import Builder
from emulator.c28x.ctypes import INT, VOID, ArrayType, FunctionType, IntType, StructType, promote
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import (
    Assign,
    Break,
    Call,
    CallPointer,
    Const,
    Continue,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    FallThrough,
    For,
    If,
    Load,
    LValue,
    Not,
    RegisterLoad,
    Return,
    Stmt,
    Switch,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import blocks, parts


def assign(b: Builder, place: Place, value: Expr, where: Where) -> None:
    """`place = value`; structures as a whole.  Raises SourceError for what C does not assign."""
    place = complete(place)
    if isinstance(place.ctype, StructType):
        if value.ctype != place.ctype or not isinstance(place, LValue):
            raise SourceError.at(value.where, f"a {place.ctype} is assigned from another {place.ctype}")
        if not isinstance(value, Load):  # what a function returned
            b.emit(Assign(where, place, value))
            return
        for side in (place, value.lvalue):
            if isinstance(side.root, Variable):
                side.root.escapes = True
        b.emit(CopyStruct(where, place, value.lvalue))
        return
    if isinstance(place.ctype, ArrayType):
        raise SourceError.at(place.where, "an array is not assignable in C")
    if place.ctype == PINT and isinstance(value.ctype, FunctionType) and value.ctype.parameters:
        raise SourceError.at(value.where, "an interrupt routine has no parameters")
    b.emit(Assign(where, place, convert(b, value, place.ctype)))


def evaluate(b: Builder, value: Expr) -> None:
    """An expression for its effect: calls and accesses to registers happen, the value is dropped."""
    acts = Call | CallPointer | RegisterLoad
    if any(isinstance(p, acts) or (isinstance(p, LValue) and isinstance(p.root, Expr)) for p in parts(value)):
        b.emit(Evaluate(value.where, value))


def initialise(b: Builder, variable: Variable, value: Expr | list[Expr] | None, where: Where) -> None:
    """A local begins, with a value (of an aggregate: one a scalar) or without."""
    if isinstance(value, Expr) and isinstance(variable.ctype, StructType):
        b.emit(Declare(where, variable, None))
        assign(b, LValue(variable.ctype, variable, where=where, text=variable.declaration.name), value, where)
        return
    if isinstance(value, Expr):
        value = convert(b, value, variable.ctype)
        if any(isinstance(part, LValue) and part.root is variable for part in parts(value)):
            # `int x = x;` reads the x that begins here.
            b.emit(Declare(where, variable, None))
            target = LValue(variable.ctype, variable, where=where, text=variable.declaration.name)
            b.emit(Assign(where, target, value))
            return
    variable.initialised = value is not None
    b.emit(Declare(where, variable, value))


def if_(b: Builder, test: Expr, then: Callable[[], None], otherwise: Callable[[], None] | None, where: Where) -> None:
    """`if`; the branches say themselves whether they are blocks."""
    condition(test)
    with b.aside() as first:
        then()
    with b.aside() as second:
        if otherwise is not None:
            otherwise()
    b.emit(If(where, test, first, second))


def while_(b: Builder, test: Callable[[], Expr], body: Callable[[], None], where: Where) -> None:
    """`while`."""
    loop(b, test, body, None, where)


def loop(
    b: Builder, test: Callable[[], Expr] | None, body: Callable[[], None], step: Callable[[], None] | None, where: Where
) -> None:
    """`while`, or `for` at large: `test` (none: for ever), `body` as a block, then `step`, at `continue` too."""
    effects, value = b.apart(test) if test is not None else ([], Const(INT, 1, where=where))
    condition(value)
    with b.aside() as steps:
        if step is not None:
            step()
    with b.block(where, loop=True) as inner:
        body()
    if effects:
        ends = If(value.where, Not(INT, value, where=value.where), [Break(value.where)], [])
        inner = [*effects, ends, *inner]
        value = Const(INT, 1, where=value.where)
    if not _continues(inner):
        inner, steps = [*inner, *steps], []
    b.emit(While(where, value, inner, steps))


def _continues(body: list[Stmt]) -> bool:
    """Whether a `continue` of this loop stands in its body."""
    return any(
        isinstance(s, Continue) or (not isinstance(s, While | For) and any(map(_continues, blocks(s)))) for s in body
    )


def do_while(b: Builder, body: Callable[[], None], test: Callable[[], Expr], where: Where) -> None:
    """`do`: the test comes behind the body, at `continue` too."""
    with b.block(where, loop=True) as inner:
        body()
    effects, value = b.apart(test)
    condition(value)
    if not effects:
        b.emit(While(where, value, inner, first=False))
        return
    again = b.temporary(Const(INT, 1, where=where), where)
    repeat = Assign(value.where, again, Not(INT, Not(INT, value, where=value.where), where=value.where))
    b.emit(While(where, Load(INT, again, where=where), inner, [*effects, repeat]))


def for_range(
    b: Builder, counter: LValue, start: Expr, stop: Expr, step: int, body: Callable[[], None], where: Where
) -> None:
    """`for (counter = start; counter < stop; counter += step)`; `>` where `step` is negative."""
    if not isinstance(counter.ctype, IntType):
        raise SourceError.at(where, "the loop variable must be a declared integer object")
    if not isinstance(stop.ctype, IntType):
        message = f"the limit of a counted loop is an integer, not a {stop.ctype}: write a while"
        raise SourceError.at(stop.where, message)
    first = convert(b, start, counter.ctype)
    with b.block(where, loop=True) as inner:
        body()
    b.emit(For(where, counter, first, stop, step, inner))


def switch(
    b: Builder, subject: Expr, cases: Sequence[tuple[list[int] | None, list[Stmt]]], where: Where, *, complete: bool
) -> None:
    """`switch`: C converts a label to the promoted type of the subject.."""
    if not isinstance(subject.ctype, IntType):
        raise SourceError.at(subject.where, "switch needs an integer")
    ctype = promote(subject.ctype)
    converted = [(None if labels is None else [ctype.wrap(v) for v in labels], body) for labels, body in cases]
    falls = any(isinstance(s, FallThrough) for _, body in converted for s in body[-1:])
    if not falls:  # the order of cases does not matter: the default comes last
        converted.sort(key=lambda case: case[0] is None)
    b.emit(Switch(where, subject, converted, complete))


def return_(b: Builder, value: Expr | None, where: Where) -> None:
    """`return`."""
    result = b.function.ctype.result
    if value is None:
        b.emit(Return(where, None))
        return
    if result == VOID:
        raise SourceError.at(where, f"{b.function.name} returns void")
    b.emit(Return(where, convert(b, value, result)))
