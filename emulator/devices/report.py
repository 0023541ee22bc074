"""How a device reports mistakes of a driver, and at which statement.

A driver reaches a device through functions of its own.  When a word has gone over the bus, the executing statement is
always that of the transfer function.  A mistake in two accesses together (one sample taken twice) comes from the code
that made both: the innermost call that both share.  A mark keeps the calls of one access.  A report `since` a mark has
the statement of that shared call as its place.  The board keeps findings and calls.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

#: The firmware's calls at one moment: the innermost one, which is a tuple of its own; its second member is the call
#: around it (`emulator.c28x.sites.Calls`).  Empty: no call.
Mark = tuple[Any, ...]


class ReportedFinding(Protocol):
    """A finding whose numbers may still grow."""

    message: str
    value: Any


def shared(a: Mark, b: Mark) -> Mark:
    """The innermost call that two marks share; all calls around it are the same too.  Empty if there is none."""
    calls = set()
    while a:
        calls.add(id(a))
        a = a[1] or ()
    while b and id(b) not in calls:
        b = b[1] or ()
    return b


class DeviceReport(Protocol):
    """The report function of a device.  Returns the finding, so that its numbers can grow; None if it is not kept."""

    def __call__(
        self, rule: str, message: str, /, *, object: str = "", value: Any = None, since: Mark | None = None,
        cause: Any = None,
    ) -> ReportedFinding | None:  # fmt: skip
        """`rule` was broken now; `since`: together with the marked access; `cause`: by an earlier statement."""


def mark_of(report: DeviceReport) -> Callable[[], Mark]:
    """The function that returns the present mark; for reports without places, one that returns an empty mark."""
    mark: Callable[[], Mark] = getattr(report, "mark", tuple)
    return mark


class DiscardedReports:
    """The report function of a device whose reports are not kept."""

    def __call__(
        self, rule: str, message: str, /, *, object: str = "", value: Any = None, since: Mark | None = None,
        cause: Any = None,
    ) -> ReportedFinding | None:  # fmt: skip
        """Do nothing."""
        return None
