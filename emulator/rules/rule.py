"""What a rule is: an identifier that never changes, how bad it is, and the page that explains it."""

from __future__ import annotations

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


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule.  `page` is Markdown: what it means on this chip, why nothing else shows it, what to do."""

    id: str
    severity: Severity
    family: str
    #: One sentence: what the firmware did.
    title: str
    page: str
    #: Seen while the firmware runs ("dynamic"), or in its typed tree ("static").
    how: str = "dynamic"
    #: Document and section that make it a defect.
    source: str = ""
