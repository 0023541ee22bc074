"""`hil console --app` without windows: the port, the folder, the farewell, what goes wrong."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from hil.recording.log import Direction, read_log
from tests.hil.cli.test_run import HIL
from tests.hil.scripted_machine import numbered_frame
from tests.hil.waiting import TIMEOUT_S, eventually

REPOSITORY = Path(__file__).parents[3]
APP = Path(__file__).with_name("headless_console.py")
ORDERS = b"#TELE\r#SETR0.1,0.0\r"

pytestmark = pytest.mark.skipif(os.name != "posix", reason="--app is for Linux and macOS")


#: The command with a robot whose firmware ends a second and a half after start-up.
ENDING = """
import hil.cli.show as show
from hil.__main__ import main
from hil.machine import FirmwareStopped
from tests.hil.scripted_machine import BOOT_CYCLES, ScriptedMachine

class Ending(ScriptedMachine):
    def run_until(self, cycles):
        super().run_until(cycles)
        if self.clock.now > BOOT_CYCLES + 300_000_000:
            raise FirmwareStopped("a poll that nothing can end")

show.open_machine = Ending
main()
"""


@contextmanager
def hil(*arguments: str, cwd: Path, code: str = HIL, **environment: str) -> Iterator[subprocess.Popen[str]]:
    """The command with a scripted robot; ended at the end whatever happens."""
    process = subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        cwd=cwd, env={**os.environ, "PYTHONPATH": str(REPOSITORY), **environment},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        yield process
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
            process.communicate(timeout=TIMEOUT_S)


def app_says(folder: Path, what: str) -> None:
    output = folder / "output.txt"
    eventually(
        lambda: output.exists() and f"{what}\n" in output.read_text("utf-8"), what=f"{what!r} in the app's output"
    )


def app_pid(process: subprocess.Popen[str]) -> int:
    assert process.stdout is not None
    match = re.search(r"process (\d+)", process.stdout.readline())
    assert match
    return int(match[1])


def test_bytes_pass_whole_and_the_robot_is_stopped_at_the_end(tmp_path: Path) -> None:
    with hil(
        "console", "--app", str(APP), "--dir", "run", "--wire", "w.log", "--json", cwd=tmp_path, DEED="end", LC_ALL="C"
    ) as process:
        out, err = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 0, err
    recording, summary = read_log(tmp_path / "w.log"), json.loads(out)
    assert recording.problems == []
    assert recording.stream(Direction.TO_ROBOT) == ORDERS + b"#STOP\r"
    assert recording.header["clock"] == "virtual"
    assert summary["bytes_to_robot"] == len(ORDERS) + len(b"#STOP\r")
    assert summary["failure"] == ""
    received = (tmp_path / "run" / "received.bin").read_bytes()
    first = int(re.findall(rb"#ODO (\d+),", received)[0])
    assert received == b"".join(numbered_frame(first + n).encode() for n in range(3))
    assert received in recording.stream(Direction.FROM_ROBOT)
    text = (tmp_path / "run" / "output.txt").read_text("utf-8")
    assert "kbhit True True\n" in text
    assert "msvcrt hidden True\n" in text
    assert "as python runs it __main__ headless_console.py True True\n" in text
    assert sorted(path.name for path in (tmp_path / "run").iterdir()) == ["D:", "output.txt", "received.bin"]


def test_an_app_that_fails_is_one_line_with_its_last_words_and_the_robot_is_stopped(tmp_path: Path) -> None:
    with hil("console", "--app", str(APP), "--wire", "w.log", cwd=tmp_path, DEED="fail") as process:
        _, err = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 1
    assert err.startswith("hil: error: headless_console.py ended with status 1: RuntimeError: no battery (its output: ")
    assert err.count("\n") == 1
    assert read_log(tmp_path / "w.log").stream(Direction.TO_ROBOT) == ORDERS + b"#STOP\r"


def test_a_killed_app_is_said_and_the_robot_is_stopped(tmp_path: Path) -> None:
    with hil("console", "--app", str(APP), "--wire", "w.log", cwd=tmp_path, DEED="stay") as process:
        pid = app_pid(process)
        app_says(tmp_path / "console-run", "ready")
        os.kill(pid, signal.SIGKILL)
        _, err = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 1
    assert "was killed by signal 9" in err
    assert read_log(tmp_path / "w.log").stream(Direction.TO_ROBOT) == ORDERS + b"#STOP\r"


@pytest.mark.parametrize("deed", ["stay", "stubborn"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_the_app_and_stops_the_robot(tmp_path: Path, deed: str, number: signal.Signals) -> None:
    with hil("console", "--app", str(APP), "--wire", "w.log", cwd=tmp_path, DEED=deed) as process:
        pid = app_pid(process)
        app_says(tmp_path / "console-run", "ready" if deed == "stay" else deed)
        process.send_signal(number)
        _, err = process.communicate(timeout=TIMEOUT_S)
    assert (process.returncode, err) == (0, "")
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
    recording = read_log(tmp_path / "w.log")
    assert recording.problems == []
    assert recording.stream(Direction.TO_ROBOT) == ORDERS + b"#STOP\r"


@pytest.mark.parametrize("line", ["--link ROBOT", "--listen tcp://127.0.0.1:0", "--listen rfc2217://127.0.0.1:0"])
def test_a_robot_that_runs_already_is_reached_through_its_port(tmp_path: Path, line: str) -> None:
    with hil("run", *line.split(), "--json", cwd=tmp_path) as robot:
        assert robot.stderr is not None
        address = robot.stderr.readline().removeprefix("port: ").strip()
        with hil(
            "console", "--app", str(APP), "--port", address, "--wire", "w.log", cwd=tmp_path, DEED="end"
        ) as process:
            _, err = process.communicate(timeout=TIMEOUT_S)
        assert process.returncode == 0, err
        robot.send_signal(signal.SIGTERM)
        out, _ = robot.communicate(timeout=TIMEOUT_S)
    recording = read_log(tmp_path / "w.log")
    assert recording.header["clock"] == "real"
    assert recording.header["port"] == address
    assert recording.stream(Direction.TO_ROBOT) == ORDERS + b"#STOP\r"
    assert json.loads(out)["bytes_to_robot"] == len(ORDERS + b"#STOP\r")
    received = (tmp_path / "console-run" / "received.bin").read_bytes()
    assert received in recording.stream(Direction.FROM_ROBOT)
    assert received.count(b"\r") == 3


def test_firmware_that_stops_ends_the_app_and_is_one_line(tmp_path: Path) -> None:
    with hil("console", "--app", str(APP), "--wire", "w.log", cwd=tmp_path, code=ENDING, DEED="stay") as process:
        pid = app_pid(process)
        _, err = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 1
    assert err == "hil: error: the firmware stopped: a poll that nothing can end\n"
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
    assert read_log(tmp_path / "w.log").problems == []


def test_two_consoles_in_one_folder_are_refused_in_one_line(tmp_path: Path) -> None:
    with hil("console", "--app", str(APP), cwd=tmp_path, DEED="stay") as process:
        app_says(tmp_path / "console-run", "ready")
        with hil("console", "--app", str(APP), cwd=tmp_path, DEED="end") as second:
            _, err = second.communicate(timeout=TIMEOUT_S)
        assert second.returncode == 2
        assert "COM3: is the port of a robot that is running" in err
        assert err.count("\n") == 1
        assert process.poll() is None
