"""Static check of lines that only their last character limits: `line-unlimited`.

    if (c == '\\r') { Obey(); length = 0; }
    else line[length++] = c;

The length is only stepped by 1 and set to constants, and no test of the program limits it.  Silent if anything else
may: a test of the length, of the line or of another count in the function, a loop with a number of turns, a value that
is computed from the length.  The check needs the source of a whole program (one with a `main`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from emulator.c28x.ctypes import ArrayType
from emulator.c28x.passes.begun_again import step_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    Compare,
    Conditional,
    Declaration,
    Declare,
    Expr,
    For,
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
from emulator.c28x.tree_queries import assigned, bare, blocks, own_nodes, parts, statements


def check_unlimited_lines(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the statements that put a character into a line whose length nothing limits."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    if not any(function.name == "main" and function.body for function in owners):
        return
    open_lengths: dict[Variable, bool] = {}
    for function, report in owners.items():
        for s, line, length, character in _stores(function):
            if length not in open_lengths:
                open_lengths[length] = _never_limited(length, owners)
            if not open_lengths[length] or _tests(line.declaration, function) or _counts_besides(function, length):
                continue
            if any(_ends(test, character) and _sets_back(test, length) for test in statements(function.body)):
                name = line.declaration
                assert isinstance(line.ctype, ArrayType)
                message = (
                    f"{name.name} has {line.ctype.length} elements, and only the last character of a line sets "
                    f"{length.declaration.name} back: a longer line is written behind {name.name}"
                )
                report.report(function, s.where, "line-unlimited", message, object=name.path, declaration=name)


def _stores(function: Function) -> Iterator[tuple[Stmt, Variable, Variable, Variable]]:
    """The statements of a function that put a character into a line: with the line, its length, the character."""
    lengths = {v.declaration: v for s in statements(function.body) if (v := assigned(s)) is not None and step_of(s, v)}
    for s in in_no_counting_loop(function.body):
        match s:
            case Assign(target=LValue(root=Variable(kind="global", ctype=ArrayType()) as line, indices=[index])):
                at, value = bare(index.expr), bare(s.value)
                if not isinstance(at, Load) or not isinstance(at.lvalue.root, Variable) or not isinstance(value, Load):
                    continue
                length, character = lengths.get(at.lvalue.root.declaration), value.lvalue.root
                if length is None or length.kind != "global" or not isinstance(character, Variable):
                    continue
                if character.plain:
                    yield s, line, length, character


def in_no_counting_loop(body: list[Stmt]) -> Iterator[Stmt]:
    """Statements that are in no loop but those without an end, and those that take what there is.

    These ask a register or a function, or whether the two indices of a ring differ.
    """
    for s in body:
        yield s
        if isinstance(s, For) or (isinstance(s, While) and not _takes_what_is_there(s.test)):
            continue
        for block in blocks(s):
            yield from in_no_counting_loop(block)


def _takes_what_is_there(test: Expr) -> bool:
    """Whether a loop with this test counts no turns."""
    match bare(test):
        case Compare(op="!=", left=left, right=right) if isinstance(bare(left), Load) and isinstance(bare(right), Load):
            return True
    return constant_of(test) is not None or any(isinstance(p, RegisterLoad | Call) for p in parts(test))


def _never_limited(length: Variable, functions: Iterable[Function]) -> bool:
    """Whether a length is only stepped by 1, set to constants, used as an index or an argument, and compared with 0."""
    for function in functions:
        for s in statements(function.body):
            mine = assigned(s) is length
            if mine and not (isinstance(s, Assign) and (step_of(s, length) == 1 or constant_of(s.value) is not None)):
                return False
            kept = isinstance(s, Declare) and s.variable.kind == "temporary"
            value = s.value if isinstance(s, Assign | Declare) and not mine and not kept else None
            if isinstance(value, Expr) and not isinstance(value, Call) and _made_of(value, length.declaration):
                return False
            if any(isinstance(p, AddressOf) and p.lvalue.root is length for p in own_nodes(s)):
                return False
        if _tests(length.declaration, function):
            return False
    return True


def _made_of(e: Expr, declaration: Declaration) -> bool:
    """Whether a value is made of an object, other than as a subscript."""
    subscripts = {id(q) for p in parts(e) if isinstance(p, LValue) for i in p.indices for q in parts(i.expr)}
    return any(
        isinstance(p, Load) and isinstance(p.lvalue.root, Variable) and p.lvalue.root.declaration == declaration
        for p in parts(e) if id(p) not in subscripts
    )  # fmt: skip


def _tests(declaration: Declaration, function: Function) -> bool:
    """Whether a test of a function may limit an object: any but one against 0 or 1."""
    for s in statements(function.body):
        tests: list[Any] = [p for p in own_nodes(s) if isinstance(p, Compare | Not | Logic)]
        tests += [p.test for p in own_nodes(s) if isinstance(p, Conditional)]
        match s:
            case If(test=test) | While(test=test) | Switch(subject=test):
                tests.append(test)
            case For():
                tests += own_nodes(s)
        for test in tests:
            if isinstance(test, Logic | Not):
                continue  # its parts are looked at one by one
            if isinstance(test, Compare) and (constant_of(test.right) in (0, 1) or constant_of(test.left) in (0, 1)):
                continue
            if isinstance(test, Load) and not test.lvalue.indices:
                continue
            for p in parts(test):
                if isinstance(p, LValue) and isinstance(p.root, Variable) and p.root.declaration == declaration:
                    return True
    return False


def _counts_besides(function: Function, length: Variable) -> bool:
    """Whether a function steps another object than the length: that may be what limits it."""
    for s in statements(function.body):
        v = assigned(s)
        if v is not None and v is not length and step_of(s, v) is not None:
            return True
    return False


def _ends(s: Stmt, character: Variable) -> bool:
    """Whether a statement tests just a character."""
    match s:
        case If(test=test) | Switch(subject=test):
            used = {p.root for p in parts(test) if isinstance(p, LValue)}
            return used == {character} and not any(isinstance(p, Call | RegisterLoad) for p in parts(test))
    return False


def _sets_back(s: Stmt, length: Variable) -> bool:
    return any(
        isinstance(inner, Assign) and assigned(inner) is length and constant_of(inner.value) is not None
        for block in blocks(s) for inner in statements(block)
    )  # fmt: skip
