"""Static check of casts behind a test that lets more through than the type holds: `narrowed`.

    if (number > 0 && number <= 100000L)
        Period_ms = (Uint16)number;

The test says which values are meant, and the conversion loses some of them.  Only the branch of the test is looked at.
Not reported: a branch that uses the value otherwise too (its upper word, a remainder), or that tests or changes it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import Assign, Compare, Convert, Expr, Function, If, Load, Logic, LValue, Stmt
from emulator.c28x.tree_queries import bare, blocks, source_text, statements, within

#: A value with an upper limit, the limit, and the test of it.
Limited = tuple[LValue, int, Compare]
#: The largest value that the left side of a comparison may have behind it, less the constant on the right.
_UP_TO: Final = {"<": -1, "<=": 0}
_TURNED: Final = {">": "<", ">=": "<="}


def check_admitted(function: Function, report: StaticReport) -> None:
    """Report the conversions of one function that lose values which the test around them lets through."""
    _block(function, function.body, [], report)


def _block(function: Function, body: list[Stmt], around: list[Limited], report: StaticReport) -> None:
    """`around`: the values that have an upper limit in this block."""
    for s in body:
        if not isinstance(s, If):
            for inner in blocks(s):
                _block(function, inner, around, report)
            continue
        limits = list(_limits(s.test))
        for value, limit, test in limits:
            others = [other for known, other, _ in (*around, *limits) if known == value]
            cut = _cut(s.then, value)
            if cut is not None and cut.ctype.high < min(others):
                kept = f"behind it {source_text(cut.operand)} becomes {cut.ctype}, which holds up to {cut.ctype.high}"
                message = f"{source_text(test)} lets {limit} through, and {kept}"
                report.report(function, test.where, "narrowed", message, object=value.text, value=limit)
        _block(function, s.then, [*around, *limits], report)
        _block(function, s.otherwise, around, report)


def _limits(test: Expr) -> Iterator[Limited]:
    """The upper limits that hold where a test is true."""
    match bare(test):
        case Logic(op="and", operands=operands):
            for operand in operands:
                yield from _limits(operand)
        case Compare(op=op, left=left, right=right) as compare:
            if op in _TURNED:
                op, left, right = _TURNED[op], right, left
            value, limit = bare(left), constant_of(right)
            if op in _UP_TO and isinstance(value, Load) and limit is not None and isinstance(value.ctype, IntType):
                yield value.lvalue, limit + _UP_TO[op], compare


def _cut(body: list[Stmt], value: LValue) -> Any:
    """The conversion to fewer bits that is the only use of a value in a block; None: there are others, or none."""
    cuts = [
        p for p in within(body)
        if isinstance(p, Convert) and isinstance(p.operand, Load) and p.operand.lvalue == value
        and isinstance(p.ctype, IntType) and p.ctype.words < p.operand.ctype.words
    ]  # fmt: skip
    uses = sum(isinstance(p, Load) and p.lvalue == value for p in within(body))
    changes = any(isinstance(s, Assign) and s.target == value for s in statements(body))
    return cuts[0] if cuts and len(cuts) == uses and not changes else None
