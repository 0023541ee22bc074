"""The AN output of the LV-MaxSonar-EZ: a held voltage that moves to its new value after the echo.

Modelled: Vcc / 512 for each inch, hold, the slew between the echo and 44.3 ms of the cycle, incomplete long steps,
ripple.
Not modelled: droop of the held value (no figure), output impedance.
Time: a pure function of cycles since the last `move`; no events.
Sources: EZ pin description AN, timing description.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

from mypy_extensions import i64

from emulator.clock import CYCLES_PER_US, NEVER
from emulator.signals import AnalogSource

#: Time constant of an upward step.  CHOICE: first order; 90 % of a step to "no target", whose listening time ends at
#: 37.5 ms, is done at 44.3 ms, so tau = 6.8 ms / ln 10.  Nearer targets leave more time and complete their step, which
#: is why only long ranges after short ones fall short.
RISE_TAU: Final = 6_800 * CYCLES_PER_US / math.log(10.0)

#: The ripple is constant for this many cycles.
_RIPPLE_HOLD: Final = 100 * CYCLES_PER_US


class HeldVoltage(AnalogSource):
    """The source of the analog wire.  `ripple_v` is the greatest ripple, `salt` its seed."""

    __slots__ = (
        "_calm_from", "_calm_until", "_calm_v", "_converted", "_linear", "_quiet_until", "_ripple_now", "_slot",
        "_steady_v", "end", "from_v", "ripple_v", "rise_tau", "salt", "start", "target_v",
    )  # fmt: skip

    def __init__(
        self, volts: float, ripple_v: float = 0.0, salt: int = 0,
        converted: Callable[[HeldVoltage, int, float], int] | None = None,
    ) -> None:  # fmt: skip
        """`converted(this, cycles, volts)` is called at a conversion; it returns when it must be called next."""
        self.ripple_v = ripple_v
        self.salt = salt
        self.rise_tau = RISE_TAU
        # The ripple of the latest slot.
        self._slot = -1
        self._ripple_now = 0.0
        #: The latest move: cycles and volts.
        self.start = 0
        self.end = 0
        self.from_v = volts
        self.target_v = volts
        #: The voltage that is held from `end` on.
        self._steady_v = volts
        self._linear = True
        # The voltage and the cycles for which it does not change.  Samples come in groups, so this saves time.
        self._calm_from = 0
        self._calm_until = 0
        self._calm_v = volts
        self._converted = converted
        self._quiet_until = 0

    def set_conversion_callback(self, converted: Callable[[HeldVoltage, int, float], int] | None) -> None:
        """Set the function that is called at conversions from now on."""
        self._converted = converted
        self._calm_from = self._calm_until = self._quiet_until = 0

    def move(self, target_v: float, start: int, end: int, *, finish: bool) -> None:
        """Slew from the present value to `target_v` between the cycles `start` and `end`.

        Downward, or with `finish` (the reading repeats), the target is reached in a straight line (CHOICE); upward the
        approach is exponential and may fall short.
        """
        present = self._level(start)
        self.from_v = present
        self.target_v = target_v
        self.start = start
        self.end = end
        self._linear = finish or target_v <= present
        if end <= start or target_v == present:
            self.end = start
            self._steady_v = target_v
        elif self._linear:
            self._steady_v = target_v
        else:
            self._steady_v = self._level(end - 1)
        self._calm_from = self._calm_until = self._quiet_until = 0

    def volts(self, cycles: int) -> float:
        """The voltage at virtual time `cycles`."""
        if self._calm_from <= cycles < self._calm_until:
            return self._calm_v
        if cycles >= self.end:
            begin, until = self.end, NEVER
        elif cycles <= self.start:
            begin, until = 0, min(self.start + 1, self.end)
        else:
            begin = until = 0
        v = self._level(cycles)
        if self.ripple_v:
            slot = cycles // _RIPPLE_HOLD
            if slot != self._slot:
                self._slot = slot
                self._ripple_now = self.ripple_v * self._noise(slot)
            v += self._ripple_now
            begin, until = max(begin, slot * _RIPPLE_HOLD), min(until, (slot + 1) * _RIPPLE_HOLD)
        if self._converted is not None:
            if cycles >= self._quiet_until:
                self._quiet_until = self._converted(self, cycles, v)
            if self._quiet_until < until:
                until = self._quiet_until
        self._calm_from, self._calm_until, self._calm_v = begin, until, v
        return v

    def _level(self, cycles: int) -> float:
        if cycles >= self.end:
            return self._steady_v
        if cycles <= self.start:
            return self.from_v
        step = self.target_v - self.from_v
        if self._linear:
            return self.from_v + step * (cycles - self.start) / (self.end - self.start)
        return self.from_v + step * -math.expm1(-(cycles - self.start) / self.rise_tau)

    def _noise(self, slot: int) -> float:
        """A value in -1..1 that depends only on the slot, however often it is asked for."""
        # Machine words, of which only the low 32 bits count.
        s: i64 = slot & 0xFFFFFFFF
        salt: i64 = self.salt & 0xFFFFFFFF
        h: i64 = (s * 0x9E3779B1 ^ salt * 0x85EBCA6B) & 0xFFFFFFFF
        h = (h ^ h >> 15) * 0x2C1B3C6D & 0xFFFFFFFF
        h = (h ^ h >> 12) * 0x297A2D39 & 0xFFFFFFFF
        return (h ^ h >> 15) / 0x7FFFFFFF - 1.0
