"""Static check of tests that let one element too many into an array: `table-short`.

    static char Line[LINE_MAX];
    if (Length <= LINE_MAX)
        Line[Length++] = c;

    if (Length < LINE_MAX)
        Line[Length++] = c;
    ...
    Line[Length] = '\\0';

    if (step <= STEPS) { wanted = steps[step].wanted; if (elapsed >= steps[step].seconds) step++; }

The number is only counted up by 1 behind one test, and set to constants; no other test asks for it, or only another
function that sets it back then in any case.  So it reaches the limit, and one more behind it.  If it is counted behind
a further test, only the elements that are used before it count; silent if that test may find a mark of the end in an
element (`if (steps[step].seconds != 0) step++;`).  Silent in loops with a number of turns: these may be fewer than the
limit.  For an object at file scope the check needs the source of a whole program (one with a `main`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set
from itertools import chain
from typing import Any, NamedTuple

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.admitted import upper_limits
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.passes.tables import is_step
from emulator.c28x.passes.unlimited_lines import in_no_counting_loop
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Break,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Continue,
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
    Not,
    Return,
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
    leaves,
    named_scalar,
    named_scalars,
    own_nodes,
    parts,
    source_text,
    statements,
)


class _Gate(NamedTuple):
    """A test that lets a number up to a limit through, to statements that count it."""

    function: Function
    test: Compare
    number: NamedScalar
    limit: int
    body: list[Stmt]
    #: The body counts it only behind further tests.
    further: bool = False
    #: The identities of those of them that only ask for elements.
    of_elements: frozenset[int] = frozenset()


class _Beyond(NamedTuple):
    """An element behind the end of an array, the length of the array, and the largest value of the subscript."""

    array: LValue
    length: int
    most: int


def check_off_by_one(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the tests of a number behind which it goes beyond the end of an array."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    whole = any(function.name == "main" and function.body for function in owners)
    gates = [gate for function in owners for gate in _gates(function)]
    for gate in gates:
        local = isinstance(gate.number[0], Variable) and gate.number[0].kind != "global"
        functions = [gate.function] if local else [f for f in owners if gate.number in named_scalars(f)]
        if not (local or whole):
            continue
        if not _only_counted(gate, functions):
            late = {id(t) for f in functions if f is not gate.function for t in _tested_at_the_end(f, gate.number)}
            if not late or not _only_counted(gate, functions, late):
                continue
            functions = [gate.function]  # where it is tested, the test may keep it within the array
        for function in functions:
            found = _beyond(gate, function)
            if found is not None:
                name = found.array.text.partition("[")[0]
                lets = f"{source_text(gate.test)} lets {gate.limit} through"
                message = f"{lets}, and {name} has only {found.length} elements"
                if found.most > gate.limit:
                    message += f": it is counted up behind the test, and used in line {found.array.where.line}"
                owners[gate.function].report(
                    gate.function, gate.test.where, "table-short", message, object=name, value=found.most
                )  # fmt: skip
                break


def _gates(function: Function) -> Iterator[_Gate]:
    """The tests of a function that alone let a number be counted up."""
    free = {id(s) for s in in_no_counting_loop(function.body)}
    for block in all_blocks(function.body):
        for at, s in enumerate(block):
            if not isinstance(s, If) or id(s) not in free:
                continue
            ways = [(s.then, list(upper_limits(s.test)))]
            refused = list(upper_limits(s.test, holds=False))
            if s.otherwise:
                ways.append((s.otherwise, refused))
            elif leaves(s.then) or any(_sets_back(s.then, lvalue) for lvalue, _, _ in refused):
                ways.append((block[at + 1 :], refused))
            for body, limits in ways:
                for lvalue, limit, test in limits:
                    number = named_scalar(lvalue)
                    if number is None or any(_sets(x, number) for x in block[:at]):
                        continue
                    if any(_steps(x, number) for x in body):
                        yield _Gate(function, test, number, limit, body)
                    elif (tests := _counted_behind(body, number)) is not None:
                        asked = frozenset(id(p) for e in tests for p in parts(e) if _only_of_element(p, number))
                        yield _Gate(function, test, number, limit, body, further=True, of_elements=asked)


def _counted_behind(body: list[Stmt], number: NamedScalar) -> tuple[Expr, ...] | None:
    """The further tests behind which a body counts a number, if none of them may find a mark of the end; or None.

    If the body also sets it back, something else may end the count.
    """
    if any(_sets(s, number) for s, _ in _further(body)):
        return None
    for s, tests in _further(body):
        if _steps(s, number):
            return None if any(_finds_end(test, body) for test in tests) else tests
    return None


def _further(body: list[Stmt], tests: tuple[Expr, ...] = ()) -> Iterator[tuple[Stmt, tuple[Expr, ...]]]:
    """The statements of a body and of the branches in it, each with the tests around it."""
    for s in body:
        yield s, tests
        if isinstance(s, If):
            for block in blocks(s):
                yield from _further(block, (*tests, s.test))


def _finds_end(test: Expr, body: list[Stmt]) -> bool:
    """Whether a test may find a mark of the end in an element, or in a copy of it: it asks for one value of it.

    The order of two values ends nothing.
    """
    copies = {s.target.text for s in body if isinstance(s, Assign) and isinstance(s.target, LValue)}
    copies |= {s.variable.declaration.name for s in body if isinstance(s, Declare)}
    match bare(test):
        case Compare(op="<" | "<=" | ">" | ">=", left=left, right=right):
            return any(constant_of(side) is not None and _reads_element(other, copies) for side, other in (
                (left, right), (right, left),
            ))  # fmt: skip
        case Logic(operands=operands):
            return any(_finds_end(each, body) for each in operands)
    return _reads_element(test, copies)


def _only_of_element(e: Any, number: NamedScalar) -> bool:
    """Whether an expression is a comparison in which a number is nothing but a subscript."""
    if not isinstance(e, Compare):
        return False
    within = {id(q) for p in parts(e) if isinstance(p, LValue) for i in p.indices for q in parts(i.expr)}
    return all(id(p) in within for p in parts(e) if isinstance(p, LValue) and named_scalar(p) == number)


def _reads_element(e: Expr, copies: set[str]) -> bool:
    """Whether an expression reads an element, a result of a function, or one of some objects."""
    return any(
        isinstance(p, Call | CallPointer) or (isinstance(p, LValue) and bool(p.indices or p.text in copies))
        for p in parts(e)
    )


def _sets_back(body: list[Stmt], lvalue: LValue) -> bool:
    return any(isinstance(x, Assign) and x.target == lvalue and constant_of(x.value) == 0 for x in body)


def _steps(s: Stmt, number: NamedScalar) -> bool:
    return isinstance(s, Assign) and isinstance(s.target, LValue) and named_scalar(s.target) == number and is_step(
        s.target, s.value
    )  # fmt: skip


def _only_counted(gate: _Gate, functions: Iterable[Function], late: Set[int] = frozenset()) -> bool:
    """Whether a number is only counted behind its gate, set to constants elsewhere, and tested nowhere else.

    `late`: the identities of tests that do not count.
    """
    counted = {id(s) for s, tests in _further(gate.body) if gate.further or not tests}
    for function in functions:
        for s in statements(function.body):
            nodes = own_nodes(s)
            for test in _tests(s, nodes):
                if test is gate.test or id(test) in late or id(test) in gate.of_elements:
                    continue
                if _has(test, gate.number) and not _about_nothing(test):
                    return False
            match s:
                case Assign(target=LValue() as target, value=value) if named_scalar(target) == gate.number:
                    if not (_steps(s, gate.number) and id(s) in counted) and constant_of(value) is None:
                        return False
                case For(variable=variable) if named_scalar(variable) == gate.number:
                    return False
            if any(isinstance(p, AddressOf) and named_scalar(p.lvalue) == gate.number for p in nodes):
                return False
    return True


def _tests(s: Stmt, nodes: Iterable[Any]) -> Iterator[Expr]:
    for p in nodes:
        if isinstance(p, Compare):
            yield p
        elif isinstance(p, Not | Conditional):
            inner = p.operand if isinstance(p, Not) else p.test
            if isinstance(bare(inner), Load):
                yield inner
    match s:
        case Switch(subject=test):
            yield test
        case If(test=test) | While(test=test) if isinstance(bare(test), Load):
            yield test
        case For(stop=stop):
            yield stop


def _tested_at_the_end(function: Function, number: NamedScalar) -> Iterator[Expr]:
    """The tests of a number that a function sets back behind them in any case: they end no count.

    As in `if (Count == 8) Serve(); Count = 0;` behind a frame.
    """
    for block in all_blocks(function.body):
        for at, s in enumerate(block):
            if not isinstance(s, If) or not any(_is_reset(x, number) for x in block[at + 1 :]):
                continue
            inner = statements([*s.then, *s.otherwise])
            if not any(isinstance(x, Return | Break | Continue | Jump | LeaveSwitch) for x in inner):
                for x in (s, *inner):
                    yield from _tests(x, own_nodes(x))


def _is_reset(s: Stmt, number: NamedScalar) -> bool:
    return _sets(s, number) and isinstance(s, Assign) and constant_of(s.value) is not None


def _about_nothing(test: Expr) -> bool:
    """Whether a test only asks whether a number is 0, or is the number of turns of a loop."""
    return not isinstance(test, Compare) or 0 in (constant_of(test.left), constant_of(test.right))


def _has(e: Any, number: NamedScalar) -> bool:
    return any(isinstance(p, LValue) and named_scalar(p) == number for p in parts(e))


def _beyond(gate: _Gate, function: Function) -> _Beyond | None:
    """An element that the number goes beyond, with the length of its array and the largest value of the number."""
    within = {id(x) for s in gate.body for block in blocks(s) for x in statements(block)}
    inside = _elements(gate, gate.body, within, gate.limit) if function is gate.function else iter(())
    if gate.further:
        return next(inside, None)
    return next(chain(inside, _elements(gate, function.body, within, gate.limit + 1)), None)


def _elements(gate: _Gate, body: list[Stmt], within: set[int], most: int) -> Iterator[_Beyond]:
    """What `_beyond` looks for, in a block up to a statement that sets the number back; it is `most` at the start."""
    old: set[Variable] = set()
    set_back: list[Expr] = []
    for s in body:
        if s is gate.body[0] and body is not gate.body:
            return
        if isinstance(s, If) and s.test in set_back:
            continue
        match s:
            case Declare(variable=Variable(kind="temporary") as kept, value=Expr() as value) if _is(value, gate.number):
                old.add(kept)
        nodes = own_nodes(s)
        pointed = {id(p.lvalue) for p in nodes if isinstance(p, AddressOf)}
        for lvalue in nodes if id(s) not in within else ():
            if not isinstance(lvalue, LValue) or id(lvalue) in pointed or len(lvalue.indices) != 1:
                continue
            index = lvalue.indices[0]
            at = bare(index.expr)
            before = isinstance(at, Load) and isinstance(at.lvalue.root, Variable) and at.lvalue.root in old
            reached = gate.limit if before else most
            if index.bound and index.bound <= reached and (before or _is(index.expr, gate.number)):
                yield _Beyond(lvalue, index.bound, reached)
        for block in blocks(s):
            if block is not gate.body:  # behind the test the number is no larger than the limit
                yield from _elements(gate, block, within, most)
        if _steps(s, gate.number):
            most = gate.limit + 1
        elif _sets(s, gate.number):
            return
        elif not any(p is gate.test for p in nodes):
            staying = [block for block in blocks(s) if not leaves(block)]
            if any(_sets(x, gate.number) for block in staying for x in statements(block)):
                if not isinstance(s, If) or s.otherwise:
                    return
                set_back.append(s.test)  # it keeps its value where this test fails


def _sets(s: Stmt, number: NamedScalar) -> bool:
    """Whether a statement sets a number, and does not step it."""
    return (
        isinstance(s, Assign) and isinstance(s.target, LValue) and named_scalar(s.target) == number
        and not _steps(s, number)
    )  # fmt: skip


def _is(e: Expr, number: NamedScalar) -> bool:
    """Whether an expression is just the value of a number."""
    inner = bare(e)
    return isinstance(inner, Load) and isinstance(inner.ctype, IntType) and named_scalar(inner.lvalue) == number
