"""From source to typed tree: what an expression designates - objects, members, elements, registers, enum constants."""

from __future__ import annotations

import ast
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, Final

from emulator.c28x.ctypes import (
    UINT,
    ULONG,
    VOID,
    ArrayType,
    CType,
    FunctionType,
    IntType,
    PointerType,
    StructType,
    bit_field,
    promote,
)  # fmt: skip
from emulator.c28x.symbols import CoreRegister, EnumType, Module, Registers, SourceError
from emulator.c28x.tree import Convert, Expr, Field, Function, Index, Load, LValue, RegisterRef, Variable, Where
from emulator.c28x.type_reader import TypeReader

#: What an entry of the vector table holds: `typedef interrupt void (*PINT)(void)`.
PINT: Final = FunctionType("PINT", VOID, ())


class PlaceLowering(ABC):
    """Lowers lvalues of one function (or of a file-scope initialiser)."""

    def __init__(self, module: Module, function: Function) -> None:
        self.module = module
        self.function = function
        self.types = TypeReader(module)
        self.scope: dict[str, Variable] = {}
        #: Locals of inner blocks that have ended.
        self.ended: dict[str, Variable] = {}
        self.addressed: set[str] = set()
        self.source_lines: Sequence[str] = module.text.splitlines()

    def error(self, node: ast.AST, message: str) -> SourceError:
        """A construct outside the language, with its place."""
        return self.types.error(node, message)

    def where(self, node: ast.AST) -> Where:
        """The place of a construct."""
        return self.types.where(node)

    @abstractmethod
    def expression(self, node: ast.expr) -> Expr:
        """The value of an expression, arrays decayed."""

    def undeclared(self, node: ast.AST, name: str, message: str) -> SourceError:
        """A name that means nothing here; perhaps it did in a block before."""
        if name in self.ended:
            line = self.ended[name].declaration.line
            message = f"{name} is declared in an inner block (line {line}) that has ended: declare it at the top"
        return self.error(node, message)

    def enumerated(self, node: ast.expr) -> int | None:
        match node:
            case ast.Attribute(value=ast.Name(id=name), attr=constant) if name not in self.scope:
                symbol = self.module.symbols.get(name)
                if isinstance(symbol, EnumType):
                    if constant not in symbol.constants:
                        raise self.error(node, f"enum {name} has no {constant}: it has {', '.join(symbol.constants)}")
                    return symbol.constants[constant]
        return None

    def lvalue(self, node: ast.expr) -> LValue | RegisterRef:
        """What an expression designates."""
        place = self.designate(node)
        if isinstance(place, LValue) and not place.text:
            place.text = ast.unparse(node)
        return place

    def designate(self, node: ast.expr) -> LValue | RegisterRef:
        """The way to what an expression designates."""
        match node:
            case ast.Name(id=name):
                variable = self.scope.get(name)
                if variable is None:
                    symbol = self.module.symbols.get(name)
                    if isinstance(symbol, CoreRegister):
                        return RegisterRef("CPU", name, None, 16, UINT)
                    if not isinstance(symbol, Variable):
                        raise self.undeclared(node, name, f"{name} is not a declared object")
                    variable = symbol
                return LValue(variable.ctype, variable, where=self.where(node))
            case ast.Attribute():
                register = self.register(node)
                return register if register is not None else self.member(node)
            case ast.Subscript():
                return self.element(node)
        raise self.error(node, f"'{ast.unparse(node)}' does not designate an object")

    def member(self, node: ast.Attribute) -> LValue:
        base = self.aggregate_place(node.value)
        if isinstance(base, Expr):
            assert isinstance(base.ctype, PointerType)
            ctype = base.ctype.target
            place = LValue(ctype, base, where=self.where(node))
        else:
            ctype = base.ctype
            place = base
        if not isinstance(ctype, StructType):
            raise self.error(node, f"'{ast.unparse(node.value)}' is a {ctype}, not a structure")
        member = ctype.member(node.attr)
        if member is None:
            raise self.error(node, f"struct {ctype} has no member {node.attr}")
        return LValue(
            member.ctype, place.root, place.leaf + member.leaf, place.words + member.offset, place.indices,
            self.where(node),
        )  # fmt: skip

    def element(self, node: ast.Subscript) -> LValue:
        base = self.aggregate_place(node.value)
        index = self.expression(node.slice)
        if not isinstance(index.ctype, IntType):
            raise self.error(node.slice, "an index must be an integer")
        index = Convert(promote(index.ctype), index) if promote(index.ctype) != index.ctype else index
        if isinstance(base, Expr):
            assert isinstance(base.ctype, PointerType)
            target = base.ctype.target
            return LValue(target, base, 0, 0, [Index(index, None, target.leaves, max(1, target.words))],
                self.where(node),
            )  # fmt: skip
        if not isinstance(base.ctype, ArrayType):
            raise self.error(node, f"'{ast.unparse(node.value)}' is a {base.ctype}: it cannot be indexed")
        element = base.ctype.element
        step = Index(index, base.ctype.length, element.leaves, element.words)
        return LValue(element, base.root, base.leaf, base.words, [*base.indices, step], self.where(node))

    def aggregate_place(self, node: ast.expr) -> LValue | Expr:
        """The base of `.member` or `[index]`: an lvalue of aggregate type, or a pointer value."""
        if isinstance(node, ast.Name | ast.Attribute | ast.Subscript) and self.enumerated(node) is None:
            place = self.lvalue(node)
            if isinstance(place, RegisterRef):
                raise self.error(node, "a register has no members here")
            if isinstance(place.ctype, PointerType):
                return Load(place.ctype, place)
            return place
        value = self.expression(node)
        if not isinstance(value.ctype, PointerType):
            raise self.error(node, f"'{ast.unparse(node)}' is a {value.ctype}, not a pointer")
        return value

    def register(self, node: ast.Attribute) -> RegisterRef | None:
        """`Regs.R`, `Regs.R.all` or `Regs.R.bit.F`; None if it is not about registers."""
        path: list[str] = []
        inner: ast.expr = node
        while isinstance(inner, ast.Attribute):
            path.append(inner.attr)
            inner = inner.value
        if not isinstance(inner, ast.Name) or inner.id in self.scope:
            return None
        block = self.module.symbols.get(inner.id)
        if not isinstance(block, Registers):
            return None
        path.reverse()
        entry: Any = block.layout.get(path[0])
        if entry is None:
            raise self.error(node, f"{block.name} has no register {path[0]}")
        description = entry.register
        plain = description.__name__ == "PlainRegister"
        whole: CType = ULONG if description.bits == 32 else UINT
        if getattr(entry, "routine", False):
            whole = PINT
        match path[1:]:
            case [] | ["all"] as way if plain == (not way):
                return RegisterRef(block.name, path[0], None, description.bits, whole)
            case ["bit", name] if not plain:
                f = description.fields.get(name)
                if f is None:
                    raise self.error(node, f"{block.name}.{path[0]} has no field {name}")
                field = Field(name, f.lo, f.width, f.mask, f.lane)
                return RegisterRef(
                    block.name, path[0], field, description.bits, bit_field(f.width), not description.read_mask
                )
        wanted = block.name + "." + path[0] + ("" if plain else ".all or .bit.FIELD")
        raise self.error(node, f"'{ast.unparse(node)}': C writes {wanted}")
