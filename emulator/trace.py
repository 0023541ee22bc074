"""The event list of a run: task switches, ready, block, post, Clock ticks, interrupts, with their cycle.

Everything that draws a timeline, measures a task or compares two runs reads this one stream.  With nobody
listening an event costs one attribute test.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from typing import Final

from emulator.clock import Clock

#: Lines that are hashed together.
_TOGETHER: Final = 4096

#: `(cycles, kind, name)` of an event.
Listener = Callable[[int, str, str], None]


class Trace:
    """`trace.emit(kind, name)` tells every listener `(cycles, kind, name)`."""

    __slots__ = ("_clock", "_hash", "_lines", "_listeners", "active", "live")

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._listeners: list[Listener] = []
        #: Lines of the digest that are not hashed yet; None if nobody wants a digest.
        self._lines: list[str] | None = None
        self._hash = hashlib.sha256()
        #: Whether events are wanted at all, and whether somebody looks at the machine when they happen.
        self.active = False
        self.live = False

    def listen(self, listener: Listener, *, live: bool = True) -> None:
        """Call `listener(cycles, kind, name)` for every event from now on.

        One that is not `live` looks at nothing but the event: of ticks that are taken in one step it hears afterwards.
        """
        self._listeners.append(listener)
        self.active = True
        self.live = self.live or live

    def keep_digest(self) -> None:
        """Keep a digest of every event from now on."""
        if self._lines is None:
            self._lines = []
        self.active = True

    @property
    def sha256(self) -> str:
        """The digest: SHA-256 of a line `cycles kind name` for each event; "" if none is kept."""
        if self._lines is None:
            return ""
        self._digest(self._lines)
        return self._hash.hexdigest()

    def emit(self, kind: str, name: str) -> None:
        """Something happened now."""
        now = self._clock.now
        lines = self._lines
        if lines is not None:
            lines.append(f"{now} {kind} {name}\n")
            if len(lines) >= _TOGETHER:
                self._digest(lines)
        for listener in self._listeners:
            listener(now, kind, name)

    def emit_each(self, starts: Iterable[int], events: Iterable[tuple[int, str, str]]) -> None:
        """The same `events` (cycles from a start, kind, name) happened from each of `starts` (cycles) on."""
        lines = self._lines
        for start in starts:
            for after, kind, name in events:
                if lines is not None:
                    lines.append(f"{start + after} {kind} {name}\n")
                for listener in self._listeners:
                    listener(start + after, kind, name)
        if lines is not None and len(lines) >= _TOGETHER:
            self._digest(lines)

    def _digest(self, lines: list[str]) -> None:
        self._hash.update("".join(lines).encode())
        lines.clear()
