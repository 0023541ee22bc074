"""The positions of an object in order of time, in bounded memory."""

from __future__ import annotations

from array import array
from typing import Final

from emulator.signal import Signal

#: (time_s, x_m, y_m, heading_rad)
Point = tuple[float, float, float, float]

#: CHOICE: more points than any picture shows; they take 640 kB.
MAX_POINTS: Final = 20_000
_FIELDS: Final = 4


class Path:
    """At most `most` points.  When full, it drops every second point, and from then on keeps half as many new ones."""

    def __init__(self, most: int = MAX_POINTS) -> None:
        self._most = most
        self._values = array("d")
        self._every = 1
        self._given = 0
        #: (time_s, x_m, y_m, heading_rad): each point, kept or not.
        self.added: Signal[float, float, float, float] = Signal()

    def __len__(self) -> int:
        return len(self._values) // _FIELDS

    def add(self, time_s: float, x_m: float, y_m: float, heading_rad: float) -> None:
        """The next point."""
        self.added.emit(time_s, x_m, y_m, heading_rad)
        self._given += 1
        if (self._given - 1) % self._every:
            return
        self._values.extend((time_s, x_m, y_m, heading_rad))
        if len(self) > self._most:
            self._every *= 2
            kept = self.points(every=2)
            self._values = array("d", [value for point in kept for value in point])

    def clear(self) -> None:
        """Begin anew."""
        self._values = array("d")
        self._every, self._given = 1, 0

    def points(self, every: int = 1) -> list[Point]:
        """Each point, or the first and each `every`-th after it."""
        step = _FIELDS * every
        t, x, y, heading = [self._values[field::step] for field in range(_FIELDS)]
        return list(zip(t, x, y, heading, strict=True))
