"""Sheets: what they say, and that an error names file, line and key."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.rta.sheet import load_sheet, parse_sheet
from hil.rta.task_set import Arrival, Interrupt, Section, TaskModel, TaskSet
from tests.hil.rta.sheets import SHEET

GOOD = f"""\
switch_us = 0.5

{SHEET}deadline_us = 1900
jitter_us = 3

[[interrupt]]
name = "tick"
period_us = 100
computation_us = 5.25
"""


def test_a_sheet(tmp_path: Path) -> None:
    file = tmp_path / "tasks.toml"
    file.write_text(GOOD, encoding="utf-8")
    assert load_sheet(file) == TaskSet(
        (
            TaskModel("a", 2, Arrival(1_000_000), 100_000, 1_000_000, (Section("g", 10_000),)),
            TaskModel("b", 1, Arrival(2_000_000, 3000), 300_000, 1_900_000, (Section("g", 20_000),), 50_000),
        ),
        (Interrupt("tick", Arrival(100_000), 5250),), switch_ns=500,
    )  # fmt: skip


def test_sections_within_a_section() -> None:
    text = SHEET.replace("time_us = 20", 'time_us = 20, sections = [{ gate = "h", time_us = 5 }]')
    _, b = parse_sheet(text, "t").tasks
    assert b.sections == (Section("g", 20_000, (Section("h", 5_000),)),)
    assert [section.gate for section in b.stays] == ["g", "h"]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("priority = 1\n", "priority = 99\n", r"^t:12: priority: 99 must be a whole number from 1 to 31"),
        ("priority = 1\n", "", r"^t:10: priority: it is missing"),
        ("deadline_us = 1900", "deadlin = 1900", r"^t:17: deadlin: \[\[task\]\] has no such key: there are name,"),
        ("period_us = 2000", "period_us = 0", r"^t:13: period_us: it must be more than 0"),
        ("period_us = 100\n", "period_us = 'x'\n", r"^t:22: period_us: 'x' must be a time in microseconds"),
        ("time_us = 10", "time = 4", r"^t:8: time: a section has no such key"),
        ("time_us = 10", "time_us = 150", r"^t:8: sections: they take longer than the whole computation"),
        ("time_us = 20", 'time_us = 20, sections = [{ gate = "h", time_us = 21 }]',
         r"^t:16: sections: they take longer than the whole section"),
        ("time_us = 20", 'time_us = 20, sections = [{ gate = "g", time_us = 2 }]', r"^t:16: gate: 'g' is held already"),
        ('name = "tick"', 'name = "a"', r"^t:4: name: 'a' occurs twice"),
        ("switch_us = 0.5", "switch_us = -1", r"^t:1: switch_us: -1 must be a time in microseconds, 0 or more"),
        ("switch_us = 0.5", "switch_us = nan", r"^t:1: switch_us: nan must be"),
        ("switch_us = 0.5", "switch_us =", r"^t:1: not TOML"),
    ],
)
def test_an_error_names_file_line_and_key(old: str, new: str, message: str) -> None:
    assert old in GOOD
    with pytest.raises(ValueError, match=message):
        parse_sheet(GOOD.replace(old, new), "t")


def test_a_sheet_without_a_task() -> None:
    with pytest.raises(ValueError, match=r"^t:1: task: there is no \[\[task\]\]"):
        parse_sheet("", "t")
