"""Static check of indices, flags and sums that `main` and an interrupt routine both write, without a mask: `race`.

    Out = (Out + 1) % SIZE;             // in main, where the routine does the same if the ring is full
    Alarms = (Alarms & ~LOW) | (volts < LIMIT ? LOW : 0);       // the routine does `Alarms |= HIGH;`
    events = Events; Events = 0;                                // or `Events |= LOST;`
    heading = wrap(heading + correction);                       // or `heading = wrap(heading + rate * STEP);`

If the routine comes between the read and the write, what it wrote is lost.  The check needs a whole program without a
kernel.  `Out += 1` and `Flags &= ~1` are one instruction, and the routine comes before or behind it.

Only of subscripts, of flags of which a routine that counts a clock changes some and keeps the others, and of sums
(floats) to which both sides add, the routine of a clock whose time `main` takes: other objects may have a routine that
writes them once, before `main` does.  Silent if the routine writes only under a condition that
`main` sets: it may not come then.  And, of flags, if `main` goes by what the routine sets and masks none of that: it
may always be done before the routine comes again.
"""

from __future__ import annotations

from collections.abc import Iterator

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.interrupted import (
    Place,
    RoutineWrite,
    Sides,
    mentions,
    off_at,
    place_of,
    runs_always,
    switched,
    test_of,
    written,
)
from emulator.c28x.passes.on_the_way import ways_to, with_turns
from emulator.c28x.passes.taken import mark_copy_and_clear
from emulator.c28x.tree import Assign, Binary, Declare, Expr, Function, Index, Load, LValue, Stmt, Variable, While
from emulator.c28x.tree_queries import added, bare, own_nodes, parts, source_text, statements, variables

#: Operators that change a word in memory by one instruction (CPU, `ADD loc16`, `AND loc16`, `ADDL loc32`).
_ONE_INSTRUCTION = ("+", "-", "&", "|", "^")
_BITS = ("&", "|", "^")


def check_lost_writes(sides: Sides) -> None:
    """Report what `main` computes from its old value and a routine writes, too."""
    always = {function for routine in sides.routines if runs_always(sides, routine) for function in routine}
    for function in sides.bodies:
        mark_copy_and_clear(function)
    for place, writes in _routine_writes(sides).items():
        timed = {w.function: w for w in writes if _adds(w.statement, place) and _is_timed(sides, w.function)}
        total = next(iter(timed.values()), None)
        flags = next((w for w in writes if w.function in always and _changes_bits(w.statement, place)), None)
        for function, body in sides.bodies.items():
            for s in statements(body):
                if not isinstance(s, Assign) or written(s) != place:
                    continue
                if total is not None and _adds(s, place) and not _after_the_routine(sides, function, s, total.function):
                    _tell(sides, function, s, total)
                    continue
                if not s.takes and not _from_itself(function, s.value, place):
                    continue
                index = not s.takes and _is_index(body, place)
                write = writes[0] if index else flags
                if write is None or (not index and _kept_apart_by_time(sides, write.function)):
                    continue
                _tell(sides, function, s, write)


def _tell(sides: Sides, function: Function, s: Assign, write: RoutineWrite) -> None:
    """Report a statement of `main`, if nothing masks the routine then."""
    body = sides.bodies[function]
    if off_at(body, {id(s)}) or sides.mask_of_caller(function):
        return
    assert isinstance(s.target, LValue)
    name = source_text(Load(s.target.ctype, s.target))
    lost = f"what {write.function.name} writes in between (line {write.statement.line}) is lost"
    how = "cleared behind a read" if s.takes else "computed from its old value"
    message = f"{name} is {how}, and the interrupt is not masked: {lost}"
    sides.owners[function].report(function, s.where, "race", message, object=name)


def _adds(s: Assign, place: Place) -> bool:
    """Whether a statement adds something to a float, also on the way through a function."""
    if not isinstance(s.target, LValue) or not isinstance(s.target.ctype, FloatType):
        return False
    for p in parts(s.value):
        match p:
            case Binary(op="+" | "-", left=one, right=other) if _is(one, place) and not mentions(other, place):
                return True
            case Binary(op="+", left=other, right=one) if _is(one, place) and not mentions(other, place):
                return True
    return False


def _set_with(sides: Sides, function: Function) -> set[Place]:
    """What the routine sets of which a function is a part."""
    routine = next(r for r in sides.routines if function in r)
    return {
        place for w in sides.routine_writes if w.function in routine and (place := written(w.statement)) is not None
    }  # fmt: skip


def _is_timed(sides: Sides, function: Function) -> bool:
    """Whether the routine of a function counts a clock in each run, and `main` takes times of it."""
    routine = next(r for r in sides.routines if function in r)
    clocks = {
        place for s in routine[0].body
        if (place := written(s)) is not None and added(s) is not None and place not in sides.main_writes
    }  # fmt: skip
    return any(
        isinstance(p, Binary) and p.op == "-" and not clocks.isdisjoint(sides.asked(reader, p.left))
        for reader, body in sides.bodies.items() if clocks for s in statements(body) for p in own_nodes(s)
    )


def _after_the_routine(sides: Sides, function: Function, s: Stmt, other: Function) -> bool:
    """Whether `main` comes to a statement behind the routine: it waits for it, or has asked for what it sets."""
    there = _set_with(sides, other)
    for reader, body in sides.bodies.items():
        for each in statements(body):
            if isinstance(each, While) and not sides.asked(reader, each.test).isdisjoint(there):
                return True
    here = next(turns for turns, each in with_turns(function) if each is s)
    turns = [turn for way in (here, *ways_to(function, sides.bodies)) for turn in way]
    return any(not sides.asked(turn.function, turn.test).isdisjoint(there) for turn in turns)


def _is_index(body: list[Stmt], place: Place) -> bool:
    """Whether an object is a subscript in some statements."""
    nodes = [p for s in statements(body) for p in own_nodes(s)]
    return any(isinstance(p, Index) and mentions(p.expr, place) for p in nodes)


def _changes_bits(s: Assign, place: Place) -> bool:
    """Whether a statement changes bits of a word and keeps the others."""
    value = bare(s.value)
    return isinstance(value, Binary) and value.op in _BITS and (_is(value.left, place) or _is(value.right, place))


def _kept_apart_by_time(sides: Sides, function: Function) -> bool:
    """Whether `main` goes by what a routine sets, and never masks what it sets: it may rely on being done in time."""
    set_there = _set_with(sides, function)
    goes_by = masks = False
    for reader, body in sides.bodies.items():
        off = False
        for s in statements(body):
            test = test_of(s)
            goes_by |= test is not None and not sides.asked(reader, test).isdisjoint(set_there)
            off = switched(s, off)
            masks |= off and any(isinstance(p, LValue) and place_of(p) in set_there for p in own_nodes(s))
    return goes_by and not masks


def _routine_writes(sides: Sides) -> dict[Place, list[RoutineWrite]]:
    """The scalars that a routine writes, under conditions that `main` does not set."""
    found: dict[Place, list[RoutineWrite]] = {}
    for write in sides.routine_writes:
        place = written(write.statement)
        if place is None or place not in sides.main_writes:
            continue
        if not isinstance(write.statement.target.ctype, IntType | FloatType):
            continue
        asked = set().union(*(sides.asked(write.function, condition.test) for condition in write.conditions))
        if not (asked - {place}) & sides.main_writes.keys():
            found.setdefault(place, []).append(write)
    return found


def _from_itself(function: Function, value: Expr, place: Place) -> bool:
    """Whether a value is computed from what the object has, in more than one instruction."""
    match bare(value):
        case Binary(op=op, left=one, right=other) if op in _ONE_INSTRUCTION and (_is(one, place) or _is(other, place)):
            return False
    if _computed(value, place):
        return True
    for copy in variables(parts(value)):
        given = list(_given(function, copy)) if copy.kind == "local" and copy.plain else []
        if any(_computed(g, place) for g in given):
            return True
        taken = [g for g in given if _is(g, place)]
        changed = [g for g in given if copy in variables(parts(g))]
        if taken and len(taken) + len(changed) == len(given) and (changed or isinstance(bare(value), Binary)):
            return True
    return False


def _given(function: Function, local: Variable) -> Iterator[Expr]:
    for s in statements(function.body):
        match s:
            case Declare(variable=variable, value=Expr() as value) if variable is local:
                yield value
            case Assign(target=LValue(root=root), value=value) if root is local:
                yield value


def _computed(value: Expr, place: Place) -> bool:
    return isinstance(bare(value), Binary) and any(_is(p, place) for p in parts(value) if isinstance(p, Load))


def _is(e: Expr, place: Place) -> bool:
    inner = bare(e)
    return isinstance(inner, Load) and not inner.lvalue.indices and place_of(inner.lvalue) == place
