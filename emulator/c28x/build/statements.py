"""Statements: assignment, declarations with a value, loops, switch labels, return."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass

from emulator.c28x.build.conversions import condition, convert
from emulator.c28x.build.initialisers import Braces, Item, values
from emulator.c28x.build.places import PINT, Place, complete, object_place, seen_by_words
from emulator.c28x.build.scope import CHAIN_NESTING, LOOP_NESTING, Builder
from emulator.c28x.ctypes import INT, VOID, ArrayType, CType, FunctionType, IntType, Member, StructType, promote
from emulator.c28x.symbols import EnumType, SourceError
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
    LeaveSwitch,
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
from emulator.c28x.tree_queries import blocks, leaves, parts


def assign(b: Builder, place: Place, value: Expr, where: Where) -> None:
    """`place = value`; structures as a whole.  Raises SourceError for what C does not assign."""
    place = complete(place)
    if isinstance(place.ctype, StructType):
        if value.ctype != place.ctype or not isinstance(place, LValue):
            raise SourceError.at(value.where, f"a {value.ctype} cannot become a {place.ctype}")
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
    """An expression for its effects: calls and register accesses are made, the value is dropped."""
    acts = Call | CallPointer | RegisterLoad
    if any(isinstance(p, acts) or (isinstance(p, LValue) and isinstance(p.root, Expr)) for p in parts(value)):
        b.emit(Evaluate(value.where, value))


def initialise(b: Builder, variable: Variable, value: Expr | list[Expr] | None, where: Where) -> None:
    """Declare a local, with a value or without; an aggregate has one value per scalar."""
    if isinstance(value, Expr) and isinstance(variable.ctype, StructType):
        b.emit(Declare(where, variable, None))
        assign(b, LValue(variable.ctype, variable, where=where, text=variable.declaration.name), value, where)
        return
    if isinstance(value, Expr):
        value = convert(b, value, variable.ctype)
        if any(isinstance(part, LValue) and part.root is variable for part in parts(value)):
            # `int x = x;` reads the same x that it declares.
            b.emit(Declare(where, variable, None))
            target = LValue(variable.ctype, variable, where=where, text=variable.declaration.name)
            b.emit(Assign(where, target, value))
            return
    variable.initialised = value is not None
    b.emit(Declare(where, variable, value))


def begin(b: Builder, variable: Variable, given: Item | Braces, where: Where) -> None:
    """Declare a local with an initialiser: a list in braces, or one value."""
    later: list[tuple[Member, Expr]] = []
    made = values(b, variable.ctype, given, later)
    initialise(b, variable, made if isinstance(variable.ctype, ArrayType | StructType) else made[0], where)
    whole = object_place(variable, where)
    for member, value in later:
        text = f"{whole.text}.{member.name}" if member.name else whole.text
        assign(b, seen_by_words(whole, member, value.where, text), value, value.where)


def in_temporary(b: Builder, value: Expr, where: Where) -> LValue:
    """A structure that a function returned, in a temporary: its members can be read, its address cannot be taken."""
    if not isinstance(value.ctype, StructType) or not value.ctype.word_backed:
        return b.temporary(value, where)
    variable = b.declare(f"result__{len(b.function.locals)}", value.ctype, where)
    initialise(b, variable, value, where)
    return object_place(variable, where)


def literal(b: Builder, ctype: CType, given: Item | Braces, where: Where) -> LValue:
    """An unnamed object with initial values: `(struct point){1, 2}`."""
    variable = b.declare(f"literal__{len(b.function.locals)}", ctype, where)
    begin(b, variable, given, where)
    return object_place(variable, where)


@dataclass(frozen=True)
class IfBranch:
    """One `if` of a chain: its test and its branch.  The branch itself opens a block if it is one."""

    where: Where
    test: Callable[[], Expr]
    then: Callable[[], None]


def chain(b: Builder, links: Sequence[IfBranch], otherwise: Callable[[], None] | None) -> None:
    """`if`, `else if` ..., `else`.  A long chain becomes a switch with one test after the other, without nesting.

    Raises SourceError for a long chain with a `break` of the switch around it.
    """
    nested = b.depth + b.chained + len(links) <= CHAIN_NESTING
    outer, loops = b.chained, b.loops
    if not nested:
        if loops == LOOP_NESTING:
            message = f"more than {LOOP_NESTING} loops and long chains of else if nested within each other"
            raise SourceError.at(links[0].where, f"{message}: write a function")
        b.loops += 1
    parts: list[tuple[Where, list[Stmt], Expr, list[Stmt]]] = []
    for i, link in enumerate(links):
        b.chained = outer + (i if nested else 2)
        effects, value = b.collect_effects(link.test)
        condition(value)
        with b.collect() as then:
            link.then()
        parts.append((link.where, effects, value, then))
    with b.collect() as rest:
        if otherwise is not None:
            otherwise()
    b.chained, b.loops = outer, loops
    if nested:
        for where, effects, value, then in reversed(parts):
            rest = [*effects, If(where, value, then, rest)]
        b.out.extend(rest)
        return
    steps: list[Stmt] = []
    for where, effects, value, then in parts:
        if any(map(_leaves_switch, then)):
            message = f"a chain of {len(links)} else if with a break of the switch around it: write a function for it"
            raise SourceError.at(links[0].where, message)
        left = then if leaves(then) else [*then, LeaveSwitch(where)]
        steps += [*effects, If(where, value, left, [])]
    b.emit(Switch(links[0].where, Const(INT, 0, where=links[0].where), [(None, [*steps, *rest])]))


def _leaves_switch(s: Stmt) -> bool:
    """Whether a statement contains a `break` of the switch around it."""
    inner = [] if isinstance(s, Switch) else blocks(s)
    return isinstance(s, LeaveSwitch) or any(_leaves_switch(part) for block in inner for part in block)


def while_(b: Builder, test: Callable[[], Expr], body: Callable[[], None], where: Where) -> None:
    """`while`."""
    loop(b, test, body, None, where)


def loop(
    b: Builder, test: Callable[[], Expr] | None, body: Callable[[], None], step: Callable[[], None] | None, where: Where
) -> None:
    """`while`, or a general `for`: `test` (None: no end), `body` as a block, then `step`, after `continue` too."""
    effects, value = b.collect_effects(test) if test is not None else ([], Const(INT, 1, where=where))
    condition(value)
    with b.collect() as steps:
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
    """Whether the body of a loop contains a `continue` of this loop."""
    return any(
        isinstance(s, Continue) or (not isinstance(s, While | For) and any(map(_continues, blocks(s)))) for s in body
    )


def do_while(b: Builder, body: Callable[[], None], test: Callable[[], Expr], where: Where) -> None:
    """`do`: the test comes after the body, and after `continue`."""
    with b.block(where, loop=True) as inner:
        body()
    effects, value = b.collect_effects(test)
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
    b: Builder, subject: Expr, cases: Sequence[tuple[list[int] | None, list[Stmt]]], where: Where,
    named: Collection[str], enumerations: Iterable[EnumType], label: str = "",
) -> None:  # fmt: skip
    """`switch`.  Labels are converted to the promoted type of the subject.  `named`: the labels, if all are names.

    `label` is its name for `Jump`.
    """
    if not isinstance(subject.ctype, IntType):
        raise SourceError.at(subject.where, "switch needs an integer")
    ctype = promote(subject.ctype)
    converted = [(None if labels is None else [ctype.wrap(v) for v in labels], body) for labels, body in cases]
    falls = any(isinstance(s, FallThrough) for _, body in converted for s in body[-1:])
    if not falls:  # the order of cases does not matter: the default comes last
        converted.sort(key=lambda case: case[0] is None)
    left = [
        {value: name for name, value in enumeration.constants.items() if name not in named}
        for enumeration in enumerations
        if named and set(named) <= set(enumeration.constants)
    ]
    b.emit(Switch(where, subject, converted, min(left, key=len) if left else None, label))


def before_label(b: Builder, body: list[Stmt], label: str, where: Where) -> None:
    """The statements before a label, which a `goto` from within (`Jump`) leaves."""
    b.emit(Switch(where, Const(INT, 0, where=where), [(None, body)], label=label))


def from_label(b: Builder, body: list[Stmt], label: str, where: Where) -> None:
    """The statements behind a label, which a `goto` from within repeats: a `continue`, or a `Jump` to `label`."""
    if not leaves(body):
        body = [*body, Break(where, said=False)]
    if label:
        body = [Switch(where, Const(INT, 0, where=where), [(None, body)], label=label)]
    b.emit(While(where, Const(INT, 1, where=where), body))


def return_(b: Builder, value: Expr | None, where: Where) -> None:
    """`return`."""
    result = b.function.ctype.result
    if value is None:
        b.emit(Return(where, None))
        return
    if result == VOID:
        raise SourceError.at(where, f"{b.function.name} returns void")
    b.emit(Return(where, convert(b, value, result)))
