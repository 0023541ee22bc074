"""The robot that does not exist: board, firmware, world, assembled and run in virtual time.

    bench = Bench(Setup(world="corridor", seed=1))
    bench.boot()
    bench.feed(b"#MISN\\r")
    bench.run_until(bench.clock.now + 60 * SYSCLK_HZ)

One setup is one run: two benches of the same setup give the same bytes and the same trace.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from math import nan
from typing import Final

from emulator.c28x.coverage import Coverage
from emulator.c28x.runtime import EndlessPoll, IllegalCall, UninitialisedRead
from emulator.clock import SYSCLK_HZ, seconds, us
from emulator.cpu import InterruptStorm
from emulator.image import Firmware
from emulator.signal import Signal
from emulator.signals import SerialFrame
from emulator.sysbios.core import KernelError
from emulator.sysbios.statistics import TaskStatistics
from firmware_model import c_files
from firmware_model.image import link
from hil.machine import (
    START_UP,
    Circle,
    CpuUse,
    FirmwareStopped,
    PathPoint,
    Setup,
    Status,
    TaskTimes,
    Wall,
    fault_of_ours,
)
from hil.robot.board import XBEE_TX_GPIO, RobotBoard
from hil.robot.mounting import mounted
from hil.tolerance import tasks_of
from hil.world.maps import WorldMap, load_map
from hil.world.path import Path

#: Start-up: Init_GYRO waits 100 times 20 ms at priority 5, so everything below starts after 2 s (TFG annex 1).  The
#: eight releases of TaskODO that piled up meanwhile then run at once and rewrite the frame that is being sent.
BOOT_S: Final = 2.2
_SLICE_CYCLES: Final = SYSCLK_HZ // 20


@contextmanager
def _stopping() -> Iterator[None]:
    """What ends the firmware for good, as one kind of error with the note of who it was.

    So is an error of ours in what the firmware does (the kernel notes who it was); any other is the caller's.
    """
    try:
        yield
    except (UninitialisedRead, EndlessPoll, IllegalCall, InterruptStorm, KernelError, RecursionError) as error:
        who = "; ".join(getattr(error, "__notes__", []))
        raise FirmwareStopped(f"{error} ({who})" if who else str(error)) from error
    except Exception as error:
        who = "; ".join(getattr(error, "__notes__", []))
        if not who:
            raise
        raise FirmwareStopped(f"{fault_of_ours(error)} ({who})") from error


class Bench:
    """A robot with its world.  Implements `hil.machine.Machine`.

    `traced` keeps the digest of every kernel event; without it the run is a little faster and `trace_sha256` is empty.
    `world_map` is the setup's world as it was read before, whatever its file holds by now.  `coverage` takes up how
    often each statement of the firmware is begun.
    """

    def __init__(
        self, setup: Setup | None = None, *, traced: bool = True, world_map: WorldMap | None = None,
        coverage: Coverage | None = None, steps: bool = False,
    ) -> None:  # fmt: skip
        self.setup = setup = setup or Setup()
        self.map = world_map or load_map(setup.world)
        self.board = board = RobotBoard(seed=setup.seed, ideal=not setup.realistic, xbee=setup.xbee)
        self.firmware: Firmware = link(
            board, fill=setup.fill, divide=setup.divide, float_division=setup.float_division, fixes=setup.fixes,
            watch=setup.watch, static=setup.static,
            firmware=setup.firmware, include=setup.include, defines=setup.defines,
            coverage=coverage, steps=steps,
        )  # fmt: skip
        self.clock = board.clock
        self.findings = board.findings
        self.world = mounted(board, self.map, setup.seed if setup.realistic else None)
        #: (byte, end_cycles): the PC has a byte of the robot.
        self.uart_sent: Signal[int, int] = Signal()
        board.link.received.connect(self._received)
        board.serial_pins[XBEE_TX_GPIO].sent.connect(self._sent)
        self._uart = hashlib.sha256()
        if traced:
            board.trace.keep_digest()
        #: Where the firmware believed to be, a point a frame, in the frame it starts in.
        self.odometry = Path()
        self._statistics: TaskStatistics | None = None
        self._booted = False

    # Running

    def boot(self, progress: Callable[[float], None] | None = None) -> None:
        """Power up and run the 2.2 s of start-up at full speed; `progress` is told a fraction 0..1."""
        self.power_up()
        end = int(BOOT_S * SYSCLK_HZ)
        while self.clock.now < end:
            self.run_until(min(self.clock.now + _SLICE_CYCLES, end))
            if progress is not None:
                progress(min(1.0, self.clock.now / end))

    def power_up(self) -> None:
        """Power up only: the firmware's main has started the kernel, or has had a slice of time.

        `boot` begins with this.
        """
        if self._booted:
            raise ValueError("the robot has booted already; make a new Bench for a new power-up")
        self._booted = True
        kernel, clock = self.board.kernel, self.clock
        pause = clock.after(_SLICE_CYCLES, kernel.pause)
        with _stopping():
            kernel.start(self.firmware.function("main_robot.main"))
        clock.cancel(pause)

    def run_until(self, cycles: int) -> None:
        """Run to an absolute time in cycles.  Raises FirmwareStopped when the firmware does not run on."""
        with _stopping():
            self.board.kernel.run_until(cycles)

    def run_for(self, duration_s: float) -> None:
        """Run for a stretch of virtual time."""
        self.run_until(self.clock.now + round(duration_s * SYSCLK_HZ))

    def close(self) -> None:
        """End the kernel's tasks."""
        self.board.kernel.shutdown()

    # The line

    def feed(self, data: bytes) -> None:
        """Queue bytes for the robot; the line takes them at its own baud."""
        self.board.link.feed(data)

    @property
    def pending_to_robot(self) -> int:
        """How many bytes were fed and are not on the wire yet."""
        return self.board.link.pending_to_robot

    def _received(self, data: bytes, cycles: int) -> None:
        for byte in data:
            self.uart_sent.emit(byte, cycles)

    def _sent(self, frame: SerialFrame) -> None:
        self._uart.update(bytes((frame.data & 0xFF,)))
        if frame.data == 0x0D and self._tells("ROBOT_Odometry_T"):
            believed = self.firmware.servidores.ROBOT_Odometry_T
            # The firmware's X and Y are millimetres; its angle is in radians.
            self.odometry.add(seconds(self.clock.now), believed.X / 1000.0, believed.Y / 1000.0, believed.tita)

    # Looking

    @property
    def uart_sha256(self) -> str:
        """Digest of every byte the robot sent since power-up."""
        return self._uart.hexdigest()

    @property
    def trace_sha256(self) -> str:
        """Digest of the trace since power-up: task switches, posts, ticks, interrupts, with their cycle.

        "" if it is not kept.
        """
        return self.board.trace.sha256

    @property
    def walls(self) -> Sequence[Wall]:
        """The world's walls as pairs of points in metres."""
        return [((w.ax, w.ay), (w.bx, w.by)) for w in self.map.walls]

    @property
    def posts(self) -> Sequence[Circle]:
        """The world's round obstacles as (x, y, radius) in metres."""
        return [(post.x_m, post.y_m, post.radius_m) for post in self.world.posts]

    def _tells(self, *names: str) -> bool:
        """Whether servidores.c has these objects: one of somebody else's may keep the robot's state elsewhere."""
        return all(hasattr(self.firmware.servidores, name) for name in names)

    def status(self) -> Status:
        """What the robot believes and where it is."""
        servers = self.firmware.servidores
        pose = self.world.pose
        state, distances = "unknown", (nan, nan, nan)
        if not self.board.kernel.started:
            state = START_UP
        elif self._tells("ROBOT_Status"):
            state = self.firmware.robot_types.STATUS.name(servers.ROBOT_Status)
        if self._tells("ROBOT_df", "ROBOT_dr", "ROBOT_dl"):
            distances = (servers.ROBOT_df, servers.ROBOT_dr, servers.ROBOT_dl)
        return Status(
            seconds(self.clock.now), state, pose.x_m, pose.y_m, pose.heading_rad, distances, len(self.findings)
        )

    def true_path(self) -> Sequence[PathPoint]:
        """Where the robot really was, in the world's frame."""
        return [PathPoint(*point) for point in self.world.path.points()]

    def odometry_path(self) -> Sequence[PathPoint]:
        """Where the firmware believed to be, in the frame it starts in."""
        return [PathPoint(*point) for point in self.odometry.points()]

    def measure_tasks(self) -> TaskStatistics:
        """Start measuring task times now."""
        if self._statistics is None:
            self._statistics = TaskStatistics()
            self.board.trace.read(self._statistics)
        self._statistics.reset(self.clock.now)
        return self._statistics

    def task_statistics(self) -> CpuUse:
        """Task times and CPU load since `measure_tasks` (or nothing, if nobody measured)."""
        statistics = self._statistics
        if statistics is None:
            return CpuUse()
        rows = []
        for task in self.board.kernel.tasks.all:
            activity = statistics.tasks.get(task.name)
            if activity is None or activity.computation.count == 0:
                continue
            computation, response = activity.computation, activity.response
            rows.append(
                TaskTimes(
                    task.name, task.priority, computation.count, us(computation.minimum or 0), us(computation.mean),
                    us(computation.maximum or 0), us(response.maximum or 0),
                )
            )  # fmt: skip
        own = tasks_of(
            c_files.own(self.setup.firmware).files, self.firmware.linked.program.modules.values(),
            [row.task for row in rows],
        )  # fmt: skip
        return CpuUse(tuple(rows), statistics.busy(self.clock.now), own)
