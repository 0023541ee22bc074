"""The interrupt generator of the L3G4200D: thresholds, AND/OR, duration, latch.

Modelled: INT1_CFG, INT1_THS_*, INT1_DURATION with WAIT, INT1_SRC and its latch.
Not modelled: nothing of the data sheet.
Time: one step for each sample; the device calls `step` in order.
Sources: L3G section on INT1_CFG, INT1_SRC, INT1_THS, INT1_DURATION.
"""

from __future__ import annotations

from typing import Final

AND_OR: Final = 0x80
LIR: Final = 0x40
ENABLES: Final = 0x3F
IA: Final = 0x40


class InterruptGenerator:
    """INT1.  `active` is the internal interrupt signal; the device puts it on the pin."""

    __slots__ = ("_count", "active", "config", "duration", "enabled", "source", "thresholds", "wait")

    def __init__(self) -> None:
        self.config = 0
        #: Whether any event is enabled.
        self.enabled = False
        self.thresholds = [0, 0, 0]
        self.duration = 0
        self.wait = False
        self.source = 0
        self.active = False
        self._count = 0

    def configure(self, config: int, thresholds: list[int], duration: int) -> None:
        """INT1_CFG, the three 15-bit magnitudes and INT1_DURATION as written."""
        self.config = config
        self.thresholds = thresholds
        self.duration = duration & 0x7F
        self.wait = bool(duration & 0x80)
        self.enabled = bool(config & ENABLES)
        if not self.enabled:
            self.source = 0
            self.active = False
            self._count = 0

    def step(self, digits: tuple[int, int, int]) -> bool:
        """One sample of the path that INT1_Sel selects; returns True when the interrupt becomes active.

        High event: |v| > threshold; low event: |v| < threshold.
        CHOICE: the duration is the time since the first sample of the condition, so D = 0 acts on the first sample
        and D = n on the n-th after it; with WAIT the interrupt ends on the n-th sample of absence.  INT1_SRC shows
        enabled events only, and a latched one stays as it was at its event.
        """
        enables = self.config & ENABLES
        if not enables:
            return False
        events = 0
        for axis in range(3):
            magnitude = abs(digits[axis])
            if magnitude > self.thresholds[axis]:
                events |= 2 << 2 * axis
            elif magnitude < self.thresholds[axis]:
                events |= 1 << 2 * axis
        events &= enables
        condition = events == enables if self.config & AND_OR else bool(events)
        limit = self.duration + 1
        if condition:
            self._count = min(self._count + 1, limit)
        elif self._count:
            self._count -= 1
        was = self.active
        latched = was and bool(self.config & LIR)
        if condition and self._count >= limit:
            self.active = True
        elif not condition and not latched and (not self.wait or self._count <= 1):
            self.active = False
        if not latched:
            self.source = IA | events if self.active else events
        return self.active and not was

    def read_source(self) -> int:
        """INT1_SRC as read: clears a latched IA, and with it the pin."""
        word = self.source
        if self.config & LIR:
            self.source = 0
            self.active = False
            self._count = 0
        return word
