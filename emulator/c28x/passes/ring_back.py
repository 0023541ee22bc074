"""Static check of subscripts that go back from the index of a ring, and not around its end: `table-short`.

    Next = (Next + 1) % EVENTS;
    ...
    Events[Next - back]                     // Events[(Next + EVENTS - back) % EVENTS]

The index gets nothing but 0 and such steps, over the whole ring.  So it is 0 now and then, and the subscript negative
(or, unsigned, 65535).  Silent if the function tests the index, or if the way back is computed from it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.given import GivenValues
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Binary,
    Compare,
    Conditional,
    Expr,
    For,
    Function,
    If,
    Load,
    LValue,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import NamedScalar, bare, named_scalar, own_nodes, parts, source_text, statements


def check_ring_back(reports: dict[Module, StaticReport], given: GivenValues) -> None:
    """Report the subscripts that are below the first element of a ring once its index has begun again."""
    for module, report in reports.items():
        for function in module.functions:
            for s in statements(function.body):
                for lvalue in own_nodes(s):
                    if isinstance(lvalue, LValue) and isinstance(lvalue.root, Variable):
                        for index in lvalue.indices:
                            if index.bound and _goes_back(function, index.expr, index.bound, given):
                                _report(function, s, lvalue, index.expr, report)


def _report(function: Function, s: Stmt, lvalue: LValue, index: Expr, report: StaticReport) -> None:
    assert isinstance(lvalue.root, Variable)
    difference, name = bare(index), lvalue.root.declaration
    assert isinstance(difference, Binary)
    text = source_text(difference.left)
    message = f"{source_text(index)} is below the first element of {name.name} when {text} has begun again at 0"
    report.report(function, s.where, "table-short", message, object=name.path, declaration=name)


def _goes_back(function: Function, index: Expr, bound: int, given: GivenValues) -> bool:
    """Whether a subscript is the index of a ring of so many elements, less something else."""
    difference = bare(index)
    if not isinstance(difference, Binary) or difference.op != "-":
        return False
    at, back = bare(difference.left), bare(difference.right)
    if not isinstance(at, Load) or not isinstance(at.ctype, IntType) or not isinstance(at.lvalue.root, Variable):
        return False
    ring = named_scalar(at.lvalue)
    if ring is None or not _runs_around(ring, bound, given) or any(_has(test, ring) for test in _tests(function)):
        return False
    if isinstance(back, Load):
        way = named_scalar(back.lvalue)
        known = given.of(way) if way is not None else []
        return bool(known) and not any(
            not isinstance(one.by, For) if one.value is None else _has(one.value, ring) for one in known
        )
    return (constant_of(back) or 0) > 0


def _runs_around(ring: NamedScalar, bound: int, given: GivenValues) -> bool:
    """Whether a scalar gets 0, and its own value and 1 more, around the end of so many elements."""
    steps = 0
    for one in given.of(ring):
        if one.value is not None and constant_of(one.value) == 0:
            continue
        match bare(one.value) if one.value is not None else None:
            case Binary(op="%" | "&" as op, left=left, right=right) if constant_of(right) == bound - (op == "&"):
                match bare(left):
                    case Binary(op="+", left=old, right=step) if constant_of(step) == 1 and _has(old, ring):
                        steps += 1
                        continue
        return False
    return steps > 0


def _tests(function: Function) -> Iterator[Any]:
    for s in statements(function.body):
        yield from (p for p in own_nodes(s) if isinstance(p, Compare))
        yield from (p.test for p in own_nodes(s) if isinstance(p, Conditional))
        match s:
            case If(test=test) | While(test=test) | For(stop=test) | Switch(subject=test):
                yield test


def _has(e: Any, scalar: NamedScalar) -> bool:
    return any(isinstance(p, LValue) and named_scalar(p) == scalar for p in parts(e))
