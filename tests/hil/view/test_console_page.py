"""The page of a robot that is only a serial line: `serve_console` on a pseudo-terminal, in Chromium."""

from __future__ import annotations

import os
import re
import select
import signal
import struct
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from hil.client.decode import OdometryFrame
from tests.hil.view.conftest import needs_view
from tests.hil.view.test_browser import hold
from tests.hil.waiting import TIMEOUT_S, eventually

Shot = Callable[[Any, str], None]


class SerialRobot:
    """The robot's end of a pseudo-terminal: a frame each 100 ms, and what it was told."""

    def __init__(self) -> None:
        self.master, slave = os.openpty()
        import tty  # not on Windows

        tty.setraw(slave)  # or it echoes the frames back as orders until somebody opens it
        self.port = os.ttyname(slave)
        self._slave = slave
        self.heard = b""
        #: The frames so far.
        self.sent = 0
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        while not self._stop.wait(0.1):
            os.write(self.master, OdometryFrame(10 * (self.sent + 1), 0, 0, 1000, 500, 500).encode())
            self.sent += 1
            if select.select([self.master], [], [], 0)[0]:
                self.heard += os.read(self.master, 4096)

    @property
    def waiting(self) -> int:
        """How many bytes of its frames nobody has read."""
        import fcntl  # not on Windows
        import termios

        return int(struct.unpack("i", fcntl.ioctl(self._slave, termios.FIONREAD, bytes(4)))[0])

    def end(self) -> None:
        self._stop.set()
        self._thread.join()
        os.close(self._slave)
        os.close(self.master)


@pytest.fixture
def robot() -> Iterator[SerialRobot]:
    if os.name != "posix":
        pytest.skip("needs a pseudo-terminal")
    robot = SerialRobot()
    yield robot
    robot.end()


class ConsoleView:
    """`hil console --view` as a user starts it."""

    def __init__(self, port: str) -> None:
        command = [sys.executable, "-m", "hil", "console", "--view", "--view-port", "0", "--port", port]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        assert self.process.stdout is not None
        self.address = self.process.stdout.readline().split()[-1]

    def end(self) -> str:
        """Ctrl-C; the summary."""
        self.process.send_signal(signal.SIGINT)
        summary, _ = self.process.communicate(timeout=TIMEOUT_S)
        assert self.process.returncode == 0
        return summary


@pytest.fixture
def served(robot: SerialRobot) -> Iterator[ConsoleView]:
    needs_view()
    served = ConsoleView(robot.port)
    yield served
    if served.process.poll() is None:
        served.end()


def hears(robot: SerialRobot, end: bytes) -> None:
    """Wait until the last thing that the robot was told is `end`."""
    eventually(lambda: robot.heard.endswith(end), what=f"{end!r} after {robot.heard!r}")


def test_a_robot_on_a_port_is_driven_from_the_page(
    browser: Any, robot: SerialRobot, served: ConsoleView, shot: Shot
) -> None:
    page = browser.new_page(viewport={"width": 1500, "height": 950})
    page.set_default_timeout(TIMEOUT_S * 1e3)
    page.goto(served.address)
    page.get_by_text("<-  #ODO").first.wait_for()
    page.locator("path.cloud").first.wait_for(state="attached")
    page.get_by_role("button", name="MISSION").click()
    page.get_by_text("->  #MISN").first.wait_for()
    page.get_by_role("button", name="STOP").click()
    page.get_by_text("->  #STOP").first.wait_for()
    shot(page, "serial")
    assert page.get_by_role("tab").count() == 0
    page.close()
    hears(robot, b"#STOP\r")
    assert robot.heard == b"#MISN\r#STOP\r"
    assert re.fullmatch(r"\d+ frames, \d+ bytes from the robot, 18 bytes to it\n", served.end())


def test_without_a_page_frames_are_taken_in_and_the_end_stops_the_robot(
    robot: SerialRobot, served: ConsoleView
) -> None:
    before = robot.sent
    eventually(lambda: robot.sent >= before + 20 and not robot.waiting, what="its frames are not taken in")
    found = re.fullmatch(r"(\d+) frames, \d+ bytes from the robot, 6 bytes to it\n", served.end())
    assert found is not None
    assert int(found[1]) >= 19  # it may have opened the port within a frame
    hears(robot, b"#STOP\r")


def test_a_page_that_is_closed_while_driving_stops_the_robot(
    browser: Any, robot: SerialRobot, served: ConsoleView
) -> None:
    page = browser.new_page()
    page.set_default_timeout(TIMEOUT_S * 1e3)
    page.goto(served.address)
    page.get_by_text("<-  #ODO").first.wait_for()
    page.keyboard.press("t")
    page.get_by_text("->  #SETR0.0,").first.wait_for()
    hold(page, "ArrowUp", lambda: page.get_by_text("->  #SETR0.01,").count() > 0, "the arrow does nothing")
    page.close()
    hears(robot, b"#SETR0.0,0.0\r")
    assert robot.heard.startswith(b"#TELE\r")
