"""What the page sees of the machine: snapshots and paths, made in the machine's thread and never changed afterwards."""

from __future__ import annotations

import time
from typing import Final

from emulator.c28x.findings import Finding
from hil.machine import Status, Wall
from hil.session import Session
from hil.view.checkpoints import Run
from hil.view.snapshot import (
    Mode,
    Snapshot,
    Trails,
    beams_of,
    believed_pose,
    obstacles_of,
    trails_of,
)
from hil.view.stepping import Where
from hil.world.robot_params import Pose

#: Real time between two snapshots, and between two looks at the whole paths.
SNAPSHOT_S: Final = 0.045
TRAILS_S: Final = 0.25


class Showing:
    """The last of each, for readers in any thread; what it says besides the run is set by the machine's thread."""

    def __init__(self, pace: float | None) -> None:
        self.findings: tuple[Finding, ...] = ()
        self.trails = Trails((), (), Pose(0.0, 0.0, 0.0))
        self.walls: tuple[Wall, ...] = ()
        self.blocks: list[str] = []
        self.snapshot = Snapshot(
            Mode.STARTING, 0, Status(0.0, "", 0.0, 0.0, 0.0, (0.0, 0.0, 0.0)), Pose(0.0, 0.0, 0.0), False, (), (), 0,
            pace, 0.0, 0.0, 0.0, "the firmware is translated and linked",
        )  # fmt: skip
        #: What is being done, and how far it is: 0..1.
        self.message = ""
        self.progress = 1.0
        #: Where the last step stopped.
        self.where: Where | None = None
        #: Grows whenever walls, obstacles or the run itself are others.
        self.scene = 0
        self._snapshot_due = self._trails_due = 0.0

    def take(self, run: Run) -> None:
        """Another machine is shown from now on."""
        self.walls = tuple(run.walls)
        self.blocks = list(run.bench.board.blocks)
        self.scene += 1
        self.where = None

    def make_due(self) -> None:
        """Something was done that should be seen at once."""
        self._snapshot_due = 0.0

    def due(self) -> bool:
        """Whether the next snapshot is due."""
        return time.monotonic() >= self._snapshot_due

    def publish(self, run: Run, mode: Mode, pace: float | None, stopped: str, session: Session | None) -> None:
        """A new snapshot; `session` is what runs it at its pace, if one does."""
        self._snapshot_due = time.monotonic() + SNAPSHOT_S
        pacer = session.pacer if session is not None and mode is Mode.RUNNING else None
        self.snapshot = Snapshot(
            mode, run.clock.now, run.status(), believed_pose(run), run.bench.world.bumper_pressed, beams_of(run),
            obstacles_of(run), self.scene, pace, pacer.ratio(run.clock.now) if pacer else 0.0,
            pacer.lag.last_s * 1e3 if pacer else 0.0, self.progress, stopped or self.message, self.where,
            sum(not each.scripted for each in run.ahead), len(run.findings), run.pending_to_robot,
        )  # fmt: skip
        if time.monotonic() >= self._trails_due:
            self.look_at_paths(run)

    def look_at_paths(self, run: Run) -> None:
        """The whole paths and findings anew."""
        self._trails_due = time.monotonic() + TRAILS_S
        self.trails = trails_of(run)
        self.findings = tuple(run.findings)
