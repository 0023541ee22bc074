"""How much a check may compute.  It is counted in work of the chip, so that every machine finds the same.

The unit is the executed cycle, about 50 ns of an ordinary machine's time.  Cycles of polls, of delays and of turns that
change nothing are skipped and not counted.  An event of the chip, and the creation of a chip, count as the number of
cycles that take as long.  Only if all this fails, the time of this machine ends the check, and the report says so.
"""

from __future__ import annotations

from time import process_time
from typing import Final

from hil.image import Image

#: The budget of one call.  It is halved after each call that exceeded it, but never falls below the second number.
_CALL: Final = (20_000_000, 5_000_000)
#: The budget of all calls together, and of a run of `main` or the tasks.
CALLS: Final = 600_000_000
RUN: Final = 200_000_000
#: The cycles that an event of the chip and a fresh image count for.
_EVENT: Final = 50
_IMAGE: Final = 2_000_000
#: The limit in seconds of this machine for all calls, and for a run.  The budgets usually take a tenth of it.
_LAST_RESORT_S: Final = 120.0


def computed(image: Image) -> int:
    """The work that an image has done so far, in cycles."""
    clock = image.board.clock
    return clock.now - clock.waited + _EVENT * clock.events_run


class TimeBudget:
    """The rest of the budget `allowed`.  `cut` says whether the time limit of this machine has ended it."""

    def __init__(self, allowed: int) -> None:
        self.left = allowed
        #: The budget of the next call.
        self.call = _CALL[0]
        self.cut = False
        self._began = process_time()

    def spend(self, cycles: int) -> None:
        """Subtract work that has been done."""
        self.left -= cycles

    def exceeded(self) -> None:
        """A call has exceeded its budget: reduce the budget of the next call."""
        self.call = max(self.call // 2, _CALL[1])

    def image(self) -> None:
        """Subtract the work of creating an image."""
        self.left -= _IMAGE

    @property
    def over(self) -> bool:
        """Whether the budget is used up."""
        self.cut = self.cut or process_time() - self._began > _LAST_RESORT_S
        return self.cut or self.left <= 0
