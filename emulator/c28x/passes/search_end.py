"""Static check of searches in a table that may end behind it, and use the element where they ended: `table-short`.

    while (k < POINTS && code > Codes[k])
        k++;
    if (code >= Codes[k]) ...

    for (k = 0; k < POINTS; k++)
        if (code <= Codes[k])
            break;
    return Degrees[k];

A code above the last one of the table ends the search at POINTS.  The table must be constant, so that its last element
is known.  Silent if that is the end of a scale (4095, 32767), or if something else tests the code or the place.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.admitted import upper_limits
from emulator.c28x.passes.given import GivenValues
from emulator.c28x.passes.intervals import interval
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.passes.tables import is_step
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Break,
    Compare,
    Expr,
    For,
    Function,
    If,
    Index,
    Load,
    Logic,
    LValue,
    RegisterLoad,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    OPPOSITE,
    TURNED,
    all_blocks,
    bare,
    blocks,
    leaves,
    named_scalar,
    own_nodes,
    parts,
    statements,
    within,
)

#: The full scale of a converter of 12 bits: nothing that it gives is above.
_FULL_SCALE: Final = 4095
#: Comparisons of a value with an element by which a search goes on.
_ABOVE: Final = (">", ">=")


class _Search(NamedTuple):
    """A loop that looks for the first element that is not below a value, from its place on up to the end."""

    place: Variable
    end: int
    value: Variable
    last: int
    test: Compare


def check_searches(reports: dict[Module, StaticReport], given: GivenValues) -> None:
    """Report the elements that are used where a search has ended, if that may be behind the end."""
    homes = {id(s): f for module in reports for f in module.functions for s in statements(f.body)}
    for module, report in reports.items():
        for function in module.functions:
            for block in all_blocks(function.body):
                for at, loop in enumerate(block):
                    search = _search(loop)
                    used = _used(block[at + 1 :], search) if search is not None else None
                    if search is None or used is None or _tested(function, search, used[0]):
                        continue
                    sources = given.of((search.value, 0))
                    if any(one.by is not None and _free(one.value, search, homes[id(one.by)]) for one in sources):
                        _report(function, loop, search, used, report)


def _report(
    function: Function, loop: Stmt, search: _Search, used: tuple[Stmt, LValue], report: StaticReport
) -> None:  # fmt: skip
    s, element = used
    assert isinstance(element.root, Variable)
    name, above = element.root.declaration, f"{search.value.declaration.name} is above {search.last}"
    message = (
        f"{search.place.declaration.name} is {search.end} if {above} (line {loop.line}), and {name.name} has only "
        f"{element.indices[0].bound} elements"
    )
    report.report(function, s.where, "table-short", message, object=name.path, declaration=name, value=search.end)


def _search(loop: Stmt) -> _Search | None:
    """The search that a loop is; None: it is none."""
    match loop:
        case While(test=test, body=body, step=step):
            limits = list(upper_limits(test))
            stepped = [s for s in (*body, *step) if isinstance(s, Assign) and isinstance(s.target, LValue)]
            if len(limits) != 1 or len(stepped) != 1 or not is_step(limits[0][0], stepped[0].value):
                return None
            lvalue, end = limits[0][0], limits[0][1] + 1
            others = [s for s in body if s is not stepped[0]]
            compares = [c for c in _operands(test) if c is not limits[0][2]]
        case For(variable=lvalue, stop=stop, step=1, body=others):
            end, compares = constant_of(stop) or 0, []
        case _:
            return None
    match others:
        case []:
            pass
        case [If(test=Compare(op=op) as ends, then=[Break()], otherwise=[])] if op in OPPOSITE:
            compares = [*compares, Compare(ends.ctype, OPPOSITE[op], ends.left, ends.right)]
        case _:
            return None
    place = lvalue.root
    if len(compares) != 1 or not isinstance(place, Variable) or not place.plain or end < 1:
        return None
    (compare,) = compares
    turned = TURNED.get(compare.op, "")
    for value, op, element in (
        (bare(compare.left), compare.op, compare.right), (bare(compare.right), turned, compare.left),
    ):  # fmt: skip
        last = _last(element, place, end)
        if last is None or op not in _ABOVE or not isinstance(value, Load) or value.lvalue.indices:
            continue
        sought, ctype = value.lvalue.root, value.ctype
        if isinstance(sought, Variable) and sought.plain and isinstance(ctype, IntType):
            full = last >= min(_FULL_SCALE, ctype.high) or not last & last + 1
            return None if full else _Search(place, end, sought, last, compare)
    return None


def _operands(test: Expr) -> list[Compare]:
    operands = test.operands if isinstance(test, Logic) and test.op == "and" else [test]
    return [o for o in operands if isinstance(o, Compare)]


def _last(e: Expr, place: Variable, end: int) -> int | None:
    """The last element that a search compares, if its table is constant and the place its only subscript."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable(constant=True, initial=list(values)), indices=[index]) as lvalue):
            leaf = lvalue.leaf + (end - 1) * index.leaves
            if _is(index.expr, place) and leaf < len(values):
                return constant_of(values[leaf])
    return None


def _is(e: Expr, variable: Variable) -> bool:
    inner = bare(e)
    return isinstance(inner, Load) and inner.lvalue.root is variable and not inner.lvalue.indices


def _used(behind: list[Stmt], search: _Search) -> tuple[Stmt, LValue] | None:
    """The first element behind a loop at the place where the search ended, if the array ends before that."""
    for s in behind:
        nodes = own_nodes(s)
        subscripts = {id(p) for q in nodes if isinstance(q, Index) for p in parts(q.expr)}
        for p in nodes:
            if isinstance(p, LValue) and p.root is search.place and id(p) not in subscripts:
                return None
        pointed = {id(p.lvalue) for p in nodes if isinstance(p, AddressOf)}
        for p in nodes:
            if isinstance(p, LValue) and isinstance(p.root, Variable) and len(p.indices) == 1 and id(p) not in pointed:
                index = p.indices[0]
                if index.bound is not None and index.bound <= search.end and _is(index.expr, search.place):
                    return s, p
        if any(isinstance(p, LValue) and p.root is search.place for block in blocks(s) for p in within(block)):
            return None
    return None


def _tested(function: Function, search: _Search, used: Stmt) -> bool:
    """Whether a function may keep the value from being above the last element."""
    for s in statements(function.body):
        match s:
            case Assign(target=LValue(root=root)) if root is search.value:
                return True
            case If(test=Compare(op="<" | "<=", left=left), then=then, otherwise=[]) if (
                _is(left, search.value) and leaves(then)
            ):  # fmt: skip
                continue
        for p in own_nodes(s) if s is not used else ():
            sides = (p.left, p.right) if isinstance(p, Compare) else ()
            if not sides or any(_last(side, search.place, search.end) is not None for side in sides):
                continue
            if any(isinstance(q, LValue) and q.root is search.value for q in parts(p)):
                return True
    return False


def _free(value: Expr | None, search: _Search, function: Function) -> bool:
    """Whether a value that the search gets may be above the last element, and its function does not test it."""
    inner = bare(value) if value is not None else None
    if isinstance(inner, RegisterLoad):
        return interval(inner, {})[1] > search.last
    scalar = named_scalar(inner.lvalue) if isinstance(inner, Load) else None
    if inner is None or scalar is None or not isinstance(inner.ctype, IntType) or inner.ctype.high <= search.last:
        return False
    tests = [p for p in within(function.body) if isinstance(p, Compare)]
    return not any(isinstance(q, LValue) and named_scalar(q) == scalar for p in tests for q in parts(p))
