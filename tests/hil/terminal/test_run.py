"""The whole program in a pseudo-terminal of its own: what a person at a shell sees, and what the robot hears."""

from __future__ import annotations

import fcntl
import io
import os
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pyte
import pytest

from hil.machine import Setup
from hil.terminal.run import run_terminal
from tests.hil.terminal.desk import FarEnd
from tests.hil.waiting import TIMEOUT_S, rest

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")

COLUMNS, ROWS = 80, 24
#: Makes its standard input the terminal that hangs up on it, as a shell's is.
PROGRAM = """
import fcntl, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
from hil.machine import Setup
from hil.terminal.run import run_terminal
port, world = sys.argv[1:]
print(run_terminal(port or None, None if port else Setup(world=world, seed=1), pace=4.0).line)
"""
#: Colours that are legible on the terminal's own background, dark or light (blue is the scroll bar's).
READABLE = {(colour, "default") for colour in ("default", "red", "magenta", "blue")}
LEAVES_ALTERNATE_SCREEN = b"\x1b[?1049l"
SHOWS_CURSOR = b"\x1b[?25h"


class Terminal:
    """An 80 x 24 terminal with the program in it."""

    def __init__(self, port: str, world: str) -> None:
        self.master, slave = os.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        self.attributes = termios.tcgetattr(slave)
        self.raw = bytearray()
        self._screen = pyte.Screen(COLUMNS, ROWS)
        self._stream = pyte.ByteStream(self._screen)
        self.process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM, port, world], stdin=slave, stdout=slave, stderr=slave,
            start_new_session=True, env={**os.environ, "TERM": "xterm-256color"},
        )  # fmt: skip
        # Kept, so that the terminal's attributes can be looked at after the program has left.
        self.slave = slave

    @property
    def text(self) -> str:
        """The screen now."""
        self._read()
        return "\n".join(self._screen.display)

    @property
    def colours(self) -> set[tuple[str, str]]:
        """Foreground and background of everything on the screen."""
        self._read()
        return {(cell.fg, cell.bg) for line in self._screen.buffer.values() for cell in line.values()}

    def press(self, keys: bytes) -> None:
        os.write(self.master, keys)

    def until(self, condition: Callable[[str], object]) -> None:
        limit = time.monotonic() + TIMEOUT_S
        while not condition(self.text):
            assert time.monotonic() < limit, f"it did not happen:\n{self.text}"
            assert self.process.poll() is None, f"it ended:\n{self.text}"
            rest()

    def ended(self) -> int:
        """Wait for the program and give its status."""
        limit = time.monotonic() + TIMEOUT_S
        while self.process.poll() is None:
            assert time.monotonic() < limit, "it does not end"
            if self.master >= 0:
                self._read()
            rest()
        if self.master >= 0:
            self._read()
        return self.process.returncode

    def hang_up(self) -> None:
        """The connection is gone."""
        os.close(self.slave)
        os.close(self.master)
        self.master = self.slave = -1

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        if self.master >= 0:
            self.hang_up()

    def _read(self) -> None:
        while select.select([self.master], [], [], 0)[0]:
            data = os.read(self.master, 65536)
            self.raw += data
            self._stream.feed(data)


@contextmanager
def console(port: str = "", world: str = "corridor") -> Iterator[Terminal]:
    terminal = Terminal(port, world)
    try:
        yield terminal
    finally:
        terminal.close()


def robots_x_m(text: str) -> float:
    match = re.search(r"x (-?\d+\.\d{3})  y", text)
    return float(match[1]) if match else 0.0


def dots(text: str) -> int:
    return sum(0x2800 < ord(letter) <= 0x28FF for letter in text)


def last_frames(text: str) -> list[str]:
    return re.findall(r"#ODO (\S+)", text)


def test_an_emulated_robot_drives_a_mission_and_stops() -> None:
    with console() as terminal:
        terminal.until(lambda text: "connected" in text and "findings" in text)
        # The first line keeps the order; in the list of frames it may have gone before anybody looked.
        terminal.press(b"m")
        terminal.until(lambda text: "| mission |" in text)
        terminal.until(lambda text: robots_x_m(text) > 0.3)
        # Both walls of the corridor and the way itself.
        assert dots(terminal.text) > 15
        assert re.search("[→↗↘]", terminal.text)
        assert ("red", "default") in terminal.colours <= READABLE
        terminal.press(b" ")
        terminal.until(lambda text: "| stop |" in text)
        # It rolls out; then the odometry of a whole list of frames is one place (X, Y).
        terminal.until(
            lambda text: "#STOP" not in text and len({tuple(line.split(",")[:2]) for line in last_frames(text)}) == 1
        )
        assert robots_x_m(terminal.text) > 0.3
        # Arrows, as a terminal sends them.
        x_m = robots_x_m(terminal.text)
        terminal.press(b"t")
        terminal.until(lambda text: "tele V" in text)
        terminal.press(b"\x1b[A")
        terminal.until(lambda text: "tele V 0.01" in text)
        for step in range(2, 11):
            terminal.press(b"\x1b[A")
            terminal.until(lambda text, step=step: f"tele V {step / 100:.2f}" in text)
        terminal.until(lambda text: robots_x_m(text) > x_m + 0.05)
        # Nobody presses anything any more.
        terminal.until(lambda text: "tele V 0.00" in text)
        terminal.press(b"l\r")
        terminal.until(lambda text: "call path" in text)
        assert terminal.colours <= READABLE
        terminal.press(b"\x1b")
        terminal.until(lambda text: "call path" not in text)
        terminal.press(b"q")
        assert terminal.ended() == 0
        raw = bytes(terminal.raw)
        assert LEAVES_ALTERNATE_SCREEN in raw
        assert SHOWS_CURSOR in raw
        assert termios.tcgetattr(terminal.slave) == terminal.attributes
        summary = raw.rsplit(LEAVES_ALTERNATE_SCREEN, 1)[1].decode()
        assert re.search(
            r"\d+\.\d s: \d+ frames, 0 malformed, 4 orders and \d+ SETR sent, \d+ findings; robot stopped\r\n", summary
        )
        assert "Traceback" not in summary


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_stops_the_robot_and_gives_the_terminal_back(number: int) -> None:
    robot = FarEnd()
    try:
        with console(robot.port) as terminal:
            terminal.until(lambda text: "robot silent" in text)
            terminal.press(b"m")
            terminal.until(lambda text: "> #MISN" in text)
            terminal.process.send_signal(number)
            assert terminal.ended() == 0
            assert robot.heard == b"#MISN\r#STOP\r"
            assert LEAVES_ALTERNATE_SCREEN in terminal.raw
            assert termios.tcgetattr(terminal.slave) == terminal.attributes
    finally:
        robot.close()


def test_a_terminal_that_is_gone_stops_the_robot() -> None:
    robot = FarEnd()
    try:
        with console(robot.port) as terminal:
            terminal.until(lambda text: "robot silent" in text)
            terminal.press(b"m")
            terminal.until(lambda text: "> #MISN" in text)
            terminal.hang_up()
            terminal.ended()
            assert robot.heard == b"#MISN\r#STOP\r"
    finally:
        robot.close()


def test_ctrl_c_in_the_terminal_stops_the_robot() -> None:
    robot = FarEnd()
    try:
        with console(robot.port) as terminal:
            terminal.until(lambda text: "robot silent" in text)
            terminal.press(b"\x03")
            assert terminal.ended() == 0
            assert robot.heard == b"#STOP\r"
    finally:
        robot.close()


def test_a_world_that_does_not_exist_gives_the_terminal_back_and_says_so() -> None:
    with console(world="moon") as terminal:
        assert terminal.ended() == 1
        said = bytes(terminal.raw).rsplit(LEAVES_ALTERNATE_SCREEN, 1)[1].decode()
        # The command line makes one line of it; this program shows the exception.
        assert re.search(r"Error: moon: no built-in map[^\n]*\r\n$", said)
        assert termios.tcgetattr(terminal.slave) == terminal.attributes


def test_without_a_terminal_it_says_what_to_use(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO())
    with pytest.raises(ValueError, match="needs a terminal; without one: hil drive"):
        run_terminal(None, Setup())
