"""C types as written in annotations, and the constant integers in them."""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import Final

from emulator.c28x import build
from emulator.c28x.arithmetic import divide_int
from emulator.c28x.ctypes import (
    BASIC,
    INT,
    VOID,
    ArrayType,
    BlockType,
    CType,
    FunctionType,
    IntType,
    StructType,
)  # fmt: skip
from emulator.c28x.readers.python.hints import hint
from emulator.c28x.symbols import Define, Enumerator, EnumType, Module, RegisterBlock, SourceError
from emulator.c28x.tree import Variable, Where

_CONSTANT: Final[dict[type, Callable[[int, int], int]]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: divide_int,
    ast.LShift: operator.lshift, ast.RShift: operator.rshift, ast.BitOr: operator.or_, ast.BitAnd: operator.and_,
}  # fmt: skip

_LINE_END: Final = re.compile(r"\r\n|\r|\n")


@lru_cache(maxsize=8192)
def shown(node: ast.AST) -> str:
    """The text of a construct for a message.  It is cached, because images of a process share their trees."""
    try:
        return ast.unparse(node)
    except RecursionError:
        return "expression"


@lru_cache(maxsize=64)
def source_lines(text: str) -> tuple[str, ...]:
    """The lines of a text as Python counts them: form feeds and other separators do not end a line."""
    return tuple(_LINE_END.split(text))


#: Words before a type that are about the object itself.
_QUALIFIERS: Final = ("const", "volatile", "static")


@dataclass(frozen=True)
class DeclaredType:
    """The type of an object or member, and the words in front of it."""

    ctype: CType
    words: frozenset[str]
    #: The node of the type, without the words in front.
    node: ast.expr

    def mark(self, variable: Variable) -> None:
        """Store these words on a variable."""
        variable.volatile = "volatile" in self.words
        variable.constant = "const" in self.words


class PythonTypeReader:
    """Reads types with the names of one module.

    `use`: the place where a `#define` of this module is used; it becomes the place of what is read.
    """

    def __init__(self, module: Module, use: Where | None = None) -> None:
        self.module = module
        self.use = use
        self.lines = source_lines(module.text)

    def error(self, node: ast.AST, message: str) -> SourceError:
        """The error about a construct outside the language, with its place."""
        return SourceError.at(self.where(node), message)

    def text(self, node: ast.expr) -> str:
        """The source text of a literal, in lower case."""
        line = self.lines[node.lineno - 1]
        if line.isascii():
            return line[node.col_offset : node.end_col_offset].lower()
        return line.encode()[node.col_offset : node.end_col_offset].decode(errors="replace").lower()

    def before(self, node: ast.expr) -> str:
        """The character before a construct in its line; empty at the start of the line."""
        octets = self.lines[node.lineno - 1].encode(errors="replace")
        return octets[max(0, node.col_offset - 1) : node.col_offset].decode(errors="replace")

    def where(self, node: ast.AST) -> Where:
        """The place of a construct: columns in characters, from 1."""
        line = getattr(node, "lineno", 0)
        octets = getattr(node, "col_offset", 0)
        if line and octets and line <= len(self.lines) and not self.lines[line - 1].isascii():
            octets = len(self.lines[line - 1].encode()[:octets].decode(errors="replace"))
        place = Where(self.module.file, line, octets + 1)
        return place if self.use is None else self.use._replace(macro=place)

    def try_type(self, node: ast.expr) -> CType | None:
        """The C type that an expression names; None if it names none."""
        try:
            return self.ctype(node)
        except SourceError:
            return None

    def ctype(self, node: ast.expr) -> CType:
        """The C type that an annotation names."""
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
                if isinstance(symbol, RegisterBlock):
                    return build.block_type(symbol)
                raise self.error(node, f"{name} is not a C type{hint(name, self.module.text)}")
            case ast.Subscript(value=ast.Name(id="ptr"), slice=target):
                inner = self.ctype(target)
                return inner.pointer
            case ast.Subscript(value=ast.Name(id="const" | "volatile"), slice=target):
                return self.ctype(target)
            case ast.Subscript(value=ast.Name(id="array"), slice=ast.Tuple(elts=[element, length])):
                return build.array_of(self.ctype(element), self.constant(length), self.where(node))
            case ast.Subscript(value=ast.Name(id="array"), slice=ast.Tuple()):
                message = "write array[TYPE, LENGTH], array[array[TYPE, COLUMNS], ROWS] for two dimensions"
                raise self.error(node, f"{shown(node)} is not a C type: {message}")
            case ast.Subscript(value=ast.Name(id="array"), slice=element):
                inner = self.ctype(element)
                return inner.pointer
            case ast.Subscript(value=ast.Name(id="funcptr"), slice=ast.Tuple(elts=[result, *parameters])):
                return FunctionType("funcptr", self.ctype(result), tuple(self.ctype(p) for p in parameters))
            case ast.Subscript(value=ast.Name(id="funcptr"), slice=result):
                return FunctionType("funcptr", self.ctype(result), ())
            case ast.Subscript(value=ast.Name(id="static")):
                raise self.error(node, "static stands before the whole type of a local: static[uint16]")
            case ast.Subscript(value=ast.Name(id="Annotated")):
                raise self.error(node, "Annotated[...] is for a member of a structure: Annotated[uint16, bits(3)]")
            case ast.Subscript(value=ast.Name(id=name)) if name in BASIC or name in self.module.symbols:
                raise self.error(node, f"{shown(node)} is not a C type: write array[{name}, LENGTH]")
            case ast.Subscript(value=ast.Name(id=name)):
                raise self.error(node, f"{shown(node)} is not a C type{hint(name)}")
            case ast.BinOp(op=ast.BitOr()):
                raise self.error(node, f"{shown(node)} is not a C type: write ptr[TYPE], which may be NULL, or a union")
        raise self.error(node, f"{shown(node)} is not a C type")

    def declared(self, annotation: ast.expr) -> DeclaredType:
        """The type of an object or a parameter, and its `const`, `volatile` and `static`."""
        node = annotation
        words = set()
        while True:
            match node:
                case ast.Constant(value=str(text)):
                    node = self.quoted(node, text)
                case ast.Subscript(value=ast.Name(id=word), slice=inner) if word in _QUALIFIERS:
                    words.add(word)
                    node = inner
                case _:
                    break
        element = node
        while (
            isinstance(element, ast.Subscript)
            and isinstance(element.slice, ast.Tuple)
            and (shown(element.value) == "array")
        ):  # an array is what its elements are
            element = element.slice.elts[0]
            if isinstance(element, ast.Subscript) and shown(element.value) in ("const", "volatile"):
                words.add(shown(element.value))
                element = element.slice
        return DeclaredType(self.complete(node), frozenset(words), node)

    def member(self, annotation: ast.expr) -> tuple[DeclaredType, int | None]:
        """A member, and its width if it is a bit-field: `Annotated[uint16, bits(3)]`."""
        match annotation:
            case ast.Constant(value=str(text)):
                return self.member(self.quoted(annotation, text))
            case ast.Subscript(value=ast.Name(id="Annotated"), slice=ast.Tuple(elts=[inner, width])):
                pass
            case _:
                declared = self.declared(annotation)
                if "static" in declared.words:
                    raise self.error(annotation, "a member is not static: static stands before the type of a local")
                return declared, None
        match width:
            case ast.Call(func=ast.Name(id="bits"), args=[number], keywords=[]):
                pass
            case _:
                raise self.error(width, f"'{shown(width)}' says nothing of a member: write Annotated[uint16, bits(3)]")
        declared = self.declared(inner)
        ctype = declared.ctype
        if not isinstance(ctype, IntType):
            raise self.error(inner, f"a bit-field of type {ctype}: only integers have bit-fields")
        value = self.constant(number)
        if not 0 <= value <= ctype.bits:
            raise self.error(number, f"a bit-field of an {ctype} has at most {ctype.bits} bits")
        return declared, value

    def quoted(self, node: ast.expr, text: str) -> ast.expr:
        """The expression of an annotation in quotation marks, with the place of the annotation."""
        try:
            inner = ast.parse(text, mode="eval").body
            ast.unparse(inner)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise self.error(node, f"{text!r} is not a C type") from None
        for part in ast.walk(inner):
            ast.copy_location(part, node)
        return inner

    def complete(self, node: ast.expr) -> CType:
        """The type of an object or member.  Raises SourceError for void, a block, or a structure without members."""
        ctype = element = self.ctype(node)
        while isinstance(element, ArrayType):
            element = element.element
        if element == VOID:
            raise self.error(node, "an object of type void: write the type that it has, or ptr[void]")
        if isinstance(element, BlockType):
            raise self.error(node, f"{element} is a register block of the chip: declare a pointer to it")
        if isinstance(element, StructType) and not element.members:
            raise self.error(node, f"{element} has no members here: declare it before, or use a pointer to it")
        return ctype

    def constant(self, node: ast.expr, known: Mapping[str, int] = MappingProxyType({})) -> int:
        """A constant integer, for an array length or an enumeration; `known`: its constants so far."""
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
        raise self.error(node, f"'{shown(node)}' is not an integer constant: write a number, or NAME = number")

    def computed(self, node: ast.BinOp, known: Mapping[str, int]) -> int:
        """The value of a constant chain of operators."""
        steps = [node]
        while isinstance(steps[-1].left, ast.BinOp):
            steps.append(steps[-1].left)
        value = self.constant(steps[-1].left, known)
        for step in reversed(steps):
            op, right = step.op, self.constant(step.right, known)
            if type(op) not in _CONSTANT:
                raise self.error(step, f"{shown(step)} is not an integer constant")
            if isinstance(op, ast.Div) and right == 0:
                raise self.error(step, "a division by zero is not a constant")
            if isinstance(op, ast.LShift | ast.RShift) and not 0 <= right < 32:
                raise self.error(step, f"a shift by {right} is not a constant")
            value = _CONSTANT[type(op)](value, right)
            if value.bit_length() > 64:
                raise self.error(step, "a constant that does not fit into 64 bits")
        return value
