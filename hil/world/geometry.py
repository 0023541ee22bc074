"""Plane geometry of the world: straight walls, round posts, lines of sight.

Modelled
    Wall segments with precomputed direction and normal; posts as discs; distance, foot of perpendicular, mirror
    image, ray casting, line of sight, corners of two walls.
Not modelled
    Height, thickness (a wall that has two faces is two segments), curved walls (use short segments).
Time
    None: pure functions of positions in metres.  They use plain floats on purpose.  Measured with
    `python -m tests.benchmarks.geometry` for maps of about ten walls, they are 10 times faster than shapely for a ray,
    and 2.5 times for a clearance.  Beyond some 40 walls shapely's clearance is faster, but a clearance is computed only
    when the robot has used up its last one.  The tests compare with shapely.
Sources
    Elementary geometry.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import acos, degrees, hypot, inf, pi, sqrt
from typing import Final

#: Two wall ends closer than this are one corner; a line of sight may end this close to its target.
TOUCH_M: Final = 1e-6


class Segment:
    """A straight wall from (ax, ay) to (bx, by); (ux, uy) is its direction, (nx, ny) its left normal."""

    __slots__ = ("ax", "ay", "bx", "by", "length_m", "material", "nx", "ny", "offset_m", "ux", "uy")

    def __init__(self, ax: float, ay: float, bx: float, by: float, material: str = "smooth") -> None:
        length = hypot(bx - ax, by - ay)
        if not TOUCH_M < length < inf:
            raise ValueError(f"wall from ({ax}, {ay}) to ({bx}, {by}): its ends must be finite and apart")
        self.ax, self.ay, self.bx, self.by = ax, ay, bx, by
        self.length_m = length
        self.ux, self.uy = (bx - ax) / length, (by - ay) / length
        self.nx, self.ny = -self.uy, self.ux
        self.offset_m = self.nx * ax + self.ny * ay
        self.material = material

    def __repr__(self) -> str:
        return f"Segment({self.ax}, {self.ay}, {self.bx}, {self.by}, {self.material!r})"

    def __reduce__(self) -> tuple[type[Segment], tuple[float, float, float, float, str]]:
        """How to copy it to another process.  Compiled, an object is made by its constructor only."""
        return Segment, (self.ax, self.ay, self.bx, self.by, self.material)

    def side(self, x: float, y: float) -> float:
        """Signed distance from the wall's line, positive on its left."""
        return self.nx * x + self.ny * y - self.offset_m

    def along(self, x: float, y: float) -> float:
        """The position of the foot of the perpendicular, in metres from the first end."""
        return (x - self.ax) * self.ux + (y - self.ay) * self.uy

    def nearest(self, x: float, y: float) -> tuple[float, float]:
        """The point of the wall nearest to (x, y)."""
        along = min(max(self.along(x, y), 0.0), self.length_m)
        return self.ax + along * self.ux, self.ay + along * self.uy

    def distance(self, x: float, y: float) -> float:
        """Distance from (x, y) to the nearest point of the wall."""
        along = (x - self.ax) * self.ux + (y - self.ay) * self.uy
        if along < 0.0:
            return hypot(x - self.ax, y - self.ay)
        if along > self.length_m:
            return hypot(x - self.bx, y - self.by)
        return abs(self.nx * x + self.ny * y - self.offset_m)

    def mirror(self, x: float, y: float) -> tuple[float, float]:
        """The image of (x, y) in the wall's line."""
        twice = 2.0 * self.side(x, y)
        return x - twice * self.nx, y - twice * self.ny

    def ray(self, x: float, y: float, dx: float, dy: float) -> float:
        """Distance from (x, y) along the unit vector (dx, dy) to the wall; inf when it misses.

        A ray that touches an end hits the wall.  So rounding never lets a ray slip between two walls that meet.
        """
        approach = self.nx * dx + self.ny * dy
        if approach == 0.0:
            return inf
        reach = -self.side(x, y) / approach
        if reach < 0.0:
            return inf
        along = self.along(x + reach * dx, y + reach * dy)
        past = max(-along, along - self.length_m)
        if past <= 0.0:
            return reach
        return max(reach, self.distance(x, y)) if past <= TOUCH_M else inf

    def crosses(self, px: float, py: float, qx: float, qy: float) -> bool:
        """Whether the wall cuts the line of sight p-q strictly between its ends (touching an end is not cutting)."""
        from_p = self.nx * px + self.ny * py - self.offset_m
        from_q = self.nx * qx + self.ny * qy - self.offset_m
        if from_p * from_q >= 0.0 or abs(from_p) < TOUCH_M or abs(from_q) < TOUCH_M:
            return False
        share = from_p / (from_p - from_q)
        along = (px + share * (qx - px) - self.ax) * self.ux + (py + share * (qy - py) - self.ay) * self.uy
        return 0.0 <= along <= self.length_m


class Post:
    """A round obstacle, fixed or moved by the bench."""

    __slots__ = ("name", "radius_m", "x_m", "y_m")

    def __init__(self, x_m: float, y_m: float, radius_m: float, name: str = "") -> None:
        if not (radius_m > 0.0 and abs(x_m) < inf and abs(y_m) < inf and radius_m < inf):
            raise ValueError(f"post {name!r} at ({x_m}, {y_m}), radius {radius_m} m: must be finite, radius above 0")
        self.x_m, self.y_m, self.radius_m, self.name = x_m, y_m, radius_m, name

    def __reduce__(self) -> tuple[type[Post], tuple[float, float, float, str]]:
        """As that of `Segment`."""
        return Post, (self.x_m, self.y_m, self.radius_m, self.name)

    def distance(self, x: float, y: float) -> float:
        """Distance from (x, y) to the surface, negative inside."""
        return hypot(x - self.x_m, y - self.y_m) - self.radius_m

    def ray(self, x: float, y: float, dx: float, dy: float) -> float:
        """Distance from (x, y) along the unit vector (dx, dy) to the surface; inf when it misses."""
        cx, cy = self.x_m - x, self.y_m - y
        ahead = cx * dx + cy * dy
        under = self.radius_m * self.radius_m - (cx * cx + cy * cy - ahead * ahead)
        if under < 0.0:
            return inf
        root = sqrt(under)
        if ahead - root >= 0.0:
            return ahead - root
        return ahead + root if ahead + root >= 0.0 else inf

    def crosses(self, px: float, py: float, qx: float, qy: float) -> bool:
        """Whether the post stands in the line of sight p-q."""
        vx, vy = qx - px, qy - py
        square = vx * vx + vy * vy
        if square == 0.0:
            return False
        share = ((self.x_m - px) * vx + (self.y_m - py) * vy) / square
        share = min(max(share, 0.0), 1.0)
        return hypot(px + share * vx - self.x_m, py + share * vy - self.y_m) < self.radius_m - TOUCH_M


@dataclass(frozen=True, slots=True)
class Corner:
    """Two walls meeting at (x_m, y_m), opening by `opening_rad` about the unit vector (dx, dy), less than pi."""

    x_m: float
    y_m: float
    dx: float
    dy: float
    opening_rad: float
    walls: tuple[Segment, Segment]

    @property
    def opening_deg(self) -> float:
        """The angle between the two walls in degrees."""
        return degrees(self.opening_rad)


def corners(walls: Sequence[Segment]) -> list[Corner]:
    """Every pair of wall ends that meet, seen from the side where they include less than 180 degrees."""
    found = []
    for index, first in enumerate(walls):
        for second in walls[index + 1 :]:
            for px, py, ux, uy in _ends(first):
                for qx, qy, vx, vy in _ends(second):
                    if hypot(px - qx, py - qy) > TOUCH_M:
                        continue
                    opening = acos(min(1.0, max(-1.0, ux * vx + uy * vy)))
                    bx, by = ux + vx, uy + vy
                    length = hypot(bx, by)
                    if 1e-6 < opening < pi - 1e-6:
                        found.append(Corner(px, py, bx / length, by / length, opening, (first, second)))
    return found


def _ends(wall: Segment) -> tuple[tuple[float, float, float, float], tuple[float, float, float, float]]:
    """Both ends of a wall, each with the direction from it into the wall."""
    return (wall.ax, wall.ay, wall.ux, wall.uy), (wall.bx, wall.by, -wall.ux, -wall.uy)


def in_sight(
    px: float,
    py: float,
    qx: float,
    qy: float,
    walls: Iterable[Segment],
    posts: Iterable[Post],
    ignore: object = None,
) -> bool:
    """Whether nothing but `ignore` stands between p and q."""
    for wall in walls:
        if wall is not ignore and wall.crosses(px, py, qx, qy):
            return False
    return all(post is ignore or not post.crosses(px, py, qx, qy) for post in posts)


def cast(
    x: float, y: float, dx: float, dy: float, walls: Iterable[Segment], posts: Iterable[Post] = ()
) -> tuple[float, Segment | Post | None]:
    """The first thing hit by a ray from (x, y) along the unit vector (dx, dy): distance (inf: nothing) and thing."""
    best: float = inf
    thing: Segment | Post | None = None
    for wall in walls:
        reach = wall.ray(x, y, dx, dy)
        if reach < best:
            best, thing = reach, wall
    for post in posts:
        reach = post.ray(x, y, dx, dy)
        if reach < best:
            best, thing = reach, post
    return best, thing


def clearance(x: float, y: float, walls: Iterable[Segment], posts: Iterable[Post]) -> float:
    """Distance from (x, y) to the nearest wall or post; inf in the open."""
    best: float = inf
    for wall in walls:
        away = wall.distance(x, y)
        if away < best:
            best = away
    for post in posts:
        away = post.distance(x, y)
        if away < best:
            best = away
    return best


def within(x: float, y: float, outline: Iterable[Segment]) -> bool:
    """Whether (x, y) lies inside a closed line of walls: a ray from it crosses them an odd number of times."""
    crossings = 0
    for wall in outline:
        if (wall.ay > y) != (wall.by > y) and x < wall.ax + (y - wall.ay) / (wall.by - wall.ay) * (wall.bx - wall.ax):
            crossings += 1
    return crossings % 2 == 1
