"""The robot that does not exist: board, firmware, world, assembled and run in virtual time.

    bench = Bench("corridor", seed=1)
    bench.boot()
    bench.feed("#MISN\\r")
    bench.run_for(60.0)
    bench.plot()

One setup is one run: two benches of the same setup give the same bytes and the same trace.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import nan
from typing import TYPE_CHECKING, Any, ClassVar, Final, cast

from emulator import compiled
from emulator.c28x.coverage import Coverage
from emulator.clock import SYSCLK_HZ, seconds
from emulator.signals import SerialFrame
from firmware_model import c_files
from firmware_model.image import link
from hil.board import Board, load, made, optional
from hil.client.decode import OdometryFrame
from hil.faces import parse_all
from hil.machine import START_UP, Circle, PathPoint, Setup, Status, Wall
from hil.robot.board import RobotBoard
from hil.robot.mounting import mounted
from hil.robot.sent_frames import FrameRow, SentFrames
from hil.running import RunningBoard
from hil.tolerance import tasks_of
from hil.world.maps import WorldMap, load_map
from hil.world.path import Path

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from hil.feeds import DeclaredFeed

#: Start-up: Init_GYRO waits 100 times 20 ms at priority 5, so everything below starts after 2 s (TFG annex 1).  The
#: eight releases of TaskODO that piled up meanwhile then run at once and rewrite the frame that is being sent.
BOOT_S: Final = 2.2
_SLICE_CYCLES: Final = SYSCLK_HZ // 20


class Bench(RunningBoard):
    """A robot with its world.  Implements `hil.machine.RobotMachine`.

    `setup` is a `Setup`, or the name of a world; any of its fields can be given by name beside it.

    `traced` keeps the digest of every kernel event; without it the run is a little faster and `trace_sha256` is empty.
    `world_map`, `kind` and `feeds` are the setup's as they were read before, whatever their files hold by now.
    `coverage` takes up how often each statement of the firmware is begun.  `replaceable`: functions of the firmware can
    be replaced (`Linked.replace`), so a compiled build of it is not used.  `awaited` are orders that are given when
    something has happened after start-up: what (`hil.faults.when`), and the bytes.
    """

    FIRST_SLICE_CYCLES: ClassVar[int] = _SLICE_CYCLES
    board: RobotBoard

    def __init__(
        self, setup: Setup | str | None = None, *, traced: bool = True, world_map: WorldMap | None = None,
        coverage: Coverage | None = None, steps: bool = False, replaceable: bool = False,
        kind: type[Board] | None = None,
        feeds: Sequence[DeclaredFeed] | None = None, awaited: Sequence[tuple[str, bytes]] = (), **settings: Any,
    ) -> None:  # fmt: skip
        self.setup = setup = Setup.of(setup, **settings)
        self.map = world_map or load_map(setup.world)
        kind = kind or load(setup.board)
        if not issubclass(kind, RobotBoard):
            raise ValueError(f"{kind.__name__} has no wheels and is in no world: hil.running runs it")
        board = made(kind, seed=setup.seed, ideal=not setup.realistic, xbee=setup.xbee, **optional(kind, setup.options))
        firmware = link(
            board, fill=setup.fill, divide=setup.divide, float_division=setup.float_division, fixes=setup.fixes,
            watch=setup.watch, static=setup.static,
            firmware=setup.firmware, include=setup.include, defines=setup.defines,
            coverage=coverage, steps=steps, built=None if replaceable else compiled.part,
        )  # fmt: skip
        super().__init__(
            board, firmware, "main_robot.main", start_up_cycles=int(BOOT_S * SYSCLK_HZ),
            puts=parse_all(setup.put, board), traced=traced,
        )  # fmt: skip
        self.world = mounted(board, self.map, setup.seed if setup.realistic else None)
        #: Where the firmware believed to be, a point a frame, in the frame it starts in.
        self.odometry = Path()
        self._frames = SentFrames()
        self.mount(setup, feeds)
        self.awaited = tuple(awaited)
        if awaited:
            self.clock.schedule(self.start_up_cycles, self._await)

    def _await(self) -> None:
        from hil.faults.effect import FaultTarget
        from hil.faults.when import wait_for

        for what, order in self.awaited:
            wait_for(what, cast(FaultTarget, self), partial(self.feed, order))

    # Running

    def boot(self, progress: Callable[[float], None] | None = None) -> None:
        """Power up and run the 2.2 s of start-up at full speed; `progress` is told a fraction 0..1."""
        self.power_up()
        end = self.start_up_cycles
        while self.clock.now < end:
            self.run_until(min(self.clock.now + _SLICE_CYCLES, end))
            if progress is not None:
                progress(min(1.0, self.clock.now / end))

    def _sent(self, frame: SerialFrame) -> None:
        super()._sent(frame)
        self._frames.add(frame.data & 0xFF, seconds(self.clock.now))
        if frame.data == 0x0D and self._has_objects("ROBOT_Odometry_T"):
            believed = self.firmware.servidores.ROBOT_Odometry_T
            # The firmware's X and Y are millimetres; its angle is in radians.
            self.odometry.add(seconds(self.clock.now), believed.X / 1000.0, believed.Y / 1000.0, believed.tita)

    # Looking

    def __repr__(self) -> str:
        status = self.status()
        return (
            f"<Bench {self.setup.world}, seed {self.setup.seed}: {status.state} at {status.virtual_s:.3f} s, "
            f"x {status.x_m:.3f} m, y {status.y_m:.3f} m, {status.findings} findings>"
        )

    def frames(self) -> list[FrameRow]:
        """The frames that it has sent, a row each: `pandas.DataFrame(bench.frames())`."""
        return self._frames.rows()

    def plot(self) -> Figure:
        """The drive up to now: walls, true path, odometry, and what the sonars saw.  A notebook shows it."""
        from hil.robot.picture import drive_of

        frames = ((row.time_s, OdometryFrame(*row[1:])) for row in self.frames())
        return drive_of(self, frames, f"{self.setup.world}, {seconds(self.clock.now):.1f} s, seed {self.setup.seed}")

    @property
    def read(self) -> dict[str, Any]:
        """What was read of files for it: its board, what it is fed with, its map, orders that wait."""
        return {**super().read, "world_map": self.map, "awaited": self.awaited}

    @property
    def walls(self) -> Sequence[Wall]:
        """The world's walls as pairs of points in metres."""
        return [((w.ax, w.ay), (w.bx, w.by)) for w in self.map.walls]

    @property
    def posts(self) -> Sequence[Circle]:
        """The world's round obstacles as (x, y, radius) in metres."""
        return [(post.x_m, post.y_m, post.radius_m) for post in self.world.posts]

    def _has_objects(self, *names: str) -> bool:
        """Whether servidores.c has these objects: one of somebody else's may keep the robot's state elsewhere."""
        return all(hasattr(self.firmware.servidores, name) for name in names)

    def status(self) -> Status:
        """What the robot believes and where it is."""
        servers = self.firmware.servidores
        pose = self.world.pose
        state, distances = "unknown", (nan, nan, nan)
        if not self.board.kernel.started:
            state = START_UP
        elif self._has_objects("ROBOT_Status"):
            state = self.firmware.robot_types.STATUS.name(servers.ROBOT_Status)
        if self._has_objects("ROBOT_df", "ROBOT_dr", "ROBOT_dl"):
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

    def of_own_c(self, tasks: Sequence[str]) -> frozenset[str]:
        """Those of the tasks that run a C file of the user's."""
        own = c_files.own(self.setup.firmware).files
        return tasks_of(own, self.firmware.linked.program.modules.values(), tasks)
