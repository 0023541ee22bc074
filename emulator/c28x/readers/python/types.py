"""C types as annotations write them, and the constant integers within them."""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from types import MappingProxyType
from typing import Final

from emulator.c28x import build
from emulator.c28x.arithmetic import divide_int
from emulator.c28x.ctypes import BASIC, INT, VOID, ArrayType, BlockType, CType, FunctionType, PointerType, StructType
from emulator.c28x.symbols import Define, Enumerator, EnumType, Module, Registers, SourceError
from emulator.c28x.tree import Where

_CONSTANT: Final[dict[type, Callable[[int, int], int]]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: divide_int,
    ast.LShift: operator.lshift, ast.RShift: operator.rshift, ast.BitOr: operator.or_, ast.BitAnd: operator.and_,
}  # fmt: skip

_LINE_END: Final = re.compile(r"\r\n|\r|\n")
#: Words of other languages, and what to write here.
_HINTS: Final = {
    "int": "int16", "float": "float32", "bool": "uint16, with 1 and 0", "True": "1", "False": "0", "None": "NULL",
    "uint8": "uchar: this chip has no type of 8 bits", "int8": "schar: this chip has no type of 8 bits",
    "uint8_t": "uchar: this chip has no type of 8 bits", "int8_t": "schar: this chip has no type of 8 bits",
    "uint16_t": "uint16", "int16_t": "int16", "uint32_t": "uint32", "int32_t": "int32", "uint64_t": "uint64",
    "int64_t": "int64", "Uint16": "uint16", "Uint32": "uint32", "double": "float32", "unsigned": "uint16",
    "long": "int32", "short": "int16",
}  # fmt: skip


@lru_cache(maxsize=8192)
def shown(node: ast.AST) -> str:
    """A construct as a message or a report names it.  Images of a process share their trees, and so these texts."""
    try:
        return ast.unparse(node)
    except RecursionError:
        return "expression"


@lru_cache(maxsize=64)
def source_lines(text: str) -> tuple[str, ...]:
    """The lines of a text as Python counts them: form feeds and other separators end none."""
    return tuple(_LINE_END.split(text))


def hint(name: str) -> str:
    """What to write instead of a name that this language does not have."""
    return f": write {_HINTS[name]}" if name in _HINTS else ""


class TypeReader:
    """Reads types with the names of one module.

    What a `#define` of this module wrote stands where it is used: at `use`.
    """

    def __init__(self, module: Module, use: Where | None = None) -> None:
        self.module = module
        self.use = use
        self.lines = source_lines(module.text)

    def error(self, node: ast.AST, message: str) -> SourceError:
        """A construct outside the language, with its place."""
        return SourceError.at(self.where(node), message)

    def text(self, node: ast.expr) -> str:
        """A literal as it is written, in lower case."""
        line = self.lines[node.lineno - 1]
        if line.isascii():
            return line[node.col_offset : node.end_col_offset].lower()
        return line.encode()[node.col_offset : node.end_col_offset].decode(errors="replace").lower()

    def where(self, node: ast.AST) -> Where:
        """The place of a construct: columns in characters, from 1."""
        line = getattr(node, "lineno", 0)
        octets = getattr(node, "col_offset", 0)
        if line and octets and line <= len(self.lines) and not self.lines[line - 1].isascii():
            octets = len(self.lines[line - 1].encode()[:octets].decode(errors="replace"))
        place = Where(self.module.file, line, octets + 1)
        return place if self.use is None else replace(self.use, macro=place)

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
                if isinstance(symbol, Registers):
                    return build.block_type(symbol)
                raise self.error(node, f"{name} is not a C type{hint(name)}")
            case ast.Subscript(value=ast.Name(id="ptr"), slice=target):
                inner = self.ctype(target)
                return PointerType(f"{inner} *", inner)
            case ast.Subscript(value=ast.Name(id="const" | "volatile"), slice=target):
                return self.ctype(target)
            case ast.Subscript(value=ast.Name(id="array"), slice=ast.Tuple(elts=[element, length])):
                return build.array_of(self.ctype(element), self.constant(length), self.where(node))
            case ast.Subscript(value=ast.Name(id="array"), slice=element):
                inner = self.ctype(element)
                return PointerType(f"{inner} *", inner)
            case ast.Subscript(value=ast.Name(id="funcptr"), slice=ast.Name() as result):
                return FunctionType("funcptr", self.ctype(result), ())
            case ast.Subscript(value=ast.Name(id="funcptr"), slice=ast.Tuple(elts=[result, *parameters])):
                return FunctionType("funcptr", self.ctype(result), tuple(self.ctype(p) for p in parameters))
        raise self.error(node, f"{shown(node)} is not a C type")

    def volatile(self, node: ast.expr) -> bool:
        """Whether an annotation makes the object itself `volatile`, an array by its elements."""
        match node:
            case ast.Constant(value=str(text)):
                return self.volatile(self.quoted(node, text))
            case ast.Subscript(value=ast.Name(id="volatile")):
                return True
            case ast.Subscript(value=ast.Name(id="const"), slice=target):
                return self.volatile(target)
            case ast.Subscript(value=ast.Name(id="array"), slice=ast.Tuple(elts=[element, _])):
                return self.volatile(element)
        return False

    def quoted(self, node: ast.expr, text: str) -> ast.expr:
        """An annotation in quotation marks, at its own place."""
        try:
            inner = ast.parse(text, mode="eval").body
            ast.unparse(inner)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise self.error(node, f"{text!r} is not a C type") from None
        for part in ast.walk(inner):
            ast.copy_location(part, node)
        return inner

    def complete(self, node: ast.expr) -> CType:
        """The type of an object or member: not a structure that is declared further down."""
        ctype = element = self.ctype(node)
        while isinstance(element, ArrayType):
            element = element.element
        if isinstance(element, BlockType):
            raise self.error(node, f"{element} is a register block of the chip: declare a pointer to it")
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
                if isinstance(symbol, Enumerator):
                    return symbol.value
                if isinstance(symbol, Define):
                    builder = build.file_scope(self.module)
                    with builder.expanding(name, self.where(node)):
                        number = build.constant_value(symbol.expression(builder, self.where(node)))
                    if isinstance(number, int):
                        return number
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
            case ast.BinOp():
                return self.computed(node, known)
        raise self.error(node, f"{shown(node)} is not an integer constant")

    def computed(self, node: ast.BinOp, known: Mapping[str, int]) -> int:
        """A constant with operators, as many as there are one after the other."""
        steps = [node]
        while isinstance(steps[-1].left, ast.BinOp):
            steps.append(steps[-1].left)
        value = self.constant(steps[-1].left, known)
        for step in reversed(steps):
            op, right = step.op, self.constant(step.right, known)
            if type(op) not in _CONSTANT:
                raise self.error(step, f"{shown(step)} is not an integer constant")
            if isinstance(op, ast.Div) and right == 0:
                raise self.error(step, "a division by zero is no constant")
            if isinstance(op, ast.LShift | ast.RShift) and not 0 <= right < 32:
                raise self.error(step, f"a shift by {right} is no constant")
            value = _CONSTANT[type(op)](value, right)
            if value.bit_length() > 64:
                raise self.error(step, "a constant that does not fit into 64 bits")
        return value
