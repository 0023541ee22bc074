"""Plane geometry against shapely (an independent implementation) and against formulas of another kind."""

from __future__ import annotations

from math import atan2, cos, hypot, inf, pi, sin

import pytest
import shapely
from hypothesis import assume, example, given
from hypothesis import strategies as st

from hil.world.geometry import TOUCH_M, Post, Segment, cast, clearance, corners, in_sight

metre = st.floats(-10, 10)
course = st.floats(-pi, pi)


@st.composite
def segments(draw: st.DrawFn) -> Segment:
    ax, ay, bx, by = (draw(metre) for _ in range(4))
    assume(hypot(bx - ax, by - ay) > 1e-3)
    return Segment(ax, ay, bx, by)


def line(wall: Segment) -> shapely.LineString:
    return shapely.LineString([(wall.ax, wall.ay), (wall.bx, wall.by)])


@given(wall=segments(), x=metre, y=metre)
def test_distance_and_nearest_point_agree_with_shapely(wall: Segment, x: float, y: float) -> None:
    want = line(wall).distance(shapely.Point(x, y))
    assert wall.distance(x, y) == pytest.approx(want, abs=1e-9)
    px, py = wall.nearest(x, y)
    assert hypot(px - x, py - y) == pytest.approx(want, abs=1e-9)
    assert line(wall).distance(shapely.Point(px, py)) < 1e-9


@given(wall=segments(), x=metre, y=metre, way=course)
def test_a_ray_hits_where_two_lines_solve_to(wall: Segment, x: float, y: float, way: float) -> None:
    """Cramer's rule on the two parametric lines, and shapely as a judge of hits away from the brink."""
    dx, dy = cos(way), sin(way)
    ex, ey = wall.bx - wall.ax, wall.by - wall.ay
    determinant = ex * dy - ey * dx
    assume(abs(determinant) > 1e-6)
    reach = (ex * (wall.ay - y) - ey * (wall.ax - x)) / determinant
    share = (dx * (wall.ay - y) - dy * (wall.ax - x)) / determinant
    assume(abs(reach) > 1e-6)
    past_m = max(-share, share - 1) * wall.length_m
    got = wall.ray(x, y, dx, dy)
    if reach > 0 and past_m <= 0:
        assert got == pytest.approx(reach, rel=1e-6, abs=1e-7)
        beam = shapely.LineString([(x, y), (x + 2 * reach * dx, y + 2 * reach * dy)])
        assert beam.intersects(line(wall)) or past_m > -1e-6
    elif reach > 0 and past_m < 2 * TOUCH_M:
        assert got in (inf, pytest.approx(reach, rel=1e-6, abs=2 * TOUCH_M))
    else:
        assert got == inf


@given(cx=metre, cy=metre, radius=st.floats(0.01, 2), x=metre, y=metre, aside=st.floats(-3, 3))
def test_a_ray_hits_a_post_by_pythagoras(cx: float, cy: float, radius: float, x: float, y: float, aside: float) -> None:
    """A ray that passes the middle at a known distance enters at sqrt(d2 - p2) - sqrt(r2 - p2)."""
    away = hypot(cx - x, cy - y)
    assume(away > radius + 0.05 and abs(aside) < away and abs(abs(aside) - radius) > 1e-6)
    from math import asin

    way = atan2(cy - y, cx - x) + asin(aside / away)
    got = Post(cx, cy, radius).ray(x, y, cos(way), sin(way))
    if abs(aside) < radius:
        want = (away**2 - aside**2) ** 0.5 - (radius**2 - aside**2) ** 0.5
        assert got == pytest.approx(want, abs=1e-6)
    else:
        assert got == inf


@given(wall=segments(), px=metre, py=metre, qx=metre, qy=metre)
def test_a_wall_in_the_line_of_sight_is_one_that_shapely_says_crosses(
    wall: Segment, px: float, py: float, qx: float, qy: float
) -> None:
    assume(hypot(qx - px, qy - py) > 1e-3)
    sight = shapely.LineString([(px, py), (qx, qy)])
    # away from the brink: no end of either lies within 1e-5 of the other
    ends = [shapely.Point(px, py), shapely.Point(qx, qy)]
    assume(all(line(wall).distance(end) > 1e-5 for end in ends))
    assume(all(sight.distance(shapely.Point(x, y)) > 1e-5 for x, y in ((wall.ax, wall.ay), (wall.bx, wall.by))))
    assert wall.crosses(px, py, qx, qy) == sight.crosses(line(wall))


@given(wall=segments(), x=metre, y=metre)
def test_a_mirror_image_is_as_far_behind_and_mirrors_back(wall: Segment, x: float, y: float) -> None:
    ix, iy = wall.mirror(x, y)
    assert wall.side(ix, iy) == pytest.approx(-wall.side(x, y), abs=1e-9)
    assert wall.along(ix, iy) == pytest.approx(wall.along(x, y), abs=1e-9)
    assert wall.mirror(ix, iy) == pytest.approx((x, y), abs=1e-9)


@given(walls=st.lists(segments(), min_size=1, max_size=6), x=metre, y=metre, way=course)
# the rounding of where the ray meets the line of the nearer wall puts it 1e-16 m beyond that wall's end
@example(walls=[Segment(1.0, 0.0, 0.0, 1.0), Segment(0.125, 0.0, 0.0, 1.0)], x=-3.0, y=0.0, way=0.0)
def test_the_first_thing_hit_is_in_sight_and_the_clearance_is_shapelys(
    walls: list[Segment], x: float, y: float, way: float
) -> None:
    union = shapely.MultiLineString([line(wall) for wall in walls])
    assert clearance(x, y, walls, ()) == pytest.approx(union.distance(shapely.Point(x, y)), abs=1e-9)
    away, thing = cast(x, y, cos(way), sin(way), walls)
    if thing is not None:
        short = max(0.0, away - 1e-4)
        assert in_sight(x, y, x + short * cos(way), y + short * sin(way), walls, ())
        assert away >= clearance(x, y, walls, ()) - 1e-9


@given(x=st.floats(0.1, 1.9), y=st.floats(0.1, 2.9), turn=course)
def test_no_ray_leaves_a_room_through_its_corner(x: float, y: float, turn: float) -> None:
    """A room of 2 m by 3 m, turned about the origin, and rays to its corners."""
    c, s = cos(turn), sin(turn)
    points = [(c * px - s * py, s * px + c * py) for px, py in ((0, 0), (2, 0), (2, 3), (0, 3))]
    walls = [Segment(*points[k - 1], *points[k]) for k in range(4)]
    x, y = c * x - s * y, s * x + c * y
    for px, py in points:
        away = hypot(px - x, py - y)
        assert cast(x, y, (px - x) / away, (py - y) / away, walls)[0] == pytest.approx(away, abs=1e-5)


def test_a_square_has_four_concave_corners_of_90_degrees() -> None:
    points = [(0, 0), (2, 0), (2, 2), (0, 2), (0, 0)]
    walls = [Segment(*points[k], *points[k + 1]) for k in range(4)]
    found = corners(walls)
    assert sorted((round(c.x_m), round(c.y_m)) for c in found) == [(0, 0), (0, 2), (2, 0), (2, 2)]
    for corner in found:
        assert corner.opening_deg == pytest.approx(90.0)
        # the bisector points to the middle of the square
        assert corner.dx * (1 - corner.x_m) + corner.dy * (1 - corner.y_m) == pytest.approx(2**0.5)


@pytest.mark.parametrize("bad", [(0, 0, 0, 0), (0, 0, inf, 1), (float("nan"), 0, 1, 1)])
def test_a_wall_without_length_or_finite_ends_is_refused(bad: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="ends must be finite and apart"):
        Segment(*bad)


@pytest.mark.parametrize(("x", "radius"), [(0.0, 0.0), (0.0, -1.0), (inf, 1.0), (0.0, float("nan"))])
def test_a_post_without_size_or_place_is_refused(x: float, radius: float) -> None:
    with pytest.raises(ValueError, match="must be finite, radius above 0"):
        Post(x, 0.0, radius)
