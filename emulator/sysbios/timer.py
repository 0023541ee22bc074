"""The tick's timer: `ti.sysbios.family.c28.Timer` as the kernel itself uses it.

Modelled
    `Timer.ANY` selects the highest free CPU timer, which is CPU timer 2 with interrupt INT14.  Its period register is
    floor(kHz * microseconds / 1000), without the usual -1.  So the period is one count longer.
Time
    A tick takes the same cycles every time if the CPU is idle and no Clock function is due: those of the core, the
    dispatcher, the handler and the Clock Swi.  If nothing else happens, such ticks are computed in one step
    (`pass_idle_ticks`).
Not modelled
    `Timer_create` for firmware, prescaler, one-shot mode.
Sources
    `family/c28/Timer.c` 6.83 (Timer_setPeriodMicroSecs, Timer_Instance_init, Timer_startup).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Protocol

from emulator.cpu import INTERRUPT_ENTRY_CYCLES, INTERRUPT_EXIT_CYCLES
from emulator.sysbios.clock import ClockModule
from emulator.sysbios.hwi import HwiModule
from emulator.sysbios.task import TaskModule

TIMER_INTERRUPT: Final = 14
_LINE: Final = 1 << TIMER_INTERRUPT - 1


class TickSource(Protocol):
    """The timer of the tick, as `pass_idle_ticks` needs it."""

    def skip(self, most: int, cycles: int) -> range:
        """Take up to `most` underflows, each of which occupies the CPU for `cycles`; returns when those were taken."""


#: Loads the period register and starts the timer; returns the timer if it can take idle ticks together.
StartTick = Callable[[int, Callable[[], None]], TickSource | None]


class TickTimer:
    """Connects the tick handler with CPU timer 2."""

    def __init__(
        self, hwis: HwiModule, clocks: ClockModule, tasks: TaskModule, *, cpu_frequency_hz: int, start_tick: StartTick,
        join_idle_ticks: bool = True,
    ) -> None:  # fmt: skip
        """With `join_idle_ticks` False every tick is computed by itself; the result is the same."""
        self._hwis = hwis
        self._clocks = clocks
        self._tasks = tasks
        self._start_tick = start_tick
        self._join = join_idle_ticks
        self._source: TickSource | None = None
        costs = hwis.core.costs
        handler = costs["hwi_prologue"] + costs["clock_tick"] + costs["hwi_epilogue"]
        self._handler_cycles = INTERRUPT_ENTRY_CYCLES + handler
        self._interrupt_cycles = self._handler_cycles + INTERRUPT_EXIT_CYCLES
        self._swi_cycles = costs["swi_run"] + costs["clock_work"]
        self._cycles_per_object = costs["clock_walk"]
        #: The value that the kernel writes to PRD.  The timer counts one more.
        self.period_register = cpu_frequency_hz // 1000 * clocks.tick_period_us // 1000
        self._hwi = hwis.create(TIMER_INTERRUPT, clocks.tick, name="Clock_tick")

    def start(self) -> None:
        """Start the tick (`Timer_startup`).  BIOS_start calls it."""
        self._hwis.Hwi_enableInterrupt(TIMER_INTERRUPT)
        source = self._start_tick(self.period_register, self._hwis.handler(TIMER_INTERRUPT))
        if self._join:
            self._source = source

    def pass_idle_ticks(self) -> None:
        """Compute the next ticks in one step, as long as each tick would only be counted.

        The idle task calls it between two events.  It does so only if no listener wants each tick, no interrupt, Swi or
        task waits, and the interrupted stack has room for the dispatcher.
        """
        source, core, clocks, tasks = self._source, self._hwis.core, self._clocks, self._tasks
        quiet = clocks.quiet_ticks()
        if source is None or quiet <= 0 or core.trace.each_tick or core.clock.need_attention:
            return
        cpu, swis = core.cpu, tasks.swis
        if cpu.intm or cpu.ifr & cpu.ier or not cpu.ier & _LINE:
            return
        if tasks.locked or tasks.work or swis.locked or swis.ready_set:
            return
        if cpu.sp > cpu.stack_limit:
            return
        swi_cycles = self._swi_cycles + self._cycles_per_object * len(clocks.queue)
        cycles = self._interrupt_cycles + swi_cycles
        ticks = source.skip(quiet, cycles)
        clocks.ticks += len(ticks)
        if ticks and core.trace.active:
            hwi, swi = self._hwi.name, clocks.swi.name
            core.trace.joined_ticks(ticks, self._interrupt_cycles, swi_cycles, (
                (INTERRUPT_ENTRY_CYCLES, "hwi", hwi), (self._handler_cycles, "hwi end", hwi),
                (self._interrupt_cycles, "swi", swi), (cycles, "swi end", swi),
            ))  # fmt: skip
