"""The machine at one moment, for the page: made in the machine's thread, immutable afterwards.

A snapshot must not change the run: it uses stored words and objects, reads no register, and does not integrate the
world.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any

from emulator.clock import seconds
from hil.faces import FaceValue
from hil.session import HOLD_BACK_BYTES
from hil.view.stepping import StepEnd

if TYPE_CHECKING:
    from hil.faults import FaultOutcome
    from hil.faults.effect import Phase


class Mode(Enum):
    """The state of the machine's thread."""

    STARTING = "starting up"
    RUNNING = "running"
    PAUSED = "paused"
    HELD = "held"
    REPLAYING = "executing again"
    STOPPED = "stopped"


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The state of the machine at one moment."""

    mode: Mode
    cycles: int
    #: What the world looks like (`hil.view.stage.StageProtocol.look`); None: there is only the board.
    scene: Any
    #: Grows whenever something was done to the world, or the run itself is another.
    changes: int
    faces: tuple[FaceValue, ...]
    pace: float | None
    reached: float
    lag_ms: float
    progress: float
    message: str = ""
    where: StepEnd | None = None
    ahead: int = 0
    findings: int = 0
    #: What came of each fault so far, in the order in which they were mounted.
    faults: tuple[tuple[FaultOutcome, Phase], ...] = ()
    #: Bytes that wait for the line.
    pending_to_robot: int = 0

    @property
    def takes_orders(self) -> bool:
        """Whether orders sent now are received soon.  At a slow pace the line is slower than a user."""
        return self.mode is Mode.RUNNING and self.pending_to_robot < HOLD_BACK_BYTES

    @property
    def time_s(self) -> float:
        """Virtual time since power-up."""
        return seconds(self.cycles)
