"""A robot's drive as a figure, in world coordinates: its path, its own estimate of it, and what its sonars saw."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable
from typing import TYPE_CHECKING

from hil.client.decode import OdometryFrame
from hil.client.plot import drive_figure, place, sonar_points
from hil.machine import PathPoint, RobotMachine

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def drive_of(robot: RobotMachine, frames: Iterable[tuple[float, OdometryFrame]], title: str) -> Figure:
    """The drive up to now; `frames` are those that it has sent, each with the virtual time in seconds at its end."""
    true_path = robot.true_path()
    believed = robot.odometry_path()
    start = true_path[0] if true_path else PathPoint(0.0, 0.0, 0.0, 0.0)
    times = [point.time_s for point in believed]
    cloud = []
    for time_s, frame in frames:
        # The frame's own heading is in whole radians; the firmware's is better.
        index = min(bisect_left(times, time_s), len(times) - 1)
        cloud += sonar_points(frame, believed[index].heading_rad if believed else None)
    pose = (start.x_m, start.y_m, start.heading_rad)
    return drive_figure(
        odometry=place([(point.x_m, point.y_m) for point in believed], *pose),
        cloud=place(cloud, *pose),
        true_path=[(point.x_m, point.y_m) for point in true_path],
        walls=robot.walls,
        posts=robot.posts,
        title=title,
    )
