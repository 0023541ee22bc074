"""Where a static check reports: the function, its file, and the line of the statement it looks at."""

from __future__ import annotations

from dataclasses import dataclass

from emulator.c28x.findings import Findings, Place
from emulator.c28x.tree import Declaration, Function


@dataclass(frozen=True)
class StaticReport:
    """The findings of one source file."""

    findings: Findings
    file: str
    c_file: str

    def report(
        self, function: Function | None, line: int, rule: str, message: str, *, object: str = "",
        declaration: Declaration | None = None, value: int | float | None = None,
    ) -> None:  # fmt: skip
        """Record `rule` at a line of a function, or of the file scope (None)."""
        name = function.name if function is not None else ""
        place = Place(self.file, line, name, function.c_file if function is not None else self.c_file)
        self.findings.report_at(
            place, rule, message, object=object, declaration=str(declaration or ""), value=value, how="static"
        )
