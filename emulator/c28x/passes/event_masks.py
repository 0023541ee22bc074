"""Static check of waits for events whose masks or tests lose some of them: `event-mask`.

    events = Event_pend(event, TICK | START, Event_Id_NONE, 100);   // the masks are exchanged
    if (events & TICK) ...
    if (events & START) ...

The first mask is for events that must all have come.  Then each single bit is set, and to test them one by one says
nothing: what was meant is the second mask.  Reported where the result is tested for at least two parts of the first
mask, and for nothing of the second.

    events = Event_pend(event, Event_Id_NONE, TICK | SECOND, BIOS_WAIT_FOREVER);
    if (events & TICK) ...
    else if (events & SECOND) ...                                   // lost when both have come

The wait takes all the bits that have come.  Reported where both bits come again and again, so that they come together
now and then: a Clock posts them in each of its calls, or a routine that reads an ADC's results.  An event that
something else posts (an error, a key) may rightly put another one aside.
"""

from __future__ import annotations

from collections.abc import Mapping

from emulator.c28x.passes.report import StaticReport
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Binary,
    Call,
    Const,
    Evaluate,
    Expr,
    Function,
    FunctionRef,
    If,
    Load,
    LValue,
    RegisterLoad,
    RegisterRef,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, gives, own_nodes, parts, statements, within


def check_event_masks(function: Function, report: StaticReport) -> None:
    """Report the waits for all events of a mask behind which these are tested one by one."""
    waits: dict[Variable, list[tuple[Stmt, int, int]]] = {}
    others: set[Variable] = set()
    body = statements(function.body)
    for s in body:
        match gives(s):
            case LValue(root=Variable() as variable), value:
                if (masks := _masks(value)) is not None:
                    waits.setdefault(variable, []).append((s, *masks))
                else:
                    others.add(variable)
    for variable, every in waits.items():
        for s, together, single in every:
            any_one = [other.line for other, both, one in every if not both and one == together]
            if together & (together - 1) and not single and any_one:
                message = (
                    f"Event_pend waits until all of {together:#x} have come, and the wait in line {any_one[0]} takes "
                    "any of the same events: the masks are exchanged"
                )
                report.report(function, s.where, "event-mask", message, object=variable.declaration.name)
    for variable, ((s, together, single), *more) in waits.items():
        if variable in others or more or together & (together - 1) == 0:
            continue
        tested = {mask for mask in _tested(body, variable) if mask & together}
        parts = {mask for mask in tested if mask & ~together == 0 and mask != together}
        if len(parts) > 1 and parts == tested and not single:
            message = (
                f"Event_pend waits until all of {together:#x} have come, and what follows tests {len(parts)} parts of "
                "them one by one, which are all set then: events of which one is enough go into the second mask"
            )
            report.report(function, s.where, "event-mask", message, object=variable.declaration.name)


def check_lost_events(reports: Mapping[Module, StaticReport]) -> None:
    """Report the tests of an event that comes regularly which are reached only if another such event has not come."""
    functions = {function: report for module, report in reports.items() for function in module.functions}
    if not any(call.function.name == "Event_pend" for f in functions for call in _calls(f)):
        return
    regular = _regular(list(functions))
    for function, report in functions.items():
        body = statements(function.body)
        taken: dict[Variable, int] = {}
        for s in body:
            match gives(s):
                case LValue(root=Variable() as variable), value:
                    # A variable that gets anything else may keep what was not looked at.
                    masks = _masks(value)
                    taken[variable] = masks[1] if masks is not None and variable not in taken else 0
        for variable, mask in taken.items():
            for s in body:
                first = _chosen(s, variable) & mask
                if not isinstance(s, If) or first not in regular or len(s.otherwise) != 1:
                    continue
                if any(isinstance(p, LValue) and p.root is variable for p in within(s.then)):
                    continue  # the first event looks after the others
                second = _chosen(s.otherwise[0], variable) & mask
                if second in regular and regular[second] != regular[first]:
                    message = (
                        f"Event_pend takes all events that have come: {second:#x} is lost here whenever {first:#x} has "
                        f"come too ({regular[first]} and {regular[second]} post them)"
                    )
                    report.report(
                        function, s.otherwise[0].where, "event-mask", message, object=variable.declaration.name
                    )


def _chosen(s: Stmt, variable: Variable) -> int:
    """The one bit of a local that alone decides an `if`; 0: something else decides it."""
    masks = _tested([s], variable) if isinstance(s, If) else set()
    mask = masks.pop() if len(masks) == 1 else 0
    return mask if mask & (mask - 1) == 0 else 0


def _regular(functions: list[Function]) -> dict[int, str]:
    """The events that just one function posts, of a Clock or with the results of an ADC, in each of its calls -> it."""
    makers: dict[Function | str, int] = {"Clock_create": 0}
    for function in functions:
        for call in _calls(function):
            match [bare(a) for a in call.arguments[:1]]:
                case [Load(lvalue=LValue(root=Variable(kind="parameter") as parameter))] if (
                    call.function.name == "Clock_create" and parameter in function.parameters
                ):
                    makers[function] = function.parameters.index(parameter)
    often = {f for f in functions if any(map(_is_result, within(f.body)))}
    for function in functions:
        for call in _calls(function):
            number = makers.get(call.function, makers.get(call.function.name))
            if number is not None and number < len(call.arguments):
                often |= {p.function for p in parts(call.arguments[number]) if isinstance(p, FunctionRef)}
    posts = [(f, mask) for f in functions for mask in _posts(statements(f.body))]
    every = [mask for _, mask in posts]
    return {mask: f.name for f, mask in posts if f in often and mask in _posts(f.body) and every.count(mask) == 1}


def _is_result(node: object) -> bool:
    """Whether a node reads a result of an ADC."""
    match node:
        case RegisterLoad(register=RegisterRef(block=block)):
            return block.endswith("ResultRegs")
    return False


def _posts(body: list[Stmt]) -> list[int]:
    """The events that the statements themselves post."""
    found = []
    for s in body:
        match s:
            case Evaluate(value=Call(function=Function(name="Event_post"), arguments=[_, mask])):
                match bare(mask):
                    case Const(value=int() as number):
                        found.append(number)
    return found


def _calls(function: Function) -> list[Call]:
    return [p for p in within(function.body) if isinstance(p, Call)]


def _masks(value: Expr) -> tuple[int, int] | None:
    """The two masks of a call of Event_pend, if they are constants."""
    match bare(value):
        case Call(function=Function(name="Event_pend"), arguments=[_, both, either, _]):
            match bare(both), bare(either):
                case Const(value=int() as together), Const(value=int() as single):
                    return together, single
    return None


def _tested(body: list[Stmt], variable: Variable) -> set[int]:
    """The masks with which a local is combined."""
    found = set()
    for s in body:
        for p in own_nodes(s):
            match p:
                case Binary(op="&", left=left, right=right):
                    match bare(left), bare(right):
                        case (Load(lvalue=lvalue), Const(value=int() as mask)) | (
                            Const(value=int() as mask), Load(lvalue=lvalue)
                        ) if lvalue.root is variable:  # fmt: skip
                            found.add(mask)
    return found
