"""Static check of states whose only way out wants a stamp from the future: `state-stuck`.

    sample = Last;
    now = Clock_getTicks();
    switch (State) {
    case SAFE:
        if (sample.taken > now)         // for ever false
            State = HEATING;

`now` is read from a free-running counter, and `sample` does not change behind that.  If all that its member ever gets
are readings of the same counter, it was read before `now`, and is never greater.  A counter of 32 bits wraps so seldom
that this is no way out.

An uncertain case gives no finding: an object whose address is taken, a stamp that anything else sets, a state that
another statement ends, or that has another way out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from emulator.c28x.ctypes import IntType, StructType
from emulator.c28x.passes.stamps import CLOCKS, Key, key_of
from emulator.c28x.passes.states import States, exits_of, only_variable
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    Compare,
    Const,
    Expr,
    FallThrough,
    Function,
    Load,
    Logic,
    LValue,
    RegisterLoad,
    RegisterRef,
    Stmt,
    Switch,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import addressed, assigned_variables, bare, blocks, statements, within


def unreachable_exits(
    states: States, modules: Iterable[Module]
) -> Iterator[tuple[Module, Function, Compare, Variable, int, str]]:  # fmt: skip
    """States that are never left, each with its function, the test of the exit, the object, its value, and why."""
    future = _Future(states)
    for owner, f in ((module, f) for module in modules for f in module.functions):
        taken = addressed(within(f.body))
        for body in (f.body, *(block for s in statements(f.body) for block in blocks(s))):
            for n, s in enumerate(body):
                match s:
                    case Assign(target=LValue(root=Variable(kind="local") as now, indices=[], words=0), value=value):
                        clock = future.clock(value) if _bits(now) == 32 and now not in taken else None
                        if clock:
                            for test, state, label in future.behind(body[n + 1 :], now, clock, taken):
                                why = f"it was read from {_clock_name(clock)} before {now.declaration.name}"
                                yield owner, f, test, state, label, why


class _Future:
    """The comparisons of one program that want a stamp from the future."""

    def __init__(self, states: States) -> None:
        self._states = states
        self._given: dict[Key, list[Expr]] = {}
        for key, value in states.stamps.given:
            self._given.setdefault(key, []).append(bare(value))
        self._counters = set(states.stamps.counters())
        #: Structures of which a library function gets an object: its members may come from anywhere.
        self._filled = {
            root.ctype.name for f in states.functions.values() for p in within(f.body)
            if isinstance(p, Call) and p.function.extern and not p.function.name.startswith("Mailbox_")
            for argument in p.arguments if isinstance(at := bare(argument), AddressOf)
            if isinstance(root := at.lvalue.root, Variable) and isinstance(root.ctype, StructType)
        }  # fmt: skip

    def behind(
        self, body: list[Stmt], now: Variable, clock: Key, taken: set[Variable]
    ) -> Iterator[tuple[Compare, Variable, int]]:
        """The states in the statements behind a reading of the clock that are never left."""
        states = self._states
        unsafe = set(taken)
        for s in body:
            unsafe |= assigned_variables([s])
            if now in unsafe:
                return
            state = only_variable(s.subject) if isinstance(s, Switch) else None
            if not isinstance(s, Switch) or state is None or not states.is_followed(state):
                continue
            writes = states.writes.get(state, [])
            values, inside = {write.value for write in writes}, {id(x) for x in statements([s])}
            listed = {label for labels, _ in s.cases for label in labels or ()}
            for labels, block in s.cases:
                own = {v for v in values if v is not None and (v in labels if labels else v not in listed)}
                if None in values or not own or (block and isinstance(block[-1], FallThrough)):
                    continue
                ways = [tests for e, tests in exits_of(block, state) if states.constant(e.value) not in own]
                found = [self._impossible(tests, now, clock, unsafe) for tests in ways]
                last = found[-1] if found else None
                elsewhere = any(write.value not in own and id(write.statement) not in inside for write in writes)
                if last is not None and None not in found and not elsewhere:
                    yield last, state, min(own)

    def _impossible(
        self, tests: Iterable[tuple[Expr, bool]], now: Variable, clock: Key, unsafe: set[Variable]
    ) -> Compare | None:
        """The comparison that keeps tests from having their outcomes; None: they may have them."""
        for test, outcome in tests:
            match bare(test):
                case Logic(op="and", operands=operands) if outcome:
                    found = self._impossible([(e, True) for e in operands], now, clock, unsafe)
                    if found is not None:
                        return found
                    continue
                case Compare(op=">", left=stamp, right=read) | Compare(op="<", left=read, right=stamp) if outcome:
                    pass
                case Compare(op="<=", left=stamp, right=read) | Compare(op=">=", left=read, right=stamp) if not outcome:
                    pass
                case _:
                    continue
            compared, one, other = bare(test), bare(read), bare(stamp)
            if not isinstance(one, Load) or one.lvalue.root is not now or not isinstance(other, Load):
                continue
            root, key = other.lvalue.root, key_of(other.lvalue)
            plain = isinstance(root, Variable) and root.kind == "local" and root not in unsafe and root is not now
            if plain and key is not None and self._only_from(key, clock, set()) and isinstance(compared, Compare):
                return compared
        return None

    def _only_from(self, key: Key, clock: Key, seen: set[Key]) -> bool:
        """Whether all values of an object are readings of a clock, or constants with which it begins."""
        if key in seen:
            return True
        seen.add(key)
        if key[0] == "member" and key[1] in self._filled:
            return False
        given = self._given.get(key, [])
        for value in given:
            if self.clock(value) == clock or isinstance(value, Const):
                continue
            source = key_of(value.lvalue) if isinstance(value, Load) else None
            if source is None or not self._only_from(source, clock, seen):
                return False
        return any(not isinstance(value, Const) for value in given)

    def clock(self, e: Expr) -> Key | None:
        """The counter that an expression reads, and that counts up; None: it is something else."""
        match bare(e):
            case Call(function=function) if function.extern and function.name in CLOCKS:
                return (function.name,)
            case RegisterLoad(register=RegisterRef(block=block, register=name, field=None)):
                # A CPU timer counts down.
                up = name in self._states.stamps.registers and not block.startswith("CpuTimer")
                return (block, name) if up else None
            case Load(lvalue=lvalue):
                key = key_of(lvalue)
                return key if key in self._counters else None
        return None


def _clock_name(clock: Key) -> str:
    root = clock[0]
    return root.declaration.name if isinstance(root, Variable) else str(clock[-1])


def _bits(v: Variable) -> int:
    return v.ctype.bits if isinstance(v.ctype, IntType) else 0
