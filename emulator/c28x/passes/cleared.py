"""Static check of objects that `main` clears a while after it has read them: `cleared-late`.

    if (Order)
    {
        Obey(Order);
        Order = 0;
    }

What an interrupt routine writes while `Obey` works is lost: `main` has read the old value, and clears the new one.

Two kinds of objects are meant.  An order is a value from outside that the routine stores: it is lost if `main` waits
between the read and the clear.  A count or a sum goes on in the routine: it is wrong if `main` uses its value, and
works in a loop before it clears it.

Not meant: a routine that asks whether the object, or something else that `main` writes, lets it write (a handshake); a
flag, which the routine sets to constants only; an object to which `main` gives other values, too; the index of a buffer
(see `released.py`); a count that is only held against a limit, which is a clock; and what masks hold off.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.interrupted import (
    Place,
    RoutineWrite,
    Sides,
    mentions,
    place_of,
    reads,
    scalar_of,
    switched,
    test_of,
    written,
)
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Const,
    Declare,
    Expr,
    For,
    Function,
    If,
    LeaveSwitch,
    Load,
    Logic,
    LValue,
    Not,
    RegisterLoad,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, blocks, children, leaves, own_nodes, parts, roots, source_text, statements

#: Functions that wait, and functions whose work is as long as that of a loop.
_WAITS: Final = re.compile(r"delay|sleep|wait", re.IGNORECASE)
_LONG: Final = re.compile(r"printf")
#: So many calls deep, the text is followed.
_DEPTH: Final = 6


def check_cleared(sides: Sides) -> None:
    """Report the statements that clear an object which `main` has read before it worked."""
    work = _LongWork(sides)
    for place, writes in _written_by_routines(sides).items():
        kind = _kind(sides, place, writes)
        if kind is None:
            continue
        told: set[int] = set()
        for function, body in sides.bodies.items():
            walk = _ClearWalk(sides, work, place, kind)
            walk.block(function, body, _Since(None, False, sides.mask_of_caller(function)), 0)
            for where, s, read in walk.found:
                if id(s) not in told and isinstance(s.target, LValue):
                    told.add(id(s))
                    name = source_text(Load(s.target.ctype, s.target))
                    message = (
                        f"{name} is cleared after the work on what line {read.line} has read: what "
                        f"{writes[0].function.name} writes meanwhile is lost"
                    )
                    sides.owners[where].report(where, s.where, "cleared-late", message, object=name)


def _written_by_routines(sides: Sides) -> dict[Place, list[RoutineWrite]]:
    """The scalars that routines write and that the rest of the program only clears."""
    found: dict[Place, list[RoutineWrite]] = {}
    for w in sides.routine_writes:
        place = written(w.statement)
        if place is not None:
            found.setdefault(place, []).append(w)
    return {
        place: writes for place, writes in found.items()
        if place in sides.main_writes
        and len({_constant(s) for s in sides.main_writes[place]}) == 1
        and None not in {_constant(s) for s in sides.main_writes[place]}
    }  # fmt: skip


def _constant(s: Assign) -> float | None:
    value = bare(s.value)
    return value.value if isinstance(value, Const) else None


def _kind(sides: Sides, place: Place, writes: list[RoutineWrite]) -> str | None:
    """`sum` of what goes on in the routine, or `order` for what it stores; None: not meant."""
    if all(_constant(w.statement) is not None for w in writes):
        return None
    for w in writes:
        for c in w.conditions:
            if mentions(c.test, place) and _handshake(c.test, place):
                return None
            if any(other != place and other in sides.main_writes for other in sides.asked(w.function, c.test)):
                return None
    for routine in sides.routines:
        if any(w.function in routine for w in writes):
            if any(switched(s, False) for f in routine for s in statements(f.body)):
                return None
            if any(_subscript(sides, f, place) for f in routine):
                return None
    goes_on = [w for w in writes if isinstance(bare(w.statement.value), Binary) and _of_itself(w, place)]
    return "sum" if goes_on else "order"


def _subscript(sides: Sides, function: Function, place: Place) -> bool:
    """Whether an object says which element of an array a function uses."""
    return any(
        place in sides.asked(function, index.expr)
        for s in statements(function.body) for p in own_nodes(s) if isinstance(p, LValue) for index in p.indices
    )  # fmt: skip


def _of_itself(w: RoutineWrite, place: Place) -> bool:
    """Whether a statement makes the new value of an object from the old one (`n++` has it in a temporary)."""
    target = w.statement.target
    root = target.root if isinstance(target, LValue) else None
    for p in parts(w.statement.value):
        old = p.root if isinstance(p, LValue) else None
        if isinstance(old, Variable) and old.kind == "temporary" and isinstance(root, Variable):
            return old.declaration == root.declaration
    return mentions(w.statement.value, place)


def _handshake(test: Expr, place: Place) -> bool:
    """Whether a test asks for one value of an object: whether it is free."""
    match bare(test):
        case Not(operand=operand):
            return _handshake(operand, place)
        case Compare(op="==" | "!="):
            return True
        case Compare(left=left, right=right):
            return any(constant_of(side) == 0 for side in (left, right))
        case Logic(operands=operands):
            return any(mentions(o, place) and _handshake(o, place) for o in operands)
        case Load():
            return True
    return False


class _LongWork:
    """Which functions and statements take long."""

    def __init__(self, sides: Sides) -> None:
        self._sides = sides
        self._known: dict[tuple[str, str], bool] = {}
        #: What the routines change: a loop that asks for it waits.
        self._changing = {written(w.statement) for w in sides.routine_writes} - {None}

    def calls(self, s: Stmt, kind: str) -> bool:
        """Whether a statement itself calls a function that takes long."""
        return any(self._function(p.function, kind) for p in own_nodes(s) if isinstance(p, Call))

    def loop(self, s: Stmt, kind: str) -> bool:
        """Whether a statement is a loop that takes long: for an order, one that waits."""
        if not isinstance(s, While | For):
            return False
        if kind == "sum":
            return True
        inner = list(statements([s]))
        called = [t for u in inner for f in self._sides.below(u) for t in statements(f.body)]
        if any(_is_hardware(p) for t in (*inner, *called) for p in own_nodes(t)):
            return True
        tested = {place_of(p) for p in own_nodes(s) if isinstance(p, LValue)}
        return not self._changing.isdisjoint(tested.union(*(self._sides.named(f) for f in self._sides.below(s))))

    def _function(self, function: Function, kind: str) -> bool:
        key = (function.path, kind)
        if key not in self._known:
            self._known[key] = False
            own = self._sides.own.get(function.path)
            named = _WAITS.search(function.name) or (kind == "sum" and _LONG.search(function.name))
            self._known[key] = bool(named) or (
                own is not None and any(self.loop(s, kind) or self.calls(s, kind) for s in statements(own.body))
            )
        return self._known[key]


class _Since(NamedTuple):
    """At a place of the text: the latest read of the object, whether work followed it, whether interrupts are off."""

    read: Stmt | None
    worked: bool
    off: bool


@dataclass
class _ClearWalk:
    """Follows the text from a read of an object over work to its clear."""

    sides: Sides = field(repr=False)
    work: _LongWork = field(repr=False)
    place: Place
    kind: str
    #: The clears that come too late, each with its function and the read.
    found: list[tuple[Function, Assign, Stmt]] = field(default_factory=list)

    def block(self, function: Function, body: list[Stmt], state: _Since, depth: int) -> _Since:
        """The state behind a block."""
        for s in body:
            state = self._statement(function, s, state, depth)
        return state

    def _statement(self, function: Function, s: Stmt, state: _Since, depth: int) -> _Since:
        if isinstance(s, Assign) and written(s) == self.place:
            if state.read is not None and state.worked and not reads(s, self.place):
                self.found.append((function, s, state.read))
            return _Since(None, False, state.off)
        own = self._reads(function, s)
        works = self.work.calls(s, self.kind)
        if own:
            state = _Since(s, works and self._handed(s) and not state.off, state.off)
        for callee in self._callees(s) if depth < _DEPTH else ():
            state = self.block(callee, callee.body, state, depth + 1)
        if works and not own and not state.off:
            state = state._replace(worked=state.read is not None)
        state = state._replace(off=switched(s, state.off))
        inner = blocks(s)
        if not inner:
            return state
        ends = [self.block(function, block, state, depth) for block in inner]
        if isinstance(s, If | Switch):
            through = [end for end, block in zip(ends, inner, strict=True) if not _left(block)]
            if isinstance(s, Switch):
                through.append(state)
            return max(through, key=lambda end: (end.worked, end.read is not None), default=state)
        end = ends[0]
        if end.read is not None and not end.off and self.work.loop(s, self.kind) and not own:
            end = end._replace(worked=True)
        return end._replace(read=s, worked=False) if own else end

    def _callees(self, s: Stmt) -> list[Function]:
        """The own functions that a statement itself calls and that have to do with the object."""
        called = [self.sides.own.get(p.function.path) for p in own_nodes(s) if isinstance(p, Call)]
        return [f for f in called if f is not None and self.place in self.sides.named(f)]

    def _reads(self, function: Function, s: Stmt) -> bool:
        """Whether a statement itself reads the object as it counts: of a sum, only its value, not a test of it."""
        if not reads(s, self.place):
            return False
        if self.kind == "order":
            return True
        target = s.target if isinstance(s, Assign) else None
        if not any(_value_in(root, self.place) for root in roots(s) if root is not target):
            return False
        copy = s.variable if isinstance(s, Declare) else target.root if isinstance(target, LValue) else None
        value = s.value if isinstance(s, Assign | Declare) else None
        if isinstance(copy, Variable) and copy.kind == "local" and isinstance(value, Expr):
            return scalar_of(value) != self.place or _used_as_value(function, copy)
        return test_of(s) is None or self.work.calls(s, self.kind)

    def _handed(self, s: Stmt) -> bool:
        """Whether a statement hands the object to a function that takes long: it is read before that works."""
        return any(
            mentions(argument, self.place)
            for p in own_nodes(s) if isinstance(p, Call) for argument in p.arguments + p.extra
        )  # fmt: skip


def _is_hardware(p: Any) -> bool:
    """Whether a node reads a register, by its name or by a number as in driverlib."""
    if isinstance(p, LValue) and isinstance(p.root, Expr):
        return isinstance(bare(p.root).ctype, IntType)
    return isinstance(p, RegisterLoad)


def _left(block: list[Stmt]) -> bool:
    """Whether control leaves a block for another place than what follows it."""
    return leaves(block) and not isinstance(block[-1], LeaveSwitch)


def _value_in(e: Any, place: Place) -> bool:
    """Whether an expression uses the value of an object, other than to compare it."""
    if isinstance(e, Compare | Not | Logic):
        return any(_value_in(p, place) for p in children(e) if not isinstance(bare(p), Load))
    if isinstance(e, LValue) and not e.indices:
        return place_of(e) == place
    return any(_value_in(p, place) for p in children(e))


def _used_as_value(function: Function, copy: Variable) -> bool:
    """Whether a function does more with a local than to compare it."""
    return any(_local_in(root, copy) for s in statements(function.body) for root in roots(s))


def _local_in(e: Any, copy: Variable) -> bool:
    if isinstance(e, Compare | Not | Logic):
        return any(_local_in(p, copy) for p in children(e) if not isinstance(bare(p), Load))
    if isinstance(e, Load) and not e.lvalue.indices and e.lvalue.root is copy:
        return True
    return any(_local_in(p, copy) for p in children(e))
