"""Gates with priority inheritance: `ti.sysbios.gates.GateMutexPri`.

Modelled
    Only the key shows the nesting: the first `enter` returns 0, a nested one 1.  The owner inherits the priority of a
    higher task as soon as that task waits.  Inheritance is not transitive.  Any caller can `leave`; the owner is not
    checked.  Any leave lowers the owner to the priority that was saved.  Tasks wait in the order of their priorities,
    those of one priority in FIFO order.  `order_fault` selects the behaviour of 6.37 and older: if a task waits
    already, the place of another one depends on the low half of that task's address.
Time
    `gate_enter` and `gate_leave`.
Sources
    BIOS; `gates/GateMutexPri.c` 6.83 (GateMutexPri_enter, _leave, _insertPri) and 6.37.
"""

from __future__ import annotations

from typing import Any, Final

from emulator.c28x.memory import NULL
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import MAIN, TASK, KernelCore, KernelObject, UniqueNames
from emulator.sysbios.scheduler import Task, Waiter
from emulator.sysbios.task import TaskModule

FIRST_ENTER: Final = 0
NESTED_ENTER: Final = 1


class GateMutexPri(KernelObject):
    """The object of a `GateMutexPri_Handle`."""

    __slots__ = ("free", "original_priority", "owner", "waiters")

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.free = True
        self.owner: Task | None = None
        self.original_priority = 0
        self.waiters: list[Waiter] = []

    def __repr__(self) -> str:
        return f"<GateMutexPri {self.name} {'free' if self.free else self.owner}>"


class GateMutexPriModule:
    """`GateMutexPri_*`."""

    def __init__(self, core: KernelCore, tasks: TaskModule, *, order_fault: bool) -> None:
        self.core = core
        self.tasks = tasks
        self.order_fault = order_fault
        self._names = UniqueNames()
        self._cost_enter = core.costs["gate_enter"]
        self._cost_leave = core.costs["gate_leave"]

    def GateMutexPri_Params_init(self, params: Any) -> None:
        """Set the defaults.  There is nothing to choose."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("GateMutexPri_Params", params)

    def GateMutexPri_create(self, params: Any = None, error_block: Any = None) -> GateMutexPri:
        """Create a free gate."""
        self.core.clock.charge(self.core.costs["gate_create"])
        struct_params.read(self.core, "GateMutexPri_Params", params)
        return GateMutexPri(self._names.unique("GateMutexPri"))

    def GateMutexPri_delete(self, pointer: Any) -> None:
        """Delete the gate; a task that waits for it waits for ever."""
        self.core.clock.charge(self.core.costs["delete"])
        pointer.load().deleted = True
        pointer.store(NULL)

    def GateMutexPri_enter(self, handle: Any) -> int:
        """Take the gate; returns the key for `leave`: 0 if this call took it, 1 if the caller has it already.

        Before tasks run the handle is not looked at.
        """
        core = self.core
        clock = core.clock
        clock.now += self._cost_enter
        if clock.now >= clock.next:
            clock.run_due()
        if core.thread_type not in (TASK, MAIN):
            core.check(False, "GateMutexPri_A_badContext", "a gate can be entered from main or a task only")
        tasks = self.tasks
        task = tasks.current
        if task is None:
            return NESTED_ENTER
        gate: GateMutexPri = handle
        if gate.free:
            gate.free = False
            gate.owner = task
            gate.original_priority = task.priority
            if core.trace.active:
                core.trace.emit("gate enter", gate.name)
            return FIRST_ENTER
        owner = gate.owner
        if owner is task:
            return NESTED_ENTER
        core.check(
            not tasks.locked and not tasks.swis.locked, "GateMutexPri_A_enterTaskDisabled",
            "a gate that another task holds cannot be waited for while the Task or Swi scheduler is disabled",
        )  # fmt: skip
        if core.trace.active:
            core.trace.emit("gate wait", gate.name)
        key = tasks.lock()
        tasks.block(task)
        waiter = task.pend = Waiter(task, gate.waiters)
        self._insert(gate, waiter)
        assert owner is not None
        if task.priority > owner.priority:
            clock.now += core.costs["task_set_priority"]
            tasks.set_priority(owner, task.priority)
        tasks.restore(key)
        task.pend = None
        return FIRST_ENTER

    def _insert(self, gate: GateMutexPri, waiter: Waiter) -> None:
        """Insert a waiter before the first one of lower priority.

        The faulty version (`order_fault`) compares with the low half of an address instead of the priority.
        """
        for place, other in enumerate(gate.waiters):
            compared = other.task.priority
            if self.order_fault:
                compared = (other.task.address + 0x8000 & 0xFFFF) - 0x8000
            if waiter.task.priority > compared:
                gate.waiters.insert(place, waiter)
                return
        gate.waiters.append(waiter)

    def GateMutexPri_leave(self, handle: Any, key: int) -> None:
        """Release the gate if `key` is 0.  The caller need not be the owner.  The first waiter owns it from now on.

        Before tasks run the handle is not looked at.
        """
        core = self.core
        clock = core.clock
        clock.now += self._cost_leave
        if clock.now >= clock.next:
            clock.run_due()
        tasks = self.tasks
        task = tasks.current
        if task is None or key != FIRST_ENTER:
            return
        gate: GateMutexPri = handle
        if gate.free or gate.owner is not task:
            owner = "nobody" if gate.free or gate.owner is None else gate.owner.name
            message = f"{gate.name} was left by {task.name}, but belongs to {owner}"
            core.findings.report("gate-owner", message, object=gate.name)
        if not gate.waiters and gate.original_priority >= task.priority:  # Nothing that could lead to a switch.
            gate.free = True
            if core.trace.active:
                core.trace.emit("gate leave", gate.name)
            return
        locked = tasks.lock()
        if gate.original_priority < task.priority:
            clock.now += core.costs["task_set_priority"]
            tasks.set_priority(task, gate.original_priority)
        if gate.waiters:
            new_owner = gate.waiters.pop(0).task
            gate.owner = new_owner
            gate.original_priority = new_owner.priority
            tasks.unblock(new_owner)
        else:
            gate.free = True
        if core.trace.active:
            core.trace.emit("gate leave", gate.name)
        tasks.restore(locked)
