"""The task scheduler: it keeps the ready queues, selects a task and switches greenlets (`ti.sysbios.knl.Task`).

task.py holds the functions that firmware calls.  Sources: BIOS; `knl/Task.c` 6.83 (Task_schedule, Task_setPri,
Task_blockI, Task_unblockI, Task_exit).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any, Final

from greenlet import GreenletExit, getcurrent, greenlet

from emulator.c28x.position import Calls
from emulator.sysbios.core import (
    TASK,
    Function,
    KernelCore,
    KernelError,
    KernelObject,
    UniqueNames,
    fitted,
    function_name,
)  # fmt: skip
from emulator.sysbios.stack import Stack, StackSpace
from emulator.sysbios.swi import SwiModule

PRIORITIES: Final = 16
# Task_Mode
RUNNING: Final = 0
READY: Final = 1
BLOCKED: Final = 2
TERMINATED: Final = 3
INACTIVE: Final = 4
# PendState of Semaphore and Event
TIMEOUT: Final = 0
POSTED: Final = 1
CLOCK_WAIT: Final = 2
WAITING: Final = 3
#: The distance of two task objects in words.  Only the ordering fault of old gates uses their addresses.
OBJECT_WORDS: Final = 40


class Task(KernelObject):
    """The object of a `Task_Handle`.  Its greenlet runs `run(task)`.  When it ends, `parent` runs."""

    __slots__ = (
        "address", "arguments", "at", "calls", "env", "function", "greenlet", "mode", "pend", "priority", "stack",
        "vital",
    )  # fmt: skip

    def __init__(
        self, name: str, function: Function, arguments: tuple[int, int], priority: int, stack: Stack, *,
        vital: bool, address: int, run: Callable[[Task], None], parent: greenlet,
    ) -> None:  # fmt: skip
        super().__init__(name)
        self.function = function
        self.arguments = arguments
        self.priority = priority
        self.stack = stack
        self.mode = READY if priority >= 0 else INACTIVE
        self.vital = vital
        self.env: Any = None
        #: Its current wait for a semaphore, event or gate; None if it does not wait for one.
        self.pend: Waiter | None = None
        self.address = address
        self.greenlet = greenlet(lambda: run(self), parent=parent)
        #: Its position in the firmware while it does not run (`Position`).
        self.at = 0
        self.calls: Calls | None = None

    def __repr__(self) -> str:
        return f"<Task {self.name} priority {self.priority}>"


class Waiter:
    """The wait of a task (`Task_PendElem`): the queue it is in, how the wait ended, the Clock object of the timeout."""

    __slots__ = ("queue", "state", "task", "timer")

    def __init__(self, task: Task, queue: list[Waiter]) -> None:
        self.task = task
        self.queue = queue
        self.state = WAITING
        self.timer: Any = None


class Scheduler:
    """Keeps the ready queues, switches tasks, and starts and ends them.

    Swis and tasks can lock each other, so the scheduler creates the Swi module.  Swis run on `system_stack`.  `host()`
    is the greenlet that runs when a task ends.  `vital_tasks` is the number of vital tasks before main begins.
    """

    def __init__(
        self,
        core: KernelCore,
        stacks: StackSpace,
        *,
        system_stack: tuple[int, int],
        object_base: int,
        fail: Callable[[BaseException, str], None],
        exit_program: Callable[[int], None],
        host: Callable[[], greenlet],
        vital_tasks: int = 0,
    ) -> None:
        self.core = core
        self.stacks = stacks
        self.locked = True
        self.work = False
        self.current: Task | None = None
        self.all: list[Task] = []
        self.vital_tasks = vital_tasks
        self._host = host
        self.idle: Task | None = None
        self._ready: tuple[deque[Task], ...] = tuple(deque() for _ in range(PRIORITIES))
        self._ready_set = 0
        self.current_queue = -1
        self._object_base = object_base
        self._created = 0
        self._fail = fail
        self.exit_program = exit_program
        self._names = UniqueNames()
        self._cost_switch = core.costs["task_switch"]
        self.swis = SwiModule(core, self, system_stack=system_stack)

    # The scheduler

    def lock(self) -> bool:
        """Do what `Task_disable` does, but charge no cycles."""
        key = self.locked
        self.locked = True
        return key

    def restore(self, key: bool) -> None:
        """Do what `Task_restore` does, but charge no cycles."""
        if not key:
            if self.work and not self.swis.locked:
                self.schedule()
            else:
                self.locked = False

    def rotate(self, priority: int) -> None:
        """Move the head of a ready queue to its tail."""
        self._ready[priority].rotate(-1)

    def block(self, task: Task) -> None:
        """Take a task from its ready queue."""
        queue = self._ready[task.priority]
        queue.remove(task)
        if not queue:
            self._ready_set &= ~(1 << task.priority)
        if task is self.current:
            self.current_queue = -1
        task.mode = BLOCKED
        self.work = True
        if self.core.trace.active:
            self.core.trace.emit("block", task.name)

    def unblock(self, task: Task) -> None:
        """Put a task at the tail of its ready queue.  The caller must call `schedule`."""
        if task.priority < 0:
            task.mode = INACTIVE
            return
        self._ready[task.priority].append(task)
        self._ready_set |= 1 << task.priority
        task.mode = READY
        self.work = True
        if self.core.trace.active:
            self.core.trace.emit("ready", task.name)

    def schedule(self) -> None:
        """Give the CPU to the ready task of the highest priority, if that is higher than the running task's."""
        clock = self.core.clock
        self.locked = True
        while self.work:
            self.work = False
            top = self._ready_set.bit_length() - 1
            if top > self.current_queue:
                self.current_queue = top
                old, new = self.current, self._ready[top][0]
                self.current = new
                self.core.cpu.position.who = new.name
                self._swap(old, new)
        self.locked = False
        if clock.now >= clock.next:
            clock.run_due()

    def _swap(self, old: Task | None, new: Task) -> None:
        core = self.core
        cpu, stacks = core.cpu, self.stacks
        if stacks.checked and old is not None:
            self._check_stacks(old, new)
        if core.trace.active:
            core.trace.emit("switch", new.name)
        core.clock.now += self._cost_switch
        if new is old:
            return
        interrupts_off = cpu.intm
        position = cpu.position
        if old is not None:
            old.stack.sp = cpu.sp
            old.at, old.calls = position.at, position.calls
        cpu.sp = new.stack.sp
        cpu.stack_limit = new.stack.usable
        new.greenlet.switch()
        if old is not None:
            position.at, position.calls = old.at, old.calls
        cpu.intm = interrupts_off

    def _check_stacks(self, old: Task, new: Task) -> None:
        stacks, sp = self.stacks, self.core.cpu.sp
        left, entered = old.stack, new.stack
        if (
            left.base <= sp <= left.limit
            and entered.base <= entered.sp <= entered.limit
            and stacks.intact(left)
            and stacks.intact(entered)
        ):
            return
        for task, top in ((old, sp), (new, entered.sp)):
            if not stacks.intact(task.stack):
                stacks.overflow(task.name, task.stack, "Task_E_stackOverflow", task.stack.overrun_sp or top)
        for task, top in ((old, sp), (new, entered.sp)):
            if not task.stack.base <= top <= task.stack.limit:
                stacks.overflow(task.name, task.stack, "Task_E_spOutOfBounds", top)

    def overrun(self, sp: int) -> None:
        """Note that the running task's stack was written above its end, up to `sp`.  The next switch reports it."""
        if self.current is not None:
            self.current.stack.overrun_sp = max(sp, self.current.stack.overrun_sp)

    def start(self) -> greenlet:
        """Give the CPU to the first task; returns the greenlet to switch to."""
        core = self.core
        self.work = False
        self.current_queue = self._ready_set.bit_length() - 1
        task = self._ready[self.current_queue][0]
        self.current = task
        core.cpu.position.who = task.name
        core.thread_type = TASK
        core.cpu.sp, core.cpu.stack_limit = task.stack.sp, task.stack.usable
        if core.trace.active:
            core.trace.emit("switch", task.name)
        return task.greenlet

    def _run(self, task: Task) -> None:
        """Run a task from begin to end, in its own greenlet."""
        clock = self.core.clock
        position = self.core.cpu.position
        position.at, position.calls = 0, None
        try:
            self.core.cpu.enable_interrupts()
            if self.work:
                self.schedule()
            self.locked = False
            if clock.now >= clock.next:
                clock.run_due()
            task.function(*task.arguments)
            self.finish()
        except GreenletExit:
            return
        except BaseException as error:
            self._fail(error, task.name)

    def finish(self) -> None:
        """End the running task.  The last vital one ends the program."""
        task = self.current
        assert task is not None
        self.lock()
        self.block(task)
        task.mode = TERMINATED
        if task.vital:
            self.vital_tasks -= 1
            if not self.vital_tasks:
                self.exit_program(0)
        self.restore(False)
        # No other task has the CPU now, because Swis are disabled.  `Task_exit` returns, to an address that nothing has
        # set.  CHOICE: the program ends here, because what follows would depend on unknown words.
        raise KernelError(
            "Task_exit", f"task {task.name} has ended and Swi_disable is in force, so no other task can run"
        )  # fmt: skip

    def drop(self, task: Task) -> None:
        """Delete a task that does not run and is in no queue of a semaphore, event or gate."""
        if task.mode == READY:
            queue = self._ready[task.priority]
            queue.remove(task)
            if not queue:
                self._ready_set &= ~(1 << task.priority)
        ended = task.mode == TERMINATED
        task.mode = TERMINATED
        task.deleted = True
        self.all.remove(task)
        if not task.greenlet.dead:
            task.greenlet.parent = getcurrent()
            task.greenlet.throw(GreenletExit)
        self.stacks.free(task.stack)
        if task.vital and not ended:
            self.vital_tasks -= 1
            if not self.vital_tasks:
                self.exit_program(0)

    def add(
        self, function: Function, priority: int, stack: Stack, arguments: tuple[int, int], vital: bool, name: str
    ) -> Task:
        """Create a task with its greenlet.  It is in its ready queue, or inactive if its priority is -1."""
        name = self._names.unique(name or function_name(function))
        task = Task(
            name, fitted(self.core, function, 2, "task"), arguments, priority, stack, vital=vital,
            address=self._object_base + OBJECT_WORDS * self._created, run=self._run, parent=self._host(),
        )  # fmt: skip
        self._created += 1
        self.vital_tasks += vital
        self.all.append(task)
        if priority == 0:
            self.idle = task
        if priority >= 0:
            self.unblock(task)
        return task

    def set_priority(self, task: Task, priority: int) -> int:
        """Do what `Task_setPri` does, but charge no cycles and do not switch tasks."""
        self.core.check(
            priority == -1 or 0 < priority < PRIORITIES or (priority == 0 and self.idle is None),
            "Task_A_badPriority", f"{priority} is not -1 or 1..15",
        )  # fmt: skip
        old = task.priority
        if old == priority:
            return old
        if task.mode == READY or (task.mode == INACTIVE and priority >= 0):
            if task.mode == READY:
                queue = self._ready[old]
                queue.remove(task)
                if not queue:
                    self._ready_set &= ~(1 << old)
            if priority < 0:
                task.mode = INACTIVE
            else:
                task.mode = READY
                if task is self.current:
                    self._ready[priority].appendleft(task)
                else:
                    self._ready[priority].append(task)
                self._ready_set |= 1 << priority
            if task is self.current:
                self.current_queue = priority
        if priority < 0:
            self.current_queue = -1
        task.priority = priority
        self.work = True
        if self.core.trace.active:
            self.core.trace.emit("priority", f"{task.name}={priority}")
        return old
