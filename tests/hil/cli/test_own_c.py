"""`--firmware`: own C files of the robot for the commands that take them, and what a user can get wrong."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from emulator.c28x.passes.costs import UNCALIBRATED_FACTOR
from hil.cli import invoke

pytest.importorskip("pycparser")

ROOT = Path(__file__).parents[3]
#: The faithful Odometry.c in words of our own would be long; this one keeps the start and reads an unset local.
ODOMETRY = """\
#include "ROBOT_types.h"
#include "Odometry.h"
#ifdef BY_PROJECT
#define GAIN BY_PROJECT
#else
#define GAIN 0
#endif

void Odom_Trayect(ODOMETRY_Trayect *at, float V, float W, float df, float dr, float dl, float Tcontrol)
{
    float unset;

    at->X += GAIN * V * Tcontrol + unset * 0;
}
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "odometry.c").write_text(ODOMETRY, encoding="utf-8")
    return tmp_path


def test_a_run_reports_at_the_line_and_column_of_the_c_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--no-port", "--pace", "max", "--for", "0.5", "--json"]
    assert invoke(["run", "--firmware", "mine", *arguments]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["setup"]["firmware"] == ["mine/odometry.c"]
    (found,) = [f for f in summary["findings"] if f["object"] == "odometry.Odom_Trayect.unset"]
    # `    at->X += GAIN * V * Tcontrol + unset * 0;`: the name follows 4 + 9 + 22 characters.
    place = found["file"], found["line"], found["column"]
    assert (found["rule"], *place) == ("uninitialised", "mine/odometry.c", 13, 36)


def test_times_of_tasks_that_run_the_c_file_are_not_calibrated(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert invoke(["tasks", "--firmware", "mine", "--for", "0.5", "--json"]) == 0
    tasks = {task["task"]: task for task in json.loads(capsys.readouterr().out)["tasks"]}
    # TaskODO alone calls Odom_Trayect.
    assert {name for name, task in tasks.items() if task["residual_percent"] is None} == {"TaskODO"}
    assert tasks["TaskODO"]["uncalibrated_factor"] == UNCALIBRATED_FACTOR


def test_a_check_of_own_c_says_that_its_times_are_not_calibrated(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert invoke(["check", "--for", "0.2", "--fail-on", "never", "--firmware", "mine"]) == 0
    assert "times longer or shorter on the chip: it was not calibrated." in capsys.readouterr().out
    assert invoke(["check", "--for", "0.2", "--fail-on", "never"]) == 0
    assert "calibrated" not in capsys.readouterr().out


def test_conformance_judges_the_c_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    golden = ROOT / "tests" / "golden"
    assert invoke(["conformance", "--json", str(golden / "Odom_Trayect.json")]) == 0
    assert json.loads(capsys.readouterr().out)["failed"] == 0
    assert invoke(["conformance", "--firmware", "mine", str(golden / "Odom_Trayect.json")]) == 2
    assert "odometry.c declares no titamax" in capsys.readouterr().err
    c = folder / "mine" / "odometry.c"
    c.write_text(c.read_text(encoding="utf-8").replace("\nvoid", "\nstatic float titamax;\n\nvoid"), encoding="utf-8")
    assert invoke(["conformance", "--firmware", "mine", "--json", str(golden / "Odom_Trayect.json")]) == 1
    assert json.loads(capsys.readouterr().out)["failed"] > 0


def test_macros_of_the_project_in_the_folder_and_notes_of_what_is_left_out(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "mine" / ".cproject").write_text(
        '<cproject><option superClass="x.DEFINE"><listOptionValue value="BY_PROJECT=("/></option>'
        '<option superClass="x.INCLUDE_PATH"><listOptionValue value="${SDK}/h"/></option></cproject>',
        encoding="utf-8",
    )
    # The macro is an opening parenthesis, so the file no longer parses: it was taken from the project.
    assert invoke(["tasks", "--firmware", "mine", "--for", "0.1"]) == 2
    error = capsys.readouterr().err
    assert "note: mine/.cproject: include folder '${SDK}/h' is left out: ${SDK} is not known here" in error
    assert "mine/odometry.c:13:" in error


@pytest.mark.parametrize("command", ["run", "tasks", "check", "audit", "conformance"])
def test_a_folder_without_a_file_of_the_robot_is_one_line(
    command: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "empty").mkdir()
    arguments = ["average.json"] if command == "conformance" else []
    assert invoke([command, *arguments, "--firmware", "empty"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("hil: error: empty: no C file of the robot in this folder: looked for main_Robot.c, us.c,")
    assert error.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["tasks", "--firmware", "nowhere"], "nowhere: there is no such file or folder"),
        (["tasks", "-D", "X"], "-D needs C files: give --firmware DIR"),
        (["tasks", "--firmware", "mine", "-I", "nowhere"], "-I nowhere: there is no such folder"),
        (["tasks", "--firmware", "mine", "--project", "bomb"], "bomb: not a project of Code Composer: a DOCTYPE"),
        (["run", "--firmware", "mine", "--fix", "ODO-half-step"], "is for the port, not for a C file"),
        (["check", "mine/odometry.c", "--firmware", "mine"], "--firmware: it is for the robot"),
        (["audit", "--compare", "--firmware", "mine"], "--compare is about classes of defects"),
    ],
)
def test_bad_input_is_one_line(
    arguments: list[str], message: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "bomb").write_text('<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', encoding="utf-8")
    assert invoke(arguments) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_a_scenario_names_files_beside_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scenario = 'firmware = ["mine"]\ndefines = ["BY_PROJECT=0"]\nseconds = 0.3\norders = []\n'
    (folder / "mine" / ".." / "own.toml").write_text(scenario, encoding="utf-8")
    assert invoke(["check", "own.toml", "--json", "--fail-on", "never"]) == 0
    found = json.loads(capsys.readouterr().out)["findings"]
    assert any(f["object"] == "odometry.Odom_Trayect.unset" for f in found)
