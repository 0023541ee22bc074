"""Static check of ends of a time that wrap before the time that a function is given does: `stamp-compare`.

    int Log_Due(Uint16 now)
    {
        if (now < last + PERIOD)                /* right: (Uint16)(now - last) < PERIOD */
            return 0;
        last = now;

    if (now < next)  ...  next = now + PERIOD;  /* right: (int16)(now - next) < 0 */

Nothing in the image calls the function, or only with what another one is given, as in a driver.  What it is given is a
time of 16 bits by its name, and by the object at file scope that keeps it.  The mirror for times that the image counts
itself is `Stamps.ends`.  Silent if the function compares the two without a distance, or subtracts one from the other:
it may handle the wrap.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Binary, Call, Compare, Expr, Function, FunctionRef, Load, LValue, Stmt, Variable
from emulator.c28x.tree_queries import (
    addressed,
    assigned_variables,
    bare,
    given_values,
    own_nodes,
    parts,
    source_text,
    statements,
    within,
)

#: Names of times that go on as long as the program runs: English, German, Spanish.
_TIME: Final = re.compile(
    r"^(?!.*(?:_s$|sec|min|hour|stunde|hora)).*(?:now|tick|millis|(?<![a-z])ms(?![a-z])|jetzt|ahora)", re.IGNORECASE
)  # fmt: skip


#: A comparison that asks for the order of two values.
_ORDERS: Final = ("<", "<=", ">", ">=")
#: CHOICE: how many functions pass a time on.
_DEPTH: Final = 3


def check_given_times(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the comparisons of a time that a function is given with an end that wraps before it."""
    owners = {function: reports[module] for module in modules for function in module.functions}
    given: dict[Variable, list[Expr]] = {}
    for function in owners:
        for target, value in given_values(function.body):
            if isinstance(target.root, Variable) and target.root.kind == "global":
                given.setdefault(target.root, []).append(value)
    times = _given_times(list(owners))
    pointed = addressed(p for function in owners for p in within(function.body))
    for function, report in owners.items():
        fixed = assigned_variables(function.body) | pointed
        for now in function.parameters:
            if now in fixed or now not in times:
                continue
            kept: dict[Variable, bool] = {}
            for v, values in given.items():
                distances = {_distance(value, now) for value in values} - {None}
                if v not in pointed and _is_word(v) and all(map(_is_time, values)) and distances:
                    kept[v] = distances == {True}
            for s, compare in _wrapping(function, now, kept):
                text = source_text(compare)
                message = (
                    f"{text}: the end of the time wraps before {now.declaration.name} does, and the comparison is "
                    "wrong then"
                )
                report.report(function, s.where, "stamp-compare", message, object=text)


def _given_times(functions: list[Function]) -> set[Variable]:
    """The parameters that get a time from outside of the image, also through other functions of it."""
    passed: dict[Variable, list[Variable | None]] = {}
    inner: set[str] = set()
    for p in (p for function in functions for p in within(function.body)):
        if isinstance(p, FunctionRef):
            inner.add(p.function.path)
        elif isinstance(p, Call):
            inner.add(p.function.path)
            for parameter, argument in zip(p.function.parameters, p.arguments, strict=False):
                passed.setdefault(parameter, []).append(_variable(argument))
    named = [
        (function, v) for function in functions for v in function.parameters
        if _is_word(v) and _TIME.search(v.declaration.name)
    ]  # fmt: skip
    times = {v for function, v in named if function.path not in inner}
    for _ in range(_DEPTH):
        times |= {v for _, v in named if v in passed and times.issuperset(passed[v])}
    return times


def _is_word(v: Variable) -> bool:
    return isinstance(v.ctype, IntType) and v.ctype.bits == 16 and not v.ctype.signed


def _variable(e: Expr) -> Variable | None:
    """The variable of which an expression is just the value."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable() as root, indices=[])):
            return root
    return None


def _distance(e: Expr, v: Variable) -> bool | None:
    """Whether an expression is a variable plus or minus a number that is not 0; False: the variable; None: neither."""
    match bare(e):
        case Binary(op="+" | "-" as op, left=left, right=right, ctype=IntType(bits=16)):
            other = right if _variable(left) is v else left if op == "+" and _variable(right) is v else None
            number = constant_of(other)
            return True if number is not None and number != 0 else None
    return False if _variable(e) is v else None


def _is_time(value: Expr) -> bool:
    """Whether an object gets a number, a time that a function is given, or the end of one."""
    named = {p.root for p in parts(value) if isinstance(p, LValue) and isinstance(p.root, Variable)}
    return all(v.kind == "parameter" and _TIME.search(v.declaration.name) for v in named)


def _wrapping(function: Function, now: Variable, kept: dict[Variable, bool]) -> Iterator[tuple[Stmt, Compare]]:
    """The comparisons of a time with a time that is kept, with a distance; none of one that is handled otherwise.

    `kept`: the objects that keep the time, and whether they keep its end.
    """
    found: list[tuple[Stmt, Compare, Variable]] = []
    handled: set[Variable] = set()
    for s in statements(function.body):
        for p in own_nodes(s):
            if not isinstance(p, Compare | Binary):
                continue
            for v, end in kept.items():
                one, other = _distance(p.left, now), _distance(p.right, v)
                if one is None or other is None:
                    one, other = _distance(p.left, v), _distance(p.right, now)
                if one is None or other is None:
                    continue
                if isinstance(p, Compare) and p.op in _ORDERS and (one != other or (end and not one)) and _narrow(p):
                    found.append((s, p, v))
                elif isinstance(p, Binary) or one == other:
                    handled.add(v)
    yield from ((s, p) for s, p, v in found if v not in handled)


def _narrow(e: Compare) -> bool:
    return isinstance(e.left.ctype, IntType) and e.left.ctype.bits == 16 and not e.left.ctype.signed
