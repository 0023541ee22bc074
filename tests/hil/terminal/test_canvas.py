"""Dots and characters, against the names that Unicode gives the characters."""

from __future__ import annotations

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.terminal.canvas import BRAILLE, HALF_BLOCKS, Canvas, Layer, Raster

#: Where a numbered braille dot lies, (across, down): the Unicode Standard, section "Braille Patterns".
BRAILLE_DOTS = {1: (0, 0), 2: (0, 1), 3: (0, 2), 4: (1, 0), 5: (1, 1), 6: (1, 2), 7: (0, 3), 8: (1, 3)}
RASTERS = st.sampled_from([BRAILLE, HALF_BLOCKS])


def character(raster: Raster, dots: set[tuple[int, int]]) -> str:
    canvas = Canvas(1, 1, raster)
    for x, y in dots:
        canvas.dot(x, y, Layer.PATH)
    return canvas.lines()[0][0][0]


@given(st.sets(st.sampled_from(list(BRAILLE_DOTS)), min_size=1))
def test_a_braille_character_has_the_dots_in_its_name(numbers: set[int]) -> None:
    name = unicodedata.name(character(BRAILLE, {BRAILLE_DOTS[number] for number in numbers}))
    assert name == "BRAILLE PATTERN DOTS-" + "".join(str(number) for number in sorted(numbers))


@pytest.mark.parametrize(
    ("dots", "name"),
    [
        (set(), "SPACE"),
        ({(0, 0)}, "UPPER HALF BLOCK"),
        ({(0, 1)}, "LOWER HALF BLOCK"),
        ({(0, 0), (0, 1)}, "FULL BLOCK"),
    ],
)
def test_a_half_block_is_the_half_that_is_set(dots: set[tuple[int, int]], name: str) -> None:
    assert unicodedata.name(character(HALF_BLOCKS, dots)) == name


@given(
    RASTERS, st.integers(0, 40), st.integers(0, 20), st.sampled_from(Layer),
    st.lists(st.tuples(st.integers(-200, 200), st.integers(-200, 200))),
    st.integers(-50, 50), st.integers(-50, 50), st.text(max_size=20).filter(str.isprintable),
)  # fmt: skip
def test_whatever_is_drawn_the_picture_keeps_its_size(
    raster: Raster, columns: int, rows: int, layer: Layer, dots: list[tuple[int, int]], column: int, row: int, text: str
) -> None:
    canvas = Canvas(columns, rows, raster)
    for dot in dots:
        canvas.dot(*dot, layer)
    canvas.write(column, row, text)
    lines = canvas.lines()
    assert len(lines) == rows
    assert all(sum(len(run) for run, _ in line) == columns for line in lines)


def test_a_character_has_the_look_of_its_highest_layer_and_keeps_all_dots() -> None:
    canvas = Canvas(1, 1, HALF_BLOCKS)
    canvas.dot(0, 0, Layer.ROBOT)
    canvas.dot(0, 1, Layer.CLOUD)
    assert canvas.lines() == [[("█", Layer.ROBOT)]]


def test_characters_of_one_layer_are_one_run() -> None:
    canvas = Canvas(4, 1, HALF_BLOCKS)
    canvas.dot(0, 0, Layer.CLOUD)
    canvas.dot(1, 1, Layer.CLOUD)
    canvas.write(3, 0, "x")
    assert canvas.lines() == [[("▀▄", Layer.CLOUD), (" ", Layer.NOTHING), ("x", Layer.TEXT)]]
