"""A drive as a picture: walls, true path, odometry, and the point cloud that the sonars make of the world."""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from hil.client.decode import OdometryFrame
from hil.extras import require
from hil.files import check_target, replacing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Point = tuple[float, float]

#: If no echo returned, the firmware reports this distance or more (255 inches are 6.48 m).  It is not drawn.
NO_ECHO_M: Final = 6.0
#: The suffixes of files that Matplotlib writes.
SUFFIXES: Final = (".png", ".svg", ".pdf")
#: The suffix of a moving picture.
MOVING: Final = ".gif"


def sonar_points(frame: OdometryFrame, heading_rad: float | None = None) -> list[Point]:
    """The points that the three sonars saw, in metres: ahead, at -90 and at +90 degrees from the robot's centre.

    The heading in the frame is in whole radians; pass a more exact one as `heading_rad` if you have it.  Source: thesis
    3.3.
    """
    heading = float(frame.theta_rad) if heading_rad is None else heading_rad
    points = []
    for distance_mm, bearing in (
        (frame.front_mm, 0.0), (frame.right_mm, -math.pi / 2), (frame.left_mm, math.pi / 2),
    ):  # fmt: skip
        distance, angle = distance_mm / 1e3, heading + bearing
        if 0.0 < distance < NO_ECHO_M:
            points.append(
                (frame.x_mm / 1e3 + distance * math.cos(angle), frame.y_mm / 1e3 + distance * math.sin(angle))
            )
    return points


def place(points: Iterable[Point], x_m: float, y_m: float, heading_rad: float) -> list[Point]:
    """Transform points from a coordinate frame whose origin is at the given pose to the frame of that pose."""
    cosine, sine = math.cos(heading_rad), math.sin(heading_rad)
    return [(x_m + cosine * x - sine * y, y_m + sine * x + cosine * y) for x, y in points]


def check_plot_file(path: Path, suffixes: Sequence[str] = SUFFIXES) -> None:
    """Check before the run that a picture can be written there.

    Raises ValueError if it cannot, and ModuleNotFoundError without Matplotlib.  Matplotlib is imported here, because
    after Ctrl-C there is only a second for the picture, and the import takes half of it.
    """
    require("matplotlib")
    import hil.client.figure  # noqa: F401
    if path.suffix.lower() not in suffixes:
        raise ValueError(f"{path}: a picture's name ends in {', '.join(suffixes)}")
    check_target(path)


def plot_drive(
    path: Path,
    *,
    odometry: Sequence[Point],
    cloud: Sequence[Point],
    true_path: Sequence[Point] = (),
    walls: Iterable[tuple[Point, Point]] = (),
    posts: Iterable[tuple[float, float, float]] = (),
    title: str = "Drive",
) -> None:
    """Draw a drive, as `drive_figure` does, and write it to `path` (PNG, SVG or PDF by its suffix)."""
    save(drive_figure(
        odometry=odometry, cloud=cloud, true_path=true_path, walls=walls, posts=posts, title=title
    ), path)  # fmt: skip


def save(figure: Figure, path: str | Path, *, dpi: float = 120) -> None:
    """Write a figure whole or not at all: PNG, SVG or PDF by the suffix.  Raises OSError, which names `path`."""
    drawn = io.BytesIO()  # where a disk is full, Matplotlib's PDF fails in ways of its own
    figure.savefig(drawn, format=Path(path).suffix[1:].lower(), dpi=dpi)
    with replacing(path) as new:
        new.write_bytes(drawn.getbuffer())


def drive_figure(
    *,
    odometry: Sequence[Point],
    cloud: Sequence[Point],
    true_path: Sequence[Point] = (),
    walls: Iterable[tuple[Point, Point]] = (),
    posts: Iterable[tuple[float, float, float]] = (),
    title: str = "Drive",
) -> Figure:
    """A drive as a figure.  All points are in metres and in one coordinate frame; `posts` are (x, y, radius)."""
    require("matplotlib")
    from hil.client.figure import ShownFigure

    figure = ShownFigure(8, 6)
    axes = figure.add_subplot()
    draw_drive(axes, odometry=odometry, cloud=cloud, true_path=true_path, walls=walls, posts=posts)
    axes.set_title(title)
    return figure


def draw_drive(
    axes: Axes,
    *,
    odometry: Sequence[Point],
    cloud: Sequence[Point],
    true_path: Sequence[Point] = (),
    walls: Iterable[tuple[Point, Point]] = (),
    posts: Iterable[tuple[float, float, float]] = (),
) -> None:
    """Draw a drive into the axes of an existing figure."""
    from matplotlib.patches import Circle

    label = "walls"
    for (x0, y0), (x1, y1) in walls:
        axes.plot((x0, x1), (y0, y1), color="black", linewidth=2, label=label)
        label = "_nolegend_"
    for x, y, radius in posts:
        axes.add_patch(Circle((x, y), radius, color="black"))
    if cloud:
        axes.plot(*zip(*cloud, strict=True), ".", color="tab:red", markersize=3, label="sonar points")
    if true_path:
        axes.plot(*zip(*true_path, strict=True), color="tab:green", linewidth=2, label="true path")
        axes.plot(*true_path[-1], "o", color="tab:green", label="end of the true path")
    if odometry:
        axes.plot(*zip(*odometry, strict=True), "--", color="tab:blue", label="odometry")
        axes.plot(*odometry[-1], "o", color="tab:blue", label="end of the odometry")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.grid(alpha=0.3)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="best", fontsize="small")
