"""The outputs of two runs, compared.  Nothing runs here."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final

from emulator.c28x.findings import Finding
from emulator.clock import us
from hil.client.decode import FrameDecoder, OdometryFrame
from hil.reports.outputs import OutputKind, RunOutputs, Stream, kind_of

#: The fields of a frame, as the thesis calls them, in their order on the line.
FIELDS: Final = ("X", "Y", "theta", "dF", "dR", "dL")


@dataclass(frozen=True, slots=True)
class OutputDifference:
    """One output that differs between two runs, A and B."""

    output: str
    kind: OutputKind
    #: When the first difference came: in A, or in B where A put out nothing more.
    first_us: float
    #: Its number in the stream, from 0, and what both put out there; None: nothing more.
    index: int
    a: int | None
    b: int | None
    #: How many values differ, missing ones included, and how many were compared.  0: the same values at other times.
    differing: int
    compared: int

    @property
    def only_times(self) -> bool:
        """Whether only the times differ."""
        return self.differing == 0

    def shown(self, value: int | None) -> str:
        """A value for a reader: a byte of the line as the character that it is."""
        if value is None:
            return "nothing"
        return repr(chr(value)) if self.kind is OutputKind.UART else str(value)


@dataclass(frozen=True, slots=True)
class FrameDifference:
    """The frames of two runs, by their number."""

    compared: int = 0
    #: Numbers of the frames that differ, from 1.
    numbers: tuple[int, ...] = ()
    #: Field -> in how many frames it differs.
    fields: Mapping[str, int] = field(default_factory=dict)
    #: First differing frame in both runs, as its line.
    first: tuple[str, str] = ("", "")


@dataclass(frozen=True, slots=True)
class RunDifferences:
    """The outputs that differ between two runs in which some memory holds different values."""

    differences: tuple[OutputDifference, ...]
    frames: FrameDifference
    #: How long was compared, in seconds of virtual time since power-up.
    seconds: float
    #: How each run ended, if it did not run on.
    stopped: tuple[str, str] = ("", "")
    #: The fills that were tried; the last of them made the difference, if there is one.
    tried: tuple[str, ...] = ()

    @property
    def anything(self) -> bool:
        """Whether an output has another value; a different time alone does not count."""
        return any(not d.only_times for d in self.differences) or self.stopped[0] != self.stopped[1]

    def of(self, kind: OutputKind) -> list[OutputDifference]:
        """The outputs of one kind whose values differ."""
        return [d for d in self.differences if d.kind is kind and not d.only_times]

    @property
    def summary(self) -> str:
        """The differences in one sentence: "frames 1..9 (dF, dL), PWM of EPwm1Regs, 2 registers"."""
        if not self.anything:
            return f"no output differs within {self.seconds:g} s (tried {', '.join(self.tried)})"
        parts = []
        if self.stopped[0] != self.stopped[1]:
            parts.append(f"ends the run ({self.stopped[1] or self.stopped[0]})")
        if self.frames.numbers:
            parts.append(f"{_numbers(self.frames.numbers)} ({', '.join(self.frames.fields)})")
        elif self.of(OutputKind.UART):
            parts.append("bytes between the frames")
        for kind, noun in ((OutputKind.PWM, "PWM"), (OutputKind.GPIO, "GPIO"), (OutputKind.REGISTER, "registers")):
            names = [d.output for d in self.of(kind)]
            if names:
                more = f" and {len(names) - 3} more" if len(names) > 3 else ""
                parts.append(f"{noun} {', '.join(names[:3])}{more}")
        return "; ".join(parts)


def _numbers(numbers: tuple[int, ...]) -> str:
    if len(numbers) == 1:
        return f"frame {numbers[0]}"
    if numbers[-1] - numbers[0] + 1 == len(numbers):
        return f"frames {numbers[0]}..{numbers[-1]}"
    return f"{len(numbers)} frames from {numbers[0]} to {numbers[-1]}"


@dataclass(frozen=True, slots=True)
class FilledMemory:
    """The memory that a finding names, whose value was changed: an object, a cell outside one, words at address 0."""

    rule: str
    object: str
    declaration: str

    @classmethod
    def of(cls, finding: Finding) -> FilledMemory:
        """The subject of a finding."""
        return cls(finding.rule, finding.object, finding.declaration)


@dataclass(frozen=True, slots=True)
class TwoFillProof:
    """One scenario under two fills, and again with only one object at a time filled by the second."""

    fill_a: str
    fill_b: str
    whole: RunDifferences
    parts: Mapping[FilledMemory, RunDifferences]

    def reach_of(self, finding: Finding) -> RunDifferences | None:
        """The outputs that a finding's object affects; None if it was not examined."""
        return self.parts.get(FilledMemory.of(finding))


def compare(a: RunOutputs, b: RunOutputs) -> RunDifferences:
    """Every output that differs, by the time of its first difference."""
    found = [_compare(name, a.streams.get(name, []), b.streams.get(name, [])) for name in _names(a, b)]
    differences = sorted((d for d in found if d is not None), key=lambda d: (d.only_times, d.first_us, d.output))
    seconds = us(min(a.end_cycles, b.end_cycles)) / 1e6
    return RunDifferences(tuple(differences), _compare_frames(a.uart, b.uart), seconds, (a.stopped, b.stopped))


def _names(*runs: RunOutputs) -> Iterable[str]:
    return dict.fromkeys(name for run in runs for name in run.streams)


def _compare(name: str, a: Stream, b: Stream) -> OutputDifference | None:
    if a == b:
        return None
    common = min(len(a), len(b))
    different = [i for i in range(common) if a[i][1] != b[i][1]]
    unequal = len(different) + max(len(a), len(b)) - common
    if different or unequal:
        first = different[0] if different else common
    else:
        first = next(i for i in range(common) if a[i][0] != b[i][0])
    at_a, at_b = (stream[first] if first < len(stream) else None for stream in (a, b))
    time = (at_a or at_b or (0, 0))[0]
    return OutputDifference(
        name, kind_of(name), us(time), first, at_a and at_a[1], at_b and at_b[1], unequal, max(len(a), len(b))
    )


def _compare_frames(a: Stream, b: Stream) -> FrameDifference:
    frames_a, frames_b = _frames(a), _frames(b)
    numbers: list[int] = []
    fields = Counter[str]()
    first = ("", "")
    for number, (one, other) in enumerate(zip(frames_a, frames_b, strict=False), 1):
        differing = [name for name, x, y in zip(FIELDS, one.values, other.values, strict=True) if x != y]
        if differing:
            first = first if numbers else (one.line, other.line)
            numbers.append(number)
            fields.update(differing)
    ordered = {name: fields[name] for name in FIELDS if fields[name]}
    return FrameDifference(min(len(frames_a), len(frames_b)), tuple(numbers), ordered, first)


def _frames(stream: Stream) -> list[OdometryFrame]:
    return FrameDecoder().feed(bytes(value & 0xFF for _, value in stream))
