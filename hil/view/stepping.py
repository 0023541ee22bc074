"""One step: the run goes on to the next statement, register access, task switch, frame or finding.

| step | where it stops | exact |
|---|---|---|
| statement | before the next statement of the firmware, in whatever task runs then | yes |
| access | before the register is read or written | yes: `taps.RegisterTaps` |
| switch | after the scheduler has chosen another task | at the CPU's next charge |
| frame | after the last byte of a frame has left | at the CPU's next charge |
| finding | where something is found for the first time, in the middle of its statement | yes |

Statements, accesses and findings *hold* the firmware in the middle of a slice, between two statements.  An input at
this point would make the run depend on the step, so inputs wait until the end of the slice.  The other steps end the
slice; then the robot is at rest.

The image is linked with `CompileOptions.steps`: before each statement, the firmware reports its place and its locals.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from heapq import nlargest
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.c28x.position import Calls
from emulator.c28x.sites import Place
from emulator.clock import CYCLES_PER_US
from emulator.registers.cell import Cell
from hil.running import RunningBoard
from hil.view.taps import RegisterTaps

MAX_REGISTERS: Final = 6
#: The most characters of a local's value.
MAX_TEXT: Final = 60


class Step(Enum):
    """The kind of a step: the event at which it stops."""

    STATEMENT = "statement"
    ACCESS = "register access"
    SWITCH = "task switch"
    FRAME = "frame"
    FINDING = "finding"


@dataclass(frozen=True, slots=True)
class StepEnd:
    """The end of a step."""

    text: str
    place: Place | None
    task: str
    cycles: int
    #: The callers of the function, the nearest first.
    callers: tuple[Place, ...] = ()
    #: The locals of the C function: name and value.
    locals: tuple[tuple[str, str], ...] = ()
    #: The registers that were written last, the latest first: path, word, and the time since in us.
    registers: tuple[tuple[str, int, float], ...] = ()


class Stepper:
    """Makes the steps of one machine.  `hold(where)` waits until the user goes on; `rest(where)` ends the slice."""

    def __init__(
        self, bench: RunningBoard, taps: RegisterTaps, hold: Callable[[StepEnd], None], rest: Callable[[StepEnd], None]
    ) -> None:
        self._bench = bench
        self._taps = taps
        self._hold = hold
        self._rest = rest
        self._position = bench.findings.position
        self._kind: Step | None = None
        #: The call whose statement began last, and its locals at that time.
        self._begun: tuple[Calls | None, Mapping[str, Any]] = (None, {})
        self._listening = False
        #: The only finding to stop at; None: any.
        self.sought: Finding | None = None
        self._stop_listening: Callable[[], None] | None = None

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
            self._position.hold = self._statement
        elif kind is Step.ACCESS:
            self._position.hold = self._began
            self._taps.set(step=self._accessed)
        elif kind is Step.FINDING:
            self._position.hold = self._began
            if self._stop_listening is None:
                self._stop_listening = self._bench.findings.found.connect(self._found)
        elif not self._listening:
            self._listening = True
            self._bench.board.trace.listen(self._event)

    def disarm(self) -> None:
        """Stop at no event."""
        self._kind = None
        self._position.hold = None
        self._begun = (None, {})
        if self._stop_listening is not None:
            self._stop_listening()
            self._stop_listening = None
        if self._taps.step is not None:
            self._taps.set()

    def frame_sent(self) -> None:
        """End the step if it waits for a frame: a frame was sent."""
        if self._kind is Step.FRAME:
            self._ended("a frame was sent")

    def _began(self, values: Mapping[str, Any]) -> None:
        self._begun = (self._position.calls, values)

    def _statement(self, values: Mapping[str, Any]) -> None:
        self._began(values)
        self._hold(self._where("before this statement"))

    def _accessed(self, register: Cell, access: str, word: int) -> None:
        if not self._position.innermost():  # the kernel's own accesses are not the firmware's
            return
        what = f"writes {word:#06x} to" if access == "write" else "reads"
        self._hold(self._where(f"{what} {register.path}"))

    def _found(self, finding: Finding) -> None:
        sought = self.sought
        if sought is None or (
            (sought.rule, sought.object, sought.place) == (finding.rule, finding.object, finding.place)
        ):
            place, *callers = (*finding.call_path,) or (finding.place,)
            self._hold(self._where(f"{finding.rule}: found here", place, callers))

    def _event(self, _cycles: int, kind: str, name: str) -> None:
        if self._kind is Step.SWITCH and kind == "switch":
            self._ended(f"the CPU goes to {name}")

    def _ended(self, text: str) -> None:
        self._kind = None
        findings = self._bench.findings
        self._bench.board.kernel.pause()
        self._rest(StepEnd(text, None, findings.context(), self._bench.clock.now))

    def _where(self, text: str, place: Place | None = None, callers: Sequence[Place] = ()) -> StepEnd:
        """The present place of the firmware; `place` and `callers` replace those of its position."""
        findings, position = self._bench.findings, self._position
        if place is None:
            place, *callers = findings.path(position.at, position.calls)
        call, values = self._begun
        if call is not position.calls:  # a function that it called has returned since
            values = {}
        names = tuple((name, _shown(value)) for name, value in values.items() if not name.startswith("_"))
        return StepEnd(text, place, findings.context(), self._bench.clock.now, tuple(callers), names, self._written())

    def _written(self) -> tuple[tuple[str, int, float], ...]:
        """The registers that were written last, as far as that is recorded."""
        now = self._bench.clock.now
        latest = nlargest(MAX_REGISTERS, self._taps.writers.items(), key=lambda item: item[1][0])
        return tuple((cell.path, word, (now - cycles) / CYCLES_PER_US) for cell, (cycles, _, _, word) in latest)


def _shown(value: Any) -> str:
    """The value of a local as text.  Of a long array the first elements; an element never written is a `?`."""
    if value is None:
        return "never written"
    if not isinstance(value, list):
        return _cut(_number(value))
    unwritten = "  (?: never written)" if None in value else ""
    return _cut(f"{{{', '.join('?' if each is None else _number(each) for each in value)}}}") + unwritten


def _number(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else repr(value)


def _cut(text: str) -> str:
    return text if len(text) <= MAX_TEXT else f"{text[: MAX_TEXT - 3]}..."
