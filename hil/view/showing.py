"""Snapshots and paths for the page: made in the machine's thread, immutable afterwards."""

from __future__ import annotations

import time
from dataclasses import dataclass
from enum import Enum
from typing import Any, Final

from emulator.c28x.findings import Finding
from hil.faces import face_values
from hil.faults.all import unsuitable
from hil.session import Session
from hil.view.checkpoints import RewindableRun
from hil.view.snapshot import Mode, Snapshot
from hil.view.stepping import StepEnd

#: Real time between two snapshots, and between two looks at the whole paths.
SNAPSHOT_S: Final = 0.045
TRAILS_S: Final = 0.25


class MarkKind(Enum):
    """The kind of a mark on the scrub bar."""

    ORDER = "order"
    HAND = "hand"
    WORLD = "world"


@dataclass(frozen=True, slots=True)
class Mark:
    """An input, or an event of the world, at `cycles`."""

    cycles: int
    kind: MarkKind
    text: str


class PublishedState:
    """The latest snapshot, paths and marks.  The machine's thread sets them, any thread may read them."""

    def __init__(self, pace: float | None) -> None:
        self.findings: tuple[Finding, ...] = ()
        #: What the stage has of that kind; None: there is only the board.
        self.trails: Any = None
        self.blocks: list[str] = []
        #: What was done and what happened, references of driving by hand left out; what lies ahead too.
        self.marks: tuple[Mark, ...] = ()
        #: The latest time that the run has reached, or will by what lies ahead.
        self.known_cycles = 0
        #: The findings, with those of the earlier run that lie ahead.
        self.known_findings: tuple[Finding, ...] = ()
        #: Kinds of faults that it cannot have, and why.
        self.unsuitable: dict[str, str] = {}
        self.snapshot = Snapshot(
            Mode.STARTING, 0, None, 0, (), pace, 0.0, 0.0, 0.0, "the firmware is translated and linked"
        )
        #: What is being done, and how far it is: 0..1.
        self.message = ""
        self.progress = 1.0
        #: Where the last step stopped.
        self.where: StepEnd | None = None
        #: Grows whenever something was done to the world, or the run itself is another.
        self.changes = 0
        self._snapshot_due = self._trails_due = 0.0

    def take(self, run: RewindableRun) -> None:
        """Show another machine from now on."""
        self.blocks = list(run.bench.board.blocks)
        self.unsuitable = unsuitable(run.bench)
        self.changes += 1
        self.where = None

    def make_due(self) -> None:
        """Make the next snapshot due at once, because something was done."""
        self._snapshot_due = 0.0

    def due(self) -> bool:
        """Whether the next snapshot is due."""
        return time.monotonic() >= self._snapshot_due

    def publish(
        self, run: RewindableRun, mode: Mode, pace: float | None, stopped: str, session: Session | None
    ) -> None:
        """Publish a new snapshot; `session` is the one that runs the machine at its pace, if there is one."""
        self._snapshot_due = time.monotonic() + SNAPSHOT_S
        self.known_cycles = max(self.known_cycles, run.clock.now)
        pacer = session.pacer if session is not None and mode is Mode.RUNNING else None
        self.snapshot = Snapshot(
            mode, run.clock.now, None if run.stage is None else run.stage.look(), self.changes,
            face_values(run.bench.board), pace, pacer.ratio(run.clock.now) if pacer else 0.0,
            pacer.lag.last_s * 1e3 if pacer else 0.0, self.progress, stopped or self.message, self.where,
            sum(not each.scripted for each in run.ahead), len(run.findings),
            tuple((each.report(), each.phase) for each in run.bench.faults), run.pending_to_robot,
        )  # fmt: skip
        if time.monotonic() >= self._trails_due:
            self.look_at_paths(run)

    def look_at_paths(self, run: RewindableRun) -> None:
        """Publish the whole paths and findings again."""
        self._trails_due = time.monotonic() + TRAILS_S
        self.trails = None if run.stage is None else run.stage.trails()
        self.findings = tuple(run.findings)
        later = (each for each in self.known_findings if each.time_cycles > run.clock.now)
        self.known_findings = (*self.findings, *later)
        marks = marks_of(run)
        if marks != self.marks:
            self.marks = marks
            self.known_cycles = max(self.known_cycles, *(each.cycles for each in marks), 0)

    def forget_after(self, cycles: int) -> None:
        """Forget what was known after this time: another input was given."""
        self.known_cycles = cycles
        self.known_findings = tuple(each for each in self.known_findings if each.time_cycles <= cycles)


def marks_of(run: RewindableRun) -> tuple[Mark, ...]:
    """The marks of a run on the scrub bar, besides its findings."""
    done = [
        Mark(each.cycles, MarkKind.ORDER if each.do == "order" else MarkKind.HAND, each.text)
        for each in (*run.done, *run.ahead)
        if not (each.do == "order" and bytes(each.values[0]).startswith(b"#SETR"))  # type: ignore[arg-type]
    ]
    happened = () if run.stage is None else run.stage.happened
    return (*done, *(Mark(cycles, MarkKind.WORLD, text) for cycles, text in happened))
