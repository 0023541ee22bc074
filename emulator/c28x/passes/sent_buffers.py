"""Static check of a buffer that `main` fills anew while an interrupt routine may still send it: `race`.

    if (Next < Length)
        return;                         // the last report is still on its way
    sprintf(Text, ...); Length = strlen(Text); Next = 0;

    sprintf(Text, "OK"); Length = strlen(Text); Next = 0;       // another function does not ask

The routine sends `Text[Next++]` as long as `Next` is below `Length`.  One function asks for one of them before it fills
the buffer, so the author knows that it may be busy.  Another one does not, nor does any that calls it.

The check needs a whole program without a kernel.  Silent if the function has switched interrupts off before: it means
to break the report off.
"""

from __future__ import annotations

import re
from typing import Final, NamedTuple

from emulator.c28x.passes.interrupted import Place, Sides, mentions, off_at, place_of, scalar_of, written
from emulator.c28x.passes.on_the_way import ways_to, with_turns
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import (
    Assign,
    Call,
    CallPointer,
    Compare,
    Function,
    Load,
    LValue,
    RegisterLoad,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import all_blocks, below, own_nodes, parts, statements

#: Functions that fill the buffer which is their first argument.
_FILLS: Final = re.compile(r"(System_)?v?sn?printf$|str(n?cpy|n?cat)$|mem(cpy|set|move)$")

#: Functions of the library that depend on their arguments only.
_OF_TEXTS: Final = re.compile(r"str|mem|ato|l?abs|f?abs|is[a-z]+$|to(upper|lower)$")


class _Filling(NamedTuple):
    """A statement that fills a buffer which is sent from its beginning then."""

    function: Function
    statement: Stmt
    #: Whether a test before it depends on what the routine goes by, or changes.
    asks: bool
    #: Whether one depends on a register, or on a function of somebody else: this may be the same question.
    may_ask: bool


def check_sent_buffers(sides: Sides) -> None:
    """Report the statements that fill a buffer without a question which others ask."""
    for routine in sides.routines:
        changed = {place for f in routine for s in statements(f.body) if (place := written(s)) is not None}
        for buffer, at, length in {each for function in routine for each in _sent(function)}:
            found = [
                _filling(sides, function, s, changed | {at, length})
                for function, body in sides.bodies.items() for s in _fillings(body, buffer, at)
            ]  # fmt: skip
            asking = next((each for each in found if each.asks), None)
            for each in found:
                body = sides.bodies[each.function]
                if asking is None or each.asks or each.may_ask:
                    continue
                if off_at(body, {id(each.statement)}) or sides.mask_of_caller(each.function):
                    continue
                name = buffer.declaration.path
                sides.owners[each.function].report(
                    each.function, each.statement.where, "race",
                    f"{name} is filled while {routine[0].name} may still send it: {asking.function.name} asks for that "
                    f"before line {asking.statement.line}",
                    object=name, declaration=buffer.declaration,
                )  # fmt: skip


def _sent(function: Function) -> list[tuple[Variable, Place, Place]]:
    """The arrays of which a function uses one element after the other, up to a length: array, index, length."""
    nodes = [p for s in statements(function.body) for p in own_nodes(s)]
    stepped = {place for s in statements(function.body) if (place := written(s)) is not None}
    found: list[tuple[Variable, Place, Place]] = []
    for p in nodes:
        if not isinstance(p, Compare) or p.op in ("==", "!="):
            continue
        at, length = scalar_of(p.left), scalar_of(p.right)
        if at is None or length is None or at not in stepped or length in stepped:
            continue
        for load in nodes:
            match load:
                case Load(lvalue=LValue(root=Variable(kind="global") as array, indices=[index])):
                    steps = _copies_of(function, at)
                    if mentions(index, at) or any(isinstance(q, LValue) and q.root in steps for q in parts(index)):
                        found.append((array, at, length))
    return found


def _copies_of(function: Function, place: Place) -> set[Variable]:
    """The locals that get the value of a word, as in `buffer[next++]`."""
    found: set[Variable] = set()
    for s in statements(function.body):
        variable = getattr(s, "variable", None)
        value = getattr(s, "value", None)
        if isinstance(variable, Variable) and value is not None and scalar_of(value) == place:
            found.add(variable)
    return found


def _fillings(body: list[Stmt], buffer: Variable, at: Place) -> list[Stmt]:
    """The statements that fill a buffer, before one of the same block that sets the index of the routine to 0."""
    found: list[Stmt] = []
    for block in all_blocks(body):
        for number, s in enumerate(block):
            if any(_fills(p, buffer) for p in own_nodes(s)) and any(
                isinstance(later, Assign) and written(later) == at and constant_of(later.value) == 0
                for later in block[number + 1 :]
            ):
                found.append(s)
    return found


def _fills(p: object, buffer: Variable) -> bool:
    match p:
        case Call(function=function, arguments=[first, *_]) if _FILLS.match(function.name):
            return any(isinstance(q, LValue) and q.root is buffer and place_of(q) is not None for q in parts(first))
    return False


def _filling(sides: Sides, function: Function, statement: Stmt, about: set[Place]) -> _Filling:
    here = next(turns for turns, s in with_turns(function) if s is statement)
    turns = [turn for way in (here, *ways_to(function, sides.bodies)) for turn in way]
    asks = any(sides.asked(turn.function, turn.test) & about for turn in turns)
    return _Filling(function, statement, asks, any(_is_foreign(sides, p) for turn in turns for p in parts(turn.test)))


def _is_foreign(sides: Sides, p: object) -> bool:
    """Whether a part of a test is a register, or the result of something that may have read one."""
    match p:
        case RegisterLoad() | CallPointer():
            return True
        case Call(function=function) if function.path in sides.own:
            inner = below([function.path], sides.own)
            nodes = (q for f in inner for s in statements(f.body) for q in own_nodes(s))
            return any(
                not isinstance(q.root, Variable) if isinstance(q, LValue) else isinstance(q, RegisterLoad | CallPointer)
                for q in nodes
            )
        case Call(function=function):
            return _OF_TEXTS.match(function.name) is None
    return False
