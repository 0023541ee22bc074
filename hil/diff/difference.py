"""One difference between the port and the C: what differs, where in each, and why."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from emulator.c28x.sites import Place
from emulator.c28x.tree import Where

PORT: Final = "the port"
OWN: Final = "the C"


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


def spelled(name: str) -> str:
    """An object as a report names it, spelled alike in C and in C-shaped Python: `p->x` is `p.x` there."""
    return name.replace("->", ".")
