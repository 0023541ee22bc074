"""One table reads scenario files and makes their schema: what one takes, the other takes."""

from __future__ import annotations

import copy
import json
import random
import tomllib
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from hil.cli import invoke
from hil.scenarios import keys
from hil.scenarios.running import shipped

PUBLISHED = Path(keys.__file__).parent / "scenario-1.schema.json"
VALIDATOR = Draft202012Validator(keys.schema())

#: Every key once.
WHOLE = """
description = "d"
thesis = "3.2"
world = "corridor"
realistic = true
seed = 3
fill = "random:7"
divide = "nr"
float_division = "fast"
fixes = ["all"]
firmware = []
include = []
defines = ["A=1"]
board = "robot"
options = []
put = []
xbee = false
seconds = 2.5
orders = ["mission", "0.5:set 0.2 -0.1", "1:#STOP", "2.:SETR.2,1"]
defects = ["US-accumulator"]
faithful_fails = ["a"]
baseline = "b.json"
fail_on = "never"
script = "s.py"
[start]
x_m = 1
y_m = 1.5
heading_deg = 90
[floor]
grip = 0.5
slip_left = 0.1
slip_right = -0.1
[outputs]
plot = "p.png"
json = "j.json"
path = "p.csv"
[severity]
index = "note"
[[order]]
send = "stop"
when = "pose x>500"
[[faults]]
kind = "adc-bit-stuck"
input = "A5"
bit = 3
value = 1
at = 2
for_s = 1.5
[[faults]]
kind = "sonar-deaf"
sensor = "LEFT"
when = "frame 3"
seed = 7
[[feed]]
input = "ADCINA3"
value = 1.25
[[feed]]
input = "bumper.pressed"
values = [[0, 0], [1.5, 1]]
[[feed]]
file = "t.csv"
column = "c"
how = "linear"
[[expect]]
name = "a"
quantity = "x_m"
during = [1, 2]
once = true
least = 1
most = 2
[[expect]]
name = "b"
finding = "index"
absent = true
place = "us.c"
[[expect]]
name = "c"
frame = "#ODO"
[[expect]]
name = "d"
state = "STOP"
at = 1
[[expect]]
name = "e"
deadline = "TaskGYRO"
most = 5
"""
VALUES: list[Any] = [
    True, False, 0, 1, -1, 2.0, 2.5, 1e7, -1e7, "", "zero", "mission", "x_m", "index", "random:9", "random:", "nr",
    "1:jump", "#", "#X\n", "MISN", "set 1 2", "set 1", "stop\n", [], [1], [1, 2], [1, 2, 3], ["all"], ["1:stop"], [""],
    [[0, 1], [1, -2.5]], [[1, 2], [1]], [[1, "a"]],
    {}, {"x_m": 1}, {"grip": 0}, {"index": "off"}, {"index": 1}, {"nothing": "off"}, [{}], [{"name": "n"}],
    "gyro-reset", ["gyro-reset:at=2"], [{"kind": "gyro-reset"}], {"kind": "gyro-reset", "rate": 2.5}, {"kind": "what"},
    [{"name": "n", "state": "STOP"}], [{"name": "n", "state": "STOP", "frame": "x"}],
]  # fmt: skip


def taken(table: dict[str, Any]) -> bool:
    try:
        keys.check(table)
    except keys.Problem:
        return False
    return True


def places(table: Any) -> list[tuple[Any, Any]]:
    """Every (container, key) of a table."""
    found: list[tuple[Any, Any]] = []
    for key, value in list(table.items()) if isinstance(table, dict) else enumerate(table):
        found.append((table, key))
        if isinstance(value, dict | list):
            found += places(value)
    return found


def same(table: dict[str, Any]) -> bool:
    assert taken(table) == VALIDATOR.is_valid(table), table
    return taken(table)


def test_the_schema_is_one_and_is_published() -> None:
    Draft202012Validator.check_schema(keys.schema())
    assert json.loads(PUBLISHED.read_text(encoding="utf-8")) == keys.schema(), "hil scenario --schema writes it"


@pytest.mark.parametrize("path", shipped(), ids=lambda path: path.name)
def test_shipped_files_are_taken_by_both(path: Path) -> None:
    assert same(tomllib.loads(path.read_text(encoding="utf-8")))


def test_every_key_is_in_the_whole_file() -> None:
    whole = tomllib.loads(WHOLE)
    assert set(whole) == {key.name for key in keys.KEYS}
    assert same(whole)


def test_reader_and_schema_take_the_same_mutations() -> None:
    """Each value in the place of each other one; keys left out; keys too many."""
    whole = tomllib.loads(WHOLE)
    accepted = rejected = 0
    for index in range(len(places(whole))):
        for value in [*VALUES, None]:
            table = copy.deepcopy(whole)
            container, key = places(table)[index]
            if value is None:
                del container[key]
            else:
                container[key] = copy.deepcopy(value)
            if same(table):
                accepted += 1
            else:
                rejected += 1
        table = copy.deepcopy(whole)
        container, key = places(table)[index]
        if isinstance(container, dict):
            container["unheard"] = 1
            assert not same(table)
    # Both happen often: neither side takes all, or nothing.
    assert accepted > 100
    assert rejected > 1000


def test_several_mutations_at_once() -> None:
    draw = random.Random(1)
    for _ in range(300):
        table = tomllib.loads(WHOLE)
        for _ in range(draw.randrange(1, 4)):
            container, key = draw.choice(places(table))
            container[key] = copy.deepcopy(draw.choice(VALUES))
        same(table)


def test_the_command_prints_the_schema_and_the_page_has_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["scenario", "--schema"]) == 0
    assert json.loads(capsys.readouterr().out) == keys.schema()
    assert keys.page() in (PUBLISHED.parent / "README.md").read_text(encoding="utf-8")
