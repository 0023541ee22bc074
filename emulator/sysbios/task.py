"""Tasks: `ti.sysbios.knl.Task`.

Modelled
    There are sixteen priorities (0 is the idle task's), each with a FIFO ready queue.  The kernel switches only to a
    task of a higher priority.  A pre-empted task stays at the head of its queue; a task that becomes ready goes to the
    tail.  `Task_yield`, `Task_sleep`, `Task_setPri` with its three cases, and `Task_disable` with nested keys are
    there.  The return from the task function is `Task_exit`.  A task is a greenlet, so it can be pre-empted at any
    charge of CPU time.
Not modelled
    Hooks, `Task_setEnv`, `Task.deleteTerminatedTasks`, the memory protection of later versions.
Time
    `task_switch` for each switch, with interrupts disabled.  An interrupt that becomes due during a switch runs when
    the switch is complete.
Sources
    BIOS; `knl/Task.c` 6.83 (Task_schedule, Task_setPri, Task_yield, Task_sleep, Task_blockI, Task_unblockI).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from greenlet import greenlet

from emulator.c28x.memory import NULL
from emulator.sysbios import params as struct_params
from emulator.sysbios.clock import ClockModule
from emulator.sysbios.core import HWI, MAIN, SWI, TASK, WAIT_FOREVER, Function, KernelCore
from emulator.sysbios.scheduler import (
    CLOCK_WAIT,
    POSTED,
    PRIORITIES,
    READY,
    RUNNING,
    TIMEOUT,
    WAITING,
    Scheduler,
    Task,
    Waiter,
)
from emulator.sysbios.stack import StackSpace


class TaskModule(Scheduler):
    """`Task_*`.  The `clocks` end a wait when its timeout has passed.  `timeout_mask` is the width of a timeout."""

    def __init__(
        self, core: KernelCore, stacks: StackSpace, *, system_stack: tuple[int, int], object_base: int,
        fail: Callable[[BaseException, str], None], exit_program: Callable[[int], None],
        host: Callable[[], greenlet], vital_tasks: int, timeout_mask: int, tick_period_us: int,
    ) -> None:  # fmt: skip
        super().__init__(
            core, stacks, system_stack=system_stack, object_base=object_base, fail=fail, exit_program=exit_program,
            host=host, vital_tasks=vital_tasks,
        )  # fmt: skip
        self.timeout_mask = timeout_mask
        self.clocks = ClockModule(core, self.swis, tick_period_us=tick_period_us)

    # Waiting

    def wait(self, waiter: Waiter, timeout: int) -> int:
        """Block the running task in its queue for up to `timeout` ticks; returns how the wait ended."""
        forever = timeout == WAIT_FOREVER
        waiter.state = WAITING if forever else CLOCK_WAIT
        waiter.task.pend = waiter
        if not forever:
            waiter.timer = self.clocks.add_temporary(timeout, self._expired, waiter)
        self.restore(self.lock())
        if waiter.timer is not None:
            self.clocks.remove(waiter.timer)
        waiter.task.pend = None
        return waiter.state

    def _expired(self, waiter: Waiter) -> None:
        """The Clock function of a pend's timeout.  It does nothing if a post came first."""
        if waiter.state == CLOCK_WAIT:
            waiter.queue.remove(waiter)
            waiter.state = TIMEOUT
            self.core.clock.charge(self.core.costs["pend_timeout"])
            self.unblock(waiter.task)

    def wake(self, waiter: Waiter) -> None:
        """End a pend because of a post.  The waiter has left its queue; the caller must call `schedule`."""
        waiter.state = POSTED
        if waiter.timer is not None:
            waiter.timer.active = False
        self.unblock(waiter.task)

    def check_blocking(self, function: str) -> None:
        """Check the two assertions of a pend that has to wait."""
        if self.core.thread_type != TASK:
            module = function.partition("_")[0]
            self.core.check(False, f"{module}_A_badContext", f"{function} can only block a task")
        if self.locked or self.swis.locked:
            module = function.partition("_")[0]
            self.core.check(
                False, f"{module}_A_pendTaskDisabled",
                f"{function} cannot block while the Task or Swi scheduler is disabled",
            )  # fmt: skip

    # C functions

    def Task_Params_init(self, params: Any) -> None:
        """Set the defaults: priority 1, a stack of 256 words."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("Task_Params", params)

    def Task_create(self, function: Function, params: Any, error_block: Any = None) -> Task | None:
        """Create a task.  Main or a task calls it; a task of higher priority pre-empts its creator."""
        core = self.core
        core.clock.charge(core.costs["task_create"])
        wanted = struct_params.read(core, "Task_Params", params)
        core.check(
            core.thread_type not in (HWI, SWI), "Task_A_badThreadType", "a task cannot be created from a Hwi or Swi"
        )
        priority = wanted["priority"]
        core.check(priority == -1 or 0 < priority < PRIORITIES, "Task_A_badPriority", f"{priority} is not -1 or 1..15")
        arguments = (wanted["arg0"], wanted["arg1"])
        given = wanted["stack"]
        stack = self.stacks.allocate(wanted["stackSize"], given.addr if given else 0, error_block, arguments)
        if stack is None:
            return None
        task = self.add(function, priority, stack, arguments, bool(wanted["vitalTaskFlag"]), "")
        task.env = wanted["env"]
        self.restore(self.lock())
        return task

    def Task_delete(self, pointer: Any) -> None:
        """Delete another task, whatever it waits for or holds.  Deleting the last vital task ends the program."""
        core = self.core
        core.clock.charge(core.costs["delete"])
        task: Task = pointer.load()
        key = self.lock()
        core.check(self.Task_getMode(task) != RUNNING, "Task_A_badTaskState", "a task cannot delete itself")
        core.check(
            core.thread_type in (MAIN, TASK), "Task_A_badThreadType", "a task cannot be deleted from a Hwi or Swi"
        )
        waiter = task.pend
        if waiter is not None:
            if waiter in waiter.queue:
                waiter.queue.remove(waiter)
            if waiter.timer is not None:
                self.clocks.remove(waiter.timer)
        self.drop(task)
        pointer.store(NULL)
        self.restore(key)

    def Task_sleep(self, ticks: int) -> None:
        """Block for (ticks-1, ticks] tick periods; 0 returns at once."""
        core = self.core
        core.clock.charge(core.costs["task_sleep"])
        ticks &= self.timeout_mask
        if not ticks:
            return
        core.check(ticks != WAIT_FOREVER, "Task_A_badTimeout", "a task cannot sleep BIOS_WAIT_FOREVER")
        core.check(
            core.thread_type == TASK and not self.locked and not self.swis.locked, "Task_A_sleepTaskDisabled",
            "Task_sleep needs the running task's own context and an enabled scheduler",
        )  # fmt: skip
        task = self.current
        if task is None:
            return
        if core.trace.active:
            core.trace.emit("sleep", task.name)
        self.block(task)
        waiter = task.pend = Waiter(task, [])
        waiter.timer = self.clocks.add_temporary(ticks, self.unblock, task)
        self.restore(self.lock())
        self.clocks.remove(waiter.timer)
        task.pend = None

    def Task_yield(self) -> None:
        """Move the running task to the tail of its ready queue, also when a Swi or Hwi calls it."""
        self.core.clock.charge(self.core.costs["task_yield"])
        if self.current_queue >= 0:
            self.rotate(self.current_queue)
        self.current_queue = -1
        self.work = True
        self.restore(self.lock())

    def Task_disable(self) -> int:
        """Hold back task switches; returns the key for `Task_restore`."""
        self.core.clock.charge(self.core.costs["task_service"])
        return int(self.lock())

    def Task_restore(self, key: int) -> None:
        """Undo the `Task_disable` that returned `key`."""
        self.core.clock.charge(self.core.costs["task_service"])
        self.restore(bool(key))

    def Task_enable(self) -> None:
        """Release the scheduler, however often it was disabled."""
        self.Task_restore(0)

    def Task_setPri(self, task: Task, priority: int) -> int:
        """Change a task's priority; returns the old one.  Waiting queues are not sorted again."""
        self.core.clock.charge(self.core.costs["task_set_priority"])
        key = self.lock()
        old = self.set_priority(task, priority)
        self.restore(key)
        return old

    def Task_getPri(self, task: Task) -> int:
        """The priority of a task."""
        return task.priority

    def Task_getMode(self, task: Task) -> int:
        """The mode of a task: 0 RUNNING, 1 READY, 2 BLOCKED, 3 TERMINATED, 4 INACTIVE."""
        return RUNNING if task is self.current and task.mode == READY else task.mode

    def Task_self(self) -> Task | None:
        """The running task (also from a Swi or Hwi that interrupted it); NULL before tasks start."""
        return self.current

    def Task_getIdleTask(self) -> Task | None:
        """The idle task."""
        return self.idle

    def Task_exit(self) -> None:
        """End the running task.  If it was the last vital task, the program ends."""
        core = self.core
        core.clock.charge(core.costs["task_service"])
        core.check(core.thread_type not in (MAIN, HWI, SWI), "Task_A_badThreadType", "only a task can end itself")
        self.finish()
