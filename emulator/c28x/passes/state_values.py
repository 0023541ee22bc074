"""The values that statements may give to a state, also through the functions that they call."""

from __future__ import annotations

from collections.abc import Container, Iterable
from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.tree import (
    Assign,
    Call,
    Conditional,
    Const,
    Expr,
    Function,
    FunctionRef,
    Load,
    LValue,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned, bare, own_nodes, statements

#: What a function may give to a state: a constant, the parameter with this number, or anything.
Given = tuple[str, int]
ANYTHING: Final[Given] = ("anything", 0)


class StateValues:
    """What the functions of a program may give to the objects at file scope."""

    def __init__(self, functions: list[Function]) -> None:
        self._parameters = {v for f in functions for v in f.parameters}
        self._by_pointer: set[str] = set()
        #: Object -> the functions that assign it, each with the assignments; function -> the calls of it, with callers.
        self._assigns: dict[Variable, list[tuple[Function, Stmt]]] = {}
        self._callers: dict[str, list[tuple[Function, Call]]] = {}
        for function in functions:
            for s in statements(function.body):
                if (variable := assigned(s)) is not None:
                    self._assigns.setdefault(variable, []).append((function, s))
                for p in own_nodes(s):
                    if isinstance(p, Call):
                        self._callers.setdefault(p.function.path, []).append((function, p))
                    elif isinstance(p, FunctionRef):
                        self._by_pointer.add(p.function.path)
        self._given: dict[Variable, dict[str, set[Given]]] = {}

    def of(self, state: Variable) -> set[int] | None:
        """The constants that the program gives to a state; None: it may give others too."""
        summaries = self._summaries(state)
        found = set().union(*summaries.values())
        passed = {path for path, given in summaries.items() if any(kind == "parameter" for kind, _ in given)}
        if self._by_pointer & passed or ANYTHING in found:
            return None
        return {value for kind, value in found if kind == "constant"}

    def of_statements(
        self, body: Iterable[Stmt], state: Variable, called: Container[str] | None = None
    ) -> set[Given]:
        """What statements, and the functions that they call, may give to a state.

        Of functions that are not `called`, it is only what the statements pass to them: they are looked at themselves.
        """
        found: set[Given] = set()
        summaries = self._summaries(state)
        parameters = tuple(self._parameters) if called is not None else ()
        for s in body:
            if assigned(s) is state:
                found |= _values(s.value, parameters) if isinstance(s, Assign) else {ANYTHING}
            for p in own_nodes(s):
                if isinstance(p, Call):
                    given = summaries.get(p.function.path, set())
                    if called is not None and p.function.path not in called:
                        given = {one for one in given if one[0] == "parameter"}
                    found |= _passed_on(given, p, parameters)
        return {one for one in found if one[0] != "parameter"}  # their callers say which

    def _summaries(self, state: Variable) -> dict[str, set[Given]]:
        """What each function, with those that it calls, may give to a state."""
        if state in self._given:
            return self._given[state]
        found: dict[str, set[Given]] = {}
        for function, s in self._assigns.get(state, ()):
            parameters = tuple(function.parameters)
            given = _values(s.value, parameters) if isinstance(s, Assign) else {ANYTHING}
            found.setdefault(function.path, set()).update(given)
        waiting = list(found)
        while waiting:
            path = waiting.pop()
            for function, call in self._callers.get(path, ()):
                mine = found.setdefault(function.path, set())
                more = _passed_on(found[path], call, tuple(function.parameters)) - mine
                if more:
                    mine |= more
                    waiting.append(function.path)
        self._given[state] = found
        return found


def start_of(v: Variable) -> int:
    """The value of an integer at the start."""
    start = constant_of(v.initial[0]) if v.initial else None
    return start if start is not None else 0


def constant_of(e: object) -> int | None:
    """The value of a constant integer; None: it is none."""
    inner = bare(e) if isinstance(e, Expr) else None
    return inner.value if isinstance(inner, Const) and isinstance(inner.value, int) else None


def named(e: Expr) -> Variable | None:
    """The integer at file scope of which an expression is just the value."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable(kind="global", ctype=IntType()) as v, indices=[])):
            return v
    return None


def _values(value: Expr, parameters: tuple[Variable, ...]) -> set[Given]:
    """What an expression may give."""
    match bare(value):
        case Const(value=int(number)):
            return {("constant", number)}
        case Conditional(then=then, otherwise=otherwise):
            return _values(then, parameters) | _values(otherwise, parameters)
        case Load(lvalue=LValue(root=Variable() as root, indices=[])) if root in parameters:
            return {("parameter", parameters.index(root))}
    return {ANYTHING}


def _passed_on(given: set[Given], call: Call, parameters: tuple[Variable, ...]) -> set[Given]:
    """What a call gives, if its function gives `given`."""
    found: set[Given] = set()
    for kind, number in given:
        if kind != "parameter":
            found.add((kind, number))
        elif number < len(call.arguments):
            found |= _values(call.arguments[number], parameters)
    return found
