"""Static check of tables that lack an element for a state of their subscript: `table-short`.

    typedef enum { OFF, RAMP, HOLD, DONE, FAULT } STATE;
    static const char *const Names[] = { "OFF", "RAMP", "HOLD", "FAULT" };
    sprintf(text, "%s", Names[State]);

A state is an object at file scope, or a member, that gets nothing but constants, from 0 on without a gap.  The check
follows the subscript through copies, parameters and the results of functions.

What `main` sets before its loop does not count: the table may be for what comes later.  A subscript is left alone
where the program may know that it is not the last state: a test of the state, or of what is set beside it, on the way
to the subscript in its function, or on every way through its callers.  Of a member, the program has one object only.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import ArrayType, CType, IntType, StructType
from emulator.c28x.passes.given import GivenValue, GivenValues
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import start_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Break,
    Call,
    Conditional,
    Const,
    Continue,
    Convert,
    Declare,
    Expr,
    For,
    Function,
    If,
    Jump,
    LeaveSwitch,
    Load,
    Logic,
    LValue,
    Return,
    Stmt,
    Switch,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    NamedScalar,
    all_blocks,
    bare,
    below,
    blocks,
    last_loop,
    named_scalar,
    own_nodes,
    parts,
    source_text,
    statements,
)

#: Through how many objects and functions a state is followed, and how many callers up.
_DEEPEST: Final = 5
#: A table of states has at least so many elements.
_LEAST: Final = 2


def check_state_tables(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report subscripts by states for which the table has no element.  Silent without a whole program."""
    modules = list(modules)
    functions = [function for module in modules for function in module.functions]
    if not any(function.name == "main" and function.body for function in functions):
        return
    states = _States(functions, [variable for module in modules for variable in module.variables])
    for module, report in reports.items():
        for function in module.functions:
            states.check(function, report)


class _Known(NamedTuple):
    """The scalars that have a state, and those that are set beside it."""

    states: set[NamedScalar]
    beside: set[NamedScalar]
    #: The value in question.
    highest: int

    def asked(self, test: Expr) -> bool:
        """Whether a test asks for the state, or for what is set beside it."""
        return _mentions(test, self.states) or _mentions(test, self.beside)


class _States:
    """What the scalars of a program get, and what tests them."""

    def __init__(self, functions: list[Function], objects: list[Variable]) -> None:
        self._objects = objects
        self._given = GivenValues(functions)
        #: Function -> its calls, each with the statement and the function.
        self._callers: dict[str, list[tuple[Function, Stmt, Call]]] = {}
        self._functions = functions
        self._beside: dict[NamedScalar, set[NamedScalar]] = {}
        self._later = _run_later(functions, self._given.by_pointer)
        for function in functions:
            for s in statements(function.body):
                for p in own_nodes(s):
                    if isinstance(p, Call):
                        self._callers.setdefault(p.function.path, []).append((function, s, p))

    def check(self, function: Function, report: StaticReport) -> None:
        """Report the subscripts of one function."""
        for s in statements(function.body):
            if id(s) not in self._later:
                continue
            nodes = own_nodes(s)
            pointed = {id(p.lvalue) for p in nodes if isinstance(p, AddressOf)}
            for lvalue in nodes:
                if not isinstance(lvalue, LValue) or not isinstance(lvalue.root, Variable) or id(lvalue) in pointed:
                    continue
                for index in lvalue.indices:
                    if index.bound and isinstance(bare(index.expr), Load | Call):
                        self._subscript(function, s, lvalue, index.expr, index.bound, report)

    def _subscript(
        self, function: Function, s: Stmt, lvalue: LValue, index: Expr, bound: int, report: StaticReport
    ) -> None:  # fmt: skip
        values: dict[int, Where | None] = {}
        through: set[NamedScalar] = set()
        if not self._values(index, values, through, 0, later=True):
            return
        highest = max(values, default=0)
        where = values.get(highest)
        if highest < bound or bound < _LEAST or set(values) != set(range(highest + 1)) or where is None:
            return
        kept = [scalar for scalar in through if _kept(scalar)]
        beside = set().union(*map(self._set_beside, kept))
        if not kept or not self._may_come(function, s, lvalue, _Known(through, beside, highest), frozenset()):
            return
        assert isinstance(lvalue.root, Variable)
        name, text = lvalue.root.declaration, source_text(index)
        message = f"{text} may be {highest} (line {where.line}), and {name.name} has only {bound} elements there"
        report.report(function, s.where, "table-short", message, object=name.path, declaration=name, value=highest)

    def _values(
        self, e: Expr, values: dict[int, Where | None], through: set[NamedScalar], depth: int, *, later: bool
    ) -> bool:  # fmt: skip
        """Collect the constants that a value may be, and the scalars that it goes through.

        Each constant has its place, or None if it is only set at the start.  False: the value may be anything else too.
        """
        if depth > _DEEPEST or not isinstance(e.ctype, IntType):
            return False
        given: list[GivenValue]
        match e:
            case Const(value=int(value)):
                if later:
                    values[value] = e.where
                values.setdefault(value, None)
                return True
            case Convert(operand=operand):
                return self._values(operand, values, through, depth, later=later)
            case Conditional(then=then, otherwise=otherwise):
                given = [GivenValue(then, None), GivenValue(otherwise, None)]
            case Load(lvalue=LValue(ctype=IntType()) as lvalue) if (scalar := named_scalar(lvalue)) is not None:
                if scalar in through:
                    return True
                through.add(scalar)
                given = self._given.of(scalar)
                holder = scalar[0]
                if isinstance(holder, StructType):
                    if self._count(holder) != 1:
                        return False
                    values.setdefault(0, None)
                elif holder.kind == "global":
                    values.setdefault(start_of(holder), None)
            case Call(function=function) if function.path in self._given.results:
                given = self._given.results[function.path]
            case _:
                return False
        return all(
            one.value is not None and self._values(one.value, values, through, depth + 1, later=later and kept)
            for one, kept in sorted(((one, self._comes_later(one)) for one in given), key=lambda pair: not pair[1])
        )

    def _comes_later(self, given: GivenValue) -> bool:
        """Whether a value is given after the start."""
        return given.by is None or id(given.by) in self._later

    def _count(self, structure: StructType) -> int:
        """The objects with a structure, without the locals that only get copies of others."""
        filled = {
            s.target.root for f in self._functions for s in statements(f.body)
            if isinstance(s, Assign) and isinstance(s.target, LValue) and isinstance(s.target.root, Variable)
        }  # fmt: skip
        own = [v for v in filled if v.kind != "global"]
        return sum(_times(structure, v.ctype) for v in (*self._objects, *own))

    def _set_beside(self, state: NamedScalar) -> set[NamedScalar]:
        """The scalars that are set where a state is, or where it is tested, or that are computed from it."""
        if state not in self._beside:
            found: set[NamedScalar] = set()
            setting = {
                f.path for f in self._functions for s in f.body
                if isinstance(s, Assign) and isinstance(s.target, LValue) and named_scalar(s.target) == state
            }  # fmt: skip
            for function in self._functions:
                for block in all_blocks(function.body):
                    if any(_sets(s, state, setting) for s in block):
                        found |= _assigned(block)
                for s in statements(function.body):
                    if any(_mentions(test, {state}) for test in _tests(s)):
                        found |= _assigned(x for inner in blocks(s) for x in statements(inner))
                    if isinstance(s, Assign | Declare) and isinstance(s.value, Expr) and _mentions(s.value, {state}):
                        found |= _assigned([s])
            self._beside[state] = found
        return self._beside[state]

    def _may_come(self, function: Function, s: Stmt, node: Any, known: _Known, above: frozenset[str]) -> bool:
        """Whether a way leads to a node of a statement on which nothing asks for a state."""
        around = [p for p in own_nodes(s) if isinstance(p, Logic | Conditional)]
        choices = [p for p in around if any(q is node for q in parts(p))]
        tests, before = _way(function.body, s, known) or ([], [])
        if any(map(known.asked, [*choices, *tests])) or any(self._sets_another(x, known) for x in before):
            return False
        if function.path in self._given.by_pointer or function.interrupt or function.name == "main":
            return True
        callers = [caller for caller in self._callers.get(function.path, ()) if caller[0].path not in above]
        return len(above) < _DEEPEST and any(
            self._may_come(*caller, known, above | {function.path}) for caller in callers
        )

    def _sets_another(self, s: Stmt, known: _Known) -> bool:
        """Whether a statement sets a state, or calls what does, and never to the value in question."""
        for state in known.states:
            setting = [s, *self._always_set_by(s, state)]
            values: list[Any] = [x.value for x in setting if isinstance(x, Assign) and _sets(x, state, set())]
            values += [a for p in own_nodes(s) if values and isinstance(p, Call) for a in p.arguments]
            if values and not any(self._gives(value, known.highest) for value in values):
                return True
        return False

    def _always_set_by(self, s: Stmt, state: NamedScalar) -> list[Stmt]:
        """The statements of the functions which a statement calls that set a state whatever happens."""
        called = {p.function.path for p in own_nodes(s) if isinstance(p, Call)}
        return [x for f in self._functions if f.path in called for x in f.body if _sets(x, state, set())]

    def _gives(self, value: Any, number: int) -> bool:
        values: dict[int, Where | None] = {}
        return isinstance(value, Expr) and self._values(value, values, set(), 0, later=True) and number in values


def _times(structure: StructType, ctype: CType) -> int:
    """How often a type has a structure in it."""
    match ctype:
        case ArrayType(element=element, length=length):
            return _times(structure, element) * length
        case StructType(members=members):
            return 1 if ctype == structure else sum(_times(structure, member.ctype) for member in members)
    return 0


def _run_later(functions: list[Function], by_pointer: set[str]) -> set[int]:
    """The identities of the statements that run in the loop of `main`, in a routine, in a task, or are called there."""
    own = {function.path: function for function in functions}
    roots = [f.path for f in functions if f.path in by_pointer or f.interrupt]
    loops = [loop for f in functions if f.name == "main" and (loop := last_loop(f)) is not None]
    looped = [s for loop in loops for s in statements([loop])]
    roots += [p.function.path for s in looped for p in own_nodes(s) if isinstance(p, Call)]
    return {id(s) for s in (*looped, *(x for f in below(roots, own) for x in statements(f.body)))}


def _kept(scalar: NamedScalar) -> bool:
    """Whether a scalar keeps its value: an object at file scope, or a member."""
    return isinstance(scalar[0], StructType) or scalar[0].kind == "global"


def _sets(s: Stmt, state: NamedScalar, setting: set[str]) -> bool:
    """Whether a statement itself sets a state, or calls a function that does."""
    if isinstance(s, Assign) and isinstance(s.target, LValue) and named_scalar(s.target) == state:
        return True
    return any(isinstance(p, Call) and p.function.path in setting for p in own_nodes(s))


def _assigned(body: Iterable[Stmt]) -> set[NamedScalar]:
    found: set[NamedScalar] = set()
    for s in body:
        match s:
            case Assign(target=LValue() as target) if (scalar := named_scalar(target)) is not None:
                found.add(scalar)
            case Declare(variable=variable):
                found.add((variable, 0))
    return found


def _mentions(e: Any, scalars: set[NamedScalar]) -> bool:
    return any(isinstance(p, LValue) and named_scalar(p) in scalars for p in parts(e))


def _tests(s: Stmt) -> list[Expr]:
    """What decides which block of a statement is executed."""
    match s:
        case If(test=test) | While(test=test) | Switch(subject=test):
            return [test]
        case For(start=start, stop=stop):
            return [start, stop]
    return []


def _way(body: list[Stmt], wanted: Stmt, known: _Known) -> tuple[list[Expr], list[Stmt]] | None:
    """What is on the way to a statement: tests, and the statements that are executed before it.

    The tests are those around it, and those before it that may lead away or set the state.
    """
    tests: list[Expr] = []
    for at, s in enumerate(body):
        if s is wanted:
            return tests, body[:at]
        for block in blocks(s):
            inner = _way(block, wanted, known)
            if inner is not None:
                return [*tests, *_tests(s), *inner[0]], [*body[:at], *inner[1]]
        tests += _leading_away(s, known)
    return None


def _leading_away(s: Stmt, known: _Known) -> Iterator[Expr]:
    """The tests of a statement that may leave the block, wait, or set the state."""
    inner = [x for block in blocks(s) for x in statements(block)]
    away = any(isinstance(x, Return | Break | Continue | Jump | LeaveSwitch) for x in inner)
    if away or isinstance(s, While) or _assigned(inner) & known.states:
        for x in (s, *inner):
            yield from _tests(x)
