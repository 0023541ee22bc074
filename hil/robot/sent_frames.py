"""The frames that a robot has sent since power-up, with the virtual time at which each one ended."""

from __future__ import annotations

from array import array
from typing import Final, NamedTuple

from hil.client.decode import FrameDecoder

#: CHOICE: the least number of line ends that are kept; 40,000 are 2.8 hours of a robot that sends four lines a second.
REMEMBERED: Final = 40_000
_END: Final = 0x0D


class FrameRow(NamedTuple):
    """One frame as a row of a table.  `time_s` is virtual time since power-up, at the end of its last byte."""

    time_s: float
    x_mm: int
    y_mm: int
    theta_rad: int
    front_mm: int
    right_mm: int
    left_mm: int


class SentFrames:
    """The bytes that were sent; frames are decoded from them on demand."""

    def __init__(self) -> None:
        self._bytes = bytearray()
        self._ends_s = array("d")

    def add(self, byte: int, time_s: float) -> None:
        """A byte has been sent."""
        self._bytes.append(byte)
        if byte == _END:
            self._ends_s.append(time_s)
            if len(self._ends_s) > 2 * REMEMBERED:
                kept = bytes(self._bytes).split(b"\r", REMEMBERED)[-1]
                self._bytes[:] = kept
                del self._ends_s[:REMEMBERED]

    def rows(self) -> list[FrameRow]:
        """The whole frames, oldest first."""
        decoder, rows = FrameDecoder(), []
        for line, time_s in zip(bytes(self._bytes).split(b"\r"), self._ends_s, strict=False):
            rows += [FrameRow(time_s, *frame.values) for frame in decoder.feed(line + b"\r")]
        return rows
