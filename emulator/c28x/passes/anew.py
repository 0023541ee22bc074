"""Static check of counters that every pass begins anew: `count = 0; count++; if (count >= 64) ...` is never true.

A value that is only set may be a choice of the build (`fast = 1; if (fast)`), and a subscript that is set and counted
may be tested against the end of its array.  A number of passes is neither.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x.arithmetic import COMPARE
from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.tree import Assign, Binary, Compare, Const, Expr, Function, If, Index, Load, LValue, Stmt, Variable
from emulator.c28x.tree_queries import (
    all_blocks,
    bare,
    blocks,
    parts,
    runs_function,
    source_text,
    statements,
    variables,
    within,
)

#: The value of an object, and whether it was counted since it was set.
_Known = tuple[int, bool]
_STEPS: Final = ("+", "-")


def check_begun_anew(function: Function, report: StaticReport) -> None:
    """Report comparisons of counters that are set and counted right before them."""
    subscripts = {v for p in within(function.body) if isinstance(p, Index) for v in variables(parts(p))}
    for block in all_blocks(function.body):
        known: dict[Variable, _Known] = {}
        for s in block:
            if isinstance(s, If) and isinstance(s.test, Compare):
                _compare(function, s, s.test, known, report)
            if blocks(s) or runs_function(s):
                changed = {v for inner in statements([s]) if (v := _target(inner)) is not None}
                opaque = any(map(runs_function, statements([s])))
                known = {} if opaque else {v: value for v, value in known.items() if v not in changed}
            else:
                _follow(s, known)
                for variable in subscripts:
                    known.pop(variable, None)



def _target(s: Stmt) -> Variable | None:
    """The scalar object at file scope that a statement sets."""
    match s:
        case Assign(target=LValue(root=Variable(kind="global", ctype=IntType()) as variable)):
            return variable
    return None


def _follow(s: Stmt, known: dict[Variable, _Known]) -> None:
    """What is known of the objects at file scope after a statement."""
    variable = _target(s)
    if variable is None or not isinstance(s, Assign):
        if isinstance(s, Assign) and isinstance(s.target, LValue) and isinstance(s.target.root, Expr):
            known.clear()  # through a pointer
        return
    before = known.pop(variable, None)
    if variable.volatile or variable.escapes:
        return
    match bare(s.value):
        case Const(value=int(value)):
            known[variable] = value, False
        case Binary(op=op, left=left, right=right) if before is not None and op in _STEPS:
            stepped, by = bare(left), bare(right)
            if isinstance(stepped, Load) and stepped.lvalue.root is variable and isinstance(by, Const):
                known[variable] = int(before[0] + by.value if op == "+" else before[0] - by.value), True


def _compare(function: Function, s: If, test: Compare, known: dict[Variable, _Known], report: StaticReport) -> None:
    for side, other, left in ((test.left, test.right, True), (test.right, test.left, False)):
        load, limit = bare(side), bare(other)
        if not isinstance(load, Load) or not isinstance(load.lvalue.root, Variable) or not isinstance(limit, Const):
            continue
        value, counted = known.get(load.lvalue.root, (0, False))
        if counted:
            outcome = COMPARE[test.op](value, limit.value) if left else COMPARE[test.op](limit.value, value)
            text, name = source_text(test), load.lvalue.root.declaration
            why = f"each pass sets {name.name} anew, and counts it to {value}"
            report.report(
                function, s.where, "constant-condition", f"{text} is always {str(bool(outcome)).lower()}: {why}",
                object=name.path, declaration=name,
            )  # fmt: skip
