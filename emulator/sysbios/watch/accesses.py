"""Accesses of one memory cell or one piece of a peripheral by several threads, and which of them nothing keeps apart.

Hybrid of Eraser (S. Savage et al. 1997) and vector clocks (R. O'Callahan, J. Choi 2003).  A cell belongs to the thread
that uses it first until another one comes: initialisation needs no protection.  From then on every access is kept, by
thread, direction and protection.  Two accesses conflict if one of them writes, nothing excludes them (threads.py), and
no semaphore, post or plain hand-over word orders them.

Only what a later access finds written counts: that a buffer is written again after it was read follows from its being
handed over, and whether the reader has finished by then is a matter of time, not of order.
"""

from __future__ import annotations

from typing import Final

from emulator.sysbios.watch.spots import Spot
from emulator.sysbios.watch.threads import Protection, Thread, VectorClock, excluded


class LatestAccess:
    """The latest access of one thread, direction and protection."""

    __slots__ = ("clock", "protection", "spot", "thread", "time", "write")

    def __init__(self, thread: Thread, write: bool, protection: Protection, clock: int, spot: Spot, time: int) -> None:
        self.thread = thread
        self.write = write
        self.protection = protection
        self.clock = clock
        self.spot = spot
        self.time = time


NONE: Final[tuple[LatestAccess, ...]] = ()


class SharedObject:
    """A scalar, or what else can be used by one thread at a time."""

    __slots__ = (
        "accesses", "changed", "handed", "hands_over", "last", "owner", "reader", "reader_spot", "writers", "writes",
    )  # fmt: skip

    def __init__(self, owner: Thread, hands_over: bool = False) -> None:
        #: The only thread so far; None once there are two.
        self.owner: Thread | None = owner
        #: Whether its value may say that something else is ready.
        self.hands_over = hands_over
        self.accesses: dict[tuple[Thread, bool, Protection], LatestAccess] = {}
        #: The latest of them, and those that write.
        self.last: LatestAccess | None = None
        self.writes: list[LatestAccess] = []
        self.writers: set[Thread] = set()
        #: Threads that changed it by one statement which reads it too: the latest one under each protection.
        self.changed: dict[Thread, dict[Protection, Spot]] = {}
        #: Last reader with its statement, and what the last writer knew of the others, at its own clock.
        self.reader: Thread | None = None
        self.reader_spot: Spot = 0
        self.handed: tuple[Thread, int, VectorClock] | None = None

    def conflicts(self, thread: Thread, protection: Protection) -> tuple[LatestAccess, ...]:
        """Writes of other threads that nothing keeps apart from an access of `thread` under `protection`."""
        found = NONE
        for other in self.writes:
            if (
                other.thread is not thread
                and not thread.knows(other.thread, other.clock)
                and not excluded(other.thread, other.protection, thread, protection)
            ):
                found = (*found, other)
        return found

    def unfinished(self, thread: Thread, protection: Protection) -> tuple[LatestAccess, ...]:
        """Reads of other threads that a write of `thread` may come into, because nothing says that they are over."""
        return tuple(
            other for other in self.accesses.values()
            if not other.write
            and other.thread is not thread
            and not thread.knows(other.thread, other.clock)
            and not excluded(other.thread, other.protection, thread, protection)
        )  # fmt: skip

    def cut(self, low: Thread, high: LatestAccess) -> Spot | None:
        """The statement by which `low` changed it, and which nothing keeps `high` from coming into."""
        for protection, spot in self.changed.get(low, {}).items():
            if high.thread in self.writers and not excluded(low, protection, high.thread, high.protection):
                return spot
        return None

    def keep(self, thread: Thread, write: bool, protection: Protection, spot: Spot, time: int) -> None:
        """Remember an access, once the cell is shared."""
        known = self.last
        if known is None or known.thread is not thread or known.write != write or known.protection is not protection:
            key = (thread, write, protection)
            known = self.accesses.get(key)
            if known is None:
                known = self.accesses[key] = LatestAccess(thread, write, protection, thread.clock, spot, time)
                if write:
                    self.writes.append(known)
            self.last = known
        known.clock, known.spot, known.time = thread.clock, spot, time
