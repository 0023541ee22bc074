"""The reflectors in the beam of each sonar: walls as mirrors, corners, posts, in order of range.

Modelled
    A wall answers from the foot of its perpendicular, if the foot is on the wall and nothing is in between, with the
    probability of its angle off the boresight.  A concave corner of about 90 degrees answers like a wall at the
    corner's distance.  A post answers from its near side, by its diameter.  Reflectors behind others are in the list
    too.  Cross-talk: the length of the path from one sonar by way of one mirror or post to another.
Not modelled
    Diffraction at edges and convex corners, paths of more than one bounce other than corners, reflections from the
    floor or the robot itself, side lobes.
Time
    None: pure functions of a pose.
Sources
    EZ beam plots (through devices.lv_maxsonar_beam); TFG 3.1.1: three sonars high in front, looking ahead, left, right.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, pi, remainder, sin
from types import MappingProxyType
from typing import Final

from emulator.devices.lv_maxsonar_beam import (
    A1_RAD,
    OBJECT_LIMIT_RAD,
    Echo,
    detection_probability,
    in_order,
    object_detection_probability,
    object_range_m,
)
from hil.world.geometry import Corner, Post, Segment, corners, in_sight

#: EZ: detects up to 254 inches.
MAX_RANGE_M: Final = 254 * 0.0254
#: CHOICE: a corner reflects sound fully up to 5 degrees off the right angle, and not at all beyond 15.
CORNER_FULL_DEG: Final = 5.0
CORNER_NONE_DEG: Final = 15.0


@dataclass(frozen=True, slots=True)
class SonarMount:
    """The position of a sonar on the robot (x ahead of the axle, y to the left) and its direction."""

    x_m: float
    y_m: float
    bearing_rad: float


#: Named as in us.h.  CHOICE: they sit on the upper front of a body that reaches 0.12 m ahead of the axle (TFG: no
#: dimensions).
DEFAULT_MOUNTS: Final[Mapping[str, SonarMount]] = MappingProxyType(
    {
        "LEFT": SonarMount(0.055, 0.055, pi / 2.0),
        "FRONT": SonarMount(0.090, 0.0, 0.0),
        "RIGHT": SonarMount(0.055, -0.055, -pi / 2.0),
    }
)


class SonarRays:
    """Sonars on a robot among walls and posts.  `posts` may be changed by its owner between two calls."""

    __slots__ = ("_corners", "_walls", "mounts", "posts", "vcc_v")

    def __init__(
        self,
        walls: Sequence[Segment],
        posts: list[Post] | None = None,
        mounts: Mapping[str, SonarMount] = DEFAULT_MOUNTS,
        vcc_v: float = 3.3,
    ) -> None:
        self.mounts = mounts
        self.posts = posts if posts is not None else []
        self.vcc_v = vcc_v
        self._walls = tuple(walls)
        self._corners: list[tuple[Corner, float]] = []
        for corner in corners(self._walls):
            off = abs(corner.opening_deg - 90.0)
            strength = min(1.0, (CORNER_NONE_DEG - off) / (CORNER_NONE_DEG - CORNER_FULL_DEG))
            if strength > 0.0:
                self._corners.append((corner, strength))

    def placed(self, sensor: str, pose: tuple[float, float, float]) -> tuple[float, float, float]:
        """Position of a sonar in the world and the direction it looks; ValueError for a name there is none of."""
        mount = self.mounts.get(sensor)
        if mount is None:
            raise ValueError(f"no sonar {sensor!r} on this robot; there are {', '.join(self.mounts)}")
        x, y, heading = pose
        c, s = cos(heading), sin(heading)
        return x + c * mount.x_m - s * mount.y_m, y + s * mount.x_m + c * mount.y_m, heading + mount.bearing_rad

    def reflectors(self, sensor: str, pose: tuple[float, float, float]) -> list[tuple[float, float]]:
        """Everything in the beam: (range_m, strength), nearest first, up to the first that is certain to be heard."""
        x, y, look = self.placed(sensor, pose)
        found: list[tuple[float, float, float, float, object]] = []
        for wall in self._walls:
            side = wall.nx * x + wall.ny * y - wall.offset_m
            if -MAX_RANGE_M <= side <= MAX_RANGE_M and side:
                along = (x - wall.ax) * wall.ux + (y - wall.ay) * wall.uy
                if 0.0 <= along <= wall.length_m:
                    toward = atan2(-wall.ny, -wall.nx) if side > 0.0 else atan2(wall.ny, wall.nx)
                    strength = detection_probability(remainder(toward - look, 2.0 * pi))
                    if strength > 0.0:
                        found.append((abs(side), strength, x - side * wall.nx, y - side * wall.ny, wall))
        for corner, strength in self._corners:
            dx, dy = corner.x_m - x, corner.y_m - y
            away = hypot(dx, dy)
            if 0.0 < away <= MAX_RANGE_M:
                strength *= detection_probability(remainder(atan2(dy, dx) - look, 2.0 * pi))
                # The sonar must stand inside the corner: within half its opening of the bisector.
                inside = -(dx * corner.dx + dy * corner.dy) > away * cos(0.5 * corner.opening_rad)
                if strength > 0.0 and inside:
                    found.append((away, strength, corner.x_m, corner.y_m, corner))
        for post in self.posts:
            dx, dy = post.x_m - x, post.y_m - y
            away = hypot(dx, dy) - post.radius_m
            if 0.0 < away <= MAX_RANGE_M:
                bearing = remainder(atan2(dy, dx) - look, 2.0 * pi)
                if -OBJECT_LIMIT_RAD < bearing < OBJECT_LIMIT_RAD:
                    strength = object_detection_probability(2.0 * post.radius_m, away, bearing, self.vcc_v)
                    if strength > 0.0:
                        found.append((away, strength, post.x_m, post.y_m, post))
        if len(found) > 1:
            found.sort(key=_by_range)
        heard = []
        for away, strength, px, py, thing in found:
            if in_sight(x, y, px, py, self._walls, self.posts, thing):
                heard.append((away, strength))
                if strength >= 1.0:
                    break
        return heard

    def echo(self, sensor: str, pose: tuple[float, float, float]) -> tuple[float, float] | None:
        """The nearest reflector in the beam: range in m, and probability (0..1] that one ping hears it; None: none."""
        heard = self.reflectors(sensor, pose)
        return heard[0] if heard else None

    def echoes(self, sensor: str, pose: tuple[float, float, float]) -> Echo | None:
        """The reflectors in the form for the sonar device: each with the next one behind it."""
        return in_order([Echo(away, strength) for away, strength in self.reflectors(sensor, pose)])

    def cross_path(self, source: str, listener: str, pose: tuple[float, float, float]) -> float | None:
        """Shortest path in m of a ping from one sonar by one wall or post to another; None: it is not heard.

        CHOICE: both sonars must have the reflecting point within the angle at which they hear a wall at all.
        """
        sx, sy, s_look = self.placed(source, pose)
        tx, ty, t_look = self.placed(listener, pose)
        best: float | None = None
        for wall in self._walls:
            s_side, t_side = wall.side(sx, sy), wall.side(tx, ty)
            if s_side * t_side <= 0.0:
                continue
            share = s_side / (s_side + t_side)
            along = wall.along(sx, sy) + share * (wall.along(tx, ty) - wall.along(sx, sy))
            if not 0.0 <= along <= wall.length_m:
                continue
            px, py = wall.ax + along * wall.ux, wall.ay + along * wall.uy
            ix, iy = wall.mirror(sx, sy)
            path = hypot(ix - tx, iy - ty)
            if (
                (best is None or path < best)
                and path <= 2.0 * MAX_RANGE_M
                and _off(sx, sy, px, py, s_look) < A1_RAD
                and _off(tx, ty, px, py, t_look) < A1_RAD
                and in_sight(sx, sy, px, py, self._walls, self.posts, wall)
                and in_sight(tx, ty, px, py, self._walls, self.posts, wall)
            ):
                best = path
        for post in self.posts:
            there = hypot(post.x_m - sx, post.y_m - sy) - post.radius_m
            back = hypot(post.x_m - tx, post.y_m - ty) - post.radius_m
            path = there + back
            if (
                (best is None or path < best)
                and 0.5 * path <= object_range_m(2.0 * post.radius_m, self.vcc_v)
                and _off(sx, sy, post.x_m, post.y_m, s_look) < OBJECT_LIMIT_RAD
                and _off(tx, ty, post.x_m, post.y_m, t_look) < OBJECT_LIMIT_RAD
                and in_sight(sx, sy, post.x_m, post.y_m, self._walls, self.posts, post)
                and in_sight(tx, ty, post.x_m, post.y_m, self._walls, self.posts, post)
            ):
                best = path
        return best

    def describe(self) -> list[str]:
        """The mounts in words, for reports."""
        return [
            f"{name}: {mount.x_m:+.3f} m ahead, {mount.y_m:+.3f} m left, looking {degrees(mount.bearing_rad):+.0f} deg"
            for name, mount in self.mounts.items()
        ]


def _by_range(item: tuple[float, float, float, float, object]) -> float:
    return item[0]


def _off(x: float, y: float, px: float, py: float, look: float) -> float:
    """Angle in rad between the direction `look` and the line from (x, y) to (px, py)."""
    return abs(remainder(atan2(py - y, px - x) - look, 2.0 * pi))
