"""The event list of a run: task switches, ready, block, post, Clock ticks, interrupts, with their cycle.

Everything that draws a timeline, measures a task or compares two runs reads this one stream.  With nobody
listening an event costs one attribute test.
"""

from __future__ import annotations

from collections.abc import Callable

from emulator.clock import Clock

#: Gets an event: its cycle, kind and name.
Listener = Callable[[int, str, str], None]
#: Gets the number of ticks that were taken together, and the cycles of one: its interrupt's, its Swi's.
Joined = Callable[[int, int, int], None]


class Trace:
    """`trace.emit(kind, name)` tells every listener `(cycles, kind, name)`."""

    __slots__ = ("_clock", "_joined", "_listeners", "_of_kind", "active", "each_tick")

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._listeners: list[Listener] = []
        self._of_kind: dict[str, list[Listener]] = {}
        self._joined: list[Joined] = []
        self.active = False
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
        self.active = True

    def on_joined_ticks(self, listener: Joined) -> None:
        """Call `listener(count, interrupt_cycles, swi_cycles)` when ticks have passed that nobody was told of.

        Each found the CPU idle, and occupied it for so many cycles by its interrupt and by the Clock Swi.
        """
        self._joined.append(listener)

    def joined_ticks(self, count: int, interrupt_cycles: int, swi_cycles: int) -> None:
        """Ticks have been taken together."""
        for listener in self._joined:
            listener(count, interrupt_cycles, swi_cycles)

    def emit(self, kind: str, name: str) -> None:
        """Something happened now."""
        if self.active:
            now = self._clock.now
            for listener in self._listeners:
                listener(now, kind, name)
            for listener in self._of_kind.get(kind, ()):
                listener(now, kind, name)
