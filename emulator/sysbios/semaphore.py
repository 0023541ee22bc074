"""Semaphores: `ti.sysbios.knl.Semaphore`.

Modelled
    Counting and binary, FIFO or by priority at the time of the pend; a post gives itself to the first waiter without
    counting; timeouts through Clock, resolved against a post so that exactly one wins; the count's 16 bits and their
    assertion.
Not modelled
    Event objects, `Semaphore_delete`.
Time
    `semaphore_pend` and `semaphore_post` per call, `semaphore_block` when the caller blocks.
Sources
    BIOS; `knl/Semaphore.c` 6.83 (Semaphore_pend, Semaphore_post, Semaphore_pendTimeout, Semaphore_reset).
"""

from __future__ import annotations

from collections import deque
from typing import Any, Final

from emulator.sysbios import params as struct_params
from emulator.sysbios.clock import ClockModule
from emulator.sysbios.core import MAIN, TASK, WAIT_FOREVER, Core, Names
from emulator.sysbios.scheduler import Task
from emulator.sysbios.task import TaskModule

# Semaphore_Mode
COUNTING: Final = 0
BINARY: Final = 1
COUNTING_PRIORITY: Final = 2
BINARY_PRIORITY: Final = 3
# Semaphore_PendState
TIMEOUT: Final = 0
POSTED: Final = 1
CLOCK_WAIT: Final = 2
WAITING: Final = 3


class Semaphore:
    """A semaphore: what a `Semaphore_Handle` points to.  `name` may be set to the firmware's own."""

    __slots__ = ("count", "mode", "name", "waiters")

    def __init__(self, name: str, count: int, mode: int) -> None:
        self.name = name
        self.count = count
        self.mode = mode
        self.waiters: deque[Waiter] = deque()

    def __repr__(self) -> str:
        return f"<Semaphore {self.name} count {self.count}>"


class Waiter:
    """A task that waits in a pend (`Semaphore_PendElem`)."""

    __slots__ = ("semaphore", "state", "task", "timer")

    def __init__(self, semaphore: Semaphore, task: Task, state: int) -> None:
        self.semaphore = semaphore
        self.task = task
        self.state = state
        self.timer: Any = None


class SemaphoreModule:
    """`Semaphore_*`."""

    def __init__(self, core: Core, tasks: TaskModule, clocks: ClockModule, *, narrow_timeouts: bool) -> None:
        self.core = core
        self.tasks = tasks
        self.clocks = clocks
        self._timeout_mask = 0xFFFF if narrow_timeouts else 0xFFFFFFFF
        self._names = Names()
        self._cost_pend = core.costs["semaphore_pend"]
        self._cost_post = core.costs["semaphore_post"]
        self._cost_block = core.costs["semaphore_block"]

    def Semaphore_Params_init(self, params: Any) -> None:
        """Defaults: counting, FIFO."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("Semaphore_Params", params)

    def Semaphore_create(self, count: int, params: Any = None, error_block: Any = None) -> Semaphore:
        """A semaphore with an initial count of 0..65535 (a 16-bit Int: above 32767 it arrives negative)."""
        core = self.core
        core.clock.charge(core.costs["semaphore_create"])
        p = struct_params.read(core, "Semaphore_Params", params)
        core.check(0 <= count <= 0xFFFF, "Semaphore_A_overflow", f"initial count {count} is not 0..65535")
        return Semaphore(self._names.unique("Semaphore"), count & 0xFFFF, p["mode"])

    def Semaphore_pend(self, semaphore: Semaphore, timeout: int) -> int:
        """Take one, waiting up to `timeout` ticks: (timeout-1, timeout] periods, 0xFFFF for ever.  FALSE on timeout."""
        core = self.core
        clock = core.clock
        clock.now += self._cost_pend
        if clock.now >= clock.next:
            clock.run_due()
        timeout &= self._timeout_mask
        if semaphore.count:
            core.check(
                timeout == 0 or core.thread_type in (TASK, MAIN), "Semaphore_A_badContext",
                "Semaphore_pend with a timeout is for tasks, not for a Hwi or Swi",
            )  # fmt: skip
            semaphore.count -= 1
            return 1
        if timeout == 0:
            return 0
        tasks = self.tasks
        if core.thread_type != TASK:
            core.check(False, "Semaphore_A_badContext", "Semaphore_pend can only block a task")
        if tasks.locked or tasks.swis.locked:
            core.check(
                False, "Semaphore_A_pendTaskDisabled",
                "Semaphore_pend cannot block while the Task or Swi scheduler is disabled",
            )  # fmt: skip
        task = tasks.current
        if task is None:  # Only with asserts off, before tasks exist: there is nothing that could block.
            return 0
        forever = timeout == WAIT_FOREVER
        waiter = Waiter(semaphore, task, WAITING if forever else CLOCK_WAIT)
        clock.now += self._cost_block
        if core.trace.active:
            core.trace.emit("pend", semaphore.name)
        tasks.block(task)
        self._enqueue(semaphore, waiter)
        if not forever:
            waiter.timer = self.clocks.add_temporary(timeout, self._expired, waiter)
        tasks.restore(tasks.lock())
        if waiter.timer is not None:
            self.clocks.remove(waiter.timer)
        return waiter.state

    @staticmethod
    def _enqueue(semaphore: Semaphore, waiter: Waiter) -> None:
        """FIFO, or before the first waiter that has a lower priority now."""
        if semaphore.mode & 2:
            for i, other in enumerate(semaphore.waiters):
                if waiter.task.priority > other.task.priority:
                    semaphore.waiters.insert(i, waiter)
                    return
        semaphore.waiters.append(waiter)

    def _expired(self, waiter: Waiter) -> None:
        """A pend's Clock function: too late if a post came first."""
        if waiter.state == CLOCK_WAIT:
            waiter.semaphore.waiters.remove(waiter)
            waiter.state = TIMEOUT
            self.core.clock.charge(self.core.costs["semaphore_timeout"])
            self.tasks.unblock(waiter.task)

    def Semaphore_post(self, semaphore: Semaphore) -> None:
        """Give one: to the first waiter, or to the count."""
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
            return
        waiter = semaphore.waiters.popleft()
        waiter.state = POSTED
        if waiter.timer is not None:
            waiter.timer.active = False
        tasks = self.tasks
        tasks.unblock(waiter.task)
        if not tasks.locked and not tasks.swis.locked:
            tasks.schedule()

    def Semaphore_getCount(self, semaphore: Semaphore) -> int:
        """The count as the C's Int: negative above 32767."""
        self.core.clock.charge(self.core.costs["semaphore_service"])
        return (semaphore.count + 0x8000 & 0xFFFF) - 0x8000

    def Semaphore_reset(self, semaphore: Semaphore, count: int) -> None:
        """Store the count; waiters stay."""
        self.core.clock.charge(self.core.costs["semaphore_service"])
        semaphore.count = count & 0xFFFF
