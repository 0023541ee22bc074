"""What a sonar hears: mirrors, corners, posts, occlusion, cross-talk."""

from __future__ import annotations

from math import cos, hypot, pi, radians, sin

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from hil.world import SonarMount, SonarRays
from hil.world.geometry import Post, Segment

HERE = {"FRONT": SonarMount(0.0, 0.0, 0.0)}
WALL = Segment(2.0, -5.0, 2.0, 5.0)


def looking(degrees: float, x: float = 0.0, y: float = 0.0) -> tuple[float, float, float]:
    return x, y, radians(degrees)


@pytest.mark.parametrize(
    ("off_deg", "strength"), [(0, 1.0), (20, 1.0), (-20, 1.0), (25, 0.5), (-25, 0.5), (30, 0.0), (45, 0.0), (180, 0.0)]
)
def test_a_wall_answers_from_its_perpendicular_certainly_to_20_degrees_and_never_from_30(
    off_deg: float, strength: float
) -> None:
    # EZ model: 20 degrees certain, fading in a straight line to nothing at 30; 2.0 m whatever the angle
    echo = SonarRays([WALL], mounts=HERE).echo("FRONT", looking(off_deg))
    assert echo == (None if strength == 0.0 else (2.0, pytest.approx(strength)))


@given(x=st.floats(-3, 3), y=st.floats(-3, 3), off=st.floats(-19, 19), tilt=st.floats(-180, 180))
def test_the_range_is_the_distance_to_the_line_when_the_foot_is_on_the_wall(
    x: float, y: float, off: float, tilt: float
) -> None:
    """A 4 m wall turned anywhere; shapely says the distance, the dot product whether the foot is on it."""
    ux, uy = cos(radians(tilt)), sin(radians(tilt))
    wall = Segment(-2 * ux, -2 * uy, 2 * ux, 2 * uy)
    away = shapely.LineString([(-9 * ux, -9 * uy), (9 * ux, 9 * uy)]).distance(shapely.Point(x, y))
    along = x * ux + y * uy
    if away < 0.01 or abs(abs(along) - 2.0) < 1e-6:
        return
    side = -uy * x + ux * y
    toward = tilt - 90.0 if side > 0 else tilt + 90.0
    echo = SonarRays([wall], mounts=HERE).echo("FRONT", looking(toward + off, x, y))
    if abs(along) < 2.0:
        assert echo == (pytest.approx(away, abs=1e-9), 1.0)
    else:
        assert echo is None


def test_nothing_beyond_254_inches_answers() -> None:
    # 254 in = 6.4516 m
    assert SonarRays([Segment(6.45, -1, 6.45, 1)], mounts=HERE).echo("FRONT", looking(0)) == (6.45, 1.0)
    assert SonarRays([Segment(6.46, -1, 6.46, 1)], mounts=HERE).echo("FRONT", looking(0)) is None


def test_a_nearer_wall_hides_a_farther_one_even_when_it_does_not_answer() -> None:
    slanted = Segment(0.5, -0.5, 1.5, 0.5)  # 45 degrees: throws the sound away
    rays = SonarRays([WALL, slanted], mounts=HERE)
    assert rays.echo("FRONT", looking(0)) is None
    assert SonarRays([WALL], mounts=HERE).echo("FRONT", looking(0)) == (2.0, 1.0)


def test_of_several_the_nearest_comes_first_and_an_uncertain_one_lets_the_next_be_heard() -> None:
    near = Segment(1.0, -0.7, 1.2, -0.1)  # its perpendicular (foot at 0.3 m from its end) is 18 degrees off
    rays = SonarRays([WALL, near], [Post(1.5, 0.3, 0.04)], mounts=HERE)
    ranges = [away for away, _ in rays.reflectors("FRONT", looking(0))]
    assert ranges == sorted(ranges)
    echo = rays.echoes("FRONT", looking(25.0))
    # 25 degrees off: the wall at 2 m is heard half the time; the post at 11.3 degrees, 13.7 off, always
    assert echo is not None
    assert echo.range_m == pytest.approx(hypot(1.5, 0.3) - 0.04)
    assert echo.behind is None


@pytest.mark.parametrize("off_deg", [0, 10, -14])
def test_a_corner_of_90_degrees_answers_at_its_own_distance(off_deg: float) -> None:
    # Both walls are 45 degrees off and silent; the corner at (1, 1) is sqrt 2 away at 45 degrees
    rays = SonarRays([Segment(1, -1, 1, 1), Segment(1, 1, -1, 1)], mounts=HERE)
    assert rays.echo("FRONT", looking(45 + off_deg)) == (pytest.approx(2**0.5), 1.0)


@pytest.mark.parametrize(("opening", "strength"), [(90, 1.0), (94, 1.0), (100, 0.5), (110, 0.0), (118, 0.0), (60, 0.0)])
def test_a_corner_answers_only_when_it_is_nearly_square(opening: float, strength: float) -> None:
    # CHOICE of the module: fully to 5 degrees off the right angle, not at all from 15
    half = radians(opening / 2)
    arms = [Segment(2, 0, 2 - 2 * cos(half), side * 2 * sin(half)) for side in (1, -1)]
    echo = SonarRays(arms, mounts=HERE).echo("FRONT", looking(0))
    assert echo == (None if strength == 0.0 else (pytest.approx(2.0), pytest.approx(strength)))


def test_a_convex_corner_is_silent() -> None:
    arms = [Segment(1, 0, 2, 1), Segment(1, 0, 2, -1)]
    assert SonarRays(arms, mounts=HERE).echo("FRONT", looking(0)) is None


@pytest.mark.parametrize(
    ("diameter", "heard", "silent"),
    # EZ plots at 3.3 V: 0.25 in to 2.9 ft = 0.88 m, 1 in to 6.6 ft = 2.01 m, 3.25 in to 8.9 ft = 2.71 m
    [(0.00635, 0.87, 0.90), (0.0254, 2.0, 2.03), (0.08255, 2.70, 2.73)],
)
def test_a_post_is_heard_as_far_as_its_diameter_allows(diameter: float, heard: float, silent: float) -> None:
    for away, there in ((heard, True), (silent, False)):
        post = Post(away + diameter / 2, 0.0, diameter / 2)
        echo = SonarRays([], [post], HERE).echo("FRONT", looking(0))
        assert echo == ((pytest.approx(away), 1.0) if there else None)


def test_a_post_is_heard_to_17_degrees_and_not_from_20() -> None:
    for off, strength in ((17.0, 1.0), (18.5, 0.5), (20.0, 0.0)):
        echo = SonarRays([], [Post(1.04, 0, 0.04)], HERE).echo("FRONT", looking(off))
        assert echo == (None if strength == 0 else (pytest.approx(1.0), pytest.approx(strength)))


def test_the_default_sonars_look_ahead_left_and_right_from_where_they_sit() -> None:
    rays = SonarRays([])
    pose = (1.0, 2.0, pi / 2)  # facing +y: left is -x
    assert rays.placed("FRONT", pose) == pytest.approx((1.0, 2.09, pi / 2))
    assert rays.placed("LEFT", pose) == pytest.approx((0.945, 2.055, pi))
    assert rays.placed("RIGHT", pose) == pytest.approx((1.055, 2.055, 0.0))
    with pytest.raises(ValueError, match="no sonar 'BACK' on this robot; there are LEFT, FRONT, RIGHT"):
        rays.placed("BACK", pose)


PAIR = {"A": SonarMount(0.0, 0.3, 0.0), "B": SonarMount(0.0, -0.3, 0.0)}


def test_cross_talk_goes_by_way_of_the_mirror_point() -> None:
    # 0.3 m to each side of a perpendicular of 2 m: twice sqrt(2^2 + 0.3^2)
    want = 2.0 * hypot(2.0, 0.3)
    rays = SonarRays([WALL], mounts=PAIR)
    assert rays.cross_path("A", "B", looking(0)) == pytest.approx(want)
    assert rays.cross_path("B", "A", looking(0)) == pytest.approx(want)
    # a screen between the two legs' point of reflection and B hides it
    screen = Segment(1.0, -0.05, 1.0, -0.4)
    assert SonarRays([WALL, screen], mounts=PAIR).cross_path("A", "B", looking(0)) is None


def test_cross_talk_by_way_of_a_post_is_the_way_there_and_back() -> None:
    rays = SonarRays([], [Post(1.5, 0.0, 0.05)], PAIR)
    assert rays.cross_path("A", "B", looking(0)) == pytest.approx(2.0 * (hypot(1.5, 0.3) - 0.05))


def test_sonars_that_look_apart_do_not_hear_each_other() -> None:
    # Front and left look 90 degrees apart: one mirror would have to stand 45 degrees off both
    rays = SonarRays([Segment(0.5, 0.5, 1.5, 1.5), WALL, Segment(-3, 1, 3, 1)])
    assert rays.cross_path("FRONT", "LEFT", (0.0, 0.0, 0.0)) is None
