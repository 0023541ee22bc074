"""The evidence of one demonstration: a finding of a detector, or a measured number with its bounds.

No defect is stated by hand.  It is seen if a detector has reported the entry's rule in the entry's function, or if a
measured number is outside of the bounds from its source.  Evidence that is only read is marked as such.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum

from emulator.c28x.findings import Finding


@dataclass(frozen=True, slots=True)
class Series:
    """A line of a plot: y over x, with the units in the labels of the axes."""

    label: str
    x: Sequence[float]
    y: Sequence[float]


@dataclass(frozen=True, slots=True)
class Picture:
    """A plot that helps to see the defect.  The first line comes from the firmware; the others are drawn dashed."""

    title: str
    x_label: str
    y_label: str
    series: Sequence[Series]
    #: Whether x and y are places in the plane, which need one scale for both.
    plane: bool = False


class EvidenceKind(Enum):
    """The kind of evidence.  Only the first two are proofs."""

    DETECTOR = "detector"
    #: A number measured on the running firmware.
    PROPERTY = "property"
    #: Nothing ran: numbers of the text are compared with each other.
    READ = "read"


@dataclass(frozen=True, slots=True)
class Evidence:
    """The outcome on one firmware (faithful or corrected)."""

    by: EvidenceKind
    seen: bool
    #: One line: the measured value and the right one, with units; or the finding's message.
    line: str
    findings: tuple[Finding, ...] = ()
    picture: Picture | None = field(default=None, compare=False)

    def shown(self, picture: Picture) -> Evidence:
        """The same evidence with a plot."""
        return replace(self, picture=picture)


def reported(findings: Iterable[Finding], rule: str, *, function: str = "", object: str = "") -> Evidence:
    """Seen if a detector reported `rule` in `function`, or a function that it calls, for an object named `object`."""
    hits = tuple(
        finding
        for finding in findings
        if finding.rule == rule
        and object in finding.object
        and (not function or any(place.function == function for place in finding.call_path))
    )
    where = " ".join(part for part in (function, object) if part)
    line = hits[0].message if hits else f"no finding {rule}{f' in {where}' if where else ''}"
    return Evidence(EvidenceKind.DETECTOR, bool(hits), line, hits)


def measured(
    what: str, value: float, unit: str = "", *, low: float = float("-inf"), high: float = float("inf")
) -> Evidence:
    """Seen if `value` is not within `low`..`high` (both allowed).  NaN is never within."""
    holds = low <= value <= high
    if f"{low:g}" == f"{high:g}":
        right = f"{low:g}"
    elif low == float("-inf"):
        right = f"at most {high:g}"
    elif high == float("inf"):
        right = f"at least {low:g}"
    else:
        right = f"{low:g}..{high:g}"
    unit = f" {unit}" if unit else ""
    return Evidence(EvidenceKind.PROPERTY, not holds, f"{what}: {value:g}{unit}, right is {right}{unit}")


def read(what: str, value: float, unit: str, *, low: float, high: float) -> Evidence:
    """Like `measured`, for numbers of the text, or numbers that are computed only from these."""
    return replace(measured(what, value, unit, low=low, high=high), by=EvidenceKind.READ)
