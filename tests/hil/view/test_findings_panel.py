"""The table of findings in the browser has the order of every other one."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.hil.reports.samples import finding, module

pytest.importorskip("nicegui", reason="pip install nicegui")

from hil.view.findings_panel import has_words, row_of, worst_first


def test_the_worst_stand_first_and_those_of_one_severity_as_they_came(tmp_path: Path) -> None:
    file = module(tmp_path)
    rules = ("unused-object", "dead-store", "index", "no rule of ours", "overflow")
    findings = [finding(file, 1 + number, rule=rule) for number, rule in enumerate(rules)]
    assert [each.rule for each in worst_first(findings)] == [
        "index", "overflow", "dead-store", "unused-object", "no rule of ours",
    ]  # fmt: skip


def test_a_search_wants_all_of_its_words_in_whatever_column(tmp_path: Path) -> None:
    row = row_of(finding(module(tmp_path), 1, rule="index"))
    assert has_words(row, "")
    assert has_words(row, f"INDEX {row.cells[2].text}")
    assert not has_words(row, "index nowhere")
