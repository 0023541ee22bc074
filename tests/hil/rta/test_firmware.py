"""The robot's own firmware, and the command."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hil.cli import invoke
from hil.client.orders import parse_order
from hil.machine import Setup
from hil.rta.analysis import analyse
from hil.rta.firmware import RunningFirmware
from hil.running import running
from tests.hil.rta.sheets import SHEET


@pytest.fixture(scope="module")
def robot() -> RunningFirmware:
    firmware = RunningFirmware(running(Setup(), traced=False), orders=[parse_order("mission")])
    firmware.start()
    firmware.run(3)
    firmware.machine.close()
    return firmware


def test_the_task_set_of_the_robot(robot: RunningFirmware) -> None:
    found = {task.name: task for task in robot.measured().tasks}
    # main_Robot.c: priorities and periods in ticks; the tick of CPU timer 2 is 200,001 cycles of 5 ns.
    expected = {
        "TaskUS": (6, 5), "TaskGYRO": (5, 5), "TaskSERVO": (3, 25), "TaskNAVIGATION": (2, 50), "TaskODO": (1, 250),
    }  # fmt: skip
    for name, (priority, ticks) in expected.items():
        assert (found[name].priority, found[name].arrival.period_ns) == (priority, ticks * 1_000_005)
    assert found["TaskORD"].arrival.period_ns == 6_250_000
    assert {section.gate for section in found["TaskNAVIGATION"].sections} == {
        "US_server", "GYRO_server", "Status_server", "Reference_server",
    }  # fmt: skip
    assert [section.gate for section in found["TaskUS"].sections] == ["US_server"]
    assert not robot.measured().nested


def test_the_critical_instant_is_seen(robot: RunningFirmware) -> None:
    worst = robot.observer.tasks["TaskODO"].worst
    assert worst is not None
    assert {"TaskUS", "TaskGYRO", "TaskSERVO", "TaskNAVIGATION"} <= {stretch.who for stretch in worst.stretches}


def test_nothing_longer_is_seen_than_computed(robot: RunningFirmware) -> None:
    for response in analyse(robot.measured()):
        seen = robot.observer.tasks[response.task.name].response * 5
        assert response.ready_to_end_ns is not None
        assert 0 < seen <= response.ready_to_end_ns


def test_start_up_is_what_taskgyro_waits_for(robot: RunningFirmware) -> None:
    # Init_GYRO waits 100 times 20 ms: whoever is below TaskGYRO starts afterwards.
    first = {start.task: start.first_wait_ms for start in robot.start_ups()}
    assert first["TaskUS"] < 10
    assert min(first[name] for name in ("TaskGYRO", "TaskORD", "TaskSERVO", "TaskNAVIGATION", "TaskODO")) > 2000


def test_the_command_on_the_robot(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "worst.png"
    assert invoke(["rta", "--phasings", "0", "--synthetic", "--plot", str(picture), "--task", "TaskODO", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert [run["kind"] for run in report["runs"]] == ["firmware", "synthetic tasks"]
    assert report["findings"] == report["late"] == []
    assert {row["task"]: row["off_by"] for row in report["tasks"]}["TaskORD"] == "x 0.33 to x 3"
    assert picture.read_bytes()[:4] == b"\x89PNG"


def test_the_command_on_a_sheet(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sheet = tmp_path / "tasks.toml"
    sheet.write_text(SHEET, encoding="utf-8")
    assert invoke(["rta", str(sheet), "--phasings", "3"]) == 0
    text = capsys.readouterr().out
    assert "Start-up of b: ends at 150.00 us, 1 releases by then" in text
    assert invoke(["rta", str(sheet), "--json", "--protocol", "ceiling", "--phasings", "3"]) == 0
    report = json.loads(capsys.readouterr().out)
    # a: 100 and 20 of b in g; b: 300 and one a.
    assert [row["response_us"] for row in report["tasks"]] == [120, 400]


BOARD = '''from hil.board import Board


class Lab(Board):
    """A chip alone."""

    def solder(self) -> None:
        """Nothing."""
'''
PROGRAM = '''#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Task.h>
#include "F28x_Project.h"
Semaphore_Handle go;
GateMutexPri_Handle A, B;
void release(UArg a) { Semaphore_post(go); }
void Blink(UArg a, UArg b) {
    IArg k, l;
    while (1) {
        Semaphore_pend(go, BIOS_WAIT_FOREVER);
        k = GateMutexPri_enter(A); DELAY_US(60);
        l = GateMutexPri_enter(B); DELAY_US(40); GateMutexPri_leave(B, l);
        GateMutexPri_leave(A, k);
    }
}
void main(void) {
    Clock_Params clock; Task_Params task;
    go = Semaphore_create(0, NULL, NULL); A = GateMutexPri_create(NULL, NULL); B = GateMutexPri_create(NULL, NULL);
    Clock_Params_init(&clock); clock.period = 10; clock.startFlag = TRUE;
    Clock_create((Clock_FuncPtr)release, 10, &clock, NULL);
    Task_Params_init(&task); task.priority = 3;
    Task_create((Task_FuncPtr)Blink, &task, NULL);
    BIOS_start();
}
'''


def test_a_program_on_a_board_of_ones_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pycparser")
    (tmp_path / "lab.py").write_text(BOARD, encoding="utf-8")
    (tmp_path / "main.c").write_text(PROGRAM, encoding="utf-8")
    command = ["rta", "--board", str(tmp_path / "lab.py"), "--firmware", str(tmp_path / "main.c"), "--json"]
    assert invoke([*command, "--phasings", "2"]) == 0
    (row,) = json.loads(capsys.readouterr().out)["tasks"]
    # Ten ticks of 200,001 cycles.
    assert (row["task"], row["priority"], row["period_us"]) == ("Blink", 3, pytest.approx(10_000.05))
    assert 100 < row["computation_us"] <= row["seen"][0]["response_us"] <= row["seen"][0]["computed_us"]
    assert row["off_by"] == "x 0.33 to x 3"
    (outer,) = row["sections"]
    (inner,) = outer["sections"]
    assert (outer["gate"], inner["gate"]) == ("A", "B")
    assert 100 < outer["time_us"] < 120
    assert 40 < inner["time_us"] < 50


def test_a_missed_deadline_is_exit_1(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sheet = tmp_path / "tasks.toml"
    sheet.write_text(SHEET.replace("computation_us = 300", "computation_us = 300\ndeadline_us = 350"), encoding="utf-8")
    assert invoke(["rta", str(sheet), "--phasings", "0"]) == 1
    assert "Deadlines that may be missed: b" in capsys.readouterr().out


def test_a_set_without_a_bound_is_computed_and_not_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sheet = tmp_path / "tasks.toml"
    # 900 in 1000 of a, 300 in 2000 of b.
    sheet.write_text(SHEET.replace("computation_us = 100", "computation_us = 900"), encoding="utf-8")
    assert invoke(["rta", str(sheet), "--json"]) == 1
    report = json.loads(capsys.readouterr().out)
    assert (report["utilisation"], report["runs"]) == (pytest.approx(1.05), [])
    assert report["not_run"].startswith("b may not end before its next release")
    assert {row["task"]: row["response_us"] for row in report["tasks"]}["b"] is None
    assert invoke(["rta", str(sheet), "--plot", str(tmp_path / "t.png")]) == 2
    assert "b may not end before its next release" in capsys.readouterr().err


def test_gates_that_are_entered_in_a_circle(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sheet = tmp_path / "tasks.toml"
    within = '{ gate = "%s", time_us = %d, sections = [{ gate = "%s", time_us = %d }] }'
    text = SHEET.replace('{ gate = "g", time_us = 10 }', within % ("g", 10, "h", 4))
    sheet.write_text(text.replace('{ gate = "g", time_us = 20 }', within % ("h", 20, "g", 8)), encoding="utf-8")
    assert invoke(["rta", str(sheet), "--phasings", "0"]) == 1
    out = capsys.readouterr().out
    assert "Tasks may wait in a circle for ever: gates g, h" in out
    assert "b holds h: 20 us\nb holds g: 8 us, within h\n" in out
    assert invoke(["rta", str(sheet), "--phasings", "3", "--protocol", "ceiling", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    # a: 100, and all that b holds h for.
    assert [row["response_us"] for row in report["tasks"]] == [120, 400]
    assert report["tasks"][1]["sections"] == [
        {"gate": "h", "time_us": 20, "sections": [{"gate": "g", "time_us": 8, "sections": []}]}
    ]


def test_options_of_the_board_reach_it(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def told(setup: Setup, **_: object) -> None:
        raise ValueError(f"made with {setup.options}")

    monkeypatch.setattr("hil.running.running", told)
    assert invoke(["rta", "--option", "five-sonars,lidar"]) == 2
    assert "made with ('five-sonars', 'lidar')" in capsys.readouterr().err


def test_a_response_above_the_computed_one_is_a_finding(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from hil.rta import synthetic

    class Shorter(synthetic.SyntheticTasks):
        """Tells of shorter computation times than the runs had."""

        def measured(self) -> synthetic.TaskSet:
            return self.observer.measured({"a": (2, 0), "b": (3, 0)})  # b above a: its response has no place for a

    monkeypatch.setattr(synthetic, "SyntheticTasks", Shorter)
    sheet = tmp_path / "tasks.toml"
    sheet.write_text(SHEET, encoding="utf-8")
    assert invoke(["rta", str(sheet), "--phasings", "0", "--json"]) == 1
    findings = json.loads(capsys.readouterr().out)["findings"]
    assert [(finding["rule"], finding["task"]) for finding in findings] == [("response-exceeds-computed", "b")]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--protocol", "magic"], "there are none, inheritance, ceiling"),
        (["nowhere.toml"], "No such file"),
        (["--thesis", "x.toml"], "leave the sheet out"),
        (["--thesis", "--plot", "x.png"], "leave --plot out"),
        (["--kernel", "2"], "--kernel is for synthetic tasks"),
        (["x.toml", "--order", "stop"], "a sheet or --order, not both"),
        (["x.toml", "--board", "lab.py"], "a sheet or --board, not both"),
        (["--plot", "x.txt"], "a picture's name ends in .png"),
        (["--task", "TaskODO"], "give --plot FILE"),
        (["--option", "sonar"], "option 'sonar': must be five-sonars"),
        (["x.toml", "--option", "lidar"], "a sheet or --option, not both"),
    ],
)
def test_what_a_user_can_get_wrong(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["rta", *arguments]) == 2
    assert message in capsys.readouterr().err


def test_the_tables_of_the_thesis(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["rta", "--thesis"]) == 0
    assert "359.83" in capsys.readouterr().out
    assert invoke(["rta", "--thesis", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["cells"]) == 93
