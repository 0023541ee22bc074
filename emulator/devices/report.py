"""How a device tells what a driver does wrong, and at which of its statements.

A driver reaches a device through functions of its own: the statement that executes when a word has gone over the bus is
that of the transfer function, for good and for bad.  What is wrong about two accesses together (one sample taken twice)
is decided where both come from: the innermost call that is still the same.  A mark keeps the calls of one access, and a
report `since` a mark stands at the statement of that call.  Who keeps findings and calls is the board's business.
"""

from __future__ import annotations

from typing import Any, Protocol

#: The firmware's calls at one moment, innermost first.
Mark = tuple[object, ...]


class Told(Protocol):
    """What has been told, whose numbers may grow."""

    message: str
    value: Any


def shared(a: Mark, b: Mark) -> int:
    """How many calls two marks share, from the outermost inwards."""
    count = 0
    for one, other in zip(reversed(a), reversed(b), strict=False):
        if one is not other:
            break
        count += 1
    return count


class Report(Protocol):
    """What a device calls.  Returns the finding, so that its numbers can grow; None if nothing keeps it."""

    def __call__(
        self, rule: str, message: str, /, *, object: str = "", value: Any = None, since: Mark | None = None
    ) -> Told | None:
        """`rule` was broken now; `since`: together with the access that was marked."""


class Silent:
    """The report of a device that nobody listens to."""

    def __call__(
        self, rule: str, message: str, /, *, object: str = "", value: Any = None, since: Mark | None = None
    ) -> Told | None:
        """Nothing."""
        return None
