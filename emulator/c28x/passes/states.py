"""Static check of states that never end: `state-stuck`, `stepped-over`, `stamp-backwards`.

The check needs a whole program (one with a `main`), because it must see all statements.  A state is a case of a switch
over an object, or an `if` that compares an object with a constant.  Its exits are statements that set the object to
another value.  If all exits depend on one other object, the check follows the values of that object, pass by pass, from
every value that a statement outside of the state assigns.  If they only repeat, the state is never left.

A second check examines tests for equality, in a loop or a state, of an object that only goes up (or down) in steps:
does any step reach the tested value?

An uncertain case gives no finding: an exit that depends on anything else; an object whose address is taken, or that a
call, a pointer or a computed value may change; a state that an interrupt routine or a statement outside of the states
also ends.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from math import gcd
from typing import Any, Final

from emulator.c28x.arithmetic import COMPARE
from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.stamps import Stamps
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Break,
    CallPointer,
    Compare,
    Const,
    Convert,
    CopyStruct,
    Declare,
    Expr,
    FallThrough,
    For,
    Function,
    If,
    Jump,
    LeaveSwitch,
    Load,
    LValue,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    TURNED,
    addressed,
    bare,
    below,
    blocks,
    called,
    own_nodes,
    parts,
    roots,
    source_text,
    statements,
    within,
)  # fmt: skip

#: The largest number of values of one object that are followed.
_MOST: Final = 3000


@dataclass(frozen=True)
class _Write:
    """An assignment to an object: a known `value`, or a known `step`; None: not known."""

    function: Function
    statement: Stmt
    value: int | None
    step: int | None


@dataclass
class _Pass:
    """The possible results of one pass through a state: whether it can leave, and the values afterwards."""

    leaves: bool = False
    values: set[int] = field(default_factory=set)


class _Unclear(Exception):
    """The state does more than this check can follow."""


class States:
    """The objects of one program, and the assignments to them."""

    def __init__(self, modules: Iterable[Module], entries: frozenset[str], stamps: Stamps) -> None:
        """`stamps` are those of these modules, after a call of `suspicions`."""
        self.stamps = stamps
        self.modules = list(modules)
        self.functions = {f.path: f for module in self.modules for f in module.functions}
        self.entries = entries
        self.taken: set[Variable] = set()
        #: The objects that some assignment sets, and every setting of each.
        self.assigned: set[Variable] = set()
        self.writes: dict[Variable, list[_Write]] = {}

    def check(self, reports: dict[Module, StaticReport]) -> None:
        """Report states and waits that never end; only in a whole program."""
        if not any(f.name == "main" and f.body for f in self.functions.values()):
            return
        for f in self.functions.values():
            self.taken |= addressed(within(f.body))
            for s in statements(f.body):
                if isinstance(s, Assign) and isinstance(s.target, LValue) and isinstance(s.target.root, Variable):
                    self.assigned.add(s.target.root)
        for f in self.functions.values():
            for s in statements(f.body):
                self._read(f, s)
        for module, report in reports.items():
            for f in module.functions:
                for subject, label, body in _states(f):
                    self._state(f, subject, label, body, report)
                self._equalities(f, report)
        self._backwards(reports)

    def _read(self, f: Function, s: Stmt) -> None:
        match s:
            case Assign(target=LValue(root=Variable() as v), value=value):
                self.writes.setdefault(v, []).append(_Write(f, s, self.constant(value), _step(value, v)))
            case Declare(variable=v, value=Expr() as value):
                self.writes.setdefault(v, []).append(_Write(f, s, self.constant(value), None))
            case For(variable=LValue(root=Variable() as v)):
                self.writes.setdefault(v, []).append(_Write(f, s, None, None))
            case CopyStruct(target=LValue(root=Variable() as v)):
                self.writes.setdefault(v, []).append(_Write(f, s, None, None))

    def constant(self, e: Expr) -> int | None:
        """The value of a constant, or of an object that nothing ever writes; None for other expressions."""
        match bare(e):
            case Const(value=int(value)):
                return value
            case Load(lvalue=LValue(root=Variable(kind="global") as v, indices=[], words=0)) if self.is_followed(v):
                if v not in self.assigned and v.initial:
                    start = bare(v.initial[0])
                    return start.value if isinstance(start, Const) and isinstance(start.value, int) else None
        return None

    def is_followed(self, v: Variable) -> bool:
        """Whether all values of an object are those that statements assign to it."""
        return isinstance(v.ctype, IntType) and v not in self.taken and not v.escapes

    def _start(self, v: Variable) -> int:
        start = bare(v.initial[0]) if v.initial else None
        return start.value if isinstance(start, Const) and isinstance(start.value, int) else 0

    # States

    def _state(
        self, f: Function, subject: Variable, label: int, body: list[Stmt], report: StaticReport
    ) -> None:  # fmt: skip
        if not self.is_followed(subject):
            return
        exits = list(exits_of(body, subject))
        exits = [(e, tests) for e, tests in exits if self.constant(e.value) != label]
        if not exits or any(not tests for _, tests in exits):
            return
        last = exits[-1][1][-1][0]
        x = self._only(exits)
        if x is None or x is subject or not self.is_followed(x) or x.kind != "global":
            return
        why = self._round(subject, label, x, body)
        if why and not self._ended_elsewhere(subject, label):
            inside = [w.statement for w in self.writes[x] if _holds(body, w.statement)]
            wanted = source_text(last) if exits[-1][1][-1][1] else f"the contrary of {source_text(last)}"
            report.report(
                f, inside[0].where, "state-stuck",
                f"{f.path} never leaves {subject.declaration.name} = {label} by itself: {wanted} never becomes true, "
                f"{why}",
                object=subject.declaration.path, declaration=subject.declaration,
            )  # fmt: skip

    def _ended_elsewhere(self, subject: Variable, label: int) -> bool:
        """Whether a repeated statement outside of all states of the object also ends this state."""
        in_states: set[int] = set()
        again: set[int] = set()
        #: State -> the states that its own statements lead to.
        leads: dict[int, set[int | None]] = {}
        repeated = [path for path, f in self.functions.items() if f.interrupt or path in self.entries]
        for f in self.functions.values():
            for s in statements(f.body):
                match s:
                    case Switch(subject=chosen, cases=cases) if only_variable(chosen) is subject:
                        for labels, body in cases:
                            inside = {id(inner) for inner in statements(body)}
                            in_states |= inside
                            to = {w.value for w in self.writes.get(subject, []) if id(w.statement) in inside}
                            leads |= dict.fromkeys(labels or (), to)
                    case While(body=body) | For(body=body):
                        again |= {id(inner) for inner in statements(body)}
                        repeated += called(within(body))
            for state, _, body in _states(f):
                if state is subject:
                    in_states |= {id(inner) for inner in statements(body)}
        repeating = set(below(repeated, self.functions))
        return any(
            w.value != label and id(w.statement) not in in_states
            and not (w.value is not None and leads.get(w.value) == {label})  # that state leads straight back
            and (w.function in repeating or id(w.statement) in again)
            for w in self.writes.get(subject, [])
        )  # fmt: skip

    @staticmethod
    def _only(exits: list[tuple[Assign, tuple[tuple[Expr, bool], ...]]]) -> Variable | None:
        """The only object on which all exits depend, compared with constants; None: there is no such object."""
        seen: set[Variable] = set()
        for _, tests in exits:
            for test, _ in tests:
                for p in parts(test):
                    if isinstance(p, LValue):
                        if not isinstance(p.root, Variable) or p.indices:
                            return None
                        seen.add(p.root)
                    elif isinstance(p, Expr) and not isinstance(p, Compare | Convert | Const | Load):
                        return None
        return seen.pop() if len(seen) == 1 else None

    def _round(self, subject: Variable, label: int, x: Variable, body: list[Stmt]) -> str:
        """Why the values of `x` never lead out of a state, as text; empty: they may lead out."""
        inside = {id(s) for s in statements(body)}
        own = [w for w in self.writes.get(x, []) if id(w.statement) in inside]
        others = [w for w in self.writes.get(x, []) if id(w.statement) not in inside]
        if not own or any(w.value is None for w in others):
            return ""
        starts = {w.value for w in others if w.value is not None}
        if not starts or not self._set_on_entry(subject, label, x):
            starts.add(self._start(x))
        known: set[int] = set()
        waiting = list(starts)
        while waiting:
            value = waiting.pop()
            if value in known:
                continue
            known.add(value)
            if len(known) > _MOST:
                return ""
            try:
                came = self._walk(body, subject, label, x, {value})
            except _Unclear:
                return ""
            if came.leaves:
                return ""
            waiting += came.values
        told = ", ".join(map(str, sorted(known)[:4])) + (" ..." if len(known) > 4 else "")
        return f"because {x.declaration.name} is only {told} there"

    def _set_on_entry(self, subject: Variable, label: int, x: Variable) -> bool:
        """Whether `x` is set wherever the state is entered."""
        entered = [w for w in self.writes.get(subject, []) if w.value == label]
        for w in entered:
            blocks_of = [body for body in _bodies(w.function.body) if any(s is w.statement for s in body)]
            if not any(
                isinstance(s, Assign) and isinstance(s.target, LValue) and s.target.root is x
                for body in blocks_of for s in body
            ):  # fmt: skip
                return False
        return bool(entered) and self._start(subject) != label

    def _walk(self, body: list[Stmt], subject: Variable, label: int, x: Variable, values: set[int]) -> _Pass:
        """One pass through the state with each of these values.  Raises _Unclear."""
        came = _Pass(values=set(values))
        for s in body:
            match s:
                case Assign(target=LValue(root=Variable() as v), value=value) if v is subject:
                    if self.constant(value) != label:
                        came.leaves = True
                        return came
                case Assign(target=LValue(root=Variable() as v), value=value) if v is x:
                    constant, step = self.constant(value), _step(value, x)
                    if constant is not None:
                        came.values = {constant}
                    elif step is not None:
                        assert isinstance(x.ctype, IntType)
                        came.values = {_within(value + step, x.ctype) for value in came.values}
                    else:
                        raise _Unclear
                case If(test=test, then=then, otherwise=otherwise):
                    self._calls(test, x, subject)
                    merged = _Pass()
                    decided = _decided(test, x, self.constant)
                    for holds, branch in ((True, then), (False, otherwise)):
                        here = {v for v in came.values if decided is None or decided(v) == holds}
                        if here:
                            inner = self._walk(branch, subject, label, x, here)
                            merged.leaves |= inner.leaves
                            merged.values |= inner.values
                    if merged.leaves:
                        return merged
                    came = merged
                case Return() | Break() | LeaveSwitch():
                    raise _Unclear
                case _:
                    for inner_s in statements([s]):
                        target = inner_s.target if isinstance(inner_s, Assign) else None
                        if isinstance(target, LValue) and target.root in (x, subject):
                            raise _Unclear
                        for root in roots(inner_s):
                            self._calls(root, x, subject)
        return came

    def _calls(self, e: Any, *objects: Variable) -> None:
        """Raises _Unclear if a function that an expression calls may write one of the objects."""
        if any(isinstance(p, CallPointer) for p in parts(e)):
            raise _Unclear
        inside = below(called(parts(e)), self.functions)
        if any(w.function in inside for v in objects for w in self.writes.get(v, [])):
            raise _Unclear

    # Equality

    def _equalities(self, f: Function, report: StaticReport) -> None:
        """Report tests for equality that would end something, but are stepped over."""
        for s in statements(f.body):
            match s:
                case If(test=test, then=then, otherwise=otherwise):
                    for compare, v, goal, ends in self._tests(test):
                        met, away = (then, otherwise) if ends else (otherwise, then)
                        if met and self._stepped(v, away):
                            self._step_past(f, s, compare, v, goal, met, report)
                case While(test=test, body=body, step=step):
                    for compare, v, goal, ends in self._tests(test):
                        if not ends and self._stepped(v, [*body, *step]):
                            self._step_past(f, s, compare, v, goal, [], report)
                    if any(isinstance(p, Compare) and p.op not in ("==", "!=") for p in parts(test)):
                        continue
                    for inner in body:
                        if isinstance(inner, If) and any(isinstance(e, Return | Break | Jump) for e in inner.then):
                            for compare, v, goal, ends in self._tests(inner.test):
                                if ends and self._stepped(v, body):
                                    self._step_past(f, inner, compare, v, goal, inner.then, report)

    def _stepped(self, v: Variable, body: list[Stmt]) -> bool:
        return any(w.step and _holds(body, w.statement) for w in self.writes.get(v, []))

    def _tests(self, test: Expr) -> Iterator[tuple[Compare, Variable, int, bool]]:
        """A test that is only a comparison for equality: the comparison, the object, the value, whether it is `==`."""
        match test:
            case Compare(op="==" | "!=" as op, left=left, right=right):
                for side, other in ((left, right), (right, left)):
                    goal, load = self.constant(other), bare(side)
                    if goal is not None and isinstance(load, Load) and self.constant(side) is None:
                        way, v = load.lvalue, load.lvalue.root
                        if isinstance(v, Variable) and not way.indices and not way.words and self.is_followed(v):
                            yield test, v, goal, op == "=="

    def _step_past(
        self, f: Function, s: Stmt, compare: Compare, v: Variable, goal: int, met: list[Stmt], report: StaticReport
    ) -> None:  # fmt: skip
        """Report a test that the steps of `v` never meet; `met`: the statements that run if they do."""
        assert isinstance(v.ctype, IntType)
        if v.kind == "parameter" or v.ctype.bits < 16:
            return
        writes = [w for w in self.writes.get(v, []) if not _holds(met, w.statement)]
        steps = {w.step for w in writes if w.step}
        starts = {w.value for w in writes if w.value is not None}
        if any(w.value is None and not w.step for w in writes) or not steps:
            return
        if v.kind == "global":
            starts.add(self._start(v))
        step = gcd(*(each for each in steps if each is not None))
        one_way = len(steps) == 1
        if one_way and min(each for each in steps if each is not None) < 0:
            step = -step
        if any((goal - start) % step == 0 and ((goal - start) * step >= 0 or not one_way) for start in starts):
            return
        bounds = (
            p for g in self.functions.values() for s in statements(g.body) for p in own_nodes(s)
            if isinstance(p, Compare) and p.op not in ("==", "!=")
            and any(isinstance(q, Load) and q.lvalue.root is v for q in parts(p))
        )  # fmt: skip
        if v.kind == "local" and any(True for _ in bounds):
            return
        begun = " or ".join(map(str, sorted(starts)))
        way = "up" if one_way and step > 0 else "down" if one_way else "up and down"
        message = (
            f"{v.declaration.name} begins at {begun} and goes {way} by {abs(step)}: it steps "
            f"past {goal}, so {source_text(compare)} never becomes true"
        )  # fmt: skip
        report.report(f, s.where, "stepped-over", message, object=v.declaration.path, declaration=v.declaration)

    # Stamps

    def _backwards(self, reports: dict[Module, StaticReport]) -> None:
        """Report an unsigned difference "earlier stamp minus counter" that is compared by order."""
        counters = set(self.stamps.counters())
        if not counters:
            return
        for module, report in reports.items():
            for f in module.functions:
                for s in statements(f.body):
                    for p in own_nodes(s):
                        match p:
                            case Compare(op="<" | "<=" | ">" | ">=", left=left, right=right):
                                for side, other in ((left, right), (right, left)):
                                    if self.constant(other) not in (None, 0):
                                        self._backward(f, s, side, counters, report)

    def _backward(self, f: Function, s: Stmt, side: Expr, counters: set[Any], report: StaticReport) -> None:
        difference = side
        while isinstance(difference, Convert):
            if not isinstance(difference.ctype, IntType) or difference.ctype.signed:
                return
            difference = difference.operand
        match difference:
            case Binary(op="-", left=old, right=now):
                before, counter = only_variable(old), only_variable(now)
                if before is None or counter is None or (counter, 0) not in counters or (before, 0) in counters:
                    return
                given = [value for key, value in self.stamps.given if key == (before, 0)]
                if given and all(self._past(value, counter) for value in given):
                    message = (
                        f"{source_text(difference)} takes the counter {counter.declaration.name} from the earlier "
                        f"stamp {before.declaration.name}: the difference wraps below 0 and is huge at any age but 0"
                    )  # fmt: skip
                    report.report(f, s.where, "stamp-backwards", message, object=before.declaration.path)

    def _past(self, value: Expr, counter: Variable) -> bool:
        """Whether a value is the counter, the counter minus a constant, or a constant."""
        inner = bare(value)
        if isinstance(inner, Binary) and inner.op == "-" and self.constant(inner.right) is not None:
            inner = bare(inner.left)
        return isinstance(inner, Const) or only_variable(inner) is counter


def only_variable(e: Expr) -> Variable | None:
    """The object at file scope that an expression is the value of; None: it is something else."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable(kind="global") as v, indices=[], words=0)):
            return v
    return None


def _states(f: Function) -> Iterator[tuple[Variable, int, list[Stmt]]]:
    """The states of a function: object, value, statements."""
    for s in statements(f.body):
        match s:
            case Switch(subject=subject, cases=cases):
                v = only_variable(subject)
                for labels, body in cases if v is not None else ():
                    if labels is not None and len(labels) == 1 and not (body and isinstance(body[-1], FallThrough)):
                        assert v is not None
                        yield v, labels[0], body
            case If(test=Compare(op="==", left=left, right=right), then=then):
                v, value = only_variable(left), bare(right)
                if v is not None and isinstance(value, Const) and isinstance(value.value, int):
                    yield v, value.value, then


def exits_of(
    body: list[Stmt], subject: Variable, tests: tuple[tuple[Expr, bool], ...] = ()
) -> Iterator[tuple[Assign, tuple[tuple[Expr, bool], ...]]]:  # fmt: skip
    """The assignments to the object of a state, each with the tests around it and their outcomes."""
    for s in body:
        match s:
            case Assign(target=LValue(root=Variable() as v)) if v is subject:
                yield s, tests
            case If(test=test, then=then, otherwise=otherwise):
                yield from exits_of(then, subject, (*tests, (test, True)))
                yield from exits_of(otherwise, subject, (*tests, (test, False)))
            case _:
                for block in blocks(s):
                    yield from exits_of(block, subject, tests)


def _bodies(body: list[Stmt]) -> Iterator[list[Stmt]]:
    yield body
    for s in statements(body):
        yield from blocks(s)


def _holds(body: list[Stmt], wanted: Stmt) -> bool:
    return any(s is wanted for s in statements(body))


def _step(value: Expr, v: Variable) -> int | None:
    """The constant that an assigned value adds to its object; None: it is not a step."""
    match bare(value):
        case Binary(op="+" | "-" as op, left=left, right=right):
            stepped, by = bare(left), bare(right)
            known = isinstance(by, Const) and isinstance(by.value, int)
            if known and isinstance(stepped, Load) and stepped.lvalue.root is v:
                assert isinstance(by, Const)
                return int(by.value) if op == "+" else -int(by.value)
    return None


def _within(value: int, ctype: IntType) -> int:
    """A value wrapped to its type."""
    span = ctype.high - ctype.low + 1
    return (value - ctype.low) % span + ctype.low


def _decided(test: Expr, x: Variable, constant: Callable[[Expr], int | None]) -> Callable[[int], bool] | None:
    """A test as a function of the value of one object; None: it tests something else."""
    match test:
        case Compare(op=op, left=left, right=right):
            for side, other, named in ((left, right, op), (right, left, TURNED[op])):
                goal = constant(other)
                if only_variable(side) is x and goal is not None:
                    return lambda value: COMPARE[named](value, goal)
    return None
