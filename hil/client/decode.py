"""Decodes the robot's frames from any stream of bytes.

A frame is ``#ODO X,Y,theta,dF,dR,dL\\n\\r``: six integers of 16 bits.  X, Y and the distances (front, *right, left*)
are in mm, theta is in whole radians.  The decoder never raises on input.  It skips and counts bytes that are no frame,
starts a new frame at each ``#``, and uses a bounded amount of memory.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

#: Bytes of the longest frame: "#ODO ", six times "-32768", five commas, "\n\r".
LONGEST_FRAME: Final = 5 + 6 * 6 + 5 + 2

#: The six numbers in the frame's order: name and unit.
QUANTITIES: Final = (("x", "mm"), ("y", "mm"), ("theta", "rad"), ("front", "mm"), ("right", "mm"), ("left", "mm"))

_BODY = re.compile(rb"#ODO (-?\d{1,5}),(-?\d{1,5}),(-?\d{1,5}),(-?\d{1,5}),(-?\d{1,5}),(-?\d{1,5})\n")


@dataclass(frozen=True, slots=True)
class OdometryFrame:
    """One odometry frame, in the units of the frame."""

    x_mm: int
    y_mm: int
    theta_rad: int
    front_mm: int
    right_mm: int
    left_mm: int

    @property
    def line(self) -> str:
        """The six numbers as a line of the console's file."""
        return ",".join(str(value) for value in self.values)

    @property
    def values(self) -> tuple[int, int, int, int, int, int]:
        """The six numbers in the frame's order."""
        return (self.x_mm, self.y_mm, self.theta_rad, self.front_mm, self.right_mm, self.left_mm)

    @property
    def distances_mm(self) -> dict[str, int]:
        """The three measured distances in mm, by name."""
        return {name: value for (name, _), value in zip(QUANTITIES[3:], self.values[3:], strict=True)}

    def encode(self) -> bytes:
        """The bytes that the robot sends for this frame."""
        return f"#ODO {self.line}\n\r".encode("ascii")


class FrameDecoder:
    """Decodes frames.  The bytes may come in pieces of any size."""

    def __init__(self) -> None:
        #: The number of frames without six 16-bit integers, and of frames without an end.
        self.malformed = 0
        #: The number of bytes that belonged to no frame.
        self.skipped = 0
        self.frames = 0
        self._buffer = bytearray()

    def feed(self, data: bytes) -> list[OdometryFrame]:
        """Take in `data`, and return the frames that it completes."""
        frames: list[OdometryFrame] = []
        for byte in data:
            if byte == 0x23:
                if self._buffer:
                    self._reject()
                self._buffer.append(byte)
            elif not self._buffer:
                self.skipped += 1
            elif byte == 0x0D:
                frame = _parse(bytes(self._buffer))
                if frame is None:
                    self.skipped += 1
                    self._reject()
                else:
                    self._buffer.clear()
                    self.frames += 1
                    frames.append(frame)
            elif len(self._buffer) >= LONGEST_FRAME:
                self.skipped += 1
                self._reject()
            else:
                self._buffer.append(byte)
        return frames

    def _reject(self) -> None:
        self.malformed += 1
        self.skipped += len(self._buffer)
        self._buffer.clear()


def _parse(body: bytes) -> OdometryFrame | None:
    match = _BODY.fullmatch(body)
    if match is None:
        return None
    values = [int(group) for group in match.groups()]
    if not all(-32768 <= value <= 32767 for value in values):
        return None
    return OdometryFrame(*values)
