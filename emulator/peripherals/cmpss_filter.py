"""The digital filter of a comparator: samples, a window, a majority; and the latch behind it.

A sample is taken every CLKPRESCALE + 1 SYSCLK.  The output changes if at least THRESH + 1 of the newest SAMPWIN + 1
samples differ from it.  The samples are computed on demand, because the input level changes only by `take`.

CHOICE: a new CLKPRESCALE restarts the sample clock; a new window or threshold takes effect at the next sample.
CHOICE: FILINIT sets all samples to the level of the input, and the output with them.
Part of `cmpss.py`.  Sources: TRM CMPSS, digital filter.
"""

from __future__ import annotations

from typing import Final

from emulator.clock import NEVER

#: Samples of the widest window.
DEPTH: Final = 32
_ALL: Final = (1 << DEPTH) - 1


class DigitalFilter:
    """Samples, output and latch of one comparator.  Times are in SYSCLK cycles."""

    __slots__ = ("_last", "_origin", "_samples", "_threshold", "_window", "latched", "level", "output", "period")

    def __init__(self) -> None:
        self.reset(0)

    def reset(self, now: int) -> None:
        """Input, samples, output and latch 0; one sample each cycle."""
        self.level = self.output = self.latched = 0
        #: The newest sample is bit 0.
        self._samples = 0
        self._window = self._threshold = self.period = 1
        self._origin = now
        #: The number of samples that have been taken since `_origin`.
        self._last = 0

    def configure(self, window: int, threshold: int) -> None:
        """`window` samples, of which `threshold` change the output.  The filter must have been settled."""
        self._window, self._threshold = window, threshold

    def set_period(self, now: int, cycles: int) -> None:
        """A sample every `cycles` from now on.  The filter must have been settled."""
        if cycles != self.period:
            self.period = cycles
            self._origin = now
            self._last = 0

    def initialise(self) -> None:
        """FILINIT: every sample is the input."""
        self._samples = _ALL if self.level else 0
        self._decide()

    def clear(self) -> None:
        """Clear the latch, which an output that is high sets again."""
        self.latched = self.output

    def take(self, now: int, level: int) -> None:
        """The input has this level from `now` on, a sample of this cycle included."""
        self.settle(now - 1)
        self.level = level
        self.settle(now)

    def settle(self, now: int) -> None:
        """Take all samples up to and including `now`."""
        due = (now - self._origin) // self.period
        missing, self._last = due - self._last, max(due, self._last)
        if missing <= 0 or self._settled:
            return
        for _ in range(min(missing, DEPTH)):
            self._sample()

    def next_change(self) -> int:
        """When the output changes if the input stays as it is; NEVER: it does not.  The filter must be settled."""
        if self._settled:
            return NEVER
        wanted, samples = self.level, self._samples
        for n in range(1, DEPTH + 1):
            samples = samples << 1 & _ALL | wanted
            if self._majority(samples):
                return self._origin + (self._last + n) * self.period
        return NEVER

    @property
    def _settled(self) -> bool:
        """Whether all samples equal the input and have had their effect."""
        return self.output == self.level and self._samples == (_ALL if self.level else 0)

    def _majority(self, samples: int) -> bool:
        """Whether enough samples of the window differ from the output."""
        window = samples & (1 << self._window) - 1
        ones = window.bit_count()
        return (self._window - ones if self.output else ones) >= self._threshold

    def _sample(self) -> None:
        self._samples = self._samples << 1 & _ALL | self.level
        self._decide()

    def _decide(self) -> None:
        if self._majority(self._samples):
            self.output ^= 1
        self.latched |= self.output
