"""The comparison: what it says of each kind of difference, and that a reviewed one silences itself and nothing else."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.hil.unchanged.comparison import Allowed, Gone, Moved, Named, New, Reworded, Value, differences, expected
from tests.hil.unchanged.record import text_of
from tests.hil.unchanged.scenarios import Data


def finding(rule: str, line: int, **changed: Any) -> Data:
    return {
        "rule": rule, "how": "dynamic", "object": "us.v", "declaration": "float v (us.py:3)", "message": "v is read",
        "value": "", "details": [f"main (a/us.py:{line})"], "task": "main", "count": 1, "cycles": 10,
        "path": [["a/us.py", line, "f", "us.c"], ["a/us.py", 50, "main", "us.c"]],
    } | changed  # fmt: skip


def run_data() -> Data:
    return {"uart": "12ab", "tasks": {"A": {"runs": 3}}, "findings": [finding("index", 7), finding("race", 9)]}


def left(now: Data, *allowed: Allowed) -> list[str]:
    return differences(expected("mission 0", run_data(), allowed)[0], now, allowed)


def test_equal_data_have_no_difference() -> None:
    assert left(run_data()) == []


def test_a_value_that_differs_is_named_with_its_key() -> None:
    now = run_data()
    now["tasks"]["A"]["runs"] = 4
    assert left(now) == ["tasks/A/runs: recorded 3, now 4"]


def test_a_key_that_comes_or_goes_is_a_difference() -> None:
    now = run_data()
    now["pose"] = now.pop("uart")
    assert left(now) == ["uart: recorded, and not there now", "pose: there now, and not recorded"]


def test_another_order_of_findings_is_a_difference() -> None:
    now = run_data()
    now["findings"].reverse()
    assert len(left(now)) > 2


@pytest.mark.parametrize(
    "changed",
    [{"rule": "x"}, {"how": "static"}, {"object": "us.w"}, {"task": "B"}, {"count": 2}, {"cycles": 11}, {"path": []},
     {"declaration": ""}, {"message": ""}, {"value": "1"}, {"details": []}],
    ids=str,
)  # fmt: skip
def test_whatever_differs_in_a_finding_is_a_difference(changed: Data) -> None:
    now = run_data()
    now["findings"][0].update(changed)
    was, becomes = left(now)[-2:]
    assert was.startswith("-index | dynamic | us.v | a/us.py:7 f (us.c) < a/us.py:50 main (us.c) | main | 1 times")
    assert becomes.startswith("+")


def test_a_finding_that_moved_is_allowed_only_to_its_new_place() -> None:
    moved = Moved(rule="index", object="us.v", before="a/us.py:7 f", after="a/us.py:8 f", because="...")
    now = run_data()
    now["findings"][0]["path"][0][1] = 8
    assert left(now, moved) == []
    now["findings"][0]["path"][0][1] = 9
    assert left(now, moved) != []


def test_a_c_file_may_have_another_name_in_every_place() -> None:
    now = json.loads(json.dumps(run_data()).replace('"us.c"', '"us.py"'))
    assert left(now, Named(before="us.c", after="us.py", because="...")) == []
    assert left(now) != []


def test_findings_of_a_new_rule_are_left_out_and_no_others() -> None:
    now = run_data()
    now["findings"].insert(1, finding("unsequenced", 8))
    new = New(rule="unsequenced", because="...")
    assert left(now, new) == []
    now["findings"].insert(1, finding("index", 8))
    assert left(now, new) != []


def test_a_finding_that_is_gone_is_allowed_at_its_place() -> None:
    now = run_data()
    del now["findings"][0]
    assert left(now, Gone(rule="index", object="us.v", place="a/us.py:7 f", because="...")) == []
    assert left(now, Gone(rule="index", object="us.v", place="a/us.py:8 f", because="...")) != []


def test_a_text_may_be_worded_differently_for_a_rule() -> None:
    now = run_data()
    now["findings"][0]["details"] = ["a/us.py:7: main"]
    other = Reworded(rule="in*", before=r"main \((a/us\.py:\d+)\)", after=r"\1: main", because="...")
    assert left(now, other) == []


def test_a_value_may_be_another_in_the_scenarios_that_match() -> None:
    now = run_data()
    now["uart"] = "34cd"
    assert left(now, Value(scenario="mission *", key="uart", after="34cd", because="...")) == []
    assert left(now, Value(scenario="check *", key="uart", after="34cd", because="...")) != []
    del now["uart"]
    assert left(now, Value(scenario="*", key="uart", after=None, because="...")) == []


def test_a_reviewed_difference_that_concerns_nothing_is_told_apart() -> None:
    used = Named(before="us.c", after="us.py", because="...")
    unused = Named(before="GYRO.c", after="gyro.py", because="...")
    assert expected("mission 0", run_data(), (used, unused))[1] == {used}


_PLAIN = st.recursive(
    st.integers() | st.text() | st.floats(allow_nan=False), lambda x: st.lists(x) | st.dictionaries(st.text(), x)
)


@given(st.dictionaries(st.text(), _PLAIN))
def test_the_text_of_a_record_reads_back_as_what_was_written(data: Data) -> None:
    assert json.loads(text_of(data)) == data
