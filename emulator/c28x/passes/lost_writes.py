"""Static check of indices that `main` and an interrupt routine both write, without a mask: `race`.

    Out = (Out + 1) % SIZE;             // in main, where the routine does the same if the ring is full

If the routine comes between the read and the write, what it wrote is lost.  The check needs a whole program without a
kernel.  `Out += 1` and `Flags &= ~1` are one instruction, and the routine comes before or behind it.

Only of subscripts: other objects may have a routine that writes them once, before `main` does.  Silent if the routine
writes only under a condition that `main` sets: it may not come then.
"""

from __future__ import annotations

from collections.abc import Iterator

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.interrupted import Place, RoutineWrite, Sides, mentions, off_at, place_of, written
from emulator.c28x.tree import Assign, Binary, Declare, Expr, Function, Index, Load, LValue, Stmt, Variable
from emulator.c28x.tree_queries import bare, own_nodes, parts, source_text, statements

#: Operators that change a word in memory by one instruction (CPU, `ADD loc16`, `AND loc16`, `ADDL loc32`).
_ONE_INSTRUCTION = ("+", "-", "&", "|", "^")


def check_lost_writes(sides: Sides) -> None:
    """Report what `main` computes from its old value and a routine writes, too."""
    for place, write in _routine_writes(sides).items():
        for function, body in sides.bodies.items():
            for s in statements(body):
                if not isinstance(s, Assign) or written(s) != place or not _from_itself(function, s.value, place):
                    continue
                if not _is_index(body, place) or off_at(body, {id(s)}) or sides.mask_of_caller(function):
                    continue
                assert isinstance(s.target, LValue)
                name = source_text(Load(s.target.ctype, s.target))
                lost = f"what {write.function.name} writes in between (line {write.statement.line}) is lost"
                message = f"{name} is computed from its old value, and the interrupt is not masked: {lost}"
                sides.owners[function].report(function, s.where, "race", message, object=name)


def _is_index(body: list[Stmt], place: Place) -> bool:
    """Whether an object is a subscript in some statements."""
    nodes = [p for s in statements(body) for p in own_nodes(s)]
    return any(isinstance(p, Index) and mentions(p.expr, place) for p in nodes)


def _routine_writes(sides: Sides) -> dict[Place, RoutineWrite]:
    """The integers that a routine writes, under conditions that `main` does not set."""
    found: dict[Place, RoutineWrite] = {}
    for write in sides.routine_writes:
        place = written(write.statement)
        if place is None or place not in sides.main_writes or not isinstance(write.statement.target.ctype, IntType):
            continue
        asked = set().union(*(sides.asked(write.function, condition.test) for condition in write.conditions))
        if not (asked - {place}) & sides.main_writes.keys():
            found.setdefault(place, write)
    return found


def _from_itself(function: Function, value: Expr, place: Place) -> bool:
    """Whether a value is computed from what the object has, in more than one instruction."""
    match bare(value):
        case Load(lvalue=LValue(root=Variable(kind="local") as copy, indices=[])) if copy.plain:
            return any(_computed(given, place) for given in _given(function, copy))
        case Binary(op=op, left=left, right=right) if op in _ONE_INSTRUCTION:
            sides = [_is(left, place), _is(right, place)]
            return not any(sides) and _computed(value, place)
    return _computed(value, place)


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
