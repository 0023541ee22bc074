"""The emulated board, or robot, for the page.  All methods may be called from any thread.

    Page -> `submit(work)`, `act`, `resume`, `pause`, `step`, `go_to`   commands for the machine's thread
    Page <- `snapshot`, `trails`, `findings`, `line.log`                made there, never changed afterwards

The future of a command ends when the command was executed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from typing import Any, TypeVar

from emulator.c28x.findings import Finding
from hil.board import Board, load
from hil.client.orders import TimedOrder
from hil.machine import Machine, Setup
from hil.pacing import Pacer
from hil.reports.policy import Policy
from hil.serial_port import SerialPort
from hil.view.checkpoints import RewindableRun
from hil.view.commands import Commands
from hil.view.machine_thread import MachineThread
from hil.view.showing import Mark
from hil.view.snapshot import Snapshot
from hil.view.stepping import Step
from hil.view.taps import RegisterTaps

T = TypeVar("T")


class Engine:
    """A board that runs in a thread of its own."""

    def __init__(
        self,
        setup: Setup,
        *,
        pace: float | None = 1.0,
        orders: Iterable[TimedOrder] = (),
        open_port: Callable[[Machine], SerialPort | None] = lambda _machine: None,
        record_writers: bool = True,
        read: Mapping[str, Any] | None = None,
        policy: Policy | None = None,
    ) -> None:
        """`open_port` is called in the machine's thread once it is ready; None: only the page speaks to it.

        `read` is what was read of files for the setup before (`RunningBoard.read`): its board, its map.
        `policy` weighs the findings; None: by their rules.
        """
        self.setup = setup
        self.policy = policy or Policy()
        read = {"kind": load(setup.board)} | dict(read or {})
        self.kind: type[Board] = read["kind"]
        self._commands = Commands()
        self._machine = machine = MachineThread(
            setup, self._commands, pace=pace, orders=orders, open_port=open_port, record_writers=record_writers,
            read=read,
        )  # fmt: skip
        self.line = machine.line
        self.moments = machine.moments
        self.probes = machine.probes
        #: Set when it has started up, or failed to: then `error` says why.
        self.ready = machine.ready

    def start(self) -> None:
        """Start the thread."""
        self._machine.start()

    def close(self) -> None:
        """End the thread and release the machine."""
        self._machine.join()

    def on_error(self, listener: Callable[[], None]) -> None:
        """Call `told`, in any thread, when the thread ends with an `error`; at once if it has."""
        self._machine.failed.connect(listener)
        if self.error is not None:
            listener()

    # Commands

    def submit(self, work: Callable[[RewindableRun], T], *, changes: bool = False) -> Future[T]:
        """Execute `work(run)` in the machine's thread.  `changes`: it changes the run, so it waits until the machine
        is at rest."""
        return self._commands.put(lambda: work(self._machine.run), changes=changes)

    def act(self, do: str, *values: bytes | str | float) -> Future[None]:
        """Apply an input by its name in `checkpoints.hands`."""
        return self._commands.put(lambda: self._machine.act(do, *values), changes=True)

    def resume(self) -> Future[None]:
        """Continue the run."""
        return self._commands.put(self._machine.resume)

    def pause(self) -> Future[None]:
        """Pause virtual time."""
        return self._commands.put(self._machine.pause)

    def step(self, kind: Step) -> Future[None]:
        """Run to the next `kind` and stop there."""
        return self._commands.put(lambda: self._machine.step(kind))

    def go_to(self, cycles: int) -> Future[None]:
        """Go to another time and pause there.  An earlier time is reached from power-up, a later one at full speed.

        The future ends on arrival, or if the command was given up.
        """
        arrived: Future[None] = Future()
        asked = self._commands.put(lambda: self._machine.travel_to(cycles, arrived))
        asked.add_done_callback(lambda done: arrived.cancel() if done.cancelled() else None)
        return arrived

    def go_to_finding(self, finding: Finding) -> Future[None]:
        """Go to the first occurrence of a finding, and stop the firmware in its statement, with its locals.

        The future ends shortly before that statement, or if the command was given up.
        """
        arrived: Future[None] = Future()
        asked = self._commands.put(lambda: self._machine.travel_to_finding(finding, arrived))
        asked.add_done_callback(lambda done: arrived.cancel() if done.cancelled() else None)
        return arrived

    def set_pace(self, pace: float | None) -> Future[None]:
        """Virtual time per real time; None: as fast as possible."""
        Pacer(pace)  # a wrong pace is refused here and now
        return self._commands.put(lambda: self._machine.set_pace(pace))

    def record(self, on: bool) -> Future[None]:
        """Set whether the writers of registers are recorded, from now on and when the run is executed again."""
        return self._commands.put(lambda: self._machine.record(on))

    def note(self, label: str) -> Future[None]:
        """Note this moment as a checkpoint."""
        return self._commands.put(lambda: self.moments.note(self._machine.run.clock.now, label))

    # What is seen

    @property
    def snapshot(self) -> Snapshot:
        """The latest snapshot; there are about 20 a second."""
        return self._machine.showing.snapshot

    @property
    def trails(self) -> Any:
        """The long paths of the stage (`hil.view.stage.StageProtocol.trails`)."""
        return self._machine.showing.trails

    @property
    def faults(self) -> tuple[str, ...]:
        """The outcome of each fault, as a sentence."""
        return tuple(str(fired) for fired, _ in self.snapshot.faults)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The findings so far."""
        return self._machine.showing.findings

    @property
    def known_findings(self) -> tuple[Finding, ...]:
        """The findings, with those of the earlier run that are ahead."""
        return self._machine.showing.known_findings

    @property
    def marks(self) -> tuple[Mark, ...]:
        """The marks of inputs and events, with those that are ahead; without references of driving by hand."""
        return self._machine.showing.marks

    @property
    def known_cycles(self) -> int:
        """The latest time that the run has reached, or reaches with the inputs that are ahead."""
        return self._machine.showing.known_cycles

    @property
    def blocks(self) -> list[str]:
        """Names of the register blocks."""
        return self._machine.showing.blocks

    @property
    def unsuitable(self) -> dict[str, str]:
        """The kinds of faults that this board cannot have, each with the reason."""
        return self._machine.showing.unsuitable

    @property
    def pace(self) -> float | None:
        """Virtual time per real time; None: as fast as possible."""
        return self._machine.pace

    @property
    def record_writers(self) -> bool:
        """Whether the writers of registers are recorded."""
        return self._machine.record_writers

    @property
    def stopped(self) -> str:
        """The reason why the firmware or the port has stopped; empty while it runs."""
        return self._machine.stopped

    @property
    def error(self) -> BaseException | None:
        """The exception that ended the thread; None if `close` did, or if it runs."""
        return self._machine.error

    @property
    def taps(self) -> RegisterTaps:
        """The taps of the present machine; only for submitted work."""
        return self._machine.taps
