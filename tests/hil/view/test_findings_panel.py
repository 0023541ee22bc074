"""The table of findings in the browser has the order of every other one."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.hil.reports.samples import finding, module

pytest.importorskip("nicegui", reason="pip install nicegui")

from hil.view.findings_panel import row_of, worst_first


def test_the_worst_stand_first_and_those_of_one_severity_as_they_came(tmp_path: Path) -> None:
    file = module(tmp_path)
    rules = ("unused-object", "dead-store", "index", "no rule of ours", "overflow")
    rows = [row_of(number, finding(file, 1 + number, rule=rule)) for number, rule in enumerate(rules)]
    assert [row["rule"] for row in worst_first(rows)] == [
        "index", "overflow", "dead-store", "unused-object", "no rule of ours",
    ]  # fmt: skip
