"""What the frames tell, drawn: nothing outside, both axes alike, as close as it may be."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.client.decode import OdometryFrame
from hil.terminal.arena import MARGIN, MAX_ECHOES, MAX_POSES, MIN_EXTENT_M, ArenaHistory, View, arrow, scale_bar
from hil.terminal.canvas import BRAILLE, HALF_BLOCKS, Canvas, Layer, Raster

NUMBERS = st.integers(-32768, 32767)
FRAMES = st.builds(OdometryFrame, NUMBERS, NUMBERS, NUMBERS, NUMBERS, NUMBERS, NUMBERS)
METRES = st.floats(-40.0, 40.0)
POINTS = st.lists(st.tuples(METRES, METRES), min_size=1, max_size=30)
#: Less than four dots have no room for a margin.
DOTS = st.integers(4, 400)


def text(canvas: Canvas) -> list[str]:
    return ["".join(run for run, _ in line) for line in canvas.lines()]


@given(
    st.lists(FRAMES, max_size=20), st.integers(-1, 130), st.integers(-1, 50), st.sampled_from([BRAILLE, HALF_BLOCKS])
)
def test_any_frames_fill_exactly_the_room_there_is(
    frames: list[OdometryFrame], columns: int, rows: int, raster: Raster
) -> None:
    arena = ArenaHistory()
    for frame in frames:
        arena.add(frame)
    lines = text(arena.draw(columns, rows, raster))
    assert [len(line) for line in lines] == [max(0, columns)] * max(0, rows)


@given(POINTS, DOTS, DOTS)
def test_every_point_lies_within_the_view(points: list[tuple[float, float]], width: int, height: int) -> None:
    view = View.fit(points, width, height)
    for point in points:
        x, y = view.dot(*point)
        assert 0 <= x < width
        assert 0 <= y < height


@given(POINTS, DOTS, DOTS, METRES, METRES, st.floats(0.0, 20.0))
def test_a_metre_is_as_wide_as_high_and_up_is_up(
    points: list[tuple[float, float]], width: int, height: int, x_m: float, y_m: float, side_m: float
) -> None:
    view = View.fit(points, width, height)
    x0, y0 = view.dot(x_m, y_m)
    x1, y1 = view.dot(x_m + side_m, y_m + side_m)
    assert x1 >= x0
    assert y1 <= y0
    # Rounding to dots: each end by half a dot.
    assert abs((x1 - x0) - (y0 - y1)) <= 2


@given(POINTS, DOTS, DOTS)
def test_the_view_is_as_close_as_a_step_of_a_tenth_of_a_decade_allows(
    points: list[tuple[float, float]], width: int, height: int
) -> None:
    view = View.fit(points, width, height)
    extents = [max(values) - min(values) for values in zip(*points, strict=True)]
    room = [max(1, dots - 2 * MARGIN - 1) for dots in (width, height)]
    needed = max(extents[0] / room[0], extents[1] / room[1], MIN_EXTENT_M / min(room))
    assert needed <= view.m_per_dot * (1 + 1e-9)
    assert view.m_per_dot <= needed * 10**0.1 * (1 + 1e-9)


def test_a_drive_of_one_metre_along_x_looks_like_it() -> None:
    arena = ArenaHistory()
    arena.add(OdometryFrame(0, 0, 0, 0, 0, 0))
    arena.add(OdometryFrame(1000, 0, 0, 0, 0, 0))
    # 13 x 10 dots, 10 x 7 without margin: 1 m / 7 dots, next step 10**-0.8 = 0.1585 m; the middle is x = 0.5 m at dot
    # 6, so x = 0 is at 6 - 0.5 / 0.1585 = 2.8 -> 3 and x = 1 at 9; y = 0 is at 4.5 -> 4, the upper half of row 2.
    # Bar: at most a third of 13 * 0.1585 m is 0.69 m -> 0.5 m, 3 characters.
    assert text(arena.draw(13, 5, HALF_BLOCKS)) == [
        "             ",
        "             ",
        "   ▀     →▀▀▀",
        "             ",
        "├─┤ 0.5 m    ",
    ]


def test_echoes_stand_where_the_sonars_look() -> None:
    arena = ArenaHistory()
    # At the origin, looking along +y would need pi/2; the line knows whole radians, so look along +x (0): the front
    # echo lies to the right, the right one below, the left one above.
    arena.add(OdometryFrame(0, 0, 0, 1000, 500, 500))
    canvas = arena.draw(60, 15, BRAILLE)
    red = {
        (column, row)
        for row, line in enumerate(canvas.lines())
        for column, layer in enumerate(layer for run, layer in line for _ in run)
        if layer is Layer.CLOUD
    }
    assert len(red) == 3
    (above, front, below) = sorted(red, key=lambda cell: cell[1])
    assert above[0] == below[0] < front[0]
    # 1 m ahead is as far as from one side to the other (2 x 0.5 m); a character is two dots wide and four high.
    assert abs((front[0] - above[0]) * 2 - (below[1] - above[1]) * 4) <= 4


def test_no_echo_is_no_point() -> None:
    arena = ArenaHistory()
    # 255 inches, what the firmware reports when nothing returned, and 0.
    arena.add(OdometryFrame(0, 0, 0, 6477, 0, 6477))
    layers = {layer for line in arena.draw(40, 10).lines() for _, layer in line}
    assert Layer.CLOUD not in layers


@pytest.mark.parametrize(
    ("heading_rad", "character"), [(0, "→"), (1, "↗"), (2, "↖"), (3, "←"), (-1, "↘"), (-2, "↙"), (6, "→")]
)
def test_the_arrow_is_the_nearest_of_eight(heading_rad: int, character: str) -> None:
    # In degrees: 57.3 is nearest to 45, 114.6 to 135, 171.9 to 180, 6 rad = -16.2 to 0.
    assert arrow(float(heading_rad)) == character


@given(NUMBERS)
def test_the_arrow_is_within_an_eighth_of_a_half_turn_of_any_heading(heading_rad: int) -> None:
    shown_deg = 45 * "→↗↑↖←↙↓↘".index(arrow(float(heading_rad)))
    off_deg = (math.degrees(heading_rad) - shown_deg + 180) % 360 - 180
    assert abs(off_deg) <= 22.5 + 1e-6


def test_a_robot_that_says_the_same_again_adds_nothing_and_a_long_drive_is_bounded() -> None:
    arena = ArenaHistory()
    for number in range(2 * MAX_POSES):
        arena.add(OdometryFrame(number % 30000, 0, 0, 1, 1, 1 + number % 2))
        arena.add(OdometryFrame(number % 30000, 0, 0, 1, 1, 1 + number % 2))
    assert len(arena._path) == MAX_POSES
    assert len(arena._echoes) == MAX_ECHOES
    assert arena._path[0][0] == MAX_POSES % 30000 / 1e3
    arena.clear()
    assert text(arena.draw(20, 3))[:2] == [" " * 20] * 2


@given(st.floats(1e-4, 10.0), st.integers(1, 300))
def test_the_scale_bar_is_as_long_as_it_says(m_per_column: float, columns: int) -> None:
    bar = scale_bar(m_per_column, columns)
    assert len(bar) <= columns
    if bar:
        drawn, said = bar.split("┤ ")
        assert abs((len(drawn) + 1) * m_per_column - float(said.removesuffix(" m"))) <= m_per_column / 2 * (1 + 1e-9)
