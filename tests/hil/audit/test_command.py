"""``hil audit``: table, page, picture, and errors in one line."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from firmware_model.catalogue import CATALOGUE
from hil.audit import run
from hil.cli import compare_tools, invoke
from hil.cli.audit import complete_id


def test_an_entry_is_a_page_with_its_evidence(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["audit", "ODO-angle-factor"]) == 0
    words = " ".join(capsys.readouterr().out.replace("\u2502", " ").split())
    assert "ODO-angle-factor" in words
    assert CATALOGUE["ODO-angle-factor"].correction in words
    assert "severity error" in words, "after a quarter turn the robot is drawn at 70 degrees"
    assert "Odometry.c:21: Odom_Trayect" in words, "where dx is computed, in the C file of the thesis"
    assert words.count("not seen (property):") == 2, "with the correction, and with all"


def test_the_entries_of_a_file_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["audit", "--file", "Odometry.c", "--jobs", "1", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert [entry["id"] for entry in report["entries"]] == [
        d.id for d in CATALOGUE.values() if d.c_file == "Odometry.c"
    ]
    assert report["proven"] == report["of"]
    severities = {entry["id"]: entry["severity"] for entry in report["entries"]}
    # 0.01 rad/s is a slow turn; in every other one the robot is drawn on the spot, and squares are open.
    assert severities["ODO-slow-turn-lost"] == "warning"
    assert severities["ODO-units-turning"] == severities["ODO-angle-factor"] == "error"


def test_the_list_runs_nothing_and_says_where_how_grave_and_how_sure(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hil.audit.run.demonstrate", None)
    assert invoke(["audit", "--list", "GYRO-sum16", "ODO-angle-factor"]) == 0
    sure, angle = capsys.readouterr().out.splitlines()
    assert sure.startswith("GYRO-sum16  GYRO.c:102: Init_GYRO  TFG 3.1.2  warning  depends on the zero-rate level")
    assert angle == "ODO-angle-factor  Odometry.c:21: Odom_Trayect  TFG 3.3.2  error"
    assert invoke(["audit", "--list", "--json", "FIG-end-mark"]) == 0
    (entry,) = json.loads(capsys.readouterr().out)["entries"]
    assert (entry["id"], entry["line"], entry["depends_on"]) == ("FIG-end-mark", 0, "")


def test_what_is_only_read_is_not_counted_as_proven(capsys: pytest.CaptureFixture[str]) -> None:
    # A blocking time of the text against another of the text, a time against the running robot's, a finding.
    names = ["FIG-blocking-orders", "FIG-periodic-tasks", "ODO-half-step", "US-average-empty"]
    assert invoke(["audit", *names, "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["by"] == {"detector": 1, "property": 2, "read": 1}
    assert (report["proven"], report["of"]) == (3, 4)


def test_a_picture_is_written(tmp_path: Path) -> None:
    file = tmp_path / "square.png"
    assert invoke(["audit", "ODO-angle-factor", "--plot", str(file)]) == 0
    assert file.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["US-acumulator"], "did you mean US-accumulator"),
        (["--file", "us.h"], "the catalogue has no entries of 'us.h'"),
        (["--plot", "x.png"], "--plot needs one entry"),
        (["US-accumulator", "--plot", "x.txt"], "a picture's name ends in .png"),
        (["US-median-even", "--plot", "x.png"], "US-median-even has no picture"),
        (["--compare", "US-accumulator"], "--compare takes no entries"),
        (["--list", "--firmware", "x"], "--list runs nothing"),
        (["--markdown"], "--markdown is a form of --compare"),
        (["--compare", "--markdown", "--json"], "--markdown is a form of --compare"),
    ],
)
def test_bad_input_is_one_line(
    arguments: list[str], error: str, tmp_path: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert invoke(["audit", *arguments]) == 2
    err = capsys.readouterr().err
    assert error in err
    assert err.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_without_tools_the_table_has_the_column_of_this_one(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compare_tools, "TOOLS", ())
    assert invoke(["audit", "--compare", "--markdown"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "| defect | rule | hil |"
    assert lines[-1] == "| **of 20** |  | **20** |"


def test_identifiers_are_completed() -> None:
    assert [name for name, _ in complete_id("ODO-a")] == ["ODO-angle-factor"]


@pytest.mark.parametrize("form", [(), ("--json",)])
def test_an_interrupted_audit_keeps_what_it_has(
    form: tuple[str, ...], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = run.audit

    def interrupted(names: list[str], **options: Any) -> Iterator[run.DemonstrationOutcome]:
        for count, outcome in enumerate(whole(names[:2], **options)):
            yield outcome
            if count:
                raise KeyboardInterrupt

    monkeypatch.setattr(run, "audit", interrupted)
    assert invoke(["audit", "--file", "protocol.c", *form]) == 130
    out, err = capsys.readouterr()
    entries = [defect.id for defect in CATALOGUE.values() if defect.c_file == "protocol.c"]
    left = f"{len(entries) - 2} of {len(entries)} entries were not examined"
    assert err.splitlines() == [left, "hil: error: interrupted"]
    if form:
        told = json.loads(out)
        assert [entry["id"] for entry in told["entries"]] == entries[:2]
        assert told["interrupted"]
    else:
        assert "Catalogue: 2 entries" in out
