"""The counter of an ePWM module, computed from the cycle at which it was last set.

The counter's path is described by a *phase*, the number of TBCLK since the start of its period:

    mode       phase 0        period (TBCLK)   TBCTR
    up         CTR = 0        TBPRD + 1        phase
    down       CTR = TBPRD    TBPRD + 1        TBPRD - phase
    up-down    CTR = 0        2 * TBPRD        phase up to TBPRD, then 2 * TBPRD - phase

A counter beyond TBPRD (written, or TBPRD lowered at once) first has a *lead* to go: upwards through 0xFFFF to 0,
downwards to TBPRD.  CHOICE: no compare event happens on the lead.  CHOICE: with TBPRD = 0 an up-down counter stays at
0, one TBCLK a period.

Sources: TRM ePWM, time-base submodule.
"""

from __future__ import annotations

from typing import Final

from emulator.clock import Clock

UP: Final = 0
DOWN: Final = 1
UP_DOWN: Final = 2
STOPPED: Final = 3


class TimeBase:
    """TBCTR of one module.  `period` is the active TBPRD, `tick` the length of a TBCLK in SYSCLK cycles."""

    __slots__ = (
        "_base", "_clock", "_count", "_grid", "_lead", "_passed", "_phase", "_seen", "_up", "enabled", "length", "mode",
        "period", "tick",
    )  # fmt: skip

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self.enabled = False
        self._base = self._count = self._lead = self._phase = self._seen = 0
        self._up = True
        self._passed = False
        self.length = 1
        self.reset()

    def reset(self) -> None:
        """Set TBCTR to 0 and stop the counter.  The clock gates stay as they are."""
        self.mode = STOPPED
        self.period = 0
        self.tick = 1
        self._grid = self._clock.now
        self._place(0, True)
        self._passed = False

    @property
    def running(self) -> bool:
        """Whether the counter runs."""
        return self.enabled and self.mode != STOPPED

    @property
    def counts(self) -> bool:
        """Whether the count changes: with TBPRD = 0 it stays at 0 once it is there."""
        return self.running and (self.period > 0 or self._ticks() < self._lead)

    # -- Count and phase ---------------------------------------------------------------------------------------------

    def count(self) -> int:
        """The present value of TBCTR."""
        ticks = self._ticks()
        if ticks < self._lead or not self.running:
            return self._count + ticks if self._up else self._count - ticks
        phase = (self._phase + ticks - self._lead) % self.length
        if self.mode == UP:
            return phase
        if self.mode == DOWN:
            return self.period - phase
        return phase if phase <= self.period else 2 * self.period - phase

    def up(self) -> bool:
        """The value of TBSTS.CTRDIR.  At CTR = 0 an up-down counter counts up, at CTR = TBPRD it counts down."""
        ticks = self._ticks()
        if ticks < self._lead or not self.running:
            return self._up
        phase = self.phase()
        return self.mode == UP or (self.mode == UP_DOWN and (phase == 0 or phase < self.period))

    def phase(self) -> int:
        """The present phase.  During a lead, it is the phase at the end of the lead."""
        return (self._phase + max(self._ticks() - self._lead, 0)) % self.length

    def arrivals(self) -> tuple[int, int]:
        """(phase, n): since it was last set, the counter has passed the n phases after `phase`."""
        ticks = self._ticks()
        if self._lead:
            return self._phase - 1, max(ticks - self._lead + 1, 0)
        return self._phase, ticks

    def arrival_time(self, n: int) -> int:
        """The cycle of the nth arrival of `arrivals`, n >= 1."""
        return self._base + (self._lead + n - 1 if self._lead else n) * self.tick

    def next_tick(self) -> int:
        """The cycle of the next TBCLK after now.  Call it only while the counter runs."""
        return self._base + (self._ticks() + 1) * self.tick

    def next_time(self, phase: int) -> int:
        """The cycle of the next arrival at `phase` after now.  Call it only while the counter runs."""
        ticks = self._ticks()
        first = self._lead + (phase - self._phase) % self.length
        if first <= ticks:
            first += -(-(ticks + 1 - first) // self.length) * self.length
        return self._base + first * self.tick

    def reached_maximum(self) -> bool:
        """Whether TBCTR has reached 0xFFFF by counting since the last call."""
        passed, self._passed = self._passed, False
        before, self._seen = self._seen, self._ticks()
        return passed or self._meets_maximum(before, self._seen)

    def _meets_maximum(self, before: int, ticks: int) -> bool:
        """Whether an arrival at 0xFFFF lies in the ticks `before` < n <= `ticks`."""
        if self._lead and self._up and before < 0xFFFF - self._count <= ticks:
            return True
        if self.period != 0xFFFF or self.mode == STOPPED:
            return False
        first = self._lead + ((0 if self.mode == DOWN else self.period) - self._phase) % self.length
        return (ticks - first) // self.length > (before - first) // self.length

    # -- Settings ------------------------------------------------------------------------------------------------

    def change(self, *, mode: int | None = None, period: int | None = None, tick: int | None = None,
               enabled: bool | None = None, count: int | None = None, up: bool | None = None) -> None:  # fmt: skip
        """Change the given settings from now on.  Everything else stays as it is.

        TBCLK edges lie on a grid that starts when TBCLKSYNC is set.  CHOICE: a new prescaler starts a new grid.
        """
        here, rising = self.count(), self.up()
        self._passed = self.reached_maximum()
        if tick is not None and tick != self.tick:
            self.tick = tick
            self._grid = self._clock.now
        if enabled is not None and enabled != self.enabled:
            self.enabled = enabled
            self._grid = self._clock.now
        if mode is not None:
            self.mode = mode
        if period is not None:
            self.period = period
        self._place(here if count is None else count, rising if up is None else up)

    def _ticks(self) -> int:
        return (self._clock.now - self._base) // self.tick if self.running else 0

    def _place(self, count: int, up: bool) -> None:
        now, period, mode = self._clock.now, self.period, self.mode
        self._base = now - (now - self._grid) % self.tick
        self._seen = 0
        if mode in (UP, DOWN):
            up = mode == UP
        self._count, self._up = count, up
        self.length = max(2 * period, 1) if mode == UP_DOWN else period + 1
        self._lead = 0
        if count > period:
            self._lead = 0x10000 - count if up else count - period
            self._phase = period if mode == UP_DOWN and not up else 0
        elif mode == DOWN:
            self._phase = period - count
        elif mode == UP_DOWN and not up:
            self._phase = (2 * period - count) % self.length
        else:
            self._phase = count % self.length
