"""Draws the arena as SVG text.  Colours are classes of the page's style sheet (`style.py`)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from math import atan2, cos, degrees, hypot, radians, sin
from typing import Final

from emulator.devices.lv_maxsonar_beam import OBJECT_HALF_ANGLE_RAD
from hil.machine import Wall
from hil.world.robot_params import Pose, RobotParams

Point = tuple[float, float]

WIDTH: Final = 1000
HEIGHT: Final = 640
MARGIN: Final = 34
#: The possible distances between two lines of the grid.
STEPS_M: Final = (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100)
#: The height of the buttons at the upper edge; the width and height of the numbers at the left and the lower edge.
TOOLS_PX: Final = 40
NUMBERS_PX: Final = (38, 18)
#: An obstacle can be dragged within this distance of its edge, and a small robot within this number of pixels.
GRIP_M: Final = 0.05
GRIP_PX: Final = 16
ARROW_PX: Final = 16
BODY: Final = RobotParams()
#: The legend: colours and their meanings.
LEGEND: Final = (
    ("--true", "robot and path"), ("--odo", "odometry"), ("--beam", "measured by the sonars"),
    ("--real", "true ray and echo"), ("--cloud", "points in the frames"),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Beam:
    """A sonar in the world's frame: its pose, the distance that the firmware measured, and the true distances."""

    name: str
    x_m: float
    y_m: float
    heading_rad: float
    measured_m: float
    #: The distance to the first wall or post straight ahead; the sonar's range if there is none.
    ray_m: float
    #: The distance to the object that returns the first echo, which may be off the axis; None: there is no echo.
    echo_m: float | None


@dataclass(frozen=True, slots=True)
class Obstacle:
    """A round obstacle."""

    name: str
    x_m: float
    y_m: float
    radius_m: float


@dataclass(frozen=True, slots=True)
class VisibleArea:
    """The visible area, in units of the picture; `unit` is the size of a pixel in these units."""

    x: float = 0.0
    y: float = 0.0
    width: float = WIDTH
    height: float = HEIGHT
    unit: float = 1.0

    def holds(self, x: float, y: float) -> bool:
        """Whether a point of the picture is visible."""
        return self.x <= x <= self.x + self.width and self.y <= y <= self.y + self.height


@dataclass(frozen=True, slots=True)
class Viewport:
    """Converts metres to units of the picture: `scale` units per metre; (left, top) is the origin of the picture."""

    left_m: float
    top_m: float
    scale: float

    @classmethod
    def around(cls, points: Iterable[Point], least_m: float = 2.0) -> Viewport:
        """The viewport that shows all points, in the middle."""
        xs, ys = zip(*points, strict=True)
        width, height = max(max(xs) - min(xs), least_m), max(max(ys) - min(ys), least_m * HEIGHT / WIDTH)
        scale = min((WIDTH - 2 * MARGIN) / width, (HEIGHT - 2 * MARGIN) / height)
        x, y = (max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2
        return cls(x - WIDTH / 2 / scale, y + HEIGHT / 2 / scale, scale)

    def to_picture(self, x_m: float, y_m: float) -> Point:
        """The point of the picture for a point of the world."""
        return (x_m - self.left_m) * self.scale, (self.top_m - y_m) * self.scale

    def to_world(self, x: float, y: float) -> Point:
        """The point of the world for a point of the picture."""
        return self.left_m + x / self.scale, self.top_m - y / self.scale

    def extent(self, points: Iterable[Point]) -> tuple[float, float, float, float]:
        """The left, top, width and height of the rectangle around all points, with a margin."""
        xs, ys = zip(*(self.to_picture(*point) for point in points), strict=True)
        return min(xs) - MARGIN, min(ys) - MARGIN, max(xs) - min(xs) + 2 * MARGIN, max(ys) - min(ys) + 2 * MARGIN


def grid(view: Viewport, seen: VisibleArea) -> str:
    """The lines of the grid in the visible area, with their numbers at its edges."""
    pixels_per_m = view.scale / seen.unit
    step = next(s for s in STEPS_M if s * pixels_per_m >= 64 or s == STEPS_M[-1])
    x0, y1 = view.to_world(seen.x, seen.y)
    x1, y0 = view.to_world(seen.x + seen.width, seen.y + seen.height)
    lines, texts = [], []
    for index in range(int(x0 // step), int(x1 // step) + 2):
        x, _ = view.to_picture(index * step, 0)
        lines.append(f"M{x:.1f} {seen.y:.1f}v{seen.height:.1f}")
        if seen.x <= x <= seen.x + seen.width - NUMBERS_PX[0] * seen.unit:  # or it is cut
            texts.append((x + 3 * seen.unit, seen.y + seen.height - 5 * seen.unit, index * step))
    for index in range(int(y0 // step), int(y1 // step) + 2):
        _, y = view.to_picture(0, index * step)
        lines.append(f"M{seen.x:.1f} {y:.1f}h{seen.width:.1f}")
        # Otherwise it would be on the numbers of the lower edge, or below the buttons.
        if seen.y + (TOOLS_PX + 12) * seen.unit < y < seen.y + seen.height - 20 * seen.unit:
            texts.append((seen.x + 4 * seen.unit, y - 3 * seen.unit, index * step))
    numbers = "".join(f'<text x="{x:.1f}" y="{y:.1f}">{value:g} m</text>' for x, y, value in texts)
    return f'<g class="grid"><path d="{"".join(lines)}"/>{numbers}</g>'


def walls(view: Viewport, segments: Iterable[Wall]) -> str:
    """The walls."""
    parts = []
    for a, b in segments:
        (ax, ay), (bx, by) = view.to_picture(*a), view.to_picture(*b)
        parts.append(f"M{ax:.1f} {ay:.1f}L{bx:.1f} {by:.1f}")
    return f'<path class="wall" d="{"".join(parts)}"/>'


def obstacles(view: Viewport, posts: Iterable[Obstacle]) -> str:
    """The posts and obstacles."""
    parts = []
    for post in posts:
        x, y = view.to_picture(post.x_m, post.y_m)
        parts.append(
            f'<circle class="post" cx="{x:.1f}" cy="{y:.1f}" r="{post.radius_m * view.scale:.1f}"/>'
            f'<circle class="grip" cx="{x:.1f}" cy="{y:.1f}" r="{(post.radius_m + GRIP_M) * view.scale:.1f}">'
            f"<title>{escape(post.name)}</title></circle>"
        )
    return "".join(parts)


def robot(view: Viewport, pose: Pose, css: str, *, bumper: bool = False, unit: float = 1.0) -> str:
    """The body, its wheels and an arrow for its heading.  The arrow is visible however small the body is.

    `unit` is the size of a pixel in units of the picture.
    """
    x, y = view.to_picture(pose.x_m, pose.y_m)
    s = view.scale
    ahead, radius, half = BODY.body_ahead_m * s, BODY.body_radius_m * s, BODY.track_m / 2 * s
    wheel = BODY.wheel_radius_m * s
    pressed = f'<path class="pressed" d="M{ahead + radius:.1f} {-half:.1f}v{2 * half:.1f}"/>' if bumper else ""
    tip, barb = max(ahead + radius, ARROW_PX * unit) + 3 * unit, 5 * unit
    return (
        f'<g class="{css}" transform="translate({x:.1f} {y:.1f}) rotate({-degrees(pose.heading_rad):.2f})">'
        f'<circle cx="{ahead:.1f}" cy="0" r="{radius:.1f}"/>'
        f'<path d="M{-wheel:.1f} {-half:.1f}h{2 * wheel:.1f}M{-wheel:.1f} {half:.1f}h{2 * wheel:.1f}"/>'
        f'<path class="nose" d="M0 0H{tip:.1f}M{tip - barb:.1f} {-barb:.1f}L{tip:.1f} 0L{tip - barb:.1f} {barb:.1f}"/>'
        f'{pressed}<circle class="grip" cx="{ahead:.1f}" cy="0" r="{max(radius, GRIP_PX * unit):.1f}"/></g>'
    )


def out_of_sight(view: Viewport, pose: Pose, seen: VisibleArea, text: str) -> str:
    """An arrow at the edge that points to a pose outside of the visible area, with the distance; else empty.

    The distance is measured from the middle of the visible area.
    """
    x, y = view.to_picture(pose.x_m, pose.y_m)
    if seen.holds(x, y):
        return ""
    middle_x, middle_y = seen.x + seen.width / 2, seen.y + seen.height / 2
    away_x, away_y = x - middle_x, y - middle_y
    inset = 22 * seen.unit
    share = min(
        (seen.width / 2 - inset) / abs(away_x) if away_x else 1.0,
        (seen.height / 2 - inset) / abs(away_y) if away_y else 1.0,
    )
    at_x, at_y = middle_x + share * away_x, middle_y + share * away_y
    distance_m = hypot(away_x, away_y) / view.scale
    u, turn = seen.unit, degrees(atan2(away_y, away_x))
    right = at_x > middle_x
    return (
        f'<g class="away"><path transform="translate({at_x:.1f} {at_y:.1f}) rotate({turn:.1f})" '
        f'd="M{-6 * u:.1f} {-7 * u:.1f}L{8 * u:.1f} 0L{-6 * u:.1f} {7 * u:.1f}Z"/>'
        f'<text x="{at_x - 14 * u if right else at_x + 14 * u:.1f}" y="{at_y + 4 * u:.1f}" '
        f'text-anchor="{"end" if right else "start"}">{escape(text)}, {distance_m:.2f} m away</text></g>'
    )


def beams(view: Viewport, sonars: Iterable[Beam], unit: float = 1.0) -> str:
    """The beams of the sonars: the cone up to the measured distance, the true ray, and the echo."""
    parts = []
    cross = 4.5 * unit
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
            f'<path class="hit" d="M{hx - cross:.1f} {hy - cross:.1f}l{2 * cross:.1f} {2 * cross:.1f}'
            f'm0 {-2 * cross:.1f}l{-2 * cross:.1f} {2 * cross:.1f}"/>'
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
    """A path as a line."""
    if len(points) < 2:
        return ""
    drawn = " ".join(f"{x:.1f},{y:.1f}" for x, y in (view.to_picture(*p) for p in points))
    return f'<polyline class="{css}" points="{drawn}"/>'


def dots(view: Viewport, points: Sequence[Point], css: str) -> str:
    """A cloud of points.  It is one SVG path of strokes without length."""
    if not points:
        return ""
    drawn = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in (view.to_picture(*p) for p in points))
    return f'<path class="{css}" d="{drawn}"/>'
