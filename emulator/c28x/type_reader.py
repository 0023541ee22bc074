"""C types as annotations write them, and the constant integers within them."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from emulator.c28x.arithmetic import divide_int
from emulator.c28x.ctypes import BASIC, INT, VOID, ArrayType, CType, FunctionType, PointerType, StructType
from emulator.c28x.symbols import Define, EnumType, Module, SourceError
from emulator.c28x.tree import Where

_CONSTANT: Final[dict[type, Callable[[int, int], int]]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: divide_int,
    ast.LShift: operator.lshift, ast.RShift: operator.rshift, ast.BitOr: operator.or_, ast.BitAnd: operator.and_,
}  # fmt: skip


class TypeReader:
    """Reads types with the names of one module."""

    def __init__(self, module: Module) -> None:
        self.module = module
        self.lines = module.text.splitlines()

    def error(self, node: ast.AST, message: str) -> SourceError:
        """A construct outside the language, with its place."""
        return SourceError(self.module.file, getattr(node, "lineno", 0), message)

    def where(self, node: ast.AST) -> Where:
        """The place of a construct: columns in characters, from 1."""
        line = getattr(node, "lineno", 0)
        octets = getattr(node, "col_offset", 0)
        if line and octets and line <= len(self.lines):
            octets = len(self.lines[line - 1].encode()[:octets].decode(errors="replace"))
        return Where(self.module.file, line, octets + 1)

    def try_type(self, node: ast.expr) -> CType | None:
        """The C type that an expression means; None if it means none."""
        try:
            return self.ctype(node)
        except SourceError:
            return None

    def ctype(self, node: ast.expr) -> CType:
        """The C type that an annotation means."""
        match node:
            case ast.Constant(value=None):
                return VOID
            case ast.Constant(value=str(text)):
                return self.ctype(self.quoted(node, text))
            case ast.Name(id=name):
                if name in BASIC:
                    return BASIC[name]
                if name == "funcptr":
                    return FunctionType("funcptr", VOID, ())
                symbol = self.module.symbols.get(name)
                if isinstance(symbol, CType):
                    return symbol
                if isinstance(symbol, EnumType):
                    return INT
                raise self.error(node, f"{name} is not a C type")
            case ast.Subscript(value=ast.Name(id="ptr"), slice=target):
                inner = self.ctype(target)
                return PointerType(f"{inner} *", inner)
            case ast.Subscript(value=ast.Name(id="const"), slice=target):
                return self.ctype(target)
            case ast.Subscript(value=ast.Name(id="array"), slice=ast.Tuple(elts=[element, length])):
                count = self.constant(length)
                if count < 1:
                    raise self.error(node, "an array needs at least one element")
                inner = self.ctype(element)
                return ArrayType(f"{inner}[{count}]", inner, count)
            case ast.Subscript(value=ast.Name(id="array"), slice=element):
                inner = self.ctype(element)
                return PointerType(f"{inner} *", inner)
            case ast.Subscript(value=ast.Name(id="funcptr"), slice=ast.Name() as result):
                return FunctionType("funcptr", self.ctype(result), ())
            case ast.Subscript(value=ast.Name(id="funcptr"), slice=ast.Tuple(elts=[result, *parameters])):
                return FunctionType("funcptr", self.ctype(result), tuple(self.ctype(p) for p in parameters))
        raise self.error(node, f"{ast.unparse(node)} is not a C type")

    def quoted(self, node: ast.expr, text: str) -> ast.expr:
        """An annotation in quotation marks, at its own place."""
        try:
            inner = ast.parse(text, mode="eval").body
        except SyntaxError:
            raise self.error(node, f"{text!r} is not a C type") from None
        for part in ast.walk(inner):
            ast.copy_location(part, node)
        return inner

    def complete(self, node: ast.expr) -> CType:
        """The type of an object or member: not a structure that is declared further down."""
        ctype = element = self.ctype(node)
        while isinstance(element, ArrayType):
            element = element.element
        if isinstance(element, StructType) and not element.members:
            raise self.error(node, f"struct {element} has no members here: declare it before, or use a pointer to it")
        return ctype

    def constant(self, node: ast.expr, known: Mapping[str, int] = MappingProxyType({})) -> int:
        """A constant integer, for an array length or an enumeration (whose constants so far are `known`)."""
        match node:
            case ast.Constant(value=bool()):
                pass
            case ast.Constant(value=int(value)):
                return value
            case ast.Constant(value=str(text)) if len(text) == 1:
                return ord(text)
            case ast.Name(id=name) if name in known:
                return known[name]
            case ast.Name(id=name):
                symbol = self.module.symbols.get(name)
                if isinstance(symbol, Define):
                    return self.constant(symbol.node)
            case ast.Attribute(value=ast.Name(id=name), attr=attribute):
                symbol = self.module.symbols.get(name)
                if isinstance(symbol, EnumType) and attribute in symbol.constants:
                    return symbol.constants[attribute]
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -self.constant(operand, known)
            case ast.Call(func=ast.Name(id="sizeof"), args=[argument]):
                ctype = self.try_type(argument)
                if ctype is not None:
                    return ctype.words
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _CONSTANT:
                a, b = self.constant(left, known), self.constant(right, known)
                if isinstance(op, ast.Div) and b == 0:
                    raise self.error(node, "a division by zero is no constant")
                if isinstance(op, ast.LShift | ast.RShift) and not 0 <= b < 32:
                    raise self.error(node, f"a shift by {b} is no constant")
                return _CONSTANT[type(op)](a, b)
        raise self.error(node, f"{ast.unparse(node)} is not an integer constant")
