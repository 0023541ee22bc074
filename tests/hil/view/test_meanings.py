"""What a value of a field means is read out of its description."""

from __future__ import annotations

import pytest

from hil.robot.board import RobotBoard
from hil.view.meanings import meaning, named


@pytest.mark.parametrize(
    ("description", "value", "means"),
    [
        ("0 up, 1 down, 2 up-down, 3 stopped", 2, "up-down"),
        ("1 = stop, 0 = run", 0, "run"),
        ("interrupt pulse: 0 end of window, 1 end of conversion", 1, "end of conversion"),
        ("TBPRD: 0 shadowed, loads at CTR = 0; 1 immediate", 0, "shadowed, loads at CTR = 0"),
        ("sync-out is 0 sync-in, 1 CTR = PRD, 2 and 3 nothing", 3, "nothing"),
        ("SOCA at: 0 digital compare event, 1-7 as INTSEL", 4, "1-7 as INTSEL"),
        ("parity: 5 = off; no word of this message RAM is ever damaged", 5, "off"),
        ("last round-robin SOC converted; 16 = none", 16, "none"),
        ("last round-robin SOC converted; 16 = none", 3, ""),
    ],
)
def test_a_named_value_has_its_name(description: str, value: int, means: str) -> None:
    assert meaning(description, value) == means


@pytest.mark.parametrize(
    "description",
    ["29 bits of identifier", "objects 17 to 24, 25 to 32", "up-down: direction, 1 up", "event 1 filtered"],
)
def test_numbers_that_name_no_value_are_left_alone(description: str) -> None:
    assert named(description) == ()


def test_every_value_that_a_field_of_the_chip_names_fits_into_it() -> None:
    board = RobotBoard(ideal=True)
    fields = [field for block in board.blocks.values() for each in block for field in each.fields.values()]
    naming = [field for field in fields if named(field.text)]
    assert len({field.text for field in naming}) > 100
    for field in naming:
        assert all(each.low <= each.high < 1 << field.width for each in named(field.text)), field.text
