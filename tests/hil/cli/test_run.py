"""``hil run`` around a scripted robot."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import serial

from hil.cli import invoke, show
from hil.client.decode import FrameDecoder
from hil.recording.log import read_log
from tests.hil.scripted_machine import ScriptedMachine
from tests.hil.waiting import eventually

REPOSITORY = Path(__file__).parents[3]

#: The installed command, with the scripted robot in place of the real one.
HIL = (
    "import hil.cli.show as show; from tests.hil.scripted_machine import ScriptedMachine; "
    "show.open_machine = ScriptedMachine; from hil.__main__ import main; main()"
)


@pytest.fixture(autouse=True)
def scripted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(show, "open_machine", ScriptedMachine)


def start(*arguments: str, cwd: Path) -> subprocess.Popen[str]:
    environment = {**os.environ, "PYTHONPATH": str(REPOSITORY)}
    return subprocess.Popen(
        [sys.executable, "-c", HIL, *arguments],
        cwd=cwd,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )


def test_json_is_one_object_with_both_digests(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["run", "--no-port", "--pace", "max", "--for", "2", "--order", "1:MISN", "--json"]) == 0
    out, err = capsys.readouterr()
    summary = json.loads(out)
    assert err == ""
    # The first of the frames begins 0.25 s after start-up and each takes less than 0.25 s: seven in 2 s.
    assert summary["frames"] == 7
    assert summary["bytes_to_robot"] == len(b"#MISN\r")
    assert len(summary["uart_sha256"]) == len(summary["trace_sha256"]) == 64
    assert [finding["rule"] for finding in summary["findings"]] == ["unwritten-read"]
    assert summary["virtual_s"] == 2.0


def test_two_runs_of_one_seed_have_the_same_digests(capsys: pytest.CaptureFixture[str]) -> None:
    digests = []
    for _ in range(2):
        invoke(["run", "--no-port", "--pace", "max", "--for", "1", "--seed", "7", "--json"])
        summary = json.loads(capsys.readouterr().out)
        digests.append((summary["uart_sha256"], summary["trace_sha256"]))
    assert digests[0] == digests[1]


def test_the_summary_tells_frames_findings_and_pace(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["run", "--pace", "max", "--for", "2"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("port: /dev/")
    assert "7 frames" in out
    assert "\n1 warning\n" in out
    assert "pace" in out


def test_with_json_the_port_is_announced_on_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["run", "--listen", "tcp://:0", "--pace", "max", "--for", "0.1", "--json"]) == 0
    out, err = capsys.readouterr()
    assert err.startswith("port: socket://127.0.0.1:")
    json.loads(out)


def test_a_plot_is_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "drive.png"
    assert invoke(["run", "--no-port", "--pace", "max", "--for", "2", "--plot", str(picture)]) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert f"plot {picture}" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--pace", "quick"], "pace 'quick': must be 'max' or a number"),
        (["--pace", "0"], "pace 0.0: must be 'max' or a number from"),
        (["--order", "jump"], "no order 'jump'"),
        (["--order", "1:set 1"], "no order 'set 1'"),
        (["--listen", "foo"], "cannot listen on 'foo'"),
        (["--listen", "tcp://:1", "--link", "X"], "choose one of"),
        (["--no-port", "--link", "X"], "--no-port contradicts"),
        (["--plot", "drive.doc"], "a picture's name ends in"),
        (["--view", "--wire", "not-written.wire"], "--view runs until Ctrl-C"),
        (["--world", "moon"], "no world 'moon'"),
        (["--port", "/dev/no-such-port"], "cannot open the serial port /dev/no-such-port"),
        (["--for", "-1"], "--for"),
        (["--deliver", "words"], "--deliver"),
        (["--no-such-option"], "No such option"),
        (["--link", "/no/such/folder/COM3", "--for", "0"], "cannot create the link"),
    ],
)
def test_wrong_input_is_one_line_on_stderr_and_status_2(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert invoke(["run", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("hil: error: ")
    assert message in err
    assert err.count("\n") == 1
    assert not Path("not-written.wire").exists()


@pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals and signals of POSIX")
def test_a_device_that_goes_away_ends_with_the_summary_a_whole_log_and_one_line(tmp_path: Path) -> None:
    master, slave = os.openpty()
    device = os.ttyname(slave)
    robot = start("run", "--port", device, "--wire", "run.wire", "--json", cwd=tmp_path)
    assert robot.stderr is not None
    assert robot.stderr.readline() == f"port: {device}\n"
    os.close(slave)
    os.close(master)
    out, err = robot.communicate(timeout=60)
    assert robot.returncode == 2
    assert err.startswith(f"hil: error: {device}: the port has gone away (")
    assert err.count("\n") == 1
    assert json.loads(out)["stopped"] in err
    assert read_log(tmp_path / "run.wire").problems == []


@pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals and signals of POSIX")
def test_frames_and_orders_pass_and_ctrl_c_ends_cleanly(tmp_path: Path) -> None:
    robot = start("run", "--link", "COM3", "--pace", "max", cwd=tmp_path)
    assert robot.stdout is not None
    assert robot.stdout.readline() == "port: COM3\n"
    with serial.Serial(str(tmp_path / "COM3"), 9600, timeout=1) as line:
        decoder = FrameDecoder()
        eventually(lambda: decoder.frames >= 10, lambda: decoder.feed(line.read(64)))
        line.write(b"#STOP\r")
    robot.send_signal(signal.SIGINT)
    out, err = robot.communicate(timeout=60)
    assert robot.returncode == 0
    assert err == ""
    assert "frames" in out
    assert not os.path.lexists(tmp_path / "COM3")


@pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals and signals of POSIX")
def test_a_terminated_robot_removes_its_link(tmp_path: Path) -> None:
    robot = start("run", "--link", "COM3", "--json", cwd=tmp_path)
    assert robot.stderr is not None
    assert robot.stderr.readline() == "port: COM3\n"
    robot.send_signal(signal.SIGTERM)
    out, _ = robot.communicate(timeout=60)
    assert robot.returncode == 0
    assert json.loads(out)["port"]["address"] == "COM3"
    assert not os.path.lexists(tmp_path / "COM3")


def test_an_output_that_nobody_reads_any_more_is_no_traceback(tmp_path: Path) -> None:
    robot = start("run", "--no-port", "--pace", "max", "--for", "1", cwd=tmp_path)
    assert robot.stdout is not None
    assert robot.stderr is not None
    robot.stdout.close()
    assert robot.stderr.read() == ""
    robot.stderr.close()
    assert robot.wait(timeout=60) == 1


@pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals and signals of POSIX")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_run_that_was_to_go_on_is_told_from_a_whole_one(number: int, tmp_path: Path) -> None:
    robot = start("run", "--link", "COM3", "--json", "--for", "1000", cwd=tmp_path)
    assert robot.stderr is not None
    assert robot.stderr.readline() == "port: COM3\n"
    robot.send_signal(number)
    out, err = robot.communicate(timeout=60)
    assert (robot.returncode, err) == (130, "hil: error: interrupted\n")
    assert json.loads(out)["interrupted"]
    assert not os.path.lexists(tmp_path / "COM3")
