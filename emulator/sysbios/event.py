"""Events: `ti.sysbios.knl.Event`.

Modelled
    An event has sixteen bits.  A pend waits for all bits of one mask or any bit of another, and consumes the bits that
    it matched.  Only one task can wait at a time.  Timeouts are like those of semaphores.  Semaphores and mailboxes can
    keep a bit of an event up to date.
Time
    `event_pend` and `event_post` for each call, `event_block` when the caller blocks.
Sources
    BIOS; `knl/Event.c` 6.83 (Event_pend, Event_post, Event_checkEvents, Event_pendTimeout, Event_sync).
"""

from __future__ import annotations

from typing import Any

from emulator.c28x.memory import NULL
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import KernelCore, KernelObject, UniqueNames
from emulator.sysbios.handles import Handles
from emulator.sysbios.scheduler import TIMEOUT, Task, Waiter
from emulator.sysbios.task import TaskModule


class Event(KernelObject):
    """The object of an `Event_Handle`; `posted` are the bits that no pend has consumed."""

    __slots__ = ("posted", "waiters")

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.posted = 0
        self.waiters: list[Waiter] = []

    def __repr__(self) -> str:
        return f"<Event {self.name} posted {self.posted:#x}>"

    def take(self, and_mask: int, or_mask: int) -> int:
        """Consume the bits that match, and return them; 0 if the wait is not over (`Event_checkEvents`)."""
        matching = or_mask & self.posted
        if and_mask & self.posted == and_mask:
            matching |= and_mask
        self.posted &= ~matching
        return matching

    def sync(self, event_id: int, count: int) -> None:
        """Set the bits if `count` is not 0, else clear them.  No task is woken (`Event_sync`)."""
        self.posted = self.posted | event_id if count else self.posted & ~event_id


class EventWaiter(Waiter):
    """A task that waits for bits, and the bits that it got (`Event_PendElem`)."""

    __slots__ = ("and_mask", "matching", "or_mask")

    def __init__(self, task: Task, queue: list[Waiter], and_mask: int, or_mask: int) -> None:
        super().__init__(task, queue)
        self.and_mask = and_mask
        self.or_mask = or_mask
        self.matching = 0


class EventModule:
    """`Event_*`."""

    def __init__(self, core: KernelCore, tasks: TaskModule, handles: Handles) -> None:
        self.core = core
        self.tasks = tasks
        self._handles = handles
        self._names = UniqueNames()

    def given(self, value: Any, function: str) -> Event | None:
        """The event in a member of a `*_Params` structure; None for NULL."""
        if value is None or value is NULL:
            return None
        event = self._handles.living("Event_Handle", value, function)
        assert isinstance(event, Event)
        return event

    def post(self, event: Event, event_id: int) -> None:
        """Do what `Event_post` does, but charge no cycles."""
        event.posted |= event_id
        if not event.waiters:
            return
        tasks = self.tasks
        key = tasks.lock()
        waiter = event.waiters[0]
        assert isinstance(waiter, EventWaiter)
        waiter.matching = event.take(waiter.and_mask, waiter.or_mask)
        if waiter.matching:
            tasks.wake(event.waiters.pop(0))
        tasks.restore(key)

    # C functions

    def Event_Params_init(self, params: Any) -> None:
        """Set the defaults.  There is nothing to choose."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("Event_Params", params)

    def Event_create(self, params: Any = None, error_block: Any = None) -> Event:
        """Create an event with no bit posted."""
        self.core.clock.charge(self.core.costs["event_create"])
        struct_params.read(self.core, "Event_Params", params)
        return Event(self._names.unique("Event"))

    def Event_delete(self, pointer: Any) -> None:
        """Delete the event.  A task that waits for it without a timeout waits for ever."""
        self.core.clock.charge(self.core.costs["delete"])
        pointer.load().deleted = True
        pointer.store(NULL)

    def Event_pend(self, event: Event, and_mask: int, or_mask: int, timeout: int) -> int:
        """Wait up to `timeout` ticks for all bits of `and_mask` or any of `or_mask`.

        Returns the bits consumed, 0 on timeout.
        """
        core, tasks = self.core, self.tasks
        core.clock.charge(core.costs["event_pend"])
        timeout &= tasks.timeout_mask
        core.check((and_mask | or_mask) != 0, "Event_A_nullEventMasks", "both masks of Event_pend are 0")
        matching = event.take(and_mask, or_mask)
        if matching or timeout == 0:
            return matching
        tasks.check_blocking("Event_pend")
        task = tasks.current
        if task is None:  # Only with asserts off and before tasks exist: no task could block.
            return 0
        core.check(
            not event.waiters, "Event_A_eventInUse", f"{event.name} has a task that waits already: only one can"
        )
        core.clock.now += core.costs["event_block"]
        if core.trace.active:
            core.trace.emit("event pend", event.name)
        waiter = EventWaiter(task, event.waiters, and_mask, or_mask)
        tasks.block(task)
        event.waiters.append(waiter)
        return 0 if tasks.wait(waiter, timeout) == TIMEOUT else waiter.matching

    def Event_post(self, event: Event, event_id: int) -> None:
        """Set bits.  If the posted bits match what the waiting task wants, wake it."""
        core = self.core
        core.clock.charge(core.costs["event_post"])
        core.check(event_id != 0, "Event_A_nullEventId", "Event_post was given no bit")
        if core.trace.active:
            core.trace.emit("event post", event.name)
        self.post(event, event_id)

    def Event_sync(self, event: Event, event_id: int, count: int) -> None:
        """Set bits if `count` is not 0, else clear them."""
        self.core.clock.charge(self.core.costs["event_service"])
        event.sync(event_id, count)

    def Event_getPostedEvents(self, event: Event) -> int:
        """The bits that no pend has consumed."""
        self.core.clock.charge(self.core.costs["event_service"])
        return event.posted
