"""Pass `idle_turns`: the turns of a loop that change nothing, so that the next one does the same.

A turn is idle if it only reads named objects and registers, compares them, and sets locals that it does not read
before.  It may count through a table, switch interrupts off and on, and call functions that do no more (`idle_calls`).
As long as no event comes and no interrupt is taken, each turn after an idle one is idle too, and takes the same
cycles.  So time can skip whole turns (`Runtime.turn`), up to the next event.

A register may change by itself, or notice that it is read.  The loop asks each of them at run time (`Cell.steady`).

`while (1) { now = Ticks; if (now - last >= 10) { last = now; Report(); } }` has such turns: those in which the test
fails.  What begins a turn that is not idle is marked, also in the functions that it calls.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

from emulator.c28x.tree import (
    Assign,
    Break,
    Call,
    CallPointer,
    Continue,
    Declare,
    Evaluate,
    Expr,
    FallThrough,
    For,
    Function,
    If,
    Jump,
    LValue,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Variable,
    While,
)
from emulator.c28x.tree_queries import parts, polls, statements

#: Path of a function that a turn may call and still be idle -> the registers that it reads then.
IdleCalls = Mapping[str, tuple[RegisterRef, ...]]
#: They only set INTM or DBGM: after two turns that did the same, another one changes nothing.
_MASKS: Final = frozenset({"DINT", "EINT", "DRTM", "ERTM", "__disable_interrupts", "__enable_interrupts"})


def idle_calls(functions: Iterable[Function]) -> IdleCalls:
    """The functions of an image with a way to their end that changes nothing."""
    own = {function.path: function for function in functions}
    found: dict[str, tuple[RegisterRef, ...]] = {}
    #: What was looked at, or is: a function that calls itself is not idle.
    met: set[str] = set()

    def look(function: Function) -> None:
        met.add(function.path)
        for path in function.calls:
            if path in own and path not in met:
                look(own[path])
        turn = _Turn(set(), found)
        if function.body and turn.of_call(function):
            found[function.path] = tuple(turn.registers.values())

    for path, function in own.items():
        if path not in met:
            look(function)
    return found


def idle_turns(
    function: Function, idle: IdleCalls
) -> tuple[dict[int, list[RegisterRef]], dict[int, list[int]], set[int]]:
    """The loops of a function that have idle turns, and the statements that end the idleness of a turn.

    Returns identities: of loops, each with the registers that idle turns read; of statements, each with those of the
    loops whose turn it is part of; and of the statements that end the idleness of a call.
    """
    loops: dict[int, list[RegisterRef]] = {}
    marks: dict[int, list[int]] = {}
    for s in statements(function.body):
        turn = _idle_turn(s, idle) if isinstance(s, While) else None
        if turn is not None:
            loops[id(s)] = list(turn.registers.values())
            for statement in turn.busy:
                marks.setdefault(id(statement), []).append(id(s))
    call = _Turn(set(), idle)
    if function.path in idle:
        call.of_call(function)
    return loops, marks, {id(s) for s in call.busy}


def _idle_turn(loop: While, idle: IdleCalls) -> _Turn | None:
    """The idle turns of a loop; None: it has none."""
    if not loop.body or polls(loop):
        return None
    turn = _Turn(set(), idle)
    found = turn.of(loop)
    while turn.set & turn.read:
        turn = _Turn(turn.carried | turn.set & turn.read, idle)
        found = turn.of(loop)
    return turn if found else None


class _Turn:
    """One turn of a loop, or a call; `carried`: the locals that a turn hands to the next: no idle turn sets them."""

    def __init__(self, carried: set[Variable], idle: IdleCalls) -> None:
        self.carried = carried
        self.idle = idle
        #: The statements before which a turn is idle, and after which it is not.
        self.busy: list[Stmt] = []
        #: The locals that idle turns set, and those that they read before they have set them.
        self.set: set[Variable] = set()
        self.read: set[Variable] = set()
        #: The registers that they read, by block and name.
        self.registers: dict[tuple[str, str], RegisterRef] = {}
        #: Whether a `continue`, or in a call a `return`, ends an idle turn; a test that follows it.
        self.carries_on = False
        self.last: list[Expr] = []
        self.called = False
        #: Of the turns of a counting loop within: whether a `break` or `continue` ends an idle one.
        self.within = False
        self.leaves = False

    def of(self, loop: While) -> bool:
        """Whether the loop has idle turns."""
        if loop.step or not self._pure([loop.test]):
            return False
        known: set[Variable] = set()
        self.last = [] if loop.first else [loop.test]
        if loop.first:
            self._reads([loop.test], known)
        after = self._block(loop.body, known)
        if after is not None:
            self._reads(self.last, after)
        return after is not None or self.carries_on

    def of_call(self, function: Function) -> bool:
        """Whether the function has an idle way to its end."""
        self.called = True
        if any(variable.in_memory for variable in (*function.parameters, *function.locals)):
            return False
        return self._block(function.body, set()) is not None or self.carries_on

    def _block(self, body: list[Stmt], known: set[Variable]) -> set[Variable] | None:
        """Follow an idle turn through a block; `known`: the locals that it has set.

        Returns those that it has set at the end; None: no idle turn reaches the end.
        """
        for s in body:
            match s:
                case Break() | Continue() if self.within:
                    self.leaves = True
                    return None
                case Continue():
                    self.carries_on = True
                    self._reads(self.last, known)
                    return None
                case Return(value=value) if self.called and (value is None or self._pure([value])):
                    self.carries_on = True
                    self._reads([] if value is None else [value], known)
                    return None
                case Break() | Return() | Jump():
                    if self.called:
                        self.busy.append(s)
                    return None  # the loop ends
                case Evaluate(value=value) if self._pure([value]):
                    self._reads([value], known)
                case Declare(value=None) | FallThrough():
                    pass
                case Evaluate(value=Call(function=Function(extern=True, name=name))) if name in _MASKS:
                    pass
                case Assign(target=LValue(root=Variable() as target, indices=[]), value=value) | Declare(
                    variable=target, value=Expr() as value
                ) if target.plain and target not in self.carried and self._pure([value]):  # fmt: skip
                    self._reads([value], known)
                    self.set.add(target)
                    known = {*known, target}
                case If(test=test, then=then, otherwise=otherwise) if self._pure([test]):
                    self._reads([test], known)
                    ends = [e for e in (self._block(then, known), self._block(otherwise, known)) if e is not None]
                    if not ends:
                        return None
                    known = set.intersection(*ends)
                case For(start=start, stop=stop, counter=counter) if (
                    counter.plain and counter not in self.carried and self._pure([start, stop])
                ):
                    counting = self._counting(s, {*known, counter})
                    if counting is None:
                        self.busy.append(s)
                        return None
                    self._reads([start], known)
                    known = {*known, counter}
                    self._reads([stop], known)
                    self.set.add(counter)
                    self._take(counting)
                case While(first=True, test=test, body=[first, *_]) if self._pure([test]) and not (
                    self.called and _idle_turn(s, self.idle)  # a call that marked its turns would end their idleness
                ):
                    self._reads([test], known)
                    self.busy.append(first)
                case _:
                    self.busy.append(s)
                    return None
        return known

    def _counting(self, loop: For, known: set[Variable]) -> _Turn | None:
        """The idle turns of a counting loop within this turn; None: it has none."""
        inner = _Turn(self.carried, self.idle)
        inner.called, inner.within = self.called, True
        return inner if inner._block(loop.body, known) is not None or inner.leaves else None

    def _take(self, inner: _Turn) -> None:
        """Add what the turns of a loop within do."""
        self.busy += inner.busy
        self.set |= inner.set
        self.read |= inner.read
        self.registers.update(inner.registers)
        self.carries_on = self.carries_on or inner.carries_on

    def _reads(self, values: Iterable[Expr], known: set[Variable]) -> None:
        for value in values:
            for part in parts(value):
                match part:
                    case LValue(root=Variable() as root) if root not in known:
                        self.read.add(root)
                    case RegisterLoad(register=RegisterRef() as register):
                        self._reads_register(register)
                    case Call(function=function):
                        for register in self.idle[function.path]:
                            self._reads_register(register)

    def _reads_register(self, register: RegisterRef) -> None:
        self.registers.setdefault((register.block, register.register), register)

    def _pure(self, values: Iterable[Expr]) -> bool:
        """Whether expressions only read named objects and registers: no pointer, no call but idle ones."""
        for part in (p for value in values for p in parts(value)):
            match part:
                case CallPointer() | LValue(root=Expr()) | RegisterLoad(register=RegisterAt()):
                    return False
                case Call(function=function) if function.path not in self.idle:
                    return False
        return True
