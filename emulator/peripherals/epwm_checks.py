"""Finds mistakes of ePWM drivers.

They are: a duty for a counter that stands still or has no period, or for an output without a pin; a compare value
beyond the period; a one-shot trip whose interrupt flag is cleared and whose latch is not.

Part of `epwm.py`.  Start-up code writes compare values before it starts the counter and before it sets the pins.  So
nothing is reported in the first 10 ms after the first compare value (CHOICE).
"""

from __future__ import annotations

from typing import Final, NamedTuple

from emulator.c28x.findings import Cause
from emulator.clock import CYCLES_PER_MS, Clock
from emulator.cpu import Cpu
from emulator.registers.epwm import EPwmRegs
from emulator.signals import DutyWire

SET_UP_CYCLES: Final = 10 * CYCLES_PER_MS


class CompareBeyondPeriod(NamedTuple):
    """A compare value beyond a period, and the statement that wrote it."""

    value: int
    period: int
    cause: Cause


class EPwmChecks:
    """The findings of one module."""

    __slots__ = ("_above", "_clock", "_cpu", "_first", "_regs", "above", "above_half")

    def __init__(self, clock: Clock, cpu: Cpu, regs: EPwmRegs) -> None:
        self._clock, self._cpu, self._regs = clock, cpu, regs
        self._first: int | None = None
        #: Compare register -> the first value above the period plus 1 of each statement, and the period.  A value
        #: counts only if it stood until the next one was written and the period did not change meanwhile.
        self.above: dict[str, list[CompareBeyondPeriod]] = {}
        self._above: dict[str, CompareBeyondPeriod] = {}
        #: Compare register -> the greatest value above half of the period, and that period.
        self.above_half: dict[str, tuple[int, int]] = {}

    def reset(self) -> None:
        """Module reset."""
        self._first = None
        self._above.clear()

    def compared(self, compare: str, value: int, period: int) -> None:
        """A compare value was written; `period` is the larger one of TBPRD and its shadow."""
        if self._above and (stood := self._above.pop(compare, None)):
            self.above.setdefault(compare, []).append(stood)
        if 2 * value > period > 0 and value > self.above_half.get(compare, (0, 0))[0]:
            self.above_half[compare] = value, period
        if not value > period + 1 > 1 or (cause := self._cpu.findings.mark()) is None:
            return
        if all(seen.cause.at != cause.at for seen in self.above.get(compare, ())):
            self._above[compare] = CompareBeyondPeriod(value, period, cause)

    def period_written(self) -> None:
        """The period was written.  The compare value under test may be for the new period."""
        self._above.clear()

    def duty(self, compare: str, *, stopped: bool, tbclksync: bool, unseen: DutyWire | None) -> None:
        """`compare` was written; `unseen` is the output that it drives, if no pin carries it."""
        now = self._clock.now
        if self._first is None:
            self._first = now
        if now - self._first < SET_UP_CYCLES:
            return
        name = self._regs.name
        if stopped and not tbclksync:
            self._report(compare, "CpuSysRegs.PCLKCR0.TBCLKSYNC", "= 0: no ePWM counter counts")
        elif stopped:
            self._report(compare, f"{name}.TBCTL.CTRMODE", "= 3: the counter does not count")
        elif not self._regs.registers["TBPRD"].value:
            self._report(compare, f"{name}.TBPRD", "= 0: the period was never set, the counter stays at 0")
        elif unseen is not None:
            self._report(compare, unseen.name, f"has no pin: {unseen.missing}")

    def old_trip(self) -> None:
        """Report that the latch of a one-shot trip has given its interrupt again, more than once."""
        flag = f"{self._regs.name}.TZFLG.OST"
        self._cpu.findings.report(
            "flag-not-cleared",
            f"{flag} is still set and repeats the interrupt of the same trip: the outputs stay tripped until "
            "TZCLR.OST is written",
            object=flag,
        )  # fmt: skip

    def _report(self, compare: str, what: str, why: str) -> None:
        self._cpu.findings.report(
            "not-configured", f"{self._regs.name}.{compare} was written while {what} {why}", object=what
        )
