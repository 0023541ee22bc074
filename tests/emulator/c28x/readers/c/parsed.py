"""What pycparser understands of a header of ours: its constants, its types, and the type of every name.

A preprocessor of some lines is enough for text that the project generates: includes of its own headers, conditions on
a name and on its value, constants without parameters.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from emulator.c28x.ctypes import ArrayType, CType, FunctionType, HandleType, PointerType, StructType

pycparser = __import__("pytest").importorskip("pycparser")
c_ast = pycparser.c_ast

_INCLUDE = re.compile(r'#include\s+["<](.+)[">]')
_DEFINE = re.compile(r"#define\s+(\w+)(\([^)]*\))?\s*(.*)")
_WORD = re.compile(r"[A-Za-z_]\w*")
#: What the reader of this chip's C knows and pycparser does not.
_KEYWORDS = {"__interrupt": "", "__cregister": "", "interrupt": "", "cregister": ""}


class Parsed:
    """One text, read."""

    def __init__(self, text: str, find: Callable[[str], str | None]) -> None:
        self.defines: dict[str, str] = {}
        self.macros: dict[str, str] = {}
        lines: list[str] = []
        self._expand(text, find, lines)
        self.text = "\n".join(lines)
        tree = pycparser.c_parser.CParser().parse(self.text)
        self.types: dict[str, Any] = {}
        self.structs: dict[str, Any] = {}
        self.names: dict[str, Any] = {}
        self.functions: dict[str, Any] = {}
        for node in tree.ext:
            if isinstance(node, c_ast.FuncDef):
                self.functions[node.decl.name] = node
                node = node.decl
            self._structure(node.type)
            if isinstance(node, c_ast.Typedef):
                self.types[node.name] = node.type
                self._structure(getattr(node.type, "type", None))
            elif node.name:
                self.names[node.name] = node.type

    def _structure(self, node: Any) -> None:
        if isinstance(node, c_ast.Struct | c_ast.Union | c_ast.Enum) and node.name:
            members = node.values if isinstance(node, c_ast.Enum) else node.decls
            if members is not None:
                self.structs[node.name] = node

    def _expand(self, text: str, find: Callable[[str], str | None], lines: list[str]) -> None:
        taken: list[bool] = []
        for line in text.splitlines():
            if line.startswith(("#ifndef", "#ifdef")):
                taken.append((line.split()[1] in self.defines) is line.startswith("#ifdef"))
            elif line.startswith("#if "):
                name, equals, other = line.split()[1:]
                assert equals == "==", line
                taken.append(self.value(name) == int(self.defines.get(other, other)))
            elif line.startswith("#else"):
                taken[-1] = not taken[-1]
            elif line.startswith("#endif"):
                taken.pop()
            elif not all(taken):
                continue
            elif found := _INCLUDE.match(line):
                inner = find(found[1])
                assert inner is not None, f"{found[1]} is included and is not there"
                self._expand(inner, find, lines)
            elif found := _DEFINE.match(line):
                (self.macros if found[2] else self.defines)[found[1]] = found[3]
            else:
                assert not line.startswith("#"), line
                lines.append(_WORD.sub(self._replace, line))

    def _replace(self, found: re.Match[str]) -> str:
        word = found[0]
        seen: set[str] = set()
        while word not in seen:
            seen.add(word)
            word = _KEYWORDS.get(word, self.defines.get(word, word))
        return word

    def value(self, name: str) -> int:
        """The value of a constant integer."""
        text = re.sub(r"\b(0[xX][0-9a-fA-F]+|\d+)[uUlL]*\b", lambda m: str(int(m[1], 0)), self.defines[name])
        text = _WORD.sub(lambda m: str(self.value(m[0])), text)
        return int(eval(text.replace("/", "//"), {}))

    def shape(self, node: Any) -> object:
        """The type that a declaration means, with type names resolved: what `shape` makes of a type of the project."""
        match node:
            case c_ast.TypeDecl():
                return self.shape(node.type)
            case c_ast.PtrDecl(type=c_ast.FuncDecl() as function):
                return ("function", self.shape(function.type), *self._parameters(function))
            case c_ast.PtrDecl():
                return ("pointer", self.shape(node.type))
            case c_ast.ArrayDecl():
                return ("array", int(node.dim.value), self.shape(node.type))
            case c_ast.FuncDecl():
                return ("prototype", self.shape(node.type), *self._parameters(node))
            case c_ast.Struct() | c_ast.Union() | c_ast.Enum():
                return ("tag", node.name)
            case c_ast.IdentifierType():
                name = " ".join(node.names)
                return self.shape(self.types[name]) if name in self.types else name
            case c_ast.Typename():
                return self.shape(node.type)
        raise AssertionError(node)

    def _parameters(self, function: Any) -> tuple[object, ...]:
        parameters = function.args.params if function.args else []
        shapes = tuple("..." if isinstance(p, c_ast.EllipsisParam) else self.shape(p.type) for p in parameters)
        return () if shapes == ("void",) else shapes


def shape(ctype: CType) -> object:
    """A type of the project in the form of `Parsed.shape`."""
    match ctype:
        case PointerType(target=target):
            return ("pointer", shape(target))
        case ArrayType(element=element, length=length):
            return ("array", length, shape(element))
        case FunctionType():
            return ("function", *_of(ctype))
        case HandleType(name=name):
            return ("pointer", ("tag", name.replace("_Handle", "_Object")))
        case StructType(name=name):
            return ("tag", name)
    return ctype.name


def prototype_shape(ctype: FunctionType) -> object:
    """A function itself in the form of `Parsed.shape`."""
    return ("prototype", *_of(ctype))


def _of(ctype: FunctionType) -> tuple[object, ...]:
    variadic = ("...",) if ctype.variadic else ()
    return (shape(ctype.result), *(shape(p) for p in ctype.parameters), *variadic)
