"""Finds the statement that gives an object its scale or its sign: where a measured value is converted to its unit.

    raw = position - last;                      // the sign
    rpm = raw * 60 * RATE / COUNTS_PER_TURN;    // the scale
    status.speed += (rpm - status.speed) / 4;   // a filter: neither

The search goes from the assignments of the object back through locals, and through `f(&local)`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import Final

from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Call,
    Const,
    Declare,
    Expr,
    Function,
    Load,
    LValue,
    Return,
    Stmt,
    Unary,
    Variable,
)
from emulator.c28x.tree_queries import bare, own_nodes, parts, statements

#: The operators that give a scale, and those that give a sign.
SCALE: Final = frozenset({"*", "/", "<<", ">>"})
SIGN: Final = frozenset({"-"})
#: Values are followed through so many statements.
_DEEPEST: Final = 6

_Source = tuple[Function, Stmt, Expr]


def conversion_of(modules: Iterable[Module], path: str, operators: frozenset[str]) -> Place | None:
    """The place that converts the object `path` (`status.speed`) by one of the operators; None: none is found."""
    functions = [function for module in modules for function in module.functions]
    name = path.rpartition(".")[2]
    given = list(_given(functions, lambda lvalue: lvalue.text == path))
    if not given and name != path:
        given = list(_given(functions, lambda lvalue: lvalue.text.endswith((f"->{name}", f".{name}"))))
    for source in given:
        found = _converting(functions, source, operators, _DEEPEST)
        if found is not None:
            function, s, _ = found
            return Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column)
    return None


def _given(functions: Iterable[Function], wanted: Callable[[LValue], bool]) -> Iterator[_Source]:
    """The values that are assigned to an object and are no constants."""
    for function in functions:
        for s in statements(function.body):
            match s:
                case Assign(target=LValue() as target, value=value) if wanted(target):
                    pass
                case Declare(variable=variable, value=Expr() as value) if wanted(LValue(variable.ctype, variable)):
                    pass
                case _:
                    continue
            if not isinstance(bare(value), Const):
                yield function, s, value


def _converting(
    functions: list[Function], source: _Source, operators: frozenset[str], depth: int
) -> _Source | None:  # fmt: skip
    function, s, value = source
    used = parts(value)
    target = s.target if isinstance(s, Assign) else None
    filtered = any(isinstance(p, Load) and p.lvalue == target for p in used)
    if not filtered and any(
        (isinstance(p, Binary) and p.op in operators) or (isinstance(p, Unary) and p.op in operators) for p in used
    ):
        return source
    for p in used if depth else ():
        if isinstance(p, Load) and isinstance(p.lvalue.root, Variable) and p.lvalue.root.kind == "local":
            for earlier in _of_local(functions, function, p.lvalue.root):
                found = _converting(functions, earlier, operators, depth - 1)
                if found is not None:
                    return found
        if isinstance(p, Call):
            for returned in _returned(p.function):
                found = _converting(functions, returned, operators, depth - 1)
                if found is not None:
                    return found
    return None


def _of_local(functions: list[Function], function: Function, local: Variable) -> Iterator[_Source]:
    """The values of a local, also those that a function gives it through its address."""
    yield from _given([function], lambda lvalue: lvalue.root is local)
    for s in statements(function.body):
        for p in own_nodes(s):
            if isinstance(p, Call) and not p.function.extern:
                for parameter, value in zip(p.function.parameters, p.arguments, strict=False):
                    address = bare(value)
                    if isinstance(address, AddressOf) and address.lvalue.root is local:
                        yield from _given([p.function], partial(_points, parameter))


def _points(parameter: Variable, lvalue: LValue) -> bool:
    """Whether an lvalue is what a parameter points to."""
    root = bare(lvalue.root) if isinstance(lvalue.root, Expr) else None
    return isinstance(root, Load) and root.lvalue.root is parameter


def _returned(function: Function) -> Iterator[_Source]:
    """The values that a function returns and that are no constants."""
    for s in statements(function.body):
        if isinstance(s, Return) and isinstance(s.value, Expr) and not isinstance(bare(s.value), Const):
            yield function, s, s.value
