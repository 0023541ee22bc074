"""A value over virtual time: one number, points with hold or straight lines between them, a function, a generator.

A `Course` gives its value at any cycle, also at one in the past, because sensors compute their samples late.  Before
its first point it has the first value, after its last point the last.  Nothing here knows a board.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from array import array
from bisect import bisect_right
from collections import deque
from collections.abc import Callable, Iterator
from itertools import islice
from typing import Final

from emulator.clock import CYCLES_PER_MS, NEVER, SYSCLK_HZ
from hil.longest import LONGEST_S

HOW: Final = ("hold", "linear")
#: What cannot be asked when it likes, such as a switch, is moved along a curve in steps of this.
STEP_CYCLES: Final = CYCLES_PER_MS
#: How many points of a generator are remembered for those who ask about the past.
REMEMBERED: Final = 4096


class Course(ABC):
    """A value over virtual time."""

    #: Whether it goes from value to value without jumps.
    smooth = False

    @abstractmethod
    def at(self, cycles: int) -> float:
        """The value at a cycle."""

    @abstractmethod
    def after(self, cycles: int) -> int:
        """The first cycle after `cycles` at which the value may have changed; NEVER: it stays constant."""


class Constant(Course):
    """A constant value."""

    def __init__(self, value: float) -> None:
        self._value = value

    def at(self, cycles: int) -> float:
        """The value at a cycle."""
        return self._value

    def after(self, cycles: int) -> int:
        """NEVER: the value is constant."""
        return NEVER


class Points(Course):
    """Values at times that do not decrease; of several values at one time the last counts."""

    def __init__(self, times: array[int], values: array[float], how: str, origin: int = 0) -> None:
        self._times, self._values = times, values
        self.smooth = how == "linear"
        #: The cycle that is time 0 of the points.
        self._origin = origin

    def at(self, cycles: int) -> float:
        """The value at a cycle."""
        times, values, time = self._times, self._values, cycles - self._origin
        index = bisect_right(times, time)
        if index == 0:
            return values[0]
        before = values[index - 1]
        if not self.smooth or index == len(times):
            return before
        share = (time - times[index - 1]) / (times[index] - times[index - 1])
        return before + share * (values[index] - before)

    def after(self, cycles: int) -> int:
        """The next point, or the next step of the line to it."""
        times = self._times
        index = bisect_right(times, cycles - self._origin)
        if index == len(times):
            return NEVER
        point = times[index] + self._origin
        return min(point, cycles + STEP_CYCLES) if self.smooth and index else point


class Computed(Course):
    """The value of a function of the time in seconds."""

    smooth = True

    def __init__(self, function: Callable[[float], float], check: Callable[[float, float], None], origin: int) -> None:
        self._function, self._check, self._origin = function, check, origin

    def at(self, cycles: int) -> float:
        """The value at a cycle."""
        time_s = (cycles - self._origin) / SYSCLK_HZ
        value = float(self._function(time_s))
        self._check(value, time_s)
        return value

    def after(self, cycles: int) -> int:
        """The next step: a function may change at any time."""
        return cycles + STEP_CYCLES


class GeneratedCourse(Course):
    """The points of a generator, `(time_s, value)` in the order of time.  They are taken from it when they are needed.

    The generator may be endless.  The latest `REMEMBERED` points of the past are kept.
    """

    def __init__(
        self, pairs: Iterator[tuple[float, float]], check: Callable[[float, float], None], how: str, origin: int
    ) -> None:
        self._pairs, self._check, self._origin = pairs, check, origin
        self.smooth = how == "linear"
        self._points: deque[tuple[int, float]] = deque(maxlen=REMEMBERED)
        self._ended = False
        self._draw(-(1 << 62))
        if not self._points:
            raise ValueError("a generator that yields nothing: expected (time_s, value)")

    def at(self, cycles: int) -> float:
        """The value at a cycle."""
        return self._known(cycles).at(cycles)

    def after(self, cycles: int) -> int:
        """The next point, or the next step of the line to it."""
        return self._known(cycles).after(cycles)

    def _known(self, cycles: int) -> Points:
        """The points before and after a cycle."""
        self._draw(cycles - self._origin)
        points = self._points
        first = next((i for i in range(len(points) - 1, -1, -1) if points[i][0] <= cycles - self._origin), 0)
        around = list(islice(points, first, first + 2))
        return Points(
            array("q", [t for t, _ in around]), array("d", [v for _, v in around]),
            "linear" if self.smooth else "hold", self._origin,
        )  # fmt: skip

    def _draw(self, time: int) -> None:
        """Take points from the generator, up to the first one after a cycle."""
        points = self._points
        while not self._ended and (not points or points[-1][0] <= time):
            pair = next(self._pairs, None)
            if pair is None:
                self._ended = True
                return
            time_s, value = map(float, pair)
            self._check(value, time_s)
            cycles = cycles_of(time_s)
            if points and cycles < points[-1][0]:
                raise ValueError(f"time {time_s:g} s comes before the previous time, {points[-1][0] / SYSCLK_HZ:g} s")
            points.append((cycles, value))


def cycles_of(time_s: float) -> int:
    """Convert a time to cycles.  Raises ValueError for a text that is no time, or one beyond a year."""
    if not abs(time_s) <= LONGEST_S:
        raise ValueError(f"time {time_s:g} s: must be a number of seconds, at most a year")
    return round(time_s * SYSCLK_HZ)
