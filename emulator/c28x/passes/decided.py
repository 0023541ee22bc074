"""Static check of tests that a test before them decides, `constant-condition`, and of assignments: `self-assignment`.

    if (air > wanted - SLACK) cool();
    else if (air < wanted + SLACK) rest();

Where the second test is reached, `air <= wanted - SLACK` holds, so it is always true.  The check compares tests of one
difference (`air - wanted`) with constants.  It looks only at tests without calls, registers and volatile objects, along
`else if`: nothing runs between them.

The exact complement (`else if (air <= wanted - SLACK)`) is a usual way to say what `else` means, and not reported.
Nor is a difference of unsigned numbers, which wraps.

    if (state == IDLE) { state = IDLE; lamp(0); }

The assignment has no effect: the test has just found that value.  Reported only where the function tests for the same
value elsewhere, and leaves it there, and where nothing beside the test gives the object another value: `state = IDLE;`
in one of several cases says that the state stays.

Comparisons of texts are looked at along `else if`, too (`text-compare`): one that is taken for yes or no, among others
that are compared with 0.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.values import volatile
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Const,
    Convert,
    Expr,
    Function,
    If,
    Load,
    Logic,
    LValue,
    Not,
    Stmt,
    Unary,
    Variable,
)
from emulator.c28x.tree_queries import OPPOSITE, TURNED, bare, calls, runs_function, source_text, statements

#: Functions whose result is 0 for equal texts or blocks.
_COMPARES: Final = ("strcmp", "strncmp", "memcmp", "strcasecmp", "stricmp")


class _Linear(NamedTuple):
    """A sum of objects, each by its name with a factor, and of a constant."""

    terms: frozenset[tuple[str, float]]
    constant: float


class _Limit(NamedTuple):
    """A sum of objects, compared with a constant: `terms op limit`."""

    terms: frozenset[tuple[str, float]]
    op: str
    limit: float
    whole: bool
    test: Compare


def check_decided(function: Function, report: StaticReport) -> None:
    """Report the tests after an `else` that a test before it decides."""
    inner: set[int] = set()
    found = [pair for s in statements(function.body) if isinstance(s, If) and (pair := _finds(s)) is not None]
    for s in statements(function.body):
        if isinstance(s, If) and id(s) not in inner:
            _check_kept(s, found, function, report)
            _check_texts(s, function, report)
            known: list[_Limit] = []
            failed: dict[str, int] = {}
            for test in _chain(s):
                inner.add(id(test))
                _check(test, known, function, report)
                _check_again(test, failed, function, report)
                known += [limit for limit in map(_limit, _each(test.test)) if limit is not None]
                failed |= {source_text(each): test.where.line for each in _each(test.test) if _stays(each)}


def _chain(first: If) -> Iterator[If]:
    """An `if`, and those that its `else` leads to at once."""
    s: Stmt | None = first
    while isinstance(s, If):
        yield s
        s = s.otherwise[0] if s.otherwise else None


def _each(test: Expr) -> list[Expr]:
    """The comparisons that have all failed where a test has failed."""
    return test.operands if isinstance(test, Logic) and test.op == "or" else [test]


def _check(s: If, known: list[_Limit], function: Function, report: StaticReport) -> None:
    now = _limit(s.test)
    if now is None:
        return
    for before in known:
        if before.terms != now.terms:
            continue
        outcome = _decided(before, now)
        if outcome is not None:
            text = source_text(now.test)
            message = f"{text} is always {'true' if outcome else 'false'} here: not {source_text(before.test)}"
            report.report(function, s.where, "constant-condition", message, object=text)
            return


def _check_again(s: If, failed: dict[str, int], function: Function, report: StaticReport) -> None:
    """Report a test that is one of those that have `failed`: their texts, with the lines of their `if`."""
    text = source_text(s.test)
    if text in failed and _stays(s.test):
        message = f"{text} is always false here: line {failed[text]} has tested it"
        report.report(function, s.where, "constant-condition", message, object=text)


def _check_texts(first: If, function: Function, report: StaticReport) -> None:
    """Report a comparison of texts that is taken for yes or no, among others that are compared with 0."""
    equal: list[str] = []
    truths: list[tuple[If, Call]] = []
    for s in _chain(first):
        match s.test:
            case Compare(op="==", left=Call() as call, right=Const(value=0)) | Not(operand=Call() as call):
                if call.function.name in _COMPARES:
                    equal.append(source_text(call.arguments[0]))
            case Compare(op="!=", left=Call() as call, right=Const(value=0)) | (Call() as call):
                if call.function.name in _COMPARES:
                    truths.append((s, call))
    for s, call in truths:
        if equal.count(source_text(call.arguments[0])) > 1 and len(truths) == 1:
            text = source_text(call)
            message = f"{text} is 0 for equal texts: this is true for all others; the tests beside it compare with 0"
            report.report(function, s.where, "text-compare", message, object=text)


class _Equal(NamedTuple):
    """What the test of an `if` finds an object to be."""

    at: If
    name: str
    value: float


def _finds(s: If) -> _Equal | None:
    """The object that a test compares with a constant for equality, and the constant."""
    match s.test:
        case Compare(op="==", left=left, right=right):
            match bare(left), bare(right):
                case (Load(lvalue=lvalue), Const(value=value)) | (Const(value=value), Load(lvalue=lvalue)):
                    return _Equal(s, _name(lvalue), value)
    return None


def _given(body: list[Stmt], name: str) -> set[float | None]:
    """What statements assign to an object; None: something else than a constant."""
    return {
        value.value if isinstance(value := bare(s.value), Const) else None
        for s in statements(body) if isinstance(s, Assign) and isinstance(s.target, LValue) and _name(s.target) == name
    }  # fmt: skip


def _check_kept(s: If, found: list[_Equal], function: Function, report: StaticReport) -> None:
    """Report an assignment of the value that the test of its `if` has just found."""
    own = _finds(s)
    if own is None or _given(s.otherwise, own.name) or any(_finds(other) for other in _chain(s) if other is not s):
        return
    if not any(each.name == own.name and each.value == own.value and _given(each.at.then, own.name) - {own.value}
               for each in found if each.at is not s):  # fmt: skip
        return
    for inner in s.then:
        if isinstance(inner, Assign) and _given([inner], own.name) == {own.value}:
            assert isinstance(inner.target, LValue)
            text = inner.target.text
            message = f"{text} is {source_text(inner.value)} here already: line {s.test.where.line} has tested it"
            report.report(function, inner.where, "self-assignment", message, object=text)
            return
        if _given([inner], own.name) or any(runs_function(each) for each in statements([inner])):
            return


def _stays(test: Expr) -> bool:
    """Whether a test has the same result a moment later, and its text says all of it."""
    text = source_text(test)
    same = isinstance(test, Compare) and not calls(test) and not volatile(test)
    return same and "..." not in text and "expression" not in text


def _decided(before: _Limit, now: _Limit) -> bool | None:
    """What the failed test before says of the present one: true (beyond the complement), false, or nothing."""
    holds, last, op, limit = OPPOSITE[before.op], before.limit, now.op, now.limit
    if before.whole:  # of integers, make both comparisons inclusive
        last += {"<": -1, ">": 1}.get(holds, 0)
        limit += {"<": -1, ">": 1}.get(op, 0)
        holds, op = holds[0] + "=", op[0] + "="
    if holds[0] == op[0]:
        return True if (limit > last if op[0] == "<" else limit < last) else None
    apart = limit - last if holds[0] == "<" else last - limit
    excluded = apart > 0 or (apart == 0 and not ("=" in holds and "=" in op))
    return False if excluded else None


def _limit(test: Expr) -> _Limit | None:
    """The limit that a comparison by order sets; None: it is none that stays the same."""
    if not isinstance(test, Compare) or test.op not in OPPOSITE or calls(test) or volatile(test):
        return None
    left, right = _linear(test.left), _linear(test.right)
    if left is None or right is None:
        return None
    terms = dict(left.terms)
    for text, factor in right.terms:
        terms[text] = terms.get(text, 0) - factor
    terms = {text: factor for text, factor in terms.items() if factor}
    if not terms:
        return None
    op, limit = test.op, right.constant - left.constant
    if terms[min(terms)] < 0:
        terms, op, limit = {text: -factor for text, factor in terms.items()}, TURNED[op], -limit
    return _Limit(frozenset(terms.items()), op, limit, isinstance(test.left.ctype, IntType), test)


def _linear(e: Expr) -> _Linear | None:
    """An expression as a sum; None: it is none, or it may wrap."""
    match e:
        case Const(value=value):
            return _Linear(frozenset(), value)
        case Load(lvalue=lvalue) if lvalue.text and isinstance(e.ctype, IntType | FloatType):
            return _Linear(frozenset({(_name(lvalue), 1)}), 0)
        case Convert(ctype=FloatType(), operand=operand):
            return _linear(operand)
        case Convert(ctype=IntType() as to, operand=Expr(ctype=IntType() as of) as operand):
            return _linear(operand) if to.low <= of.low and of.high <= to.high else None
        case Unary(op="-", operand=operand) if not _wraps(e) and (inner := _linear(operand)) is not None:
            return _Linear(frozenset((text, -factor) for text, factor in inner.terms), -inner.constant)
        case Binary(op="+" | "-" as op, left=left, right=right) if not _wraps(e):
            a, b = _linear(left), _linear(right)
            if a is None or b is None:
                return None
            sign = 1 if op == "+" else -1
            terms = dict(a.terms)
            for text, factor in b.terms:
                terms[text] = terms.get(text, 0) + sign * factor
            return _Linear(frozenset(terms.items()), a.constant + sign * b.constant)
    return None


def _name(lvalue: LValue) -> str:
    """The source text of an object, with the place of what it begins with: another function may use the same name."""
    return f"{lvalue.root.declaration.path} {lvalue.text}" if isinstance(lvalue.root, Variable) else lvalue.text


def _wraps(e: Expr) -> bool:
    """Whether an operation is one of unsigned numbers."""
    return isinstance(e.ctype, IntType) and not e.ctype.signed
