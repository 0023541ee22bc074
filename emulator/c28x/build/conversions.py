"""Conversions: by assignment, by a cast, of operands and of arguments without a prototype."""

from __future__ import annotations

from typing import Final

from emulator.c28x.build.constants import fold
from emulator.c28x.build.scope import Builder
from emulator.c28x.ctypes import (
    BOOL,
    FLOAT,
    INT,
    VOID,
    BlockType,
    CType,
    FunctionType,
    HandleType,
    IntType,
    PointerType,
    StructType,
    is_arithmetic,
    promote,
)  # fmt: skip
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import Binary, Compare, Const, Convert, Expr, Logic, Not, Null, String

#: Types whose values are addresses.
ADDRESSES: Final = (PointerType, HandleType, FunctionType)


def convert(b: Builder, value: Expr, ctype: CType, *, explicit: bool = False) -> Expr:
    """`value` converted to `ctype` as by assignment, or by a cast.  Raises SourceError where C does not convert."""
    if isinstance(value, Null) or (isinstance(value, Const) and value.value == 0 and not is_arithmetic(ctype)):
        if is_arithmetic(ctype):
            if explicit or isinstance(ctype, IntType):
                return Const(ctype, 0, where=value.where)
            raise SourceError.at(value.where, f"NULL is not a {ctype}")
        if ctype != VOID and not isinstance(ctype, StructType):
            return Null(ctype, where=value.where)
    if isinstance(value, String) and isinstance(ctype, PointerType):
        return String(ctype, value.text, where=value.where)
    source = value.ctype
    if source == ctype:
        # A cast to the type that a result already has states that a wrap is intended.
        return Convert(ctype, value, explicit, where=value.where) if explicit and isinstance(value, Binary) else value
    if ctype == BOOL and (is_arithmetic(source) or isinstance(source, ADDRESSES)):
        return _truth(value)
    if is_arithmetic(source) and is_arithmetic(ctype):
        return fold(Convert(ctype, value, explicit, where=value.where))
    if isinstance(ctype, ADDRESSES) and isinstance(source, ADDRESSES):
        if not explicit:
            _check_pointers(b, value, ctype)
        match value:
            case Convert(operand=Expr(ctype=FunctionType()) as inner) if isinstance(ctype, FunctionType):
                value = inner  # of two casts of a function, only the outer one counts
        return Convert(ctype, value, where=value.where)
    if isinstance(ctype, ADDRESSES) and isinstance(source, IntType) and (explicit or b.remarks_pointers):
        if not explicit:
            b.remark(value.where, "pointer-types", f"a {source} becomes a {ctype} without a cast", str(ctype))
        return Convert(ctype, value, where=value.where)
    if isinstance(ctype, IntType) and isinstance(source, ADDRESSES) and (explicit or b.remarks_pointers):
        if not explicit:
            b.remark(value.where, "pointer-types", f"a {source} becomes a {ctype} without a cast", str(ctype))
        return Convert(ctype, value, where=value.where)
    if ctype == VOID:
        return value
    raise SourceError.at(value.where, f"a {source} cannot become a {ctype}")


def _truth(value: Expr) -> Expr:
    """`value` as a `_Bool`: 1 if it differs from 0."""
    if isinstance(value, Const):
        return Const(BOOL, int(value.value != 0), where=value.where)
    if isinstance(value, Compare | Logic | Not):
        return Convert(BOOL, value, where=value.where)
    zero = Const(value.ctype, 0, where=value.where) if is_arithmetic(value.ctype) else Null(value.ctype)
    return Convert(BOOL, Compare(INT, "!=", value, zero, where=value.where), where=value.where)


def _check_pointers(b: Builder, value: Expr, ctype: CType) -> None:
    """Check an implicit pointer conversion: only `void *` and pointers of the same type convert silently."""
    source = value.ctype
    if not isinstance(ctype, PointerType) or not isinstance(source, PointerType):
        return
    if VOID in (ctype.target, source.target) or same_type(ctype.target, source.target):
        return
    message = f"a {source} given where a {ctype} is wanted"
    if not b.remarks_pointers:
        raise SourceError.at(value.where, f"{message}: C needs a cast to {ctype}")
    b.remark(value.where, "pointer-types", message, str(ctype))


def same_type(one: CType, other: CType) -> bool:
    """Whether two pointed-to types are one type for C."""
    if isinstance(one, BlockType) or isinstance(other, BlockType):
        return one == other
    if isinstance(one, PointerType) and isinstance(other, PointerType):
        return same_type(one.target, other.target)
    return _without_tag(one.name) == _without_tag(other.name)


def _without_tag(name: str) -> str:
    """The name of a type as a typedef gives it: in a file without the definition, `thing` is only a `struct thing`."""
    return name.replace("struct ", "").replace("union ", "")


def unnamed(b: Builder, argument: Expr) -> Expr:
    """An argument that no parameter receives, after the default argument promotions: a float becomes a double."""
    return convert(b, argument, b.double) if argument.ctype == FLOAT else promoted(b, argument)


def promoted(b: Builder, value: Expr) -> Expr:
    """The integer promotions; anything else stays."""
    return convert(b, value, promote(value.ctype)) if isinstance(value.ctype, IntType) else value


def condition(value: Expr) -> Expr:
    """A controlling expression: anything scalar.  Raises SourceError otherwise."""
    if isinstance(value.ctype, StructType) or value.ctype == VOID:
        raise SourceError.at(value.where, f"a {value.ctype} is not a condition")
    return value
