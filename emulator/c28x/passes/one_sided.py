"""Static check of objects and states that only one half of the program knows: `one-sided`.

The check needs a whole program (one with a `main`), because it must see all statements.

* A `static` integer that begins with 0 is tested or computed with, and no statement writes it.
* A `static` integer is counted and set back, or only set back beside others that are counted, and nothing but its own
  count reads it.
* A `static` integer is counted up on some condition, held against a limit, and nothing begins it again.
* A state has a case, or is asked for, and no statement gives it to its object.

A number of events is only counted, and nothing asks for a limit; a debugger may set an object that is not `static`:
both are not meant.  Nor are switches for tests, by their names.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final

from emulator.c28x.passes.begun_again import is_latched, is_number, step_of
from emulator.c28x.passes.declared import line_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import StateValues, constant_of, named, start_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Conditional,
    Const,
    Evaluate,
    Expr,
    Function,
    If,
    Index,
    Load,
    Logic,
    LValue,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    addressed,
    all_blocks,
    assigned,
    bare,
    blocks,
    own_nodes,
    parts,
    roots,
    source_text,
    statements,
    within,
)

#: Names of objects that are set by hand, with a debugger.
_BY_HAND: Final = re.compile(r"debug|test|sim|trace|verbose|enable|option|config|dbg", re.IGNORECASE)
#: Names of numbers that stay 0 until somebody measures them: they are no defect where they are only computed with.
_ADJUSTED: Final = re.compile(r"offset|trim|cal|gain|bias|corr|adjust|default|scale|factor|zero", re.IGNORECASE)
_STATIC: Final = re.compile(r"\bstatic\b")


def check_one_sided(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report what only one half of a whole program knows."""
    modules = list(modules)
    functions = [function for module in modules for function in module.functions]
    if not any(function.name == "main" and function.body for function in functions):
        return
    writes: dict[Variable, list[Stmt]] = {}
    taken: set[Variable] = set()
    for function in functions:
        taken |= addressed(within(function.body))
        for s in statements(function.body):
            if (variable := assigned(s)) is not None:
                writes.setdefault(variable, []).append(s)
    counts = {v for v, assigns in writes.items() if any(step_of(s, v) for s in assigns)}
    values = StateValues(functions)
    owners = {function: report for module, report in reports.items() for function in module.functions}
    asked = _asked(functions)
    for module in modules:
        report = reports[module]
        for variable in module.variables:
            if not is_number(variable) or variable in taken or variable.escapes or module.brought:
                continue
            if _is_static(variable) and not _BY_HAND.search(variable.declaration.name):
                if variable not in writes and start_of(variable) == 0:
                    _never_written(variable, module.functions, report)
                elif _begins_again(writes.get(variable, []), variable):
                    _never_read(variable, functions, report, "counted and set back")
                elif _only_set_back(writes.get(variable, []), variable) and _beside(variable, counts, functions):
                    _never_read(variable, functions, report, "only set back")
                elif variable in writes and all(_goes_up(s, variable) for s in writes[variable]):
                    _only_up(variable, counts, functions, values, owners)
            if variable in writes and variable.constants and variable in asked:
                _never_entered(variable, asked[variable], values, owners)


def _never_written(variable: Variable, functions: list[Function], report: StaticReport) -> None:
    """Report the first test of an object that is always 0; if none tests it, the first use of its value."""
    used: tuple[Function, Stmt] | None = None
    name = variable.declaration
    for function in functions:
        for s in statements(function.body):
            for test in _tests(s):
                if _mentions(test, variable):
                    message = f"no statement writes {name.name}: it is always 0 in {source_text(test)}"
                    report.report(function, s.where, "one-sided", message, object=name.path, declaration=name)
                    return
            if used is None and _computes_with(s, variable):
                used = function, s
    if used is not None and not variable.volatile and not _ADJUSTED.search(name.name):
        message = f"no statement writes {name.name}: it is always 0 here"
        report.report(used[0], used[1].where, "one-sided", message, object=name.path, declaration=name)


def _computes_with(s: Stmt, variable: Variable) -> bool:
    """Whether a statement uses the value of an object; `(void) x;` does not."""
    named_alone = isinstance(s, Evaluate) and isinstance(bare(s.value), Load)
    return not named_alone and any(_mentions(root, variable) for root in roots(s))


def _tests(s: Stmt) -> Iterator[Expr]:
    """The conditions of a statement."""
    match s:
        case If(test=test) | While(test=test) | Switch(subject=test):
            yield test
    for p in own_nodes(s):
        if isinstance(p, Conditional):
            yield p.test


def _begins_again(writes: list[Stmt], variable: Variable) -> bool:
    """Whether an object is both counted and set to a constant."""
    counted = again = False
    for s in writes:
        value = bare(s.value) if isinstance(s, Assign) else None
        ways = [value.then, value.otherwise] if isinstance(value, Conditional) else [value]
        again |= any(constant_of(way) is not None for way in ways)
        counted |= step_of(s, variable) is not None or (isinstance(value, Conditional) and _mentions(value, variable))
    return counted and again


def _mentions(e: Any, variable: Variable) -> bool:
    return any(isinstance(p, LValue) and p.root is variable for p in parts(e))


def _only_set_back(writes: list[Stmt], variable: Variable) -> bool:
    """Whether statements only give an object the constant with which it begins."""
    return bool(writes) and all(isinstance(s, Assign) and constant_of(s.value) == start_of(variable) for s in writes)


def _beside(variable: Variable, counts: set[Variable], functions: list[Function]) -> bool:
    """Whether an object is set back beside others that are counted."""
    for block in (block for function in functions for block in all_blocks(function.body)):
        back = {assigned(s) for s in block if isinstance(s, Assign) and constant_of(s.value) is not None}
        if variable in back and back & counts:
            return True
    return False


def _never_read(variable: Variable, functions: list[Function], report: StaticReport, how: str) -> None:
    """Report an object that only its own count reads; `how` it is written."""
    first: tuple[Function, Stmt] | None = None
    for function in functions:
        for s in statements(function.body):
            own = assigned(s) is variable
            if own and (first is None or constant_of(getattr(first[1], "value", None)) is not None):
                first = function, s
            for root in roots(s):
                reads = sum(
                    isinstance(p, LValue) and getattr(p.root, "declaration", None) == variable.declaration
                    for p in parts(root)
                )  # fmt: skip
                if reads and not own:
                    return
    if first is not None:
        name = variable.declaration
        message = f"{name.name} is {how}, and nothing reads it: what it is for may be missing"
        report.report(first[0], first[1].where, "one-sided", message, object=name.path, declaration=name)


def _goes_up(s: Stmt, variable: Variable) -> bool:
    """Whether a statement adds something to an object, and nothing else."""
    if (by := step_of(s, variable)) is not None:
        return by > 0
    value = bare(s.value) if isinstance(s, Assign) else None
    if not isinstance(value, Binary) or value.op != "+":
        return False
    return any(named(side) is variable for side in (value.left, value.right))


def _only_up(
    variable: Variable, counts: set[Variable], functions: list[Function], values: StateValues,
    reports: dict[Function, StaticReport],
) -> None:  # fmt: skip
    """Report the limit of a count of what happens now and then, if nothing begins the count again.

    Silent about a delay after the start, which counts always, each time another count is full, up to its own limit, or
    in a state that is never entered again; about an index, a clock, and a count that is handed on.
    """
    now_and_then = False
    limit: tuple[Function, Stmt, Compare] | None = None
    for function in functions:
        for s, tests in _with_tests(function.body, []):
            if assigned(s) is variable:
                regular = all(_mentions(test, variable) or _of_counts(test, counts) for test in tests)
                now_and_then |= not regular and all(_holds_again(test, values) for test in tests)
            for p in own_nodes(s):
                match p:
                    case Index(expr=inner) | Call(arguments=inner) if _used(inner, variable):
                        return
                    case Binary(op="-") if _mentions(p, variable):
                        return
                    case Compare(left=left, right=right):
                        for side, other in ((left, right), (right, left)):
                            if (constant_of(other) or 0) > 1 and _mentions(side, variable) and limit is None:
                                limit = function, s, p
    if now_and_then and limit is not None and not is_latched(variable):
        function, s, compare = limit
        name = variable.declaration
        message = (
            f"{name.name} only goes up: once it has passed the limit, {source_text(compare)} never changes again, "
            "whatever comes between"
        )
        reports[function].report(function, s.where, "one-sided", message, object=name.path, declaration=name)


def _used(e: Any, variable: Variable) -> bool:
    """Whether an object itself is used, and not only a comparison of it."""
    if isinstance(e, list):
        return any(_used(each, variable) for each in e)
    compared = {id(q) for p in parts(e) if isinstance(p, Compare) for q in parts(p)}
    return any(
        getattr(p.root, "declaration", None) == variable.declaration  # or its old value, of `x++`
        for p in parts(e) if isinstance(p, LValue) and id(p) not in compared
    )  # fmt: skip


def _of_counts(test: Expr, counts: set[Variable]) -> bool:
    """Whether a test asks for counts alone, as of a clock that is divided."""
    every = parts(test)
    asked = [p.root for p in every if isinstance(p, LValue)]
    counted = bool(asked) and all(isinstance(root, Variable) and root in counts for root in asked)
    return counted and not any(isinstance(p, Call) for p in every)


def _with_tests(body: list[Stmt], tests: list[Expr]) -> Iterator[tuple[Stmt, list[Expr]]]:
    """Every statement, with the conditions around it."""
    for s in body:
        yield s, tests
        if isinstance(s, Switch):
            ctype = s.subject.ctype
            for labels, case in s.cases:
                one_of: list[Expr] = [Compare(ctype, "==", s.subject, Const(ctype, each)) for each in labels or ()]
                yield from _with_tests(case, [*tests, Logic(ctype, "or", one_of)])
            continue
        around = [*tests, s.test] if isinstance(s, If | While) and not isinstance(s.test, Const) else tests
        for block in blocks(s):
            yield from _with_tests(block, around)


def _holds_again(test: Expr, values: StateValues) -> bool:
    """Whether a test may be true again.  One for the state at the start is not, if no statement gives that again."""
    if isinstance(test, Logic) and test.operands:
        some = any if test.op == "or" else all
        return some(_holds_again(each, values) for each in test.operands)
    if isinstance(test, Compare) and test.op == "==":
        for side, other in ((test.left, test.right), (test.right, test.left)):
            if (state := named(side)) is not None and (label := constant_of(other)) is not None:
                given = values.of(state)
                return not given or label in given  # what no statement gives at all, something else may
    return True


#: Where a value of an object has a case, or is asked for.
_Asked = tuple[Function, Stmt, int]


def _asked(functions: list[Function]) -> dict[Variable, list[_Asked]]:
    """The objects of switches and of tests for equality with constants."""
    found: dict[Variable, list[_Asked]] = {}
    for function in functions:
        for s in statements(function.body):
            if isinstance(s, Switch) and (v := named(s.subject)) is not None:
                cases = [(label, body) for labels, body in s.cases for label in labels or ()]
                found.setdefault(v, []).extend((function, body[0] if body else s, label) for label, body in cases)
            for p in own_nodes(s):
                if isinstance(p, Compare) and p.op == "==":
                    for side, other in ((p.left, p.right), (p.right, p.left)):
                        v, label = named(side), constant_of(other)
                        if v is not None and label is not None:
                            found.setdefault(v, []).append((function, s, label))
    return found


def _never_entered(
    variable: Variable, asked: list[_Asked], values: StateValues, reports: dict[Function, StaticReport]
) -> None:
    """Report cases and comparisons for values that no statement gives to an object."""
    given = values.of(variable)
    if given is None or len(given) < 2:
        return
    told: set[int] = set()
    for function, s, label in asked:
        if label not in given | {start_of(variable)} | told:
            told.add(label)
            name = variable.declaration
            message = f"no statement gives {name.name} the value {label}, which is handled here"
            reports[function].report(function, s.where, "one-sided", message, object=name.path, declaration=name)


def _is_static(v: Variable) -> bool:
    """Whether only its own file, or function, knows an object at file scope."""
    declaration = v.declaration
    if declaration.function:
        return True
    line = line_of(declaration)
    return line.startswith("_") if Path(declaration.file).suffix == ".py" else _STATIC.search(line) is not None
