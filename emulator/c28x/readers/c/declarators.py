"""C text of types and declarations: the common core of every header that is generated.

A type of the translator is written as C writes it, inside out: `int (*table[4])(char)`.  A `FunctionType` is the type
of an object that points to a function, as everywhere in the translator; only `prototype` writes a function itself.
"""

from __future__ import annotations

import ast
from collections.abc import Sequence
from typing import Final

from emulator.c28x.ctypes import ArrayType, CType, FunctionType, PointerType, StructType
from emulator.c28x.symbols import Define, EnumType
from emulator.c28x.tree import Function

#: What Python writes as C does, and what it writes otherwise.
_OPERATORS: Final[dict[type, str]] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "/", ast.Mod: "%", ast.LShift: "<<",
    ast.RShift: ">>", ast.BitOr: "|", ast.BitAnd: "&", ast.BitXor: "^", ast.USub: "-", ast.UAdd: "+", ast.Invert: "~",
}  # fmt: skip
_ESCAPES: Final = {"\\": "\\\\", '"': '\\"', "'": "\\'", "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def declarator(ctype: CType, name: str = "") -> str:
    """An object of type `ctype` called `name`, without the semicolon; without a name, the type as a cast has it."""
    match ctype:
        case PointerType(target=target):
            return declarator(target, f"*{name}")
        case ArrayType(element=element, length=length):
            return declarator(element, f"{_grouped(name)}[{length}]")
        case FunctionType(result=result):
            # An empty list stands for any parameters, as `funcptr` does.
            return declarator(result, f"(*{name})({_parameters(ctype, (), empty='')})")
    return f"{ctype.name} {name}".rstrip()


def prototype(function: Function) -> str:
    """The declaration of a function, with the names of its parameters, without the semicolon."""
    names = [parameter.declaration.name for parameter in function.parameters]
    return declarator(function.ctype.result, f"{function.name}({_parameters(function.ctype, names, empty='void')})")


def _parameters(ctype: FunctionType, names: Sequence[str], *, empty: str) -> str:
    listed = [declarator(p, names[i] if names else "") for i, p in enumerate(ctype.parameters)]
    return ", ".join([*listed, "..."] if ctype.variadic else listed) or empty


def _grouped(name: str) -> str:
    """`[]` and `()` bind before `*`."""
    return f"({name})" if name.startswith("*") else name


def structure(ctype: StructType) -> str:
    """The definition of a structure by its tag; `forward` makes the tag a type name."""
    body = "".join(f"    {declarator(member.ctype, member.name)};\n" for member in ctype.members)
    return f"struct {ctype.name} {{\n{body}}};"


def forward(ctype: StructType) -> str:
    """The name of a structure before its members are known: pointers to it can be written from here on."""
    return f"typedef struct {ctype.name} {ctype.name};"


def enumeration(ctype: EnumType) -> str:
    """The definition of an enumeration, under the same name as tag and as type."""
    constants = ", ".join(f"{name} = {value}" for name, value in ctype.constants.items())
    return f"typedef enum {ctype.name} {{ {constants} }} {ctype.name};"


def definition(name: str, define: Define) -> str | None:
    """The `#define` of a constant; None if C has no such constant."""
    value = expression(define.node, define.lines)
    if value is None:
        return None
    return f"#define {name} {value if isinstance(define.node, ast.Constant) else f'({value})'}"


def expression(node: ast.expr, lines: Sequence[str]) -> str | None:
    """A constant expression as C writes it: numbers as they stand in `lines`, because that decides their types."""
    match node:
        case ast.Constant(value=bool() | None | bytes() | complex()):
            return None
        case ast.Constant(value=str(text)):
            return _quoted(text)
        case ast.Constant(value=value):
            line = lines[node.lineno - 1].encode() if node.lineno <= len(lines) else b""
            written = line[node.col_offset : node.end_col_offset].decode().replace("_", "")
            return str(value) if not written or written.lower().startswith(("0b", "0o")) else written
        case ast.Name(id=name):
            return name
        case ast.Attribute(value=ast.Name(), attr=constant):  # of an enumeration
            return constant
        case ast.UnaryOp(op=op, operand=operand) if type(op) in _OPERATORS:
            inner = expression(operand, lines)
            return None if inner is None else f"{_OPERATORS[type(op)]}{_nested(operand, inner)}"
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            a, b = expression(left, lines), expression(right, lines)
            if a is None or b is None:
                return None
            return f"{_nested(left, a)} {_OPERATORS[type(op)]} {_nested(right, b)}"
    return None


def _nested(node: ast.expr, text: str) -> str:
    return text if isinstance(node, ast.Constant | ast.Name | ast.Attribute) else f"({text})"


def _quoted(text: str) -> str:
    """A character constant, as C-shaped Python writes one; a longer text is a string."""
    quote = "'" if len(text) == 1 else '"'
    return quote + "".join(_character(c) for c in text) + quote


def _character(character: str) -> str:
    return _ESCAPES.get(character, character if " " <= character <= "~" else f"\\{ord(character):03o}")
