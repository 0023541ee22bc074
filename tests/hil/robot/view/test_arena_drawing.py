"""Metres to picture and back; what is drawn is where it is."""

from __future__ import annotations

import itertools
import re
from math import isclose, pi

from hypothesis import given
from hypothesis import strategies as st

from hil.robot.view import arena_drawing as draw
from hil.robot.view.arena_drawing import Beam, Obstacle, Viewport, VisibleArea
from hil.world.robot_params import Pose

metres = st.floats(-50.0, 50.0)
points = st.lists(st.tuples(metres, metres), min_size=1, max_size=20)


@given(points, metres, metres)
def test_a_click_is_the_point_that_is_drawn_there(around: list[tuple[float, float]], x: float, y: float) -> None:
    view = Viewport.around(around)
    back = view.to_world(*view.to_picture(x, y))
    assert isclose(back[0], x, abs_tol=1e-9)
    assert isclose(back[1], y, abs_tol=1e-9)


@given(points)
def test_everything_is_in_sight(around: list[tuple[float, float]]) -> None:
    view = Viewport.around(around)
    seen = VisibleArea(*view.extent(around))
    assert all(seen.holds(*view.to_picture(*point)) for point in around)


def test_up_in_the_world_is_up_in_the_picture() -> None:
    view = Viewport.around([(0.0, 0.0), (2.0, 1.0)])
    assert view.to_picture(0.0, 1.0)[1] < view.to_picture(0.0, 0.0)[1]
    assert view.to_picture(1.0, 0.0)[0] > view.to_picture(0.0, 0.0)[0]


def test_the_robot_looks_where_its_heading_points() -> None:
    view = Viewport.around([(0.0, 0.0), (2.0, 1.0)])
    # SVG turns clockwise for positive angles, headings are counter-clockwise.
    assert "rotate(-90.00)" in draw.robot(view, Pose(0.5, 0.5, pi / 2), "robot")


def test_the_ray_ends_at_what_it_hits_and_the_cone_at_what_was_measured() -> None:
    view = Viewport(0.0, 4.0, 100.0)
    # From (1 m, 2 m) ahead along x: wall at 1.5 m, measured 2 m; 100 units a metre, y from 4 m downwards.
    shown = draw.beams(view, [Beam("FRONT", 1.0, 2.0, 0.0, 2.0, 1.5, None)])
    assert 'class="ray" d="M100.0 200.0L250.0 200.0"' in shown
    assert re.search(r'class="beam"[^>]*A200\.0 200\.0', shown)
    assert 'class="echo"' not in shown


def test_names_of_obstacles_are_escaped() -> None:
    view = Viewport(0.0, 4.0, 100.0)
    shown = draw.obstacles(view, [Obstacle("<script>", 1.0, 1.0, 0.1)])
    assert "<script>" not in shown
    assert "&lt;script&gt;" in shown


def test_a_path_of_one_point_is_nothing() -> None:
    view = Viewport.around([(0.0, 0.0), (5.0, 4.0)])
    assert draw.path(view, [(1.0, 1.0)], "trail-true") == ""


@given(points, st.floats(-500, 500), st.floats(-500, 500), st.floats(1, 5000), st.floats(0.1, 5))
def test_the_grid_goes_through_all_that_is_in_sight_and_never_becomes_a_crowd(
    around: list[tuple[float, float]], x: float, y: float, width: float, unit: float
) -> None:
    view, seen = Viewport.around(around), VisibleArea(x, y, width, width / 2, unit)
    shown = draw.grid(view, seen)
    upright = [float(at) for at in re.findall(r"M(\S+) \S+v", shown)]
    # A line stands 64 pixels or more from the next one, so that its number can be read; none is missing at an edge.
    assert all(b - a >= 64 * unit - 0.2 for a, b in itertools.pairwise(upright))
    assert upright[0] <= x + 0.1
    assert upright[-1] >= x + width - 0.1
    assert len(upright) <= width / unit / 64 + 3
