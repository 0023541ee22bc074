"""A picture of a run: walls, true path, odometry, and the point cloud that the sonars drew.

Modelled
    What the console of the thesis draws (a point at the measured range to the left and to the right of each odometry
    pose, one straight ahead), over the truth that only the bench knows.
Not modelled
    Interaction: the picture is a PNG (matplotlib's Agg canvas; no display is needed).
Time
    None.
Sources
    TFG 3.3.2 (odometry and point cloud).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import cos, isfinite, pi, sin
from pathlib import Path
from typing import TYPE_CHECKING, Final

from hil.world.geometry import Post
from hil.world.maps import WorldMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: Where the console puts the points of each distance, as an angle to the heading.
BEARINGS: Final = {"front": 0.0, "left": pi / 2.0, "right": -pi / 2.0}
_COLOURS: Final = {"front": "tab:orange", "left": "tab:green", "right": "tab:red"}


@dataclass(frozen=True, slots=True)
class OdometryPoint:
    """One odometry frame: pose in the robot's own frame (start at 0, 0, 0) and the three distances, in SI units."""

    x_m: float
    y_m: float
    theta_rad: float
    front_m: float
    left_m: float
    right_m: float


def point_cloud(odometry: Iterable[OdometryPoint]) -> dict[str, list[tuple[float, float]]]:
    """For each sonar the points that a console draws: its distance from the odometry pose along its bearing."""
    cloud: dict[str, list[tuple[float, float]]] = {name: [] for name in BEARINGS}
    for point in odometry:
        for name, away in (("front", point.front_m), ("left", point.left_m), ("right", point.right_m)):
            course = point.theta_rad + BEARINGS[name]
            cloud[name].append((point.x_m + away * cos(course), point.y_m + away * sin(course)))
    return cloud


def place(points: Iterable[tuple[float, float]], start: tuple[float, float, float]) -> list[tuple[float, float]]:
    """Points of the robot's own frame in the world, for a robot that started at `start`."""
    x, y, heading = start
    c, s = cos(heading), sin(heading)
    return [(x + c * px - s * py, y + s * px + c * py) for px, py in points]


def plot_run(
    file: str | Path,
    world_map: WorldMap,
    path: Sequence[tuple[float, float, float, float]] = (),
    odometry: Sequence[OdometryPoint] = (),
    posts: Sequence[Post] | None = None,
    *,
    max_range_m: float = 6.4,
    title: str | None = None,
) -> Path:
    """Write a PNG and return its path.

    `path` is `World.path`; `posts` are the obstacles at the end (default: the map's).  Points at `max_range_m` or
    more are no echo and are not drawn.  Raises ValueError when the file name does not end in .png.
    """
    from matplotlib.figure import Figure

    target = Path(file)
    if target.suffix.lower() != ".png":
        raise ValueError(f"{target}: the plot is a PNG; give a name that ends in .png")
    figure = Figure(figsize=(8.0, 8.0), layout="constrained")
    axes = figure.add_subplot()
    _draw_map(axes, world_map, world_map.posts if posts is None else posts)
    if path:
        axes.plot([p[1] for p in path], [p[2] for p in path], color="tab:blue", label="true path")
        axes.plot(path[0][1], path[0][2], "o", color="tab:blue", markersize=5)
    if odometry:
        track = place(((p.x_m, p.y_m) for p in odometry), world_map.start)
        axes.plot(*zip(*track, strict=True), "--", color="tab:purple", label="odometry")
        for name, points in point_cloud(odometry).items():
            away = [getattr(p, f"{name}_m") for p in odometry]
            kept = [p for p, m in zip(place(points, world_map.start), away, strict=True) if m < max_range_m]
            kept = [p for p in kept if isfinite(p[0]) and isfinite(p[1])]
            if kept:
                axes.plot(*zip(*kept, strict=True), ".", color=_COLOURS[name], markersize=4, label=f"sonar {name}")
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.set_title(title or world_map.name)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="best")
    figure.savefig(str(target), format="png", backend="agg")
    return target


def _draw_map(axes: Axes, world_map: WorldMap, posts: Sequence[Post]) -> None:
    from matplotlib.patches import Circle

    for wall in world_map.walls:
        axes.plot([wall.ax, wall.bx], [wall.ay, wall.by], color="black", linewidth=2.0)
    for post in posts:
        axes.add_patch(Circle((post.x_m, post.y_m), post.radius_m, color="black"))
    low_x, low_y, high_x, high_y = world_map.bounds()
    margin = 0.05 * max(high_x - low_x, high_y - low_y, 0.2)
    axes.set_xlim(low_x - margin, high_x + margin)
    axes.set_ylim(low_y - margin, high_y + margin)
