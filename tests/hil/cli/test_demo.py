"""`hil demo`, by each of its ways, and what `hil run` says to do next."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import urllib.request
import webbrowser
from importlib.util import find_spec
from pathlib import Path

import pytest

from hil.cli import demo as DEMO
from hil.cli import invoke, show
from hil.cli import run as RUN
from hil.machine import Setup
from hil.terminal.app import TerminalApp
from hil.terminal.robot import EmulatedRobot
from tests.hil.scripted_machine import ScriptedMachine
from tests.hil.waiting import TIMEOUT_S

REPOSITORY = Path(__file__).parents[3]


def test_without_browser_and_terminal_it_draws_a_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(DEMO, "has", lambda package: package == "matplotlib")
    monkeypatch.setattr(DEMO, "PICTURE_S", 4.0)
    assert invoke(["demo"]) == 0
    assert (tmp_path / "demo.png").read_bytes().startswith(b"\x89PNG")
    said = capsys.readouterr().out
    assert "drawn into demo.png" in said
    assert "6 bytes to it" in said  # the order


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")
def test_in_the_terminal_the_robot_is_told_to_drive_as_soon_as_it_is_there() -> None:
    from tests.hil.terminal.desk import becomes, play, screen

    robot = EmulatedRobot(Setup(world="corridor"), machine=ScriptedMachine, pace=4.0)
    app = TerminalApp(None, robot, ("mission",))

    async def scene(pilot: object) -> None:
        await becomes(pilot, lambda: any("> #MISN" in line for line in screen(app)))  # type: ignore[arg-type]

    try:
        play(app, scene)
        assert app.link is not None
        assert app.link.traffic.orders == 1
    finally:
        if app.link is not None:
            app.link.close()
        robot.end()


@pytest.mark.skipif(find_spec("nicegui") is None, reason="needs the extra view: pip install 'c2000-hil[view]'")
def test_in_the_browser_it_drives_until_ctrl_c() -> None:
    with subprocess.Popen(
        [sys.executable, "-m", "hil", "demo", "--no-open"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": str(REPOSITORY)},
    ) as process:  # fmt: skip
        assert process.stdout is not None
        address = process.stdout.readline().rpartition(" ")[2].strip()
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/", address)
        with urllib.request.urlopen(address, timeout=TIMEOUT_S) as page:
            assert page.status == 200
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=TIMEOUT_S)
    assert (process.returncode, "Traceback" in err) == (0, False), err
    assert out.splitlines()[-1].startswith("virtual time ")


def test_the_browser_is_opened_where_there_is_a_desktop(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    threads: list[str] = []

    class Now:
        """A thread that is done as soon as it begins."""

        def __init__(self, target: object, args: tuple[str], daemon: bool) -> None:
            self.begin = lambda: target(*args)  # type: ignore[operator]

        def start(self) -> None:
            threads.append("began")
            self.begin()

    monkeypatch.setattr("threading.Thread", Now)
    show.print_and_open("view: http://127.0.0.1:8080/")
    show.print_and_open("the robot stopped")
    assert opened == ["http://127.0.0.1:8080/"]
    assert capsys.readouterr().out == "view: http://127.0.0.1:8080/\nthe robot stopped\n"

    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    for display, terminal, wanted in ((":0", True, True), (":0", False, False), ("", True, False)):
        monkeypatch.setenv("DISPLAY", display)
        monkeypatch.setattr(sys.stdout, "isatty", lambda terminal=terminal: terminal, raising=False)
        assert show.wants_page(None) is wanted
    assert show.wants_page(True)
    assert not show.wants_page(False)


def test_hil_run_says_what_to_do_with_its_port(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-m", "hil", "run", "--pace", "max", "--link", "ROBOT"], cwd=tmp_path,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": str(REPOSITORY)},
    ) as process:  # fmt: skip
        assert process.stdout is not None
        assert process.stdout.readline().startswith("port: ")
        told = [process.stdout.readline() for _ in RUN.NEXT]
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=TIMEOUT_S)
    assert "virtual time" in out
    assert all("{port}" not in line for line in told)
    # What it says can be done: the commands are understood.
    for line in told[:3]:
        words = line.split("   ")[0].split()
        assert words[0] == "hil"
        assert invoke([words[1], "--help"]) == 0
        told_of = capsys.readouterr().out
        assert all(word in told_of for word in words if word.startswith("--"))
