"""The tick's timer: `ti.sysbios.family.c28.Timer` as the kernel itself uses it.

Modelled
    `Timer.ANY` takes the highest free CPU timer, that is CPU timer 2 with interrupt INT14; its period register is
    floor(kHz * microseconds / 1000), without the usual -1, so that the period is one count longer.
Not modelled
    `Timer_create` for firmware, prescaler, one-shot mode.
Sources
    `family/c28/Timer.c` 6.83 (Timer_setPeriodMicroSecs, Timer_Instance_init, Timer_startup).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.sysbios.clock import ClockModule
from emulator.sysbios.hwi import HwiModule

TIMER_INTERRUPT: Final = 14


class TickTimer:
    """Binds the tick handler to CPU timer 2."""

    def __init__(
        self, hwis: HwiModule, clocks: ClockModule, *, cpu_frequency_hz: int,
        start_tick: Callable[[int, Callable[[], None]], None],
    ) -> None:  # fmt: skip
        self._hwis = hwis
        self._start_tick = start_tick
        #: What the kernel writes to PRD; the timer counts one more.
        self.period_register = cpu_frequency_hz // 1000 * clocks.tick_period_us // 1000
        hwis.create(TIMER_INTERRUPT, clocks.tick, name="Clock_tick")

    def start(self) -> None:
        """`Timer_startup`, from BIOS_start: the tick begins to count."""
        self._hwis.Hwi_enableInterrupt(TIMER_INTERRUPT)
        self._start_tick(self.period_register, self._hwis.handler(TIMER_INTERRUPT))
