"""The ramp generator of a CMPSS: a reference that falls by a step each SYSCLK after an ePWM's sync pulse.

RAMPSTS keeps its start value until EPWMSYNCPER comes.  It then waits for RAMPDLYA SYSCLK, and falls by RAMPDECVALA in
each SYSCLK after that, down to 0.  When the comparator's filter output (COMPHSTS) rises, RAMPSTS returns to the start
value and waits for the next pulse.  Its upper twelve bits are the code of the high comparator's DAC.

CHOICE: the first step down is in the SYSCLK after the delay is over.
CHOICE: a step that would go below 0 ends at 0.
Part of `cmpss.py`.  Sources: TRM CMPSS, ramp generator.
"""

from __future__ import annotations

from typing import Final

#: The number of low bits of RAMPSTS that the DAC does not use.
FRACTION_BITS: Final = 4


class Ramp:
    """RAMPSTS, computed on demand.  Times are in SYSCLK cycles."""

    __slots__ = ("_begin", "_start", "_step", "running")

    def __init__(self) -> None:
        self.running = False
        self._start = self._step = self._begin = 0

    def stand(self, start: int) -> None:
        """Stand at `start` until the next `fall`."""
        self.running = False
        self._start = start

    def fall(self, now: int, start: int, step: int, delay: int) -> None:
        """Fall from `start` by `step` each cycle, `delay` cycles from now."""
        self._start, self._step, self._begin = start, step, now + delay
        self.running = True

    def value(self, cycles: int) -> int:
        """RAMPSTS at a time that is not before the last pulse."""
        if not self.running or cycles <= self._begin:
            return self._start
        return max(self._start - self._step * (cycles - self._begin), 0)

    def code(self, cycles: int) -> int:
        """The code of the DAC at that time."""
        return self.value(cycles) >> FRACTION_BITS

    @property
    def end(self) -> int:
        """The cycle from which on it does not fall any more."""
        if not self.running or not self._step:
            return self._begin
        return self._begin - (-self._start // self._step)
