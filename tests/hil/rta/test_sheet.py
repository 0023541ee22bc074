"""Sheets: what they say, and that an error names file, line and key."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.rta.sheet import load_sheet, parse_sheet
from hil.rta.task_set import Arrival, Interrupt, Section, Task, TaskSet

GOOD = """\
switch_us = 0.5

[[task]]
name = "fast"
priority = 2
period_us = 5000
computation_us = 42.97
jitter_us = 3
start_up_us = 100
sections = [{ gate = "g", time_us = 4.05 }]

[[task]]
name = "slow"
priority = 1
period_us = 10_000
deadline_us = 9000
computation_us = 1

[[interrupt]]
name = "tick"
period_us = 1000
computation_us = 5
"""


def test_a_sheet(tmp_path: Path) -> None:
    file = tmp_path / "tasks.toml"
    file.write_text(GOOD, encoding="utf-8")
    assert load_sheet(file) == TaskSet(
        (
            Task("fast", 2, Arrival(5_000_000, 3000), 42_970, 5_000_000, (Section("g", 4050),), 100_000),
            Task("slow", 1, Arrival(10_000_000), 1000, 9_000_000),
        ),
        (Interrupt("tick", Arrival(1_000_000), 5000),), switch_ns=500,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("priority = 1\n", "priority = 99\n", r"^t:14: priority: 99 must be a whole number from 1 to 31"),
        ("priority = 1\n", "", r"^t:12: priority: it is missing"),
        ("deadline_us = 9000", "deadlin = 9000", r"^t:16: deadlin: \[\[task\]\] has no such key: there are name,"),
        ("period_us = 10_000", "period_us = 0", r"^t:15: period_us: it must be more than 0"),
        ("period_us = 1000\n", "period_us = 'x'\n", r"^t:21: period_us: 'x' must be a time in microseconds"),
        ("time_us = 4.05", "time = 4", r"^t:10: time: a section has no such key"),
        ("time_us = 4.05", "time_us = 50", r"^t:10: sections: they take longer than the whole computation"),
        ('name = "tick"', 'name = "slow"', r"^t:4: name: 'slow' stands there twice"),
        ("switch_us = 0.5", "switch_us = -1", r"^t:1: switch_us: -1 must be a time in microseconds, 0 or more"),
        ("switch_us = 0.5", "switch_us = nan", r"^t:1: switch_us: nan must be"),
        ("switch_us = 0.5", "switch_us =", r"^t: .*line 1"),
    ],
)
def test_an_error_names_file_line_and_key(old: str, new: str, message: str) -> None:
    assert old in GOOD
    with pytest.raises(ValueError, match=message):
        parse_sheet(GOOD.replace(old, new), "t")


def test_a_sheet_without_a_task() -> None:
    with pytest.raises(ValueError, match=r"^t:1: task: there is no \[\[task\]\]"):
        parse_sheet("", "t")
