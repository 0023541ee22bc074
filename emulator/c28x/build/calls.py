"""Calls: arguments converted to the parameter types, extra arguments by the default promotions; `sizeof`."""

from __future__ import annotations

from collections.abc import Sequence

from emulator.c28x.build.conversions import convert, unnamed
from emulator.c28x.build.scope import Builder
from emulator.c28x.ctypes import ULONG, BlockType, CType, FunctionType, PointerType, StructType
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import Call, CallPointer, Const, Expr, Function, FunctionRef, Where


def call(b: Builder, function: Function, arguments: Sequence[Expr], where: Where) -> Expr:
    """A call of a function by its name.  Raises SourceError where the number of arguments is wrong."""
    wanted = function.ctype.parameters
    if len(arguments) < len(wanted) or (len(arguments) > len(wanted) and not function.ctype.variadic):
        raise SourceError.at(where, f"{function.name} takes {len(wanted)} arguments, {len(arguments)} given")
    converted = [convert(b, a, t) for a, t in zip(arguments, wanted, strict=False)]
    extra = [unnamed(b, a) for a in arguments[len(wanted) :]]
    for argument in extra:
        if isinstance(argument.ctype, StructType):
            message = f"a {argument.ctype} behind the parameters of {function.name}: pass its address"
            raise SourceError.at(where, message)
    b.function.calls.add(function.path)
    return Call(function.ctype.result, function, converted, extra, where=where)


def call_value(b: Builder, target: Expr, arguments: Sequence[Expr], where: Where, text: str = "") -> Expr:
    """A call through a pointer to a function."""
    if isinstance(target, FunctionRef):
        return call(b, target.function, arguments, where)
    if not isinstance(target.ctype, FunctionType):
        raise SourceError.at(where, f"'{text}' is a {target.ctype}, not a function")
    wanted = target.ctype.parameters
    if target.ctype.variadic and not wanted:  # `int (*f)()`: C does not say which parameters
        return CallPointer(target.ctype.result, target, [unnamed(b, a) for a in arguments], where=where)
    if len(arguments) != len(wanted):
        raise SourceError.at(where, f"this function takes {len(wanted)} arguments, {len(arguments)} given")
    converted = [convert(b, a, t) for a, t in zip(arguments, wanted, strict=True)]
    return CallPointer(target.ctype.result, target, converted, where=where)


def sizeof(ctype: CType, where: Where) -> Expr:
    """`sizeof`: 16-bit words, an unsigned long."""
    if isinstance(ctype, BlockType) and ctype.layout:
        ends = (entry.offset + entry.register.bits // 16 for entry in ctype.layout.values())
        return Const(ULONG, max(ends), text="sizeof", where=where)
    if not ctype.words:
        raise SourceError.at(where, f"the size of a {ctype} is not known here")
    text = "sizeof pointer" if isinstance(ctype, PointerType) else "sizeof"
    return Const(ULONG, ctype.words, text=text, measured=ctype, where=where)
