"""What a static check finds, and where: the function, its file, and the line of the statement it looks at."""

from __future__ import annotations

from dataclasses import dataclass, field

from emulator.c28x.sites import Place
from emulator.c28x.tree import Declaration, Function, Where


@dataclass(frozen=True, slots=True)
class StaticFinding:
    """A finding of the tree alone."""

    place: Place
    rule: str
    message: str
    object: str
    declaration: str
    value: int | float | None


@dataclass(frozen=True)
class StaticReport:
    """The findings of one source file, added to those of the image."""

    file: str
    c_file: str
    found: list[StaticFinding] = field(repr=False)

    def report(
        self, function: Function | None, where: Where, rule: str, message: str, *, object: str = "",
        declaration: Declaration | None = None, value: int | float | None = None,
    ) -> None:  # fmt: skip
        """Record `rule` at a place of a function, or of the file scope (None)."""
        name = function.name if function is not None else ""
        place = Place(
            self.file, where.line, name, function.c_file if function is not None else self.c_file, where.column
        )  # fmt: skip
        self.found.append(StaticFinding(place, rule, message, object, str(declaration or ""), value))
