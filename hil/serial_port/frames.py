"""Robot to PC: bytes gathered into frames, and a bounded buffer that forgets whole frames, oldest first.

A frame is ``#...\\r`` (the robot sends ``#ODO x,y,theta,dF,dR,dL\\n\\r``).  Two ways of handing it over:

* `Delivery.FRAMES` (default): a frame becomes visible whole, at the end of its last byte's stop bit.  The line's
  timing holds at frame grain, and a reader that looks at any moment never sees a number cut in half.  The thesis
  console takes a frame cut inside its last field for a complete one (five commas) and draws a wrong point.
* `Delivery.BYTES`: each byte becomes visible at the end of its own stop bit, as on the wire, with that consequence.

Nothing is withheld for ever: bytes outside a frame leave after a pause on the line or when there are too many.
What the port has taken is in transit and never dropped, so what arrives is always whole frames in order.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import Enum
from typing import Final

from emulator.clock import CYCLES_PER_MS

FRAME_BEGIN: Final = 0x23  # '#'
FRAME_END: Final = 0x0D  # '\r'

#: A longer run without an end is handed over as it is.  The firmware's own frame buffer has 80 characters.
LONGEST_UNIT: Final = 256
#: Silence after which an unfinished unit is handed over: five byte times of 9600 baud, rounded.
PAUSE_CYCLES: Final = 5 * CYCLES_PER_MS
#: CHOICE: 6 s of odometry.  With less, a program that reads every few seconds loses frames; with more, a program that
#: was busy gets older frames first.  A kernel's own buffer (4095 bytes) would hold 38 s.
DEFAULT_KEEP: Final = 24


class Delivery(Enum):
    """When a byte becomes visible to the PC: with its frame, or by itself."""

    FRAMES = "frames"
    BYTES = "bytes"


@dataclass(slots=True)
class Counters:
    """What passed through a port since it was opened.  Bytes dropped belong to frames dropped."""

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
    #: Part of it was already taken: dropping the rest would tear the frame.
    begun: bool


def split_units(data: bytes) -> list[bytes]:
    """Cut a stretch of the line after each frame end; the last piece may be unfinished."""
    pieces = data.split(b"\r")
    units = [piece + b"\r" for piece in pieces[:-1]]
    if pieces[-1]:
        units.append(pieces[-1])
    return units


class OutboundQueue:
    """Bytes of the robot on their way out: at most `keep` finished frames wait, the oldest give way."""

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
        """How many finished units wait."""
        return len(self._waiting)

    @property
    def has_piece(self) -> bool:
        """Whether `take` would return something."""
        if self._waiting:
            return True
        return self.deliver is Delivery.BYTES and not self._open_unwanted and self._open_taken < len(self._open)

    def push(self, byte: int, end_cycles: int) -> None:
        """A byte of the robot whose stop bit ended at `end_cycles`."""
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
        """Hand over an unfinished unit after which the line has been silent."""
        if self._open and now_cycles - self._last_byte_end >= PAUSE_CYCLES:
            self._close()

    def take(self) -> bytes:
        """The next bytes to put on their way, b"" if none.  They are the caller's now."""
        if self._waiting:
            return self._waiting.popleft().data
        if self.has_piece:
            piece = bytes(self._open[self._open_taken :])
            self._open_taken = len(self._open)
            return piece
        return b""

    def discard(self) -> None:
        """Nobody is there to hear: forget what waits, so that the next listener begins with a whole frame."""
        while self._waiting:
            self.count_dropped(self._waiting.popleft().data)
        if self._open_taken:
            self._open_unwanted = True

    def count_dropped(self, data: bytes) -> None:
        """Bytes of one frame that will not arrive."""
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
