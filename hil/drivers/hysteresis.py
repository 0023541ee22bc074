"""Finds two limits that a hysteresis should part, and that are one: `no-hysteresis`.

    if (temperature < SET_TENTHS - HYST_TENTHS) heater = 1;
    ...
    if (temperature > SET_TENTHS - HYST_TENTHS) heater = 0;     // the sign is that of the other limit

A value is compared below a limit in one test, and above the same limit in another one of the same function.  That alone
is no defect; but the limit is made with a constant that its name calls a hysteresis.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Binary, Compare, Const, Expr, Load
from emulator.c28x.tree_queries import bare, own_nodes, source_text, statements
from hil.drivers.stated_units import as_written, defined_number
from hil.drivers.units import UnitMismatch

_NAME: Final = re.compile(r"hyst|hist(?:e|é)r|dead_?band|totband|banda_?muerta", re.IGNORECASE)
#: A value, and a limit of it as the source has it.
_Limit = tuple[str, str]


def equal_limits(modules: Iterable[Module]) -> Iterator[UnitMismatch]:
    """The tests of a value against a limit with a hysteresis that another test has for the other direction."""
    for function in (function for module in modules for function in module.functions):
        below: dict[_Limit, int] = {}
        above: dict[_Limit, int] = {}
        for s in statements(function.body):
            tests = [found for p in own_nodes(s) if isinstance(p, Compare) and (found := _limit(p)) is not None]
            for limit, name, falls in tests:
                if any(other == limit and down != falls for other, _, down in tests):
                    continue  # `x >= limit && x <= limit` is a window
                (below if falls else above).setdefault(limit, s.where.line)
                other = (above if falls else below).get(limit)
                if other is not None:
                    value, text = limit
                    message = (
                        f"{value} is compared with {text} in both directions (the other test is in line {other}): "
                        f"{name} does not part the two limits"
                    )
                    place = Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column)
                    yield UnitMismatch(place, message, value, "no-hysteresis")


def _limit(test: Compare) -> tuple[_Limit, str, bool] | None:
    """A value with its limit, the name of the hysteresis in this, and whether the test is for values below it."""
    if test.op not in ("<", "<=", ">", ">="):
        return None
    for value, limit, falls in ((test.left, test.right, test.op[0] == "<"), (test.right, test.left, test.op[0] == ">")):
        text = _text(limit) if _is_sum(limit) else ""  # a dead band alone is one limit: inside, and outside
        named = [name for name in re.findall(r"[^\W\d]\w*", text) if _NAME.search(name)]
        if named and isinstance(bare(value), Load):
            return (source_text(bare(value)), text), named[0], falls
    return None


def _is_sum(e: Expr) -> bool:
    inner = as_written(e)
    if isinstance(inner, Const) and isinstance(inner.source, Expr):
        return _is_sum(inner.source)
    return isinstance(inner, Binary) and inner.op in ("+", "-")


def _text(e: Expr) -> str:
    """A sum or difference as the source has it, with the names of its constants."""
    match as_written(e):
        case Const(source=Expr() as source):
            return _text(source)
        case Const() as number:
            return defined_number(number)[0] or source_text(number)
        case Binary(op="+" | "-" as op, left=left, right=right):
            return f"{_text(left)} {op} {_text(right)}"
        case other:
            return source_text(other)
