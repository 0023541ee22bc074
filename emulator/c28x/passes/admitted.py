"""Static check of casts behind a test that lets more through than the type holds: `narrowed`.

    if (number > 0 && number <= 100000L)
        Period_ms = (Uint16)number;

    if (number > 100000L)
        return REFUSED;
    Period_ms = (Uint16)number;

The test says which values are meant, and the conversion loses some of them.  Only the branch of the test is looked at,
or, if the test refuses the larger ones, what follows it in its block.  Not reported: statements that use the value
otherwise too (its upper word, a remainder), or that test or change it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import Assign, Compare, Convert, Expr, Function, If, Load, Logic, LValue, Not, Stmt
from emulator.c28x.tree_queries import OPPOSITE, TURNED, bare, blocks, leaves, source_text, statements, within

#: A value with an upper limit, the limit, and the test of it.
Limited = tuple[LValue, int, Compare]
#: The largest value that the left side of a comparison may have behind it, less the constant on the right.
_UP_TO: Final = {"<": -1, "<=": 0}


def check_admitted(function: Function, report: StaticReport) -> None:
    """Report the conversions of one function that lose values which the test around them lets through."""
    _block(function, function.body, [], report)


def _block(function: Function, body: list[Stmt], around: list[Limited], report: StaticReport) -> None:
    """`around`: the values that have an upper limit in this block."""
    for number, s in enumerate(body):
        if not isinstance(s, If):
            for inner in blocks(s):
                _block(function, inner, around, report)
            continue
        limits = list(upper_limits(s.test))
        _branch(function, s.then, limits, around, report)
        _block(function, s.then, [*around, *limits], report)
        _block(function, s.otherwise, around, report)
        if leaves(s.then) and not s.otherwise:
            kept = [limit for limit in upper_limits(s.test, holds=False) if not _used_whole(function, limit[0])]
            _branch(function, body[number + 1 :], kept, around, report)
            around = [*around, *kept]


def _branch(
    function: Function, body: list[Stmt], limits: list[Limited], around: list[Limited], report: StaticReport
) -> None:
    """Report what the statements for which `limits` hold cut of these values."""
    for value, limit, test in limits:
        others = [other for known, other, _ in (*around, *limits) if known == value]
        cut = _cut(body, value)
        if cut is not None and cut.ctype.high < min(others):
            kept = f"behind it {source_text(cut.operand)} becomes {cut.ctype}, which holds up to {cut.ctype.high}"
            message = f"{source_text(test)} lets {limit} through, and {kept}"
            report.report(function, test.where, "narrowed", message, object=value.text, value=limit)


def upper_limits(test: Expr, *, holds: bool = True) -> Iterator[Limited]:
    """The upper limits that hold where a test is true, or (`holds`) where it is false."""
    match bare(test):
        case Not(operand=operand):
            yield from upper_limits(operand, holds=not holds)
        case Logic(op=op, operands=operands) if (op == "and") == holds:
            for operand in operands:
                yield from upper_limits(operand, holds=holds)
        case Compare(op=op, left=left, right=right) as compare:
            if not holds:
                op = OPPOSITE.get(op, "")
            if op in (">", ">=") and constant_of(right) is None:
                op, left, right = TURNED[op], right, left
            value, limit = bare(left), constant_of(right)
            if op in _UP_TO and isinstance(value, Load) and limit is not None and isinstance(value.ctype, IntType):
                yield value.lvalue, limit + _UP_TO[op], compare


def _used_whole(function: Function, value: LValue) -> bool:
    """Whether a function uses a value otherwise than in comparisons and casts: its upper word, before the test."""
    cut = tested = 0
    for p in within(function.body):
        match p:
            case Convert(operand=Load(lvalue=lvalue) as whole) if lvalue == value:
                cut += p.explicit or p.ctype.words < whole.ctype.words
            case Compare(left=left, right=right):
                tested += sum(isinstance(side, Load) and side.lvalue == value for side in map(bare, (left, right)))
    return _uses(function.body, value) > cut + tested


def _uses(body: list[Stmt], value: LValue) -> int:
    return sum(isinstance(p, Load) and p.lvalue == value for p in within(body))


def _cut(body: list[Stmt], value: LValue) -> Any:
    """The conversion to fewer bits that is the only use of a value in a block; None: there are others, or none."""
    cuts = [
        p for p in within(body)
        if isinstance(p, Convert) and isinstance(p.operand, Load) and p.operand.lvalue == value
        and isinstance(p.ctype, IntType) and p.ctype.words < p.operand.ctype.words
    ]  # fmt: skip
    uses = _uses(body, value)
    changes = any(isinstance(s, Assign) and s.target == value for s in statements(body))
    return cuts[0] if cuts and len(cuts) == uses and not changes else None
