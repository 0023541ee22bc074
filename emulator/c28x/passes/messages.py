"""Static check of mailboxes whose messages are smaller than the structure that both sides give them: `message-cut`.

    Box = Mailbox_create(sizeof(EVENT *), 8, NULL, NULL);
    Mailbox_post(Box, &event, BIOS_NO_WAIT);        // an EVENT, not its address

The handle is an object at file scope, or a member, that gets one mailbox.  Every post and every pend by this name must
pass the same structure, and something must read a member of it that does not arrive.
"""

from __future__ import annotations

from collections.abc import Iterable

from emulator.c28x.ctypes import CType, PointerType, StructType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Assign, Call, Expr, Function, Load, LValue, Stmt, Variable
from emulator.c28x.tree_queries import NamedScalar, bare, named_scalar, own_nodes, statements

_SIDES = ("Mailbox_post", "Mailbox_pend")


def check_messages(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the mailboxes that are created too small for what is posted to them and taken from them."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    created: dict[NamedScalar, list[tuple[Function, Stmt, int | None]]] = {}
    passed: dict[NamedScalar, set[tuple[str, CType | None]]] = {}
    for function in owners:
        for s in statements(function.body):
            for p in own_nodes(s):
                if isinstance(p, Call) and p.function.name in _SIDES and (handle := _named(p.arguments[0])) is not None:
                    passed.setdefault(handle, set()).add((p.function.name, _target(p.arguments[1])))
            match s:
                case Assign(target=LValue() as target, value=value) if (handle := named_scalar(target)) is not None:
                    created.setdefault(handle, []).append((function, s, _size(value)))
    for handle, makers in created.items():
        structures = {structure for _, structure in passed.get(handle, ())}
        if len(makers) != 1 or len(structures) != 1 or len(passed[handle]) != len(_SIDES):
            continue
        (function, s, size), (structure,) = makers[0], structures
        if size is None or not isinstance(structure, StructType) or structure.words <= size:
            continue
        if any(_reads_behind(t, structure, size) for f in owners for t in statements(f.body)):
            assert isinstance(s, Assign)
            assert isinstance(s.target, LValue)
            message = (
                f"a message has {size} words, and {structure} has {structure.words}: what is posted behind them does "
                "not arrive"
            )
            owners[function].report(function, s.where, "message-cut", message, object=s.target.text, value=size)


def _named(e: Expr) -> NamedScalar | None:
    """The handle of a call, if it is an object at file scope or a member."""
    match bare(e):
        case Load(lvalue=lvalue):
            handle = named_scalar(lvalue)
            local = handle is not None and isinstance(handle[0], Variable) and handle[0].kind != "global"
            return None if local else handle
    return None


def _size(value: Expr) -> int | None:
    """The words of a message of a mailbox that a value creates; None: it creates none, or they are not known."""
    match bare(value):
        case Call(function=Function(name="Mailbox_create"), arguments=[size, *_]):
            return constant_of(size)
    return None


def _target(e: Expr) -> CType | None:
    """What an argument points to; None: not known."""
    ctype = bare(e).ctype
    return ctype.target if isinstance(ctype, PointerType) else None


def _reads_behind(s: Stmt, structure: StructType, size: int) -> bool:
    """Whether a statement reads a member of a structure that lies behind so many words."""
    read = [p.lvalue for p in own_nodes(s) if isinstance(p, Load)]
    return any(
        lvalue.ctype != structure and lvalue.words + lvalue.ctype.words > size and _holder(lvalue) == structure
        for lvalue in read
    )


def _holder(lvalue: LValue) -> CType | None:
    root = lvalue.root
    return root.ctype if isinstance(root, Variable) else _target(root)
