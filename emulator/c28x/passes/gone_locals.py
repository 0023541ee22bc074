"""Static check of addresses of locals that outlive the call: `dangling-pointer`.

    static const char *describe(void)
    {
        char text[48];
        sprintf(text, ...);
        return text;                    /* the next call reuses the words of `text` */
    }

    void Defaults(void)
    {
        Config small = { 4, 2, 9 };
        Used = &small;                  /* `small` ends here, and another function reads Used->gain */
    }

An address may come through a local pointer that only ever points into the local (`return p;` behind
`*--p = digit;`), or through a function of the library that returns its first argument (`return strcpy(text, from);`).

Silent about a returned local that nothing is stored in: such a function measures the stack.

Of an address that a function leaves at file scope it is told if nothing but assignments of other objects comes behind
the store: no call, no loop and no other use of the pointer, so that it can only be for later.  Another function must
follow the pointer without setting it.  Silent if a caller sets the pointer too, if its address is taken, if it is a
member or an element, and about `main`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.ctypes import ArrayType, PointerType, StructType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    CallPointer,
    Conditional,
    CopyStruct,
    Declare,
    Expr,
    For,
    Function,
    Load,
    LValue,
    PointerAdd,
    Return,
    Stmt,
    Variable,
    While,
)
from emulator.c28x.tree_queries import (
    addressed,
    assigned,
    assigned_variables,
    bare,
    blocks,
    gives,
    own_nodes,
    parts,
    statements,
    within,
)

#: Functions of the library that return their first argument, or a place in what it points to.
_RETURNS_FIRST: Final = frozenset((
    "strcpy", "strncpy", "strcat", "strncat", "strchr", "strrchr", "strstr", "strpbrk", "memcpy", "memmove", "memset",
    "memchr",
))  # fmt: skip
#: So many local pointers lead to one another.
_DEEPEST: Final = 4


def check_gone_locals(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the addresses of locals that a function returns, or leaves where other functions follow them."""
    owners = {function: reports[module] for module in modules for function in module.functions}
    for function, report in owners.items():
        if any(v.in_memory for v in (*function.locals, *function.parameters)):
            _check_returned(function, report)
    _check_left_behind(owners)


def _check_returned(function: Function, report: StaticReport) -> None:
    for s in statements(function.body):
        if not isinstance(s, Return) or s.value is None or not isinstance(s.value.ctype, PointerType):
            continue
        for v in _locals(s.value, function):
            if _is_filled(v, function):
                name = v.declaration
                message = (
                    f"{function.path} returns the address of its local {name.name}, whose words the next call or "
                    f"interrupt uses"
                )  # fmt: skip
                report.report(function, s.where, "dangling-pointer", message, object=name.path, declaration=name)
                break


def _locals(e: Expr, function: Function, deep: int = _DEEPEST) -> Iterator[Variable]:
    """The locals of a function one of which an expression certainly points into."""
    match bare(e):
        case AddressOf(lvalue=LValue(root=Variable(kind="local" | "parameter") as v)):
            yield v
        case AddressOf(lvalue=LValue(root=Expr() as pointer)) | PointerAdd(pointer=pointer):
            yield from _locals(pointer, function, deep)
        case Conditional(then=then, otherwise=otherwise):
            yield from _locals(then, function, deep)
            yield from _locals(otherwise, function, deep)
        case Call(function=Function(extern=True, name=name), arguments=[first, *_]) if name in _RETURNS_FIRST:
            yield from _locals(first, function, deep)
        case Load(
            ctype=PointerType(), lvalue=LValue(root=Variable(kind="local", in_memory=False) as pointer, indices=[])
        ) if deep:
            values = [value for target, value in map(_given, statements(function.body)) if target is pointer]
            olds = {v for v, value in map(_given, statements(function.body)) if v and v.kind == "temporary"
                    and value is not None and _steps(value, {pointer})}
            values = [value for value in values if value is None or not _steps(value, {pointer, *olds})]
            found = [list(_locals(value, function, deep - 1)) if value is not None else [] for value in values]
            if found and all(found):
                yield from found[0]


def _given(s: Stmt) -> tuple[Variable | None, Expr | None]:
    """The variable that a statement assigns, and the value."""
    if isinstance(s, Declare) and s.value is None:
        return None, None
    given = gives(s)
    return assigned(s), given[1] if given is not None else None


def _steps(value: Expr, same: set[Variable]) -> bool:
    """Whether a value is that of the pointer itself, moved.  `same`: the pointer, and what holds its old value."""
    match bare(value):
        case PointerAdd(pointer=inner):
            return _steps(inner, same)
        case Load(lvalue=LValue(root=Variable() as root, indices=[])):
            return root in same
    return False


def _is_filled(v: Variable, function: Function) -> bool:
    """Whether something is stored in a local: by a statement, or by a function that gets its address."""
    whole = isinstance(v.ctype, ArrayType | StructType)
    for s in statements(function.body):
        match s:
            case Declare(variable=variable, value=value) if variable is v and value is not None:
                if whole or (isinstance(value, Expr) and constant_of(value) is None):
                    return True
            case Assign(target=LValue(root=root), value=value) if root is v and (whole or constant_of(value) is None):
                return True
            case CopyStruct(target=LValue(root=root)) if root is v:
                return True
        if any(v in addressed(p.arguments) for p in own_nodes(s) if isinstance(p, Call | CallPointer)):
            return True
        if any(v in addressed([p]) for p in own_nodes(s)) and not isinstance(s, Return):
            return True  # through a pointer
    return False


def _check_left_behind(owners: dict[Function, StaticReport]) -> None:
    """Report the addresses of locals that other functions follow when the function has returned."""
    kept = [
        (function, s, pointer, local)
        for function in owners if function.name != "main"
        for s, after in _followed(function.body, [])
        for pointer, local in _stores(s, function) if _ends_at_once(after, pointer)
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


def _stores(s: Stmt, function: Function) -> Iterator[tuple[Variable, Variable]]:
    """The pointer at file scope that a statement sets to the address of a local, and the local."""
    match s:
        case Assign(target=LValue(ctype=PointerType(), root=Variable(kind="global") as pointer), value=value):
            local = next(_locals(value, function), None)
            if local is not None and isinstance(pointer.ctype, PointerType):
                yield pointer, local


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
