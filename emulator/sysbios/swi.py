"""Software interrupts: `ti.sysbios.knl.Swi`.

Modelled
    Swis have priorities 0 to 15.  A Swi pre-empts Swis of lower priority; those of one priority run in the order of
    their posts.  A Swi that is posted already is not posted again; its flag is cleared just before its function runs.
    `Swi_or` and `Swi_inc` always post; `Swi_andn` and `Swi_dec` post when the trigger becomes 0.  `Swi_disable` delays
    Swis and task switches.  All Swis run on the system stack, with interrupts enabled.
Not modelled
    Hooks, `Swi_raisePri`, `Swi_setAttrs`.
Time
    `swi_post` for each call, `swi_run` for each run (costs.py).
Sources
    BIOS; `knl/Swi.c` 6.83 (Swi_post, Swi_run, Swi_schedule, Swi_restore).
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.memory import NULL
from emulator.c28x.position import INTERRUPT
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import HWI, SWI, TASK, Function, KernelCore, KernelObject, UniqueNames, fitted, function_name
from emulator.sysbios.params import NO_PRIORITY

if TYPE_CHECKING:
    from emulator.sysbios.scheduler import Scheduler

PRIORITIES: Final = 16


class Swi(KernelObject):
    """The object of a `Swi_Handle`."""

    __slots__ = ("arg0", "arg1", "function", "initial_trigger", "mask", "posted", "priority", "trigger", "who")

    def __init__(self, name: str, function: Function, arg0: int, arg1: int, priority: int, trigger: int) -> None:
        super().__init__(name)
        self.who = f"Swi:{name}"
        self.function = function
        self.arg0 = arg0
        self.arg1 = arg1
        self.priority = priority
        self.mask = 1 << priority
        self.trigger = self.initial_trigger = trigger
        self.posted = False

    def __repr__(self) -> str:
        return f"<Swi {self.name} priority {self.priority}>"


class SwiModule:
    """`Swi_*`.  A running Swi locks the task scheduler `tasks`, which creates this module."""

    def __init__(self, core: KernelCore, tasks: Scheduler, *, system_stack: tuple[int, int]) -> None:
        self.core = core
        self.tasks = tasks
        self.locked = True
        self.ready_set = 0
        self.current: Swi | None = None
        self._system_stack = system_stack
        self._ready: tuple[deque[Swi], ...] = tuple(deque() for _ in range(PRIORITIES))
        self._current_priority = -1
        self._current_trigger = 0
        self._names = UniqueNames()
        self._cost_post = core.costs["swi_post"]
        self._cost_run = core.costs["swi_run"]

    # Scheduling

    def post(self, swi: Swi) -> None:
        """Make a Swi ready as `Swi_post` does, but charge no cycles."""
        if not swi.posted:
            swi.posted = True
            self._ready[swi.priority].append(swi)
            self.ready_set |= swi.mask

    def run_ready(self) -> None:
        """Run every ready Swi of higher priority than the running one, the highest first.

        Call it only while the Swi scheduler is unlocked.
        """
        floor = self._current_priority
        if self.ready_set.bit_length() - 1 <= floor:
            return
        core = self.core
        cpu = core.cpu
        key = self.tasks.lock()
        previous, sp, limit, interrupts_off = core.thread_type, cpu.sp, cpu.stack_limit, cpu.intm
        if previous == TASK:
            cpu.sp, cpu.stack_limit = self._system_stack
        core.thread_type = SWI
        current, trigger = self.current, self._current_trigger
        position = cpu.position
        position.calls = below = (position.at, position.calls, INTERRUPT)
        position.at, outer = 0, position.who
        while (top := self.ready_set.bit_length() - 1) > floor:
            queue = self._ready[top]
            swi = queue.popleft()
            if not queue:
                self.ready_set &= ~swi.mask
            self.current = swi
            position.who = swi.who
            self._current_priority = top
            self._current_trigger = swi.trigger
            swi.trigger = swi.initial_trigger
            swi.posted = False
            self.locked = False
            if cpu.intm:
                cpu.enable_interrupts()
            self._run(swi)
        self._current_priority, self.current, self._current_trigger = floor, current, trigger
        core.thread_type = previous
        position.at, position.calls, _ = below
        position.who = outer
        cpu.sp, cpu.stack_limit, cpu.intm = sp, limit, interrupts_off
        self.locked = False
        if not key:
            self.tasks.restore(False)

    def _run(self, swi: Swi) -> None:
        core = self.core
        clock = core.clock
        trace = core.trace
        if trace.active:
            trace.emit("swi", swi.name)
        clock.now += self._cost_run
        if clock.now >= clock.next:
            clock.run_due()
        swi.function(swi.arg0, swi.arg1)
        if trace.active:
            trace.emit("swi end", swi.name)

    def create(
        self, function: Function, priority: int, *, arg0: int = 0, arg1: int = 0, trigger: int = 0, name: str = ""
    ) -> Swi:
        """Create a Swi for the kernel itself or for a test."""
        if priority in (NO_PRIORITY, -1):
            priority = PRIORITIES - 1
        self.core.check(
            0 <= priority < PRIORITIES, "Swi_A_badPriority", f"priority {priority} is not 0..{PRIORITIES - 1}"
        )
        name = self._names.unique(name or function_name(function))
        return Swi(name, fitted(self.core, function, 2, "Swi function"), arg0, arg1, priority % PRIORITIES, trigger)

    # C functions

    def Swi_Params_init(self, params: Any) -> None:
        """Set the defaults: the highest priority, trigger 0."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("Swi_Params", params)

    def Swi_create(self, function: Function, params: Any, error_block: Any = None) -> Swi:
        """Create a Swi."""
        self.core.clock.charge(self.core.costs["swi_create"])
        given = struct_params.read(self.core, "Swi_Params", params)
        return self.create(
            function, given["priority"], arg0=given["arg0"], arg1=given["arg1"], trigger=given["trigger"]
        )

    def Swi_delete(self, pointer: Any) -> None:
        """Delete the Swi.  It must not be posted."""
        self.core.clock.charge(self.core.costs["delete"])
        swi = pointer.load()
        self.core.check(not swi.posted, "Swi_delete", f"{swi.name} is posted: it cannot be deleted before it has run")
        swi.deleted = True
        pointer.store(NULL)

    def Swi_post(self, swi: Swi) -> None:
        """Run the Swi as soon as its priority allows it, which may be at once."""
        core = self.core
        clock = core.clock
        clock.now += self._cost_post
        if clock.now >= clock.next:
            clock.run_due()
        if core.trace.active:
            core.trace.emit("swi post", swi.name)
        if swi.posted:
            return
        self.post(swi)
        if not self.locked and core.thread_type != HWI:
            self.run_ready()

    def Swi_or(self, swi: Swi, mask: int) -> None:
        """Set bits of the trigger, and post."""
        self.core.clock.charge(self.core.costs["swi_trigger"])
        swi.trigger = (swi.trigger | mask) & 0xFFFF
        self.Swi_post(swi)

    def Swi_inc(self, swi: Swi) -> None:
        """Add 1 to the trigger (16 bits wrap), and post."""
        self.core.clock.charge(self.core.costs["swi_trigger"])
        swi.trigger = (swi.trigger + 1) & 0xFFFF
        self.Swi_post(swi)

    def Swi_andn(self, swi: Swi, mask: int) -> None:
        """Clear bits of the trigger, and post if that made it 0.  If the trigger is 0 already, do nothing."""
        self.core.clock.charge(self.core.costs["swi_trigger"])
        if swi.trigger:
            swi.trigger &= ~mask & 0xFFFF
            if not swi.trigger:
                self.Swi_post(swi)

    def Swi_dec(self, swi: Swi) -> None:
        """Subtract 1 from the trigger, and post if that made it 0.  If the trigger is 0 already, do nothing."""
        self.core.clock.charge(self.core.costs["swi_trigger"])
        if swi.trigger:
            swi.trigger -= 1
            if not swi.trigger:
                self.Swi_post(swi)

    def Swi_getTrigger(self) -> int:
        """The trigger as it was when the running Swi was started."""
        return self._current_trigger

    def Swi_getPri(self, swi: Swi) -> int:
        """The priority of a Swi."""
        return swi.priority

    def Swi_self(self) -> Swi | None:
        """The running Swi; NULL if none runs."""
        return self.current

    def Swi_disable(self) -> int:
        """Hold back Swis and task switches; returns the key for `Swi_restore`."""
        self.core.clock.charge(self.core.costs["swi_disable"])
        key = self.locked
        self.locked = True
        return int(key)

    def Swi_restore(self, key: int) -> None:
        """Undo the `Swi_disable` that returned `key`.  Swis and tasks that were held back run now."""
        self.core.clock.charge(self.core.costs["swi_disable"])
        if key:
            return
        self.locked = False
        if self.ready_set:
            self.run_ready()
        self.tasks.restore(self.tasks.lock())

    def Swi_enable(self) -> None:
        """Release the Swi scheduler, however often it was disabled."""
        self.Swi_restore(0)
