"""A run that can go back in time: every input with its cycle, and the moments to return to.

A run is determined by its `Setup` and its inputs: bytes on the line, values set at faces of its parts, faults, changes
of the world by hand.  All inputs are logged here with their cycle.  So a new bench with the same inputs at the same
cycles is the same run, byte for byte.  An earlier moment is reached in this way: the run is executed again from
power-up, at full speed.

After going back, the later inputs of the run are repeated at their cycles, until somebody does something else.  Then
they are dropped, and a new future begins.

Not modelled: a copy of the running machine (greenlets cannot be copied), so going back costs executing up to there.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from emulator.clock import SYSCLK_HZ, seconds
from emulator.signal import Signal
from hil.client.orders import KEYWORDS, TimedOrder, order
from hil.machine import CpuUse, Setup
from hil.running import RunningBoard, running
from hil.view.stage import Hand, StageProtocol, stage_of

#: How much is executed between two looks at the progress.
STRIDE_CYCLES: Final = SYSCLK_HZ // 20

#: All orders without a number.
NAMED_ORDERS: Final = frozenset(map(order, KEYWORDS))

Progress = Callable[[float], None]


@dataclass(frozen=True, slots=True)
class RecordedInput:
    """An input from outside at `cycles`: `do` is a name of `hands`, `values` its arguments.

    `scripted` inputs were planned before the run, and stay when another input is given.
    """

    cycles: int
    do: str
    values: tuple[bytes | str | float, ...]
    scripted: bool = False

    @property
    def text(self) -> str:
        """The input as text for a user."""
        shown = (v.decode("latin-1").strip() if isinstance(v, bytes) else f"{v:.3g}" if isinstance(v, float) else v
                 for v in self.values)  # fmt: skip
        return f"{self.do} {', '.join(shown)}"


@dataclass(frozen=True, slots=True, order=True)
class Checkpoint:
    """A time to which the user can go back."""

    cycles: int
    label: str

    @property
    def time_s(self) -> float:
        """Virtual time in seconds."""
        return seconds(self.cycles)


def hands(bench: RunningBoard, stage: StageProtocol | None) -> Mapping[str, Hand]:
    """The actions on a machine from outside, by name."""
    return {
        "order": bench.feed, "put": bench.put, "break": bench.mount_faults, "mend": bench.remove_fault,
        **({} if stage is None else stage.hands),
    }  # fmt: skip


class RewindableRun:
    """A machine with its history.  Implements `hil.machine.Machine`.

    `done` are the inputs so far; `ahead` are those still to come, each at its cycle.  `read` is what was read from
    files, so that the run can be built again (`RunningBoard.read`).
    """

    def __init__(
        self,
        setup: Setup,
        ahead: Iterable[RecordedInput] = (),
        *,
        traced: bool = True,
        read: Mapping[str, Any] | None = None,
    ) -> None:
        self.setup = setup
        self.bench = running(setup, traced=traced, steps=True, **(read or {}))
        self.stage = stage_of(self.bench)
        self.hands = hands(self.bench, self.stage)
        self.done: list[RecordedInput] = []
        self.ahead = sorted(ahead, key=lambda each: each.cycles)
        self.clock = self.bench.clock
        self.findings = self.bench.findings
        #: (input): something is done because it was planned or had been done before.
        self.done_again: Signal[RecordedInput] = Signal()
        #: (input): something is done now.
        self.acted: Signal[RecordedInput] = Signal()
        #: (cycles): something else is done at this time than before.
        self.future_changed: Signal[int] = Signal()

    # What is done

    def act(self, do: str, *values: bytes | str | float) -> None:
        """Apply an input now and log it.  Raises ValueError, and logs nothing, if it is not possible."""
        self.hands[do](*values)
        now = RecordedInput(self.clock.now, do, values)
        self.done.append(now)
        kept = [each for each in self.ahead if each.scripted]
        if len(kept) < len(self.ahead):
            self.ahead = kept
            self.future_changed.emit(self.clock.now)
        self.acted.emit(now)

    def feed(self, data: bytes) -> None:
        """Give bytes to the line."""
        self.act("order", data)

    def plan(self, orders: Iterable[TimedOrder]) -> None:
        """Orders timed from now, as `hil run --order` gives them."""
        now = self.clock.now
        planned = [RecordedInput(now + round(each.time_s * SYSCLK_HZ), "order", (each.data,), True) for each in orders]
        self.ahead = sorted([*self.ahead, *planned], key=lambda each: each.cycles)

    # Time

    def boot(self, progress: Progress | None = None) -> None:
        """Power up and run start-up."""
        self.bench.power_up()
        self.reach(self.bench.start_up_cycles, progress or (lambda _share: None))

    def run_until(self, cycles: int) -> None:
        """Run to `cycles`, with the inputs that are ahead (one at `cycles` itself comes with the next run).

        A pause of the kernel ends it earlier.
        """
        clock = self.clock
        while self.ahead and self.ahead[0].cycles < cycles:
            due = self.ahead[0]
            self.bench.run_until(due.cycles)
            if clock.now < due.cycles:
                return
            del self.ahead[0]
            self.hands[due.do](*due.values)
            self.done.append(due)
            self.done_again.emit(due)
        self.bench.run_until(cycles)

    def reach(self, cycles: int, progress: Progress) -> None:
        """Run at full speed; `progress` gets the fraction of the time from power-up."""
        while self.clock.now < cycles:
            self.run_until(min(cycles, self.clock.now + STRIDE_CYCLES))
            progress(min(1.0, self.clock.now / max(1, cycles)))

    def again(self) -> RewindableRun:
        """A new run, not powered up, with the past and planned inputs of this one ahead."""
        return RewindableRun(self.setup, [*self.done, *self.ahead], read=self.bench.read)

    def pause(self) -> None:
        """Make `run_until` return at the CPU's next charge."""
        self.bench.pause()

    def close(self) -> None:
        """End the kernel's tasks."""
        self.bench.close()

    # The rest of a machine

    @property
    def uart_sent(self) -> Signal[int, int]:
        """(byte, end_cycles): each byte that was sent."""
        return self.bench.uart_sent

    @property
    def pending_to_robot(self) -> int:
        """The number of bytes that were fed and are not on the wire yet."""
        return self.bench.pending_to_robot

    @property
    def uart_sha256(self) -> str:
        """The digest of the sent bytes."""
        return self.bench.uart_sha256

    @property
    def trace_sha256(self) -> str:
        """The digest of the trace."""
        return self.bench.trace_sha256

    def measure_tasks(self) -> object:
        """Start measuring task times."""
        return self.bench.measure_tasks()

    def task_statistics(self) -> CpuUse:
        """Task times."""
        return self.bench.task_statistics()


class CheckpointList:
    """The moments to return to, in order of time.  "ready" stays; the oldest without a name is dropped first."""

    def __init__(self, ready_cycles: int = 0, most: int = 60) -> None:
        self._most = most
        self.begin_at(ready_cycles)

    def begin_at(self, ready_cycles: int) -> None:
        """Start with a single moment: the end of start-up."""
        self._ready_cycles = ready_cycles
        self.all: list[Checkpoint] = [Checkpoint(ready_cycles, "ready")]

    def note(self, cycles: int, label: str) -> None:
        """Remember a moment."""
        moment = Checkpoint(cycles, label)
        if moment in self.all:
            return
        self.all.insert(bisect_right(self.all, moment), moment)
        if len(self.all) > self._most:
            oldest = 1 if self.all[0].label == "ready" else 0
            del self.all[next((at for at, each in enumerate(self.all) if not each.label), oldest)]

    def note_order(self, each: RecordedInput) -> None:
        """Remember the moment before an order, except for references of driving, ten a second."""
        if each.do == "order" and each.values[0] in NAMED_ORDERS:
            self.note(each.cycles, each.values[0].decode("ascii").strip())

    def forget_after(self, cycles: int) -> None:
        """Drop the moments after `cycles`: a new future begins there."""
        self.all = [moment for moment in self.all if moment.cycles <= max(cycles, self._ready_cycles)]
