"""Evidence is a detector's finding or a number outside its bounds, never a word."""

from __future__ import annotations

import math
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place
from hil.audit.evidence import EvidenceKind, measured, read, reported

numbers = st.floats(allow_nan=False, allow_infinity=False, width=32)


def finding(rule: str, function: str, object: str) -> Finding:
    place = Place("us.py", 10, function, "us.c")
    caller = Place("main_robot.py", 20, "TaskUS", "main_Robot.c")
    return Finding(rule, "message", object, "", place, (place, caller), "TaskUS", 0)


@given(value=numbers, low=numbers, high=numbers)
def test_a_number_is_seen_exactly_outside_its_bounds(value: float, low: float, high: float) -> None:
    low, high = min(low, high), max(low, high)
    assert measured("x", value, low=low, high=high).seen == (not low <= value <= high)


def test_what_is_no_number_is_outside_any_bounds() -> None:
    assert measured("x", math.nan).seen


def test_what_is_only_read_says_so() -> None:
    seen = measured("B", 33.25, "us", low=12.0, high=12.0)
    assert read("B", 33.25, "us", low=12.0, high=12.0) == replace(seen, by=EvidenceKind.READ) != seen


def test_the_line_says_what_was_measured_and_what_is_right() -> None:
    assert measured("way", 0.075, "mm", low=74.9, high=75.1).line == "way: 0.075 mm, right is 74.9..75.1 mm"
    assert measured("cycles", 0, low=1).line == "cycles: 0, right is at least 1"
    assert measured("error", 3, "cm", high=2).line == "error: 3 cm, right is at most 2 cm"


def test_a_finding_counts_by_rule_function_and_object() -> None:
    found = [finding("index", "Read_Distance", "us.Read_Distance.v")]
    assert reported(found, "index", function="Read_Distance", object=".v").seen
    assert reported(found, "index", function="TaskUS").seen, "the caller is on the path"
    assert not reported(found, "index", function="median").seen
    assert not reported(found, "overflow").seen
    assert not reported(found, "index", object="vF").seen
