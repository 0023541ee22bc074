"""Compares two runs: aligns them in time, pairs their frames, and measures the differences.

Time zero of each run is the first order that both runs have and that is not ``#STOP`` (a console sends that at its
start); without such an order, it is the first frame.  Then each frame of one run is paired with the nearest frame of
the other, in order and at most once, if their times differ by at most `tolerance_s`.  Runs without times (the console's
file of points) are paired by the content of their frames.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from functools import partial
from pathlib import Path
from typing import Final

from hil.client.decode import QUANTITIES as NUMBERS
from hil.client.decode import FrameDecoder, OdometryFrame
from hil.files import read_bytes
from hil.recording.log import Direction, Recording, parse_log
from hil.recording.trajectory import is_trajectory, parse_trajectory

#: Half of the robot's frame period (TaskODO: 250 ms).  Frames with a greater difference in time do not belong together.
TOLERANCE_S: Final = 0.125
_STOP: Final = b"#STOP\r"


def _number(index: int, frame: OdometryFrame) -> int:
    return frame.values[index]


#: The columns of a comparison: name, unit, and the function that gives the value of a frame.
QUANTITIES: Final[tuple[tuple[str, str, Callable[[OdometryFrame], int]], ...]] = tuple(
    (name, unit, partial(_number, index)) for index, (name, unit) in enumerate(NUMBERS)
)


@dataclass(slots=True)
class RecordedRun:
    """The frames and orders of a file, with their times in seconds since its start if the file has times."""

    name: str
    frames: list[OdometryFrame]
    #: When each frame was complete; empty if the file has no times.
    times_s: list[float] = field(default_factory=list)
    orders: list[tuple[float, bytes]] = field(default_factory=list)
    #: What a user must know before trusting the comparison, one line each.
    statements: list[str] = field(default_factory=list)

    @property
    def timed(self) -> bool:
        """Whether its frames have times."""
        return bool(self.times_s)


@dataclass(frozen=True, slots=True)
class QuantityDifference:
    """The difference of one quantity between the second and the first run, over all pairs."""

    name: str
    unit: str
    mean: float
    rms: float
    largest: float
    #: The index of the pair with the largest difference.
    at: int


@dataclass(frozen=True, slots=True)
class PairedRuns:
    """Two runs with their pairs of frames."""

    first: RecordedRun
    second: RecordedRun
    #: The seconds to subtract from the times of each run so that both start together, and what aligned them.
    zero_s: tuple[float, float]
    aligned_by: str
    #: The indices of frames that belong together.
    pairs: list[tuple[int, int]]
    differences: list[QuantityDifference]

    @property
    def only_first(self) -> int:
        """The number of frames of the first run without a pair."""
        return len(self.first.frames) - len(self.pairs)

    @property
    def only_second(self) -> int:
        """The number of frames of the second run without a pair."""
        return len(self.second.frames) - len(self.pairs)


def read_run(path: Path) -> RecordedRun:
    """Read a wire log or the console's file of points.  Raises ValueError and OSError."""
    data = read_bytes(path)
    if is_trajectory(data):
        trajectory = parse_trajectory(data)
        problems = [f"{path}: {problem}" for problem in trajectory.problems]
        return RecordedRun(str(path), trajectory.frames, statements=problems)
    return run_of(parse_log(data, str(path)))


def run_of(recording: Recording) -> RecordedRun:
    """The frames and the complete orders of a wire log."""
    run = RecordedRun(recording.name, [], statements=recording.statements())
    decoder = FrameDecoder()
    order = b""
    for record in recording.records:
        time_s = record.time_ns / 1e9
        if record.direction is Direction.FROM_ROBOT:
            for frame in decoder.feed(record.data):
                run.frames.append(frame)
                run.times_s.append(time_s)
        else:
            *whole, order = (order + record.data).split(b"\r")
            run.orders += [(time_s, data + b"\r") for data in whole]
    if decoder.malformed:
        run.statements.append(f"{recording.name}: {decoder.malformed} malformed frames, left out")
    return run


def compare(first: RecordedRun, second: RecordedRun, *, tolerance_s: float = TOLERANCE_S) -> PairedRuns:
    """Pair two runs and measure their differences.  Raises ValueError if there is nothing to compare."""
    for run in (first, second):
        if not run.frames:
            raise ValueError(f"{run.name}: has no frames")
    if first.timed and second.timed:
        zero_s, aligned_by = _zero(first, second)
        pairs = _pair_by_time(
            [time - zero_s[0] for time in first.times_s], [time - zero_s[1] for time in second.times_s], tolerance_s
        )
        if not pairs:
            raise ValueError(f"no frames of {first.name} and {second.name} belong together (aligned by {aligned_by})")
    else:
        zero_s, aligned_by = (0.0, 0.0), "what the frames say (no times)"
        pairs = _pair_by_content(first.frames, second.frames)
    differences = [
        _measure(name, unit, [value(second.frames[b]) - value(first.frames[a]) for a, b in pairs])
        for name, unit, value in QUANTITIES
    ]
    if first.timed and second.timed:
        late_ms = [((second.times_s[b] - zero_s[1]) - (first.times_s[a] - zero_s[0])) * 1e3 for a, b in pairs]
        differences.append(_measure("time", "ms", late_ms))
    return PairedRuns(first, second, zero_s, aligned_by, pairs, differences)


def _zero(first: RecordedRun, second: RecordedRun) -> tuple[tuple[float, float], str]:
    theirs = {order: time for time, order in reversed(second.orders)}
    for time, order in first.orders:
        if order != _STOP and order in theirs:
            return (time, theirs[order]), f"the first {order[:-1].decode('ascii', 'replace')}"
    return (first.times_s[0], second.times_s[0]), "the first frame"


def _pair_by_time(first: Sequence[float], second: Sequence[float], tolerance_s: float) -> list[tuple[int, int]]:
    """Pair frames that are nearest in time, in order, each at most once."""
    pairs: list[tuple[int, int]] = []
    b = 0
    for a, time in enumerate(first):
        while b + 1 < len(second) and abs(second[b + 1] - time) <= abs(second[b] - time):
            b += 1
        if b >= len(second):
            break
        distance = abs(second[b] - time)
        nearer_next = a + 1 < len(first) and abs(first[a + 1] - second[b]) < distance
        if distance <= tolerance_s and not nearer_next:
            pairs.append((a, b))
            b += 1
    return pairs


def _pair_by_content(first: Sequence[OdometryFrame], second: Sequence[OdometryFrame]) -> list[tuple[int, int]]:
    """Pair equal frames in order; between them, pair frames by their position."""
    matcher = SequenceMatcher(None, [frame.values for frame in first], [frame.values for frame in second])
    pairs = []
    for tag, a0, a1, b0, b1 in matcher.get_opcodes():
        if tag in ("equal", "replace"):
            pairs += list(zip(range(a0, a1), range(b0, b1), strict=False))
    return pairs


def _measure(name: str, unit: str, values: Sequence[float]) -> QuantityDifference:
    if not values:
        return QuantityDifference(name, unit, 0.0, 0.0, 0.0, 0)
    at = max(range(len(values)), key=lambda index: abs(values[index]))
    rms = math.sqrt(sum(value * value for value in values) / len(values))
    return QuantityDifference(name, unit, sum(values) / len(values), rms, values[at], at)
