"""Finds two limits that a hysteresis should part, and that are one, or change their places: `no-hysteresis`.

    if (temperature < SET_TENTHS - HYST_TENTHS) heater = 1;
    ...
    if (temperature > SET_TENTHS - HYST_TENTHS) heater = 0;     // the sign is that of the other limit

A value is compared below a limit in one test, and above the same limit in another one of the same function.  That alone
is no defect; but the limit is made with a constant that its name calls a hysteresis.

    if (temperature > limit) alarm = 1;
    ...
    if (temperature < limit + HYSTERESIS) alarm = 0;            // both hold between the limits: it has to be -

Both tests decide about one object or pin, to which the program gives two values only.  What else must hold is the same
for both, or asks for that object.  An oven that heats up to `SET - HYST`, and is cold below `SET + HYST`, has states.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import product
from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.state_values import constant_of, start_of
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Const,
    Declare,
    Evaluate,
    Expr,
    Function,
    If,
    Load,
    Logic,
    LValue,
    RegisterRef,
    Stmt,
    Switch,
    Unary,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import bare, blocks, own_nodes, parts, source_text, statements
from hil.drivers.stated_units import as_written, defined_number
from hil.drivers.units import UnitMismatch

_NAME: Final = re.compile(r"hyst|hist(?:e|é)r|dead_?band|totband|banda_?muerta", re.IGNORECASE)
#: A value, and a limit of it as the source has it.
_Limit = tuple[str, str]
_PIN: Final = re.compile(r"GP[A-F](SET|CLEAR|DAT)$")


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


@dataclass(frozen=True)
class _Switching:
    """A test of a value against a limit, behind which an object or a pin is given a constant."""

    value: str
    falls: bool
    limit: Expr
    effect: str
    to: int
    test: If
    #: What decides whether the test is made: statements, with the number of the block that is taken.
    way: tuple[tuple[Stmt, int], ...]
    #: What the test asks for besides, apart from the object itself.
    besides: frozenset[str]


def crossed_limits(modules: Iterable[Module]) -> Iterator[UnitMismatch]:
    """The pairs of tests with a hysteresis that hold both, and switch one object or pin to and fro."""
    modules = list(modules)
    given = _all_given(modules)
    for function in (function for module in modules for function in module.functions):
        found = list(_switchings(function.body, ()))
        written = Counter(name for s in statements(function.body) if (name := _given(s)[0])) if found else Counter()
        for up, down in product(found, found):
            if up.falls or not down.falls or (up.value, up.effect) != (down.value, down.effect) or up.to == down.to:
                continue
            texts = {id(each.test): _text(each.limit) for each in (up, down)}
            mentioned = [name for text in texts.values() for name in re.findall(r"[^\W\d]\w*", text)]
            names = [name for name in mentioned if _NAME.search(name)]
            if any(written[name] > 1 for name in (up.value, *re.findall(r"\w+", up.value), *mentioned)):
                continue  # another value, or another limit, may have the name of the first
            if names and given.get(_last_name(up.effect)) == {up.to, down.to} and _alike(up, down) and _apart(up, down):
                named = next(each for each in (down, up) if names[0] in texts[id(each.test)])
                message = (
                    f"{up.effect} becomes {up.to} where {up.value} is above {texts[id(up.test)]} "
                    f"(line {up.test.where.line}), and {down.to} where it is below {texts[id(down.test)]} "
                    f"(line {down.test.where.line}): between the two both hold, and {names[0]} makes it go to and fro"
                )
                where = named.test.where
                place = Place(function.where.file, where.line, function.name, function.c_file, where.column)
                yield UnitMismatch(place, message, up.effect, "no-hysteresis")


def _switchings(body: list[Stmt], way: tuple[tuple[Stmt, int], ...]) -> Iterator[_Switching]:
    """The tests in a body that switch something."""
    for s in body:
        if isinstance(s, If):
            terms = s.test.operands if isinstance(s.test, Logic) else [s.test]
            joined = isinstance(s.test, Logic) and s.test.op == "and"
            for test in terms:
                for value, limit, falls in _sides(test):
                    for effect, to in _effects(s.then, value):
                        others = (other for other in terms if joined and other is not test)
                        besides = frozenset(source_text(other) for other in others if not _only(other, effect))
                        yield _Switching(value, falls, limit, effect, to, s, way, besides)
        for number, block in enumerate(blocks(s)):
            yield from _switchings(block, (*way, (s, number)) if isinstance(s, If | Switch) else way)


def _sides(test: Expr) -> Iterator[tuple[str, Expr, bool]]:
    """A value that a test compares, its limit, and whether the test is for values below it."""
    if isinstance(test, Compare) and test.op in ("<", "<=", ">", ">="):
        for value, limit, falls in (
            (test.left, test.right, test.op[0] == "<"), (test.right, test.left, test.op[0] == ">")
        ):  # fmt: skip
            if isinstance(bare(value), Load):
                yield source_text(bare(value)), limit, falls


def _effects(body: list[Stmt], value: str) -> Iterator[tuple[str, int]]:
    """What statements give constants to, if nothing but counts and the like stands between; each once."""
    found = set(_given_here(body, value))
    several = Counter(effect for effect, _ in found)
    yield from (each for each in found if several[each[0]] == 1)


def _given_here(body: list[Stmt], value: str) -> Iterator[tuple[str, int]]:
    for s in body:
        effect, to = _given(s)
        if effect and to is not None:
            yield effect, to
        if isinstance(s, If) and not any(tested == value for p in parts(s.test) for tested, _, _ in _sides(p)):
            yield from _given_here(s.then, value)
            yield from _given_here(s.otherwise, value)


def _given(s: Stmt) -> tuple[str, int | None]:
    """The object or pin that a statement writes ("": none), and the constant that it gives (None: another value)."""
    match s:
        case Assign(target=LValue() as target, value=value):
            return target.text, constant_of(value)
        case Declare(variable=variable, value=Expr() as value):
            return variable.declaration.name, constant_of(value)
        case Assign(target=RegisterRef(register=register, field=field), value=value) if field is not None:
            port, to = _PIN.match(register), constant_of(value)
            if port is not None:
                return field.name, to if port[1] == "DAT" else {"SET": 1, "CLEAR": 0}[port[1]] if to == 1 else None
        case Evaluate(value=Call(function=Function(name="GPIO_WritePin" | "GPIO_writePin"), arguments=[pin, value])):
            number = constant_of(pin)
            return f"GPIO{number}" if number is not None else "", constant_of(value)
    return "", None


def _all_given(modules: list[Module]) -> dict[str, set[int | None]]:
    """The constants that a program gives to its objects and pins, or asks them for, by their last names."""
    found: dict[str, set[int | None]] = {}
    for variable in (variable for module in modules for variable in module.variables):
        if isinstance(variable.ctype, IntType):
            found.setdefault(variable.declaration.name, set()).add(start_of(variable))
    for function in (function for module in modules for function in module.functions):
        for s in statements(function.body):
            effect, to = _given(s)
            if effect:
                found.setdefault(_last_name(effect), set()).add(to)
            for subject, value in _asked(s):
                found.setdefault(_last_name(source_text(bare(subject))), set()).add(value)
    return found


def _asked(s: Stmt) -> Iterator[tuple[Expr, int]]:
    """The expressions that a statement compares with constants for equality, each with the constant."""
    if isinstance(s, Switch):
        yield from ((s.subject, label) for labels, _ in s.cases for label in labels or ())
    for p in own_nodes(s):
        if isinstance(p, Compare) and p.op in ("==", "!="):
            for side, other in ((p.left, p.right), (p.right, p.left)):
                if (value := constant_of(other)) is not None:
                    yield side, value


def _last_name(text: str) -> str:
    """Of `zones[i].alarm`: alarm."""
    names = re.findall(r"[^\W\d]\w*", re.sub(r"\[.*?\]", "", text))
    return names[-1] if names else ""


def _alike(up: _Switching, down: _Switching) -> bool:
    """Whether what else must hold for two tests is the same, or asks for the object that they switch."""
    for one, other in ((up, down), (down, up)):
        shared = {(id(s), number) for s, number in other.way}
        for s, number in one.way:
            test = s.test if isinstance(s, If) else s.subject if isinstance(s, Switch) else None
            behind = s is other.test and number == 1  # `else if`
            if (id(s), number) not in shared and not behind and not (test is not None and _only(test, one.effect)):
                return False
    return up.besides == down.besides


def _only(e: Expr, effect: str) -> bool:
    """Whether an expression asks for one object alone."""
    nodes = parts(e)
    asked = {p.text for p in nodes if isinstance(p, LValue)}
    return asked == {effect} and not any(isinstance(p, Call | RegisterRef) for p in nodes)


def _apart(up: _Switching, down: _Switching) -> bool:
    """Whether the limit of the values that are above is certainly lower than that of those below."""
    terms: Counter[str] = Counter()
    least = _sum(down.limit, 1, terms) + _sum(up.limit, -1, terms)
    left = {term: times for term, times in terms.items() if times}
    positive = {source_text(p) for each in (up, down) for p in parts(each.limit) if isinstance(p, Load) and _grows(p)}
    grows = all(times > 0 and term in positive for term, times in left.items())
    return grows and (least > 0 or (least == 0 and bool(left)))


def _sum(e: Expr, sign: int, terms: Counter[str]) -> float:
    """The constant in a sum; `terms` gets the others, with how often each is in it."""
    match as_written(e):
        case Const(value=int() | float() as number):
            return sign * number
        case Binary(op="+" | "-" as op, left=left, right=right):
            return _sum(left, sign, terms) + _sum(right, sign if op == "+" else -sign, terms)
        case Unary(op="-", operand=operand):
            return _sum(operand, -sign, terms)
        case other:
            terms[source_text(other)] += sign
            return 0.0


def _grows(load: Load) -> bool:
    """Whether an object is a hysteresis by its name, and more than 0."""
    match load.lvalue:
        case LValue(root=Variable() as root, text=text) if _NAME.search(text.rpartition(".")[2]):
            unsigned = isinstance(load.ctype, IntType) and not load.ctype.signed
            return unsigned or (root.kind == "global" and not load.lvalue.indices and start_of(root) > 0)
    return False
