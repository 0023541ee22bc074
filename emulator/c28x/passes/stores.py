"""Static check of stores: values that are overwritten before anything can have read them.

The value of a file-scope object, a member, or a register field is overwritten by a following statement, or by the case
to which a switch falls through.  A call, a loop, a register access or a pointer access in between ends the search: it
may have read the value.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.ctypes import PointerType, StructType
from emulator.c28x.passes.declared import may_be_volatile
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.values import volatile
from emulator.c28x.tree import (
    Assign,
    Call,
    Const,
    Declare,
    Evaluate,
    Expr,
    FallThrough,
    Function,
    Load,
    LValue,
    RegisterAt,
    RegisterRef,
    Stmt,
    Switch,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import OBSERVABLE, bare, blocks, calls, parts, roots, source_text, statements

#: Blocks in which a second write to the same field is a second event: it sends, sets, clears or acknowledges.
_EVENTS = ("Sci", "Spi", "I2c", "Mcb", "Can", "Usb", "Gpio", "Pie", "Lin")

#: Registers of other blocks that act when they are written.
_ACTS: Final = re.compile(r"CLR|FRC|CLEAR|FORCE|ACK|^TCR$|^TSC|LDR|CTL$")

#: If more cases than this end with a break, a single case that does not is suspicious.
LEAST_ENDED: Final = 2


def check_stores(function: Function, report: StaticReport) -> None:
    """Report the stores of a function that are overwritten before anything reads them, and missing breaks."""
    for s in statements(function.body):
        if isinstance(s, Switch):
            falling = [body for _, body in s.cases if len(body) > 1 and isinstance(body[-1], FallThrough)]
            ended = sum(bool(body) and not isinstance(body[-1], FallThrough) for _, body in s.cases)
            for number, (_, body) in enumerate(s.cases[:-1]):
                if body and isinstance(end := body[-1], FallThrough):
                    labels, following = _next_case(s.cases[number + 1 :])
                    told = _falls(function, body[:-1], following, report, said=end.said)
                    if not end.said:
                        only = len(falling) == 1 and ended > LEAST_ENDED
                        told |= _check_fall_through(function, body[:-1], following, report, only=only)
                        told = told or _check_next_state(
                            function, s, body[:-1], labels, following, report, only=len(falling) == 1
                        )
                        if only and not told and body[:-1]:
                            message = "this case goes on with the next one, and no comment says so; all others end"
                            report.report(function, statements(body[:-1])[-1].where, "case-goes-on", message)
    for body in _bodies(function.body):
        for i, s in enumerate(body):
            if isinstance(s, Assign) and isinstance(s.target, LValue) and _seen_by_others(s.target):
                again = _overwritten(s.target, body[i + 1 :])
                if again is not None and isinstance(s.target.root, Expr) and may_be_volatile(s.target.root):
                    continue
                if again is not None and not (isinstance(bare(s.value), Const) and not _twice(s, again, body[i + 1])):
                    text = s.target.text
                    message = f"{text} is set to {source_text(s.value)}, and is set again in line {again.line}"
                    report.report(function, s.where, "dead-store", message, object=text)


def _next_case(cases: list[tuple[list[int] | None, list[Stmt]]]) -> tuple[list[int], list[Stmt]]:
    """The labels and the statements with which a case goes on: `case UP: case DOWN: ...` is one case."""
    every: list[int] = []
    for labels, body in cases:
        every += labels or []
        if len(body) != 1 or not isinstance(body[0], FallThrough):
            return every, body
    return every, []


def _bodies(body: list[Stmt]) -> Iterator[list[Stmt]]:
    """Every block."""
    yield body
    for s in statements(body):
        yield from blocks(s)


def _twice(s: Assign, again: Assign, following: Stmt) -> bool:
    """Whether the next statement overwrites one constant by another: then the first is not just a start value."""
    value, other = bare(s.value), bare(again.value)
    return again is following and isinstance(other, Const) and isinstance(value, Const) and value.value != other.value


def _falls(
    function: Function, body: list[Stmt], following: list[Stmt], report: StaticReport, *, said: bool
) -> bool:  # fmt: skip
    """Report stores of a case that are overwritten by the case to which it falls through; false if there is none.

    `said`: a comment says that it does.  Then a register may be meant to have the first value for a moment.
    """
    told = False
    for i, s in enumerate(body):
        if not isinstance(s, Assign):
            continue
        if said and not isinstance(s.target, LValue) and s.target.field is None:
            continue
        again = _overwritten(s.target, [*body[i + 1 :], *following], in_cases=True)
        if again is not None and any(again is later for later in following):
            text = s.target.text if isinstance(s.target, LValue) else source_text(again.value)
            first = f"{_name(s)} is set to {source_text(s.value)}"
            message = f"{first}, and the next case sets it again: a break is missing"
            report.report(function, s.where, "case-falls", message, object=text)
            told = True
    return told


def _check_fall_through(
    function: Function, body: list[Stmt], following: list[Stmt], report: StaticReport, *, only: bool
) -> bool:  # fmt: skip
    """Report a case that falls through without a comment, into one that is not its continuation; false if it is none.

    The next case makes the same call again, or (`only`: all other cases end) stores the same value in another object.
    """
    again = next((s for s in body if isinstance(s, Assign | Evaluate) and calls(s.value) and s in following), None)
    if again is not None:
        message = f"the next case does {source_text(again.value)} again, and no comment says so: a break is missing"
        report.report(function, body[-1].where, "case-falls", message, object=source_text(again.value))
        return True
    match body, following:
        case [Evaluate(value=Call() as one_call)], [Evaluate(value=Call() as other_call), *_] if (
            only and one_call.function.path == other_call.function.path
            and all(isinstance(bare(a), Const) for a in (*one_call.arguments, *other_call.arguments))
        ):  # fmt: skip
            text = source_text(one_call)
            message = f"the next case calls {one_call.function.name} with other numbers, and no comment says so: "
            report.report(function, body[-1].where, "case-falls", message + "a break is missing", object=text)
            return True
        case [Assign(target=LValue() as one, value=value)], [Assign(target=LValue() as other, value=same), *_] if (
            only and value == same and one != other and not isinstance(bare(value), Const)
        ):
            text = source_text(value)
            message = f"{text} goes to {one.text}, and in the next case to {other.text}, and no comment says so: "
            report.report(function, body[-1].where, "case-falls", message + "a break is missing", object=one.text)
            return True
    return False


def _check_next_state(
    function: Function, switch: Switch, body: list[Stmt], labels: list[int], following: list[Stmt],
    report: StaticReport, *, only: bool,
) -> bool:  # fmt: skip
    """Report a case of a state machine that gives a state, and goes on with the case of another one, which does too.

    `only`: all other cases end.  Then a state that a function returns counts, too.
    """
    match bare(switch.subject):
        case Load(lvalue=state) if labels:
            given = [
                s for s in statements(body)
                if isinstance(s, Assign) and s.target == state
                and (value.value not in labels if isinstance(value := bare(s.value), Const) else
                     only and isinstance(value, Call))
            ]  # fmt: skip
            again = any(isinstance(s, Assign) and s.target == state for s in statements(following))
            if given and again and state.text:
                message = f"{state.text} becomes {source_text(given[-1].value)}, and this case goes on with the next "
                message += "one, which is for another state: a break is missing"
                report.report(function, statements(body)[-1].where, "case-falls", message, object=state.text)
                return True
    return False


def _name(s: Assign) -> str:
    """The target of an assignment, for a report."""
    target = s.target
    if isinstance(target, LValue):
        return target.text
    name = target.register if isinstance(target, RegisterRef) else target.name
    return f"{name}.{target.field.name}" if target.field else name


def _seen_by_others(target: LValue) -> bool:
    """Whether a target is a file-scope object, a member of one, or one that a pointer leads to; not volatile."""
    if volatile(target):
        return False
    if isinstance(target.root, Variable):
        return target.root.kind == "global"
    pointer = target.root.ctype
    return isinstance(pointer, PointerType) and isinstance(pointer.target, StructType)


def _overwritten(
    target: LValue | RegisterRef | RegisterAt, following: Iterable[Stmt], *, in_cases: bool = False
) -> Assign | None:  # fmt: skip
    """The statement that writes `target` again before anything can have read it.

    `in_cases`: in the case to which another one falls through; what a pointer writes there cannot have asked for it.
    """
    if isinstance(target, LValue):
        if volatile(target) or any(isinstance(p, OBSERVABLE) for p in parts(target)):
            return None
    elif not isinstance(target, RegisterRef) or not _setting(target, whole=in_cases):
        return None
    for s in following:
        if not isinstance(s, Assign | Declare) or _looks_at(s, target):
            return None
        if isinstance(s, Assign) and s.target == target:
            return s
        if isinstance(s, Assign) and not isinstance(s.target, LValue) and not in_cases:
            return None
        if isinstance(s, Assign) and isinstance(s.target, LValue) and _moves(s.target, target, in_cases=in_cases):
            return None
    return None


def _setting(register: RegisterRef, *, whole: bool) -> bool:
    """Whether a register field (`whole`: or a register) holds a number until it is written again."""
    if register.block.startswith(_EVENTS):
        return False
    if register.field is not None:
        return register.field.width > 1
    return whole and not _ACTS.search(register.register)


def _looks_at(s: Stmt, target: LValue | RegisterRef) -> bool:
    """Whether a statement reads the target, or may read it by a call, a register or a pointer."""
    for root in roots(s):
        for p in parts(root)[1 if isinstance(s, Assign) and root is s.target else 0 :]:
            if isinstance(p, OBSERVABLE):
                return True
            if isinstance(p, LValue) and (isinstance(p.root, Expr) or not isinstance(target, LValue)):
                return True
            if isinstance(p, LValue) and isinstance(target, LValue) and p.root is target.root:
                return True
    return isinstance(s, Evaluate)


def _moves(written: LValue, target: LValue | RegisterRef, *, in_cases: bool) -> bool:
    """Whether a write may change which object `target` designates, or a part of that object."""
    if not isinstance(target, LValue):
        return not in_cases
    if isinstance(written.root, Expr):
        designators = [p for p in parts(target) if isinstance(p, LValue) and p is not target]
        return not in_cases or any(isinstance(p.root, Expr) or not p.root.plain for p in designators)
    return any(isinstance(p, LValue) and p.root is written.root for p in parts(target))
