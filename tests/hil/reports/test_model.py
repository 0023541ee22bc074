"""What counts, what is known, what is turned off."""

from __future__ import annotations

from pathlib import Path

from emulator.rules import Severity
from hil.reports.baseline import Baseline, known
from hil.reports.model import Report, Run, merged
from hil.reports.policy import Policy
from tests.hil.reports.samples import finding, module


def test_known_findings_do_not_count_and_gone_ones_are_listed(tmp_path: Path) -> None:
    file = module(tmp_path)
    old, gone, new = finding(file, 3), finding(file, 4), finding(file, 6)
    report = Report.of([old, new], run=Run("x"), baseline=Baseline(tuple(known([old, gone]))))
    assert [entry.state for entry in report.entries] == ["unchanged", "new"]
    assert [entry.finding for entry in report.counted] == [new]
    assert [entry.statement for entry in report.absent] == ["g()"]
    assert report.failed


def test_severity_decides_what_counts_and_off_leaves_out(tmp_path: Path) -> None:
    file = module(tmp_path)
    findings = [finding(file, 3, rule="unit"), finding(file, 4, rule="figure"), finding(file, 6, rule="no-effect")]
    # unit is an error, figure a note, no-effect a warning of its own.
    report = Report.of(findings, run=Run("x"), policy=Policy({"no-effect": None}))
    assert [entry.severity for entry in report.entries] == [Severity.ERROR, Severity.NOTE]
    assert [entry.rule.id for entry in report.counted] == ["unit"]
    assert report.turned_off == 1
    assert not Report.of(findings, run=Run("x"), policy=Policy(fail_on=None)).failed


def test_turning_a_rule_off_does_not_renumber_the_others(tmp_path: Path) -> None:
    file = module(tmp_path)
    findings = [finding(file, 3), finding(file, 5, rule="unit")]
    with_all = Report.of(findings, run=Run("x")).entries[1].known
    without = Report.of(findings, run=Run("x"), policy=Policy({"rotation-sign": None})).entries[0].known
    assert with_all == without


def test_a_stopped_firmware_has_failed_without_a_finding() -> None:
    assert Report.of([], run=Run("x", stopped="a trapped read")).failed
    assert not Report.of([], run=Run("x")).failed


def test_a_rule_without_an_entry_is_shown_all_the_same(tmp_path: Path) -> None:
    (entry,) = Report.of([finding(module(tmp_path), 3, rule="mine")], run=Run("x")).entries
    assert entry.rule.id == "mine"
    assert entry.severity is Severity.WARNING


def test_errors_come_first_and_keep_their_order(tmp_path: Path) -> None:
    file = module(tmp_path)
    rules = ["figure", "unit", "no-effect", "rotation-sign"]  # note, error, warning, error
    report = Report.of([finding(file, 3, rule=rule) for rule in rules], run=Run("x"))
    assert [entry.rule.id for entry in report.worst_first] == ["unit", "rotation-sign", "no-effect", "figure"]


def test_what_several_runs_found_is_merged_by_rule_object_and_place(tmp_path: Path) -> None:
    file = tmp_path / "us.c"
    first, again, elsewhere = finding(file, 3, count=2), finding(file, 3, count=5), finding(file, 4)
    one, other = merged([first, elsewhere, again])
    assert (one.count, one.time_cycles, one.place) == (7, first.time_cycles, first.place)
    assert other == elsewhere
    assert first.count == 2  # what a run has found stays as it is
