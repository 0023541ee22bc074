"""What a rule is: an identifier that never changes, how bad it is, and the page that explains it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum


class Severity(Enum):
    """How bad a finding is; the order of comparison is that of harm."""

    NOTE = "note"
    WARNING = "warning"
    ERROR = "error"

    @property
    def rank(self) -> int:
        """0 for a note, 2 for an error."""
        return ("note", "warning", "error").index(self.value)


def counted(severities: Iterable[Severity]) -> str:
    """The number of findings of each severity, the worst first: "11 errors, 35 warnings"; "no findings"."""
    every = list(severities)
    counts = [(every.count(severity), severity.value) for severity in reversed(Severity)]
    texts = [f"{number} {name}{'' if number == 1 else 's'}" for number, name in counts if number]
    return ", ".join(texts) or "no findings"


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule.  `page` is Markdown: what it means on this chip, why nothing else shows it, what to do."""

    id: str
    severity: Severity
    family: str
    #: One sentence: what the firmware did.
    title: str
    page: str
    #: Document and section that make it a defect.
    source: str = ""
    #: Seen while the firmware runs ("dynamic"), in its typed tree ("static"), or in either way ("dynamic/static").
    how: str = "dynamic"


def rule(
    family: str, id: str, severity: Severity, title: str, page: str, source: str = "", *, how: str = "dynamic"
) -> Rule:
    """A rule as the modules of families write it: each binds its own `family`."""
    return Rule(id, severity, family, title, page.strip(), source, how)
