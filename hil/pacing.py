"""Real time laid over virtual time: absolute deadlines, and an honest account of how late they were met.

The machine runs in slices.  A slice that ends at virtual time T is executed when the wall clock reaches T's
deadline, so what happens in it becomes visible at most one slice (`SLICE_S`) plus its execution late, never early.
Bytes from the PC end the wait at once and are stamped with the virtual time of their arrival, not of the slice.

Lag is the wall time by which a slice was finished after its deadline.  When the computer falls more than
`REANCHOR_S` behind, the anchor is moved: that much real time is lost, and it is counted.  Nothing is made up by
running faster than asked after such a loss.
"""

from __future__ import annotations

import os
import select
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

from emulator.clock import SYSCLK_HZ

#: Real time in one slice.
SLICE_S: Final = 0.005
#: Virtual time in one slice when nothing is waited for: long enough that looking at the port costs little.
FREE_SLICE_S: Final = 0.025
REANCHOR_S: Final = 0.5
_BIN_S: Final = 0.0001
_BINS: Final = int(REANCHOR_S / _BIN_S) + 1

#: wait(fds, seconds) -> whether one of them became readable in that time.
Wait = Callable[[Sequence[int], float], bool]


def wait_readable(fds: Sequence[int], seconds: float) -> bool:
    """Wait until one of `fds` is readable or the time is over.

    `select` and not epoll or sleep: its time-out has microseconds.
    """
    if not fds and os.name != "posix":
        time.sleep(seconds)  # there is nothing to wait for but time, and Windows' select wants a socket
        return False
    return bool(select.select(fds, [], [], seconds)[0])


@dataclass(slots=True)
class Lag:
    """How late slices were finished."""

    slices: int = 0
    last_s: float = 0.0
    max_s: float = 0.0
    reanchors: int = 0
    lost_s: float = 0.0
    _bins: list[int] = field(default_factory=lambda: [0] * _BINS, repr=False)

    def note(self, lag_s: float) -> None:
        """A slice was finished `lag_s` after its deadline."""
        self.slices += 1
        self.last_s = lag_s
        self.max_s = max(self.max_s, lag_s)
        self._bins[min(int(max(lag_s, 0.0) / _BIN_S), _BINS - 1)] += 1

    def quantile_s(self, share: float) -> float:
        """The lag that `share` (0..1) of the slices did not exceed, in steps of 0.1 ms."""
        wanted = share * self.slices
        seen = 0
        for index, count in enumerate(self._bins):
            seen += count
            if seen >= wanted and seen:
                return min((index + 1) * _BIN_S, self.max_s)
        return 0.0

    def as_dict(self) -> dict[str, float | int]:
        """Plain data for JSON, in milliseconds."""
        return {
            "median_ms": self.quantile_s(0.5) * 1e3,
            "p99_ms": self.quantile_s(0.99) * 1e3,
            "max_ms": self.max_s * 1e3,
            "reanchors": self.reanchors,
            "lost_ms": self.lost_s * 1e3,
        }


class Pacer:
    """Says when a virtual time is due on the wall clock."""

    def __init__(
        self,
        pace: float | None,
        *,
        monotonic: Callable[[], float] = time.monotonic,
        wait: Wait = wait_readable,
    ) -> None:
        """`pace` is virtual seconds per real second, None for as fast as possible."""
        if pace is not None and not 0.001 <= pace <= 1000:
            raise ValueError(f"pace {pace}: must be 'max' or a number from 0.001 to 1000 (1 is real time)")
        self.pace = pace
        self.lag = Lag()
        self._monotonic = monotonic
        self._wait = wait
        self._cycles_per_s = (pace or 1.0) * SYSCLK_HZ
        self._anchor_s = 0.0
        self._anchor_cycles = 0
        self._started_s = 0.0
        self._started_cycles = 0

    @property
    def slice_cycles(self) -> int:
        """How much virtual time to run at once."""
        if self.pace is None:
            return int(FREE_SLICE_S * SYSCLK_HZ)
        return max(1, int(SLICE_S * self._cycles_per_s))

    def start(self, cycles: int) -> None:
        """Virtual time `cycles` is now."""
        self._anchor_cycles = self._started_cycles = cycles
        self._anchor_s = self._started_s = self._monotonic()

    def deadline_s(self, cycles: int) -> float:
        """When virtual time `cycles` is due, on the monotonic clock."""
        return self._anchor_s + (cycles - self._anchor_cycles) / self._cycles_per_s

    def virtual_now(self) -> int:
        """The virtual time that is due now."""
        return self._anchor_cycles + int((self._monotonic() - self._anchor_s) * self._cycles_per_s)

    def wait_until(self, cycles: int, fds: Sequence[int]) -> bool:
        """Wait until `cycles` is due.  True if one of `fds` became readable before."""
        if self.pace is None:
            return False
        left = self.deadline_s(cycles) - self._monotonic()
        return left > 0 and self._wait(fds, left)

    def finished(self, cycles: int) -> None:
        """The machine has run to `cycles`: account for the lag."""
        if self.pace is None:
            return
        lag = self._monotonic() - self.deadline_s(cycles)
        self.lag.note(lag)
        if lag > REANCHOR_S:
            self.lag.reanchors += 1
            self.lag.lost_s += lag
            self._anchor_s += lag

    def elapsed_s(self) -> float:
        """Real time since `start`."""
        return self._monotonic() - self._started_s

    def ratio(self, cycles: int) -> float:
        """Virtual seconds per real second since `start`, by what was really reached."""
        elapsed = self.elapsed_s()
        return (cycles - self._started_cycles) / SYSCLK_HZ / elapsed if elapsed > 0 else 0.0
