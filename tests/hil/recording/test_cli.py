"""``hil record``, ``hil replay``, ``hil compare`` around a scripted robot."""

from __future__ import annotations

import json
import os
import re
import signal
from pathlib import Path

import pytest
import serial

from hil.cli import invoke, show
from hil.client.decode import FrameDecoder
from hil.recording.log import Direction, read_log
from tests.hil.cli.test_run import start
from tests.hil.scripted_machine import ScriptedMachine
from tests.hil.waiting import eventually

POSIX = pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals are a POSIX thing")


@pytest.fixture(autouse=True)
def scripted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(show, "open_machine", ScriptedMachine)
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def log(capsys: pytest.CaptureFixture[str]) -> Path:
    """Three seconds of the scripted robot."""
    arguments = ["run", "--no-port", "--pace", "max", "--for", "3", "--order", "1:MISN", "--wire", "run.wire"]
    assert invoke(arguments) == 0
    capsys.readouterr()
    return Path("run.wire")


@POSIX
def test_a_tap_records_what_a_console_and_a_robot_say(tmp_path: Path) -> None:
    robot = start("run", "--link", "ROBOT", cwd=tmp_path)
    assert robot.stdout is not None
    assert robot.stdout.readline() == "port: ROBOT\n"
    tap = start("record", "ROBOT", "--link", "COM3", "-o", "tap.wire", "--json", cwd=tmp_path)
    assert tap.stderr is not None
    assert tap.stderr.readline() == "port: COM3\n"
    decoder = FrameDecoder()
    with serial.Serial("COM3", 9600, timeout=0.1) as line:
        line.write(b"#MISN\r")
        eventually(lambda: decoder.frames >= 4, lambda: decoder.feed(line.read(64)))
    tap.send_signal(signal.SIGINT)
    out, err = tap.communicate(timeout=20)
    robot.send_signal(signal.SIGTERM)
    robot.communicate(timeout=20)
    assert (tap.returncode, err) == (0, "")
    summary = json.loads(out)
    recording = read_log(tmp_path / "tap.wire")
    assert recording.problems == []
    assert recording.header["port"] == "ROBOT"
    assert recording.stream(Direction.TO_ROBOT) == b"#MISN\r"
    assert summary["bytes_from_robot"] == len(recording.stream(Direction.FROM_ROBOT))
    assert decoder.malformed == 0
    assert recording.stream(Direction.FROM_ROBOT).count(b"\r") >= 4


@POSIX
def test_a_robot_that_is_switched_off_ends_a_recording_with_its_summary(tmp_path: Path) -> None:
    robot = start("run", "--link", "ROBOT", cwd=tmp_path)
    assert robot.stdout is not None
    assert robot.stdout.readline() == "port: ROBOT\n"
    tap = start("record", "ROBOT", "--link", "COM3", "-o", "tap.wire", cwd=tmp_path)
    assert tap.stdout is not None
    assert tap.stdout.readline() == "port: COM3\n"
    with serial.Serial("COM3", 9600, timeout=0.1) as line:
        line.write(b"#MISN\r")
        eventually(lambda: line.read(64))
        robot.send_signal(signal.SIGTERM)
        robot.communicate(timeout=20)
        out, err = tap.communicate(timeout=20)
    assert tap.returncode == 2
    assert err.startswith("hil: error: ROBOT: the port has gone away")
    assert err.count("\n") == 1
    recording = read_log(tmp_path / "tap.wire")
    assert recording.problems == []
    assert f" s: {len(recording.stream(Direction.FROM_ROBOT))} bytes from the robot " in out
    assert ", 6 to it, in tap.wire" in out


def test_a_replay_says_that_the_bytes_are_equal(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["replay", str(log), "-o", "again.wire"]) == 0
    out, err = capsys.readouterr()
    # Frames begin every 0.25 s after start-up: eleven have ended after 3 s.
    assert out.splitlines()[-1].startswith("byte-equal: 11 frames, ")
    # The table of findings that every command has.
    assert out.startswith("1 warning\n")
    assert "unwritten-read" in out
    assert err == ""
    again = read_log(Path("again.wire"))
    assert again.records == read_log(log).records
    assert again.end_ns == 3_000_000_000


def test_a_replay_that_differs_exits_1_and_shows_the_first_difference(
    log: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log.write_bytes(log.read_bytes().replace(b"#ODO 5,-2", b"#ODO 5,-3"))
    assert invoke(["replay", str(log)]) == 1
    out, err = capsys.readouterr()
    assert "frame 4 is the first that differs" in out
    assert "#ODO 5,-3" in out
    assert "#ODO 5,-2" in out
    assert err == "hil: run.wire: was changed since it was recorded (the checksum at its end does not match)\n"
    assert invoke(["replay", str(log), "--json"]) == 1
    result = json.loads(capsys.readouterr().out)
    assert (result["equal"], result["first_difference"]) == (False, 4)
    assert result["problems"]


def test_a_log_that_does_not_say_which_robot_is_played_against_the_standard_one(
    log: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log.write_bytes(re.sub(rb"setup .*\n", b"", log.read_bytes()))
    assert invoke(["replay", str(log), "--seed", "4", "--json"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out)["setup"]["seed"] == 4
    assert "does not name its robot; using the standard one" in err


@POSIX
def test_frames_are_played_to_a_console(log: Path, tmp_path: Path) -> None:
    player = start("replay", str(log), "--to-console", "--link", "COM3", "--wait", cwd=tmp_path)
    assert player.stdout is not None
    assert player.stdout.readline() == "port: COM3\n"
    decoder = FrameDecoder()
    frames = []
    with serial.Serial("COM3", 9600, timeout=0.1) as line:
        line.write(b"#STOP\r")
        eventually(lambda: decoder.frames >= 11, lambda: frames.extend(decoder.feed(line.read(64))))
    out, err = player.communicate(timeout=20)
    assert (player.returncode, err) == (0, "")
    assert out == "11 frames played, 6 bytes from the console\n"
    assert [frame.x_mm for frame in frames] == list(range(1, 12))


@POSIX
def test_a_device_that_goes_away_ends_the_playing_with_its_summary(log: Path, tmp_path: Path) -> None:
    master, slave = os.openpty()
    arguments = ("replay", str(log), "--to-console", "--port", os.ttyname(slave), "-o", "played.wire")
    player = start(*arguments, cwd=tmp_path)
    assert os.read(master, 100)
    os.close(slave)
    os.close(master)
    out, err = player.communicate(timeout=20)
    assert player.returncode == 2
    assert "the port has gone away" in err
    assert err.count("\n") == 1
    assert re.search(r"^[1-9]\d* frames played, 0 bytes from the console$", out, re.MULTILINE)
    played = read_log(tmp_path / "played.wire")
    assert played.problems == []
    assert 0 < played.duration_ns < read_log(log).duration_ns


def test_a_comparison_is_a_table_a_picture_and_json(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("other.wire").write_bytes(log.read_bytes().replace(b"#ODO 5,-2", b"#ODO 9,-2"))
    assert invoke(["compare", str(log), "other.wire", "--plot", "picture.png"]) == 0
    out, err = capsys.readouterr()
    assert "other.wire: was changed" in err
    assert "aligned by the first #MISN: 11 pairs of frames, 0 only in run.wire, 0 only in other.wire" in out
    assert re.search(r"x \(mm\) .* 4\.00 ", out)
    assert Path("picture.png").stat().st_size > 10_000
    assert invoke(["compare", str(log), "other.wire", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    # Frame 5 of 11 is off by 4 mm; it ended 0.25 s after the mission began at 1 s, and some byte times.
    assert result["differences"]["x"]["largest"] == 4
    assert result["differences"]["x"]["mean"] == pytest.approx(4 / 11)
    assert 0.25 < result["differences"]["x"]["at_s"] < 0.3
    assert result["pairs"] == 11


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["replay", "nothing.wire"], "nothing.wire: No such file"),
        (["replay", "noise"], "noise: not a wire log"),
        (["replay", "."], "not a plain file"),
        (["replay", "bare.wire", "--link", "COM3"], "belong to --to-console"),
        (["replay", "strange.wire"], "its setup has 'colour'"),
        (["compare", "noise", "noise"], "noise: not a wire log"),
        (["compare", "bare.wire", "bare.wire"], "bare.wire: has no frames"),
        (["compare", "bare.wire", "bare.wire", "--plot", "x.doc"], "x.doc"),
        (["record", "/dev/nothing", "-o", "x.wire"], "cannot open the serial port /dev/nothing"),
        (["record", "/dev/nothing", "-o", "x.wire", "--link", "A", "--to", "B"], "cannot open"),
        (["record", "/dev/nothing"], "output"),
        (["run", "--no-port", "--for", "1", "--wire", "no/folder/x.wire"], "no/folder/x.wire"),
    ],
)
def test_wrong_input_is_one_line(arguments: list[str], complaint: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("noise").write_bytes(b"\x00\xff\n" * 9)
    Path("bare.wire").write_bytes(b"hil-wire 1\n")
    Path("strange.wire").write_bytes(b'hil-wire 1\nsetup {"colour": 1}\nend 0 00000000\n')
    assert invoke(arguments) == 2
    last = capsys.readouterr().err.strip().split("\n")[-1]
    assert last.startswith("hil: error: ")
    assert complaint in last
