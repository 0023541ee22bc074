"""The table of findings in the browser has the order of every other one."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.rules import Severity
from hil.reports.policy import Policy
from tests.hil.reports.samples import finding, module

pytest.importorskip("nicegui", reason="pip install nicegui")

from hil.view.findings_panel import by_severity, has_words, row_of, worst_first
from hil.view.scrub import ticks


def test_the_worst_stand_first_and_those_of_one_severity_as_they_came(tmp_path: Path) -> None:
    file = module(tmp_path)
    rules = ("unused-object", "dead-store", "index", "no rule of ours", "overflow")
    findings = [finding(file, 1 + number, rule=rule) for number, rule in enumerate(rules)]
    assert [each.rule for each, _ in worst_first(Policy().with_severities(findings))] == [
        "index", "overflow", "dead-store", "no rule of ours", "unused-object",
    ]  # fmt: skip


def test_a_project_weighs_its_findings_in_table_counts_and_ticks(tmp_path: Path) -> None:
    policy = Policy(severities={"index": Severity.NOTE, "overflow": None})
    found = [finding(module(tmp_path), 1, rule=rule) for rule in ("index", "overflow", "dead-store")]
    rated = policy.with_severities(found)
    assert [(each.rule, severity) for each, severity in worst_first(rated)] == [
        ("dead-store", Severity.WARNING), ("index", Severity.NOTE),
    ]  # fmt: skip
    assert by_severity(rated) == {"error": 0, "warning": 1, "note": 1}
    assert row_of(*rated[0]).cells[0].text == "note"
    drawn = ticks(rated, (), 10.0)
    assert "finding note" in drawn
    assert "finding error" not in drawn


def test_a_search_wants_all_of_its_words_in_whatever_column(tmp_path: Path) -> None:
    row = row_of(finding(module(tmp_path), 1, rule="index"), Severity.ERROR)
    assert has_words(row, "")
    assert has_words(row, f"INDEX {row.cells[2].text}")
    assert not has_words(row, "index nowhere")
