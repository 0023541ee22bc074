"""From the robot to the PC: gathers bytes to frames, in a bounded buffer that drops whole frames, the oldest first.

A frame is ``#...\\r`` (the robot sends ``#ODO x,y,theta,dF,dR,dL\\n\\r``).  Two ways of handing it over:

* `Delivery.FRAMES` (default): a whole frame becomes visible at the end of its last stop bit.  So each frame has the
  right time, and a reader never sees a part of a number.  (The thesis console treats a frame that is cut in its last
  field as complete, because it has five commas, and draws a wrong point.)
* `Delivery.BYTES`: each byte becomes visible at the end of its own stop bit, as on the wire.  Readers can see parts of
  frames.

No byte is kept back for ever: bytes outside a frame are sent after a pause on the line, or when there are too many.
Bytes that the port has taken are in transit and never dropped.  So the PC always gets whole frames in order.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import Enum
from typing import Final

from emulator.clock import CYCLES_PER_MS

FRAME_BEGIN: Final = 0x23  # '#'
FRAME_END: Final = 0x0D  # '\r'

#: More bytes than this without an end are sent as they are.  The firmware's frame buffer has 80 characters.
LONGEST_UNIT: Final = 256
#: The silence after which an unfinished unit is sent: five byte times at 9600 baud, rounded.
PAUSE_CYCLES: Final = 5 * CYCLES_PER_MS
#: CHOICE: 6 s of odometry.  With less, a program that reads every few seconds loses frames; with more, a program that
#: was busy gets older frames first.  A kernel's own buffer (4095 bytes) would hold 38 s.
DEFAULT_KEEP: Final = 24


class Delivery(Enum):
    """How bytes become visible to the PC: with their frame, or one by one."""

    FRAMES = "frames"
    BYTES = "bytes"


@dataclass(slots=True)
class Counters:
    """Counts of frames and bytes since the port was opened.  Dropped bytes are those of dropped frames."""

    bytes_from_robot: int = 0
    bytes_to_robot: int = 0
    bytes_delivered: int = 0
    frames_from_robot: int = 0
    frames_dropped: int = 0
    bytes_dropped: int = 0
    connections: int = 0
    protocol_errors: int = 0

    def as_dict(self) -> dict[str, int]:
        """Plain data for JSON."""
        return {name: getattr(self, name) for name in self.__slots__}


@dataclass(slots=True)
class _Unit:
    data: bytes
    #: A part of it was taken already.  It is not dropped, because the frame would be torn.
    begun: bool


def split_units(data: bytes) -> list[bytes]:
    """Split bytes of the line after each frame end.  The last piece may be unfinished."""
    pieces = data.split(b"\r")
    units = [piece + b"\r" for piece in pieces[:-1]]
    if pieces[-1]:
        units.append(pieces[-1])
    return units


class OutboundQueue:
    """Bytes of the robot that wait to be sent.  At most `keep` finished frames wait; then the oldest are dropped."""

    def __init__(self, counters: Counters, *, keep: int = DEFAULT_KEEP, deliver: Delivery = Delivery.FRAMES) -> None:
        if not 1 <= keep <= 64:
            raise ValueError(f"frames to keep: {keep}, must be 1..64")
        self.keep = keep
        self.deliver = deliver
        self.counters = counters
        self._waiting: deque[_Unit] = deque()
        self._open = bytearray()
        self._open_taken = 0
        self._open_unwanted = False
        self._last_byte_end = 0

    def __len__(self) -> int:
        """The number of finished units that wait."""
        return len(self._waiting)

    @property
    def has_piece(self) -> bool:
        """Whether `take` would return bytes."""
        if self._waiting:
            return True
        return self.deliver is Delivery.BYTES and not self._open_unwanted and self._open_taken < len(self._open)

    def push(self, byte: int, end_cycles: int) -> None:
        """Take in a byte of the robot whose stop bit ended at `end_cycles`."""
        self.settle(end_cycles)
        if byte == FRAME_BEGIN and self._open:
            self._close()
        self._open.append(byte)
        self._last_byte_end = end_cycles
        self.counters.bytes_from_robot += 1
        if byte == FRAME_END:
            self.counters.frames_from_robot += 1
            self._close()
        elif len(self._open) >= LONGEST_UNIT:
            self._close()

    def settle(self, now_cycles: int) -> None:
        """Finish the last unit if the line has been silent since."""
        if self._open and now_cycles - self._last_byte_end >= PAUSE_CYCLES:
            self._close()

    def take(self) -> bytes:
        """Remove the next bytes and return them; b"" if there are none."""
        if self._waiting:
            return self._waiting.popleft().data
        if self.has_piece:
            piece = bytes(self._open[self._open_taken :])
            self._open_taken = len(self._open)
            return piece
        return b""

    def discard(self) -> None:
        """Drop everything that waits, because nobody is connected.  So the next reader begins with a whole frame."""
        while self._waiting:
            self.count_dropped(self._waiting.popleft().data)
        if self._open_taken:
            self._open_unwanted = True

    def count_dropped(self, data: bytes) -> None:
        """Count the bytes of a frame that will not arrive."""
        self.counters.frames_dropped += 1
        self.counters.bytes_dropped += len(data)

    def _close(self) -> None:
        data = bytes(self._open[self._open_taken :])
        begun = self._open_taken > 0
        unwanted = self._open_unwanted
        self._open.clear()
        self._open_taken = 0
        self._open_unwanted = False
        if not data:
            return
        if unwanted:
            self.count_dropped(data)
            return
        self._waiting.append(_Unit(data, begun))
        while len(self._waiting) > self.keep:
            oldest = self._waiting.popleft()
            if oldest.begun:  # only the first can be: keep its rest, drop the frame after it
                victim = self._waiting.popleft()
                self._waiting.appendleft(oldest)
                oldest = victim
            self.count_dropped(oldest.data)
