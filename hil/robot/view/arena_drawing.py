"""The arena as SVG: text out of numbers, nothing else.  Colours are classes of the page's style sheet (`style.py`)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from math import cos, degrees, radians, sin
from typing import Final

from emulator.devices.lv_maxsonar_beam import OBJECT_HALF_ANGLE_RAD
from hil.machine import Wall
from hil.robot.view.scene import Beam, Obstacle
from hil.world.robot_params import Pose, RobotParams

Point = tuple[float, float]

WIDTH: Final = 1000
HEIGHT: Final = 640
MARGIN: Final = 34
BODY: Final = RobotParams()


@dataclass(frozen=True, slots=True)
class Viewport:
    """Metres to picture: `scale` units a metre, the world's (left, top) at the picture's margin."""

    left_m: float
    top_m: float
    scale: float

    @classmethod
    def around(cls, points: Iterable[Point], least_m: float = 2.0) -> Viewport:
        """Everything in sight, in the middle."""
        xs, ys = zip(*points, strict=True)
        width, height = max(max(xs) - min(xs), least_m), max(max(ys) - min(ys), least_m * HEIGHT / WIDTH)
        scale = min((WIDTH - 2 * MARGIN) / width, (HEIGHT - 2 * MARGIN) / height)
        x, y = (max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2
        return cls(x - WIDTH / 2 / scale, y + HEIGHT / 2 / scale, scale)

    def to_picture(self, x_m: float, y_m: float) -> Point:
        """Where a point of the world is drawn."""
        return (x_m - self.left_m) * self.scale, (self.top_m - y_m) * self.scale

    def to_world(self, x: float, y: float) -> Point:
        """Which point of the world was clicked."""
        return self.left_m + x / self.scale, self.top_m - y / self.scale

    def holds(self, x_m: float, y_m: float) -> bool:
        """Whether a point is in sight."""
        x, y = self.to_picture(x_m, y_m)
        return 0 <= x <= WIDTH and 0 <= y <= HEIGHT


def grid(view: Viewport) -> str:
    """Lines each metre (or less often), with their numbers."""
    step = next(s for s in (0.5, 1, 2, 5, 10, 20, 50, 100) if s * view.scale >= 60 or s == 100)
    lines = []
    x0, y1 = view.to_world(0, 0)
    x1, y0 = view.to_world(WIDTH, HEIGHT)
    for index in range(int(x0 // step) + 1, int(x1 // step) + 1):
        x, _ = view.to_picture(index * step, 0)
        lines.append(f'<path d="M{x:.1f} 0V{HEIGHT}"/><text x="{x + 3:.1f}" y="{HEIGHT - 5}">{index * step:g} m</text>')
    for index in range(int(y0 // step) + 1, int(y1 // step) + 1):
        _, y = view.to_picture(0, index * step)
        lines.append(f'<path d="M0 {y:.1f}H{WIDTH}"/><text x="4" y="{y - 3:.1f}">{index * step:g} m</text>')
    return f'<g class="grid">{"".join(lines)}</g>'


def walls(view: Viewport, segments: Iterable[Wall]) -> str:
    """Walls."""
    parts = []
    for a, b in segments:
        (ax, ay), (bx, by) = view.to_picture(*a), view.to_picture(*b)
        parts.append(f"M{ax:.1f} {ay:.1f}L{bx:.1f} {by:.1f}")
    return f'<path class="wall" d="{"".join(parts)}"/>'


def obstacles(view: Viewport, posts: Iterable[Obstacle]) -> str:
    """Posts and obstacles."""
    parts = []
    for post in posts:
        x, y = view.to_picture(post.x_m, post.y_m)
        parts.append(
            f'<circle class="post" cx="{x:.1f}" cy="{y:.1f}" r="{post.radius_m * view.scale:.1f}">'
            f"<title>{escape(post.name)}</title></circle>"
        )
    return "".join(parts)


def robot(view: Viewport, pose: Pose, css: str, *, bumper: bool = False) -> str:
    """The body, its wheels and where it looks."""
    x, y = view.to_picture(pose.x_m, pose.y_m)
    s = view.scale
    ahead, radius, half = BODY.body_ahead_m * s, BODY.body_radius_m * s, BODY.track_m / 2 * s
    wheel = BODY.wheel_radius_m * s
    pressed = f'<path class="pressed" d="M{ahead + radius:.1f} {-half:.1f}v{2 * half:.1f}"/>' if bumper else ""
    return (
        f'<g class="{css}" transform="translate({x:.1f} {y:.1f}) rotate({-degrees(pose.heading_rad):.2f})">'
        f'<circle cx="{ahead:.1f}" cy="0" r="{radius:.1f}"/>'
        f'<path d="M{-wheel:.1f} {-half:.1f}h{2 * wheel:.1f}M{-wheel:.1f} {half:.1f}h{2 * wheel:.1f}'
        f'M0 0h{ahead + radius:.1f}"/>{pressed}</g>'
    )


def beams(view: Viewport, sonars: Iterable[Beam]) -> str:
    """Each sonar: the cone up to what was measured, the ray to what stands there, the point that answers."""
    parts = []
    for beam in sonars:
        x, y = view.to_picture(beam.x_m, beam.y_m)
        r = min(beam.measured_m, 6.45) * view.scale
        half, turn = OBJECT_HALF_ANGLE_RAD, beam.heading_rad
        ax, ay = x + r * cos(turn - half), y - r * sin(turn - half)
        bx, by = x + r * cos(turn + half), y - r * sin(turn + half)
        hit = beam.ray_m * view.scale
        hx, hy = x + hit * cos(turn), y - hit * sin(turn)
        parts.append(
            f'<path class="beam" d="M{x:.1f} {y:.1f}L{ax:.1f} {ay:.1f}A{r:.1f} {r:.1f} 0 0 0 {bx:.1f} {by:.1f}Z"/>'
            f'<path class="measured" d="M{ax:.1f} {ay:.1f}A{r:.1f} {r:.1f} 0 0 0 {bx:.1f} {by:.1f}"/>'
            f'<path class="ray" d="M{x:.1f} {y:.1f}L{hx:.1f} {hy:.1f}"/>'
            f'<path class="hit" d="M{hx - 5:.1f} {hy - 5:.1f}l10 10m0 -10l-10 10"/>'
        )
        if beam.echo_m is not None:
            e = beam.echo_m * view.scale
            parts.append(f'<path class="echo" d="{_arc(x, y, e, turn, radians(4.0))}"/>')
    return "".join(parts)


def _arc(x: float, y: float, r: float, turn: float, half: float) -> str:
    ax, ay = x + r * cos(turn - half), y - r * sin(turn - half)
    bx, by = x + r * cos(turn + half), y - r * sin(turn + half)
    return f"M{ax:.1f} {ay:.1f}A{r:.1f} {r:.1f} 0 0 0 {bx:.1f} {by:.1f}"


def path(view: Viewport, points: Sequence[Point], css: str) -> str:
    """A trajectory."""
    if len(points) < 2:
        return ""
    drawn = " ".join(f"{x:.1f},{y:.1f}" for x, y in (view.to_picture(*p) for p in points))
    return f'<polyline class="{css}" points="{drawn}"/>'


def dots(view: Viewport, points: Sequence[Point], css: str) -> str:
    """A cloud of points: one path of strokes without length."""
    if not points:
        return ""
    drawn = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in (view.to_picture(*p) for p in points))
    return f'<path class="{css}" d="{drawn}"/>'
