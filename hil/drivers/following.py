"""Checks values that follow another one in steps, as a ramp does: does each step go towards it?

    if (target > value + step)
        value += step;
    else if (target < value - step)
        value -= step;                // += would never come back
    else
        value = target;

The chain of tests says what follows what: one of its ways sets the value to the target.  A step is told only if its own
test compares the target with the value a step away, on this side: then the test stays true after the step, for ever.

A value that lasts can also take a share of the difference, as a filter does:

    value += (target - value) / 8;    // -= would make the difference greater with each step

The share of an extrapolation (`x += (x - last) / 2; last = ...`) is right: what it is compared with goes on with it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    CallPointer,
    Compare,
    Const,
    Expr,
    Function,
    If,
    Load,
    LValue,
    RegisterLoad,
    Stmt,
    Variable,
)
from emulator.c28x.tree_queries import OBSERVABLE, OPPOSITE, TURNED, assigned, bare, parts, source_text, statements


@dataclass(frozen=True, slots=True)
class WrongStep:
    """A step that goes away from the value that it follows."""

    place: Place
    message: str
    object: str


@dataclass(frozen=True, slots=True)
class _Step:
    """`value += by`, or `value -= by` (`down`)."""

    value: Expr
    by: Expr
    down: bool


def wrong_steps(modules: Iterable[Module]) -> Iterator[WrongStep]:
    """The steps of `modules` that go away from what they follow."""
    for module in modules:
        for function in module.functions:
            yield from _wrong_shares(function)
            inner: set[int] = set()
            for s in statements(function.body):
                if isinstance(s, If) and id(s) not in inner:
                    ways = list(_ways(s, inner))
                    yield from _wrong(ways, function)


def _ways(s: If, inner: set[int]) -> Iterator[tuple[Expr | None, list[Stmt]]]:
    """The ways of an `if ... else if ... else`, each with its test; the later tests of it go to `inner`."""
    while True:
        yield s.test, s.then
        if len(s.otherwise) != 1 or not isinstance(s.otherwise[0], If):
            yield None, s.otherwise
            return
        s = s.otherwise[0]
        inner.add(id(s))


def _wrong(ways: list[tuple[Expr | None, list[Stmt]]], function: Function) -> Iterator[WrongStep]:
    arrivals = [(s.target, bare(s.value)) for _, body in ways for s in body if isinstance(s, Assign)]
    for test, body in ways:
        if not isinstance(test, Compare) or test.op not in OPPOSITE:
            continue
        for s in body:
            step = _step(s)
            if step is None or not isinstance(s, Assign) or not isinstance(step.value, Load):
                continue
            for target, below in _compared(test, step):
                arrives = any(to == step.value.lvalue and value == target for to, value in arrivals)
                if arrives and below == step.down and not _acts(test):
                    name = source_text(step.value)
                    yield WrongStep(
                        Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column),
                        f"{name} follows {source_text(target)}: where {source_text(test)}, {name} "
                        f"{'-=' if step.down else '+='} {source_text(step.by)} goes away from it",
                        name,
                    )


def _wrong_shares(function: Function) -> Iterator[WrongStep]:
    """The statements that take a share of a difference in the wrong direction."""
    body = list(statements(function.body))
    stores = Counter(v for s in body if (v := assigned(s)) is not None)
    locals_ = {
        v: e for s in body if isinstance(e := getattr(s, "value", None), Expr)
        and (v := assigned(s)) is not None and v.kind == "local" and stores[v] == 1
    }  # fmt: skip
    for n, s in enumerate(body):
        step = _step(s)
        if step is None or not isinstance(s, Assign) or not isinstance(step.value, Load) or not _lasts(step.value):
            continue
        difference = _difference(step.by, locals_)
        if difference is None:
            continue
        to, of = difference
        down = step.down
        if to == step.value:
            to, of, down = of, to, not down
        if of != step.value or not down or not _changes(to) or any(part == step.value for part in parts(to)):
            continue
        if not any(isinstance(to, Load) and isinstance(x, Assign) and x.target == to.lvalue for x in body[n + 1 :]):
            name, sign = source_text(step.value), "-=" if step.down else "+="
            yield WrongStep(
                Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column),
                f"{name} follows {source_text(to)}: {name} {sign} {source_text(step.by)} goes away from it", name,
            )


def _difference(share: Expr, known: Mapping[Variable, Expr]) -> tuple[Expr, Expr] | None:
    """The two sides of the difference of which an expression is a part between 0 and 1; None: it is no such part.

    `known`: the values of locals that are set once.
    """
    factor = 1.0
    share = bare(share)
    while True:
        match share:
            case Binary(op="/", left=rest, right=by) if (number := _number(by)) is not None and number > 0:
                factor /= number
            case Binary(op=">>", left=rest, right=by) if (number := _number(by)) is not None and number >= 0:
                factor /= 2.0**number
            case Binary(op="*", left=rest, right=by) if (number := _number(by)) is not None and number > 0:
                factor *= number
            case Binary(op="*", left=by, right=rest) if (number := _number(by)) is not None and number > 0:
                factor *= number
            case Load(lvalue=LValue(root=Variable() as root)) if root in known:
                rest = known[root]
                known = {}
            case Binary(op="-", left=left, right=right) if 0 < factor < 1:
                return bare(left), bare(right)
            case _:
                return None
        share = bare(rest)


def _number(e: Expr) -> float | None:
    """The value of a constant."""
    e = bare(e)
    return float(e.value) if isinstance(e, Const) else None


def _lasts(value: Load) -> bool:
    """Whether an object still has its value when its function runs again."""
    root = value.lvalue.root
    return not isinstance(root, Variable) or root.kind == "global"


def _changes(e: Expr) -> bool:
    """Whether an expression is more than constants."""
    return any(isinstance(part, Load | RegisterLoad | Call | CallPointer) for part in parts(e))


def _compared(test: Compare, step: _Step) -> Iterator[tuple[Expr, bool]]:
    """What a test compares the value of a step with, this step away; whether the value is below it where it holds."""
    for one, op, other in ((test.left, test.op, test.right), (test.right, TURNED[test.op], test.left)):
        far = _moved(other)
        if far is None or far.by != step.by:
            continue
        greater = op in (">", ">=")
        if far.value == step.value and greater != far.down:  # target > value + step, target < value - step
            yield bare(one), greater
        elif bare(one) == step.value and greater != far.down:  # value < target - step, value > target + step
            yield far.value, not greater


def _step(s: Stmt) -> _Step | None:
    """The step that a statement makes."""
    if not isinstance(s, Assign) or not isinstance(s.target, LValue):
        return None
    moved = _moved(s.value)
    return moved if moved is not None and isinstance(moved.value, Load) and moved.value.lvalue == s.target else None


def _moved(e: Expr) -> _Step | None:
    """An expression `value + by` or `value - by`."""
    match bare(e):
        case Binary(op="+" | "-" as op, left=left, right=right) if isinstance(bare(left), Load):
            return _Step(bare(left), bare(right), op == "-")
    return None


def _acts(e: Expr) -> bool:
    """Whether evaluating an expression has an effect: it reads a register or calls a function."""
    return any(isinstance(part, OBSERVABLE) for part in parts(e))
