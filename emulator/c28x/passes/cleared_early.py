"""Static check of counts that are cleared before they are used: `cleared-early`.

    edges = 0;
    rate = edges * PER_SECOND;          // always 0

Other functions count the object up, and this one uses it only behind its own clear, in the same block and with nothing
between that runs other functions.  Reported is a use as a factor, as a dividend, or in a comparison: whoever shows a
count that was just cleared may mean the 0, and a loop may wait until it has been counted (`n = 0; while (n < 5);`).
"""

from __future__ import annotations

from collections.abc import Iterable

from emulator.c28x.passes.report import StaticReport
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Compare,
    Const,
    Declare,
    Expr,
    For,
    Function,
    Load,
    LValue,
    Stmt,
    Variable,
    While,
)
from emulator.c28x.tree_queries import added, all_blocks, assigned, bare, own_nodes, runs_function, statements


def check_cleared_early(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the uses of counts that their function has just cleared."""
    counted: dict[Variable, set[str]] = {}
    for module in modules:
        for function in module.functions:
            for s in statements(function.body):
                variable = assigned(s) if added(s) is not None else None
                if variable is not None and variable.kind == "global":
                    counted.setdefault(variable, set()).add(function.path)
    for module, report in reports.items():
        for function in module.functions:
            _check(function, {v for v, paths in counted.items() if function.path not in paths}, report)


def _check(function: Function, counts: set[Variable], report: StaticReport) -> None:
    body = list(statements(function.body))
    for block in all_blocks(function.body):
        for n, clear in enumerate(block):
            match clear:
                case Assign(target=LValue(root=Variable() as variable, indices=[]), value=value) if variable in counts:
                    cleared = bare(value)
                    if not isinstance(cleared, Const) or cleared.value != 0:
                        continue
                    behind = block[n + 1 :]
                    use = _use(behind, variable)
                    later = {id(s) for s in statements(behind)}
                    alone = all(assigned(s) is not variable for s in body if s is not clear)
                    if use is not None and alone and not any(_reads(s, variable) for s in body if id(s) not in later):
                        name = variable.declaration.name
                        message = f"{name} is 0 here: line {clear.where.line} has just cleared it"
                        report.report(function, use.where, "cleared-early", message, object=variable.declaration.path)


def _use(behind: list[Stmt], variable: Variable) -> Stmt | None:
    """The first statement behind a clear, if nothing runs in between, that computes with the object."""
    for s in behind:
        if isinstance(s, While | For) or runs_function(s):
            return None  # it may wait for the count
        for part in own_nodes(s):
            match part:
                case Binary(op="*", left=left, right=right) if _is(left, variable) or _is(right, variable):
                    return s
                case Binary(op="/", left=left) | Compare(left=left) if _is(left, variable):
                    return s
        if not isinstance(s, Assign | Declare):
            return None
    return None


def _is(e: Expr, variable: Variable) -> bool:
    match bare(e):
        case Load(lvalue=LValue(root=root, indices=[])):
            return root is variable
    return False


def _reads(s: Stmt, variable: Variable) -> bool:
    return any(isinstance(part, Load) and part.lvalue.root is variable for part in own_nodes(s))
