"""Snapshots of the robot in its world, for the page.  The machine's thread makes them, and they never change.

A snapshot must not change the run.  So it uses only stored words and objects, reads no register and does not integrate
the world.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, isfinite, nan, sin
from typing import Any, Final

from hil.bench import Bench
from hil.machine import Status, Wall
from hil.robot.view.arena_drawing import Beam, Obstacle
from hil.world.geometry import cast
from hil.world.path import Path, Point
from hil.world.robot_params import Pose
from hil.world.sonar_rays import MAX_RANGE_M

#: The most points of a path that are shown.  Of a longer path, points are left out.
MAX_POINTS: Final = 3000
STEP_M: Final = 0.005


@dataclass(frozen=True, slots=True)
class Scene:
    """The robot and its surroundings at one moment."""

    status: Status
    #: The odometry of the firmware, in the world's frame; None: the firmware stores it in another object.
    believed: Pose | None
    bumper: bool
    beams: tuple[Beam, ...]
    obstacles: tuple[Obstacle, ...]
    walls: tuple[Wall, ...]


@dataclass(frozen=True, slots=True)
class Trails:
    """The paths in the world's frame, in metres; `start` is the pose of the robot at power-up."""

    true: tuple[tuple[float, float], ...]
    believed: tuple[tuple[float, float], ...]
    start: Pose


def scene_of(bench: Bench) -> Scene:
    """The present scene."""
    return Scene(
        bench.status(), believed_pose(bench), bench.world.bumper_pressed, beams_of(bench), obstacles_of(bench),
        tuple(bench.walls),
    )  # fmt: skip


def start_pose(bench: Bench) -> Pose:
    """The origin of the robot's own frame in the world: its pose at power-up."""
    return Pose(*bench.map.start)


def beams_of(bench: Bench) -> tuple[Beam, ...]:
    """The sonars.  One that the firmware does not know has no measured distance."""
    world, pose = bench.world, bench.world.pose
    ranges_cm = zip(("FRONT", "RIGHT", "LEFT"), bench.status().distances_cm, strict=True)
    measured = {name: range_cm for name, range_cm in ranges_cm if isfinite(range_cm)}
    found = []
    for name in world.sonars.mounts:
        x, y, heading = world.sonars.placed(name, pose)
        reach, _thing = cast(x, y, cos(heading), sin(heading), world.map.walls, world.posts)
        echo = world.sonars.echo(name, pose)
        answer = None if echo is None else echo[0]
        found.append(Beam(name, x, y, heading, measured.get(name, 0.0) / 100.0, min(reach, MAX_RANGE_M), answer))
    return tuple(found)


def believed_pose(bench: Bench) -> Pose | None:
    """The odometry of the firmware (servidores.c: ROBOT_Odometry_T, in mm and rad), in the world's frame.

    None: the user's own servidores.c may store it in another object.
    """
    start = start_pose(bench)
    known = bench.firmware.linked.objects.get("servidores.ROBOT_Odometry_T")
    if known is None:
        return None
    x, y, heading = (float(value or 0.0) for value in known.data[:3])
    x, y = x / 1000.0, y / 1000.0
    cosine, sine = cos(start.heading_rad), sin(start.heading_rad)
    return Pose(
        start.x_m + cosine * x - sine * y, start.y_m + sine * x + cosine * y, start.heading_rad + heading
    )  # fmt: skip


def trace_values(bench: Bench) -> dict[str, Any]:
    """The scene for a trace: names and values of `hil.instruments.scene`, rounded to a tenth of a millimetre."""
    scene = scene_of(bench)
    status = scene.status
    tells: dict[str, Any] = {
        "walls": [_rounded(*a, *b) for a, b in scene.walls],
        "posts": [[each.name, *_rounded(each.x_m, each.y_m, each.radius_m)] for each in scene.obstacles],
        "start": _rounded(*start_pose(bench)),
        "state": status.state,
        "bumper": int(scene.bumper),
        "robot": _rounded(status.x_m, status.y_m, status.heading_rad),
    }
    if scene.believed is not None and all(map(isfinite, scene.believed)):
        tells["believed"] = _rounded(*scene.believed)
    for beam, mount in zip(scene.beams, bench.world.sonars.mounts.values(), strict=True):
        tells[f"mount {beam.name}"] = _rounded(mount.x_m, mount.y_m, mount.bearing_rad)
        ranges = (beam.measured_m or None, beam.ray_m, beam.echo_m)
        tells[f"sonar {beam.name}"] = [None if each is None else _rounded(each)[0] for each in ranges]
    return tells


def _rounded(*values: float) -> list[float]:
    return [round(float(value), 4) for value in values]


def obstacles_of(bench: Bench) -> tuple[Obstacle, ...]:
    """All round obstacles."""
    return tuple(Obstacle(post.name, post.x_m, post.y_m, post.radius_m) for post in bench.world.posts)


def trails_of(bench: Bench) -> Trails:
    """The whole paths, with at most `MAX_POINTS` points.  When a path grows, its first points stay the same."""
    start = start_pose(bench)
    true = tuple((x, y) for _, x, y, _ in thinned(bench.world.path))
    cosine, sine = cos(start.heading_rad), sin(start.heading_rad)
    believed: list[tuple[float, float]] = []
    last_x = last_y = nan
    for _, x, y, _ in thinned(bench.odometry):
        if not hypot(x - last_x, y - last_y) < STEP_M:
            last_x, last_y = x, y
            believed.append((start.x_m + cosine * x - sine * y, start.y_m + sine * x + cosine * y))
    return Trails(true, tuple(believed), start)


def thinned(path: Path) -> list[Point]:
    """At most `MAX_POINTS` points of a path."""
    return path.points(every=1 + len(path) // MAX_POINTS)
