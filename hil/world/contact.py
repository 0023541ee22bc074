"""Sliding and bumping: one implicit step of wheels, tyres and walls, by bounded impulses.

Velocities (wheel, wheel, forward, yaw) meet in up to a handful of contacts, each of which wants a relative velocity
of zero and may use only so much impulse: dry friction of a motor, grip of a tyre, a wall that pushes but never
pulls, and its rubbing.  They are solved in a fixed order until settled (projected Gauss-Seidel), which is stable for
any step and gives the same result every time.

Modelled
    Coulomb friction in motors, between tyre and floor along the wheel, between body and wall; inelastic impact.
Not modelled
    Sideways slip of the tyres, elasticity, a friction coefficient that falls with speed.
Sources
    Standard rigid-body contact; coefficients are CHOICEs of robot.RobotParams.
"""

from __future__ import annotations

from typing import Final

from hil.world.geometry import Post, Segment

#: Passes at most; solving ends when no impulse changes by more than this (N.s, or N.m.s about a wheel).
ITERATIONS: Final = 16
SETTLED_N_S: Final = 1e-9


class Touch:
    """A point of the round body near something solid: (nx, ny) points from it to the body, `gap_m` is what is left."""

    __slots__ = ("gap_m", "nx", "ny")

    def __init__(self, nx: float, ny: float, gap_m: float) -> None:
        self.nx, self.ny, self.gap_m = nx, ny, gap_m


def touches(
    x: float, y: float, radius_m: float, within_m: float, walls: tuple[Segment, ...], posts: list[Post]
) -> list[Touch]:
    """What is nearer than `within_m` to a disc of `radius_m` about (x, y)."""
    found: list[Touch] = []
    reach = radius_m + within_m
    for wall in walls:
        if wall.distance(x, y) < reach:
            px, py = wall.nearest(x, y)
            _add(found, x - px, y - py, radius_m)
    for post in posts:
        if post.distance(x, y) < reach:
            dx, dy = x - post.x_m, y - post.y_m
            _add(found, dx, dy, radius_m + post.radius_m)
    return found


def _add(found: list[Touch], dx: float, dy: float, radius_m: float) -> None:
    away = (dx * dx + dy * dy) ** 0.5
    if away < 1e-12:
        return
    nx, ny = dx / away, dy / away
    gap = away - radius_m
    for other in found:  # two walls touched at their common corner are one touch
        if other.nx * nx + other.ny * ny > 0.999999 and abs(other.gap_m - gap) < 1e-9:
            return
    found.append(Touch(nx, ny, gap))


class Row:
    """One contact: coefficients of the four velocities, wanted velocity, bounds of its impulse."""

    __slots__ = ("high", "impulse", "low", "mass", "q", "rubs_on", "want")

    def __init__(
        self,
        q: tuple[float, float, float, float],
        want: float,
        low: float,
        high: float,
        inverse_masses: tuple[float, float, float, float],
        rubs_on: Row | None = None,
    ) -> None:
        self.q = q
        self.want = want
        self.low, self.high = low, high
        q0, q1, q2, q3 = q
        m0, m1, m2, m3 = inverse_masses
        self.mass = 1.0 / (q0 * q0 * m0 + q1 * q1 * m1 + q2 * q2 * m2 + q3 * q3 * m3)
        self.impulse = 0.0
        #: Friction: its bounds are `low`, `high` times that normal row's impulse.
        self.rubs_on = rubs_on


def solve(velocities: list[float], rows: list[Row], inverse_masses: tuple[float, float, float, float]) -> None:
    """Change `velocities` in place by impulses within bounds; leaves each row's impulse in it."""
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
            if change > SETTLED_N_S or change < -SETTLED_N_S:
                settled = False
                row.impulse = after
                v0 += q0 * m0 * change
                v1 += q1 * m1 * change
                v2 += q2 * m2 * change
                v3 += q3 * m3 * change
        if settled:
            break
    velocities[:] = (v0, v1, v2, v3)
