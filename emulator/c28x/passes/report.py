"""The findings of static checks, with the function, its file and the place of the statement."""

from __future__ import annotations

from dataclasses import dataclass, field

from emulator.c28x.ctypes import FLOAT, FloatType
from emulator.c28x.sites import Place
from emulator.c28x.tree import Declaration, Function, Where


@dataclass(frozen=True, slots=True)
class StaticFinding:
    """A finding from the tree alone."""

    place: Place
    rule: str
    message: str
    object: str
    declaration: str
    value: int | float | None


@dataclass(frozen=True)
class StaticReport:
    """Adds the findings of one module to those of the image."""

    c_file: str
    found: list[StaticFinding] = field(repr=False)
    #: What the module calls `double`.
    double: FloatType = FLOAT

    def report(
        self, function: Function | None, where: Where, rule: str, message: str, *, object: str = "",
        declaration: Declaration | None = None, value: int | float | None = None,
    ) -> None:  # fmt: skip
        """Record `rule` at a place of a function, or of the file scope (None).

        The finding is about `object`; by default, about the object of `declaration`, else about the function.
        """
        if function is None:
            place = Place(where.file, where.line, "", self.c_file, where.column)
        else:
            place = Place(function.where.file, where.line, function.name, function.c_file, where.column)
        about = declaration or function
        object = object or (about.path if about else "")
        self.found.append(StaticFinding(place, rule, message, object, str(declaration or ""), value))
