"""Writes a wire log while a line is in use.

Each piece of bytes to the robot is a record with the time at which the line got it.  Played again at these times, an
emulated robot does the same.  Bytes from the robot are gathered to frames (``...\\r``), so that a person can read them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Final, Protocol

from hil.files import GrowingFile, growing
from hil.machine import Setup
from hil.recording.log import Direction, LogWriter, Record

#: The most bytes of a record.  More bytes without the end of a frame become several records.
LONGEST_STRETCH: Final = 256
#: CHOICE: the silence that ends a record.  It is longer than the 16 ms after which USB adapters pass on their bytes.
PAUSE_NS: Final = 40_000_000


class WireListener(Protocol):
    """A listener to both directions of a line.  Times are in nanoseconds since recording began."""

    def to_robot(self, data: bytes, time_ns: int) -> None:
        """Bytes were given to the line towards the robot."""

    def from_robot(self, data: bytes, time_ns: int) -> None:
        """The robot sent bytes, the last of which ended at `time_ns`."""


class WireLog:
    """A `WireListener` that writes a log, into `file`."""

    def __init__(self, file: GrowingFile, header: Mapping[str, str]) -> None:
        self.file = file
        self._writer = LogWriter(file, header)
        self._gathered = bytearray()
        self._gathered_ns = 0
        self._last_ns = 0

    def to_robot(self, data: bytes, time_ns: int) -> None:
        """Bytes were given to the line towards the robot."""
        self._settle(time_ns)
        for start in range(0, len(data), LONGEST_STRETCH):
            self._write(Direction.TO_ROBOT, data[start : start + LONGEST_STRETCH], time_ns)

    def from_robot(self, data: bytes, time_ns: int) -> None:
        """The robot sent bytes, the last of which ended at `time_ns`."""
        self._settle(time_ns)
        for byte in data:
            self._gathered.append(byte)
            self._gathered_ns = time_ns
            if byte == 0x0D or len(self._gathered) >= LONGEST_STRETCH:
                self._close_stretch()

    def end(self, time_ns: int) -> None:
        """Recording ends."""
        self._close_stretch()
        self._writer.end(max(time_ns, self._last_ns))

    def _settle(self, time_ns: int) -> None:
        if self._gathered and time_ns - self._gathered_ns >= PAUSE_NS:
            self._close_stretch()

    def _close_stretch(self) -> None:
        if self._gathered:
            self._write(Direction.FROM_ROBOT, bytes(self._gathered), self._gathered_ns)
            self._gathered.clear()

    def _write(self, direction: Direction, data: bytes, time_ns: int) -> None:
        self._last_ns = max(self._last_ns, time_ns)
        self._writer.write(Record(time_ns, direction, data))


def header_of(setup: Setup) -> dict[str, str]:
    """The header of a log of the emulated robot.  It determines the run, so that it can run again."""
    return {"clock": "virtual", "setup": json.dumps(setup.as_dict(), sort_keys=True), "began": _now()}


def header_at(port: str) -> dict[str, str]:
    """The header of a log of a robot behind a port."""
    return {"clock": "real", "port": port, "began": _now()}


def _now() -> str:
    return datetime.now().astimezone().isoformat(timespec="seconds")


@contextmanager
def record(path: Path, header: Mapping[str, str]) -> Iterator[WireLog]:
    """Create a log.  Raises OSError at once if it cannot be opened, and at the end if not everything was written."""
    with growing(path, "ascii") as file:
        yield WireLog(file, header)
