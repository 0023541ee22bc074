"""Findings with their severities, and with the reason why the source accepts them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

from emulator.c28x.findings import Finding
from emulator.rules import Severity
from hil.reports.accepted import why_accepted
from hil.reports.policy import Policy

WORST_FIRST: Final = sorted(Severity, key=lambda severity: -severity.rank)
#: The kind of a finding that the source accepts.  It is counted by itself, not with its severity.
ACCEPTED: Final = "accepted"
#: The kinds of findings, in the order in which they are counted.
KINDS: Final = (*(severity.value for severity in WORST_FIRST), ACCEPTED)


@dataclass(frozen=True, slots=True)
class RatedFinding:
    """A finding as the page shows it."""

    finding: Finding
    severity: Severity
    #: Why the source accepts it (`hil: allow`); empty: it does not.
    accepted: str = ""

    @property
    def kind(self) -> str:
        """One of `KINDS`: "accepted", or the severity."""
        return ACCEPTED if self.accepted else self.severity.value


def rated(findings: Iterable[Finding], policy: Policy) -> list[RatedFinding]:
    """The findings in their order, without those whose rule is turned off."""
    return [
        RatedFinding(finding, severity, why_accepted(finding))
        for finding, severity in policy.with_severities(findings)
    ]


def worst_first(findings: Iterable[RatedFinding]) -> list[RatedFinding]:
    """Sort by severity; findings of one severity keep their order."""
    return sorted(findings, key=lambda each: -each.severity.rank)


def by_kind(findings: Iterable[RatedFinding]) -> dict[str, int]:
    """The number of findings of each kind, in the order of `KINDS`."""
    counts = Counter(each.kind for each in findings)
    return {kind: counts[kind] for kind in KINDS}


def in_words(kind: str, count: int) -> str:
    """A count as text: "11 errors", "1 warning", "2 accepted"."""
    return f"{count} {kind}{'' if count == 1 or kind == ACCEPTED else 's'}"


def counted(counts: Mapping[str, int]) -> str:
    """Counts as coloured words of HTML."""
    words = [f'<span class="severity {kind}">{in_words(kind, count)}</span>' for kind, count in counts.items() if count]
    return " ".join(words) or "none"
