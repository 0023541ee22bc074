"""The console program's process, and its farewell.

The console of the thesis leaves without a word to the robot, which goes on with the last order: so when the app has
ended, however it ended, the robot is told to stop.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Final, Protocol, Self

from hil.client.orders import order
from hil.console.app import App
from hil.console.folder import RunFolder
from hil.console.needs import environment

_RUNNER: Final = Path(__file__).with_name("runner.py")
#: An app that was asked to end and does not is ended the hard way.
GRACE_S: Final = 3.0
#: Six bytes at 9600 baud take 6.25 ms; TaskORD acts on them at once.  And some room.
STOP_NS: Final = 250_000_000
#: How much of its output is shown when the app failed.
_LAST_OUTPUT: Final = 4096


class Process:
    """The app, running."""

    def __init__(self, app: App, folder: RunFolder, python: str = sys.executable) -> None:
        """Start it.  Raises OSError."""
        self.app = app
        self.output = folder.output
        self._killed_at: float | None = None
        with self.output.open("wb") as output:
            self._child = subprocess.Popen(
                [python, str(_RUNNER), str(app.path)],
                cwd=folder.path, env=environment(app), stdout=output, stderr=subprocess.STDOUT,
            )  # fmt: skip

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._child.poll() is None:
            self._child.kill()
            self._child.wait()

    @property
    def pid(self) -> int:
        """Its process."""
        return self._child.pid

    @property
    def asked_to_end(self) -> bool:
        """Whether `end` was called."""
        return self._killed_at is not None

    def end(self) -> None:
        """Ask it to end.  Safe in a signal handler."""
        if self._killed_at is None:
            self._killed_at = time.monotonic() + GRACE_S
            self._child.terminate()

    def ended(self) -> bool:
        """Whether it has ended."""
        status = self._child.poll()
        if status is None and self._killed_at is not None and time.monotonic() > self._killed_at:
            self._child.kill()
        return status is not None

    def failure(self) -> str:
        """Why it ended, if it was not by itself and with success; otherwise ""."""
        status = self._child.returncode
        if not status or self.asked_to_end:
            return ""
        how = f"was killed by signal {-status}" if status < 0 else f"ended with status {status}"
        said = _last_line(self.output)
        return f"{self.app.path.name} {how}" + (f": {said}" if said else "") + f" (its output: {self.output})"


class ByteCarrier(Protocol):
    """What carries bytes between robot and app: a `Session` of a fresh robot, or a `Tap`."""

    @property
    def elapsed_ns(self) -> int:
        """Time since it began."""

    def feed(self, data: bytes) -> None:
        """Send bytes to the robot."""

    def stop(self) -> None:
        """End soon."""


class StopWhenAppEnds:
    """After each turn: has the app ended?  Then one ``#STOP``, and the end when the robot has had time for it."""

    def __init__(self, process: Process) -> None:
        self._process = process
        self._end_ns: int | None = None

    def __call__(self, carrier: ByteCarrier) -> None:
        """A turn has passed."""
        if self._end_ns is None:
            if self._process.ended():
                carrier.feed(order("stop"))
                self._end_ns = carrier.elapsed_ns + STOP_NS
        elif carrier.elapsed_ns >= self._end_ns:
            carrier.stop()


def _last_line(output: Path) -> str:
    try:
        with output.open("rb") as file:
            file.seek(max(0, os.path.getsize(output) - _LAST_OUTPUT))
            lines = file.read().decode("utf-8", "replace").split("\n")
    except OSError:
        return ""
    return next((line.strip() for line in reversed(lines) if line.strip()), "")
