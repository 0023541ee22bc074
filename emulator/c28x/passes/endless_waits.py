"""Static check of what a program does for the end of a time where the wait has none: `constant-condition`.

    if (!Mailbox_pend(box, &order, BIOS_WAIT_FOREVER)) {
        order.speed = 0;        /* nobody stops the motor when no order comes */
    }

The wait returns only with what it waits for.  The check tells where the branch sets objects, and goes on with what
follows.  A branch that leaves, calls something, or only notes an error may stand there for caution.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x.passes.declared import name_at, words_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import (
    Assign,
    Break,
    Call,
    CallPointer,
    Compare,
    Continue,
    Expr,
    Function,
    If,
    Jump,
    LeaveSwitch,
    LValue,
    Not,
    Return,
    Stmt,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import added, bare, own_nodes, statements

#: The waits that return 0 if the time is over, and which of their arguments is the time.
_WAITS: Final = {"Semaphore_pend": 1, "Mailbox_pend": 2, "Mailbox_post": 2, "Event_pend": 3}
#: Words of objects that only keep that something went wrong, in English, German and Spanish.
_NOTES: Final = frozenset((
    "err", "error", "errors", "fault", "faults", "fail", "failed", "failure", "failures", "status", "state", "result",
    "res", "ret", "rc", "rv", "ok", "code", "lost", "miss", "missed", "timeout", "timeouts", "bad", "alarm", "debug",
    "dbg", "trace", "never", "impossible", "unexpected", "fehler", "zustand", "ergebnis", "verloren", "fallo", "estado",
    "resultado", "perdido", "perdidos",
))  # fmt: skip
#: What leads elsewhere.
_AWAY: Final = (Return, While, Jump, Break, Continue, LeaveSwitch)


def check_endless_waits(function: Function, report: StaticReport) -> None:
    """Report the branches for the end of the time of a wait that has none."""
    for s in statements(function.body):
        if not isinstance(s, If):
            continue
        wait, came = _asks(s.test, came=True)
        if wait is None:
            continue
        branch = s.otherwise if came else s.then
        changed = _sets(branch)
        if changed:
            name = wait.function.name
            message = f"{name} waits without a time-out: the branch for its end, which sets {changed}, never runs"
            report.report(function, s.where, "constant-condition", message, object=changed)


def _asks(test: Expr, *, came: bool) -> tuple[Call | None, bool]:
    """The wait without a time-out that a test asks, and whether the test holds if what it waits for has come."""
    match bare(test):
        case Not(operand=operand):
            return _asks(operand, came=not came)
        case Compare(op="==" | "!=" as op, left=left, right=right):
            for side, other in ((left, right), (right, left)):
                number = constant_of(other)
                if number == 0 or (number == 1 and _is_truth(side)):
                    return _asks(side, came=came == ((op == "==") == (number == 1)))
        case Call(function=Function(extern=True, name=name), arguments=arguments) as call if name in _WAITS:
            # By its name: an own macro may be a choice of the build.
            if len(arguments) == _WAITS[name] + 1 and name_at(bare(arguments[-1]).where) == "BIOS_WAIT_FOREVER":
                return call, came
    return None, came


def _is_truth(e: Expr) -> bool:
    """Whether an expression is a wait that returns TRUE or FALSE."""
    match bare(e):
        case Call(function=Function(name=name)):
            return name != "Event_pend"
    return False


def _sets(branch: list[Stmt]) -> str:
    """What a branch sets before it goes on; empty: it leaves, calls something else, or only notes an error."""
    found = ""
    for s in statements(branch):
        if isinstance(s, _AWAY) or any(isinstance(p, Call | CallPointer) for p in own_nodes(s)):
            return ""
        match s:
            case Assign(target=LValue(text=text)) if added(s) is None and _NOTES.isdisjoint(words_of(text)):
                found = found or text
    return found
