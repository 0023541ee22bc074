"""Static check of rings whose index is written before the element that it guards: `published-early`.

    ringIn = next;
    ring[old] = c;

The interrupt routine compares `ringIn` with its own index to see whether there is an element.  If it comes between the
two statements, it takes an element that is not there yet.

The check needs a whole program without a kernel, in which the loop of `main` fills a ring and a routine empties it.  It
follows what a function switches off before (`DINT`, `..._disableInterrupt`, an enable bit), also in its callers.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any, Final

from emulator.c28x.ctypes import IntType, PointerType, StructType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Declare,
    Expr,
    Function,
    Index,
    Load,
    LValue,
    RegisterRef,
    Stmt,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    bare,
    blocks,
    last_loop,
    own_nodes,
    parts,
    register_text,
    source_text,
    statements,
)

#: An object: the variable or the structure that holds it, and the offset in words.
_Place = tuple[Variable | StructType, int]

#: Names of functions that switch interrupts off, or on; and of registers that do either.
_OFF: Final = re.compile(r"DINT|disable|mask|(?<![bcf])lock|enter", re.IGNORECASE)
_ON: Final = re.compile(r"EINT|enable|unmask|unlock|restore|leave", re.IGNORECASE)
_ENABLES: Final = re.compile(r"\bIER|INTENA|FIENA|INTM|ENA\b|TIE\b")


def check_published(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the elements of rings that are written behind the index which guards them."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    own = {function.path: function for function in owners}
    main = next((function for function in owners if function.name == "main" and function.body), None)
    loop = last_loop(main) if main is not None else None
    if main is None or loop is None:
        return
    routines = [_below([f.path], own) for f in owners if f.interrupt]
    guards = {index: rings for routine in routines for index, rings in _guards(routine).items()}
    inside = {function.path for routine in routines for function in routine}
    if not guards:
        return
    turns = list(statements(loop.body))
    called = _below([p.function.path for s in turns for p in own_nodes(s) if isinstance(p, Call)], own)
    bodies = {main: loop.body, **{function: function.body for function in called if function.path not in inside}}
    for function, body in bodies.items():
        for s, later in _early(body, guards):
            if not _off_at(body, {id(s)}) and not _called_off(function, bodies):
                name = source_text(Load(s.target.ctype, s.target)) if isinstance(s.target, LValue) else ""
                message = (
                    f"{name} is written before the element that it guards (line {later.line}): an interrupt routine "
                    "that comes in between takes an element which is not there yet"
                )
                owners[function].report(function, s.where, "published-early", message, object=name)


def _below(paths: Iterable[str], own: dict[str, Function]) -> list[Function]:
    """Functions and all that they call, directly or not."""
    found: dict[str, Function] = {}
    waiting = list(paths)
    while waiting:
        path = waiting.pop()
        if path in own and path not in found:
            found[path] = own[path]
            waiting += own[path].calls
    return list(found.values())


def _place(lvalue: LValue) -> _Place | None:
    """The object at file scope, or the member of a structure, that an lvalue names; of an element, its array."""
    root = lvalue.root
    if isinstance(root, Variable):
        if isinstance(root.ctype, StructType):
            return root.ctype, lvalue.words
        return (root, lvalue.words) if root.kind == "global" else None
    if isinstance(root.ctype, PointerType) and isinstance(root.ctype.target, StructType):
        return root.ctype.target, lvalue.words
    return None


def _scalar(e: Expr) -> _Place | None:
    """The integer of which an expression is just the value."""
    match bare(e):
        case Load(ctype=IntType(), lvalue=LValue(indices=[]) as lvalue):
            return _place(lvalue)
    return None


def _mentions(e: Any, place: _Place) -> bool:
    return any(isinstance(p, LValue) and not p.indices and _place(p) == place for p in parts(e))


def _written(s: Stmt) -> _Place | None:
    """The integer that a statement writes."""
    if isinstance(s, Assign) and isinstance(s.target, LValue) and not s.target.indices:
        return _place(s.target)
    return None


def _guards(routine: list[Function]) -> dict[_Place, set[_Place]]:
    """The indices that a routine compares with an index of its own, each with the rings that its own one reads."""
    nodes = [p for function in routine for s in statements(function.body) for p in own_nodes(s)]
    written = {_written(s) for function in routine for s in statements(function.body)}
    found: dict[_Place, set[_Place]] = {}
    for p in nodes:
        if not isinstance(p, Compare):
            continue
        for mine, other in ((_scalar(p.left), _scalar(p.right)), (_scalar(p.right), _scalar(p.left))):
            if mine is None or other is None or mine not in written or other in written:
                continue
            rings = {
                place for q in nodes if isinstance(q, Load) and len(q.lvalue.indices) == 1
                and _mentions(q.lvalue.indices[0], mine) and (place := _place(q.lvalue)) is not None
            }  # fmt: skip
            if rings:
                found[other] = rings
    return found


def _early(body: list[Stmt], guards: dict[_Place, set[_Place]]) -> Iterator[tuple[Assign, Stmt]]:
    """The statements that write an index, each with the one behind it that writes the element before that index."""
    copies: dict[Variable, set[_Place | None]] = {}
    for s in statements(body):
        match s:
            case (
                Declare(variable=copy, value=Expr() as value)
                | Assign(target=LValue(root=Variable(kind="local") as copy, indices=[]), value=value)
            ):  # fmt: skip
                copies.setdefault(copy, set()).add(_scalar(value))
    for block in _all_blocks(body):
        for number, s in enumerate(block):
            index = _written(s)
            if index is None or index not in guards or not isinstance(s, Assign):
                continue
            following = block[number + 1 :]
            if any(_written(later) == index for later in following):
                continue
            for later in following:
                match later:
                    case Assign(target=LValue(indices=[Index(expr=at)]) as target) if _place(target) in guards[index]:
                        if _is_before(at, index, bare(s.value), copies):
                            yield s, later
                            break


def _is_before(at: Expr, index: _Place, given: Expr, copies: dict[Variable, set[_Place | None]]) -> bool:
    """Whether a subscript is an index as it was before it got a value: its copy, or one less than it is now."""
    match bare(at):
        case Load(lvalue=LValue(root=Variable(kind="local") as copy, indices=[])):
            return copies.get(copy) == {index}
    for p in parts(at):
        match p:
            case Binary(op="-", left=left, right=right) if constant_of(right) == 1:
                pass
            case Binary(op="%" | "&" as op, left=summed, right=around):
                match bare(summed), constant_of(around):
                    case Binary(op="+", left=left, right=right), int(size) if constant_of(right) == size - (op == "%"):
                        pass
                    case _:
                        continue
            case _:
                continue
        if _mentions(left, index) or any(q == given for q in parts(left) if isinstance(q, Load)):
            return True
    return False


def _all_blocks(body: list[Stmt]) -> Iterator[list[Stmt]]:
    yield body
    for s in body:
        for inner in blocks(s):
            yield from _all_blocks(inner)


def _off_at(body: list[Stmt], places: set[int]) -> bool:
    """Whether the last switch of interrupts in the text before a statement, one of some identities, is off."""
    off = False
    for s in statements(body):
        if off and id(s) in places:
            return True
        for p in own_nodes(s):
            if isinstance(p, Call):
                off = (off or _OFF.search(p.function.name) is not None) and not _ON.search(p.function.name)
        if isinstance(s, Assign) and isinstance(s.target, RegisterRef) and _ENABLES.search(register_text(s.target)):
            value = bare(s.value)
            off = constant_of(value) == 0 or (isinstance(value, Binary) and value.op == "&")
    return False


def _called_off(function: Function, bodies: dict[Function, list[Stmt]], seen: frozenset[str] = frozenset()) -> bool:
    """Whether a caller of a function, or a caller of that, has switched interrupts off."""
    if function.path in seen:
        return False
    for caller, body in bodies.items():
        calls_it = {
            id(s) for s in statements(body)
            for p in own_nodes(s) if isinstance(p, Call) and p.function.path == function.path
        }  # fmt: skip
        if calls_it and (_off_at(body, calls_it) or _called_off(caller, bodies, seen | {function.path})):
            return True
    return False
