"""Static check of interrupts that are switched off: does every way switch them on again?

Two things are certain from the source.  A key (`key = Hwi_disable();`) that nothing reads cannot be given to a restore.
And a `continue` or `return` between a DINT and the EINT that follows it on another way leaves interrupts off.
Not reported: a function that switches off and never on (its caller does, or it is meant), a DINT right before the exit,
a loop that comes to an EINT first, a way on which another function may switch on, the return of a start-up.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.passes.report import StaticReport
from emulator.c28x.tree import (
    Assign,
    Break,
    Call,
    Continue,
    Declare,
    Expr,
    FallThrough,
    For,
    Function,
    If,
    LeaveSwitch,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)
from emulator.c28x.tree_queries import assigned, bare, last_loop, own_nodes, parts, roots, statements, variables, within

#: A function that gives a key -> the functions that switch on again.
KEYS: Final = {
    "Hwi_disable": frozenset({"Hwi_restore", "Hwi_enable"}), "Swi_disable": frozenset({"Swi_restore", "Swi_enable"}),
    "Task_disable": frozenset({"Task_restore", "Task_enable"}),
}  # fmt: skip
#: A start-up begins with interrupts off, and may give up with interrupts off.
_START_UP: Final = re.compile("main|init|setup|config|start|open|begin|reset", re.IGNORECASE)
OFF: Final = "DINT"
ON: Final = "EINT"


def check_masked(function: Function, report: StaticReport) -> None:
    """Report keys that nothing restores, and ways out that leave interrupts off."""
    called = {call.function.name for call in _calls(within(function.body))}
    for name in KEYS.keys() & called:
        if not called & KEYS[name] and last_loop(function) is None:
            _check_key(function, name, report)
    if {OFF, ON} <= called and not function.interrupt:
        walk = _Walk()
        walk.block(function.body, None)
        for leaving, off in walk.exits:
            word = "continue" if isinstance(leaving, Continue) else "return"
            if id(off) in walk.ended and not (word == "return" and _START_UP.search(function.name)):
                message = (
                    f"this {word} leaves interrupts off since the DINT in line {off.line}: an EINT follows on "
                    "another way"
                )
                report.report(function, leaving.where, "interrupts-left-off", message, object="INTM")


def _check_key(function: Function, name: str, report: StaticReport) -> None:
    """Report a key of `name` that is kept in a local which nothing reads."""
    read = {v for s in statements(function.body) for root in roots(s) for v in _read(s, root)}
    for s in statements(function.body):
        key = assigned(s)
        value = bare(s.value) if isinstance(s, Assign | Declare) and isinstance(s.value, Expr) else None
        of_it = isinstance(value, Call) and value.function.name == name
        if of_it and key is not None and key.kind == "local" and key not in read:
            message = f"nothing uses {key.declaration.path}, the key of {name}: what it switched off stays off"
            report.report(function, s.where, "interrupts-left-off", message, object=name)


def _at(s: Stmt) -> tuple[int, int]:
    return s.where.line, s.where.column


def _read(s: Stmt, root: object) -> set[Variable]:
    return variables(parts(root)[1:] if isinstance(s, Assign) and root is s.target else parts(root))


def _calls(nodes: Iterable[object]) -> Iterator[Call]:
    return (p for p in nodes if isinstance(p, Call))


def _switches_on(function: Function, seen: set[str]) -> bool:
    """Whether a function of the firmware, or one that it calls, executes EINT."""
    if function.path in seen:
        return False
    seen.add(function.path)
    return function.name == ON or any(_switches_on(call.function, seen) for call in _calls(within(function.body)))


class _Walk:
    """Follows a DINT along the ways through a function."""

    def __init__(self) -> None:
        #: A way out, and the DINT that is in force there.
        self.exits: list[tuple[Continue | Return, Stmt]] = []
        #: Identities of the DINTs that an EINT ends on some way.
        self.ended: set[int] = set()
        #: The DINT in force before the loop around; the place of an EINT that its body comes to first.
        self._around: list[tuple[Stmt | None, tuple[int, int] | None]] = []

    def block(self, body: list[Stmt], off: Stmt | None) -> tuple[bool, Stmt | None]:
        """Whether the end of `body` is reached, and the DINT that is in force there."""
        before: Stmt | None = None
        for s in body:
            match s:
                case If(then=then, otherwise=otherwise):
                    off = self._step(s, off)
                    reached, off = self._joined([self.block(then, off), self.block(otherwise, off)])
                    if not reached:
                        return False, None
                case Switch(cases=cases):
                    off = self._step(s, off)
                    reached, off = self._joined([(True, off), *(self.block(case, off) for _, case in cases)])
                case While(body=turn) | For(body=turn):
                    off = self._step(s, off)
                    first = next((_at(p) for p in turn if any(self._named(p, ON))), None)
                    self._around.append((off, first))
                    self.block(turn, off)
                    self._around.pop()
                    if any(_switches_on(call.function, set()) for call in _calls(within([s]))):
                        off = None  # on some ways through its turns, interrupts are on again
                case Continue():
                    around, first = self._around[-1]
                    kept = off is around or off is before
                    if off is not None and not kept and (first is None or _at(off) < first):
                        self.exits.append((s, off))
                    return False, None
                case Return():
                    if off is not None and off is not before:
                        self.exits.append((s, off))
                    return False, None
                case Break():
                    return False, None
                case LeaveSwitch() | FallThrough():
                    return True, off
                case _:
                    off = self._step(s, off)
            before = s
        return True, off

    def _step(self, s: Stmt, off: Stmt | None) -> Stmt | None:
        """The DINT in force behind what a statement itself does."""
        for root in roots(s):
            for call in _calls(parts(root)):
                if call.function.name == OFF:
                    off = off or s
                elif _switches_on(call.function, set()):
                    if off is not None:
                        self.ended.add(id(off))
                    off = None
        return off

    def _named(self, s: Stmt, name: str) -> Iterator[Call]:
        return (call for call in _calls(own_nodes(s)) if call.function.name == name)

    def _joined(self, ways: list[tuple[bool, Stmt | None]]) -> tuple[bool, Stmt | None]:
        """A DINT that is in force on some ways only is not followed further."""
        reached = [off for through, off in ways if through]
        if not reached:
            return False, None
        return True, reached[0] if all(off is reached[0] for off in reached) else None
