"""Static check of two limits of a value that leave nothing between them: `limits-crossed`.

    if (integral > LIMIT) integral = LIMIT;
    if (integral < LIMIT) integral = -LIMIT;            // a minus is missing: nothing but LIMIT and -LIMIT is left

The two tests follow each other, in any order, or the second one is the `else` of the first.  The limits are constants,
and one of them is what the value becomes: `if (x > 0) x = 1; if (x < 0) x = -1;` is a sign, and no limit.
"""

from __future__ import annotations

from typing import NamedTuple

from emulator.c28x.passes.report import StaticReport
from emulator.c28x.tree import Assign, Compare, Const, Expr, Function, If, Load, LValue, Stmt
from emulator.c28x.tree_queries import all_blocks, bare, source_text


class _Clamp(NamedTuple):
    """A test behind which a value is set to a constant: the value, whether it was above, the limit, what it becomes."""

    value: LValue
    above: bool
    limit: float
    becomes: float
    test: Expr


def check_clamps(function: Function, report: StaticReport) -> None:
    """Report the pairs of limits of one value of which the lower one is not below the upper one."""
    for block in all_blocks(function.body):
        for number, s in enumerate(block):
            one = _clamp(s, alone=False)
            if one is None or not isinstance(s, If):
                continue
            behind = s.otherwise or block[number + 1 : number + 2]
            other = _clamp(behind[0], alone=True) if len(behind) == 1 else None
            if other is None or other.value != one.value or other.above == one.above:
                continue
            upper, lower = (one, other) if one.above else (other, one)
            applied = [each for each in (upper, lower) if each.becomes == each.limit]
            opposite = upper.limit == lower.limit and upper.becomes == -lower.becomes
            if applied and (upper.limit < lower.limit or opposite):
                name = source_text(other.test.left if isinstance(other.test, Compare) else other.test)
                message = (
                    f"{source_text(upper.test)} gives {upper.becomes:g}, and {source_text(lower.test)} gives "
                    f"{lower.becomes:g}: no other value is left"
                )
                report.report(function, behind[0].where, "limits-crossed", message, object=name)


def _clamp(s: Stmt, *, alone: bool) -> _Clamp | None:
    """The limit that a statement applies; `alone`: without an `else`."""
    match s:
        case If(test=Compare(op="<" | "<=" | ">" | ">=" as op, left=left, right=right) as test, then=[
            Assign(target=LValue() as target, value=value)
        ], otherwise=otherwise):  # fmt: skip
            becomes = _number(value)
            for side, bound, above in ((left, right, op[0] == ">"), (right, left, op[0] == "<")):
                limit, tested = _number(bound), bare(side)
                if limit is None or becomes is None or not isinstance(tested, Load) or tested.lvalue != target:
                    continue
                if not (alone and otherwise):
                    return _Clamp(target, above, limit, becomes, test)
    return None


def _number(e: Expr) -> float | None:
    """The value of a constant; None: it is none."""
    inner = bare(e)
    return inner.value if isinstance(inner, Const) else None
