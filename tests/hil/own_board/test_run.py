"""``hil run --board FILE``: a user's board and program, without an edit of this project."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import serial

from hil.cli import invoke
from hil.recording.log import Direction, read_log
from tests.hil.own_board import project
from tests.hil.waiting import eventually

pytest.importorskip("pycparser")

REPOSITORY = Path(__file__).parents[3]
RUN = ("run", "--board", "station_board.py", "--firmware", "firmware", "--ideal")
QUICK = (*RUN, "--pace", "max")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    project.write(tmp_path)
    return tmp_path


def summary(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    assert invoke([*arguments, "--json"]) == 0
    told: dict[str, Any] = json.loads(capsys.readouterr().out)
    return told


def sent(log: Path) -> list[str]:
    return read_log(log).stream(Direction.FROM_ROBOT).decode("ascii").split()


def start(folder: Path, *arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "hil", *arguments], cwd=folder, text=True, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(REPOSITORY)},
    )  # fmt: skip


def test_what_is_put_to_the_sensors_is_what_the_program_sends(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    told = summary(
        capsys, *QUICK, "--no-port", "--for", "0.35", "--wire", "run.wire", "--put", "thermometer.temperature_c=-3.25",
        "--put", "infrared.distance_m=0.16", "--put", "0.25:infrared.distance_m=0.32",
    )  # fmt: skip
    # -3.25 degrees are -52 sixteenths; 0.24 V m / 0.16 m = 1.5 V of 3 V = 2048 of 4096; twice as far, half of it.
    # A round takes the 100 ms of its delay and some 10 characters of 1.04 ms: the third begins at about 0.22 s.
    assert sent(folder / "run.wire") == ["-52", "2048", "-52", "2048", "-52", "2048", "-52", "1024"]
    assert told["parts"]["infrared"] == {"distance_m": 0.32, "level_v": 0.75}
    assert told["parts"]["thermometer"] == {"temperature_c": -3.25}
    assert told["bytes_from_board"] == 4 * len("-52 2048\r\n")
    assert (told["virtual_s"], told["findings"], told["ended"]) == (0.35, [], False)
    assert not {"world", "xbee", "fixes"} & told["setup"].keys()
    assert invoke(["replay", "run.wire"]) == 0
    assert capsys.readouterr().out.startswith("no findings\nbyte-equal: ")


def test_neither_robot_nor_world_is_loaded(folder: Path) -> None:
    script = (
        "import sys\nfrom hil.cli import invoke\n"
        f"status = invoke({[*QUICK, '--no-port', '--for', '0.1']})\n"
        "print('status:', status, sorted(n for n in sys.modules if n in ('firmware_model', 'hil.bench')))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=folder, capture_output=True, text=True, timeout=120, check=True,
        env={**os.environ, "PYTHONPATH": str(REPOSITORY)},
    )  # fmt: skip
    assert done.stdout.endswith("status: 0 []\n"), done.stdout


def test_tasks_of_a_kernel_run_and_findings_stand_at_the_line(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project.write(folder, main=project.TASKS)
    told = summary(capsys, *QUICK, "--no-port", "--for", "0.25")
    assert [(f["rule"], f["object"], f["task"]) for f in told["findings"]] == [
        ("uninitialised", "main.Reporter.sum", "Reporter")
    ]
    assert told["bytes_from_board"] == 3 * len("410\r\n")
    assert invoke([*QUICK, "--no-port", "--for", "0.25"]) == 0
    out = capsys.readouterr().out
    assert "1 error\n" in out
    assert "firmware/main.c:17" in out
    assert "15 bytes from the board" in out


def test_a_program_in_c_shaped_python_on_a_bare_chip(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lamp.py").write_text(project.LAMP)
    assert invoke(["run", "--board", "bare", "--firmware", "lamp.py", "--pace", "max", "--for", "0.02"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("port: none, bare has no line to a PC\nno findings\nvirtual time 0.020 s in ")
    assert "0 bytes from the board" in out


def test_a_run_says_which_build_it_ran(folder: Path) -> None:
    command = [sys.executable, "-m", "hil", *QUICK, "--no-port", "--for", "0.02"]
    done = subprocess.run(command, env=os.environ | {"HIL_PURE": "1"}, capture_output=True, text=True, check=True)
    assert ", pure Python\n" in done.stdout


def test_a_program_that_has_ended_is_told(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project.write(folder, main="void main(void) { }\n")
    assert invoke([*QUICK, "--no-port", "--for", "0.02"]) == 0
    assert "the program has ended: main has returned" in capsys.readouterr().out


def test_without_a_line_to_a_pc_it_says_so(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project.write(folder, pc=False)
    assert invoke([*QUICK, "--for", "0.1", "--json"]) == 0
    out, err = capsys.readouterr()
    assert err == "port: none, station_board.py has no line to a PC\n"
    assert json.loads(out)["port"] is None


@pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals and signals of POSIX")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_pc_program_reads_and_writes_and_a_signal_ends_it_with_the_summary(folder: Path, number: int) -> None:
    board = start(folder, *RUN, "--link", "COM3", "--pace", "10")
    assert board.stdout is not None
    assert board.stdout.readline() == "port: COM3\n"
    heard = bytearray()
    with serial.Serial(str(folder / "COM3"), 9600, timeout=1) as line:
        # 21.5 degrees are 344 sixteenths; 0.24 V m / 0.8 m = 0.3 V of 3 V = 409.6 of 4096.
        eventually(lambda: b"344 409\r\n" in heard or b"344 410\r\n" in heard, lambda: heard.extend(line.read(16)))
        line.write(b"?")
        eventually(lambda: b"?" in heard, lambda: heard.extend(line.read(16)))
    board.send_signal(number)
    out, err = board.communicate(timeout=60)
    assert (board.returncode, err) == (0, "")
    assert ", 1 bytes to it" in out
    assert not os.path.lexists(folder / "COM3")


def test_lines_that_ran_are_written(folder: Path) -> None:
    assert invoke([*QUICK, "--no-port", "--for", "0.05", "--lcov", "run.info"]) == 0
    text = (folder / "run.info").read_text()
    assert "FNDA:1,Read_Infrared" in text
    assert "firmware_model" not in text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--world", "room"], "--world needs a robot in its world, and Station has no wheels"),
        (["--order", "mission"], "--order needs a robot"),
        (["--fix", "all"], "--fix needs a robot"),
        (["--no-xbee"], "--xbee/--no-xbee needs a robot"),
        (["--plot", "drive.png"], "--plot needs a robot"),
        (["--put", "infrared.distance_m=9"], "infrared.distance_m = 9: must be 0.08 to 2 m"),
        (["--put", "infrared.distance_m=nan"], "infrared.distance_m = nan: must be 0.08 to 2 m"),
        (["--put", "thermometer.temperature_c=nan"], "temperature_c = nan: must be a number of degrees C"),
        (["--put", "infrared.distance_m=near"], "'near': must be a number; distance_m (m, 0.08 to 2)"),
        (["--put", "1:infrared.level_v=1"], "infrared.level_v can only be read: the part computes it"),
        (["--put", "infrared.range=1"], "the part 'infrared' has no face 'range': distance_m (m, 0.08 to 2), level_v"),
        (["--put", "sonar.range_m=1"], "Station has no part 'sonar': thermometer, infrared"),
        (["--put", "infrared"], "'infrared': expected [TIME:]PART.FACE=VALUE; Station has thermometer.temperature_c"),
        (["--firmware", "nowhere"], "nowhere: there is no such file"),
        (["-D", "1=2"], "-D 1=2: expected NAME or NAME=VALUE"),
    ],
)
def test_what_cannot_be_is_one_line(
    arguments: list[str], message: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert invoke([*QUICK, "--no-port", "--for", "0.01", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("hil: error: ")
    assert message in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--board", "station_board.py"], "no firmware is given for the board Station: give --firmware DIR (or files)"),
        (["--board", "missing.py"], "there is no such file"),
        (["--board", "station_board.py", "-D", "LAB=3"], "-D needs C files: give --firmware DIR"),
        (["--board", "station_board.py", "--firmware", "firmware/station.c"], "no program, it has no main"),
        (["--board", "half.py", "--firmware", "firmware"], "board Half: AttributeError: "),
        (["--board", "alone.py", "--firmware", "firmware", "--link", "COM3"], "alone.py has no line to a PC"),
        (["--board", "alone.py", "--firmware", "firmware", "--wire", "x.wire"], "--wire: alone.py has no line to a PC"),
        (["--board", "twice.py", "--firmware", "firmware"], "pc at GPIO1: no SCI reaches this pin; it reaches GPIO 8"),
    ],
)
def test_a_board_or_a_program_that_cannot_run_is_one_line(
    arguments: list[str], message: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    solder = "from hil.board import Board\n\n\nclass {}(Board):\n    def solder(self):\n        {}\n"
    (folder / "half.py").write_text(solder.format("Half", "self.on_lin('radio')"))
    (folder / "alone.py").write_text(solder.format("Alone", "pass"))
    (folder / "twice.py").write_text(solder.format("Twice", "self.to_pc(tx_gpio=1, rx_gpio=90)"))
    assert invoke(["run", *arguments, "--for", "0.01"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert message in err
    assert err.count("\n") == 1
    assert not (folder / "x.wire").exists()


def test_an_error_in_a_part_of_the_users_is_told_at_its_line(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (folder / "station_board.py").read_text()
    broken = text.replace("return min(3.0, 0.24 / self.distance_m)", "return 0.24 / (self.distance_m - 0.8)")
    line = next(n for n, each in enumerate(broken.splitlines(), 1) if "- 0.8" in each)
    (folder / "station_board.py").write_text(broken)
    assert invoke([*QUICK, "--no-port", "--for", "0.1"]) == 1
    err = capsys.readouterr().err
    assert f"an error of the board in station_board.py:{line}, not of the firmware: ZeroDivisionError" in err
    assert err.count("\n") == 1


def test_a_part_may_stand_in_a_file_beside_the_board(folder: Path) -> None:
    board = (folder / "station_board.py").read_text()
    begin, end = board.index("class Infrared"), board.index("class Station")
    (folder / "my_infrared.py").write_text(board[begin:end])
    (folder / "station_board.py").write_text("from my_infrared import Infrared\n" + board[:begin] + board[end:])
    path = list(sys.path)
    assert invoke([*QUICK, "--no-port", "--for", "0.01"]) == 0
    assert sys.path == path


def test_a_robot_with_a_part_more_drives_in_its_world(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my_robot.py").write_text(
        "from hil.board import Face\nfrom hil.robot.board import RobotBoard\n\n\n"
        "class Battery:\n    level_v = 1.0\n\n    def volts(self, cycles):\n        return self.level_v\n\n\n"
        "class MyRobot(RobotBoard):\n    def solder(self):\n        super().solder()\n"
        "        self.on_adc('battery', Battery(), adc='B', channel=2, faces=[Face('level_v', 'V', 0, 3)])\n"
    )
    told = summary(
        capsys, "run", "--board", "my_robot.py", "--world", "box", "--pace", "max", "--no-port", "--for", "0.3",
        "--put", "battery.level_v=2.5",
    )  # fmt: skip
    assert told["frames"] == 1
    assert told["setup"]["world"] == "box"
    assert invoke(["run", "--board", "my_robot.py", "--no-port", "--put", "battery.level_v=4", "--for", "0.1"]) == 2
    assert "battery.level_v = 4: must be 0 to 3 V" in capsys.readouterr().err


def test_the_project_of_the_run_is_tested_with_pytest_too(pytester: pytest.Pytester) -> None:
    project.write(pytester.path)
    pytester.makepyfile(
        test_station="""
        import pytest

        pytestmark = [
            pytest.mark.board("station_board.py"), pytest.mark.firmware("firmware/station.c", "firmware/main.c")
        ]


        def test_both_sensors_are_read(firmware, outside):
            firmware.station.Init_Station()
            outside.put("thermometer", temperature_c=-3.25)
            outside.put("infrared", distance_m=0.16)
            assert firmware.station.Read_Sixteenths() == -52
            assert firmware.station.Read_Infrared() == 2048


        def test_the_program_reports_to_the_pc(firmware, kernel, until, when, outside):
            outside.put("infrared", distance_m=0.16)
            kernel.start(firmware.main.main)
            until(when.frame(rb"344 2048\\r"))
        """
    )
    outcome = pytester.runpytest_subprocess("-p", "no:xdist")
    outcome.assert_outcomes(passed=2)
