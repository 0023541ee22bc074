"""The machine's own thread: it runs the machine at its pace, steps it, goes back, and executes commands between slices.

No other thread touches the machine.  Other threads put commands into one queue, and they are executed when the machine
is at rest: after a slice, or while it is paused.  While a step holds the firmware between two statements, commands that
only read are executed; commands that change the run wait for the end of the slice.

Everything here runs in that thread; other threads call `engine.Engine`.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.clock import SYSCLK_HZ
from emulator.signal import Signal
from hil.client.orders import TimedOrder
from hil.machine import FirmwareStopped, Machine, Setup
from hil.pacing import Pacer
from hil.serial_port import PortError, SerialPort
from hil.session import Session
from hil.view.checkpoints import CheckpointList, RecordedInput, RewindableRun
from hil.view.commands import Commands
from hil.view.line import LINE_ENDS, EngineLine
from hil.view.probes import Probes
from hil.view.showing import PublishedState
from hil.view.snapshot import Mode
from hil.view.stepping import Step, StepEnd, Stepper
from hil.view.taps import RegisterTaps

#: CHOICE: the interval of automatic checkpoints.
CHECKPOINT_CYCLES: Final = 10 * SYSCLK_HZ
#: The time before a finding from which on each statement is checked.  It is longer than a slice.
BEFORE_CYCLES: Final = SYSCLK_HZ // 100


class _GivenUp(Exception):
    """The repeated execution was given up."""


class MachineThread:
    """One board.  `commands` is the queue of commands from other threads; they only read everything else."""

    def __init__(
        self,
        setup: Setup,
        commands: Commands,
        *,
        pace: float | None,
        orders: Iterable[TimedOrder],
        open_port: Callable[[Machine], SerialPort | None],
        record_writers: bool,
        read: Mapping[str, Any],
    ) -> None:
        self.pace = pace
        self.record_writers = record_writers
        self.showing = PublishedState(pace)
        self.moments = CheckpointList()
        self.probes = Probes()
        self.line = EngineLine(
            self._send_at_rest,
            lambda: self.run.clock.now / SYSCLK_HZ,
            lambda: self.showing.snapshot.takes_orders,
            lambda: self._stepper.frame_sent(),
        )
        #: Set when it has started up, or failed to: then `error` says why.
        self.ready = threading.Event()
        self.error: BaseException | None = None
        #: (): the thread has ended with an `error`; emitted in this thread.
        self.failed: Signal[[]] = Signal()
        #: Why the firmware, or the port, does not go on; empty while it does.
        self.stopped = ""
        self.run: RewindableRun
        self.taps: RegisterTaps
        self._setup = setup
        self._read = read
        self._commands = commands
        self._orders = list(orders)
        self._open_port = open_port
        self._port: SerialPort | None = None
        self._session: Session | None = None
        self._stepper: Stepper
        self._running = True
        self._wanted: Step | None = None
        self._goal: int | None = None
        #: The finding at which the run shall stop.
        self._sought: Finding | None = None
        self._arrivals: list[Future[None]] = []
        self._ended = False
        #: Set before another thread waits for its end.
        self._end_wanted = threading.Event()
        #: Nothing may be done to the machine: the past is executed again, or a step holds it inside a slice.
        self._holding = False
        #: Whether a run, a hold or a repeated execution ends at its next check.
        self._release = False
        #: The first and the last cycle, while the run goes to a later time.
        self._travel_range: tuple[int, int] | None = None
        self._thread = threading.Thread(target=self._main, name="machine", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def join(self) -> None:
        """Wait until it has ended; `end` is the command that ends it.

        A machine that is still being linked has nothing to close: it ends by itself.
        """
        if self._thread.is_alive():
            self._commands.put(self.end)
            self._end_wanted.set()
            if hasattr(self, "run"):
                self.run.pause()
                self._thread.join(timeout=20.0)

    # The loop

    def _main(self) -> None:
        try:
            self._begin()
            self.ready.set()
            while not self._ended:
                if self._goal is not None:
                    self._travel(self._goal)
                    self._seek()
                    self._arrive()
                elif (self._running or self._wanted is not None) and not self.stopped:
                    self._run_until_command()
                else:
                    self._serve(wait=True)
        except BaseException as error:
            self.error = error
        finally:
            self._commands.cancel()
            for arrived in self._arrivals:
                arrived.cancel()
            self.ready.set()
            self._close()
            if self.error is not None:
                self.failed.emit()

    def _begin(self) -> None:
        run = RewindableRun(self._setup, read=self._read)
        self.moments.begin_at(run.bench.start_up_cycles)
        if run.stage is None:
            self.line.log.ends = LINE_ENDS
        self._take(run)
        if self._end_wanted.is_set():  # nothing runs that was never powered up
            self.end()
            return
        self._reach(run.bench.start_up_cycles, "start-up")
        self.run.plan(self._orders)
        self._port = self._open_port(self.run.bench)

    def _take(self, run: RewindableRun) -> None:
        """Take a machine that is not powered up yet, and attach all observers."""
        self.run = run
        self.taps = RegisterTaps(run.bench)
        self.taps.set(recording=self.record_writers)
        self._stepper = Stepper(run.bench, self.taps, self._hold, self._rest)
        self.line.log.clear()
        self._session = None
        self.stopped = ""
        #: Ends that somebody hears the board: the line by itself, and from the first session on the latest one.
        self._stop_hearing = run.uart_sent.connect(self.line.byte)
        run.done_again.connect(self._done_again)
        run.acted.connect(self.moments.note_order)
        run.future_changed.connect(self.moments.forget_after)
        run.future_changed.connect(self.showing.forget_after)
        self.probes.attach(run)
        self.showing.take(run)

    def _close(self) -> None:
        if self._port is not None:
            self._port.close()
        run = getattr(self, "run", None)
        if run is None:
            return
        try:
            if self.error is None:  # or nobody knows whether it can still be looked at
                self._publish()
                self.showing.look_at_paths(run)
        finally:
            run.close()

    # Running

    def _run_until_command(self) -> None:
        """Run until a command asks for something else."""
        self.showing.where = None
        if self._wanted is not None:
            self._stepper.arm(self._wanted)
        session = self._open_session(None if self._wanted is not None else self.pace)
        try:
            session.run()
        except (FirmwareStopped, PortError) as reason:
            self._stop(reason)
        finally:
            if self._wanted is None:
                self._stepper.disarm()
        self._publish()

    def _open_session(self, pace: float | None) -> Session:
        self._release = False
        self._stop_hearing()
        self._session = Session(self.run, self._port, Pacer(pace), tick=self._tick, wire=self.line)
        self._stop_hearing = self._session.release
        return self._session

    def _tick(self, session: Session) -> None:
        """Called after each slice, with the machine at rest."""
        now = self.run.clock.now
        if self._travel_range is not None:
            begin, end = self._travel_range
            self.showing.progress = min(0.999, (now - begin) / max(1, end - begin))
        self._serve()
        self._publish_when_due()
        last = self.moments.all[-1].cycles
        if now - last >= CHECKPOINT_CYCLES:
            self.moments.note(now, "automatic")
        if self._ended or self._goal is not None or self._release or not (self._running or self._stepper.armed):
            session.stop()

    def _stop(self, reason: BaseException) -> None:
        self._stepper.disarm()
        self._wanted = None
        self._running = False
        if isinstance(reason, PortError) and self._port is not None:
            self._port.close()
            self._port = self._session = None
            self.showing.message = f"{reason}; Run goes on without it"
        else:
            self.stopped = str(reason)

    # Another time

    def _travel(self, cycles: int) -> None:
        self._goal = None
        self._running = False
        old = self.run
        if cycles > old.clock.now and not self.stopped:
            self._forward(cycles)
            return
        self.showing.progress, self.showing.message = 0.0, "the firmware is translated and linked again"
        self._publish(Mode.REPLAYING)
        try:
            run = old.again()
        except (ValueError, OSError) as reason:  # a driver's file is another by now
            self.showing.progress, self.showing.message = 1.0, f"cannot be executed again: {reason}"
            return
        old.close()
        self._take(run)
        self._reach(cycles, f"executing again up to {cycles / SYSCLK_HZ:.3f} s")

    def _seek(self) -> None:
        """Go the last part of the way to a finding, if one is sought and there is no other command by now."""
        sought, self._sought = self._sought, None
        if sought is None or self._goal is not None:
            return
        if sought.time_cycles - BEFORE_CYCLES <= self.run.clock.now <= sought.time_cycles:
            self.step(Step.FINDING)
            self._stepper.sought = sought

    def _arrive(self) -> None:
        if self._goal is None:
            for arrived in self._arrivals:
                arrived.set_result(None)
            self._arrivals.clear()

    def _reach(self, cycles: int, why: str) -> None:
        """Power up and run to `cycles` at full speed."""
        run, showing = self.run, self.showing
        showing.progress, showing.message = 0.0, why
        began = time.monotonic()

        def progress(share: float) -> None:
            showing.progress = share
            self._serve()
            self._publish_when_due()
            if self._ended or (self._release and self.ready.is_set()):  # a start-up is never given up half way
                raise _GivenUp

        self._release = False
        self._holding = True  # nothing is done to it from outside while the past is executed
        try:
            run.bench.power_up()
            run.reach(cycles, progress)
            showing.message = "" if why == "start-up" else f"executed again in {time.monotonic() - began:.1f} s"
        except _GivenUp:
            showing.message = "stopped on the way"
        except FirmwareStopped as reason:
            self._stop(reason)
        finally:
            self._holding = self._release = False
            showing.progress = 1.0
        self._publish()
        showing.look_at_paths(run)

    def _forward(self, cycles: int) -> None:
        self.showing.message, self.showing.progress = "running ahead at full speed", 0.0
        session = self._open_session(None)
        self._running = True
        self._travel_range = (self.run.clock.now, cycles)
        try:
            session.run((cycles - self.run.clock.now) / SYSCLK_HZ)
        except (FirmwareStopped, PortError) as reason:
            self._stop(reason)
        finally:
            self._travel_range = None
            self._running = False
            self.showing.progress, self.showing.message = 1.0, ""
        self._publish()

    def _done_again(self, each: RecordedInput) -> None:
        self.moments.note_order(each)
        if each.do == "order":
            self.line.log.sent(bytes(each.values[0]), self.run.clock.now / SYSCLK_HZ)  # type: ignore[arg-type]
        else:
            self.showing.changes += 1

    # Commands: done by `commands`, in this thread

    def _serve(self, *, wait: bool = False) -> None:
        """Run queued commands; at rest also those that wait for rest."""
        if self._commands.serve(at_rest=not self._holding, wait=wait):
            self.showing.make_due()
        if not self._running and not self._stepper.armed:
            self._publish_when_due()

    def act(self, do: str, *values: bytes | str | float) -> None:
        """Apply an input by its name in `checkpoints.hands`."""
        self.run.act(do, *values)
        if do != "order":
            self.showing.changes += 1

    def send(self, data: bytes) -> None:
        """Give bytes to the line."""
        session = self._session
        if session is not None:
            session.feed(data)
        else:
            self.act("order", data)
            self.line.log.sent(data, self.run.clock.now / SYSCLK_HZ)

    def _send_at_rest(self, data: bytes) -> None:
        self._commands.put(lambda: self.send(data), changes=True)

    def resume(self) -> None:
        """Continue the run."""
        self._running = True
        self._wanted = None
        self._stepper.disarm()
        self._release = True
        self.showing.message = ""

    def pause(self) -> None:
        """Pause virtual time."""
        if self.showing.where is not None and self._holding:
            return  # it stands already
        self._running = False
        self._wanted = None
        self._stepper.disarm()
        self._release = True

    def step(self, kind: Step) -> None:
        """Run to the next `kind` and stop there."""
        self._running = False
        self._wanted = kind
        self._stepper.sought = None
        self.showing.message = ""
        if self._holding and self.showing.where is not None:
            self._stepper.arm(kind)
            self.showing.where = None
        else:
            self._release = True

    def travel_to(self, cycles: int, arrived: Future[None]) -> None:
        """Go to another time; `arrived` is called on arrival, or if it was given up."""
        self._arrivals.append(arrived)
        self._running = False
        self._wanted = None
        self._stepper.disarm()
        self._release = True
        self._goal = max(0, cycles)
        self._sought = None

    def travel_to_finding(self, finding: Finding, arrived: Future[None]) -> None:
        """Go to the place of a finding; `arrived` is called shortly before it."""
        self.travel_to(finding.time_cycles - BEFORE_CYCLES, arrived)
        self._sought = finding

    def set_pace(self, pace: float | None) -> None:
        """Set the virtual time per real time."""
        self.pace = pace
        self._release = self._release or self._running

    def record(self, on: bool) -> None:
        """Set whether the writers of registers are recorded."""
        self.record_writers = on
        self.taps.set(recording=on)

    def end(self) -> None:
        """End the thread."""
        self._ended = True
        self._release = True
        self._stepper.disarm()

    # Steps

    def _hold(self, where: StepEnd) -> None:
        """Hold the firmware between two statements, on its own stack, until a command continues it."""
        showing = self.showing
        showing.where = where
        self._holding, self._release = True, False
        self._publish()
        try:
            while showing.where is not None and not self._release:
                self._serve(wait=True)
        finally:
            self._holding = False
        # A held place that is left by anything but a further step ends the slice soon.
        if not self._stepper.armed:
            self._wanted = None
            self.run.pause()

    def _rest(self, where: StepEnd) -> None:
        self.showing.where = where
        self._wanted = None
        self._running = False

    # What is seen

    def _publish_when_due(self) -> None:
        if self.showing.due():
            self._publish()

    def _publish(self, mode: Mode | None = None) -> None:
        self.showing.publish(self.run, mode or self._mode(), self.pace, self.stopped, self._session)

    def _mode(self) -> Mode:
        if self.stopped:
            return Mode.STOPPED
        if self.showing.progress < 1.0:
            return Mode.REPLAYING if self.ready.is_set() else Mode.STARTING
        if self._holding:
            return Mode.HELD
        return Mode.RUNNING if self._running else Mode.PAUSED
