"""Static check of addresses of locals that a function leaves in a pointer at file scope: `dangling-pointer`.

    void Defaults(void)
    {
        Config small = { 4, 2, 9 };
        Used = &small;                                  /* `small` ends here, and another function reads Used->gain */
    }

Nothing but assignments of other objects comes behind the store: no call, no loop and no other use of the pointer, so
that it can only be for later.  Another function must follow the pointer without setting it.  Silent if a caller sets
the pointer too, if its address is taken, if it is a member or an element, and about `main`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from emulator.c28x.ctypes import PointerType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    CallPointer,
    Expr,
    For,
    Function,
    Load,
    LValue,
    PointerAdd,
    Stmt,
    Variable,
    While,
)
from emulator.c28x.tree_queries import addressed, assigned_variables, bare, blocks, own_nodes, parts, statements, within


def check_left_behind(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the addresses of locals that other functions follow when the function has returned."""
    owners = {function: reports[module] for module in modules for function in module.functions}
    kept = [
        (function, s, pointer, local)
        for function in owners if function.name != "main"
        for s, after in _followed(function.body, [])
        for pointer, local in _stores(s) if _ends_at_once(after, pointer)
    ]  # fmt: skip
    taken = addressed(p for f in owners for p in within(f.body)) if kept else set()
    for function, s, pointer, local in kept:
        if pointer in taken or _set_by_callers(function, pointer, owners):
            continue
        others = [f for f in owners if f is not function and pointer not in assigned_variables(f.body)]
        reader = next((f for f in others if any(_follows(p, pointer) for p in within(f.body))), None)
        if reader is not None:
            name = pointer.declaration.name
            message = (
                f"{name} keeps the address of {local.declaration.name}, a local that ends with {function.name}, and "
                f"{reader.name} follows it later"
            )
            owners[function].report(function, s.where, "dangling-pointer", message, object=name)


def _followed(body: list[Stmt], after: list[Stmt]) -> Iterator[tuple[Stmt, list[Stmt]]]:
    """The statements outside of loops, each with those that follow it in its block and in the blocks around."""
    for number, s in enumerate(body):
        rest = body[number + 1 :] + after
        yield s, rest
        if not isinstance(s, While | For):
            for block in blocks(s):
                yield from _followed(block, rest)


def _stores(s: Stmt) -> Iterator[tuple[Variable, Variable]]:
    """The pointer at file scope that a statement sets to the address of a local, and the local."""
    match s:
        case Assign(target=LValue(ctype=PointerType(), root=Variable(kind="global") as pointer), value=value):
            local = _local(value)
            if local is not None and isinstance(pointer.ctype, PointerType):
                yield pointer, local


def _local(e: Expr) -> Variable | None:
    """The local, or parameter, to which an expression points."""
    match bare(e):
        case PointerAdd(pointer=pointer):
            return _local(pointer)
        case AddressOf(lvalue=LValue(root=Variable(kind="local" | "parameter") as root)):
            return root
    return None


def _ends_at_once(after: list[Stmt], pointer: Variable) -> bool:
    """Whether statements neither call, nor turn, nor mention a pointer."""
    for s in statements(after):
        if isinstance(s, While | For):
            return False
        for p in own_nodes(s):
            if isinstance(p, Call | CallPointer) or (isinstance(p, LValue) and p.root is pointer):
                return False
    return True


def _follows(p: object, pointer: Variable) -> bool:
    """Whether a node is an object, or an element, to which a pointer points."""
    match p:
        case LValue(root=Load() as at) | LValue(root=PointerAdd() as at):
            return any(isinstance(q, LValue) and q.root is pointer for q in parts(at))
    return False


def _set_by_callers(function: Function, pointer: Variable, functions: Iterable[Function]) -> bool:
    """Whether a function that calls a function sets a pointer itself."""
    return any(
        pointer in assigned_variables(f.body)
        and any(isinstance(p, Call) and p.function is function for p in within(f.body))
        for f in functions
    )
