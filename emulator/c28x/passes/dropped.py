"""Static check of results that say whether something worked, and that one call drops: `result-dropped`.

A function of the program returns one of several constants (0 and 1, FALSE and TRUE, the names of errors).  Its other
calls test that, so it may fail, and somebody must know; one call does not look at it and goes on.

Whether a result matters cannot be read from the function alone.  So the other calls must be at least two, and all of
them look at it.  A cast to `void` says that it is meant.  A branch that gives up anyway only tidies up.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Call,
    Compare,
    Conditional,
    Const,
    Declare,
    Evaluate,
    Expr,
    Function,
    FunctionRef,
    Load,
    Logic,
    LValue,
    Not,
    Return,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned, bare, blocks, own_nodes, statements

#: So many other calls must look at the result.
_LOOKS: Final = 2
_MEANT: Final = re.compile(r"\(\s*[vV]oid\s*\)")


def check_dropped(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the calls that drop what all other calls of the same function look at."""
    modules = list(modules)
    own = {function.path: function for module in modules for function in module.functions if not module.brought}
    dropped: dict[str, list[tuple[Module, Function, Stmt, bool]]] = {}
    looked: dict[str, int] = {}
    pointed: set[str] = set()
    for module in modules:
        for function in module.functions:
            for s, given_up in _with_ends(function.body):
                alone = s.value if isinstance(s, Evaluate) else None
                for p in own_nodes(s):
                    match p:
                        case Call(function=Function(path=path)) if p is alone:
                            dropped.setdefault(path, []).append((module, function, s, given_up))
                        case Call(function=Function(path=path)):
                            looked[path] = looked.get(path, 0) + 1
                        case FunctionRef(function=Function(path=path)):
                            pointed.add(path)
    for path, places in dropped.items():
        count = looked.get(path, 0)
        if len(places) > 1 or count < _LOOKS or path in pointed or path not in own or not _tells(own[path], own):
            continue
        module, function, s, given_up = places[0]
        if not given_up and not _is_meant(module, s):
            name = own[path].name
            message = f"the result of {name} is dropped here; the {count} other calls look at it"
            reports[module].report(function, s.where, "result-dropped", message, object=path)


def _with_ends(body: list[Stmt], given_up: bool = False) -> Iterator[tuple[Stmt, bool]]:
    """Every statement, and whether the block around it, not a whole function, ends with `return` and a constant.

    There the function has failed already, and only tidies up.
    """
    for s in body:
        yield s, given_up
        for block in blocks(s):
            last = block[-1] if block else None
            ends = isinstance(last, Return) and (last.value is None or isinstance(bare(last.value), Const))
            yield from _with_ends(block, ends)


def _tells(function: Function, own: dict[str, Function], above: frozenset[str] = frozenset()) -> bool:
    """Whether the result of a function only says how it went: every `return` gives a constant, not always the same one.

    The result of such a function, or a comparison, may be handed on.
    """
    if not isinstance(function.ctype.result, IntType) or function.path in above:
        return False
    given: set[object] = set()
    for s in statements(function.body):
        if isinstance(s, Return):
            if s.value is None or (values := _outcomes(s.value, function, own, above | {function.path})) is None:
                return False
            given |= values
    return len(given) > 1


def _outcomes(
    e: Expr, function: Function, own: dict[str, Function], above: frozenset[str]
) -> set[object] | None:  # fmt: skip
    """The constants that an expression of a function may be; None: it may be any number."""
    match bare(e):
        case Const(value=number):
            return {number}
        case Load(lvalue=LValue(root=Variable(kind="local") as local, indices=[])) if local.plain:
            found: set[object] = set()
            for s in statements(function.body):
                if assigned(s) is local and not (isinstance(s, Declare) and s.value is None):
                    value = s.value if isinstance(s, Assign | Declare) else None
                    given = bare(value) if isinstance(value, Expr) else None
                    if not isinstance(given, Const):
                        return None
                    found.add(given.value)
            return found
        case Compare() | Logic() | Not():
            return {0, 1}
        case Conditional(then=then, otherwise=otherwise):
            ways = _outcomes(then, function, own, above), _outcomes(otherwise, function, own, above)
            return None if ways[0] is None or ways[1] is None else ways[0] | ways[1]
        case Call(function=Function(path=path)) if path in own and _tells(own[path], own, above):
            return {0, 1}
    return None


def _is_meant(module: Module, s: Stmt) -> bool:
    """Whether the source casts the call to `void`."""
    lines = module.text.splitlines()
    inside = s.where.file == module.file and 0 < s.line <= len(lines)
    return inside and casts_to_void(lines[s.line - 1])


def casts_to_void(line: str) -> bool:
    """Whether a line of C casts to `void`: then it is meant that nothing uses the result."""
    return _MEANT.search(line) is not None
