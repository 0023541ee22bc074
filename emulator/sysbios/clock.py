"""The kernel's Clock: `ti.sysbios.knl.Clock`, tick mode PERIODIC (the C28x timer cannot do another).

Modelled
    The tick handler counts, and posts the Clock Swi (priority 15).  The Swi handles every missed tick in order; for
    each tick it goes through the Clock objects in the order of their creation.  Objects are one-shot or periodic; a
    periodic object does not drift.  A start counts from the present tick, also in a Clock function that runs late.
    Timeouts of `Task_sleep` and `Semaphore_pend` are temporary objects at the end of the queue.
Not modelled
    `Clock_setTicks`, `Clock_tickStop`, tick sources USER and NULL.  An object started with timeout 0
    while asserts are off would first fire when 32 bits wrap; here it fires after 2^32 ticks.
Time
    `clock_tick` for the handler, `clock_work` for the Swi, `clock_walk` for each object, and `clock_call` for each
    function that is called.  A tick at which no object is due takes the same CPU cycles, but the emulator does not go
    through the queue: `_next_due` tells that no object is due.
Sources
    BIOS; `knl/Clock.c` 6.83 (Clock_workFunc, Clock_startI, Clock_Instance_init), `knl/Clock.xdt` Clock_doTick.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from emulator.c28x.memory import NULL
from emulator.clock import NEVER
from emulator.sysbios import params as struct_params
from emulator.sysbios.core import HWI, SWI, Function, KernelCore, KernelObject, UniqueNames, fitted, function_name
from emulator.sysbios.swi import SwiModule

UINT32: Final = 0xFFFFFFFF
WRAP: Final = 1 << 32
#: Default Clock.swiPriority: the highest.
SWI_PRIORITY: Final = 15


class ClockObject(KernelObject):
    """The object of a `Clock_Handle`.  `due` is the tick of its next call, counted from the start without wrapping."""

    __slots__ = ("active", "arg", "due", "function", "period", "timeout")

    def __init__(self, name: str, function: Function, timeout: int, period: int, arg: Any) -> None:
        super().__init__(name)
        self.function = function
        self.timeout = timeout
        self.period = period
        self.arg = arg
        self.active = False
        self.due = 0

    def __repr__(self) -> str:
        return f"<Clock {self.name} timeout {self.timeout} period {self.period}>"


class ClockModule:
    """`Clock_*`: the tick count and the queue of Clock objects."""

    def __init__(
        self, core: KernelCore, swis: SwiModule, *, tick_period_us: int, swi_priority: int = SWI_PRIORITY
    ) -> None:
        self.core = core
        self.swis = swis
        self.tick_period_us = tick_period_us
        #: Ticks since the start, not wrapped.
        self.ticks = 0
        self.queue: list[ClockObject] = []
        self._missed = 0
        #: No active object is due before this tick.
        self._next_due = NEVER
        self.swi = swis.create(self._work, swi_priority, name="Clock")
        self._names = UniqueNames()
        self._cost_tick = core.costs["clock_tick"]
        self._cost_work = core.costs["clock_work"]
        self._cost_walk = core.costs["clock_walk"]
        self._cost_call = core.costs["clock_call"]

    # The tick

    def tick(self, _arg: int = 0) -> None:
        """The timer's handler (`Clock_doTick`)."""
        clock = self.core.clock
        clock.now += self._cost_tick
        if clock.now >= clock.next:
            clock.run_due()
        self.ticks += 1
        if self.queue:
            self._missed += 1
            self.swis.post(self.swi)

    def quiet_ticks(self) -> int:
        """The number of the next ticks that will call no function.  Without a Clock object it is 0: no Swi runs."""
        return self._next_due - 1 - self.ticks if self.queue and not self._missed else 0

    def _work(self, _arg0: int, _arg1: int) -> None:
        """The Clock Swi (`Clock_workFunc`)."""
        core = self.core
        clock = core.clock
        clock.now += self._cost_work
        if clock.now >= clock.next:
            clock.run_due()
        ticks, count = self.ticks, self._missed
        self._missed = 0
        if count > 1 and core.trace.active:
            core.trace.emit("clock late", str(count))
        for tick in range(ticks - count + 1, ticks + 1):
            clock.now += self._cost_walk * len(self.queue)
            if clock.now >= clock.next:
                clock.run_due()
            if tick >= self._next_due:
                self._walk(tick)

    def _walk(self, tick: int) -> None:
        """Call the functions that are due at `tick`, in the order of creation of their objects."""
        core = self.core
        for timer in self.queue:
            if timer.active and timer.due == tick:
                if timer.period:
                    timer.due += timer.period
                else:
                    timer.active = False
                if timer.name and core.trace.active:
                    core.trace.emit("clock", timer.name)
                core.clock.charge(self._cost_call)
                timer.function(timer.arg)
        next_due = NEVER
        for timer in self.queue:
            if timer.active and timer.due < next_due:
                next_due = timer.due
        self._next_due = next_due

    # Timeouts of other modules

    def add_temporary(self, timeout: int, function: Callable[[Any], None], arg: Any) -> ClockObject:
        """Append a started one-shot Clock object to the queue, for the timeout of a sleep or pend."""
        timer = ClockObject("", function, timeout, 0, arg)
        self.queue.append(timer)
        self.start(timer)
        return timer

    def remove(self, timer: ClockObject) -> None:
        """Take an object out of the queue.  A task that waited calls it for its temporary object when it runs again."""
        timer.active = False
        self.queue.remove(timer)

    def start(self, timer: ClockObject) -> None:
        """Start an object as `Clock_start` does, but charge no cycles."""
        timer.due = self.ticks + (timer.timeout or WRAP)
        timer.active = True
        if timer.due < self._next_due:
            self._next_due = timer.due

    # C functions

    def Clock_Params_init(self, params: Any) -> None:
        """Set the defaults: not started, one-shot, argument 0."""
        self.core.clock.charge(self.core.costs["params_init"])
        struct_params.initialise("Clock_Params", params)

    def Clock_create(self, function: Function, timeout: int, params: Any, error_block: Any = None) -> ClockObject:
        """Create a Clock that calls `function` `timeout` ticks (16 bits) after its start, then every `period` ticks."""
        core = self.core
        core.clock.charge(core.costs["clock_create"])
        given = struct_params.read(core, "Clock_Params", params)
        timeout &= 0xFFFF
        core.check(
            core.thread_type not in (HWI, SWI), "Clock_A_badThreadType", "a Clock cannot be created from a Hwi or Swi"
        )
        core.check(
            not given["startFlag"] or timeout != 0,
            "Clock_A_timeout",
            "a Clock that starts at once needs a timeout above 0",
        )
        name = self._names.unique(function_name(function))
        timer = ClockObject(
            name, fitted(self.core, function, 1, "Clock function"), timeout, given["period"], given["arg"]
        )
        self.queue.append(timer)
        if given["startFlag"]:
            self.start(timer)
        return timer

    def Clock_delete(self, pointer: Any) -> None:
        """Delete the Clock, whether it runs or not."""
        core = self.core
        core.clock.charge(core.costs["delete"])
        core.check(
            core.thread_type not in (HWI, SWI), "Clock_A_badThreadType", "a Clock cannot be deleted from a Hwi or Swi"
        )
        timer = pointer.load()
        timer.deleted = True
        self.remove(timer)
        pointer.store(NULL)

    def Clock_start(self, timer: ClockObject) -> None:
        """Call the function `timeout` ticks from the current tick.  A running Clock is restarted."""
        self.core.clock.charge(self.core.costs["clock_service"])
        self.core.check(timer.timeout != 0, "Clock_A_timeout", "a Clock with timeout 0 cannot be started")
        self.start(timer)

    def Clock_stop(self, timer: ClockObject) -> None:
        """Stop calling the function.  Stopping a stopped Clock does nothing."""
        self.core.clock.charge(self.core.costs["clock_service"])
        timer.active = False

    def Clock_setPeriod(self, timer: ClockObject, period: int) -> None:
        """Store the period.  It takes effect at the next call of the function."""
        timer.period = period & UINT32

    def Clock_setTimeout(self, timer: ClockObject, timeout: int) -> None:
        """Store the timeout (32 bits) for the next start."""
        timer.timeout = timeout & UINT32

    def Clock_setFunc(self, timer: ClockObject, function: Function, arg: int) -> None:
        """Replace the function and its argument."""
        timer.function = fitted(self.core, function, 1, "Clock function")
        timer.arg = arg

    def Clock_getPeriod(self, timer: ClockObject) -> int:
        """The stored period."""
        return timer.period

    def Clock_getTimeout(self, timer: ClockObject) -> int:
        """The ticks left until a running Clock calls its function; 0 for a stopped Clock."""
        return max(0, timer.due - self.ticks) & UINT32 if timer.active else 0

    def Clock_isActive(self, timer: ClockObject) -> int:
        """Whether the Clock runs."""
        return int(timer.active)

    def Clock_getTicks(self) -> int:
        """The number of ticks since BIOS_start, 32 bits."""
        self.core.clock.charge(self.core.costs["clock_service"])
        return self.ticks & UINT32

    def Clock_getTickPeriod(self) -> int:
        """The tick period in microseconds."""
        return self.tick_period_us
