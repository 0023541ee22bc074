"""Measures the task set of the running firmware: the times of its tasks and gates, for many phasings.

The robot (or a board of the user) starts up as usual.  Then its Clock objects are stopped and started again with new
delays, so that the releases of their tasks have other phases; orders come at random moments between them.  The first
phasing is the critical instant: all Clock objects are due at one tick, together with the end of an order.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from random import Random
from typing import Final

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ
from emulator.sysbios.clock import ClockObject
from emulator.sysbios.gate_mutex import GateMutex
from emulator.sysbios.gate_mutex_pri import GateMutexPri
from hil.rta.observe import NS_PER_CYCLE, Observer
from hil.rta.task_set import TaskSet
from hil.running import RunningBoard

#: The deadlines of the robot's tasks, in ns (TFG figure 39).  The deadline of any other task is its period.
DEADLINES_NS: Final = {
    "TaskUS": 5_000_000, "TaskGYRO": 5_000_000, "TaskORD": 6_250_000, "TaskSERVO": 25_000_000,
    "TaskNAVIGATION": 50_000_000, "TaskODO": 250_000_000,
}  # fmt: skip
#: The least time between two releases of TaskORD, in ns: the time of the shortest order on the line (TFG 3.4.2).
SHORTEST_ORDER_NS: Final = 6_250_000
#: The time of a byte on the line of 9600 baud (TFG 3.4.2).
_BYTE_CYCLES: Final = SYSCLK_HZ * 10 // 9600
_STEP_CYCLES: Final = SYSCLK_HZ // 20


@dataclass(frozen=True, slots=True)
class TaskStartUp:
    """The start-up of a task: its CPU time up to its first wait, and when that was (after power-up)."""

    task: str
    computation_us: float
    first_wait_ms: float


class RunningFirmware:
    """A board with its program.  `orders` are sent in turn, one in each phasing."""

    def __init__(self, machine: RunningBoard, *, orders: Sequence[bytes] = (), seed: int = 1) -> None:
        self.machine = machine
        self.observer = Observer()
        self._orders = orders
        self._random = Random(seed)
        self._released_by: dict[str, str] = {}
        self._due = ""
        machine.board.trace.read(self.observer)
        machine.board.trace.read(self._who_releases)

    def start(self) -> None:
        """Run the start-up, and measure from then on."""
        self.machine.boot()
        self.observer.begin()

    @property
    def _clocks(self) -> Sequence[ClockObject]:
        return [timer for timer in self.machine.board.kernel.clocks.queue if timer.period and timer.active]

    def _who_releases(self, _cycles: int, kind: str, name: str) -> None:
        """Note the Clock object that releases a task: the task has the period of that object."""
        if kind == "clock":
            self._due = name
        elif kind == "swi end":
            self._due = ""
        elif kind == "ready" and self._due:
            self._released_by[name] = self._due

    def run(self, phasings: int, progress: Callable[[float], None] = lambda fraction: None) -> None:
        """Run the critical instant, and then a number of random phasings."""
        for number in range(phasings + 1):
            self._phasing(number, random=number > 0)
            progress((number + 1) / (phasings + 1))

    def _phasing(self, number: int, *, random: bool) -> None:
        machine, clocks = self.machine, self.machine.board.kernel.clocks
        longest = max((timer.period for timer in self._clocks), default=100)
        tick_cycles = clocks.tick_period_us * CYCLES_PER_MS // 1000 + 1
        for timer in self._clocks:
            # At least a period, so that no release follows another sooner than it may.
            timer.timeout = timer.period + self._random.randrange(timer.period) if random else longest
            clocks.start(timer)
        begin = machine.clock.now
        end = begin + (2 * longest + 1) * tick_cycles
        if self._orders:
            order = self._orders[number % len(self._orders)]
            at = longest * tick_cycles - len(order) * _BYTE_CYCLES
            if random:
                at = self._random.randrange(end - begin - 2 * len(order) * _BYTE_CYCLES)
            self._run_to(begin + max(0, at))
            machine.feed(order)
        self._run_to(end)

    def _run_to(self, cycles: int) -> None:
        machine = self.machine
        while machine.clock.now < cycles:
            machine.run_until(min(cycles, machine.clock.now + _STEP_CYCLES))

    def measured(self, deadlines_ns: Mapping[str, int] = DEADLINES_NS) -> TaskSet:
        """The task set with the largest times of the runs.  A task that a Clock object releases has its period."""
        for obj in self.machine.firmware.linked.objects.values():
            for value in obj.data:
                if isinstance(value, GateMutexPri | GateMutex):
                    self.observer.gate_names[value.name] = obj.declaration.name
        kernel = self.machine.board.kernel
        tick_ns = (kernel.clocks.tick_period_us * CYCLES_PER_MS // 1000 + 1) * NS_PER_CYCLE
        period = {timer.name: timer.period * tick_ns for timer in self._clocks}
        periods = {task: period[by] for task, by in self._released_by.items() if by in period}
        return self.observer.measured(
            {task.name: (task.priority, deadlines_ns.get(task.name, 0)) for task in kernel.tasks.all},
            periods_ns={"TaskORD": SHORTEST_ORDER_NS, **periods},
        )

    def of_own_c(self) -> frozenset[str]:
        """The tasks that run code of the user, whose computation times were not calibrated."""
        return self.machine.of_own_c(self.observer.names())

    def start_ups(self) -> Sequence[TaskStartUp]:
        """The start-up of each task, in the order of their first waits."""
        seen = [
            TaskStartUp(name, task.start_up * NS_PER_CYCLE / 1000, task.first_wait_at * NS_PER_CYCLE / 1e6)
            for name, task in self.observer.tasks.items()
            if task.first_wait_at is not None
        ]
        return sorted(seen, key=lambda task: task.first_wait_ms)
