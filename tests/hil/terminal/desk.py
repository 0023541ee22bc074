"""What the tests of the terminal's console share: a robot that is only the far end of a line, and the screen's text."""

from __future__ import annotations

import asyncio
import os
import select
import time
import tty
from collections.abc import Callable
from typing import Any

from textual.pilot import Pilot

from hil.terminal.app import TerminalApp
from tests.hil.waiting import TIMEOUT_S


class FarEnd:
    """The robot's side of a raw pseudo-terminal."""

    def __init__(self) -> None:
        self.master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self.master, False)
        self.port = os.ttyname(self._slave)
        self._heard = bytearray()
        self._closed = False

    @property
    def heard(self) -> bytes:
        """Everything that was sent to the robot."""
        while not self._closed and select.select([self.master], [], [], 0)[0]:
            try:
                data = os.read(self.master, 65536)
            except (BlockingIOError, OSError):
                break
            self._heard += data
        return bytes(self._heard)

    def say(self, data: bytes) -> int:
        """As much as the line takes now."""
        try:
            return os.write(self.master, data)
        except BlockingIOError:
            return 0

    def close(self) -> None:
        if not self._closed:
            self._closed = True
            os.close(self._slave)
            os.close(self.master)


async def becomes(pilot: Pilot[Any], condition: Callable[[], bool]) -> None:
    """`tests.hil.waiting.eventually` while an app runs."""
    limit = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < limit, "it did not happen:\n" + "\n".join(screen(pilot.app))
        await pilot.pause(0.02)


def screen(app: Any) -> list[str]:
    """The lines on the screen."""
    return ["".join(segment.text for segment in strip).rstrip() for strip in app.screen._compositor.render_strips()]


def play(app: TerminalApp, scene: Callable[[Pilot[None]], Any], *, size: tuple[int, int] = (80, 24)) -> None:
    """Run an app without a terminal while `scene` presses its keys."""

    async def run() -> None:
        async with app.run_test(size=size) as pilot:
            await scene(pilot)

    asyncio.run(run())
