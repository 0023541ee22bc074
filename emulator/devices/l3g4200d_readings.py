"""Finds drivers that misread the samples of the L3G4200D: an old sample taken as new, too often, too early, or torn.

Nothing here changes the answers of the device.  A driver that runs at the data rate may read one sample twice (of one
axis, counted at its high byte), because two clocks are never equal.  Reported are (CHOICE of the figures):

* `stale-sample`: three reads or more of one sample in a row, the first two within a quarter of a sample period (four
  or more otherwise); or more than a fifth of `WINDOW` reads repeated, each within a quarter of a period of the last;
* `polling-above-rate`: more than a fifth of `WINDOW` reads repeated, spread over the period.

A driver that reads STATUS_REG or DRDY first never repeats a sample.  After a window that was reported, `PAUSE` windows
are not checked, because keeping the calls takes time.

Sources: L3G section on output data rate, CTRL_REG4 (BDU).  The sheet gives no turn-on time: drivers of the part wait
300 ms, and this model's specimens settle within 250 to 300 ms, so reads of samples of the first 250 ms are reported.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US, SYSCLK_HZ, Clock
from emulator.devices.report import DeviceReport, Mark, ReportedFinding, shared

TURN_ON_CYCLES: Final = 250 * CYCLES_PER_MS
#: The number of reads in a window, and the part of them that may repeat a sample: 1/TOLERATED.
WINDOW: Final = 20
TOLERATED: Final = 5
PAUSE: Final = 15


class _Axis:
    """The reads of one axis."""

    __slots__ = ("above", "at", "both", "finding", "first", "longest", "mark", "name", "number", "pause",
                 "rate_hz", "reads", "repeats", "run", "run_at")  # fmt: skip

    def __init__(self, name: str) -> None:
        self.name = name
        #: The sample of the latest read, when it was read, how often in a row, and since when.
        self.number = self.at = self.run = self.run_at = 0
        #: The calls of an earlier read of this run, those that a later read shared, and the finding about the run.
        self.mark: Mark = ()
        self.both: Mark = ()
        self.finding: ReportedFinding | None = None
        #: The window: number of reads, repeats, longest run, time of the first read.
        self.reads = self.repeats = self.longest = self.first = 0
        #: The number of windows that need not be checked.
        self.pause = 0
        #: After a window with too many repeats: repeats in it, its rate, and the calls of its last read.
        self.above: tuple[int, Mark] | None = None
        self.rate_hz = 0.0


class GyroReadings:
    """Watches reads of the output registers.  `period` is cycles a sample, `settled_at` the end of the turn-on."""

    __slots__ = ("_axes", "_clock", "_mark", "_report", "period", "settled_at")

    def __init__(self, clock: Clock, report: DeviceReport, mark: Callable[[], Mark]) -> None:
        self._clock, self._report, self._mark = clock, report, mark
        self._axes = tuple(_Axis(f"OUT_{axis}") for axis in "XYZ")
        self.period = 0
        self.settled_at = 0

    def taken(self, axis: int, number: int, cycles: int) -> None:
        """The high byte of sample `number`, taken by the device at `cycles`, was read."""
        now = self._clock.now
        a = self._axes[axis]
        if cycles < self.settled_at:
            self._unsettled(a, number, cycles)
        if not a.reads:
            a.first = now
        a.reads += 1
        if number != a.number:
            a.number, a.run, a.run_at, a.mark, a.finding = number, 1, now, (), None
        elif number:
            self._again(a, now)
        a.at = now
        if a.reads >= WINDOW:
            self._check_window(a, now)

    def _again(self, a: _Axis, now: int) -> None:
        a.run += 1
        a.repeats += 1
        a.longest = max(a.longest, a.run)
        gap = now - a.at
        if a.above is not None:
            self._tell_window(a, *a.above, gap)
            a.above = None
        if a.finding is not None:
            self._grow(a, a.finding, now)
        elif a.mark:
            a.both = shared(a.mark, self._mark())
            a.finding = self._report(
                "stale-sample", self._run_text(a, now), object=f"L3G4200D.{a.name}", value=a.run, since=a.mark
            )
        elif a.run > 2 or 4 * gap < self.period:
            a.mark = self._mark()

    def _grow(self, a: _Axis, finding: ReportedFinding, now: int) -> None:
        """Update the finding of a run that goes on.  Another place in the firmware begins another run."""
        if shared(a.mark, self._mark()) is not a.both:
            a.run, a.run_at, a.mark, a.finding = 1, now, (), None
        elif isinstance(finding.value, int) and a.run > finding.value:
            finding.value, finding.message = a.run, self._run_text(a, now)

    def _run_text(self, a: _Axis, now: int) -> str:
        spent_ms = (now - a.run_at) / CYCLES_PER_MS
        rate = f"a sample lasts {self.period / CYCLES_PER_MS:.2f} ms" if self.period else "it takes no samples now"
        return f"{a.run} reads of L3G4200D.{a.name} in {spent_ms:.2f} ms gave 1 sample, no. {a.number}: {rate}"

    def _check_window(self, a: _Axis, now: int) -> None:
        """The window is full: judge it."""
        if a.pause:
            a.pause -= 1
        elif a.repeats * TOLERATED > a.reads and a.longest < 3:
            a.pause = PAUSE
            a.above = (a.repeats, self._mark())
            a.rate_hz = (a.reads - 1) * SYSCLK_HZ / max(1, now - a.first)
        a.reads = a.repeats = a.longest = 0

    def _tell_window(self, a: _Axis, repeats: int, mark: Mark, gap: int) -> None:
        name = f"L3G4200D.{a.name}"
        if 4 * gap < self.period:
            message = (
                f"{repeats} of {WINDOW} reads of {name} gave a sample that was already read: this one "
                f"{gap / CYCLES_PER_US:.0f} us after the last read, while a sample lasts "
                f"{self.period / CYCLES_PER_MS:.2f} ms"
            )
            self._report("stale-sample", message, object=name, value=repeats, since=mark)
        elif self.period:
            data_rate = SYSCLK_HZ / self.period
            message = (
                f"{name} is read {a.rate_hz:.1f} times a second and sampled {data_rate:.1f} times: {repeats} of "
                f"{WINDOW} reads gave a sample that was already read"
            )
            value = round(a.rate_hz / data_rate, 2)
            self._report("polling-above-rate", message, object=name, value=value, since=mark)

    def _unsettled(self, a: _Axis, number: int, cycles: int) -> None:
        name = f"L3G4200D.{a.name}"
        left_power_down = self.settled_at - TURN_ON_CYCLES
        if number and cycles >= left_power_down:
            age_ms = (cycles - left_power_down) / CYCLES_PER_MS
            message = f"a sample taken {age_ms:.1f} ms after power-down was read from {name}: it settles for 250 ms"
        else:
            age_ms = (self._clock.now - left_power_down) / CYCLES_PER_MS
            message = f"{name} was read {age_ms:.2f} ms after power-down ended, before the first sample"
        self._report("startup-read", message, object=name, value=round(age_ms, 3))

    def torn(self, axis: int, low: int, high: int) -> None:
        """Report a value whose two bytes came from different samples, `low` and `high`."""
        name = f"L3G4200D.{self._axes[axis].name}"
        self._report(
            "spread-read",
            f"the low byte of {name} is of sample {low} and the high byte of sample {high}: CTRL_REG4.BDU = 0 lets "
            "the outputs change between the two reads",
            object=name, value=high - low,
        )  # fmt: skip

    def idle(self, axis: int, powered: bool) -> None:
        """Report the read of an output that is never filled."""
        a = self._axes[axis]
        bit = f"{a.name[-1]}en" if powered else "PD"
        why = "the axis is disabled" if powered else "the device is in power-down"
        self._report(
            "not-configured", f"L3G4200D.{a.name} was read while CTRL_REG1.{bit} = 0: {why}, and the value is old",
            object=f"L3G4200D.CTRL_REG1.{bit}",
        )  # fmt: skip

    def bypassed(self) -> None:
        """Report the read of an output with the FIFO enabled and in bypass mode."""
        self._report(
            "fifo-bypassed",
            "L3G4200D.CTRL_REG5.FIFO_EN = 1 and FIFO_CTRL_REG.FM = 0 (bypass): the FIFO holds nothing, and the outputs "
            "give the newest sample only",
            object="L3G4200D.FIFO_CTRL_REG.FM",
        )  # fmt: skip
