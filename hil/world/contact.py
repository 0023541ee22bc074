"""Friction and impact: one implicit step of wheels, tyres and walls, with bounded impulses.

The four velocities (wheel, wheel, forward, yaw) are coupled by a few contacts: dry friction of a motor, grip of a tyre,
a wall that pushes but never pulls, and friction at the wall.  Each contact drives its relative velocity to zero, with
an impulse within its bounds.  The contacts are solved in a fixed order until the impulses settle (projected
Gauss-Seidel).  This is stable for any step, and gives the same result every time.

Velocities do not remove an overlap.  The robot would keep a speed that removes it, and this speed would be greater the
shorter the step is.  `pushed_out` moves the body instead.

Modelled
    Coulomb friction in motors, between tyre and floor along the wheel, and between body and wall.  Impacts are
    inelastic.  A body is moved aside by an object that is put or dragged onto it.
Not modelled
    Sideways slip of the tyres (except when the body is moved aside), elasticity, and a friction coefficient that falls
    with speed.
Sources
    Standard rigid-body contact.  The coefficients are CHOICEs of robot.RobotParams.
"""

from __future__ import annotations

from math import hypot
from typing import Final

from hil.world.geometry import Post, Segment

#: The greatest number of passes.  Solving ends earlier if each impulse changes by less than this force would cause in
#: the step (N, or N.m about a wheel).
ITERATIONS: Final = 16
SETTLED_N: Final = 2e-7
#: The greatest number of rounds over walls, which may push a body to each other.  A corner of 90 degrees needs one.
ROUNDS: Final = 8


class Touch:
    """A point of the round body near a wall or post.  (nx, ny) points from it to the body; `gap_m` is the distance."""

    __slots__ = ("gap_m", "nx", "ny")

    def __init__(self, nx: float, ny: float, gap_m: float) -> None:
        self.nx, self.ny, self.gap_m = nx, ny, gap_m


def nearby(
    x: float, y: float, reach_m: float, walls: tuple[Segment, ...], posts: list[Post]
) -> tuple[tuple[Segment, ...], list[Post]]:
    """The walls and posts that are nearer than `reach_m` to (x, y)."""
    return (
        tuple([wall for wall in walls if wall.distance(x, y) < reach_m]),
        [post for post in posts if post.distance(x, y) < reach_m],
    )


def touches(
    x: float, y: float, radius_m: float, within_m: float, walls: tuple[Segment, ...], posts: list[Post]
) -> list[Touch]:
    """The walls and posts that are nearer than `within_m` to a disc of `radius_m` about (x, y)."""
    found: list[Touch] = []
    reach = radius_m + within_m
    for wall in walls:
        if wall.distance(x, y) < reach:
            nx, ny, away = _from_wall(wall, x, y)
            _add(found, nx, ny, away - radius_m)
    for post in posts:
        if post.distance(x, y) < reach:
            nx, ny, away = _from_post(post, x, y)
            _add(found, nx, ny, away - post.radius_m - radius_m)
    return found


def _from_wall(wall: Segment, x: float, y: float) -> tuple[float, float, float]:
    """The unit vector from a wall to (x, y), and the distance in m.  On the wall itself, the side is arbitrary."""
    px, py = wall.nearest(x, y)
    away = hypot(x - px, y - py)
    return ((x - px) / away, (y - py) / away, away) if away > 1e-12 else (wall.nx, wall.ny, 0.0)


def _from_post(post: Post, x: float, y: float) -> tuple[float, float, float]:
    """The unit vector from the centre of a post to (x, y), and the distance in m.  At the centre it is arbitrary."""
    away = hypot(x - post.x_m, y - post.y_m)
    return ((x - post.x_m) / away, (y - post.y_m) / away, away) if away > 1e-12 else (1.0, 0.0, 0.0)


def pushed_out(
    x: float, y: float, radius_m: float, push_m: float, walls: tuple[Segment, ...], posts: list[Post]
) -> tuple[float, float]:
    """The new centre of a disc about (x, y) that overlaps walls or posts.

    Each post moves it by `push_m` at most.  Then walls move it until it overlaps no wall.
    """
    for post in posts:
        if post.distance(x, y) < radius_m:
            nx, ny, away = _from_post(post, x, y)
            push = min(radius_m + post.radius_m - away, push_m)
            x, y = x + push * nx, y + push * ny
    for _ in range(ROUNDS):
        before = x, y
        for wall in walls:
            if wall.distance(x, y) < radius_m:
                nx, ny, away = _from_wall(wall, x, y)
                x, y = x + (radius_m - away) * nx, y + (radius_m - away) * ny
        if (x, y) == before:
            break
    return x, y


def _add(found: list[Touch], nx: float, ny: float, gap_m: float) -> None:
    for other in found:  # two walls that are touched at their common corner count once
        if other.nx * nx + other.ny * ny > 0.999999 and abs(other.gap_m - gap_m) < 1e-9:
            return
    found.append(Touch(nx, ny, gap_m))


class ContactRow:
    """One contact: the coefficients of the four velocities, the target velocity, and the bounds of its impulse."""

    __slots__ = ("high", "impulse", "low", "mass", "q", "rubs_on", "want")

    def __init__(
        self,
        q: tuple[float, float, float, float],
        want: float,
        low: float,
        high: float,
        inverse_masses: tuple[float, float, float, float],
        rubs_on: ContactRow | None = None,
    ) -> None:
        self.q = q
        self.want = want
        self.low, self.high = low, high
        q0, q1, q2, q3 = q
        m0, m1, m2, m3 = inverse_masses
        self.mass = 1.0 / (q0 * q0 * m0 + q1 * q1 * m1 + q2 * q2 * m2 + q3 * q3 * m3)
        self.impulse = 0.0
        #: The normal row of a friction contact.  The bounds are `low` and `high` times the impulse of that row.
        self.rubs_on = rubs_on


def solve(
    velocities: list[float], rows: list[ContactRow], inverse_masses: tuple[float, float, float, float], span_s: float
) -> None:
    """Change `velocities` in place by impulses within bounds over `span_s`.  Each row stores its own impulse."""
    settled_n_s = SETTLED_N * span_s
    m0, m1, m2, m3 = inverse_masses
    v0, v1, v2, v3 = velocities
    for _ in range(ITERATIONS):
        settled = True
        for row in rows:
            q0, q1, q2, q3 = row.q
            before = row.impulse
            after = before + (row.want - (q0 * v0 + q1 * v1 + q2 * v2 + q3 * v3)) * row.mass
            base = row.rubs_on
            low, high = (row.low, row.high) if base is None else (row.low * base.impulse, row.high * base.impulse)
            if after < low:
                after = low
            elif after > high:
                after = high
            change = after - before
            if change > settled_n_s or change < -settled_n_s:
                settled = False
                row.impulse = after
                v0 += q0 * m0 * change
                v1 += q1 * m1 * change
                v2 += q2 * m2 * change
                v3 += q3 * m3 * change
        if settled:
            break
    velocities[:] = (v0, v1, v2, v3)
