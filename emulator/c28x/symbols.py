"""What the names of a firmware module mean, once its declarations have been read: data only."""

from __future__ import annotations

import ast
from dataclasses import dataclass, field
from typing import Any

from emulator.c28x.ctypes import CType
from emulator.c28x.tree import Function, Variable


class NoModule(ValueError):
    """A module that is nowhere."""


class SourceError(ValueError):
    """Firmware source outside the language: file, line, column (0: not known), construct, and what would be right."""

    def __init__(self, file: str, line: int, message: str, column: int = 0) -> None:
        super().__init__(f"{file}:{line}:{f'{column}:' if column else ''} {message}")
        self.file = file
        self.line = line
        self.column = column


@dataclass(frozen=True)
class Define:
    """A module constant without annotation: a `#define`, kept as its expression."""

    node: ast.expr
    #: The lines of the file it stands in: how a constant is written decides its type.
    lines: tuple[str, ...]


@dataclass(frozen=True)
class EnumType:
    """An enumeration: its constants are ints."""

    name: str
    constants: dict[str, int]


@dataclass(frozen=True)
class Registers:
    """A register block as a header names it; `layout` is the block class's own table."""

    name: str
    layout: dict[str, Any]


@dataclass(frozen=True)
class CoreRegister:
    """A register of the core that C declares `cregister`: IER, IFR."""

    name: str


Symbol = Define | EnumType | CType | Variable | Function | Registers | CoreRegister


@dataclass(eq=False)
class Module:
    """One source file: its symbols by name, imported ones included."""

    name: str
    file: str
    text: str
    tree: ast.Module
    c_file: str
    symbols: dict[str, Symbol] = field(default_factory=dict)
    variables: list[Variable] = field(default_factory=list)
    functions: list[Function] = field(default_factory=list)
    bodies: dict[str, ast.FunctionDef] = field(default_factory=dict)
    #: Functions and objects that an overlay replaces or adds -> the overlay, whose file and lines they have.
    units: dict[str, Module] = field(default_factory=dict)

    def unit(self, name: str) -> Module:
        """The source file that defines `name`: this one, or the overlay."""
        return self.units.get(name, self)

    @property
    def short(self) -> str:
        """The last part of the dotted name, as in the C file's name."""
        return self.name.rsplit(".", 1)[-1]
