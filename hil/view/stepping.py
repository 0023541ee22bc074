"""One step: on to the next statement, register access, task switch or frame.

| step | where it stops | exact |
|---|---|---|
| statement | before the next line of firmware source, in whatever task runs then | yes: Python's own tracing |
| access | before the register is read or written | yes: `taps.Taps` |
| switch | after the scheduler has chosen another task | at the CPU's next charge |
| frame | after the last byte of a frame has left | at the CPU's next charge |

The first two *hold*: the firmware stands in the middle of a slice, between two statements of one charge, where nothing
can be done to it from outside without the run depending on where it stood.  What is asked for meanwhile is done at the
slice's end.  The others end the slice: the robot is at rest.

Where the firmware stands is known to its `Position`, but only at statements that somebody else can notice.  Python's
frames serve what is finer than that: a stop before every line, and the values of locals.

Tracing makes everything slower, so it is on during the step only.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from types import FrameType
from typing import Any

from emulator.c28x.sites import Place
from emulator.registers.cell import Cell
from hil.bench import Bench
from hil.view.taps import Taps


class Step(Enum):
    """What to stop at."""

    STATEMENT = "statement"
    ACCESS = "register access"
    SWITCH = "task switch"
    FRAME = "frame"


@dataclass(frozen=True, slots=True)
class Where:
    """Where a step ended."""

    text: str
    place: Place | None
    task: str
    cycles: int
    #: Locals of the C function, as it declares them.
    locals: tuple[tuple[str, str], ...] = ()


class Stepper:
    """Steps of one bench.  `hold(where)` waits until the person goes on; `rest(where)` has the slice end."""

    def __init__(self, bench: Bench, taps: Taps, hold: Callable[[Where], None], rest: Callable[[Where], None]) -> None:
        self._bench = bench
        self._taps = taps
        self._hold = hold
        self._rest = rest
        self._sources = bench.findings.sources
        self._kind: Step | None = None
        self._traced: list[FrameType] = []
        self._tracing = False
        self._listening = False

    @property
    def armed(self) -> bool:
        """Whether a step is being made."""
        return self._kind is not None

    def arm(self, kind: Step) -> None:
        """Stop at the next `kind`."""
        if kind is not self._kind:
            self.disarm()
        self._kind = kind
        if kind is Step.STATEMENT:
            self._trace()
        elif kind is Step.ACCESS:
            self._taps.set(step=self._accessed)
        elif not self._listening:
            self._listening = True
            self._bench.board.trace.listen(self._event)

    def disarm(self) -> None:
        """Stop at nothing."""
        self._kind = None
        if self._tracing:
            self._tracing = False
            sys.settrace(None)
            for frame in self._traced:
                frame.f_trace = None
            self._traced.clear()
        if self._taps.step is not None:
            self._taps.set()

    def frame_sent(self) -> None:
        """A frame has left."""
        if self._kind is Step.FRAME:
            self._ended("a frame was sent")

    # Statements

    def _trace(self) -> None:
        if self._tracing:
            return
        self._tracing = True
        for frame in self._suspended():
            if frame.f_code.co_filename in self._sources:
                frame.f_trace = self._line
                self._traced.append(frame)
        sys.settrace(self._called)

    def _suspended(self) -> Iterator[FrameType]:
        """Frames of everything that waits for its turn on a stack of its own."""
        for task in self._bench.board.kernel.tasks.all:
            frame = task.greenlet.gr_frame if task.greenlet is not None else None
            while frame is not None:
                yield frame
                frame = frame.f_back

    def _called(self, frame: FrameType, _event: str, _value: Any) -> Any:
        return self._line if frame.f_code.co_filename in self._sources else None

    def _line(self, frame: FrameType, event: str, _value: Any) -> Any:
        if event == "line" and self._kind is Step.STATEMENT:
            code = frame.f_code  # A line begins: the position is still that of the statement before.
            place = Place(code.co_filename, frame.f_lineno, code.co_name, self._sources[code.co_filename])
            self._hold(self._where("before this statement", place, frame))
        return self._line if self._kind is Step.STATEMENT else None

    # The rest

    def _accessed(self, register: Cell, access: str, word: int) -> None:
        if self._kind is not Step.ACCESS:
            return
        findings = self._bench.findings
        at = findings.position.innermost()
        if not at:  # the kernel's own accesses are not the firmware's
            return
        frame: FrameType | None = sys._getframe(2)  # for the locals
        while frame is not None and frame.f_code.co_filename not in self._sources:
            frame = frame.f_back
        what = f"writes {word:#06x} to" if access == "write" else "reads"
        self._hold(self._where(f"{what} {register.path}", findings.places[at], frame))

    def _event(self, _cycles: int, kind: str, name: str) -> None:
        if self._kind is Step.SWITCH and kind == "switch":
            self._ended(f"the CPU goes to {name}")

    def _ended(self, text: str) -> None:
        self._kind = None
        findings = self._bench.findings
        self._bench.board.kernel.pause()
        self._rest(Where(text, None, findings.context(), self._bench.clock.now))

    def _where(self, text: str, place: Place, frame: FrameType | None) -> Where:
        values = {} if frame is None else frame.f_locals
        names = tuple((name, _shown(value)) for name, value in values.items() if not name.startswith("_"))
        return Where(text, place, self._bench.findings.context(), self._bench.clock.now, names)


def _shown(value: Any) -> str:
    if value is None:
        return "never written"
    if isinstance(value, float):
        return f"{value:.6g}"
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
