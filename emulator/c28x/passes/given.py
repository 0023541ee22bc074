"""The values that the statements of a program give to scalars, and that its functions return."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from emulator.c28x.ctypes import IntType
from emulator.c28x.tree import AddressOf, Assign, Call, Declare, Expr, For, Function, FunctionRef, LValue, Return, Stmt
from emulator.c28x.tree_queries import NamedScalar, named_scalar, own_nodes, statements


class GivenValue(NamedTuple):
    """A value, and the statement that gives it; None: one that is not known."""

    value: Expr | None
    by: Stmt | None


class GivenValues:
    """What the scalars of a program get.  A scalar whose address is taken gets what is not known, too.

    A parameter gets the arguments of all calls; and what is not known, if something may call its function by a pointer.
    """

    def __init__(self, functions: Iterable[Function]) -> None:
        functions = list(functions)
        self.scalars: dict[NamedScalar, list[GivenValue]] = {}
        #: Path of a function -> what it returns.
        self.results: dict[str, list[GivenValue]] = {}
        #: The paths of the functions whose address is taken.
        self.by_pointer: set[str] = set()
        for function in functions:
            for s in statements(function.body):
                self._take(function, s)
        for function in functions:
            if function.path in self.by_pointer or function.interrupt:
                for parameter in function.parameters:
                    self._add((parameter, 0), None, None)

    def of(self, scalar: NamedScalar) -> list[GivenValue]:
        """The values that statements give to a scalar."""
        return self.scalars.get(scalar, [])

    def _take(self, function: Function, s: Stmt) -> None:
        match s:
            case Assign(target=LValue() as target, value=value) if (scalar := named_scalar(target)) is not None:
                self._add(scalar, value, s)
            case Declare(variable=variable, value=Expr() as value):
                self._add((variable, 0), value, s)
            case For(counter=counter):
                self._add((counter, 0), None, s)
            case Return(value=value):
                self.results.setdefault(function.path, []).append(GivenValue(value, s))
        for p in own_nodes(s):
            match p:
                case AddressOf(lvalue=LValue(ctype=IntType()) as lvalue):
                    if (scalar := named_scalar(lvalue)) is not None:
                        self._add(scalar, None, s)
                case FunctionRef(function=named):
                    self.by_pointer.add(named.path)
                case Call(function=called, arguments=arguments):
                    for parameter, argument in zip(called.parameters, arguments, strict=False):
                        self._add((parameter, 0), argument, s)

    def _add(self, scalar: NamedScalar, value: Expr | None, s: Stmt | None) -> None:
        self.scalars.setdefault(scalar, []).append(GivenValue(value, s))
