"""Draws the arena from the robot's frames: its path, what its sonars saw, its heading.

As in the thesis console everything rests on the frame's own pose, whose heading is in whole radians: the point cloud
turns in steps of 57 degrees.  North is up, the frame's x axis points to the right, both axes have one scale.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from hil.client.decode import OdometryFrame
from hil.client.plot import Point, sonar_points
from hil.terminal.canvas import BRAILLE, Canvas, Layer, Raster

#: Remembered: 20 minutes of a moving robot.
MAX_POSES: Final = 4800
MAX_ECHOES: Final = 3 * MAX_POSES
#: The least that is shown, so that a robot at rest is no microscope picture.
MIN_EXTENT_M: Final = 1.0
#: Dots left free at the rim.
MARGIN: Final = 1
#: Dots of the line that shows the heading.
HEADING_DOTS: Final = 8
_ARROWS: Final = "→↗↑↖←↙↓↘"


@dataclass(frozen=True, slots=True)
class View:
    """A window onto the plane: its middle, and the metres per dot, the same in both directions."""

    x_m: float
    y_m: float
    m_per_dot: float
    width: int
    height: int

    @staticmethod
    def fit(points: Iterable[Point], width: int, height: int) -> View:
        """The closest view of `width` x `height` dots that shows all points; steps of 26 % keep it from trembling."""
        known = list(points) or [(0.0, 0.0)]
        left, right = min(x for x, _ in known), max(x for x, _ in known)
        low, high = min(y for _, y in known), max(y for _, y in known)
        # A dot more than the margin: rounding may move a point by one.
        across, up = (max(1, dots - 2 * MARGIN - 1) for dots in (width, height))
        needed = max((right - left) / across, (high - low) / up, MIN_EXTENT_M / min(across, up))
        m_per_dot = 10 ** (math.ceil(10 * math.log10(needed)) / 10)
        return View((left + right) / 2, (low + high) / 2, m_per_dot, width, height)

    def dot(self, x_m: float, y_m: float) -> tuple[int, int]:
        """The dot of a point."""
        x = (x_m - self.x_m) / self.m_per_dot + (self.width - 1) / 2
        y = (self.y_m - y_m) / self.m_per_dot + (self.height - 1) / 2
        return round(x), round(y)


class ArenaHistory:
    """The frames' poses and sonar points so far; the oldest are dropped."""

    def __init__(self) -> None:
        self._path: deque[Point] = deque(maxlen=MAX_POSES)
        self._echoes: deque[Point] = deque(maxlen=MAX_ECHOES)
        self._last: OdometryFrame | None = None

    def add(self, frame: OdometryFrame) -> None:
        """Add a frame, unless it equals the last one."""
        if frame == self._last:
            return
        self._last = frame
        self._path.append((frame.x_mm / 1e3, frame.y_mm / 1e3))
        self._echoes.extend(sonar_points(frame))

    def clear(self) -> None:
        """Clear the history."""
        self._path.clear()
        self._echoes.clear()
        self._last = None

    def draw(self, columns: int, rows: int, raster: Raster = BRAILLE) -> Canvas:
        """Draw the picture in `columns` x `rows` characters."""
        canvas = Canvas(columns, rows, raster)
        if not canvas.columns or not canvas.rows:
            return canvas
        view = View.fit([*self._path, *self._echoes], canvas.width, canvas.height)
        for points, layer in ((self._echoes, Layer.CLOUD), (self._path, Layer.PATH)):
            for x_m, y_m in points:
                canvas.dot(*view.dot(x_m, y_m), layer)
        if self._last is not None:
            _draw_robot(canvas, view, self._last)
        canvas.write(0, canvas.rows - 1, scale_bar(view.m_per_dot * raster.across, canvas.columns))
        return canvas


def _draw_robot(canvas: Canvas, view: View, frame: OdometryFrame) -> None:
    """Draw the robot: its place as an arrow, its heading as a line."""
    x, y = view.dot(frame.x_mm / 1e3, frame.y_mm / 1e3)
    heading = float(frame.theta_rad)
    for step in range(1, HEADING_DOTS + 1):
        canvas.dot(round(x + step * math.cos(heading)), round(y - step * math.sin(heading)), Layer.ROBOT)
    canvas.write(x // canvas.raster.across, y // canvas.raster.down, arrow(heading), Layer.ROBOT)


def arrow(heading_rad: float) -> str:
    """The nearest of eight arrows."""
    return _ARROWS[round(heading_rad / (math.pi / 4)) % 8]


def scale_bar(m_per_column: float, columns: int) -> str:
    """A bar of 1, 2 or 5 times a power of ten metres, at most a third of the width; "" where there is no room."""
    most_m = m_per_column * columns / 3
    power = 10.0 ** math.floor(math.log10(most_m))
    length_m = next(factor * power for factor in (5, 2, 1) if factor * power <= most_m or factor == 1)
    length = round(length_m / m_per_column)
    text = "├" + "─" * (length - 2) + f"┤ {length_m:g} m"
    return text if length >= 2 and len(text) <= columns else ""
