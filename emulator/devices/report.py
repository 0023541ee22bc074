"""How a device tells what a driver does wrong, and at which of its statements.

A driver reaches a device through functions of its own: the statement that executes when a word has gone over the bus is
that of the transfer function, for good and for bad.  What is wrong about two accesses together (one sample taken twice)
is decided where both come from: the innermost call that is still the same.  A mark keeps the calls of one access, and a
report `since` a mark stands at the statement of that call.  Who keeps findings and calls is the board's business.
"""

from __future__ import annotations

from typing import Any, Protocol

#: The firmware's calls at one moment: the innermost one, which is a tuple of its own; its second member is the call
#: around it (`emulator.c28x.sites.Calls`).  Empty: no call.
Mark = tuple[Any, ...]


class ReportedFinding(Protocol):
    """What has been told, whose numbers may grow."""

    message: str
    value: Any


def shared(a: Mark, b: Mark) -> Mark:
    """The innermost call that two marks share, from which on they are the same outwards; empty if there is none."""
    calls = set()
    while a:
        calls.add(id(a))
        a = a[1] or ()
    while b and id(b) not in calls:
        b = b[1] or ()
    return b


class DeviceReport(Protocol):
    """What a device calls.  Returns the finding, so that its numbers can grow; None if nothing keeps it."""

    def __call__(
        self, rule: str, message: str, /, *, object: str = "", value: Any = None, since: Mark | None = None
    ) -> ReportedFinding | None:
        """`rule` was broken now; `since`: together with the access that was marked."""


class Silent:
    """The report of a device that nobody listens to."""

    def __call__(
        self, rule: str, message: str, /, *, object: str = "", value: Any = None, since: Mark | None = None
    ) -> ReportedFinding | None:
        """Nothing."""
        return None
