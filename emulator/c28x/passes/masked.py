"""Static check of interrupts that are switched off: does every way switch them on again?

Two things are certain from the source.  A key (`key = Hwi_disable();`) that nothing reads cannot be given to a restore.
And a `continue` or `return` between a DINT and the EINT that follows it on another way leaves interrupts off.  The same
is true of the other functions that switch off and on (`SWITCHES`), and of functions that only call these.
Not reported: a function that switches off and never on (its caller does, or it is meant), a DINT right before the exit,
a loop that comes to an EINT first, a way on which another function may switch on, the return of a start-up or of a
function that takes a lock, a key that the caller gets.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

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
    LValue,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)
from emulator.c28x.tree_queries import (
    assigned,
    bare,
    last_loop,
    own_nodes,
    parts,
    reached,
    roots,
    statements,
    variables,
    within,
)

#: A function that gives a key -> the functions that switch on again.
KEYS: Final = {
    "Hwi_disable": frozenset({"Hwi_restore", "Hwi_enable"}), "Swi_disable": frozenset({"Swi_restore", "Swi_enable"}),
    "Task_disable": frozenset({"Task_restore", "Task_enable"}),
}  # fmt: skip
#: A start-up begins with interrupts off, and may give up with interrupts off; a lock that was taken stays taken.
_START_UP: Final = re.compile("main|init|setup|config|start|open|begin|reset|lock|enter|acquire|take", re.IGNORECASE)


class _Kind(NamedTuple):
    """The functions that switch one thing off, and those that switch it on again."""

    what: str
    off: frozenset[str]
    on: frozenset[str]


SWITCHES: Final = (
    _Kind(
        "interrupts", frozenset({"DINT", "__disable_interrupts", "Hwi_disable"}),
        frozenset({"EINT", "__enable_interrupts", "__restore_interrupts", "Hwi_restore", "Hwi_enable"}),
    ),
    _Kind("the Swis", frozenset({"Swi_disable"}), KEYS["Swi_disable"]),
    _Kind("the tasks", frozenset({"Task_disable"}), KEYS["Task_disable"]),
)  # fmt: skip


def check_masked(function: Function, report: StaticReport) -> None:
    """Report keys that nothing restores, and ways out that leave interrupts off."""
    called = {call.function.name for call in _calls(within(function.body))}
    for name in KEYS.keys() & called:
        if not called & KEYS[name] and last_loop(function) is None:
            _check_key(function, name, report)
    inside = _reached(*(call.function for call in _calls(within(function.body))))
    for kind in SWITCHES if not function.interrupt else ():
        if not (kind.off & inside and kind.on & inside):
            continue
        walk = _Walk(kind)
        walk.block(function.body, None)
        for leaving, off in walk.exits:
            word = "continue" if isinstance(leaving, Continue) else "return"
            if id(off) in walk.ended and not (word == "return" and _START_UP.search(function.name)):
                message = (
                    f"this {word} leaves {kind.what} off since line {off.line}: they are switched on again on another "
                    "way"
                )
                about = "INTM" if kind is SWITCHES[0] else kind.what
                report.report(function, leaving.where, "interrupts-left-off", message, object=about)


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


def _reached(*functions: Function) -> set[str]:
    """The names of functions, and of those that they call, directly or not."""
    return {f.name for f in reached(functions, lambda f: (call.function for call in _calls(within(f.body))))}


def _returned(function: Function) -> bool:
    """Whether a function returns something, or stores it where a pointer says: then its caller may have a key."""
    stored = any(
        isinstance(s, Assign) and isinstance(s.target, LValue) and isinstance(s.target.root, Expr)
        for s in statements(function.body)
    )  # fmt: skip
    return stored or any(isinstance(s, Return) and s.value is not None for s in statements(function.body))


class _Walk:
    """Follows a DINT, or what else switches off, along the ways through a function."""

    def __init__(self, kind: _Kind) -> None:
        self._kind = kind
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
                    first = next((_at(p) for p in turn if any(self._named(p))), None)
                    self._around.append((off, first))
                    self.block(turn, off)
                    self._around.pop()
                    if any(self._switches_on(call.function) for call in _calls(within([s]))):
                        off = None  # on some ways through its turns, interrupts are on again
                case Continue():
                    around, first = self._around[-1]
                    kept = off is around or off is before
                    if off is not None and not kept and (first is None or _at(off) < first):
                        self.exits.append((s, off))
                    return False, None
                case Return():
                    if off is not None and off is not before and not self._gives_key(s, off):
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
                if self._switches_off(call.function):
                    off = off or s
                elif self._switches_on(call.function):
                    if off is not None:
                        self.ended.add(id(off))
                    off = None
        return off

    def _named(self, s: Stmt) -> Iterator[Call]:
        return (call for call in _calls(own_nodes(s)) if call.function.name in self._kind.on)

    def _switches_on(self, function: Function) -> bool:
        """Whether a function, or one that it calls, switches on."""
        return not self._kind.on.isdisjoint(_reached(function))

    def _switches_off(self, function: Function) -> bool:
        """Whether a function only switches off, without a loop, and gives its caller nothing."""
        if function.name in self._kind.off:
            return True
        if _returned(function) or any(isinstance(s, While | For) for s in statements(function.body)):
            return False
        inside = _reached(function)
        return not self._kind.off.isdisjoint(inside) and self._kind.on.isdisjoint(inside)

    def _gives_key(self, s: Return, off: Stmt) -> bool:
        """Whether the caller gets the key of what is off, by the result, a pointer or an object at file scope."""
        key = assigned(off)
        if key is None:
            return isinstance(off, Assign)
        return key.kind == "global" or (s.value is not None and key in variables(parts(s.value)))

    def _joined(self, ways: list[tuple[bool, Stmt | None]]) -> tuple[bool, Stmt | None]:
        """A DINT that is in force on some ways only is not followed further."""
        reached = [off for through, off in ways if through]
        if not reached:
            return False, None
        return True, reached[0] if all(off is reached[0] for off in reached) else None
