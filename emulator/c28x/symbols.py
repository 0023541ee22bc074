"""The meanings of names in a firmware module, after its declarations have been read: data only."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cached_property
from typing import Any, Final

from emulator.c28x.ctypes import FLOAT, CType, FloatType
from emulator.c28x.tree import Expr, Function, Variable, Where

#: From this similarity on, a name counts as mistyped (0 to 1, `difflib`); how many known names are compared (the last).
_ALIKE: Final = 0.75
_LOOKED_AT: Final = 3000


class NoModule(ValueError):
    """A module that cannot be found."""


class NotAlike(Exception):
    """Nothing can be taken from a program with other corrections."""


class SourceError(ValueError):
    """An error in firmware source: file, line, column (0: not known), the construct, and what would be right."""

    def __init__(self, file: str, line: int, message: str, column: int = 0) -> None:
        super().__init__(f"{file}:{line}:{f'{column}:' if column else ''} {message}")
        self.file = file
        self.line = line
        self.column = column

    @classmethod
    def at(cls, where: Where, message: str) -> SourceError:
        """The error at a place; text from a macro has two places."""
        if where.macro is not None:
            message = f"{message} (written by the macro at {where.macro})"
        return cls(where.file, where.line, message, where.column)


def nearest(name: str, names: Iterable[str]) -> str:
    """The end of an error about an unknown name: a similar known name; "" if there is none."""
    found = get_close_matches(name[:80], [n[:80] for n in names][-_LOOKED_AT:], 1, _ALIKE)
    return f": is it {found[0]}?" if found else ""


@dataclass(frozen=True)
class Remark:
    """A remark of a reader about accepted source: a static finding of `rule`, about `name`."""

    where: Where
    rule: str
    message: str
    name: str
    function: str = ""


@dataclass(frozen=True)
class Define:
    """A `#define` with a value.  Its replacement is an expression, built anew at each use."""

    name: str
    #: (builder, place of use) -> the typed expression, in the scope of that builder (`build.Builder`).
    expression: Callable[[Any, Where], Expr]
    #: The replacement as C text; None if C has no such constant.
    written: Callable[[], str | None]


@dataclass(frozen=True)
class Enumerator:
    """A constant of an enumeration under its own name."""

    name: str
    value: int


@dataclass(frozen=True)
class EnumType:
    """An enumeration: its constants are ints."""

    name: str
    constants: dict[str, int]


@dataclass(frozen=True)
class RegisterBlock:
    """A register block as a header names it.  `layout` is the table of its block class."""

    name: str
    layout: dict[str, Any]
    #: The type of the block: the name of its class (`type_name`), and its structure tag in C (`struct`).
    type_name: str = ""
    struct: str = ""


@dataclass(frozen=True)
class CoreRegister:
    """A register of the core that C declares `cregister`: IER, IFR."""

    name: str


@dataclass(frozen=True)
class Unmodelled:
    """A register block of the chip that is not modelled.  Any register name is accepted; an access is reported."""

    name: str

    @property
    def message(self) -> str:
        """The text of such a report."""
        return f"{self.name} is a peripheral of this chip that is not modelled"


Symbol = Define | EnumType | Enumerator | CType | Variable | Function | RegisterBlock | CoreRegister | Unmodelled


def _is_lasting(symbol: Symbol) -> bool:
    """Whether a translated program keeps a symbol: not a constant, nor something that is only declared."""
    match symbol:
        case Function(extern=extern):
            return not extern
        case CType(words=words):
            return words > 0
        case _:
            return isinstance(symbol, Variable | EnumType)


@dataclass(eq=False)
class Module:
    """One source file: its symbols by name, imported ones included.

    Bodies and initialisers are read later, by functions that the reader stores here: they may use other files.
    """

    name: str
    file: str
    text: str
    c_file: str
    symbols: dict[str, Symbol] = field(default_factory=dict)
    #: The names that this file declares itself, in order.
    own: list[str] = field(default_factory=list)
    variables: list[Variable] = field(default_factory=list)
    functions: list[Function] = field(default_factory=list)
    #: Function -> reads its body into its tree.
    bodies: dict[Function, Callable[[], None]] = field(default_factory=dict)
    #: File-scope object -> reads its initialiser: one value per scalar.
    initialisers: dict[Variable, Callable[[], list[Expr]]] = field(default_factory=dict)
    remarks: list[Remark] = field(default_factory=list)
    #: Objects that a `#pragma DATA_SECTION` places in a section.
    placed: set[str] = field(default_factory=set)
    #: Functions and objects that an overlay replaces or adds -> the overlay, in whose file they are.
    units: dict[str, Module] = field(default_factory=dict)
    #: The names that an overlay adds.
    added: set[str] = field(default_factory=set)
    #: It was read only because it defines something that C files declare; the rest of it may be unused.
    brought: bool = False
    #: What it calls `double`.
    double: FloatType = FLOAT

    def __getstate__(self) -> dict[str, Any]:
        """The state of a translated module: objects, functions and types, without what only the reader needs."""
        lasting = {name: symbol for name, symbol in self.symbols.items() if _is_lasting(symbol)}
        read: dict[str, Any] = {"own": [], "bodies": {}, "initialisers": {}, "remarks": [], "text": ""}
        return {**self.__dict__, "symbols": lasting, **read}

    def unit(self, name: str) -> Module:
        """The source file that defines `name`: this one, or the overlay."""
        return self.units.get(name, self)

    @cached_property
    def short(self) -> str:
        """The last part of the dotted name; the C file has the same name."""
        return self.name.rsplit(".", 1)[-1]


def library_headers(modules: Iterable[Module]) -> frozenset[str]:
    """The headers with functions that belong to files which were only brought: headers of libraries.

    They stand beside these files, or in the folder `include` beside their folder `source`.  The name of a header is as
    the user wrote it, and may lead over a link; that of a brought file does not.
    """
    modules = list(modules)
    folders = {_folder(module.file) for module in modules if module.brought}
    folders -= {_folder(module.file) for module in modules if not module.brought}
    folders |= {os.path.join(os.path.dirname(f), "include") for f in folders if os.path.basename(f) == "source"}
    files = {f.where.file for module in modules for f in module.functions} - {module.file for module in modules}
    return frozenset(file for file in files if _folder(file) in folders)


def _folder(file: str) -> str:
    """The folder of a file, with links resolved."""
    return os.path.dirname(os.path.realpath(file))
