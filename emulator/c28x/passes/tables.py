"""Static check of tables that are shorter than a remainder, a mask or the end of a count allows: `table-short`.

    static const STEP Steps[7] = ...;
    Steps[Word() & 7]
    Steps[at];  at++;  if (at > 7) at = 0;
    Steps[at];  if (at < 7) at++; else at = 0;
    Steps[(word & 0x0FFF) >> 8]

The check follows such an index through objects that get nothing but remainders, masks, constants and steps behind which
a test sets them back, and through the results of functions.  What the program compares, or decides by, may have been
tested: it is left alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.given import GivenValue, GivenValues
from emulator.c28x.passes.intervals import interval
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    Compare,
    Conditional,
    Const,
    Convert,
    Expr,
    Function,
    If,
    Load,
    Logic,
    LValue,
    Not,
    RegisterLoad,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    NamedScalar,
    all_blocks,
    bare,
    blocks,
    named_scalar,
    own_nodes,
    parts,
    source_text,
    statements,
)

#: Through how many objects and functions an index is followed.
_DEEPEST: Final = 4


class _Reach(NamedTuple):
    """The largest value of an index, and the remainder, mask or test that allows it (None: a constant)."""

    high: int
    by: Binary | Compare | None


def check_tables(modules: Iterable[Module], reports: dict[Module, StaticReport], given: GivenValues) -> None:
    """Report subscripts that a remainder, a mask or the end of a count lets go beyond the end of a table."""
    indices = _Indices([function for module in modules for function in module.functions], given)
    for module, report in reports.items():
        for function in module.functions:
            indices.check(function, report)


class _Indices:
    """What the objects of a program get, and which of them it tests."""

    def __init__(self, functions: list[Function], given: GivenValues) -> None:
        self._given = given
        self._parameters = {(parameter, 0) for function in functions for parameter in function.parameters}
        self._tested: set[NamedScalar] = set()
        #: Identity of the value of a step -> how far it leads; the identities of the tests that end a count.
        self._steps: dict[int, _Reach] = {}
        self._ends: set[int] = set()
        for function in functions:
            for block in all_blocks(function.body):
                self._counts(block)
            for s in statements(function.body):
                self._chooses(s)
        for function in functions:
            for s in statements(function.body):
                self._tests(s)

    def _counts(self, block: list[Stmt]) -> None:
        """Take the steps by 1 of a block behind which a test sets the scalar back."""
        for number, s in enumerate(block):
            match s:
                case Assign(target=LValue() as target, value=value) if is_step(target, value):
                    pass
                case _:
                    continue
            for later in block[number + 1 :]:
                match later:
                    case If(test=Compare() as test, then=then, otherwise=[]) if (
                        (high := _highest(test, target, _BEHIND)) is not None
                        and any(_sets_back(t, target) for t in then)
                    ):
                        self._steps[id(value)] = _Reach(high, test)
                        self._ends.add(id(test))
                        break
                if blocks(later) or any(isinstance(p, LValue) and p == target for p in own_nodes(later)):
                    break

    def _chooses(self, s: Stmt) -> None:
        """Take the step by 1 of a branch whose other branch sets the scalar to a constant."""
        match s:
            case If(test=test, then=[Assign(target=LValue() as target, value=then)], otherwise=[Assign() as other]):
                otherwise = other.value if other.target == target else None
            case Assign(target=LValue() as target, value=value):
                match bare(value):
                    case Conditional(test=test, then=then, otherwise=otherwise):
                        pass
                    case _:
                        return
            case _:
                return
        if named_scalar(target) is None or not isinstance(otherwise, Expr):
            return
        compare = bare(test)
        stepped, constant = (then, otherwise) if constant_of(otherwise) is not None else (otherwise, then)
        back = constant_of(constant)
        if not isinstance(compare, Compare) or back is None:
            return
        more = _WHERE_TRUE if stepped is then else _WHERE_FALSE
        if is_step(target, stepped) and (high := _highest(compare, target, more)) is not None:
            self._steps[id(stepped)] = _Reach(high, compare)
        elif is_step(target, stepped, "-") and _stops_at_0(compare, target, goes_on=stepped is then):
            self._steps[id(stepped)] = _Reach(0, None)
            self._steps[id(constant)] = _Reach(back, compare)
        else:
            return
        self._ends.add(id(compare))

    def _tests(self, s: Stmt) -> None:
        """Take what a statement decides by."""
        for test in _tests(s, own_nodes(s)):
            if id(test) not in self._ends:
                self._tested |= {scalar for p in _ranged(test) if isinstance(p, LValue) and (scalar := named_scalar(p))}

    def check(self, function: Function, report: StaticReport) -> None:
        """Report the subscripts of one function."""
        texts: set[str] | None = None
        for s in statements(function.body):
            nodes = own_nodes(s)
            pointed = {id(p.lvalue) for p in nodes if isinstance(p, AddressOf)}
            for lvalue in nodes:
                if not isinstance(lvalue, LValue) or not isinstance(lvalue.root, Variable):
                    continue
                for index in lvalue.indices:
                    reach = self._reach(index.expr) if index.bound else None
                    behind = 1 if id(lvalue) in pointed else 0  # a pointer just behind the end may be meant
                    if reach is None or reach.by is None or index.bound is None or reach.high < index.bound + behind:
                        continue
                    if texts is None:
                        texts = _tested_texts(function)
                    masked = isinstance(reach.by, Binary) and reach.by.op in ("&", ">>")
                    if not masked or not texts & _read(index.expr):
                        self._report(function, s, lvalue, index.expr, index.bound, reach, report)

    @staticmethod
    def _report(
        function: Function, s: Stmt, lvalue: LValue, index: Expr, bound: int, reach: _Reach, report: StaticReport
    ) -> None:  # fmt: skip
        assert isinstance(lvalue.root, Variable)
        assert reach.by is not None
        name, text = lvalue.root.declaration, source_text(index)
        why = "" if bare(index) == reach.by else f", by {source_text(reach.by)}"
        if isinstance(reach.by, Compare):
            why = f" before {source_text(reach.by)} sets it back"
        message = f"{text} may be {reach.high}{why}, and {lvalue.text or name.name} has only {bound} elements there"
        report.report(
            function, s.where, "table-short", message, object=name.path, declaration=name, value=reach.high
        )  # fmt: skip

    def _reach(self, e: Expr, depth: int = 0) -> _Reach | None:
        """How far an index reaches; None: not known."""
        if not isinstance(e.ctype, IntType) or depth > _DEEPEST:
            return None
        if id(e) in self._steps:
            return self._steps[id(e)]
        match e:
            case Const(value=int(value)):
                return _Reach(value, None)
            case Convert(operand=operand):
                inner = self._reach(operand, depth)
                return inner if inner is not None and inner.high <= e.ctype.high else None
            case Binary(op="%", right=Const(value=int(count))) if count > 0:
                return _Reach(min(count - 1, interval(e, {})[1]), e)
            case Binary(op="&", left=left, right=Const(value=int(mask))) if mask > 0 and not mask & mask + 1:
                return _Reach(min(mask, _most(left)), e)
            case Binary(op=">>", left=left, right=Const(value=int(count))) if count > 0:
                match bare(left):
                    case Binary(op="&", right=Const(value=int(mask))) if mask > 0:
                        field = mask >> count
                        return _Reach(min(field, _most(left) >> count), e) if not field & field + 1 else None
            case Conditional(test=test, then=then, otherwise=otherwise) if id(bare(test)) in self._ends:
                return self._furthest([GivenValue(then, None), GivenValue(otherwise, None)], depth)
            case Load(lvalue=lvalue) if (scalar := named_scalar(lvalue)) is not None and scalar not in self._tested:
                return self._furthest(self._given.of(scalar), depth + 1) if scalar not in self._parameters else None
            case Call(function=function):
                return self._furthest(self._given.results.get(function.path, []), depth + 1)
        return None

    def _furthest(self, values: list[GivenValue], depth: int) -> _Reach | None:
        reached = [self._reach(one.value, depth) if one.value is not None else None for one in values]
        known = [reach for reach in reached if reach is not None]
        return max(known, key=lambda reach: reach.high) if known and len(known) == len(values) else None


def is_step(target: LValue, value: Expr, op: str = "+") -> bool:
    """Whether a value is that of a named scalar and 1 more (`op`: or 1 less).  (`n++` keeps it in a temporary.)"""
    match bare(value):
        case Binary(op=found, left=left, right=right) if found == op and constant_of(right) == 1:
            old = bare(left)
        case _:
            return False
    if named_scalar(target) is None or not isinstance(old, Load):
        return False
    match old.lvalue.root, target.root:
        case Variable(kind="temporary", declaration=kept), Variable(declaration=counted):
            return kept == counted
    return old.lvalue == target


#: How the largest value of a count follows from the constant of a test: what the test adds to it, by its operator.
_BEHIND: Final = {">": 0, ">=": -1, "==": -1}  # the count is stepped, and where the test is true it is set back
_WHERE_TRUE: Final = {"<": 0, "<=": 1, "!=": 0}  # the count is stepped where the test is true
_WHERE_FALSE: Final = {">=": 0, ">": 1, "==": 0}


def _highest(test: Compare, target: LValue, more: Mapping[str, int]) -> int | None:
    """The largest value of a count that a test of it lets through; None: the test is about something else."""
    left, limit = bare(test.left), constant_of(test.right)
    if not isinstance(left, Load) or left.lvalue != target or limit is None or test.op not in more:
        return None
    return int(limit) + more[test.op]


def _stops_at_0(test: Compare, target: LValue, *, goes_on: bool) -> bool:
    """Whether a test ends a count down at 0.  `goes_on`: where it is true, the count goes on."""
    left, limit = bare(test.left), constant_of(test.right)
    if not isinstance(left, Load) or left.lvalue != target:
        return False
    ends = {(">", 0), ("!=", 0), (">=", 1)} if goes_on else {("<=", 0), ("==", 0), ("<", 1)}
    return (test.op, limit) in ends


def _sets_back(s: Stmt, target: LValue) -> bool:
    return isinstance(s, Assign) and s.target == target and constant_of(s.value) is not None


def _most(e: Expr) -> int:
    """The largest value of the operand of a mask; of one that may be negative, all its bits."""
    low, high = interval(e, {}) if isinstance(e.ctype, IntType) else (-1, 0)
    return high if low >= 0 else 0xFFFF_FFFF


def _tests(s: Stmt, nodes: Iterable[Any]) -> list[Expr]:
    """What a statement decides by."""
    found: list[Expr] = [p for p in nodes if isinstance(p, Compare | Not)]
    found += [p.test for p in nodes if isinstance(p, Conditional)]
    match s:
        case If(test=test) | While(test=test) | Switch(subject=test):
            found.append(test)
    return found


def _ranged(test: Expr) -> Iterator[Any]:
    """The parts of a test that may exclude values: not whether two objects are equal (`head == tail`)."""
    match bare(test):
        case Logic(operands=operands):
            for operand in operands:
                yield from _ranged(operand)
        case Not(operand=operand):
            yield from _ranged(operand)
        case Compare(op="==" | "!=", left=left, right=right) if isinstance(bare(left), Load) and isinstance(
            bare(right), Load
        ):
            pass
        case _:
            yield from parts(test)


def _tested_texts(function: Function) -> set[str]:
    """The text of each object and register by which a function decides."""
    found: set[str] = set()
    for s in statements(function.body):
        for test in _tests(s, own_nodes(s)):
            found |= _read(test)
    return found


def _read(e: Expr) -> set[str]:
    return {source_text(p) for p in parts(e) if isinstance(p, Load | RegisterLoad)}
