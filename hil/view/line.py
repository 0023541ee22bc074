"""The serial line as a console sees it: bytes out, bytes in, and the frames that they form.

`RobotLine` is all that the console panel knows of a robot.  `EngineLine` is that of the emulated robot,
`SerialPortLine` a port of this computer: a USB adapter with the real robot, or any pyserial URL.
"""

from __future__ import annotations

import threading
import time
from array import array
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from itertools import takewhile
from typing import Final, Protocol

import serial

from hil.client.decode import FrameDecoder, OdometryFrame
from hil.client.orders import order
from hil.serial_url import gone, open_url

#: A port that takes no byte for so long is not being read.
WRITE_TIMEOUT_S: Final = 0.5
#: CHOICE: the points of at least 3 hours are kept, and the text of 2 minutes.
MAX_FRAMES: Final = 45_000
MAX_ENTRIES: Final = 500
#: What ends an entry of the log: of the robot, whose frames end in line feed and carriage return, and of any board.
FRAME_END: Final = b"\r"
LINE_ENDS: Final = b"\r\n"


@dataclass(frozen=True, slots=True)
class LogEntry:
    """A line of the log: a frame or an order, with its time in seconds."""

    number: int
    time_s: float
    text: str
    to_robot: bool


class LineLog:
    """The frames and bytes that passed, for readers in other threads.  Numbers only grow; `epoch` changes at `clear`.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._entries: deque[LogEntry] = deque(maxlen=MAX_ENTRIES)
        #: Six numbers a frame.
        self._frames = array("h")
        self._decoder = FrameDecoder()
        self._pending = bytearray()
        #: Bytes that end an entry.
        self.ends = FRAME_END
        self.epoch = 0
        self.count = 0
        self.frame_count = 0
        self.bytes_from_robot = 0
        self.bytes_to_robot = 0
        self.malformed = 0

    def received(self, data: bytes, time_s: float) -> None:
        """Note bytes from the robot, the last of which ended at `time_s`."""
        with self._lock:
            self.bytes_from_robot += len(data)
            for byte in data:
                self._pending.append(byte)
                if byte in self.ends or len(self._pending) >= 256:
                    self._add(bytes(self._pending), time_s, False)
                    self._pending.clear()
            for frame in self._decoder.feed(data):
                self._frames.extend(frame.values)
                self.frame_count += 1
            if len(self._frames) >= 2 * 6 * MAX_FRAMES:
                del self._frames[: 6 * MAX_FRAMES]
            self.malformed = self._decoder.malformed

    def sent(self, data: bytes, time_s: float) -> None:
        """Note bytes to the robot."""
        with self._lock:
            self.bytes_to_robot += len(data)
            self._add(data, time_s, True)

    @property
    def counts(self) -> str:
        """The numbers of frames and bytes, in words."""
        damaged = f" and {self.malformed} damaged" if self.malformed else ""
        return (
            f"{self._decoder.frames} frames{damaged}, {self.bytes_from_robot} bytes from the robot, "
            f"{self.bytes_to_robot} bytes to it"
        )

    @property
    def byte_counts(self) -> str:
        """The numbers of bytes, for a line without frames."""
        return f"{self.bytes_from_robot} bytes from the board, {self.bytes_to_robot} bytes to it"

    def clear(self) -> None:
        """Clear the log for a new run."""
        with self._lock:
            self._entries.clear()
            self._frames = array("h")
            self._pending.clear()
            self._decoder = FrameDecoder()
            self.bytes_from_robot = self.bytes_to_robot = self.malformed = 0
            self.epoch += 1

    def entries_since(self, number: int) -> list[LogEntry]:
        """Entries from `number` on, as far as they are kept."""
        with self._lock:
            return list(takewhile(lambda entry: entry.number >= number, reversed(self._entries)))[::-1]

    def frames_since(self, number: int) -> list[OdometryFrame]:
        """Frames from `number` on, as far as they are kept."""
        return self.frames_from(number)[0]

    def frames_from(self, number: int) -> tuple[list[OdometryFrame], int]:
        """The frames from `number` on, and the number of the next one."""
        with self._lock:
            following = self.frame_count
            oldest = following - len(self._frames) // 6
            values = self._frames[6 * max(0, number - oldest) :]
        return [OdometryFrame(*values[at : at + 6]) for at in range(0, len(values), 6)], following

    def last_frame(self) -> OdometryFrame | None:
        """The newest frame."""
        with self._lock:
            return OdometryFrame(*self._frames[-6:]) if self._frames else None

    def _add(self, data: bytes, time_s: float, to_robot: bool) -> None:
        text = data.decode("ascii", "backslashreplace").strip("\r\n")
        if not text and len(self.ends) > 1:  # between the two of one end
            return
        self._entries.append(LogEntry(self.count, time_s, text, to_robot))
        self.count += 1


class RobotLine(Protocol):
    """A robot behind a serial line."""

    address: str
    log: LineLog
    #: Why nothing comes any more; empty while the line is up.
    failure: str

    @property
    def flowing(self) -> bool:
        """Whether orders sent now are received soon, one after the other."""

    def write(self, data: bytes) -> None:
        """Send bytes to the robot."""


class EngineLine:
    """The emulated robot's line.  `send` hands bytes to the machine's owner.  A `hil.recording.wire.WireListener`."""

    failure = ""

    def __init__(
        self, send: Callable[[bytes], None], now_s: Callable[[], float], flowing: Callable[[], bool] = lambda: True,
        frame_ended: Callable[[], None] = lambda: None,
    ) -> None:  # fmt: skip
        """`frame_ended` is told that a frame's last byte has been sent, unless the run is executed again."""
        self.address = "emulated"
        self._flowing = flowing
        self.log = LineLog()
        self._frame_ended = frame_ended
        self._send = send
        self._now_s = now_s

    @property
    def flowing(self) -> bool:
        """While the machine runs and its line is not full of orders."""
        return self._flowing()

    def write(self, data: bytes) -> None:
        """Send bytes to the robot."""
        self._send(data)

    def to_robot(self, data: bytes, time_ns: int) -> None:
        """Note bytes that were given to the line."""
        self.log.sent(data, self._now_s())

    def from_robot(self, data: bytes, time_ns: int) -> None:
        """Note bytes that the robot sent."""
        self.log.received(data, self._now_s())
        if data[-1:] and data[-1] in self.log.ends:
            self._frame_ended()

    def byte(self, byte: int, _end_cycles: int) -> None:
        """Note a byte of the robot without a session, while a run is executed again."""
        self.log.received(bytes((byte,)), self._now_s())


class SerialPortLine:
    """A port of this computer; reading never waits.  Raises PortError, one line, if it cannot be opened."""

    def __init__(self, url: str) -> None:
        self.address = url
        self.log = LineLog()
        self.failure = ""
        self._began_s = time.monotonic()
        self._serial = open_url(url, read_timeout_s=0.0, write_timeout_s=WRITE_TIMEOUT_S)

    @property
    def flowing(self) -> bool:
        """True as long as the port exists."""
        return not self.failure

    def write(self, data: bytes) -> None:
        """Send bytes to the robot."""
        if self.failure:
            return
        try:
            self._serial.write(data)
        except serial.SerialTimeoutException:
            self.failure = "the robot takes no bytes: the port's buffer has been full for half a second"
            return
        except OSError as error:
            self.failure = str(gone(self.address, error))
            return
        self.log.sent(data, time.monotonic() - self._began_s)

    def turn(self) -> None:
        """Read the received bytes; this is called regularly, whether or not a page is open."""
        if self.failure:
            return
        try:
            data = self._serial.read(4096)
        except (OSError, TypeError) as error:
            self.failure = str(gone(self.address, error))
            return
        if data:
            self.log.received(bytes(data), time.monotonic() - self._began_s)

    def close(self) -> None:
        """Stop the robot, whoever drives it and however; close the port."""
        self.write(order("stop"))
        self._serial.close()
