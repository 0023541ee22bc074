"""Obstacles that move on a path over virtual time.

Modelled
    A post that moves along a polyline at one speed, from a virtual time on, once or back and forth for ever.  Its place
    follows from the time alone, so that two runs see it in the same places.
Not modelled
    Obstacles that see the robot: one that meets it pushes it aside (`robot.PUSH_M_S`).
Time
    Seconds of virtual time since power-up.  `World` moves it to its place every 10 ms.
Sources
    None.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import hypot


@dataclass(frozen=True, slots=True)
class Mover:
    """A post of the map, by its index there, and its path."""

    post: int
    points: tuple[tuple[float, float], ...]
    speed_m_s: float
    from_s: float = 0.0
    #: Whether it goes back and forth for ever; otherwise it stays at the end.
    and_back: bool = False

    def __reduce__(self) -> tuple[type[Mover], tuple[int, tuple[tuple[float, float], ...], float, float, bool]]:
        """As that of `Segment`."""
        return Mover, (self.post, self.points, self.speed_m_s, self.from_s, self.and_back)

    def at(self, time_s: float) -> tuple[float, float]:
        """Its position at a time."""
        length = sum(hypot(bx - ax, by - ay) for (ax, ay), (bx, by) in pairwise(self.points))
        way = max(0.0, time_s - self.from_s) * self.speed_m_s
        if self.and_back:
            way = way % (2.0 * length)
            way = min(way, 2.0 * length - way)
        for (ax, ay), (bx, by) in pairwise(self.points):
            leg = hypot(bx - ax, by - ay)
            if way <= leg:
                share = way / leg
                return ax + share * (bx - ax), ay + share * (by - ay)
            way -= leg
        return self.points[-1]
