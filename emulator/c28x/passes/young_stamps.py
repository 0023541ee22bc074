"""Static check of ages of stamps that an interrupt routine sets: `stamp-compare`.

    now = Millis;
    if (now - Heard_ms > TIMEOUT_MS)        // a routine sets Heard_ms = Millis in between: -1 is 4294967295

The clock is read first, and then the stamp.  If the routine comes in between, and the clock has gone on, then the stamp
is later than `now`: the age wraps, and is greater than every limit.  It is told if the same clock gives both, if the
age has no sign and a test asks for a greater one, and if nothing keeps the routine off, here or in a caller.  In one
expression a call, or a register, is read before the stamp.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.interrupted import off_at
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.stamps import CLOCKS, Key, Stamps, key_of
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Declare,
    Expr,
    Function,
    FunctionRef,
    If,
    Load,
    LValue,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    TURNED,
    assigned,
    bare,
    below,
    own_nodes,
    parts,
    source_text,
    statements,
    variables,
    within,
)

#: Functions that make a function a routine, which interrupts tasks.
_MAKES: Final = ("Hwi_create", "Hwi_construct", "Swi_create", "Swi_construct")


def check_young_stamps(modules: Iterable[Module], reports: Mapping[Module, StaticReport], stamps: Stamps) -> None:
    """Report ages that a routine can make negative."""
    owners = {function: reports[module] for module in modules for function in module.functions}
    own = {function.path: function for function in owners}
    made = {
        q.function.path for function in owners for p in within(function.body)
        if isinstance(p, Call) and p.function.name in _MAKES
        for argument in p.arguments for q in parts(argument) if isinstance(q, FunctionRef)
    }  # fmt: skip
    inside = {f.path for f in below([*made, *(f.path for f in owners if f.interrupt)], own)}
    others = [f for f in owners if f.path not in inside]
    decided = {v for f in others for s in statements(f.body) if (v := assigned(s)) is not None and v.kind == "global"}
    clocks = _Clocks(own, stamps)
    set_ = clocks.stamps([own[path] for path in sorted(inside)], decided)
    for function in others if set_ else ():
        if any(off_at(f.body, _calls_of(f, function)) for f in others if function.path in f.calls):
            continue
        for s, age, stamp in _ages(function, set_, clocks):
            if not off_at(function.body, {id(s)}):
                text, name = source_text(age), source_text(stamp)
                owners[function].report(
                    function, s.where, "stamp-compare",
                    f"{text}: an interrupt routine that sets {name} between the two reads makes it later than the "
                    "clock that was read before: the age wraps, and is greater than any limit", object=name,
                )  # fmt: skip


def _calls_of(caller: Function, function: Function) -> set[int]:
    """The identities of the statements that call a function."""
    called = ((s, p) for s in statements(caller.body) for p in own_nodes(s) if isinstance(p, Call))
    return {id(s) for s, p in called if p.function.path == function.path}


class _Clocks:
    """The clocks of a program, and what a routine sets to their count."""

    def __init__(self, own: Mapping[str, Function], stamps: Stamps) -> None:
        self._own = own
        self._counters = set(stamps.counters())

    def of(self, e: Expr, function: Function, deep: int = 3) -> Key | None:
        """The clock that an expression of a function reads; None: it is something else."""
        match bare(e):
            case Call(function=called) if called.extern:
                return (called.name,) if called.name in CLOCKS else None
            case Call(function=called) if deep and called.path in self._own:
                returned = [s.value for s in statements(called.body) if isinstance(s, Return)]
                found = {self.of(value, called, deep - 1) if isinstance(value, Expr) else None for value in returned}
                return found.pop() if len(found) == 1 else None
            case RegisterLoad(register=RegisterRef(block=block, register="TSCTR", field=None)):
                return (block, "TSCTR")
            case Load(lvalue=LValue(root=Variable(kind="local") as copy, indices=[])) if deep:
                found = {self.of(value, function, deep - 1) for _, value in _given(function, copy)}
                return found.pop() if len(found) == 1 else None
            case Load(lvalue=lvalue):
                key = key_of(lvalue)
                return key if key in self._counters else None
        return None

    def stamps(self, routines: Iterable[Function], decided: set[Variable]) -> dict[Key, Key]:
        """What routines set to a clock, and to nothing else, whatever `main` has `decided`: each with its clock."""
        found: dict[Key, set[Key | None]] = {}
        for function in routines:
            kept_off = {
                id(inner) for s in statements(function.body)
                if isinstance(s, If) and not decided.isdisjoint(variables(parts(s.test)))
                for block in (s.then, s.otherwise) for inner in statements(block)
            }  # fmt: skip
            for s in statements(function.body):
                key = key_of(s.target) if isinstance(s, Assign) and isinstance(s.target, LValue) else None
                if key is not None and isinstance(s, Assign) and key not in self._counters:
                    clock = None if id(s) in kept_off else self.of(s.value, function)
                    found.setdefault(key, set()).add(clock)
        return {
            key: clock for key, clocks in found.items() if len(clocks) == 1 for clock in clocks if clock is not None
        }  # fmt: skip


def _given(function: Function, local: Variable) -> list[tuple[Stmt, Expr]]:
    """The statements that give a local of a function a value, with the values."""
    return [
        (s, s.value) for s in statements(function.body)
        if isinstance(s, Assign | Declare) and assigned(s) is local and isinstance(s.value, Expr)
    ]  # fmt: skip


def _ages(
    function: Function, stamps: Mapping[Key, Key], clocks: _Clocks
) -> Iterator[tuple[Stmt, Binary, Load]]:  # fmt: skip
    """The ages without a sign that a test of a function takes for short or long, with their stamps."""
    body = statements(function.body)
    compares = [p for p in within(function.body) if isinstance(p, Compare) and p.op not in ("==", "!=")]
    sides = [
        (bare(a), op, b) for p in compares
        for a, op, b in ((p.left, p.op, p.right), (p.right, TURNED[p.op], p.left))
        if isinstance(a.ctype, IntType) and not a.ctype.signed
    ]  # fmt: skip
    asked = {key_of(side.lvalue) for side, _, _ in sides if isinstance(side, Load)}
    for n, s in enumerate(body):
        for p in own_nodes(s):
            match p:
                case Binary(op="-", ctype=IntType(signed=False), left=left, right=right) if isinstance(
                    stamp := bare(right), Load
                ):
                    key = key_of(stamp.lvalue)
                case _:
                    continue
            if key is None or key not in stamps or key in asked or clocks.of(left, function) != stamps[key]:
                continue
            now = bare(left)
            if isinstance(now, Load):
                root = now.lvalue.root
                if not isinstance(root, Variable) or root.kind != "local":
                    continue  # two objects in one expression: C does not say which is read first
                if not all(any(at is before for before in body[:n]) for at, _ in _given(function, root)):
                    continue
            age = assigned(s)
            whole = isinstance(s, Assign | Declare) and isinstance(s.value, Expr) and bare(s.value) is p
            by_copy = (
                age is not None and whole and age.kind == "local" and len(_given(function, age)) == 1
                and age.ctype == p.ctype
            )  # fmt: skip
            ways = {
                op[0] for side, op, other in sides if constant_of(other) != 0
                and (side is p or (by_copy and isinstance(side, Load) and side.lvalue.root is age))
            }  # fmt: skip
            if len(ways) == 1:  # between two limits, it has not wrapped
                yield s, p, stamp
