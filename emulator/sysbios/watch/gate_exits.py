"""Paths through a function that enter a gate and do not leave it: a `continue` or `return` comes in between.

The source is searched, because a run may not take the path.  If some function leaves a gate without entering it, two
functions enter and leave the gate as partners, on purpose.  Nothing is reported of such a gate, and of no gate that a
pointer leads to if such a function reaches its own by a pointer.  Nothing is reported of `main` either: before tasks
run, a gate keeps nobody out.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Final, NamedTuple

from emulator.c28x.tree import (
    Break,
    Call,
    Continue,
    FallThrough,
    For,
    Function,
    If,
    LeaveSwitch,
    Load,
    LValue,
    Return,
    Stmt,
    Switch,
    Variable,
    Where,
    While,
)
from emulator.c28x.tree_queries import assigned, bare, statements
from emulator.sysbios.watch.names import HandleNames, calls, first_argument

#: The calls that enter a gate, and (`LEAVE`) those that leave it.
ENTER: Final = ("GateMutexPri_enter", "GateMutex_enter")
LEAVE: Final = ("GateMutexPri_leave", "GateMutex_leave")

#: Gates that are held -> where they were entered.
Held = dict[str, Where]
#: What stands before the text of a gate that a pointer of the function leads to.
_POINTED: Final = "->"


class GateExit(NamedTuple):
    """A `continue` or `return` that does not leave a gate that was entered; `gate` as `_FunctionGates.gate` has it."""

    statement: Continue | Return
    gate: str
    entered: Where

    @property
    def name(self) -> str:
        """The name of the gate in the source."""
        return self.gate.removeprefix(_POINTED) if _by_pointer(self.gate) else self.gate.rpartition(".")[2]


def exits(names: HandleNames) -> Iterator[tuple[Function, GateExit]]:
    """Every `return` of the image's functions, and every `continue`, that does not leave a gate."""
    functions = [_FunctionGates(function) for function in names.functions]
    shared = {gate for each in functions for gate in each.left - each.entered}
    if None in shared or any(gate is not None and _by_pointer(gate) for gate in shared):
        functions = [each for each in functions if None not in shared and not any(map(_by_pointer, each.own))]
    for each in functions:
        own = each.own - shared
        if each.function.name != "main" and own:
            yield from ((each.function, exit) for exit in each.exits() if exit.gate in own)


def _by_pointer(gate: str) -> bool:
    """Whether a gate is known by a pointer of its function only."""
    return gate.startswith(_POINTED)


class _FunctionGates:
    """The gates that a function enters and leaves: by the file-scope object that holds the handle, or by a pointer."""

    def __init__(self, function: Function) -> None:
        self.function = function
        given = Counter(variable for s in statements(function.body) if (variable := assigned(s)) is not None)
        #: The pointers of the function that have one value as long as it runs.
        self._steady = {v for v in function.parameters if not given[v] and not v.escapes}
        self._steady |= {v for v in function.locals if given[v] == 1 and not v.escapes}
        own = list(calls(function.body))
        self.entered = {self.gate(call) for call in own if call.function.name in ENTER}
        self.left = {self.gate(call) for call in own if call.function.name in LEAVE}
        self._found: list[GateExit] = []

    @property
    def own(self) -> set[str]:
        """The gates that it both enters and leaves."""
        return {gate for gate in self.entered & self.left if gate is not None}

    def gate(self, call: Call) -> str | None:
        """What holds the gate of a call: the path of a file-scope object, or `->p->gate`; None if neither is known."""
        match bare(call.arguments[0]):
            case Load(lvalue=LValue(root=Load(lvalue=LValue(root=Variable() as pointer)), indices=[]) as held):
                return f"{_POINTED}{held.text}" if pointer in self._steady else None
        return first_argument(call)

    def exits(self) -> list[GateExit]:
        """Every `return` and `continue` that does not leave a gate that was entered."""
        self._found = []
        self._walk(self.function.body, {}, {})
        return self._found

    def _walk(self, body: list[Stmt], held: Held, outside: Held) -> Held | None:
        """The gates held after `body`; None if no path reaches its end.  `outside`: those held before the loop."""
        held = dict(held)
        for statement in body:
            match statement:
                case If(then=then, otherwise=otherwise):
                    ways = [self._walk(then, held, outside), self._walk(otherwise, held, outside)]
                case Switch(cases=cases):
                    # A case that is fallen into starts with the gates held before the switch: it holds no more than
                    # these.
                    ways = [*(self._walk(case, held, outside) for _, case in cases), held]
                case While(body=turn) | For(body=turn):
                    self._walk(turn, held, held)
                    # A gate that some turn leaves may be held behind the loop or not.
                    for call in calls(turn):
                        if call.function.name in LEAVE:
                            gate = self.gate(call)
                            held = {each: at for each, at in held.items() if gate not in (each, None)}
                    continue
                case Continue():
                    entered = ((gate, at) for gate, at in held.items() if gate not in outside)
                    self._found.extend(GateExit(statement, gate, at) for gate, at in entered)
                    return None
                case Return():
                    self._calls(statement, held)
                    self._found.extend(GateExit(statement, gate, at) for gate, at in held.items())
                    return None
                case Break():
                    return None
                case LeaveSwitch() | FallThrough():
                    return held
                case _:
                    self._calls(statement, held)
                    continue
            through = [way for way in ways if way is not None]
            if not through:
                return None
            # A gate that is held on some paths only is not followed further.
            held = {gate: at for gate, at in through[0].items() if all(gate in way for way in through)}
        return held

    def _calls(self, statement: Stmt, held: Held) -> None:
        """Update `held` with the gates that a statement without inner blocks enters and leaves."""
        for call in calls([statement]):
            name = call.function.name
            if name not in ENTER + LEAVE:
                continue
            gate = self.gate(call)
            if gate is None:
                held.clear()
            elif name in ENTER:
                held[gate] = statement.where
            else:
                held.pop(gate, None)
