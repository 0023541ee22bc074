"""The machine's own thread: runs it at its pace, steps it, goes back, and does between slices what the page asks.

Nobody else touches the machine.  What the page wants is a command in one queue, done when the machine is at rest: after
a slice, or while it is paused.  What the page shows are snapshots, made here and never changed afterwards.

    Page -> `submit(work)`, `resume`, `pause`, `step`, `go_to`   (any thread)
    Engine -> `snapshot`, `trails`, `findings`                   (read by any thread)

While a step holds the firmware between two statements, looks are answered; what would change the run waits for the end
of the slice.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from typing import Final, TypeVar

from emulator.c28x.findings import Finding
from emulator.clock import SYSCLK_HZ
from hil.client.orders import TimedOrder
from hil.machine import FirmwareStopped, Setup, Status, Wall
from hil.pacing import Pacer
from hil.serial_port import SerialPort
from hil.session import Session
from hil.view.checkpoints import BOOT_CYCLES, Input, Moments, Run
from hil.view.commands import Commands
from hil.view.line import EngineLine
from hil.view.probes import Probes
from hil.view.snapshot import (
    Mode,
    Snapshot,
    Trails,
    beams_of,
    believed_pose,
    obstacles_of,
    start_pose,
    trails_of,
)
from hil.view.stepping import Step, Stepper, Where
from hil.view.taps import Taps
from hil.world.robot_params import Pose

#: Real time between two snapshots, and between two looks at the whole paths.
SNAPSHOT_S: Final = 0.045
TRAILS_S: Final = 0.25
#: CHOICE: a moment to go back to is noted by itself this often.
MOMENT_CYCLES: Final = 10 * SYSCLK_HZ

T = TypeVar("T")


class _Given(Exception):
    """Executing again was given up."""


class Engine:
    """One robot in a thread of its own."""

    def __init__(
        self,
        setup: Setup,
        *,
        pace: float | None = 1.0,
        orders: Iterable[TimedOrder] = (),
        open_port: Callable[[], SerialPort | None] = lambda: None,
        record_writers: bool = True,
    ) -> None:
        """`open_port` is called in the machine's thread once it is ready; None: only the page speaks to the robot."""
        self.setup = setup
        self.pace = pace
        self.record_writers = record_writers
        self.moments = Moments()
        self.line = EngineLine(self._send, self._now_s, lambda: self.snapshot.mode is Mode.RUNNING)
        self.probes = Probes()
        self.port: SerialPort | None = None
        #: Why the firmware, or the port, does not go on.
        self.stopped = ""
        self.error: BaseException | None = None
        self.ready = threading.Event()
        self.findings: tuple[Finding, ...] = ()
        self.trails = Trails((), (), Pose(0.0, 0.0, 0.0))
        self.walls: tuple[Wall, ...] = ()
        self.blocks: list[str] = []
        self.snapshot = Snapshot(
            Mode.STARTING, 0, Status(0.0, "", 0.0, 0.0, 0.0, (0.0, 0.0, 0.0)), Pose(0.0, 0.0, 0.0), False, (), (), 0,
            pace, 0.0, 0.0, 0.0, "the firmware is translated and linked",
        )  # fmt: skip
        self._orders = list(orders)
        self._open_port = open_port
        self._commands = Commands()
        self._running = True
        self._wanted: Step | None = None
        self._goal: int | None = None
        self._arrivals: list[Future[None]] = []
        self._ended = False
        self._holding = False
        self._release = False
        self._where: Where | None = None
        self._message = ""
        self._progress = 1.0
        self._scene = 0
        #: From and to, while time is run ahead.
        self._way: tuple[int, int] | None = None
        self._session: Session | None = None
        self._snapshot_due = self._trails_due = 0.0
        self._thread = threading.Thread(target=self._main, name="robot", daemon=True)
        self._run: Run
        self._taps: Taps
        self._stepper: Stepper

    # Any thread

    def start(self) -> None:
        """Begin.  `ready` is set when the robot has started up, or failed to (`error`)."""
        self._thread.start()

    def submit(self, work: Callable[[Run], T], *, changes: bool = False) -> Future[T]:
        """Have `work(run)` done in the machine's thread.  `changes`: it changes the run, so only at rest."""
        return self._commands.put(lambda: work(self._run), changes=changes)

    def act(self, do: str, *values: bytes | str | float) -> Future[None]:
        """Do something to the robot: a method of `checkpoints.Inputs`."""
        return self.submit(lambda _run: self._act(do, *values), changes=True)

    def resume(self) -> Future[None]:
        """Run on."""
        return self._commands.put(self._resume)

    def pause(self) -> Future[None]:
        """Stop the time."""
        return self._commands.put(self._pause)

    def step(self, kind: Step) -> Future[None]:
        """Go on to the next `kind` and stop there."""
        return self._commands.put(lambda: self._step(kind))

    def go_to(self, cycles: int) -> Future[None]:
        """Be at another time: execute again from power-up; a later time is run to at full speed.  Paused there.

        Done when it is there, or was given up.
        """
        arrived: Future[None] = Future()
        self._commands.put(lambda: self._travel_to(cycles, arrived))
        return arrived

    def set_pace(self, pace: float | None) -> Future[None]:
        """Virtual per real time; None: as fast as possible."""
        Pacer(pace)  # a wrong pace is refused here and now
        return self._commands.put(lambda: self._set_pace(pace))

    def note(self, label: str) -> Future[None]:
        """Remember this moment."""
        return self._commands.put(lambda: self.moments.note(self._run.clock.now, label))

    def close(self) -> None:
        """End the thread and release the machine."""
        if self._thread.is_alive():
            self._commands.put(self._end)
            self._thread.join(timeout=20.0)

    def _send(self, data: bytes) -> None:
        self.submit(lambda _run: self._send_now(data), changes=True)

    def _now_s(self) -> float:
        return self._run.clock.now / SYSCLK_HZ

    # The machine's thread

    def _main(self) -> None:
        try:
            self._begin()
            self.ready.set()
            while not self._ended:
                if self._goal is not None:
                    self._travel(self._goal)
                    self._arrive()
                elif (self._running or self._wanted is not None) and not self.stopped:
                    self._stretch()
                else:
                    self._serve(wait=True)
        except BaseException as error:
            self.error = error
        finally:
            self.ready.set()
            self._close()

    def _begin(self) -> None:
        self._take(Run(self.setup))
        self._reach(BOOT_CYCLES, "start-up")
        self._run.plan(self._orders)
        self.port = self._open_port()

    def _take(self, run: Run) -> None:
        """A machine that has not been powered up yet, with everything that looks at it."""
        self._run = run
        self.walls = tuple(run.walls)
        self.blocks = list(run.bench.board.blocks)
        self._taps = Taps(run.bench)
        self._taps.set(recording=self.record_writers)
        self._stepper = Stepper(run.bench, self._taps, self._hold, self._rest)
        self.line.log.clear()
        self._session = None
        run.on_uart = self.line.byte
        run.on_ahead = self._done_again
        run.on_new_future = self.moments.forget_after
        self.probes.attach(run.bench, self._taps)
        self._scene += 1
        self.stopped = ""
        self._where = None

    def _reach(self, cycles: int, why: str) -> None:
        """Power up and run to `cycles` at full speed."""
        run = self._run
        self._progress, self._message = 0.0, why
        began = time.monotonic()

        def progress(share: float) -> None:
            self._progress = share
            self._serve()
            self._publish_when_due()
            if self._ended or (self._release and self.ready.is_set()):  # a start-up is never given up half way
                raise _Given

        self._release = False
        self._holding = True  # nothing is done to it from outside while the past is executed
        try:
            run.bench.power_up()
            run.reach(cycles, progress)
            self._message = "" if why == "start-up" else f"executed again in {time.monotonic() - began:.1f} s"
        except _Given:
            self._message = "stopped on the way"
        except FirmwareStopped as reason:
            self._stop(reason)
        finally:
            self._holding = self._release = False
            self._progress = 1.0
        self._publish()
        self._look_at_trails()

    def _travel(self, cycles: int) -> None:
        self._goal = None
        self._running = False
        old = self._run
        if cycles > old.clock.now and not self.stopped:
            self._forward(cycles)
            return
        self._progress, self._message = 0.0, "the firmware is translated and linked again"
        self._publish(Mode.REPLAYING)
        run = old.again()
        old.close()
        self._take(run)
        self._reach(cycles, f"executing again up to {cycles / SYSCLK_HZ:.3f} s")

    def _arrive(self) -> None:
        if self._goal is None:
            for arrived in self._arrivals:
                arrived.set_result(None)
            self._arrivals.clear()

    def _forward(self, cycles: int) -> None:
        self._message, self._progress = "running ahead at full speed", 0.0
        session = self._open_session(None)
        self._running = True
        self._way = (self._run.clock.now, cycles)
        try:
            session.run((cycles - self._run.clock.now) / SYSCLK_HZ)
        except (FirmwareStopped, OSError, ValueError) as reason:
            self._stop(reason)
        finally:
            self._way = None
            self._running = False
            self._progress, self._message = 1.0, ""
        self._publish()

    def _stretch(self) -> None:
        """Run until something else is wanted."""
        self._where = None
        if self._wanted is not None:
            self._stepper.arm(self._wanted)
        session = self._open_session(None if self._wanted is not None else self.pace)
        try:
            session.run()
        except (FirmwareStopped, OSError, ValueError) as reason:
            self._stop(reason)
        finally:
            if self._wanted is None:
                self._stepper.disarm()
        self._publish()

    def _open_session(self, pace: float | None) -> Session:
        self._release = False
        self._session = Session(self._run, self.port, Pacer(pace), tick=self._tick, wire=_Tee(self))
        return self._session

    def _tick(self, session: Session) -> None:
        """After each slice, the machine at rest."""
        now = self._run.clock.now
        if self._way is not None:
            begin, end = self._way
            self._progress = min(0.999, (now - begin) / max(1, end - begin))
        self._serve()
        self._publish_when_due()
        last = self.moments.all[-1].cycles
        if now - last >= MOMENT_CYCLES:
            self.moments.note(now, "")
        if self._ended or self._goal is not None or self._release or not (self._running or self._stepper.armed):
            session.stop()

    def _stop(self, reason: BaseException) -> None:
        self._stepper.disarm()
        self._wanted = None
        self._running = False
        self.stopped = str(reason)

    def _close(self) -> None:
        if self.port is not None:
            self.port.close()
        run = getattr(self, "_run", None)
        if run is not None:
            run.close()
        self._commands.cancel()

    # Commands

    def _serve(self, *, wait: bool = False) -> None:
        """Do what was asked for; at rest, what waited for it too."""
        if self._commands.serve(at_rest=not self._holding, wait=wait):
            self._snapshot_due = 0.0
        if not self._running and not self._stepper.armed:
            self._publish_when_due()

    def _act(self, do: str, *values: bytes | str | float) -> None:
        self._run.act(do, *values)
        if do != "order":
            self._scene += 1

    def _done_again(self, each: Input) -> None:
        if each.do == "order":
            self.line.log.sent(bytes(each.values[0]), self._now_s())  # type: ignore[arg-type]
        else:
            self._scene += 1

    def _send_now(self, data: bytes) -> None:
        session = self._session
        if session is not None:
            session.feed(data)
        else:
            self._act("order", data)
            self.line.log.sent(data, self._now_s())

    def _resume(self) -> None:
        self._running = True
        self._wanted = None
        self._stepper.disarm()
        self._release = True
        self._message = ""

    def _pause(self) -> None:
        if self._where is not None and self._holding:
            return  # it stands already
        self._running = False
        self._wanted = None
        self._stepper.disarm()
        self._release = True

    def _step(self, kind: Step) -> None:
        self._running = False
        self._wanted = kind
        self._message = ""
        if self._holding and self._where is not None:
            self._stepper.arm(kind)
            self._where = None
        else:
            self._release = True

    def _travel_to(self, cycles: int, arrived: Future[None]) -> None:
        self._arrivals.append(arrived)
        self._running = False
        self._wanted = None
        self._stepper.disarm()
        self._release = True
        self._goal = max(0, cycles)

    def _set_pace(self, pace: float | None) -> None:
        self.pace = pace
        self._release = self._running

    def _end(self) -> None:
        self._ended = True
        self._release = True
        self._stepper.disarm()

    # Steps

    def _hold(self, where: Where) -> None:
        """The firmware stands between two statements, on its own stack, until somebody goes on."""
        self._where = where
        self._holding, self._release = True, False
        self._publish()
        try:
            while self._where is not None and not self._release:
                self._serve(wait=True)
        finally:
            self._holding = False
        # A held place that is left by anything but a further step ends the slice soon.
        if not self._stepper.armed:
            self._wanted = None
            self._run.bench.board.kernel.pause()

    def _rest(self, where: Where) -> None:
        self._where = where
        self._wanted = None
        self._running = False

    # What the page sees

    def _publish_when_due(self) -> None:
        now = time.monotonic()
        if now >= self._snapshot_due:
            self._publish()
        if now >= self._trails_due:
            self._trails_due = now + TRAILS_S
            self._look_at_trails()

    def _look_at_trails(self) -> None:
        self.trails = trails_of(self._run)
        self.findings = tuple(self._run.findings)

    def _publish(self, mode: Mode | None = None) -> None:
        run, session = self._run, self._session
        self._snapshot_due = time.monotonic() + SNAPSHOT_S
        if mode is None:
            mode = self._mode()
        pacer = session.pacer if session is not None and mode is Mode.RUNNING else None
        self.snapshot = Snapshot(
            mode, run.clock.now, run.status(), believed_pose(run), run.bench.world.bumper_pressed, beams_of(run),
            obstacles_of(run), self._scene, self.pace, pacer.ratio(run.clock.now) if pacer else 0.0,
            pacer.lag.last_s * 1e3 if pacer else 0.0, self._progress, self.stopped or self._message, self._where,
            sum(not each.scripted for each in run.ahead), len(run.findings),
        )  # fmt: skip

    def _mode(self) -> Mode:
        if self.stopped:
            return Mode.STOPPED
        if self._progress < 1.0:
            return Mode.REPLAYING if self.ready.is_set() else Mode.STARTING
        if self._holding:
            return Mode.HELD
        return Mode.RUNNING if self._running else Mode.PAUSED

    # For panels

    @property
    def taps(self) -> Taps:
        """Of the present machine; only for work that is submitted."""
        return self._taps

    def start_pose(self) -> Pose:
        """Where the robot's own frame lies in the world."""
        return start_pose(self._run)


class _Tee:
    """The line's log, and the steps that wait for a frame."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def to_robot(self, data: bytes, time_ns: int) -> None:
        self._engine.line.to_robot(data, time_ns)

    def from_robot(self, data: bytes, time_ns: int) -> None:
        self._engine.line.from_robot(data, time_ns)
        if data == b"\r":
            self._engine._stepper.frame_sent()
