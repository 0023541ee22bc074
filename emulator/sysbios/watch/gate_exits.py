"""Paths through a function that enter a gate and do not leave it: a `continue` or `return` comes in between.

The source is searched, because a run may not take the path.  If some function leaves a gate without entering it, two
functions enter and leave the gate as partners, on purpose.  Nothing is reported of such a gate.  Nothing is reported of
`main` either: before tasks run, a gate keeps nobody out.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

from emulator.c28x.tree import (
    Break,
    Continue,
    FallThrough,
    For,
    Function,
    If,
    LeaveSwitch,
    Return,
    Stmt,
    Switch,
    Where,
    While,
)
from emulator.sysbios.watch.names import HandleNames, calls, first_argument

#: The calls that enter a gate, and (`LEAVE`) those that leave it.
ENTER: Final = ("GateMutexPri_enter", "GateMutex_enter")
LEAVE: Final = ("GateMutexPri_leave", "GateMutex_leave")

#: Gates that are held: path of the file-scope object -> where they were entered.
Held = dict[str, Where]


class GateExit(NamedTuple):
    """A `continue` or `return` that does not leave the gate whose handle is in the file-scope object `path`."""

    statement: Continue | Return
    path: str
    entered: Where


def exits(names: HandleNames) -> Iterator[tuple[Function, GateExit]]:
    """Every `return` of the image's functions, and every `continue`, that does not leave a gate."""
    entered, left = names.passed_by(*ENTER), names.passed_by(*LEAVE)
    shared = {path for function, passed in left.items() for path in passed - entered.get(function, set())}
    for function in names.functions:
        own = (entered.get(function.path, set()) & left.get(function.path, set())) - shared
        if function.name != "main" and own and None not in shared:
            found: list[GateExit] = []
            _walk(function.body, {}, {}, found)
            yield from ((function, exit) for exit in found if exit.path in own)


def _walk(body: list[Stmt], held: Held, outside: Held, found: list[GateExit]) -> Held | None:
    """The gates held after `body`; None if no path reaches its end.  `outside`: those held before the loop around."""
    held = dict(held)
    for statement in body:
        match statement:
            case If(then=then, otherwise=otherwise):
                ways = [_walk(then, held, outside, found), _walk(otherwise, held, outside, found)]
            case Switch(cases=cases):
                # A case that is fallen into starts with the gates held before the switch: it holds no more than these.
                ways = [_walk(case, held, outside, found) for _, case in cases] + [held]
            case While(body=turn) | For(body=turn):
                _walk(turn, held, held, found)
                # A gate that some turn leaves may be held behind the loop or not.
                for call in calls(turn):
                    if call.function.name in LEAVE:
                        path = first_argument(call)
                        held = {each: at for each, at in held.items() if path not in (each, None)}
                continue
            case Continue():
                found.extend(GateExit(statement, path, at) for path, at in held.items() if path not in outside)
                return None
            case Return():
                _calls(statement, held)
                found.extend(GateExit(statement, path, at) for path, at in held.items())
                return None
            case Break():
                return None
            case LeaveSwitch() | FallThrough():
                return held
            case _:
                _calls(statement, held)
                continue
        through = [way for way in ways if way is not None]
        if not through:
            return None
        # A gate that is held on some paths only is not followed further.
        held = {path: at for path, at in through[0].items() if all(path in way for way in through)}
    return held


def _calls(statement: Stmt, held: Held) -> None:
    """Update `held` with the gates that a statement without inner blocks enters and leaves."""
    for call in calls([statement]):
        name = call.function.name
        if name not in ENTER + LEAVE:
            continue
        path = first_argument(call)
        if path is None:
            held.clear()
        elif name in ENTER:
            held[path] = statement.where
        else:
            held.pop(path, None)
