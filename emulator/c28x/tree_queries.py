"""Questions about the typed tree: what it touches, calls, changes, and whether it comes to its end."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Break,
    Call,
    CallPointer,
    Const,
    Continue,
    Convert,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    If,
    Index,
    Load,
    LValue,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Unary,
    Variable,
    While,
)  # fmt: skip

#: `EALLOW` and `EDIS` set and clear a bit of ST1 (CPU, instruction set): no call, and nobody else sees them.
INSTRUCTIONS: Final = {"EALLOW": "_cpu.eallow = True", "EDIS": "_cpu.eallow = False"}
OBSERVABLE: Final = (RegisterLoad, Call, CallPointer)


def source_text(e: Expr) -> str:
    """An expression as its source says it, for a report; conversions that C makes by itself are left out."""
    match e:
        case Load(lvalue=lvalue) | AddressOf(lvalue=lvalue):
            return lvalue.text or "expression"
        case Const(value=value):
            return f"{value:g}" if isinstance(value, float) else str(value)
        case Convert(operand=operand):
            return source_text(operand)
        case Unary(op=op, operand=operand):
            return f"{op}{source_text(operand)}"
        case Binary(op=op, left=left, right=right):
            return f"{source_text(left)} {op} {source_text(right)}"
        case Call(function=function):
            return f"{function.name}(...)"
        case RegisterLoad(register=ref):
            return f"{ref.block}.{ref.register}" + (f".bit.{ref.field.name}" if ref.field else "")
    return "expression"


def parts(e: Any) -> Iterator[Any]:
    """Every expression and lvalue below `e`, itself included."""
    yield e
    for value in vars(e).values() if hasattr(e, "__dict__") else ():
        for inner in value if isinstance(value, list) else [value]:
            if isinstance(inner, Expr | LValue | Index):
                yield from parts(inner)


def observable(e: Any) -> bool:
    """Whether evaluating `e` touches anything that another task, an interrupt or a peripheral can see."""
    for part in parts(e):
        if isinstance(part, OBSERVABLE):
            return True
        if isinstance(part, LValue) and (isinstance(part.root, Expr) or part.root.kind == "global"):
            return True
    return False


def calls(e: Any) -> bool:
    """Whether evaluating `e` runs a function."""
    return any(isinstance(part, Call | CallPointer) for part in parts(e))


def identifiers(text: str) -> set[str]:
    """The names in an index text."""
    return set("".join(c if c.isalnum() or c == "_" else " " for c in text).split())


def changed_names(body: list[Stmt]) -> set[str]:
    """Names of the variables that statements assign."""
    names: set[str] = set()
    for s in body:
        match s:
            case Assign(target=LValue(root=Variable() as root)) | For(variable=LValue(root=Variable() as root)):
                names.add(root.name)
            case Declare(variable=variable):
                names.add(variable.name)
            case CopyStruct(target=LValue(root=Variable() as root)):
                names.add(root.name)
        match s:
            case If(then=a, otherwise=b):
                names |= changed_names(a) | changed_names(b)
            case While(body=inner) | For(body=inner):
                names |= changed_names(inner)
            case Switch(cases=cases):
                for _, inner in cases:
                    names |= changed_names(inner)
    return names


def leaves(body: list[Stmt]) -> bool:
    """Whether statements never reach what stands behind them."""
    match body[-1] if body else None:
        case Return() | Break() | Continue():
            return True
        case If(then=a, otherwise=b):
            return leaves(a) and leaves(b)
    return False


def visible_to_others(body: list[Stmt]) -> bool:
    """Whether any statement touches what others can see."""
    for s in body:
        match s:
            case Assign(target=target, value=value):
                if isinstance(target, RegisterRef) or observable(target) or observable(value):
                    return True
            case Evaluate(value=Call(function=Function(extern=True, name=name))) if name in INSTRUCTIONS:
                pass
            case Return(value=Expr() as value) if observable(value):
                return True
            case Evaluate() | CopyStruct():
                return True
            case Declare(value=Expr() as value) if observable(value):
                return True
            case Declare(value=list() as values) if any(observable(value) for value in values):
                return True
            case If(test=test, then=a, otherwise=b):
                if observable(test) or visible_to_others(a) or visible_to_others(b):
                    return True
            case While(test=test, body=inner):
                if observable(test) or visible_to_others(inner) or not inner:
                    return True
            case For() | Switch():
                return True
    return False
