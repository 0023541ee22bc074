"""What the names of a firmware module mean, once its declarations have been read: data only."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cached_property
from typing import Any, Final

from emulator.c28x.ctypes import CType
from emulator.c28x.tree import Expr, Function, Variable, Where

#: From here on two names are taken for one, mistyped (0 to 1, `difflib`); and how many are looked at, the last ones.
_ALIKE: Final = 0.75
_LOOKED_AT: Final = 3000


class NoModule(ValueError):
    """A module that cannot be found."""


class SourceError(ValueError):
    """Firmware source outside the language: file, line, column (0: not known), construct, and what would be right."""

    def __init__(self, file: str, line: int, message: str, column: int = 0) -> None:
        super().__init__(f"{file}:{line}:{f'{column}:' if column else ''} {message}")
        self.file = file
        self.line = line
        self.column = column

    @classmethod
    def at(cls, where: Where, message: str) -> SourceError:
        """The error at a place; what a macro wrote has two."""
        if where.macro is not None:
            message = f"{message} (written by the macro at {where.macro})"
        return cls(where.file, where.line, message, where.column)


def nearest(name: str, names: Iterable[str]) -> str:
    """The end of an error about an unknown name: the known one that it looks like; "" if there is none."""
    found = get_close_matches(name[:80], [n[:80] for n in names][-_LOOKED_AT:], 1, _ALIKE)
    return f": is it {found[0]}?" if found else ""


@dataclass(frozen=True)
class Remark:
    """What a reader noticed without refusing it: a static finding under `rule`, about `name`."""

    where: Where
    rule: str
    message: str
    name: str
    function: str = ""


@dataclass(frozen=True)
class Define:
    """A `#define` with a value: its replacement is an expression, evaluated where it is used."""

    name: str
    #: The typed expression, in the scope of a builder (`build.Builder`), used at a place.
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
    """A register block as a header names it; `layout` is the block class's own table."""

    name: str
    layout: dict[str, Any]
    #: The type of the block: the name of its class, and the tag of its structure in C.
    type_name: str = ""
    struct: str = ""


@dataclass(frozen=True)
class CoreRegister:
    """A register of the core that C declares `cregister`: IER, IFR."""

    name: str


@dataclass(frozen=True)
class Unmodelled:
    """A register block of the chip that is not modelled: its registers are known by name, and say so when touched."""

    name: str

    @property
    def message(self) -> str:
        """What there is to say."""
        return f"{self.name} is a peripheral of this chip that is not modelled"


Symbol = Define | EnumType | Enumerator | CType | Variable | Function | RegisterBlock | CoreRegister | Unmodelled


def _lasts(symbol: Symbol) -> bool:
    """Whether a translated program has what a name means: not a constant, nor what is only declared."""
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

    The reader leaves functions to call for bodies and initialisers, because they may use what other files declare.
    """

    name: str
    file: str
    text: str
    c_file: str
    symbols: dict[str, Symbol] = field(default_factory=dict)
    #: The names that it declares itself, in order.
    own: list[str] = field(default_factory=list)
    variables: list[Variable] = field(default_factory=list)
    functions: list[Function] = field(default_factory=list)
    #: What reads the body of a function into its tree.
    bodies: dict[Function, Callable[[], None]] = field(default_factory=dict)
    #: What reads the initialiser of a file-scope object: a value per scalar.
    initialisers: dict[Variable, Callable[[], list[Expr]]] = field(default_factory=dict)
    remarks: list[Remark] = field(default_factory=list)
    #: Objects that a `#pragma DATA_SECTION` of C places.
    placed: set[str] = field(default_factory=set)
    #: Functions and objects that an overlay replaces or adds -> the overlay, whose file and lines they have.
    units: dict[str, Module] = field(default_factory=dict)
    #: Those that an overlay adds.
    added: set[str] = field(default_factory=set)
    #: Read only because it defines what C files declare: nobody means all of it.
    brought: bool = False

    def __getstate__(self) -> dict[str, Any]:
        """What is left of it once it has been translated: objects, functions and types, not what only reading needs."""
        lasting = {name: symbol for name, symbol in self.symbols.items() if _lasts(symbol)}
        read: dict[str, Any] = {"own": [], "bodies": {}, "initialisers": {}, "remarks": [], "text": ""}
        return {**self.__dict__, "symbols": lasting, **read}

    def unit(self, name: str) -> Module:
        """The source file that defines `name`: this one, or the overlay."""
        return self.units.get(name, self)

    @cached_property
    def short(self) -> str:
        """The last part of the dotted name, as in the C file's name."""
        return self.name.rsplit(".", 1)[-1]
