"""A board with its firmware, run in virtual time.

    machine = RunningBoard.of(Setup(board="station.py", firmware=("station.c",), put=("infrared.distance_m=0.4",)))
    machine.boot()
    machine.run_for(0.5)

Nothing here is about a robot: `hil.bench.Bench` is one that puts the robot's board into a world.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from html import escape
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from emulator.c28x.coverage import Coverage
from emulator.c28x.runtime import EndlessPoll, IllegalCall, UninitialisedRead
from emulator.clock import SYSCLK_HZ, seconds, us
from emulator.cpu import InterruptStorm
from emulator.image import Firmware, link
from emulator.signal import Signal
from emulator.signals import SerialFrame
from emulator.sysbios.core import KernelError
from emulator.sysbios.statistics import TaskStatistics
from hil.board import Board, load, made, optional, source_of
from hil.collector import uncollected
from hil.faces import FaceSetting, parse_all
from hil.longest import LONGEST_S
from hil.machine import CpuUse, FirmwareStopped, Setup, TaskTimes, internal_error

if TYPE_CHECKING:
    from hil.faults import MountedFault
    from hil.feeds import DeclaredFeed


class RunningBoard:
    """A board that runs.  Implements `hil.machine.Machine`.

    `firmware` is linked to the board and begins at its function `main` (`module.name`).  Of what is `put` to faces,
    times count from the end of start-up, which takes `start_up_cycles`.  `traced` keeps the digest of every kernel
    event; without it the run is a little faster and `trace_sha256` is empty.
    """

    #: How long `main` may take to start the kernel before the first pause; 0: it pauses as soon as it has taken time.
    FIRST_SLICE_CYCLES: ClassVar[int] = 0

    def __init__(
        self, board: Board, firmware: Firmware, main: str, *, start_up_cycles: int = 0,
        puts: Sequence[FaceSetting] = (), traced: bool = True,
    ) -> None:  # fmt: skip
        self.board = board
        self.firmware = firmware
        self.clock = board.clock
        self.findings = board.findings
        #: (byte, end_cycles): the PC has a byte of the board.
        self.uart_sent: Signal[int, int] = Signal()
        self.start_up_cycles = start_up_cycles
        #: Those of its setup, and those that were mounted since.
        self.faults: tuple[MountedFault, ...] = ()
        #: By input that sees something else than the physics, what ends that (`hil.feeds.feed`).
        self.feeds: dict[str, Callable[[], None]] = {}
        #: The feeds of its setup.
        self._declared: tuple[DeclaredFeed, ...] = ()
        self._main = main
        self._puts = puts
        self._uart = hashlib.sha256()
        self._statistics: TaskStatistics | None = None
        self._booted = False
        if board.pc is not None:
            board.pc.line.received.connect(self._received)
            board.serial_pins[board.pc.tx_gpio].sent.connect(self._sent)
        if traced:
            board.trace.keep_digest()

    @classmethod
    def of(
        cls, setup: Setup, *, kind: type[Board] | None = None, traced: bool = True, coverage: Coverage | None = None,
        steps: bool = False, feeds: Sequence[DeclaredFeed] | None = None,
    ) -> RunningBoard:  # fmt: skip
        """The board of a setup, with the program of its driver files or, without those, the board's own firmware.

        `kind` and `feeds` are the setup's as they were read before, whatever their files hold by now; `coverage` takes
        up how often each statement is begun.  Raises ValueError for what cannot be.
        """
        kind = kind or load(setup.board)
        with uncollected():
            board = made(kind, seed=setup.seed, ideal=not setup.realistic, **optional(kind, setup.options))
            puts = parse_all(setup.put, board)
            firmware = _linked(board, setup, coverage=coverage, steps=steps)
        machine = cls(board, firmware, _main_of(firmware, setup), puts=puts, traced=traced)
        machine.mount(setup, feeds)
        return machine

    # What its inputs see, and what breaks on purpose

    def mount(self, setup: Setup, feeds: Sequence[DeclaredFeed] | None = None) -> None:
        """What its inputs see instead of the physics, and what breaks, before it is powered up.  Raises ValueError."""
        if setup.feeds:
            from hil.feeds import load

            self._declared = tuple(map(load, setup.feeds) if feeds is None else feeds)
            for declared in self._declared:
                declared.feed(self)
        self.mount_faults(*setup.faults)

    def mount_faults(self, *texts: str) -> None:
        """More that breaks on purpose, from now on or when its time has come.  Raises ValueError."""
        if texts:
            from hil.faults import mount, parse

            self.faults = (*self.faults, *(mount(parse(text), self) for text in texts))

    def remove_fault(self, index: float) -> None:
        """End one of `faults`; its report stays.  Raises ValueError if there is none."""
        if not 0 <= index < len(self.faults):
            raise ValueError(f"there is no fault {index:g}: there are {len(self.faults)}")
        self.faults[int(index)].remove()

    # Running

    def boot(self, progress: Callable[[float], None] | None = None) -> None:
        """Power up: `main` has run up to its first moment of time."""
        self.power_up()
        if progress is not None:
            progress(1.0)

    def power_up(self) -> None:
        """Power up only: `main` has started the kernel, or has run for the first slice."""
        if self._booted:
            raise ValueError("it has been powered up already; make a new one for a new power-up")
        self._booted = True
        self._put_to_faces()
        kernel, clock = self.board.kernel, self.clock
        pause = clock.after(self.FIRST_SLICE_CYCLES, kernel.pause)
        with self._stopping():
            kernel.start(self.firmware.function(self._main))
        clock.cancel(pause)

    def run_until(self, cycles: int) -> None:
        """Run to an absolute time in cycles.  Raises FirmwareStopped when the firmware does not run on."""
        with self._stopping():
            self.board.kernel.run_until(cycles)

    def pause(self) -> None:
        """Make `run_until` or the start-up's present slice end at the CPU's next charge.  Safe in a signal handler."""
        self.board.kernel.pause()

    def run_for(self, duration_s: float) -> None:
        """Run for a stretch of virtual time.

        Raises TypeError for what is no number, ValueError for no stretch, and before it was powered up.
        """
        try:
            possible = 0.0 <= duration_s <= LONGEST_S
        except TypeError:
            raise TypeError(f"run_for({duration_s!r}): expected seconds, as in run_for(10.0)") from None
        if not possible:
            raise ValueError(f"run_for({duration_s!r}): expected seconds, 0 to {LONGEST_S:.0f}")
        if not self._booted:
            raise ValueError("the board is not powered up: call boot() first")
        self.run_until(self.clock.now + round(duration_s * SYSCLK_HZ))

    def close(self) -> None:
        """End the kernel's tasks."""
        self.board.kernel.shutdown()

    @contextmanager
    def _stopping(self) -> Iterator[None]:
        """What ends the firmware for good, as one kind of error with the note of who it was.

        So is an error of ours, or of the user's board, in what the firmware does (the kernel notes who it was); any
        other is the caller's.
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
            raise FirmwareStopped(f"{internal_error(error, source_of(type(self.board)))} ({who})") from error

    # The faces of its parts

    def put(self, part: str, face: str, value: float) -> None:
        """Set a face of a part now.  Raises ValueError."""
        self.board.part(part).put(face, value)

    def _put_to_faces(self) -> None:
        """What the setup puts to faces: from now on, or when its time has come."""
        for put in self._puts:
            if put.time_s is None:
                self.put(put.part, put.face, put.value)
            else:
                at = self.start_up_cycles + round(put.time_s * SYSCLK_HZ)
                self.clock.schedule(max(at, self.clock.now), partial(self.put, put.part, put.face, put.value))

    # The line

    def feed(self, data: bytes | str) -> None:
        """Queue bytes, or a text of ASCII, for the chip; the line takes them at its own baud.

        Raises TypeError for anything else, ValueError for other characters and without a line to a PC.
        """
        if isinstance(data, str):
            if not data.isascii():
                raise ValueError(f"feed({data!r}): a text must be ASCII; give other bytes as bytes")
            data = data.encode("ascii")
        elif not isinstance(data, bytes | bytearray | memoryview):
            raise TypeError(f"feed({data!r}): expected bytes or text, as in feed('#MISN\\r')")
        if self.board.pc is None:
            raise ValueError(f"{type(self.board).__name__} has no line to a PC")
        self.board.pc.line.feed(bytes(data))

    @property
    def pending_to_robot(self) -> int:
        """How many bytes were fed and are not on the wire yet."""
        return 0 if self.board.pc is None else self.board.pc.line.pending_to_robot

    def _received(self, data: bytes, cycles: int) -> None:
        for byte in data:
            self.uart_sent.emit(byte, cycles)

    def _sent(self, frame: SerialFrame) -> None:
        self._uart.update(bytes((frame.data & 0xFF,)))

    # Looking

    def __repr__(self) -> str:
        return f"<{type(self.board).__name__} at {seconds(self.clock.now):.3f} s, {len(self.findings)} findings>"

    def _repr_html_(self) -> str:
        """What it is at, and its findings, for notebooks."""
        return f"<p>{escape(repr(self)[1:-1])}</p>{self.findings._repr_html_()}"

    @property
    def read(self) -> dict[str, Any]:
        """What was read of files for it, as the options that make another one like it, whatever they hold by now."""
        return {"kind": type(self.board), "feeds": self._declared}

    @property
    def ended(self) -> bool:
        """Whether the program has ended: `main` has returned, BIOS_exit was called, or the watchdog has reset the chip.

        The board goes on without it.
        """
        return self.board.kernel.exit_status is not None

    @property
    def uart_sha256(self) -> str:
        """Digest of every byte that was sent since power-up."""
        return self._uart.hexdigest()

    @property
    def trace_sha256(self) -> str:
        """Digest of the trace since power-up: task switches, posts, ticks, interrupts, with their cycle.

        "" if it is not kept.
        """
        return self.board.trace.sha256

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
        return CpuUse(tuple(rows), statistics.busy(self.clock.now), self.of_own_c([row.task for row in rows]))

    def of_own_c(self, tasks: Sequence[str]) -> frozenset[str]:
        """Those of the tasks that run code which was not calibrated: all of a user's board."""
        return frozenset(tasks)


def running(setup: Setup, *, kind: type[Board] | None = None, **options: Any) -> RunningBoard:
    """What a setup's board is when it runs: in a world, if it has wheels.

    `kind` is the board as it was read before; `options` are those of the machine.  Raises ValueError.
    """
    kind = kind or load(setup.board)
    if kind.bench is None:
        return RunningBoard.of(setup, kind=kind, **options)
    bench: RunningBoard = import_module(kind.bench).Bench(setup, kind=kind, **options)
    return bench


def _linked(board: Board, setup: Setup, *, coverage: Coverage | None, steps: bool) -> Firmware:
    project = board.project
    options: dict[str, Any] = {
        "fill": setup.fill, "divide": setup.divide, "float_division": setup.float_division, "watch": setup.watch,
        "static": setup.static, "include": setup.include, "defines": setup.defines, "coverage": coverage,
        "steps": steps,
    }  # fmt: skip
    if setup.firmware:
        from hil.drivers.files import driver_files

        files = [str(file) for file in driver_files(map(Path, setup.firmware))]
        asked = {} if project is None else {"header": project.header, "library": project.library}
        return link(board, files, asked=asked, **options)
    if project is None:
        raise ValueError(f"no firmware is given for the board {type(board).__name__}: give --firmware DIR (or files)")
    return project.link(board, **options)


def _main_of(firmware: Firmware, setup: Setup) -> str:
    """The function where the program begins.  Raises ValueError for none, or several."""
    found = [path for path in firmware.linked.functions if path.rpartition(".")[2] == "main"]
    if len(found) == 1:
        return found[0]
    files = " ".join(setup.firmware)
    if found:
        raise ValueError(f"{files}: main is defined more than once: {', '.join(found)}")
    raise ValueError(f"{files}: no program, it has no main; hil check {files} --board FILE calls its functions")

