"""Static check of differences over a time whose count is not begun again: `not-begun-again`.

    ms += SCAN_MS;
    if (ms >= STUCK_MS)
    {
        if (position - watched < STUCK_WAY) ...
        watched = position;
    }

What has changed since the last look is compared, or becomes a speed, and the look is remembered.  Nothing sets `ms` to
0: after the first time each pass looks, and the difference is that of one pass.

The count is a local that a loop only counts up, or an object that the whole program only counts up.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from emulator.c28x.passes.begun_again import is_number, step_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Assign, Binary, Compare, Expr, For, Function, If, Load, LValue, Stmt, Variable, While
from emulator.c28x.tree_queries import addressed, assigned, bare, leaves, source_text, statements, within

_RISES: Final = {">": ">", ">=": ">", "<": "<", "<=": "<"}


def check_spans(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the looks that come in each pass, because their count stays beyond its limit."""
    modules = list(modules)
    functions = [function for module in modules for function in module.functions]
    whole = any(function.name == "main" and function.body for function in functions)
    writes: dict[Variable, list[Stmt]] = {}
    taken: set[Variable] = set()
    for function in functions:
        taken |= addressed(within(function.body))
        for s in statements(function.body):
            if (variable := assigned(s)) is not None:
                writes.setdefault(variable, []).append(s)
    for module, report in reports.items():
        for function in module.functions:
            told: set[int] = set()
            for loop in statements(function.body):
                body = loop.body if isinstance(loop, While | For) else []
                for s in statements(body):
                    if not isinstance(s, If) or id(s) in told:
                        continue
                    count = _passed(s)
                    if count is None or count in taken:
                        continue
                    own = [x for x in statements(body) if assigned(x) is count]
                    if count.kind == "local" and count.plain and _only_up(own, count) and _looks(s):
                        told.add(id(s))
                        _tell(function, s, count, report)
            for s in statements(function.body):
                if whole and isinstance(s, If) and id(s) not in told:
                    count = _passed(s)
                    known = count is not None and is_number(count) and count not in taken and not count.escapes
                    if count is not None and known and _only_up(writes.get(count, []), count) and _looks(s):
                        _tell(function, s, count, report)


def _tell(function: Function, s: If, count: Variable, report: StaticReport) -> None:
    name = count.declaration
    message = (
        f"nothing begins {name.name} again: once it has passed this limit, each pass takes the difference, "
        "which is then that of one pass"
    )
    report.report(function, s.where, "not-begun-again", message, object=name.path, declaration=name)


def _only_up(writes: list[Stmt], count: Variable) -> bool:
    return bool(writes) and all((step_of(s, count) or 0) > 0 for s in writes)


def _passed(s: If) -> Variable | None:
    """The integer that a test alone holds against a limit which it has passed."""
    if isinstance(s.test, Compare) and s.test.op in _RISES:
        rises = _RISES[s.test.op] == ">"
        side, other = (s.test.left, s.test.right) if rises else (s.test.right, s.test.left)
        match bare(side):
            case Load(lvalue=LValue(root=Variable() as count, indices=[])) if (constant_of(other) or 0) > 1:
                return count
    return None


def _looks(s: If) -> bool:
    """Whether a branch takes a difference to what it remembers, and remembers anew."""
    if leaves(s.then):
        return False
    differences = [p for p in within(s.then) if isinstance(p, Binary) and p.op == "-"]
    for x in s.then:
        if isinstance(x, Assign) and isinstance(x.target, LValue):
            kept = source_text(Load(x.target.ctype, x.target))
            now = _text(x.value)
            if any({_text(p.left), _text(p.right)} == {kept, now} for p in differences):
                return True
    return False


def _text(e: Expr) -> str:
    return source_text(bare(e))
