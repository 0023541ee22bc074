"""Static check of switches over what a function returns that lack a case for one of its results: `no-case`.

    duty = FULL;
    switch (zone()) {           // zone() also returns STOP
    case SLOW: duty = HALF; break;
    case FREE: break;           // says that FREE keeps the value
    }

Many switches leave constants out on purpose.  This list seems meant to be complete: each case sets the same object or
says that it stays, at least one says so, and one constant alone is missing.  Silent if the value that stays is 0; if
the name of the constant, or a remark, says that it is what is left (`ZONE_NONE`, `/* others: full */`); if anything
else sets the object; and if the function or one that calls it asks before for what decides the result.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any, Final, NamedTuple

from emulator.c28x.passes.declared import lines_from, words_of
from emulator.c28x.passes.guards import flags
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Call,
    Conditional,
    Const,
    Declare,
    Expr,
    For,
    Function,
    If,
    Load,
    LValue,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import all_blocks, bare, blocks, own_nodes, parts, source_text, statements, within

#: Words of constants for which nothing needs to be done.
_NOTHING: Final = frozenset({
    "none", "nothing", "no", "nil", "idle", "unknown", "undefined", "unset", "invalid", "other", "others", "default",
    "normal", "usual", "unused", "reserved", "any", "count", "keine", "nichts", "ninguno", "ninguna", "nada",
})  # fmt: skip
#: Remarks on the constants without a case.
_REMARK: Final = re.compile(
    r"(?://|/\*).*\b(?:others?|rest|else|otherwise|default|any|all|no case|without|keeps?|stays?|unless)\b",
    re.IGNORECASE,
)


class _Choice(NamedTuple):
    """A switch over a result of a function, before which an object gets a value that one of the cases keeps."""

    switch: Switch
    asked: Function
    target: LValue
    start: Const
    #: The local that holds the result; None: the switch calls the function itself.
    kept_in: Variable | None


def check_left_out(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the switches without a case for a constant that the function returns whose result they are over."""
    modules = list(modules)
    functions = [function for module in modules for function in module.functions]
    for module in modules:
        for function in module.functions:
            for choice in _choices(function):
                left = choice.switch.left or {}
                missing = [value for value in left if value in _results(choice.asked)]
                if len(missing) != 1 or len(left) > len(choice.switch.cases):
                    continue
                name = left[missing[0]]
                if _NOTHING & {*words_of(name)} or _says(choice, name) or _decided_before(choice, function, functions):
                    continue
                message = (
                    f"{choice.asked.name}() returns {name}, too, which has no case: {choice.target.text} keeps "
                    f"{source_text(choice.start)}"
                )
                reports[module].report(
                    function, choice.switch.where, "no-case", message, object=choice.target.text, value=missing[0]
                )


def _choices(function: Function) -> Iterator[_Choice]:
    for block in all_blocks(function.body):
        for at, s in enumerate(block):
            if not isinstance(s, Switch) or not s.left:
                continue
            before = list(reversed(block[max(at - 2, 0) : at]))
            asked, kept_in = _asked(s.subject, before)
            for x in before:
                target, start = _set(x)
                if asked is None or target is None or start is None or not constant_of(start):
                    continue
                sets = [id(each) for each in statements(function.body) if _set(each)[0] == target]
                inside = [id(each) for _, body in s.cases for each in body if _set(each)[0] == target]
                if _keeps_one(s, target, start) and set(sets) == {id(x), *inside}:
                    yield _Choice(s, asked, target, start, kept_in)


def _asked(subject: Expr, before: list[Stmt]) -> tuple[Function | None, Variable | None]:
    """The function whose result a switch is over, and the local that holds it, if it is set right before."""
    match bare(subject):
        case Call(function=function, arguments=[]):
            return function, None
        case Load(lvalue=LValue(root=Variable(in_memory=False, kind="local") as local, indices=[])):
            for s in before:
                match s:
                    case Assign(target=LValue(root=root), value=value) | Declare(variable=root, value=Expr() as value):
                        match bare(value):
                            case Call(function=function, arguments=[]) if root is local:
                                return function, local
    return None, None


def _set(s: Stmt) -> tuple[LValue | None, Const | None]:
    """The object that a statement sets, and the constant that it gets."""
    match s:
        case Assign(target=LValue() as target, value=value):
            pass
        case Declare(variable=variable, value=Expr() as value):
            target = LValue(variable.ctype, variable, text=variable.declaration.name)
        case _:
            return None, None
    inner = bare(value)
    return target, inner if isinstance(inner, Const) else None


def _keeps_one(s: Switch, target: LValue, start: Const) -> bool:
    """Whether each case gives an object a constant or does nothing, and at least one says that it stays as it is."""
    stays = changes = False
    labels = [value for values, _ in s.cases for value in values or ()]
    if any(values is None for values, _ in s.cases) or flags(labels):
        return False
    for _, body in s.cases:
        given = [_set(x) for x in body]
        if body and (len(body) != 1 or given[0][0] != target or given[0][1] is None):
            return False
        same = not body or (given[0][1] is not None and given[0][1].value == start.value)
        stays, changes = stays or same, changes or not same
    return stays and changes


def _results(function: Function) -> set[int]:
    """The constants that a function returns, also by a local that it sets to them in some cases."""
    found: set[int] = set()
    for s in statements(function.body):
        if isinstance(s, Return) and s.value is not None:
            found |= _constants(s.value)
            match bare(s.value):
                case Load(lvalue=LValue(root=Variable(in_memory=False, kind="local") as local, indices=[])):
                    for test in statements(function.body):
                        for block in blocks(test) if isinstance(test, If) else ():
                            for x in block:
                                target, value = _set(x)
                                if target is not None and target.root is local and value is not None:
                                    found |= _constants(value)
    return found


def _constants(e: Expr) -> set[int]:
    inner = bare(e)
    if isinstance(inner, Conditional):
        return _constants(inner.then) | _constants(inner.otherwise)
    value = constant_of(inner)
    return set() if value is None else {value}


def _says(choice: _Choice, name: str) -> bool:
    """Whether the text of a switch names a constant that has no case, or a remark there says what the others do."""
    where = choice.switch.where
    start = max(where.line - 2, 1)
    last = max((s.line for s in statements([choice.switch])), default=where.line) + 2
    for number, line in lines_from(where.file, start):
        if number > last:
            break
        if name in line or _REMARK.search(line):
            return True
    return False


def _decided_before(choice: _Choice, function: Function, functions: list[Function]) -> bool:
    """Whether another test asks for what decides the result, in a function or in those that call it."""
    deciding = {p.root for p in within(choice.asked.body) if _is_shared(p)}
    if choice.kept_in is not None:
        deciding.add(choice.kept_in)
    callers = [f for f in functions if any(isinstance(p, Call) and p.function is function for p in within(f.body))]
    for f in (function, *callers):
        for s in statements(f.body):
            if s is choice.switch:
                continue
            tests = [s.test] if isinstance(s, If | While) else [s.subject] if isinstance(s, Switch) else []
            tests += [s.stop] if isinstance(s, For) else []
            tests += [p.test for p in own_nodes(s) if isinstance(p, Conditional)]
            for p in (p for test in tests for p in parts(test)):
                if isinstance(p, Call) and not p.function.extern:
                    return True
                if isinstance(p, LValue) and p.root in deciding:
                    return True
    return False


def _is_shared(node: Any) -> bool:
    return isinstance(node, LValue) and isinstance(node.root, Variable) and node.root.kind == "global"
