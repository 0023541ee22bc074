"""Static check of words that are written before what they stand for: `published-early`.

    ringIn = next;
    ring[old] = c;

The interrupt routine compares `ringIn` with its own index to see whether there is an element.  If it comes between the
two statements, it takes an element that is not there yet.

    State = PULL;
    pulled_ms = 0;

In this state, the routine counts `pulled_ms` and leaves the state when the count is over.  If it comes between the two
statements, it finds the count of the last time, and leaves the state at once.  Only a routine that runs all the time is
meant: it counts a clock in each run.  One of a peripheral may not come before `main` has started that.

The check needs a whole program without a kernel, in which the loop of `main` and a routine share the words; the first
form, a driver at least.  It follows what a function switches off before, also in its callers.  The mirror is
`released.py`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from emulator.c28x.passes.interrupted import (
    Place,
    Sides,
    mentions,
    off_at,
    place_of,
    runs_always,
    scalar_of,
    written,
)
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import (
    Assign,
    Binary,
    Compare,
    Declare,
    Expr,
    Function,
    If,
    Index,
    Load,
    Logic,
    LValue,
    Stmt,
    Switch,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import all_blocks, bare, own_nodes, parts, source_text, statements, within


def check_published(sides: Sides) -> None:
    """Report the words that are written before the element, or the count, that belongs to them."""
    guards = _all_guards(sides)
    timed = {found for routine in sides.routines if runs_always(sides, routine) for found in _timed(sides, routine)}
    _check_elements(sides, guards)
    for function, body in sides.bodies.items() if timed else ():
        for s, later in _begun(sides, body, timed):
            count = source_text(Load(later.target.ctype, later.target)) if isinstance(later.target, LValue) else ""
            _report(
                sides, function, s, f"is written before {count}, which says how long this state lasts (line "
                f"{later.line}): an interrupt routine that comes in between goes by the count of the last time",
            )  # fmt: skip


def check_published_elements(sides: Sides) -> None:
    """Report the words of a driver that are written before the element, unless it asks whether the ring is idle."""
    guards = _all_guards(sides)
    compared = {
        place for body in sides.bodies.values() for p in within(body) if isinstance(p, Compare) and p.op in ("==", "!=")
        for place in (scalar_of(p.left), scalar_of(p.right)) if place is not None
    }  # fmt: skip
    _check_elements(sides, {index: rings for index, rings in guards.items() if index not in compared})


def _all_guards(sides: Sides) -> dict[Place, set[Place]]:
    return {index: rings for routine in sides.routines for index, rings in _guards(routine).items()}


def _check_elements(sides: Sides, guards: dict[Place, set[Place]]) -> None:
    for function, body in sides.bodies.items() if guards else ():
        for s, later in _early(body, guards):
            _report(
                sides, function, s, f"is written before the element that it guards (line {later.line}): an interrupt "
                "routine that comes in between takes an element which is not there yet",
            )  # fmt: skip


def _report(sides: Sides, function: Function, s: Assign, what: str) -> None:
    """Report a statement that may be executed while the interrupts are on."""
    if not off_at(sides.bodies[function], {id(s)}) and not sides.mask_of_caller(function):
        name = source_text(Load(s.target.ctype, s.target)) if isinstance(s.target, LValue) else ""
        sides.owners[function].report(function, s.where, "published-early", f"{name} {what}", object=name)


def _guards(routine: list[Function]) -> dict[Place, set[Place]]:
    """The indices that a routine compares with an index of its own, each with the rings that its own one reads."""
    nodes = [p for function in routine for s in statements(function.body) for p in own_nodes(s)]
    written_here = {written(s) for function in routine for s in statements(function.body)}
    found: dict[Place, set[Place]] = {}
    for p in nodes:
        if not isinstance(p, Compare):
            continue
        for mine, other in ((scalar_of(p.left), scalar_of(p.right)), (scalar_of(p.right), scalar_of(p.left))):
            if mine is None or other is None or mine not in written_here or other in written_here:
                continue
            rings = {
                place for q in nodes if isinstance(q, Load) and len(q.lvalue.indices) == 1
                and mentions(q.lvalue.indices[0], mine) and (place := place_of(q.lvalue)) is not None
            }  # fmt: skip
            if rings:
                found[other] = rings
    return found


def _early(body: list[Stmt], guards: dict[Place, set[Place]]) -> Iterator[tuple[Assign, Stmt]]:
    """The statements that write an index, each with the one behind it that writes the element before that index."""
    copies: dict[Variable, set[Place | None]] = {}
    for s in statements(body):
        match s:
            case (
                Declare(variable=copy, value=Expr() as value)
                | Assign(target=LValue(root=Variable(kind="local") as copy, indices=[]), value=value)
            ):  # fmt: skip
                copies.setdefault(copy, set()).add(scalar_of(value))
    for block in all_blocks(body):
        for number, s in enumerate(block):
            index = written(s)
            if index is None or index not in guards or not isinstance(s, Assign):
                continue
            following = block[number + 1 :]
            if any(written(later) == index for later in following):
                continue
            for later in following:
                match later:
                    case Assign(target=LValue(indices=[Index(expr=at)]) as target) if place_of(target) in guards[index]:
                        if _is_before(at, index, bare(s.value), copies):
                            yield s, later
                            break


def _is_before(at: Expr, index: Place, given: Expr, copies: dict[Variable, set[Place | None]]) -> bool:
    """Whether a subscript is an index as it was before it got a value: its copy, or one less than it is now."""
    match bare(at):
        case Load(lvalue=LValue(root=Variable(kind="local") as copy, indices=[])):
            return copies.get(copy) == {index}
    for p in parts(at):
        match p:
            case Binary(op="-", left=left, right=right) if constant_of(right) == 1:
                pass
            case Binary(op="%" | "&" as op, left=summed, right=around):
                match bare(summed), constant_of(around):
                    case Binary(op="+", left=left, right=right), int(size) if constant_of(right) == size - (op == "%"):
                        pass
                    case _:
                        continue
            case _:
                continue
        if mentions(left, index) or any(q == given for q in parts(left) if isinstance(q, Load)):
            return True
    return False


class _Timed(NamedTuple):
    """A count that a routine moves in a state, and by which it leaves the state: the state's word and value."""

    state: Place
    value: int
    counter: Place


def _timed(sides: Sides, routine: list[Function]) -> Iterator[_Timed]:
    """The states of a routine that a count of its own ends.

    Beyond the limit, it ends them too: one that must be equal to the limit goes on when it is old.
    """
    for function in routine:
        for s in statements(function.body):
            for state, value, block in _in_states(s):
                counted = {
                    place for each in statements(block)
                    if (place := written(each)) is not None and isinstance(each, Assign)
                    and place in sides.asked(function, each.value)
                }  # fmt: skip
                for decision in statements(block):
                    if isinstance(decision, If) and any(written(each) == state for each in statements(decision.then)):
                        for limit in parts(decision.test):
                            if isinstance(limit, Compare) and limit.op not in ("==", "!="):
                                asked = sides.asked(function, limit)
                                yield from (_Timed(state, value, count) for count in counted & asked - {state})


def _in_states(s: Stmt) -> Iterator[tuple[Place, int, list[Stmt]]]:
    """The blocks of a statement that are executed only while a word has a value: the word, the value, the block."""
    match s:
        case Switch(subject=subject, cases=cases) if (state := scalar_of(subject)) is not None:
            yield from ((state, value, block) for values, block in cases for value in values or ())
        case If(test=test, then=then):
            for each in test.operands if isinstance(test, Logic) and test.op == "and" else [test]:
                match bare(each):
                    case Compare(op="==", left=left, right=right):
                        state, value = scalar_of(left), constant_of(right)
                        if state is not None and value is not None:
                            yield state, value, then


def _begun(sides: Sides, body: list[Stmt], timed: set[_Timed]) -> Iterator[tuple[Assign, Assign]]:
    """The statements that begin a timed state, each with the one behind it that sets the count.

    If anything else sets the count to this value, nothing old may be left in it.
    """
    for block in all_blocks(body):
        for number, s in enumerate(block):
            counts = {t.counter for t in timed if isinstance(s, Assign) and t.state == written(s)
                      and t.value == constant_of(s.value)}  # fmt: skip
            for later in block[number + 1 :] if counts else ():
                if isinstance(s, Assign) and isinstance(later, Assign) and (count := written(later)) in counts:
                    everywhere = [s for other in sides.bodies.values() for s in statements(other)]
                    everywhere += [w.statement for w in sides.routine_writes]
                    if not any(
                        isinstance(each, Assign) and each is not later and written(each) == count
                        and bare(each.value) == bare(later.value) for each in everywhere
                    ):  # fmt: skip
                        yield s, later
                    break
