"""Constants of C-shaped Python as C text, for generated headers."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from typing import Final

#: Operator of Python -> operator of C.
_OPERATORS: Final[dict[type, str]] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "/", ast.Mod: "%", ast.LShift: "<<",
    ast.RShift: ">>", ast.BitOr: "|", ast.BitAnd: "&", ast.BitXor: "^", ast.USub: "-", ast.UAdd: "+", ast.Invert: "~",
}  # fmt: skip
#: Type of C-shaped Python -> type of C.
_TYPES: Final = {"int16": "int", "uint16": "unsigned int", "int32": "long", "uint32": "unsigned long"}
_ESCAPES: Final = {"\\": "\\\\", '"': '\\"', "'": "\\'", "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def replacement(node: ast.expr, lines: Sequence[str]) -> str | None:
    """The text of a `#define`, in parentheses if it is an operation; None if C has no such constant."""
    try:
        value = expression(node, lines)
    except RecursionError:  # a sum of very many terms
        return None
    return value if value is None or isinstance(node, ast.Constant) else f"({value})"


def expression(node: ast.expr, lines: Sequence[str]) -> str | None:
    """A constant expression as C text.  Numbers keep their text from `lines`, because it decides their types."""
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
        case ast.Attribute(value=ast.Name(), attr=constant):  # a constant of an enumeration
            return constant
        case ast.Call(func=ast.Name(id=ctype), args=[operand], keywords=[]) if ctype in _TYPES:
            inner = expression(operand, lines)
            return None if inner is None else f"({_TYPES[ctype]}){_nested(operand, inner)}"
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
    """A character of C-shaped Python as a C character constant; a longer text as a string."""
    quote = "'" if len(text) == 1 else '"'
    return quote + "".join(_character(c) for c in text) + quote


def _character(character: str) -> str:
    return _ESCAPES.get(character, character if " " <= character <= "~" else f"\\{ord(character):03o}")
