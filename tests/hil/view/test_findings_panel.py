"""The table of findings in the browser has the order of every other one."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.rules import Severity
from hil.reports.policy import Policy
from tests.hil.reports.samples import finding, module

pytest.importorskip("nicegui", reason="pip install nicegui")

from hil.view.findings_panel import has_words, row_of
from hil.view.rated_finding import by_kind, counted, rated, worst_first
from hil.view.scrub import ticks


def test_the_worst_stand_first_and_those_of_one_severity_as_they_came(tmp_path: Path) -> None:
    file = module(tmp_path)
    rules = ("unused-object", "dead-store", "index", "no rule of ours", "overflow")
    findings = [finding(file, 1 + number, rule=rule) for number, rule in enumerate(rules)]
    assert [each.finding.rule for each in worst_first(rated(findings, Policy()))] == [
        "index", "overflow", "dead-store", "no rule of ours", "unused-object",
    ]  # fmt: skip


def test_a_project_weighs_its_findings_in_table_counts_and_ticks(tmp_path: Path) -> None:
    policy = Policy(severities={"index": Severity.NOTE, "overflow": None})
    found = [finding(module(tmp_path), 1, rule=rule) for rule in ("index", "overflow", "dead-store")]
    findings = rated(found, policy)
    assert [(each.finding.rule, each.severity) for each in worst_first(findings)] == [
        ("dead-store", Severity.WARNING), ("index", Severity.NOTE),
    ]  # fmt: skip
    assert by_kind(findings) == {"error": 0, "warning": 1, "note": 1, "accepted": 0}
    assert row_of(findings[0]).cells[0].text == "note"
    drawn = ticks(findings, (), 10.0)
    assert "finding note" in drawn
    assert "finding error" not in drawn


def test_what_the_source_accepts_is_marked_and_counted_by_itself(tmp_path: Path) -> None:
    file = tmp_path / "lamp.c"
    file.write_text("x = t[i]; // hil: allow index, a guard word follows\ny = t[i];\n", encoding="utf-8")
    findings = rated([finding(file, line, rule="index") for line in (1, 2)], Policy())
    assert [each.accepted for each in findings] == ["a guard word follows", ""]
    assert by_kind(findings) == {"error": 1, "warning": 0, "note": 0, "accepted": 1}
    assert counted(by_kind(findings)).endswith('<span class="severity accepted">1 accepted</span>')
    severity = row_of(findings[0]).cells[0]
    assert (severity.text, severity.more) == ("error", "accepted")
    assert severity.title == "accepted in the source: a guard word follows"
    assert "finding accepted" in ticks(findings, (), 10.0)
    # Somebody is typing in the file while it runs: the report at the end says what is wrong there.
    file.write_text("x = t[i]; // hil: allow index\n", encoding="utf-8")
    assert [each.accepted for each in rated([finding(file, 1, rule="index")], Policy())] == [""]


def test_a_finding_that_the_run_has_gone_back_before_is_ahead(tmp_path: Path) -> None:
    (each,) = rated([finding(module(tmp_path), 1, rule="index")], Policy())
    assert row_of(each).cells[3].more == f"{each.finding.count} x"
    assert row_of(each, ahead=True).cells[3].more == "ahead"


def test_a_search_wants_all_of_its_words_in_whatever_column(tmp_path: Path) -> None:
    row = row_of(*rated([finding(module(tmp_path), 1, rule="index")], Policy()))
    assert has_words(row, "")
    assert has_words(row, f"INDEX {row.cells[2].text}")
    assert not has_words(row, "index nowhere")
