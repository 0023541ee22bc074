"""Releases of periodic tasks: `semaphore-pile-up`, `deadline`.

A release is a post from a Clock function.  It releases the task that pends on the semaphore.  A job lasts from the pend
that takes the release to the next pend on the same semaphore.  The deadline is the period.  A task that waits without a
timeout for a message, an event or another semaphore that nobody had filled has no job: it waits for its next order,
while the Clock function goes on posting.  Posts of one call of a Clock function are one release: if it puts four items
into a queue, it posts four times.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from inspect import unwrap
from typing import Any, Final

from emulator.c28x.findings import Finding, Findings
from emulator.clock import CYCLES_PER_US, SYSCLK_HZ, ms, us
from emulator.sysbios.clock import ClockObject
from emulator.sysbios.core import WAIT_FOREVER
from emulator.sysbios.event import Event
from emulator.sysbios.mailbox import Mailbox
from emulator.sysbios.scheduler import BLOCKED, TERMINATED, Task
from emulator.sysbios.semaphore import Semaphore
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.names import HandleNames
from emulator.sysbios.watch.statements import StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Thread, ThreadWatch

#: A burst of posts that is still not worked off after this time is a backlog.
BACKLOG_CYCLES: Final = SYSCLK_HZ
#: If no task has ever pended on a semaphore after this many posts by tasks, and this time, it counts as forgotten
#: (CHOICE: a pool that a task fills at its start is smaller, or faster).
_FORGOTTEN: Final = 32
_FORGOTTEN_CYCLES: Final = SYSCLK_HZ // 100
#: At most this many releases are kept for one semaphore.
_KEPT: Final = 10_000
#: What a task can wait for as its next order.
Order = Semaphore | Mailbox | Event


class Release:
    """One post by a Clock function, with the CPU time (cycles) that each thread had used by then."""

    __slots__ = ("statement", "time", "usage")

    def __init__(self, time: int, statement: StatementNumber, usage: list[int]) -> None:
        self.time = time
        self.statement = statement
        self.usage = usage


@dataclass(slots=True)
class SemaphoreState:
    """What is known of one semaphore."""

    initial: int = 0
    period: int = 0
    consumer: Thread | None = None
    releases: deque[Release] = field(default_factory=deque)
    #: The release whose job runs; whether a later release has come before this job was done.
    job: Release | None = None
    late: bool = False
    #: The Clock whose function posted last and when it is due next, and the number of its posts in that call.
    posted_in: tuple[ClockObject, int] | None = None
    burst: int = 1
    #: The cycle since when the count has not been 0.
    since: int | None = None
    piled: Finding | None = None
    most: int = 0
    missed: Finding | None = None


class Releases:
    """Listens to posts and pends."""

    def __init__(
        self, threads: ThreadWatch, locator: StatementLocator, names: HandleNames, findings: Findings, calls: Calls
    ) -> None:
        self._threads = threads
        self._locator = locator
        self._names = names
        self._findings = findings
        self._clock = findings.clock
        self._sources: dict[Semaphore, SemaphoreState] = {}
        #: What each task waits for without end, in a pend that has not returned.
        self._orders: dict[Thread, Order] = {}
        calls.after("Semaphore_create", callback=self._create)
        calls.before("Semaphore_post", callback=self._posting)
        calls.after("Semaphore_post", callback=self._posted)
        calls.before("Semaphore_pend", callback=self._pending)
        calls.after("Semaphore_pend", callback=self._pended)
        calls.before("Semaphore_pend", "Mailbox_pend", "Event_pend", callback=self._orders_pending)
        calls.after("Semaphore_pend", "Mailbox_pend", "Event_pend", callback=self._orders_pended)

    def period(self, thread: Thread) -> int:
        """Cycles between the releases of a task; 0 if it has none."""
        return max((source.period for source in self._sources.values() if source.consumer is thread), default=0)

    # Listeners

    def _source(self, semaphore: Semaphore) -> SemaphoreState:
        source = self._sources.get(semaphore)
        if source is None:
            source = self._sources[semaphore] = SemaphoreState()
        return source

    def _create(self, semaphore: Semaphore, *_arguments: Any) -> None:
        self._sources[semaphore] = SemaphoreState(semaphore.count)

    def _posting(self, semaphore: Semaphore) -> None:
        """Before the post: report a miss if the job of the last release has not ended."""
        source = self._source(semaphore)
        timer = self._threads.current.what
        if not isinstance(timer, ClockObject) or not timer.period:
            return
        source.period = timer.period * self._threads.kernel.clocks.tick_period_us * CYCLES_PER_US
        if source.posted_in == (timer, timer.due):
            source.burst += 1
            return
        source.posted_in, source.burst = (timer, timer.due), 1
        if source.consumer is not None and self._waits_for_order(source.consumer, semaphore):
            # The job of the last release ended before this wait, and this post begins none.
            source.job, source.late = None, False
            source.releases.clear()
            return
        if source.consumer is not None and not semaphore.waiters and (source.job is not None or source.releases):
            self._report_miss(semaphore, source, source.consumer)
        if len(source.releases) < _KEPT:
            source.releases.append(Release(self._clock.now, self._locator.here(), self._threads.usage()))

    def _posted(self, _result: None, semaphore: Semaphore) -> None:
        """After the post: report a semaphore whose count keeps growing."""
        source = self._source(semaphore)
        count, now = semaphore.count, self._clock.now
        if count == 0 or semaphore.mode & 1:
            return
        if source.since is None:
            source.since = now
        if count <= max(source.burst, source.initial) or count <= source.most:
            return
        grows = now - source.since
        forgotten = (
            source.consumer is None and self._threads.current.is_task
            and count >= source.initial + _FORGOTTEN and grows >= _FORGOTTEN_CYCLES
        )  # fmt: skip
        if not source.period and grows < BACKLOG_CYCLES and not forgotten:
            return
        source.most = count
        self._report_pile_up(semaphore, source, source.since)

    def _pending(self, semaphore: Semaphore, timeout: int) -> None:
        """A task pends on the semaphore again: its job is done."""
        source = self._source(semaphore)
        thread = self._threads.current
        if not thread.is_task:
            return
        if source.consumer is None:
            source.consumer = thread
            if semaphore.count > source.burst and source.period:
                self._report_miss(semaphore, source, thread)
                if source.missed is not None:
                    source.missed.count = semaphore.count - 1
        self._job_done(source)

    def _waits_for_order(self, thread: Thread, semaphore: Semaphore) -> bool:
        """Whether the task waits without end for another object than `semaphore`, and not for what it shares."""
        task, order = thread.what, self._orders.get(thread)
        if not isinstance(task, Task) or task.mode != BLOCKED or order is None or order is semaphore.event:
            return False
        # The count of a mutex or of a pool begins above 0: it comes back, and the job goes on.
        return order is not semaphore and not (isinstance(order, Semaphore) and self._source(order).initial)

    def _orders_pending(self, order: Order, *arguments: int) -> None:
        """A task begins to wait: keep for what, if it waits without end."""
        thread = self._threads.current
        if thread.is_task and arguments[-1] & WAIT_FOREVER == WAIT_FOREVER:
            self._orders[thread] = order

    def _orders_pended(self, *_arguments: Any) -> None:
        self._orders.pop(self._threads.current, None)

    def _pended(self, taken: int, semaphore: Semaphore, timeout: int) -> None:
        source = self._source(semaphore)
        if not semaphore.count:
            source.since = None
        if taken and source.releases:
            source.job = source.releases.popleft()

    # Findings

    def _ended(self, semaphore: Semaphore, thread: Thread | None) -> bool:
        """Whether the task that takes a semaphore has ended.  Then report it where the task's function begins."""
        task = thread.what if thread is not None else None
        if not isinstance(task, Task) or task.mode != TERMINATED or task.deleted:
            return False
        begins = self._findings.beginnings
        place = begins.get(task.function) or begins.get(unwrap(task.function))
        if place is None:
            return False
        name = self._names.of(semaphore)
        self._findings.report_at(
            place, "task-ended", f"{thread} has returned from its function, and {name} is still posted for it",
            object=task.name, how="dynamic", task=task.name,
        )  # fmt: skip
        return True

    def _report_pile_up(self, semaphore: Semaphore, source: SemaphoreState, since: int) -> None:
        name, consumer = self._names.of(semaphore), source.consumer
        if self._ended(semaphore, consumer):
            return
        where = "no task has pended on it yet"
        if consumer is not None and isinstance(consumer.what, Task):
            statement = self._locator.of(consumer.what, self._threads.kernel.tasks.current)
            where = f"{consumer} does not take them: it is in {self._locator.text(statement)}"
        message = f"{name} holds {semaphore.count} releases, growing since {ms(since):.3f} ms: {where}"
        if source.piled is None:
            source.piled = self._findings.report("semaphore-pile-up", message, object=name, value=semaphore.count)
        else:
            source.piled.message, source.piled.value = message, semaphore.count
            source.piled.count += 1
        if source.piled is not None:
            running = self._threads.kernel.tasks.current
            if running is not None:
                statement = self._locator.of(running, running)
                source.piled.details = (f"{running.name} has the CPU, in {self._locator.text(statement)}",)

    def _report_miss(self, semaphore: Semaphore, source: SemaphoreState, thread: Thread) -> None:
        """Report that the next release has come before the job of the last one was done."""
        if self._ended(semaphore, thread):
            return
        release = source.job or source.releases[0]
        source.late = True
        if source.missed is not None:
            source.missed.count += 1
            return
        task = thread.what
        assert isinstance(task, Task)
        statement = self._locator.of(task, self._threads.kernel.tasks.current)
        place = self._locator.place(statement) or self._locator.place(release.statement)
        if place is None:
            return
        message = (
            f"{thread} was released at {ms(release.time):.3f} ms through {self._names.of(semaphore)} and has not "
            f"finished when the next release comes, {ms(source.period):g} ms later"
        )
        source.missed = self._findings.report_at(
            place, "deadline", message, object=thread.name, value=us(self._clock.now - release.time),
            details=self._ran_since(thread, release), how="dynamic", task=thread.name,
        )  # fmt: skip

    def _job_done(self, source: SemaphoreState) -> None:
        """The job has ended.  If it was late, put its response time into the finding."""
        job, source.job = source.job, None
        if job is None or not source.late or source.missed is None or source.consumer is None:
            return
        response = us(self._clock.now - job.time)
        if response > source.missed.value:
            source.missed.value = response
            source.missed.details = (
                f"longest response {response:.1f} us", *self._ran_since(source.consumer, job)
            )  # fmt: skip
        source.late = bool(source.releases)

    def _ran_since(self, thread: Thread, release: Release) -> tuple[str, ...]:
        """The threads that had the CPU since a release, as sentences."""
        used = [(other, cycles) for other, cycles in self._threads.used_since(release.usage) if cycles > CYCLES_PER_US]
        return tuple(f"{other} ran for {us(cycles):.1f} us of it" for other, cycles in used[:4])
