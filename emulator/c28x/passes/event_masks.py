"""Static check of waits for events whose masks do not fit the tests behind them: `event-mask`.

    events = Event_pend(event, TICK | START, Event_Id_NONE, 100);   // the masks are exchanged
    if (events & TICK) ...
    if (events & START) ...

The first mask is for events that must all have come.  Then each single bit is set, and to test them one by one says
nothing: what was meant is the second mask.  Reported where the result is tested for at least two parts of the first
mask, and for nothing of the second.
"""

from __future__ import annotations

from emulator.c28x.passes.report import StaticReport
from emulator.c28x.tree import Binary, Call, Const, Expr, Function, Load, LValue, Stmt, Variable
from emulator.c28x.tree_queries import bare, gives, own_nodes, statements


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
