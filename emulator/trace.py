"""The event list of a run: task switches, ready, block, post, Clock ticks, interrupts, with their cycle.

Everything that draws a timeline, measures a task or compares two runs reads this one stream.  With nobody
listening an event costs one attribute test.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import Final

from emulator.clock import Clock

#: Gets an event: its cycle, kind and name.
Listener = Callable[[int, str, str], None]
#: Gets the number of ticks that were taken together, and the cycles of one: its interrupt's, its Swi's.
Joined = Callable[[int, int, int], None]

#: Lines that are hashed together.
_TOGETHER: Final = 4096


class Trace:
    """`trace.emit(kind, name)` tells every listener `(cycles, kind, name)`."""

    __slots__ = (
        "_clock", "_hash", "_joined", "_lines", "_listeners", "_of_kind", "_readers", "_told", "active", "each_tick",
    )  # fmt: skip

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._listeners: list[Listener] = []
        self._of_kind: dict[str, list[Listener]] = {}
        self._joined: list[Joined] = []
        self._readers: list[Listener] = []
        #: Lines of the digest that are not hashed yet; None if nobody wants a digest.
        self._lines: list[str] | None = None
        self._hash = hashlib.sha256()
        #: Whether events are wanted at all; whether somebody is told of them.
        self.active = False
        self._told = False
        #: Whether somebody wants the events of every tick, also of one that finds the CPU idle and calls nothing.
        self.each_tick = False

    def listen(self, listener: Listener, *kinds: str, each_tick: bool = True) -> None:
        """Call `listener(cycles, kind, name)` for every event from now on, or only for those of some kinds.

        `each_tick` False: not for those of ticks that are taken together (`on_joined_ticks`).
        """
        self.each_tick = self.each_tick or each_tick
        if not kinds:
            self._listeners.append(listener)
        for kind in kinds:
            self._of_kind.setdefault(kind, []).append(listener)
        self.active = self._told = True

    def read(self, reader: Listener) -> None:
        """The same for every event and one that looks at nothing else: of ticks taken together it hears afterwards."""
        self._listeners.append(reader)
        self._readers.append(reader)
        self.active = self._told = True

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

    def on_joined_ticks(self, listener: Joined) -> None:
        """Call `listener(count, interrupt_cycles, swi_cycles)` when ticks have passed that nobody was told of.

        Each found the CPU idle, and occupied it for so many cycles by its interrupt and by the Clock Swi.
        """
        self._joined.append(listener)

    def joined_ticks(
        self, starts: range, interrupt_cycles: int, swi_cycles: int, events: tuple[tuple[int, str, str], ...]
    ) -> None:
        """Ticks have been taken together, each with the same `events`: cycles from its start, kind, name."""
        for listener in self._joined:
            listener(len(starts), interrupt_cycles, swi_cycles)
        if self._lines is not None:
            self._lines += [f"{start + after} {kind} {name}\n" for start in starts for after, kind, name in events]
        for reader in self._readers:
            for start in starts:
                for after, kind, name in events:
                    reader(start + after, kind, name)

    def emit(self, kind: str, name: str) -> None:
        """Something happened now."""
        now = self._clock.now
        lines = self._lines
        if lines is not None:
            lines.append(f"{now} {kind} {name}\n")
            if len(lines) >= _TOGETHER:
                self._digest(lines)
        if self._told:
            for listener in self._listeners:
                listener(now, kind, name)
            for listener in self._of_kind.get(kind, ()):
                listener(now, kind, name)

    def _digest(self, lines: list[str]) -> None:
        self._hash.update("".join(lines).encode())
        lines.clear()
