"""The event list of a run: task switches, ready, block, post, Clock ticks, interrupts, with their cycle.

Everything that draws a timeline, measures a task or compares two runs reads this one stream.  With nobody
listening an event costs one attribute test.
"""

from __future__ import annotations

from collections.abc import Callable

from emulator.clock import Clock

#: Gets an event: its cycle, kind and name.
Listener = Callable[[int, str, str], None]


class Trace:
    """`trace.emit(kind, name)` tells every listener `(cycles, kind, name)`."""

    __slots__ = ("_clock", "_listeners", "_of_kind", "active")

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._listeners: list[Listener] = []
        self._of_kind: dict[str, list[Listener]] = {}
        self.active = False

    def listen(self, listener: Listener, *kinds: str) -> None:
        """Call `listener(cycles, kind, name)` for every event from now on, or only for those of some kinds."""
        if not kinds:
            self._listeners.append(listener)
        for kind in kinds:
            self._of_kind.setdefault(kind, []).append(listener)
        self.active = True

    def emit(self, kind: str, name: str) -> None:
        """Something happened now."""
        if self.active:
            now = self._clock.now
            for listener in self._listeners:
                listener(now, kind, name)
            for listener in self._of_kind.get(kind, ()):
                listener(now, kind, name)
