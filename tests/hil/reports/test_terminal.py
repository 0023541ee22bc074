"""The report in a terminal: every finding, what it reaches, and the count; markup in a text is shown, not obeyed."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from rich.console import Console

from hil.reports.baseline import Baseline, known
from hil.reports.differences import FilledMemory, TwoFillProof, compare
from hil.reports.model import Report, Run
from hil.reports.outputs import RunOutputs
from hil.reports.policy import Policy
from hil.reports.terminal import WIDE, last_line, print_report, summary
from tests.hil.reports.samples import finding, module


def printed(report: Report, *, details: bool = False, width: int = 200, most: int | None = None) -> str:
    console = Console(file=io.StringIO(), width=width)
    print_report(report, console, details=details, most=most)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue()


def test_details_say_where_when_and_what_it_reaches(tmp_path: Path) -> None:
    one = finding(module(tmp_path), 3, count=2, value=None)
    a = RunOutputs({"EPwm2Regs.CMPA": [(400, 5)], "SpiaRegs.SPICCR": [(1, 1)]})
    reach = compare(a, RunOutputs({"EPwm2Regs.CMPA": [(400, 7)], "SpiaRegs.SPICCR": [(2, 1)]}))
    proof = TwoFillProof("zero", "ones", reach, {FilledMemory.of(one): reach})
    text = printed(Report.of([one], run=Run("x"), proof=proof), details=True)
    # 2 000 000 cycles of 5 ns; 400 cycles.
    assert "first at 10000.000 us in TaskUS, 2 times │" in " ".join(text.split())
    assert "EPwm2Regs.CMPA: from 2.000 us (number 0: 5 becomes 7), 1 of 1" in text
    assert "Two fills (zero, ones): PWM EPwm2Regs.CMPA" in text
    assert "SPICCR" not in text, "the same values at other times reach nothing"


def test_markup_in_a_text_is_shown(tmp_path: Path) -> None:
    hostile = finding(module(tmp_path), 3, message="[red]x[/red]", object="a[/]b")
    text = printed(Report.of([hostile], run=Run("x")), details=True)
    assert "[red]x[/red]" in text
    assert "a[/]b" in text


def test_the_last_line_counts_what_is_known_gone_and_turned_off(tmp_path: Path) -> None:
    file = module(tmp_path)
    old, gone, new, off = finding(file, 3), finding(file, 4), finding(file, 6), finding(file, 5, rule="unit")
    report = Report.of(
        [old, new, off], run=Run("x"), policy=Policy({"unit": None}), baseline=Baseline(tuple(known([old, gone]))),
    )  # fmt: skip
    assert last_line(report) == "2 errors, 1 known, 1 gone, 1 turned off; 1 fails the check"
    assert "gone: rotation-sign in us.c: f (us.f.total)" in printed(report)


@pytest.mark.parametrize("width", [70, 80, WIDE, 120, 160])
def test_the_table_says_how_many_of_each_severity_and_begins_with_the_worst(tmp_path: Path, width: int) -> None:
    file = module(tmp_path)
    found = [
        finding(file, line, rule=rule, message=message)
        for line, (rule, message) in enumerate((
            ("unused-object", "a note"), ("dead-store", "a warning"), ("index", "an error"), ("index", "another error"),
        ), 3)
    ]  # fmt: skip
    text = printed(Report.of(found, run=Run("x")), width=width)
    assert text.splitlines()[0].strip() == "2 errors, 1 warning, 1 note"
    places = [text.index(message) for message in ("an error", "another error", "a warning", "a note")]
    assert places == sorted(places)
    assert max(map(len, text.splitlines())) <= width
    assert "TaskUS" in text
    assert "10.000 ms" in text


def test_only_so_many_are_shown_and_the_rest_is_counted(tmp_path: Path) -> None:
    found = [finding(module(tmp_path), line, message=f"line {line}") for line in range(1, 7)]
    text = printed(Report.of(found, run=Run("x")), most=2)
    assert text.splitlines()[0].strip() == "6 errors"
    assert "line 2" in text
    assert "line 3" not in text
    assert "4 more" in text


@pytest.mark.parametrize("width", [80, WIDE])
def test_of_many_notes_alike_one_row_counts_the_rest(tmp_path: Path, width: int) -> None:
    file = module(tmp_path)
    of = {"MemCfgRegs.LSxMSEL": range(1, 6), "Cla1Regs.MVECT1": range(1, 4)}
    found = [finding(file, 6, rule="index", message="an error") for _ in range(4)]
    for number in range(1, 6):
        for name, numbers in of.items():
            if number in numbers:
                found.append(finding(file, number, rule="unmodelled", message=f"{name} {number}.", object=name))
    report = Report.of(found, run=Run("x"))
    text = printed(report, width=width)
    shown = [f"MemCfgRegs.LSxMSEL {number}." in text for number in of["MemCfgRegs.LSxMSEL"]]
    assert shown == [True, True, False, False, False]
    rest = text.partition("3 more of MemCfgRegs")[2].partition("Cla1Regs")[0]
    assert "us.py:3to5" in "".join(rest.split()), "a narrow table breaks the path"
    assert all(f"Cla1Regs.MVECT1 {number}." in text for number in of["Cla1Regs.MVECT1"]), "three are not many"
    assert text.count("an error") == 4, "only notes are counted together"
    whole = printed(report, width=width, details=True)
    assert all(whole.count(one.message) >= 2 for one in found), "in the table, and in full"
    # The caption counts findings, not rows.
    assert f"{len(found) - 5} more" in printed(report, width=width, most=5)


def test_no_finding_is_said_in_words() -> None:
    assert summary([]) == "no findings"
