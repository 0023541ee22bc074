"""The trees of a program in which a call of a small function is the value that it returns.

    static Uint16 Get_Level(void) { return level; }
    if (Get_Level() > FULL) ...                                 if (level > FULL) ...

Checks look for a value where it is used.  A small function has one statement: it returns an expression.  The trees have
that instead of the call, with the place of the call: there the value matters.  A function that nothing calls any more
is left out, or its parameter would be a value that nobody knows.

A function that gives a parameter to an object stays a call: a number that is passed goes out, and checks of counts are
silent about it.

A call stays as it is if the way would show: what an argument does would be done twice, or perhaps not at all, or after
something else.  A function that returns a constant is a name for it: it may be a choice of the build.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from copy import copy
from dataclasses import replace
from typing import Any, Final

from emulator.c28x.ctypes import FloatType, IntType, PointerType
from emulator.c28x.passes.rewriting import Rewriting
from emulator.c28x.passes.values import depends, volatile
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Call,
    Conditional,
    Expr,
    Function,
    Load,
    Logic,
    LValue,
    Return,
    Variable,
    Where,
)  # fmt: skip
from emulator.c28x.tree_queries import INNER, called, calls, once, own_nodes, parts, reached, source_text, within

#: CHOICE: the largest number of nodes in a small function.
_MOST: Final = 40


def with_small_functions(modules: Iterable[Module], entered: frozenset[str] = frozenset()) -> list[Module]:
    """The modules of a program, with what small functions return in the place of their calls.

    `entered` are the functions that are also called in other ways than by their names.
    """
    modules = list(modules)
    own = {function.path: function for module in modules for function in module.functions}
    small = {path: function for path, function in own.items() if _is_small(function)}
    if not small:
        return modules
    calls_of = {path: _called(function) for path, function in own.items()}
    for path in list(small):
        if path in reached(calls_of[path], lambda path: calls_of.get(path, ())):
            del small[path]
    view = _CallView(small)
    found = [view.module(module, module.variables) for module in modules]
    left = set[str]().union(*(_called(function) for module in found for function in module.functions))
    gone = set[str]().union(*calls_of.values()) & small.keys() - left - entered
    for module in found:
        module.functions = [function for function in module.functions if function.path not in gone]
    return found


@once
def _is_small(function: Function) -> bool:
    match function.body:
        case [Return(value=Expr() as value) as s]:
            return (
                depends(value) and len(own_nodes(s)) <= _MOST and not function.interrupt and function.given is None
                and all(isinstance(p.ctype, IntType | FloatType | PointerType) for p in function.parameters)
                and not any(p.in_memory for p in function.parameters)
            )  # fmt: skip
    return False


@once
def _called(function: Function) -> set[str]:
    return set(called(within(function.body)))


def _can_stand(function: Function, call: Call) -> bool:
    """Whether what a small function returns can stand where it is called."""
    nodes = own_nodes(function.body[0])
    mentions = Counter(p.root for p in nodes if isinstance(p, LValue) and isinstance(p.root, Variable))
    perhaps = any(isinstance(p, Logic | Conditional) for p in nodes)
    runs = any(map(calls, nodes))
    for parameter, argument in zip(function.parameters, call.arguments, strict=True):
        if calls(argument) or volatile(argument):
            if mentions[parameter] != 1 or perhaps or runs:
                return False
        elif runs and any(isinstance(p, LValue) and not _is_local(p) for p in parts(argument)):
            return False
    return not call.extra


def _is_local(lvalue: LValue) -> bool:
    return isinstance(lvalue.root, Variable) and lvalue.root.plain


class _CallView(Rewriting):
    """Writes functions anew, with what small functions return in the place of their calls."""

    def __init__(self, small: dict[str, Function]) -> None:
        super().__init__(())
        self._small = small

    def function(self, function: Function) -> Function:
        """A function with what those return that it calls."""
        inner = _called(function) & self._small.keys()
        if not inner:
            return function
        calls_now = function.calls.union(*(self._small[path].calls for path in reached(inner, self._inner)))
        return replace(function, body=self._node(function.body), calls=calls_now)

    def _inner(self, path: str) -> set[str]:
        return _called(self._small[path]) & self._small.keys()

    def instead(self, node: Any) -> Any:
        """What a small function returns, for a call of it."""
        while isinstance(node, Call) and (function := self._small.get(node.function.path)) is not None:
            (done,) = function.body
            if not isinstance(done, Return) or not _can_stand(function, node):
                break
            node = _written(done.value, dict(zip(function.parameters, node.arguments, strict=True)), node.where)
        return node


def _written(node: Any, given: dict[Variable, Expr], where: Where | None) -> Any:
    """A copy of an expression at another place, with what the parameters in it are given."""
    if isinstance(node, list):
        return [_written(part, given, where) for part in node]
    if isinstance(node, Load) and isinstance(node.lvalue.root, Variable) and node.lvalue.root in given:
        return _written(given[node.lvalue.root], {}, None)
    if type(node) not in INNER:
        return node
    written = copy(node)
    if where is not None and isinstance(written, Expr | LValue):
        written.where = where
    if isinstance(node, LValue) and given:
        texts = {parameter.declaration.name: source_text(value) for parameter, value in given.items()}
        written.text = re.sub(r"\w+", lambda word: texts.get(word[0], word[0]), node.text)
    for name in INNER[type(node)]:
        setattr(written, name, _written(getattr(node, name), given, where))
    return written
