"""Gates without priority inheritance: `ti.sysbios.gates.GateMutex`.

Modelled
    Only the key shows the nesting: the first `enter` returns 0, a nested one 1.  The gate has a counting semaphore with
    a count of 1, so tasks that wait are served in the order of their arrival.  Any caller can `leave`; the owner is not
    checked.
Time
    `gate_mutex`, and the call of the semaphore.  A nested `enter` or `leave` does not call the semaphore.
Sources
    BIOS; `gates/GateMutex.c` 6.83 (GateMutex_enter, GateMutex_leave).
"""

from __future__ import annotations

from typing import Any

from emulator.c28x.memory import NULL
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import MAIN, TASK, WAIT_FOREVER, KernelCore, KernelObject, UniqueNames
from emulator.sysbios.gate_mutex_pri import FIRST_ENTER, NESTED_ENTER
from emulator.sysbios.scheduler import Task
from emulator.sysbios.semaphore import COUNTING, Semaphore, SemaphoreModule
from emulator.sysbios.task import TaskModule


class GateMutex(KernelObject):
    """The object of a `GateMutex_Handle`."""

    __slots__ = ("owner", "semaphore")

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.owner: Task | None = None
        self.semaphore = Semaphore(name, 1, COUNTING)

    @property
    def free(self) -> bool:
        """Whether no task owns it.  This also holds between a leave and the moment when the next owner runs."""
        return self.owner is None

    def __repr__(self) -> str:
        return f"<GateMutex {self.name} {self.owner or 'free'}>"


class GateMutexModule:
    """`GateMutex_*`."""

    def __init__(self, core: KernelCore, tasks: TaskModule, semaphores: SemaphoreModule) -> None:
        self.core = core
        self.tasks = tasks
        self.semaphores = semaphores
        self._names = UniqueNames()

    def GateMutex_Params_init(self, params: Any) -> None:
        """Set the defaults.  There is nothing to choose."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("GateMutex_Params", params)

    def GateMutex_create(self, params: Any = None, error_block: Any = None) -> GateMutex:
        """Create a free gate."""
        self.core.clock.charge(self.core.costs["gate_create"])
        struct_params.read(self.core, "GateMutex_Params", params)
        return GateMutex(self._names.unique("GateMutex"))

    def GateMutex_delete(self, pointer: Any) -> None:
        """Delete the gate; a task that waits for it waits for ever."""
        self.core.clock.charge(self.core.costs["delete"])
        pointer.load().deleted = True
        pointer.store(NULL)

    def GateMutex_enter(self, gate: GateMutex) -> int:
        """Take the gate; returns the key for `leave`: 0 if this call took it, 1 if the caller has it already."""
        core = self.core
        core.clock.charge(core.costs["gate_mutex"])
        core.check(
            core.thread_type in (TASK, MAIN), "GateMutex_A_badContext", "a gate can be entered from main or a task only"
        )
        task = self.tasks.current
        if gate.owner is task:
            return NESTED_ENTER
        if core.trace.active and not gate.semaphore.count:
            core.trace.emit("gate wait", gate.name)
        self.semaphores.Semaphore_pend(gate.semaphore, WAIT_FOREVER)
        gate.owner = task
        if core.trace.active:
            core.trace.emit("gate enter", gate.name)
        return FIRST_ENTER

    def GateMutex_leave(self, gate: GateMutex, key: int) -> None:
        """Release the gate if `key` is 0.  The caller need not be the owner."""
        core = self.core
        core.clock.charge(core.costs["gate_mutex"])
        if key != FIRST_ENTER:
            return
        task = self.tasks.current
        if task is not None and gate.owner is not task:
            owner = "nobody" if gate.owner is None else gate.owner.name
            message = f"{gate.name} was left by {task.name}, but belongs to {owner}"
            core.findings.report("gate-owner", message, object=gate.name)
        gate.owner = None
        if core.trace.active:
            core.trace.emit("gate leave", gate.name)
        self.semaphores.Semaphore_post(gate.semaphore)
