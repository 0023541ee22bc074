"""The process of the console program, and the stop of the robot after its end.

The console of the thesis ends without an order to the robot, which continues with the last order.  So when the app has
ended, for whatever reason, the robot gets a stop.
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
#: If the app has not ended this time after it was asked to, it is killed.
GRACE_S: Final = 3.0
#: The time for a stop: six bytes at 9600 baud take 6.25 ms, and TaskORD obeys at once.  The rest is a reserve.
STOP_NS: Final = 250_000_000
#: The number of characters of its output that are shown when the app failed.
_LAST_OUTPUT: Final = 4096


class Process:
    """The running app."""

    def __init__(self, app: App, folder: RunFolder, python: str = sys.executable) -> None:
        """Start the app.  Raises OSError."""
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
        """The identifier of its process."""
        return self._child.pid

    @property
    def asked_to_end(self) -> bool:
        """Whether `end` was called."""
        return self._killed_at is not None

    def end(self) -> None:
        """Ask the app to end.  Safe in a signal handler."""
        if self._killed_at is None:
            self._killed_at = time.monotonic() + GRACE_S
            self._child.terminate()

    def ended(self) -> bool:
        """Whether the app has ended."""
        status = self._child.poll()
        if status is None and self._killed_at is not None and time.monotonic() > self._killed_at:
            self._child.kill()
        return status is not None

    def failure(self) -> str:
        """Why the app failed; "" if it ended by itself and with success, or because `end` was called."""
        status = self._child.returncode
        if not status or self.asked_to_end:
            return ""
        how = f"was killed by signal {-status}" if status < 0 else f"ended with status {status}"
        last_line = _last_line(self.output)
        return f"{self.app.path.name} {how}" + (f": {last_line}" if last_line else "") + f" (its output: {self.output})"


class ByteCarrier(Protocol):
    """The connection between robot and app: a `Session` of an emulated robot, or a `Tap`."""

    @property
    def elapsed_ns(self) -> int:
        """The time since it began, in nanoseconds."""

    def feed(self, data: bytes) -> None:
        """Send bytes to the robot."""

    def stop(self) -> None:
        """End the connection after the present turn."""


class StopWhenAppEnds:
    """Checks after each turn whether the app has ended.  Then it sends ``#STOP``, waits for the robot, and ends."""

    def __init__(self, process: Process) -> None:
        self._process = process
        self._end_ns: int | None = None

    def __call__(self, carrier: ByteCarrier) -> None:
        """Check the app.  It is called after each turn."""
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
