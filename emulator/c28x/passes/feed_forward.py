"""Static check of sums in which a feed-forward and an error disagree about the wanted value: `runs-away`.

    drive(FEED_FORWARD * wanted + KP * (speed - wanted));

The first term says that a greater wanted value needs a greater output, and the second one that it needs a smaller one.
So the second one has the wrong sign.  Names say what is a feed-forward, and that nothing subtracts the measured value.
Silent if a gain is not certainly positive.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final, NamedTuple

from emulator.c28x.passes.declared import name_at
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Binary, Expr, Function, Load, LValue, Variable
from emulator.c28x.tree_queries import (
    PRODUCT,
    SUM,
    bare,
    gives,
    number_of,
    operands,
    outermost,
    own_nodes,
    source_text,
    statements,
)

_FEED_FORWARD: Final = re.compile(r"feed|(^|_)k?_?ff(_|$)|[a-z]FF|ff_|vorsteuer|prealiment", re.IGNORECASE)


class _Term(NamedTuple):
    """A term of a sum: positive or negative constants and one value that changes."""

    value: Expr
    positive: bool
    gains: tuple[str, ...]


def check_feed_forward(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the sums of a feed-forward of a value and an error of which that value is subtracted."""
    for module in modules:
        for function in module.functions:
            for s in statements(function.body):
                for whole in outermost(own_nodes(s), SUM):
                    terms = [term for e, positive in operands(whole, SUM) if (term := _term(e, positive)) is not None]
                    ahead = [t for t in terms if any(map(_FEED_FORWARD.search, t.gains))]
                    for term in terms if ahead else ():
                        _judge(function, reports[module], ahead, term)


def _judge(function: Function, report: StaticReport, ahead: list[_Term], term: _Term) -> None:
    """Report a term that is a share of an error of the wrong sign."""
    error = _difference(function, term.value)
    if error is None or term in ahead:
        return
    for wanted in ahead:
        text = _read(wanted.value)
        if not text or text not in (_read(error.left), _read(error.right)):
            continue
        grows = term.positive == (text == _read(error.left))
        if grows != wanted.positive:
            shown = source_text(error)
            message = (
                f"the output grows with {text} by {' * '.join(wanted.gains)}, and falls with it by {shown}: the error "
                "has the wrong sign"
            )
            report.report(function, error.where, "runs-away", message, object=shown)


def _term(e: Expr, positive: bool) -> _Term | None:
    """A product of constant gains and one other value; None: it is something else."""
    values, gains = list[Expr](), list[str]()
    for factor, _ in operands(e, PRODUCT):
        gain = _gain(factor)
        if gain is None:
            values.append(factor)
        else:
            gains.append(name_at(factor.where) or source_text(factor))
            positive = positive == (gain > 0)
    return _Term(values[0], positive, tuple(gains)) if len(values) == 1 and gains else None


def _gain(e: Expr) -> int | float | None:
    """The value of a constant, or of a constant object."""
    match e:
        case Load(lvalue=LValue(root=Variable(constant=True, initial=[value]), indices=[])):
            return number_of(value)
    return number_of(e)


def _difference(function: Function, e: Expr) -> Binary | None:
    """The difference that an expression is, itself or in a local that is set once."""
    match bare(e):
        case Binary(op="-") as found:
            return found
        case Load(lvalue=LValue(root=Variable(kind="local") as local, indices=[])):
            given = [g[1] for s in statements(function.body) if (g := gives(s)) is not None and g[0].root is local]
            only = bare(given[0]) if len(given) == 1 else None
            return only if isinstance(only, Binary) and only.op == "-" else None
    return None


def _read(e: Expr) -> str:
    """The text of an lvalue of which an expression is just the value."""
    inner = bare(e)
    return source_text(inner) if isinstance(inner, Load) else ""
