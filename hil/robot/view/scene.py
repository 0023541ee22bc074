"""What the page sees of the robot in its world: made by the machine's own thread, never changed afterwards.

Everything is looked at without touching it: stored words and objects, no register read, no integration of the world.
A look must not change the run.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, nan, sin
from typing import Final

from hil.bench import Bench
from hil.machine import Status, Wall
from hil.world.geometry import cast
from hil.world.path import Path, Point
from hil.world.robot_params import Pose
from hil.world.sonar_rays import MAX_RANGE_M

#: Points of a path that are shown; more are thinned.
MOST_POINTS: Final = 3000
STEP_M: Final = 0.005


@dataclass(frozen=True, slots=True)
class Beam:
    """A sonar in the world's frame: where it stands and looks, what the firmware measured, what a ray hits."""

    name: str
    x_m: float
    y_m: float
    heading_rad: float
    measured_m: float
    #: First wall or post straight ahead; the sonar's range if there is none.
    ray_m: float
    #: What the sound comes back from first, off the axis too; None: nothing answers.
    echo_m: float | None


@dataclass(frozen=True, slots=True)
class Obstacle:
    """A round thing."""

    name: str
    x_m: float
    y_m: float
    radius_m: float


@dataclass(frozen=True, slots=True)
class Scene:
    """The robot and what stands around it at one moment."""

    status: Status
    #: Where the firmware believes to be, in the world's frame.
    believed: Pose
    bumper: bool
    beams: tuple[Beam, ...]
    obstacles: tuple[Obstacle, ...]
    walls: tuple[Wall, ...]


@dataclass(frozen=True, slots=True)
class Trails:
    """Paths in the world's frame, in metres; `start` is where the robot was put down."""

    true: tuple[tuple[float, float], ...]
    believed: tuple[tuple[float, float], ...]
    start: Pose


def scene_of(bench: Bench) -> Scene:
    """What there is now."""
    return Scene(
        bench.status(), believed_pose(bench), bench.world.bumper_pressed, beams_of(bench), obstacles_of(bench),
        tuple(bench.walls),
    )  # fmt: skip


def start_pose(bench: Bench) -> Pose:
    """Where the robot's own frame lies in the world: the pose at power-up."""
    return Pose(*bench.map.start)


def beams_of(bench: Bench) -> tuple[Beam, ...]:
    """The sonars; of those that the robot's firmware does not know nothing is measured."""
    world, pose = bench.world, bench.world.pose
    servers = bench.firmware.servidores
    measured = {"FRONT": servers.ROBOT_df, "RIGHT": servers.ROBOT_dr, "LEFT": servers.ROBOT_dl}
    found = []
    for name in world.sonars.mounts:
        x, y, heading = world.sonars.placed(name, pose)
        reach, _thing = cast(x, y, cos(heading), sin(heading), world.map.walls, world.posts)
        echo = world.sonars.echo(name, pose)
        answer = None if echo is None else echo[0]
        found.append(Beam(name, x, y, heading, measured.get(name, 0.0) / 100.0, min(reach, MAX_RANGE_M), answer))
    return tuple(found)


def believed_pose(bench: Bench) -> Pose:
    """Where the firmware believes to be (servidores.c: ROBOT_Odometry_T, in mm and rad), in the world's frame."""
    start = start_pose(bench)
    known = bench.firmware.linked.objects["servidores.ROBOT_Odometry_T"].data
    x, y, heading = (float(value or 0.0) for value in known[:3])
    x, y = x / 1000.0, y / 1000.0
    cosine, sine = cos(start.heading_rad), sin(start.heading_rad)
    return Pose(
        start.x_m + cosine * x - sine * y, start.y_m + sine * x + cosine * y, start.heading_rad + heading
    )  # fmt: skip


def obstacles_of(bench: Bench) -> tuple[Obstacle, ...]:
    """Everything round."""
    return tuple(Obstacle(post.name, post.x_m, post.y_m, post.radius_m) for post in bench.world.posts)


def trails_of(bench: Bench) -> Trails:
    """The whole paths, thinned to what is shown; a longer path has the points of the shorter one first."""
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
    """No more points of a path than are shown."""
    return path.points(every=1 + len(path) // MOST_POINTS)
