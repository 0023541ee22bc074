"""Findings that the source accepts count no more, and every report says so."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from hil.cli import invoke
from hil.drivers.check import DriverFiles, check_files
from hil.reports.model import Report, Run
from hil.reports.terminal import last_line

LAMP = """#include "F28x_Project.h"
void Lamp(void)
{
    %s
    GpioCtrlRegs.GPADIR.bit.GPIO5 = 1;
}
"""
REASON = "EALLOW is on since the boot code"


def lamp(folder: Path, comment: str) -> Path:
    file = folder / "lamp.c"
    file.write_text(LAMP % comment, encoding="utf-8")
    return file


def test_what_the_source_accepts_does_not_count_and_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = lamp(tmp_path, "")
    assert invoke(["check", str(file)]) == 1
    file = lamp(tmp_path, f"// hil: allow eallow, {REASON}")
    sarif, junit, html = (tmp_path / name for name in ("a.sarif", "a.xml", "a.html"))
    capsys.readouterr()
    files = ["--sarif", str(sarif), "--junit", str(junit), "--html", str(html)]
    assert invoke(["check", str(file), "--details", *files]) == 0
    out = capsys.readouterr().out
    assert f"accepted in the source: {REASON}" in out
    assert out.splitlines()[-1] == "1 error, 1 accepted in the source; none fails the check"
    (result,) = json.loads(sarif.read_text())["runs"][0]["results"]
    assert result["suppressions"] == [{"kind": "inSource", "justification": REASON}]
    (skipped,) = ElementTree.parse(junit).getroot().iter("skipped")
    assert skipped.get("message", "").startswith(f"accepted in the source: {REASON}: ")
    assert REASON in html.read_text()
    assert invoke(["check", str(file), "--json"]) == 0
    (finding,) = json.loads(capsys.readouterr().out)["findings"]
    assert finding["accepted"] == REASON


@pytest.mark.parametrize("comment", [f"// hil: allow index, {REASON}", f"f(); // hil: allow eallow, {REASON}"])
def test_another_rule_or_another_line_accepts_nothing_and_that_is_told(
    tmp_path: Path, comment: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert invoke(["check", str(lamp(tmp_path, comment.replace("f();", "EDIS;")))]) == 1
    out = capsys.readouterr().out
    assert f"lamp.c:4: hil: allow {comment.partition('allow ')[2]}: nothing was found there" in out


def test_a_baseline_does_not_take_up_what_the_source_accepts(tmp_path: Path) -> None:
    baseline = tmp_path / "known.json"
    command = ["check", str(lamp(tmp_path, f"// hil: allow eallow, {REASON}"))]
    assert invoke([*command, "--baseline", str(baseline), "--update-baseline"]) == 0
    assert json.loads(baseline.read_text())["findings"] == []


def test_a_report_without_files_reads_those_of_its_findings(tmp_path: Path) -> None:
    findings = check_files(DriverFiles([lamp(tmp_path, f"// hil: allow eallow, {REASON}")])).findings
    report = Report.of(findings, run=Run("a test"))
    assert [entry.accepted for entry in report.entries] == [REASON]
    assert not report.counted
    assert last_line(report) == "1 error, 1 accepted in the source; none fails the check"
