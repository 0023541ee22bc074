"""Who sees what: specimen by tool, as a table.  README.md shows `VersionComparison.markdown`, between two marks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from hil.audit.compare.specimen import SPECIMENS

#: The column of this tool, behind those of the others.
OURS: Final = "hil"
SEEN: Final = "●"


@dataclass(frozen=True, slots=True)
class VersionComparison:
    """What was seen, and by which versions."""

    tools: Sequence[str]
    #: Specimen -> tool -> whether it points at the marked line.
    seen: Mapping[str, Mapping[str, bool]]
    #: Program -> version.
    versions: Mapping[str, str]

    def rows(self) -> list[list[str]]:
        """One row a specimen: class, rule, and a mark for each tool that sees it."""
        return [
            [specimen.about, specimen.rule, *(SEEN if self.seen[specimen.name][tool] else "" for tool in self.tools)]
            for specimen in SPECIMENS
        ]

    def total(self) -> list[str]:
        """The last row: how many specimens each tool sees."""
        counts = (sum(row[tool] for row in self.seen.values()) for tool in self.tools)
        return [f"of {len(SPECIMENS)}", "", *map(str, counts)]

    def by(self) -> str:
        """The versions, in one line."""
        return ", ".join(f"{program} {version}" for program, version in self.versions.items())

    def markdown(self) -> str:
        """The table, and a line with the versions."""
        lines = [
            _line(["defect", "rule", *self.tools]),
            "|" + "|".join(["---", "---", *[":-:"] * len(self.tools)]) + "|",
            *(_line([about, f"`{rule}`", *marks]) for about, rule, *marks in self.rows()),
            _line([f"**{cell}**" if cell else "" for cell in self.total()]),
        ]
        if self.versions:
            lines += ["", f"By {self.by()}."]
        return "\n".join(lines)


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
