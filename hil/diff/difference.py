"""One difference between the port and the C: what differs, where in each, and why."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place
from emulator.c28x.tree import Where

PORT: Final = "the port"
OWN: Final = "the C"
#: Which side shows a finding.
BOTH: Final = "both"
PORT_ALONE: Final = f"{PORT} alone"
OWN_ALONE: Final = f"{OWN} alone"


@dataclass(frozen=True)
class Difference:
    """Something that is not alike.  `what` is a function (`gyro.readReg`), an object, or a thread of a run.

    `port` and `own` are places (`us.py:139`, `us.c:94:12`), empty where one has nothing of it.
    """

    what: str
    port: str
    own: str
    cause: str

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return asdict(self)


def place(where: Where) -> str:
    """A place as a report names it: file, line, and in C the column; empty for a place in no file."""
    if not where.file:
        return ""
    column = f":{where.column}" if where.column and not where.file.endswith(".py") else ""
    return f"{Path(where.file).name}:{where.line}{column}"


def place_text(at: Place) -> str:
    """The place of something that ran, likewise."""
    return f"{Path(at.file).name}:{at.numbers}" if at.file else ""


def _object(finding: Finding) -> str:
    return finding.object


def _function(finding: Finding) -> str:
    return finding.place.function if finding.place is not None else ""


def matched(port: Iterable[Finding], own: Iterable[Finding]) -> list[tuple[Finding, str]]:
    """All findings, each with which side shows it: `BOTH`, where it is as the C shows it, or one of them alone.

    Those of one rule about one object belong together; of the rest those of one rule in one function, because an object
    may be an expression, and C spells those differently.
    """
    ours, theirs = list(port), list(own)
    both: list[tuple[Finding, str]] = []
    for about in (_object, _function):
        for finding in list(ours):
            other = next((f for f in theirs if f.rule == finding.rule and about(f) == about(finding)), None)
            if other is not None:
                ours.remove(finding)
                theirs.remove(other)
                both.append((other, BOTH))
    return [*both, *((f, OWN_ALONE) for f in theirs), *((f, PORT_ALONE) for f in ours)]
