"""The units that the text of a program states: by names, and by comments beside declarations (`unit_names.py`)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from math import isclose
from typing import Final

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.tree import Const, Convert, Expr, Where
from emulator.c28x.tree_queries import bare
from hil.drivers.unit_names import PhysicalUnit, UnitRemark, remark, unit_in_context, unit_of_name

#: One number: C, and C-shaped Python.
_NUMBER: Final = (
    r"\(*\s*(?:\(\s*\w+\s*\)\s*)?([-+]?\s*(?:0[xX][0-9a-fA-F]+|\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+))[uUlLfF]*\s*\)*"
)
#: A definition whose value is one number: a macro, a name in Python, a declaration, a constant of an enumeration or a
#: member in a list of initial values.
_DEFINITION: Final = re.compile(
    rf"^\s*(?:#\s*define\s+(\w+)\s+{_NUMBER}"
    rf"|(?:(?:\w+\s+)+|enum\s*\{{\s*|\.)?(\w+)\s*(?::\s*\w+\s*)?=\s*{_NUMBER})\s*[,;]?\s*(?:\}}\s*;)?\s*$"
)
#: Members of a structure, or another declaration without a value.
_NAMES: Final = r"\w+(?:\s*\[[^\]]*\])*(?:\s*:\s*\d+)?"
_MEMBERS: Final = re.compile(rf"^\s*(?:\w+\s+)+[*\s]*({_NAMES}(?:\s*,[\s*]*{_NAMES})*)\s*;\s*$")
#: A macro with one parameter.
_MACRO: Final = re.compile(r"^\s*#\s*define\s+(\w+)\(\s*\w+\s*\)")
_IDENTIFIER: Final = re.compile(r"[A-Za-z_]\w*")
_SUBSCRIPT: Final = re.compile(r"\[[^\[\]]*\]")
#: Last letters of names that count: letters of no unit.
_CHANNELS: Final = "BDELNPRUXYZbdelnpruxyz"
#: A number in a comment may be rounded by this.
_ROUNDED: Final = 0.01


@dataclass(frozen=True, slots=True)
class Measured:
    """The unit of a value: `factor` times what was in this unit."""

    unit: PhysicalUnit
    #: What states it: a name, or a comment.  Empty: a declaration, or what is known of a library.
    by: str = ""
    factor: float = 1.0
    #: The factor is, or comes from, a constant with a name, which may convert from and to anything.
    named: bool = False
    #: The object or constant that has the unit; empty: the value itself.
    of: str = ""
    #: The hardware counter whose counts it is in; empty: another unit.
    counter: str = ""
    #: It is a number divided by a value of which the unit is known.
    inverse: bool = False

    def __str__(self) -> str:
        return f"{self.unit.name}{self.by and f' by its {self.by}'}"


@dataclass(frozen=True, slots=True)
class Misnamed:
    """A definition whose name and comment state two numbers that differ by a power of ten."""

    file: str
    line: int
    name: str
    by_name: str
    by_comment: str

    def __str__(self) -> str:
        return f"{self.name} is {self.by_name} by its name, and {self.by_comment} in its comment"


def stated(name: str, said: UnitRemark, by: str = "name") -> Measured | None:
    """The unit that the comment beside a name states, or the name; `by`: what the name is."""
    if said.unclear:
        return None
    if said.unit is not None and said.amount is None:
        return Measured(said.unit, "comment")
    unit = unit_of_name(name)
    return Measured(unit, by) if unit is not None else None


def stated_in_context(name: str, said: UnitRemark, identifiers: set[str]) -> Measured | None:
    """The unit that a name may state where another value shows the quantity (`hold_s`).

    `LIMIT_A` beside `LIMIT_B` among the `identifiers` of the program has a channel, and no unit.
    """
    unit = unit_in_context(name) if said == UnitRemark() else None
    if unit is None or (name[-2:-1] == "_" and any(name[:-1] + letter in identifiers for letter in _CHANNELS)):
        return None
    return Measured(unit, "name", of=name)


def identifiers(files: Iterable[str]) -> set[str]:
    """The identifiers in the code of files."""
    return {name for file in files for code, _ in lines_with_comments(file) for name in _IDENTIFIER.findall(code)}


def of_definition(where: Where, value: float) -> Measured | None:
    """The unit of a number that the definition at a place names; None: it is not known."""
    code, comment = _line(where)
    match = _DEFINITION.match(code)
    if match is None:
        return None
    name, said = match[1] or match[3], remark(comment)
    if said.amount is not None and abs(value) == abs(said.amount):
        said = UnitRemark(said.unit, said.unclear)
    found = stated(name, said)
    return replace(found, of=name) if found is not None else None


def as_written(e: Expr) -> Expr:
    """An expression without conversions, also those that were folded into a constant."""
    e = bare(e)
    while isinstance(e, Const) and isinstance(e.source, Convert):
        e = bare(e.source)
    return e


def defined_number(e: Const) -> tuple[str, str]:
    """The name of the number that a constant is, and the comment beside its definition; "": it has no name."""
    if e.where.macro is None or e.source is not None:
        return "", ""
    code, comment = _line(e.where.macro)
    match = _DEFINITION.match(code)
    return (match[1] or match[3], comment) if match is not None else ("", "")


def macro_name(where: Where) -> str:
    """The name of the macro with one parameter that is defined at a place; "": it is another text."""
    match = _MACRO.match(_line(where)[0])
    return match[1] if match is not None else ""


def comment_beside(where: Where, name: str) -> UnitRemark:
    """What the comment beside the declaration of a name says."""
    code, comment = _line(where)
    return remark(comment) if re.search(rf"\b{re.escape(name)}\b", code) else UnitRemark()


def members(files: Iterable[str], *, silent_agrees: bool = False) -> dict[str, UnitRemark]:
    """What comments say about members of structures, by name; members that are declared differently say nothing.

    `silent_agrees`: a declaration without a comment agrees with every other one.
    """
    said: dict[str, UnitRemark] = {}
    for file in sorted(files):
        for code, comment in lines_with_comments(file):
            match = _MEMBERS.match(code)
            for name in _IDENTIFIER.findall(_SUBSCRIPT.sub("", match[1])) if match is not None else ():
                new = remark(comment)
                if silent_agrees and not comment:
                    said.setdefault(name, new)
                    continue
                if silent_agrees and said.get(name) == UnitRemark():
                    said[name] = new
                said[name] = new if said.get(name, new) == new else UnitRemark(unclear=True)
    return said


def misnamed(files: Iterable[str]) -> Iterator[Misnamed]:
    """The definitions in `files` whose number is another one in the unit of the name than in the comment."""
    for file in sorted(files):
        for line, (code, comment) in enumerate(lines_with_comments(file), 1):
            match = _DEFINITION.match(code) if comment else None
            if match is None:
                continue
            name, said = match[1] or match[3], remark(comment)
            named = unit_of_name(name)
            if named is None or said.unit is None or not said.amount or said.unclear:
                continue
            text = (match[2] or match[4]).replace(" ", "")
            value = float(int(text, 0)) if "0x" in text.lower() else float(text)
            ratio = value * named.ratio(said.unit) / said.amount
            if any(isclose(ratio, 10.0**power, rel_tol=_ROUNDED) for power in range(-9, 10) if power):
                yield Misnamed(file, line, name, f"{value:g} in {named.name}", f"{said.amount:g} {said.unit.name}")


def _line(where: Where) -> tuple[str, str]:
    lines = lines_with_comments(where.file)
    return lines[where.line - 1] if 0 < where.line <= len(lines) else ("", "")
