"""The event list of a run: task switches, ready, block, post, Clock ticks, interrupts, with their cycle.

Everything that draws a timeline, measures a task or compares two runs reads this one stream.  With nobody
listening an event costs one attribute test.
"""

from __future__ import annotations

from collections.abc import Callable

from emulator.clock import Clock


class Trace:
    """`trace.emit(kind, name)` tells every listener `(cycles, kind, name)`."""

    __slots__ = ("_clock", "_listeners", "active")

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._listeners: list[Callable[[int, str, str], None]] = []
        self.active = False

    def listen(self, listener: Callable[[int, str, str], None]) -> None:
        """Call `listener(cycles, kind, name)` for every event from now on."""
        self._listeners.append(listener)
        self.active = True

    def emit(self, kind: str, name: str) -> None:
        """Something happened now."""
        if self.active:
            now = self._clock.now
            for listener in self._listeners:
                listener(now, kind, name)
