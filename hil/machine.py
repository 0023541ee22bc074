"""What the outside needs of a board that runs: the `Machine` protocol; of one that is a robot in a world, more.

Serial ports, pacing, plots and the command line are written against these.  `hil.running.RunningBoard` is a machine,
`hil.bench.Bench` the robot; the tests drive a small scripted one.  Times are SYSCLK cycles of the machine's own clock.
"""

from __future__ import annotations

import os
import traceback
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, fields, replace
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol, runtime_checkable

from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.seed import check_seed

if TYPE_CHECKING:
    from emulator.c28x.findings import Findings
    from emulator.clock import Clock
    from emulator.signal import Signal

#: The state of a robot whose `main` has not started the kernel yet.
START_UP: Final = "start-up"


#: How the sentence about an error of this tool begins.
INTERNAL_ERROR: Final = "an error of this tool"
FAULT_OF_THE_BOARD: Final = "an error of the board"


class FirmwareStopped(Exception):
    """The firmware does not run on, and why, in one line: a trapped read, a poll that nothing can end, a storm of
    interrupts, an abort of the kernel.
    """


def internal_error(error: Exception, board_file: str = "") -> str:
    """What a report says where this tool itself failed while firmware ran: what was found before is told all the same.

    An error behind a line of `board_file` is that board's, whose file a user wrote.  With `HIL_TRACEBACK` in the
    environment the error goes on, for those who look for the defect.
    """
    if os.environ.get("HIL_TRACEBACK"):
        raise error
    frames = traceback.extract_tb(error.__traceback__)
    of_board = [frame for frame in frames if frame.filename == board_file]
    where = (of_board or frames)[-1:]
    at = f" in {Path(where[0].filename).name}:{where[0].lineno}" if where else ""
    what = f"{type(error).__name__}: {error}"
    whose = FAULT_OF_THE_BOARD if of_board else INTERNAL_ERROR
    return f"{whose}{at}, not of the firmware: {what}; HIL_TRACEBACK=1 shows it whole"


#: What a field of a setup takes, in words.
_EXPECTED: Final = {str: "a text", int: "a whole number", bool: "True or False", tuple: "a text, or several"}


@dataclass(frozen=True, slots=True)
class Setup:
    """Everything that determines a run: two machines of one setup give the same bytes and the same trace."""

    #: Name of a built-in world (corridor, room, box, paddock) or path of a TOML map; nothing to a board without wheels.
    world: str = "corridor"
    seed: int = 1
    #: What never-written memory holds: zero, ones, nan, random:SEED, stack, trap.
    fill: str = "zero"
    #: Devices with noise, bounce, slip and loss, or without.
    realistic: bool = True
    #: What dividing floats gives: ieee, or nr (the chip's Newton-Raphson iteration).
    divide: str = "ieee"
    #: How long dividing floats takes, by how the C is built: calibrated, tmu, fast, standard.
    float_division: str = DEFAULT_FLOAT_DIVISION
    #: Put the XBee pair between SCI and port; False is a wire.
    xbee: bool = False
    #: Corrections of the catalogue that are linked in, or "all".
    fixes: tuple[str, ...] = ()
    #: Watch who touches which object under which gate, and what else only costs when wanted.
    watch: bool = False
    #: Look at the typed tree of the firmware before it runs.
    static: bool = False
    #: Of the robot: its own C files, or folders with them, in the place of the modules that mirror them.  Of another
    #: board: the driver files of a program with a `main`.
    firmware: tuple[str, ...] = ()
    #: Folders of headers and macros (`NAME`, `NAME=VALUE`) for C files.
    include: tuple[str, ...] = ()
    defines: tuple[str, ...] = ()
    #: Name of a board that comes with the tool (robot, bare), or path of a Python file with one.
    board: str = "robot"
    #: What is set of parts from outside, as `hil.faces.parse` reads it: `infrared.distance_m=0.4`.
    put: tuple[str, ...] = ()
    #: Parts that the board has on demand: of the robot those of `hil/robot/options`.
    options: tuple[str, ...] = ()
    #: What breaks on purpose, as `hil.faults.parse` reads it: `gyro-reset:at=2`.
    faults: tuple[str, ...] = ()
    #: What inputs see instead of the physics, as `hil.feeds.load` reads it: `gyro.yaw_rate_rad_s=drive.csv,linear`.
    feeds: tuple[str, ...] = ()

    @classmethod
    def of(cls, setup: Setup | str | None = None, **settings: Any) -> Setup:
        """A setup, or a world by its name, with some of its fields said anew.  A text stands for a tuple of it alone.

        Raises TypeError for a field that there is not, or a value of another type, and ValueError for a seed outside
        of its range.
        """
        if isinstance(setup, str):
            settings = {"world": setup, **settings}
            setup = None
        elif not isinstance(setup, Setup | None):
            raise TypeError(f"{setup!r}: expected a Setup, or the name of a world")
        known = {field.name: field.default for field in fields(cls)}
        for name, value in settings.items():
            if name not in known:
                alike = get_close_matches(name, known, n=1)
                hint = f"did you mean {alike[0]}?" if alike else f"it has {', '.join(known)}"
                raise TypeError(f"a setup has no {name!r}: {hint}")
            wanted = type(known[name])
            if wanted is tuple and isinstance(value, str):
                settings[name] = (value,)
            elif wanted is tuple and isinstance(value, list):
                settings[name] = tuple(value)
            elif not isinstance(value, wanted) or (wanted is int and isinstance(value, bool)):
                raise TypeError(f"{name}={value!r}: expected {_EXPECTED[wanted]}")
        check_seed(settings.get("seed", 0))
        return replace(setup or cls(), **settings)

    def as_dict(self) -> dict[str, Any]:
        """By name, as logs and reports keep it: options, faults and feeds only where there are some."""
        seldom = ("options", "faults", "feeds")
        return {name: value for name, value in asdict(self).items() if value or name not in seldom}


@dataclass(frozen=True, slots=True)
class Status:
    """A glance at the machine: what it believes (state, distances) and where it really is (pose).

    The state is START_UP until its `main` has started the kernel.
    """

    virtual_s: float
    state: str
    x_m: float
    y_m: float
    heading_rad: float
    #: What the firmware last measured, in the frame's order: front, right, left.
    distances_cm: tuple[float, float, float]
    findings: int = 0


@dataclass(frozen=True, slots=True)
class PathPoint:
    """A pose at a virtual time."""

    time_s: float
    x_m: float
    y_m: float
    heading_rad: float


@dataclass(frozen=True, slots=True)
class TaskTimes:
    """Measured times of one task over a run, in microseconds of virtual time."""

    task: str
    priority: int
    activations: int
    computation_min_us: float
    computation_mean_us: float
    computation_max_us: float
    response_max_us: float


@dataclass(frozen=True, slots=True)
class CpuUse:
    """Task times of a run and the share of the processor that was not idle (0..1)."""

    tasks: Sequence[TaskTimes] = ()
    cpu_load: float = 0.0
    #: The tasks among them that run a C file of the user's (`Setup.firmware`).
    of_own_c: frozenset[str] = frozenset()


Circle = tuple[float, float, float]
Wall = tuple[tuple[float, float], tuple[float, float]]


class Machine(Protocol):
    """A board with firmware, driven in virtual time, and through its serial line if it has one to a PC."""

    clock: Clock
    findings: Findings

    @property
    def uart_sent(self) -> Signal[int, int]:
        """(byte, end_cycles): each byte that was sent to the PC, at the end of its stop bit."""

    @property
    def pending_to_robot(self) -> int:
        """How many bytes were fed and are not on the wire yet."""

    @property
    def uart_sha256(self) -> str:
        """Digest of every byte that was sent to the PC since power-up."""

    @property
    def trace_sha256(self) -> str:
        """Digest of the trace since power-up."""

    def boot(self, progress: Callable[[float], None] | None = None) -> None:
        """Power up, and run what start-up there is at full speed, telling `progress` a fraction 0..1."""

    def run_until(self, cycles: int) -> None:
        """Run to an absolute time.  How a stretch is cut into calls does not change what happens in it."""

    def pause(self) -> None:
        """Make `run_until` return at the CPU's next charge.  Safe in a signal handler."""

    def feed(self, data: bytes) -> None:
        """Queue bytes from the PC; the line takes them at its own baud."""

    def measure_tasks(self) -> object:
        """Start measuring task times now."""

    def task_statistics(self) -> CpuUse:
        """Task times and CPU load since `measure_tasks`."""

    def close(self) -> None:
        """Release what the machine holds."""


@runtime_checkable
class RobotMachine(Machine, Protocol):
    """A robot with its world."""

    @property
    def walls(self) -> Sequence[Wall]:
        """The world's walls as pairs of points in metres."""

    @property
    def posts(self) -> Sequence[Circle]:
        """The world's round obstacles as (x, y, radius) in metres."""

    def status(self) -> Status:
        """A glance at the robot."""

    def true_path(self) -> Sequence[PathPoint]:
        """Where the robot really was, in the world's frame."""

    def odometry_path(self) -> Sequence[PathPoint]:
        """Where the firmware believed to be, in the frame it starts in (unrounded)."""
