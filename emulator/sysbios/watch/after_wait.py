"""What follows a wait whose result nothing tests: does it use again what it should have waited for?"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.passes.dropped import casts_to_void
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    CallPointer,
    Compare,
    Conditional,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    Function,
    If,
    LValue,
    RegisterLoad,
    Stmt,
    Switch,
    Variable,
    Where,
    While,
)
from emulator.c28x.tree_queries import assigned, assigned_variables, bare, blocks, own_nodes, parts, statements
from emulator.sysbios.watch.names import first_argument

#: Calls at which a thread may wait: what follows them no longer belongs to the wait before.
_WAITS: Final = ("Semaphore_pend", "Event_pend", "Mailbox_pend", "Task_sleep", "Task_yield")
_SIZES: Final = ("<", ">", "<=", ">=")


@dataclass(frozen=True)
class IgnoredWait:
    """A call that waits, as a statement of its own, with the statements of its block before and after it."""

    call: Call
    statement: Evaluate
    before: tuple[Stmt, ...]
    after: tuple[Stmt, ...]


def ignored_waits(function: Function, name: str) -> Iterator[IgnoredWait]:
    """The calls of `name` in a function whose result nothing uses; a cast to void says that it is meant."""
    for block in (function.body, *(inner for s in statements(function.body) for inner in blocks(s))):
        for n, s in enumerate(block):
            if (
                isinstance(s, Evaluate) and isinstance(s.value, Call) and s.value.function.name == name
                and not _is_meant(s.where)
            ):  # fmt: skip
                after = next((m for m, later in enumerate(block[n + 1 :], n + 1) if _waits(later)), len(block))
                begin = next((m + 1 for m in range(n - 1, -1, -1) if _waits(block[m])), 0)
                yield IgnoredWait(s.value, s, tuple(block[begin:n]), tuple(block[n + 1 : after]))


def used_again(wait: IgnoredWait, function: Function, posters: Iterable[Function]) -> str | None:
    """The object that only the posters write, and that what follows the wait uses; "": what it had asked for.

    None: what follows uses nothing of this kind, or tests something that may tell whether the wait was in vain.
    """
    written = {v for poster in posters for v in assigned_variables(poster.body) if v.kind == "global"}
    written -= assigned_variables(function.body)
    if _tested(wait.after, written):
        return None
    for s in statements(wait.after):
        if isinstance(s, Assign | Declare | CopyStruct | Evaluate):
            for part in own_nodes(s):
                if isinstance(part, LValue) and isinstance(part.root, Variable) and part.root in written:
                    return part.root.declaration.name
    asked = any(
        isinstance(part, Call) and part.function.name == "Semaphore_reset"
        and first_argument(part) == first_argument(wait.call)
        for s in wait.before for part in own_nodes(s)
    )  # fmt: skip
    return "" if asked and wait.after else None


def message_used(wait: IgnoredWait) -> Variable | None:
    """The object into which a pend on a mailbox stores its message, if what follows uses it; else None.

    If it is set before each wait, it tells whether a message has come.
    """
    buffer = _buffer(wait.call)
    if any(assigned(s) is buffer for s in wait.before):
        return None
    used = any(
        isinstance(part, LValue) and part.root is buffer for s in statements(wait.after) for part in own_nodes(s)
    )  # fmt: skip
    return buffer if buffer is not None and used else None


def message_tested(wait: IgnoredWait, buffer: Variable) -> bool:
    """Whether a test after a wait asks for something that may tell whether the message is a new one."""
    return _tested(wait.after, {buffer})


def only_received(buffer: Variable, wait: IgnoredWait, function: Function) -> bool:
    """Whether a local has no value before a wait stores a message in it: nothing else writes it or has its address."""
    if buffer.kind != "local" or buffer.initialised:
        return False
    given = {id(wait.statement), *(id(s) for s in statements(wait.after))}
    for s in statements(function.body):
        here = id(s) not in given
        if here and any(isinstance(p, AddressOf) and p.lvalue.root is buffer for p in own_nodes(s)):
            return False
        if assigned(s) is buffer and not (isinstance(s, Declare) and s.value is None):
            return False
    return True


def _buffer(call: Call) -> Variable | None:
    match bare(call.arguments[1]) if len(call.arguments) > 1 else None:
        case AddressOf(lvalue=LValue(root=Variable() as buffer)):
            return buffer
    return None


def _is_meant(where: Where) -> bool:
    lines = lines_with_comments(where.file)
    return 0 < where.line <= len(lines) and casts_to_void(lines[where.line - 1][0])


def _waits(s: Stmt) -> bool:
    return any(isinstance(part, Call) and part.function.name in _WAITS for part in own_nodes(s))


def _tested(after: Iterable[Stmt], written: set[Variable]) -> bool:
    """Whether a test asks for what the posters write, for a register or for a result, and not only how large it is."""
    known = set(written)
    for s in statements(after):
        target = assigned(s)
        if target is not None and target.kind == "local" and any(_tells(part, known) for part in own_nodes(s)):
            known.add(target)
        tests: list[Expr] = [s.test] if isinstance(s, If | While) else [s.subject] if isinstance(s, Switch) else []
        tests += [part.test for part in own_nodes(s) if isinstance(part, Conditional)]
        for test in tests:
            asked = parts(test)
            size = isinstance(test, Compare) and test.op in _SIZES
            size = size and not any(isinstance(part, Binary) and part.op == "-" for part in asked)  # it may be an age
            if any(_tells(part, known) and not (size and isinstance(part, LValue)) for part in asked):
                return True
    return False


def _tells(part: object, known: set[Variable]) -> bool:
    """Whether a part of an expression can tell what the posters have done."""
    if isinstance(part, LValue):
        return isinstance(part.root, Variable) and part.root in known
    return isinstance(part, Call | CallPointer | RegisterLoad)
