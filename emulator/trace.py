"""The event list of a run: task switches, ready, block, post, Clock ticks, interrupts, with their cycle.

All code that draws a timeline, measures a task or compares two runs reads this one stream.  Without a listener an
event costs one attribute test.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.clock import Clock
from emulator.signal import Signal

#: A listener; it gets the cycle, kind and name of an event.
Listener = Callable[[int, str, str], None]

#: The number of lines that are hashed together.
_TOGETHER: Final = 4096


class Trace:
    """`trace.emit(kind, name)` calls every listener with `(cycles, kind, name)`."""

    __slots__ = (
        "_clock",
        "_every",
        "_has_listeners",
        "_hash",
        "_latest",
        "_lines",
        "_listening",
        "_of_kind",
        "_read",
        "active",
        "each_tick",
        "ticks_joined",
    )  # fmt: skip

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._every: Signal[int, str, str] = Signal()
        self._of_kind: dict[str, Signal[int, str, str]] = {}
        self._read: Signal[int, str, str] = Signal()
        #: The connections: the function that ends each, and whether it wants the events of every tick.
        self._listening: dict[int, tuple[list[Callable[[], None]], bool]] = {}
        self._latest = 0
        #: (count, interrupt_cycles, swi_cycles): ticks have passed without trace events.  Each found the CPU idle.  Its
        #: interrupt and the Clock Swi occupied the CPU for so many cycles each.
        self.ticks_joined: Signal[int, int, int] = Signal()
        #: Lines of the digest that are not hashed yet; None if no digest is kept.
        self._lines: list[str] | None = None
        self._hash = hashlib.sha256()
        #: Whether events are needed at all; whether there is a listener.
        self.active = False
        self._has_listeners = False
        #: Whether a listener wants the events of every tick, even of one that finds the CPU idle and calls nothing.
        self.each_tick = False

    def listen(self, listener: Listener, *kinds: str, each_tick: bool = True) -> Callable[[], None]:
        """Call `listener(cycles, kind, name)` for every event from now on, or only for those of some kinds.

        Returns a function that ends this.  With `each_tick` False, the events of ticks that are taken together are left
        out (`ticks_joined`).
        """
        signals = [self._of_kind.setdefault(kind, Signal()) for kind in kinds] or [self._every]
        return self._begin([signal.connect(listener) for signal in signals], each_tick)

    def read(self, reader: Listener) -> Callable[[], None]:
        """Call `reader` for every event; it must only read the event itself.

        It gets the events of ticks that are taken together after these have passed.  Returns a function that ends this.
        """
        return self._begin([self._every.connect(reader), self._read.connect(reader)], False)

    def _begin(self, stops: list[Callable[[], None]], each_tick: bool) -> Callable[[], None]:
        self._latest += 1
        self._listening[self._latest] = stops, each_tick
        self._decide()
        return partial(self._end, self._latest)

    def _end(self, number: int) -> None:
        ended = self._listening.pop(number, None)
        if ended is not None:
            for stop in ended[0]:
                stop()
            self._decide()

    def _decide(self) -> None:
        self._has_listeners = bool(self._listening)
        self.active = self._has_listeners or self._lines is not None
        self.each_tick = any(each_tick for _, each_tick in self._listening.values())

    def keep_digest(self) -> None:
        """Keep a digest of every event from now on."""
        if self._lines is None:
            self._lines = []
        self._decide()

    @property
    def sha256(self) -> str:
        """The digest: SHA-256 of a line `cycles kind name` for each event; "" if none is kept."""
        if self._lines is None:
            return ""
        self._digest(self._lines)
        return self._hash.hexdigest()

    def joined_ticks(
        self, starts: range, interrupt_cycles: int, swi_cycles: int, events: tuple[tuple[int, str, str], ...]
    ) -> None:
        """Ticks have been taken together, each with the same `events`: cycles from its start, kind, name."""
        self.ticks_joined.emit(len(starts), interrupt_cycles, swi_cycles)
        if self._lines is not None:
            self._lines += [f"{start + after} {kind} {name}\n" for start in starts for after, kind, name in events]
        for reader in self._read.listeners:
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
        if self._has_listeners:
            for listener in self._every.listeners:
                listener(now, kind, name)
            of_kind = self._of_kind.get(kind)
            if of_kind is not None:
                for listener in of_kind.listeners:
                    listener(now, kind, name)

    def _digest(self, lines: list[str]) -> None:
        self._hash.update("".join(lines).encode())
        lines.clear()
