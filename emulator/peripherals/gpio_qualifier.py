"""Input qualification of one pin: a level counts after 3 or 6 equal samples.

Modelled: samples at the multiples of the sampling period since cycle 0; consecutive equal samples; a glitch between two
samples is not seen.
Not modelled: a period that changes while a level is being qualified (it applies from the next edge on).
Time: one clock event for each edge that may become valid; none while the pin is quiet.
Sources: TRM GPIO, qualification using a sampling window.
"""

from __future__ import annotations

from collections.abc import Callable

from emulator.clock import Clock, ClockEvent


class InputQualifier:
    """Filters the level of one pin.  `period_cycles()` is the sampling period, `accepted(level)` takes the result.

    CHOICE: the phase of the sampling counter is that of a counter that started at cycle 0.
    """

    __slots__ = (
        "_accepted", "_clock", "_event", "_first_sample", "_left", "_period_cycles", "edges", "level", "passed",
        "samples",
    )  # fmt: skip

    def __init__(
        self,
        clock: Clock,
        level: int,
        samples: int,
        period_cycles: Callable[[], int],
        accepted: Callable[[int], None],
    ) -> None:
        self._clock = clock
        self._period_cycles = period_cycles
        self._accepted = accepted
        self._event: ClockEvent | None = None
        #: The first sample of a run of samples that differ from the output, and the first sample after the run ended.
        self._first_sample = self._left = -1
        self.level = level
        self.samples = samples
        #: The number of the pin's edges, and how many of them passed.
        self.edges = self.passed = 0

    def window_cycles(self) -> int:
        """The shortest time that a level must last to count, in cycles."""
        return (self.samples - 1) * self._period_cycles()

    def change(self, level: int) -> None:
        """The pin has changed to `level`."""
        self.edges += 1
        period = self._period_cycles()
        sample = -(-self._clock.now // period)
        if level == self.level:
            self._clock.cancel(self._event)
            self._event = None
            self._left = sample
            return
        if sample != self._left:
            # A sample has seen the old level meanwhile, or there was no run: a new run begins.
            self._first_sample = sample
        last_sample = max((self._first_sample + self.samples - 1) * period, self._clock.now)
        # Among equal times it runs last, after the edges of an ePWM: a sample sees the level at the end of its cycle.
        self._event = self._clock.schedule(last_sample, self._qualified, priority=2)

    def stop(self) -> None:
        """Qualification was switched off."""
        self._clock.cancel(self._event)
        self._event = None

    def _qualified(self) -> None:
        self._event = None
        self.passed += 1
        self.level ^= 1
        self._left = -1
        self._accepted(self.level)
