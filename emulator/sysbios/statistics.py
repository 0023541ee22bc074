"""Statistics of tasks in a run: computation time, response time, CPU load.  They come from the trace alone.

An activation of a task begins when it is made ready and ends when it blocks.  Its computation time is the CPU time it
got: pre-emption by other tasks, Swis and interrupts (with the core's own entry and exit) do not count; a task switch
counts for the task it leads to.  Its response time runs from ready to block.  Waiting for a gate is part of an
activation, not its end.  All times are SYSCLK cycles.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.cpu import INTERRUPT_ENTRY_CYCLES, INTERRUPT_EXIT_CYCLES

IDLE: Final = "Idle"


class CycleStatistics:
    """The count, the sum, the least and the greatest value of a series of cycle counts."""

    __slots__ = ("count", "maximum", "minimum", "total")

    def __init__(self) -> None:
        self.count = 0
        self.total = 0
        self.minimum = 0
        self.maximum = 0

    def add(self, value: int) -> None:
        """Add a value."""
        if not self.count or value < self.minimum:
            self.minimum = value
        if value > self.maximum:
            self.maximum = value
        self.count += 1
        self.total += value

    @property
    def mean(self) -> int:
        """The mean, rounded down; 0 without values."""
        return self.total // self.count if self.count else 0

    def as_dict(self) -> dict[str, int]:
        """The statistics as plain data."""
        return {
            "count": self.count,
            "min": self.minimum,
            "mean": self.mean,
            "max": self.maximum,
            "total": self.total,
        }


class Activity:
    """The statistics of one task: `computation` and `response` of its activations, and its CPU time `cpu` in total."""

    __slots__ = ("computation", "cpu", "name", "ready_at", "response", "used", "waits")

    def __init__(self, name: str) -> None:
        self.name = name
        self.computation = CycleStatistics()
        self.response = CycleStatistics()
        self.cpu = 0
        #: The cycle when the running activation began (None outside one), its CPU time, and whether a gate blocks it.
        self.ready_at: int | None = None
        self.used = 0
        self.waits = False


class TaskStatistics:
    """Listens to a trace: `trace.listen(TaskStatistics())`.  `reset` forgets the past, but not the running task."""

    def __init__(self) -> None:
        self.tasks: dict[str, Activity] = {}
        #: CPU time of interrupts (`Hwi:name`) and Swis (`Swi:name`).
        self.interrupts: dict[str, int] = {}
        self.benchmarks: dict[str, CycleStatistics] = {}
        self._benchmark_since: dict[str, int] = {}
        self._running: Activity | None = None
        self._nested: list[str] = []
        self._since = 0
        self._began: int | None = None
        self._handlers: dict[str, Callable[[int, str], None]] = {
            "switch": self._switch,
            "ready": self._ready,
            "block": self._block,
            "gate wait": self._gate_wait,
            "hwi": self._hwi,
            "hwi end": self._hwi_end,
            "swi": self._swi,
            "swi end": self._swi_end,
            "benchmark start": self._benchmark_start,
            "benchmark stop": self._benchmark_stop,
        }

    def __call__(self, cycles: int, kind: str, name: str) -> None:
        """Take in a trace event."""
        if self._began is None:
            self._began = self._since = cycles
        handler = self._handlers.get(kind)
        if handler is not None:
            handler(cycles, name)

    def reset(self, cycles: int) -> None:
        """Begin to measure at `cycles` (now); activations that run already are not counted."""
        self._account(cycles)
        self._began = cycles
        self.interrupts.clear()
        self.benchmarks.clear()
        self._benchmark_since.clear()
        for activity in self.tasks.values():
            activity.computation, activity.response = CycleStatistics(), CycleStatistics()
            activity.cpu = activity.used = 0
            activity.ready_at = None

    def load(self, cycles: int) -> dict[str, float]:
        """Share of the CPU by task, Swi and interrupt from the first event or reset to `cycles`; they add up to 1."""
        self._account(cycles)
        span = cycles - (self._began or 0)
        if span <= 0:
            return {}
        shares = {name: activity.cpu / span for name, activity in self.tasks.items()}
        shares.update({name: used / span for name, used in self.interrupts.items()})
        return shares

    def busy(self, cycles: int) -> float:
        """Share of the CPU that was not idle."""
        shares = self.load(cycles)
        return 1.0 - shares[IDLE] if IDLE in shares else float(bool(shares))

    def _account(self, cycles: int) -> None:
        """Add the time since the last event to the thread that had the CPU."""
        used = cycles - self._since
        if used <= 0:
            return
        self._since = cycles
        if self._nested:
            name = self._nested[-1]
            self.interrupts[name] = self.interrupts.get(name, 0) + used
        elif self._running is not None:
            self._running.cpu += used
            self._running.used += used

    def _activity(self, name: str) -> Activity:
        activity = self.tasks.get(name)
        if activity is None:
            activity = self.tasks[name] = Activity(name)
        return activity

    def _switch(self, cycles: int, name: str) -> None:
        self._account(cycles)
        self._running = self._activity(name)

    def _ready(self, cycles: int, name: str) -> None:
        activity = self._activity(name)
        if activity.waits:
            activity.waits = False
            return
        self._account(cycles)
        activity.ready_at = cycles
        activity.used = 0

    def _block(self, cycles: int, name: str) -> None:
        self._account(cycles)
        activity = self._activity(name)
        if activity.waits or activity.ready_at is None:
            return
        activity.computation.add(activity.used)
        activity.response.add(cycles - activity.ready_at)
        activity.ready_at = None

    def _gate_wait(self, cycles: int, name: str) -> None:
        if self._running is not None:
            self._running.waits = True

    def _hwi(self, cycles: int, name: str) -> None:
        # The interrupt entry of the core took its cycles before the kernel's trace event.
        self._account(cycles - INTERRUPT_ENTRY_CYCLES)
        self._nested.append(f"Hwi:{name}")

    def _hwi_end(self, cycles: int, name: str) -> None:
        self._account(cycles + INTERRUPT_EXIT_CYCLES)
        self._nested.pop()

    def _swi(self, cycles: int, name: str) -> None:
        self._account(cycles)
        self._nested.append(f"Swi:{name}")

    def _swi_end(self, cycles: int, name: str) -> None:
        self._account(cycles)
        self._nested.pop()

    def _benchmark_start(self, cycles: int, name: str) -> None:
        self._benchmark_since[name] = cycles

    def _benchmark_stop(self, cycles: int, name: str) -> None:
        since = self._benchmark_since.pop(name, None)
        if since is not None:
            self.benchmarks.setdefault(name, CycleStatistics()).add(cycles - since)
