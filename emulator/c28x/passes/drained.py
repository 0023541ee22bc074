"""Static check of rings from which one element is taken for each flag: `one-for-many`.

    interrupt void Received(void) { ring[in] = SCIRXBUF; in = (in + 1) & 15; arrived = 1; }
    ...
    if (arrived) { arrived = 0; Take(ring[out]); out = (out + 1) & 15; }

A flag does not count.  If the routine runs twice before `main` looks, two elements are in the ring and one is taken:
the other one stays there until the next comes, and from then on the ring is never empty.

The test may also be a wait (`while (!arrived) ;`), or lead away (`if (!arrived) continue;`).

Silent if `main` compares the two indices anywhere, or counts what is in the ring: then it can know.  Silent too if the
routine asks for the flag, and then may wait for `main`, or if `main` sets it itself as long as there is more.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from emulator.c28x.ctypes import ArrayType, IntType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of, named
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Compare,
    Expr,
    For,
    Function,
    If,
    Load,
    LValue,
    Not,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    all_blocks,
    assigned,
    bare,
    below,
    blocks,
    last_loop,
    leaves,
    own_nodes,
    parts,
    statements,
)


def check_drained(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the places where one element is taken for each flag."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    own = {function.path: function for function in owners}
    main = next((function for function in owners if function.name == "main" and function.body), None)
    if main is None or last_loop(main) is None:
        return
    inside = below((f.path for f in owners if f.interrupt), own)
    filled = [ring for function in inside for ring in _filled(function)]
    if not filled:
        return
    outside = [f for f in below([main.path], own) if f not in inside]
    flags = {v for f in inside for s in statements(f.body) if (v := _set(s, others=False)) is not None}
    flags -= {v for f in outside for s in statements(f.body) if (v := _set(s, others=False)) is not None}
    flags -= {
        p.root for f in inside for s in statements(f.body) if isinstance(s, If | While) for p in parts(s.test)
        if _is_object(p)
    }  # fmt: skip
    for ring, index in filled:
        if any(_compares(f, index) for f in outside):
            continue
        for function in outside:
            for s, flag, behind in found_set(all_blocks(function.body), flags):
                body = list(_once(behind, own, frozenset({function.path})))
                cleared = any(_set(x, others=True) is flag for x in body)
                taken = {v for x in body if (v := _stepped(x)) is not None and v is not index}
                if cleared and any(_reads(x, ring, taken) for x in body):
                    name = flag.declaration
                    message = (
                        f"one element of {ring.declaration.name} is taken for each {name.name}, which does not count: "
                        "if two came before, one stays"
                    )
                    owners[function].report(
                        function, s.where, "one-for-many", message, object=name.path, declaration=name
                    )  # fmt: skip


def _stepped(s: Stmt) -> Variable | None:
    """The index at file scope that a statement moves to the next element, also around the end."""
    if isinstance(s, Assign) and (index := assigned(s)) is not None and index.kind == "global":
        sums = [p for p in parts(s.value) if isinstance(p, Binary) and p.op == "+" and constant_of(p.right) == 1]
        mentioned = {p.root.declaration for q in sums for p in parts(q.left) if _is_object(p)}
        if index.declaration in mentioned:
            return index
    return None


def _is_object(p: object) -> bool:
    return isinstance(p, LValue) and isinstance(p.root, Variable)


def _filled(function: Function) -> Iterator[tuple[Variable, Variable]]:
    """The rings that a function fills, each with its index."""
    steps = {v for s in statements(function.body) if (v := _stepped(s)) is not None}
    for s in statements(function.body):
        match s:
            case Assign(target=LValue(root=Variable(kind="global", ctype=ArrayType()) as ring, indices=[index])):
                for v in steps:
                    if any(_is_object(p) and p.root.declaration == v.declaration for p in parts(index.expr)):
                        yield ring, v


def _set(s: Stmt, *, others: bool) -> Variable | None:
    """The object at file scope that a statement sets to a constant: to 0 (`others`), or to another one."""
    if isinstance(s, Assign) and isinstance(s.target, LValue) and isinstance(s.target.ctype, IntType):
        v, number = assigned(s), constant_of(s.value)
        if v is not None and v.kind == "global" and number is not None and (number == 0) == others:
            return v
    return None


def found_set(each: Iterable[list[Stmt]], flags: set[Variable]) -> Iterator[tuple[Stmt, Variable, list[Stmt]]]:
    """The tests and the waits for flags in blocks, each with the flag and the statements that run when it is set."""
    for block in each:
        for number, s in enumerate(block):
            match s:
                case If(test=test, then=then):
                    if (flag := _tested(test, flags)) is not None:
                        yield s, flag, then
                    elif (flag := _not_set(test, flags)) is not None and leaves(then):
                        yield s, flag, block[number + 1 :]
                case While(test=test) if (flag := _not_set(test, flags)) is not None:
                    yield s, flag, block[number + 1 :]


def _not_set(test: Expr, flags: set[Variable]) -> Variable | None:
    """The flag that a test wants not to be set."""
    match test:
        case Not(operand=operand):
            return _tested(operand, flags)
        case Compare(op="==", left=left, right=right) if constant_of(right) == 0:
            return _tested(left, flags)
    return None


def _tested(test: Expr, flags: set[Variable]) -> Variable | None:
    """The flag that a test asks for."""
    if isinstance(test, Compare) and (number := constant_of(test.right)) is not None:
        if test.op == "==" and number == 0:
            return None
        test = test.left
    flag = named(test)
    return flag if flag in flags else None


def _once(body: list[Stmt], own: dict[str, Function], above: frozenset[str]) -> Iterator[Stmt]:
    """Statements that run once at most, also of functions that are called; those of loops are left out."""
    for s in body:
        yield s
        if isinstance(s, While | For):
            continue
        for p in own_nodes(s):
            if isinstance(p, Call) and p.function.path in own and p.function.path not in above:
                yield from _once(own[p.function.path].body, own, above | {p.function.path})
        for block in blocks(s):
            yield from _once(block, own, above)


def _reads(s: Stmt, ring: Variable, indices: set[Variable]) -> bool:
    """Whether a statement reads an element at one of some indices."""
    for p in own_nodes(s):
        match p:
            case Load(lvalue=LValue(root=root, indices=[index])) if root is ring:
                used = {q.root.declaration for q in parts(index.expr) if _is_object(q)}
                if used & {v.declaration for v in indices}:
                    return True
    return False


def _compares(function: Function, index: Variable) -> bool:
    """Whether a function compares an index with another one, or subtracts the two."""
    for s in statements(function.body):
        for p in own_nodes(s):
            match p:
                case Compare(left=left, right=right) | Binary(op="-", left=left, right=right):
                    sides = [bare(left), bare(right)]
                    if any(isinstance(e, Load) and e.lvalue.root is index for e in sides):
                        return True
    return False
