"""The page of a robot that is only a serial line: `serve_console` on a pseudo-terminal, in Chromium."""

from __future__ import annotations

import os
import select
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from hil.client.decode import OdometryFrame
from tests.hil.view.conftest import needs_view

Shot = Callable[[Any, str], None]
SERVE = (
    "import sys; from hil.view.server import serve_console; "
    "serve_console(sys.argv[1], port=0, say=lambda text: print(text, flush=True))"
)


class SerialRobot:
    """The robot's end of a pseudo-terminal: a frame each 100 ms, and what it was told."""

    def __init__(self) -> None:
        self.master, slave = os.openpty()
        import tty  # not on Windows

        tty.setraw(slave)  # or it echoes the frames back as orders until somebody opens it
        self.port = os.ttyname(slave)
        self._slave = slave
        self.heard = b""
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        number = 0
        while not self._stop.wait(0.1):
            number += 1
            os.write(self.master, OdometryFrame(10 * number, 0, 0, 1000, 500, 500).encode())
            if select.select([self.master], [], [], 0)[0]:
                self.heard += os.read(self.master, 4096)

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


def test_a_robot_on_a_port_is_driven_from_the_page(browser: Any, robot: SerialRobot, shot: Shot) -> None:
    needs_view()
    with subprocess.Popen([sys.executable, "-c", SERVE, robot.port], stdout=subprocess.PIPE, text=True) as server:
        try:
            assert server.stdout is not None
            page = browser.new_page(viewport={"width": 1500, "height": 950})
            page.goto(server.stdout.readline().split()[-1])
            page.get_by_text("<-  #ODO").first.wait_for(timeout=60_000)
            page.locator("path.cloud").first.wait_for(state="attached")
            page.get_by_role("button", name="MISSION").click()
            page.get_by_text("->  #MISN").first.wait_for()
            page.get_by_role("button", name="STOP").click()
            page.get_by_text("->  #STOP").first.wait_for()
            shot(page, "serial")
            assert page.get_by_role("tab").count() == 0
            page.close()
            for _ in range(100):
                if robot.heard == b"#MISN\r#STOP\r":
                    break
                threading.Event().wait(0.1)
            assert robot.heard == b"#MISN\r#STOP\r"
        finally:
            server.terminate()
