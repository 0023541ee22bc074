"""The console's own file of points, ``trayectoria.txt``: a line of headings, then six numbers a line, no times.

The console draws the newest frame that it has read, again and again until there is a newer one, and writes it each
time.  So the file can have a point several times, and lack frames.  Repeated points are read as one.  If the console
has cut a frame at the wrong place, a line is broken; the reader skips it and says so.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Final

from hil.client.decode import OdometryFrame

HEADINGS: Final = "X,Y,theta,dF,dR,dL"
_LINE = re.compile(r"-?\d{1,5}(?:,-?\d{1,5}){5}")


@dataclass(slots=True)
class Trajectory:
    """The points of a file."""

    frames: list[OdometryFrame] = field(default_factory=list)
    repeated: int = 0
    problems: list[str] = field(default_factory=list)


def is_trajectory(data: bytes) -> bool:
    """Whether a file begins like the console's file."""
    return data.lstrip(b"\xef\xbb\xbf").startswith(HEADINGS.encode())


def parse_trajectory(data: bytes) -> Trajectory:
    """Read all points that can be read."""
    result = Trajectory()
    broken: list[int] = []
    for number, line in enumerate(data.decode("utf-8", "replace").splitlines()[1:], 2):
        text = line.strip()
        if not text:
            continue
        values = [int(part) for part in text.split(",")] if _LINE.fullmatch(text) else []
        if not values or not all(-32768 <= value <= 32767 for value in values):
            broken.append(number)
            continue
        frame = OdometryFrame(*values)
        if result.frames and result.frames[-1] == frame:
            result.repeated += 1
        else:
            result.frames.append(frame)
    if broken:
        more = f" and {len(broken) - 1} more" if len(broken) > 1 else ""
        result.problems.append(f"line {broken[0]}{more}: not six numbers, left out")
    return result
