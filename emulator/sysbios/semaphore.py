"""Semaphores: `ti.sysbios.knl.Semaphore`.

Modelled
    A semaphore is counting or binary.  Its waiters are in FIFO order, or in the order of their priorities at the time
    of the pend.  A post wakes the first waiter and then does not count.  Timeouts use Clock; of a timeout and a post,
    exactly one takes effect.  The count has 16 bits and its assertion.  An event can follow the count.  CHOICE:
    `Semaphore.supportsEvents` is on for a semaphore with an event.
Time
    `semaphore_pend` and `semaphore_post` for each call, `semaphore_block` when the caller blocks.
Sources
    BIOS; `knl/Semaphore.c` 6.83.
"""

from __future__ import annotations

from typing import Any, Final

from emulator.c28x.memory import NULL
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import MAIN, TASK, KernelCore, KernelObject, UniqueNames
from emulator.sysbios.event import Event, EventModule
from emulator.sysbios.scheduler import Waiter
from emulator.sysbios.task import TaskModule

# Semaphore_Mode
COUNTING: Final = 0
BINARY: Final = 1
COUNTING_PRIORITY: Final = 2
BINARY_PRIORITY: Final = 3


class Semaphore(KernelObject):
    """The object of a `Semaphore_Handle`.  The bits `event_id` of `event` are set while the semaphore can be taken."""

    __slots__ = ("count", "event", "event_id", "mode", "waiters")

    def __init__(self, name: str, count: int, mode: int) -> None:
        super().__init__(name)
        self.count = count
        self.mode = mode
        self.event: Event | None = None
        self.event_id = 1
        self.waiters: list[Waiter] = []

    def __repr__(self) -> str:
        return f"<Semaphore {self.name} count {self.count}>"


class SemaphoreModule:
    """`Semaphore_*`."""

    def __init__(self, core: KernelCore, tasks: TaskModule, events: EventModule) -> None:
        self.core = core
        self.tasks = tasks
        self.events = events
        self._names = UniqueNames()
        self._cost_pend = core.costs["semaphore_pend"]
        self._cost_post = core.costs["semaphore_post"]
        self._cost_block = core.costs["semaphore_block"]

    def Semaphore_Params_init(self, params: Any) -> None:
        """Set the defaults: counting, FIFO."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("Semaphore_Params", params)

    def Semaphore_create(self, count: int, params: Any = None, error_block: Any = None) -> Semaphore:
        """Create a semaphore with an initial count of 0 to 65535.  As a 16-bit Int, a count above 32767 is negative."""
        core = self.core
        core.clock.charge(core.costs["semaphore_create"])
        given = struct_params.read(core, "Semaphore_Params", params)
        core.check(0 <= count <= 0xFFFF, "Semaphore_A_overflow", f"initial count {count} is not 0..65535")
        semaphore = Semaphore(self._names.unique("Semaphore"), count & 0xFFFF, given["mode"])
        self.register(semaphore, self.events.given(given["event"], "Semaphore_create"), given["eventId"])
        return semaphore

    def register(self, semaphore: Semaphore, event: Event | None, event_id: int) -> None:
        """Tie a new semaphore to an event.  From now on the event's bits show whether the semaphore can be taken."""
        semaphore.event, semaphore.event_id = event, event_id & 0xFFFF
        if event is not None:
            if semaphore.count:
                self.events.post(event, semaphore.event_id)
            else:
                event.sync(semaphore.event_id, 0)

    def Semaphore_delete(self, pointer: Any) -> None:
        """Delete the semaphore; a task that waits for it waits for ever."""
        self.core.clock.charge(self.core.costs["delete"])
        semaphore = pointer.load()
        if semaphore.event is not None:
            semaphore.event.sync(semaphore.event_id, 0)
        semaphore.deleted = True
        pointer.store(NULL)

    def Semaphore_pend(self, semaphore: Semaphore, timeout: int) -> int:
        """Take the semaphore, and wait up to `timeout` ticks for it; 0xFFFF waits for ever.

        The wait lasts between `timeout - 1` and `timeout` tick periods.  Returns FALSE on timeout.
        """
        core = self.core
        clock = core.clock
        clock.now += self._cost_pend
        if clock.now >= clock.next:
            clock.run_due()
        timeout &= self.tasks.timeout_mask
        if semaphore.count:
            core.check(
                timeout == 0 or core.thread_type in (TASK, MAIN), "Semaphore_A_badContext",
                "Semaphore_pend with a timeout is for tasks, not for a Hwi or Swi",
            )  # fmt: skip
            semaphore.count -= 1
            if semaphore.event is not None:
                semaphore.event.sync(semaphore.event_id, semaphore.count)
            return 1
        if timeout == 0:
            return 0
        tasks = self.tasks
        tasks.check_blocking("Semaphore_pend")
        task = tasks.current
        if task is None:  # Only with asserts off and before tasks exist: no task could block.
            return 0
        waiter = Waiter(task, semaphore.waiters)
        clock.now += self._cost_block
        if core.trace.active:
            core.trace.emit("pend", semaphore.name)
        tasks.block(task)
        self._enqueue(semaphore, waiter)
        state = tasks.wait(waiter, timeout)
        if semaphore.event is not None:
            semaphore.event.sync(semaphore.event_id, semaphore.count)
        return state

    @staticmethod
    def _enqueue(semaphore: Semaphore, waiter: Waiter) -> None:
        """Queue a waiter: at the end (FIFO), or before the first waiter that has a lower priority now."""
        if semaphore.mode & 2:
            for place, other in enumerate(semaphore.waiters):
                if waiter.task.priority > other.task.priority:
                    semaphore.waiters.insert(place, waiter)
                    return
        semaphore.waiters.append(waiter)

    def Semaphore_post(self, semaphore: Semaphore) -> None:
        """Wake the first waiter, or add 1 to the count if there is none."""
        core = self.core
        clock = core.clock
        clock.now += self._cost_post
        if clock.now >= clock.next:
            clock.run_due()
        if core.trace.active:
            core.trace.emit("post", semaphore.name)
        if not semaphore.waiters:
            if semaphore.mode & 1:
                semaphore.count = 1
            else:
                semaphore.count = semaphore.count + 1 & 0xFFFF
                core.check(semaphore.count != 0, "Semaphore_A_overflow", "the count has passed 65535 and rolled over")
            if semaphore.event is not None:
                self.events.post(semaphore.event, semaphore.event_id)
            return
        tasks = self.tasks
        tasks.wake(semaphore.waiters.pop(0))
        if not tasks.locked and not tasks.swis.locked:
            tasks.schedule()

    def Semaphore_getCount(self, semaphore: Semaphore) -> int:
        """The count as an Int of C: a count above 32767 is negative."""
        self.core.clock.charge(self.core.costs["semaphore_service"])
        return (semaphore.count + 0x8000 & 0xFFFF) - 0x8000

    def Semaphore_reset(self, semaphore: Semaphore, count: int) -> None:
        """Store the count.  Tasks that wait go on waiting."""
        self.core.clock.charge(self.core.costs["semaphore_service"])
        semaphore.count = count & 0xFFFF
        if semaphore.event is not None:
            semaphore.event.sync(semaphore.event_id, semaphore.count)

    def Semaphore_registerEvent(self, semaphore: Semaphore, event: Event | None, event_id: int) -> None:
        """Tie the semaphore to an event; NULL removes the tie.  The event's bits stay as they are."""
        self.core.clock.charge(self.core.costs["semaphore_service"])
        semaphore.event, semaphore.event_id = event, event_id
