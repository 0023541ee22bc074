"""The header of a module: its types, constants and functions as C text, for other C files.

It is used for firmware in C-shaped Python that is mixed with C files, and for the headers of the project itself.
Types, constants and prototypes come from the read module, so nothing is declared twice.  A header has no objects:
C-shaped Python does not state which of them are `static`, and no C file of the robot uses an object of another file.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Final

from emulator.c28x.ctypes import ArrayType, CType, FunctionType, HandleType, PointerType, StructType
from emulator.c28x.readers.c.declarators import declarator, definition, enumeration, forward, prototype, structure
from emulator.c28x.symbols import Define, EnumType, Module, Symbol
from emulator.c28x.tree import Function

#: Name of a type -> the header that declares it, which the module's header then includes; None: no header.
Home = Callable[[str], "str | None"]

_MARKS: Final = re.compile(r"\W")


def c_header(
    module: Module, file: str, *, home: Home = lambda name: None, constants: Collection[str] | None = None,
    private: Collection[str] = (),
) -> str:  # fmt: skip
    """The text of the header `file` of `module`: its own types, constants and functions.

    `home` returns the header of a type that is declared elsewhere.  `constants` are the names that become `#define`s;
    None: all.  `private` names are left out: functions that are `static` in the C file.
    """
    own = {name: symbol for name, symbol in own_symbols(module).items() if name not in private}
    includes = dict.fromkeys(header for name in _foreign(own) if (header := home(name)) is not None and header != file)
    lines = [f'#include "{header}"' for header in includes]
    lines += defines({name: s for name, s in own.items() if constants is None or name in constants})
    return guarded(file, [*lines, *types(own), *prototypes(own)])


def guarded(file: str, lines: Collection[str]) -> str:
    """The text of a header, with guards so that it can be included twice."""
    mark = f"_GENERATED_{_MARKS.sub('_', file).upper()}"  # a reserved name: no header of the user has it
    return "\n".join((f"#ifndef {mark}", f"#define {mark}", *lines, "#endif", ""))


def own_symbols(module: Module) -> dict[str, Symbol]:
    """The symbols that a module declares itself, in order, without imported ones."""
    return {name: module.symbols[name] for name in module.own if name in module.symbols}


def defines(symbols: Mapping[str, Symbol]) -> list[str]:
    """The constants among `symbols`, as `#define`s."""
    found = [definition(name, symbol) for name, symbol in symbols.items() if isinstance(symbol, Define)]
    return [text for text in found if text is not None]


def prototypes(symbols: Mapping[str, Symbol]) -> list[str]:
    """The functions among `symbols`, as declarations."""
    return [f"{prototype(symbol)};" for symbol in symbols.values() if isinstance(symbol, Function)]


def types(symbols: Mapping[str, Symbol], *, members: bool = True) -> list[str]:
    """The types among `symbols`, declared in an order that C accepts.  `members` False: structures without members."""
    names, bodies = [], []
    done: set[str] = set()

    def define(ctype: StructType) -> None:
        if ctype.name in done:
            return
        done.add(ctype.name)
        for member in ctype.members:
            inner = member.ctype
            while isinstance(inner, ArrayType):
                inner = inner.element
            if isinstance(inner, StructType) and symbols.get(inner.name) is inner:
                define(inner)
        bodies.append(structure(ctype))

    for name, symbol in symbols.items():
        match symbol:
            case EnumType():
                names.append(enumeration(symbol))
            case StructType() if symbol.name == name:
                names.append(forward(symbol))
                define(symbol)
            case HandleType() if symbol.name == name:
                names.append(f"typedef struct {handle_tag(name)} *{name};")
            case CType():
                names.append(f"typedef {declarator(symbol, name)};")
    return [*names, *bodies] if members else names


def handle_tag(name: str) -> str:
    """The tag of the hidden structure behind the handle type `name`."""
    return f"{name.removesuffix('_Handle')}_Object"


def _foreign(symbols: Mapping[str, Symbol]) -> Iterator[str]:
    """The names of types that `symbols` use but do not contain."""
    for symbol in symbols.values():
        match symbol:
            case StructType():
                used = [name for member in symbol.members for name in _named(member.ctype)]
            case Function(ctype=ctype):
                used = [name for part in (ctype.result, *ctype.parameters) for name in _named(part)]
            case CType():
                used = list(_named(symbol))
            case _:
                used = []
        yield from (name for name in used if name not in symbols)


def _named(ctype: CType) -> Iterator[str]:
    """The named types that `ctype` consists of."""
    match ctype:
        case PointerType(target=inner) | ArrayType(element=inner):
            yield from _named(inner)
        case FunctionType(result=result, parameters=parameters):
            for part in (result, *parameters):
                yield from _named(part)
        case StructType(name=name) | HandleType(name=name):
            yield name
