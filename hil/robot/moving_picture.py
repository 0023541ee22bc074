"""A drive as a moving picture: the robot in its world, what its sonars see, and its own estimate of its pose."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from math import cos, sin
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from hil.client.decode import OdometryFrame
from hil.client.plot import place, sonar_points
from hil.extras import require
from hil.files import replacing
from hil.machine import PathPoint, RobotMachine
from hil.world.robot_params import RobotParams

if TYPE_CHECKING:
    from PIL.Image import Image

#: The picture runs faster by this factor, at this many pictures a second; the last picture stays for a while.
SPEED: Final = 8.0
RATE_HZ: Final = 10
LAST_MS: Final = 1500
#: The number of pictures that take half a second of CPU time.
FEW: Final = 30
#: Flat colours need no more.
_COLOURS: Final = 32
_WIDTH_IN, _DPI = 7.0, 100
#: Margin around the walls in m.
_MARGIN_M: Final = 0.3
#: A drive in a world without walls is drawn in a square as large as this at least.
_MIN_M: Final = 1.0


def save_moving(
    path: Path, robot: RobotMachine, frames: Sequence[tuple[float, OdometryFrame]], title: str, *, hurried: bool = False
) -> bool:
    """Write the drive up to now as a GIF; `frames` are those that it has sent, each with the virtual time at its end.

    `hurried`: use no more than `FEW` pictures.  Returns whether no picture was left out.
    """
    require("matplotlib")
    from PIL.Image import Dither

    drawn = _Scene(robot, frames, title)
    true_path = robot.true_path()
    first_s, last_s = true_path[0].time_s, true_path[-1].time_s
    wanted = max(2, round((last_s - first_s) / SPEED * RATE_HZ))
    count = min(wanted, FEW) if hurried else wanted
    pictures = [drawn.at(first_s + (last_s - first_s) * number / (count - 1)) for number in range(count)]
    # One palette for all: the last picture has every colour.
    palette = pictures[-1].quantize(_COLOURS)
    shown = [picture.quantize(palette=palette, dither=Dither.NONE) for picture in pictures]
    durations = [1000 // RATE_HZ] * (count - 1) + [LAST_MS]
    with replacing(path) as new:
        shown[0].save(
            new, format="GIF", save_all=True, append_images=shown[1:], duration=durations, loop=0, optimize=True
        )
    return count == wanted


class _Scene:
    """The background, which is drawn once, and the moving parts."""

    def __init__(self, robot: RobotMachine, frames: Sequence[tuple[float, OdometryFrame]], title: str) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        from matplotlib.patches import Circle

        self._true, self._believed = robot.true_path(), robot.odometry_path()
        self._title = title
        start = self._true[0]
        self._pose = (start.x_m, start.y_m, start.heading_rad)
        self._odometry = place([(point.x_m, point.y_m) for point in self._believed], *self._pose)
        self._times = [[point.time_s for point in path] for path in (self._true, self._believed)]
        self._seen_s = [time_s for time_s, _ in frames]
        self._seen = [place(sonar_points(frame, self._heading(time_s)), *self._pose) for time_s, frame in frames]
        low, high = _bounds(robot, self._true)
        height_in = max(2.0, min(9.0, _WIDTH_IN * (high[1] - low[1]) / (high[0] - low[0])))
        figure = Figure(figsize=(_WIDTH_IN, height_in), dpi=_DPI)
        self._canvas: Any = FigureCanvasAgg(figure)
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal", adjustable="datalim")
        axes.axis("off")
        for (x0, y0), (x1, y1) in robot.walls:
            axes.plot((x0, x1), (y0, y1), color="black", linewidth=2.5, solid_capstyle="round")
        for x, y, radius in robot.posts:
            axes.add_patch(Circle((x, y), radius, color="black"))
        self._clock = axes.text(0.02, 0.97, "", transform=axes.transAxes, va="top", fontsize=13)
        _legend(axes)
        body = RobotParams()
        self._ahead_m, self._radius_m = body.body_ahead_m, body.body_radius_m
        (self._cloud,) = axes.plot((), (), ".", color="tab:red", markersize=4)
        (self._way,) = axes.plot((), (), color="tab:green", linewidth=2)
        (self._belief,) = axes.plot((), (), "--", color="tab:blue", linewidth=1.5)
        (self._ghost,) = axes.plot((), (), "o", color="tab:blue", markersize=7)
        self._beams = [axes.plot((), (), color="tab:red", linewidth=1, alpha=0.6)[0] for _ in range(3)]
        self._robot = Circle((0, 0), self._radius_m, facecolor="tab:green", edgecolor="black", zorder=5)
        axes.add_patch(self._robot)
        (self._nose,) = axes.plot((), (), color="black", linewidth=2.5, zorder=6)

    def _heading(self, time_s: float) -> float | None:
        known = bisect_right(self._times[1], time_s)
        return self._believed[known - 1].heading_rad if known else None

    def at(self, time_s: float) -> Image:
        """The picture of one moment."""
        from PIL.Image import frombytes

        done, believed = (max(1, bisect_right(times, time_s)) for times in self._times)
        here = self._true[done - 1]
        frames = bisect_right(self._seen_s, time_s)
        self._clock.set_text(f"{self._title}, {time_s - self._true[0].time_s:4.1f} s")
        self._way.set_data([point.x_m for point in self._true[:done]], [point.y_m for point in self._true[:done]])
        self._belief.set_data(*_columns(self._odometry[:believed]))
        self._ghost.set_data(*_columns(self._odometry[believed - 1 : believed]))
        self._cloud.set_data(*_columns([point for points in self._seen[:frames] for point in points]))
        seen_from = self._odometry[believed - 1]
        echoes = self._seen[frames - 1] if frames else []
        for number, beam in enumerate(self._beams):
            beam.set_data(*_columns([seen_from, echoes[number]] if number < len(echoes) else []))
        middle = _ahead(here, self._ahead_m)
        self._robot.set_center(middle)
        self._nose.set_data(*_columns([middle, _ahead(here, self._ahead_m + self._radius_m)]))
        self._canvas.draw()
        width, height = self._canvas.get_width_height()
        return frombytes("RGBA", (width, height), bytes(self._canvas.buffer_rgba())).convert("RGB")


def _bounds(robot: RobotMachine, path: Sequence[PathPoint]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Lower left and upper right corner of the area that contains walls, posts and the path."""
    points = [*(end for wall in robot.walls for end in wall), *((point.x_m, point.y_m) for point in path)]
    points += [(x + sign * radius, y + sign * radius) for x, y, radius in robot.posts for sign in (-1, 1)]
    low, high = (tuple(pick(axis) for axis in zip(*points, strict=True)) for pick in (min, max))
    wide = max(_MIN_M, high[0] - low[0]), max(_MIN_M, high[1] - low[1])
    return (low[0] - _MARGIN_M, low[1] - _MARGIN_M), (low[0] + wide[0] + _MARGIN_M, low[1] + wide[1] + _MARGIN_M)


def _legend(axes: Any) -> None:
    from matplotlib.lines import Line2D

    told = (
        Line2D((), (), color="tab:green", label="true path"),
        Line2D((), (), color="tab:blue", linestyle="--", label="odometry"),
        Line2D((), (), color="tab:red", linestyle="", marker=".", label="sonar points"),
    )
    axes.legend(handles=told, loc="upper left", bbox_to_anchor=(0.01, 0.92), frameon=False, fontsize=11)



def _columns(points: Sequence[tuple[float, float]]) -> tuple[list[float], list[float]]:
    return [x for x, _ in points], [y for _, y in points]


def _ahead(point: PathPoint, distance_m: float) -> tuple[float, float]:
    return point.x_m + distance_m * cos(point.heading_rad), point.y_m + distance_m * sin(point.heading_rad)
