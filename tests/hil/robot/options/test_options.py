"""Who asks for options gets them, and who asks for none has the robot of the thesis, to the byte."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import pytest

from hil.bench import Bench
from hil.board import Board
from hil.cli import invoke
from hil.machine import Setup
from hil.recording.log import Recording
from hil.recording.replay import setup_of
from hil.reports.policy import Policy
from hil.robot.board import RobotBoard
from hil.robot.options.names import OPTIONS, checked
from hil.running import running
from hil.scenarios.scenario import load_scenario
from tests.hil.robot.options.page import FILES, PAGE, SECTIONS

ALL = tuple(OPTIONS)


def test_names() -> None:
    assert checked(["lidar", "five-sonars, lidar"]) == ("lidar", "five-sonars")
    assert checked([]) == ()
    for wrong in ("radar", "", "lidar,"):
        with pytest.raises(ValueError, match="must be five-sonars, accelerometer, lidar"):
            checked([wrong])


def test_without_options_nothing_is_there() -> None:
    board = RobotBoard()
    assert set(board.parts) == {"gyro", "sonars", "left motor", "right motor", "bumper", "link"}
    assert set(board.sonars.sensors) == {"LEFT", "FRONT", "RIGHT"}
    assert (board.accelerometer, board.lidar) == (None, None)
    # A log or a report of such a run has no word more than before there were options.
    assert Setup().as_dict() == {
        name: value for name, value in asdict(Setup()).items() if name not in ("options", "faults", "feeds")
    }


def test_every_pin_is_free_but_the_bus_of_the_gyro() -> None:
    board = RobotBoard(options=ALL)
    pins = [pin for name, part in board.parts.items() if name != "accelerometer" for pin in part.pins.values()]
    pins.append(board.part("accelerometer").pins["CS"])
    assert len(pins) == len(set(pins))


def test_a_board_of_ones_own_names_its_options() -> None:
    class Mine(RobotBoard):
        options = ("lidar",)

    assert Mine(options=("five-sonars",)).options == ("lidar", "five-sonars")
    assert Mine().lidar is not None
    assert Mine().accelerometer is None


def test_boards_that_have_none_say_so() -> None:
    with pytest.raises(ValueError, match="option lidar: Board has no parts on demand"):
        running(Setup(board="bare", options=("lidar",), firmware=("x.c",)))
    assert "options" not in Board.__init__.__annotations__


def test_faces_are_read_back() -> None:
    board = RobotBoard(options=ALL)
    for part in ("accelerometer", "lidar"):
        for face in board.part(part).faces:
            board.part(part).put(face.name, 1.5)
            assert board.part(part).value(face.name) == 1.5
    bench = Bench(Setup(options=ALL), traced=False)
    assert bench.board.part("accelerometer").value("z_m_s2") is None, "a world moves it"
    assert bench.board.part("lidar").value("distance_m") is None
    bench.close()


def test_two_runs_of_one_setup_are_the_same() -> None:
    digests = set()
    for _ in range(2):
        bench = Bench(Setup(options=ALL, seed=7))
        bench.boot()
        bench.feed(b"#MISN\r")
        bench.run_for(2.0)
        digests.add((bench.uart_sha256, bench.trace_sha256))
        bench.close()
    assert len(digests) == 1


def test_a_recording_knows_its_options() -> None:
    setup = Setup(options=("lidar", "accelerometer"))
    header = {"setup": json.dumps(setup.as_dict())}
    assert setup_of(Recording("log", header, [])) == setup
    old = {name: value for name, value in asdict(Setup()).items() if name not in ("options", "faults", "feeds")}
    assert setup_of(Recording("log", {"setup": json.dumps(old)}, [])) == Setup()


def test_a_scenario_asks(tmp_path: Path) -> None:
    file = tmp_path / "five.toml"
    file.write_text('options = ["five-sonars"]\nseconds = 1\n', encoding="utf-8")
    assert load_scenario(file, Policy())[0].setup.options == ("five-sonars",)
    file.write_text('options = ["nose"]\n', encoding="utf-8")
    with pytest.raises(ValueError, match=r"five.toml:1: options: option 'nose': must be"):
        load_scenario(file, Policy())


def test_commands(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["board", "--option", "lidar,accelerometer", "--json"]) == 0
    parts = {part["name"]: part for part in json.loads(capsys.readouterr().out)["parts"]}
    assert parts["lidar"]["pins"] == {"RX": "GPIO70", "TX": "GPIO71"}
    assert parts["accelerometer"]["pins"]["CS"] == "GPIO64"
    assert invoke(["board", "--option", "nose"]) == 2
    assert "option 'nose': must be five-sonars" in capsys.readouterr().err
    assert invoke(["board", "bare", "--option", "lidar"]) == 2
    run = ["run", "--no-port", "--pace", "max", "--for", "0.1", "--json", "--option", "five-sonars"]
    assert invoke(run) == 0
    assert json.loads(capsys.readouterr().out)["setup"]["options"] == ["five-sonars"]
    assert invoke([*run[:-2], "--option", "lidar,radar"]) == 2


def test_the_drivers_of_the_page_are_clean(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("pycparser")
    monkeypatch.chdir(tmp_path)
    names = [name for name in FILES if name.endswith(".c")]
    assert len(names) == 3
    for name in names:
        Path(name).write_text(FILES[name], encoding="utf-8")
    mine = f"from hil.robot.board import RobotBoard\n\n\nclass Mine(RobotBoard):\n    options = {ALL!r}\n"
    Path("mine.py").write_text(mine, encoding="utf-8")
    assert invoke(["check", *names, "--board", "mine.py", "--calls", "5"]) == 0
    assert "; none fails the check" in capsys.readouterr().out


def test_the_page_names_every_option() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert all(f"| `{name}` |" in text for name in OPTIONS)
    assert len(SECTIONS) == 3
