"""Accesses of several threads to one memory cell or one part of a peripheral; finds those that conflict.

The method combines Eraser (S. Savage et al. 1997) with vector clocks (R. O'Callahan, J. Choi 2003).  A cell belongs to
the first thread that uses it, until a second thread uses it: initialisation needs no protection.  From then on the
latest access is kept per thread, direction and protection.  Two accesses conflict if one of them writes, nothing
excludes them (threads.py), and no semaphore, post or plain hand-over word orders them.

`conflicts` compares an access with earlier writes only.  A buffer that was handed over is written again after it was
read.  Whether its reader has finished by then is a question of time, and the order of events does not answer it.

A Swi or handler also keeps itself off: it uses a buffer only while a flag has a certain value, and the flag has another
one now (`LatestAccess.flags`).  Who gave it that value does not matter, but the thread of the lower level must know of
it.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

from emulator.sysbios.watch.statements import StatementNumber
from emulator.sysbios.watch.threads import Protection, Thread, VectorClock, at_clock, excluded, joined


class ReadyFlag(NamedTuple):
    """A scalar that may tell a reader that other data is ready: path of its object, word in it, where its value is."""

    path: str
    word: int
    data: list[Any]
    number: int


class LatestAccess:
    """The latest access with one thread, one direction (read or write) and one protection."""

    __slots__ = ("clock", "flags", "protection", "statement", "thread", "time", "vector", "write")

    def __init__(
        self, thread: Thread, write: bool, protection: Protection, clock: int, statement: StatementNumber, time: int
    ) -> None:
        #: The words that its run had read before it, with their values: only those that were the same each time.  And
        #: the level of the thread that has given them these values.
        self.flags: dict[SharedCell, tuple[Any, int]] = dict(thread.seen)
        #: The vector clock of its thread at that time.
        self.vector = thread.vector
        self.thread = thread
        self.write = write
        self.protection = protection
        self.clock = clock
        self.statement = statement
        self.time = time

    def held_off(self, thread: Thread) -> list[ReadyFlag]:
        """The flags that keep it off until `thread`, of a lower level or the same, or one below changes them."""
        level = thread.level
        if self.thread.level < level:
            return []
        return [
            cell.flag for cell, (was, by) in self.flags.items()
            if cell.flag is not None and by <= level and cell.closed(was, thread)
        ]  # fmt: skip

    def followed(self, thread: Thread, clock: int) -> bool:
        """Whether it was ordered after what `thread`, of a higher level, had done at its `clock`."""
        index = thread.index
        return thread.level > self.thread.level and index < len(self.vector) and self.vector[index] >= clock


NONE: Final[tuple[LatestAccess, ...]] = ()


class SharedCell:
    """A scalar, or another part that only one thread may use at a time."""

    __slots__ = (
        "accesses", "calm", "changed", "flag", "handed", "handed_at", "hands_over", "last", "owner", "reader",
        "reader_statement", "writers", "writes",
    )  # fmt: skip

    def __init__(self, owner: Thread, flag: ReadyFlag | None = None) -> None:
        #: The only thread that has used it so far; None once there are two.
        self.owner: Thread | None = owner
        #: Whether its value may tell a reader that other data is ready; if so, what it is.
        self.hands_over = flag is not None
        self.flag = flag
        self.accesses: dict[tuple[Thread, bool, Protection], LatestAccess] = {}
        #: The latest of `accesses`, and the writes among them.
        self.last: LatestAccess | None = None
        self.writes: list[LatestAccess] = []
        #: Whether `last` is a read that conflicts with no write, and would not if it came again.
        self.calm = False
        self.writers: set[Thread] = set()
        #: Thread -> the statement by which it last read and wrote the cell in one step, per protection.
        self.changed: dict[Thread, dict[Protection, StatementNumber]] = {}
        #: The last reader and its statement.  The last writer, its clock and vector clock at the write, and its run.
        self.reader: Thread | None = None
        self.reader_statement: StatementNumber = 0
        self.handed: tuple[Thread, int, VectorClock, list[int]] | None = None
        #: When that write was, in cycles.
        self.handed_at = -1

    def conflicts(self, thread: Thread, protection: Protection) -> tuple[LatestAccess, ...]:
        """Writes of other threads that conflict with an access of `thread` under `protection`."""
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
        """Reads of other threads that may not be over when `thread` writes: nothing orders or excludes them."""
        return tuple(
            other for other in self.accesses.values()
            if not other.write
            and other.thread is not thread
            and not thread.knows(other.thread, other.clock)
            and not excluded(other.thread, other.protection, thread, protection)
        )  # fmt: skip

    def apart_by_time(self, reader: LatestAccess, thread: Thread) -> bool:
        """Whether only time keeps a read and a write of `thread`, of a higher level, apart.

        `thread` had told the reader before that it was done, and does not wait until the reader is.  If the time is too
        short, `conflicts` shows it.
        """
        last = max((each.clock for each in self.writes if each.thread is thread), default=1)
        return reader.followed(thread, last) and not any(
            reader.thread in flag.writers and len(flag.writers) > 1
            for each in self.writes if each.thread is thread for flag in each.flags
        )  # fmt: skip

    def hand_over(self, thread: Thread, statement: StatementNumber, time: int) -> None:
        """A write of `thread` tells the readers of this word what it has done so far."""
        self.handed, self.handed_at = (thread, thread.clock, thread.vector, thread.run), time
        thread.step()
        thread.stepped = (statement, time)

    def take_over(self, thread: Thread) -> None:
        """A read of `thread` learns what the last writer had done.

        A Swi or handler has always ended its run when a thread of a lower level reads.  So its whole run is known.
        """
        if self.handed is None:
            return
        writer, clock, vector, run = self.handed
        if writer.level > thread.level and not writer.is_task:
            clock = run[0]
        if not thread.knows(writer, clock):
            thread.vector = joined(thread.vector, at_clock(vector, writer.index, clock))

    @property
    def value(self) -> Any:
        """The value of a scalar that hands over; None if it was never written."""
        assert self.flag is not None
        return self.flag.data[self.flag.number]

    def closed(self, open_at: Any, thread: Thread) -> bool:
        """Whether it has another value than `open_at`, and `thread` knows who has written it."""
        if self.value == open_at or self.handed is None:
            return False
        writer, clock, _, _ = self.handed
        return thread.knows(writer, clock)

    def cut(self, low: Thread, high: LatestAccess) -> StatementNumber | None:
        """The statement by which `low` read and wrote the cell, if `high` can interrupt it and write too; else None."""
        for protection, statement in self.changed.get(low, {}).items():
            if high.thread in self.writers and not excluded(low, protection, high.thread, high.protection):
                return statement
        return None

    def keep(self, thread: Thread, write: bool, protection: Protection, statement: StatementNumber, time: int) -> None:
        """Remember an access to a cell that several threads use."""
        known = self.last
        if known is None or known.thread is not thread or known.write != write or known.protection is not protection:
            key = (thread, write, protection)
            known = self.accesses.get(key)
            if known is None:
                known = self.accesses[key] = LatestAccess(thread, write, protection, thread.clock, statement, time)
                if write:
                    self.writes.append(known)
            self.last = known
        if known.flags:
            for cell, (was, by) in list(known.flags.items()):
                value, last = thread.seen.get(cell, (None, by))
                if value != was:
                    del known.flags[cell]
                elif last > by:
                    known.flags[cell] = was, last
        # In `v[n++] = x` the step of the index and the access are one statement: their order is the compiler's.
        known.clock = thread.clock - (thread.stepped == (statement, time) and not self.hands_over)
        known.statement, known.time, known.vector = statement, time, thread.vector
