"""How much a check may compute: counted in what the chip does, so that every machine finds the same.

The unit is the executed cycle, about 10 ns of an ordinary machine's time.  Cycles of polls and delays are carried over
and not counted; an event of the chip, and making a chip, count as many as take as long.  Only where all this fails, the
time of this machine is the last resort, and the report says so.
"""

from __future__ import annotations

from time import process_time
from typing import Final

from hil.image import Image

#: What a call may compute: half as much after each one that computed more, but never less than the second number.
_CALL: Final = (20_000_000, 5_000_000)
#: What all calls together may compute, and a run of `main` or the tasks.
CALLS: Final = 600_000_000
RUN: Final = 200_000_000
#: What counts besides executed cycles: an event of the chip, and a fresh image.
_EVENT: Final = 500
_IMAGE: Final = 2_000_000
#: Seconds of this machine for all calls, and for a run: what the budgets allow takes a tenth of it.
_LAST_RESORT_S: Final = 120.0


def computed(image: Image) -> int:
    """What an image has computed so far."""
    clock = image.board.clock
    return clock.now - clock.waited + _EVENT * clock.events_run


class TimeBudget:
    """What is left of `allowed`.  `cut` says whether this machine's time has ended it."""

    def __init__(self, allowed: int) -> None:
        self.left = allowed
        #: What the next call may compute.
        self.call = _CALL[0]
        self.cut = False
        self._began = process_time()

    def spend(self, cycles: int) -> None:
        """So much has been computed."""
        self.left -= cycles

    def exceeded(self) -> None:
        """A call has computed more than it may: the next one, of a function like that, has less."""
        self.call = max(self.call // 2, _CALL[1])

    def image(self) -> None:
        """An image has been made."""
        self.left -= _IMAGE

    @property
    def over(self) -> bool:
        """Whether nothing is left."""
        self.cut = self.cut or process_time() - self._began > _LAST_RESORT_S
        return self.cut or self.left <= 0
