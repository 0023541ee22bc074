"""Measures response times in a run of the kernel, from its trace alone.

Each cycle belongs to a task, an interrupt, a Swi, or to nobody.  An activation of a task begins when the task becomes
ready and ends when it blocks, as in `emulator.sysbios.statistics`; waiting for a gate is part of it.  The time in a
gate is the CPU time of its owner from `enter` to `leave`, with the task switches back to the owner.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from emulator.clock import SYSCLK_HZ
from emulator.cpu import INTERRUPT_ENTRY_CYCLES, INTERRUPT_EXIT_CYCLES
from emulator.sysbios.statistics import IDLE
from hil.rta.task_set import Arrival, Interrupt, Section, TaskModel, TaskSet

NS_PER_CYCLE: Final = 10**9 // SYSCLK_HZ

#: The number of distances that are kept.  Longer bursts of arrivals are not seen.
KEPT_DISTANCES: Final = 16


@dataclass(frozen=True, slots=True)
class CpuSpan:
    """A span in which one thread has the CPU, in cycles; `gate` is the gate that a task holds during it."""

    who: str
    begin: int
    end: int
    gate: str = ""


@dataclass(frozen=True, slots=True)
class Activation:
    """One activation from ready to end: the threads that ran, and the releases in between."""

    task: str
    ready: int
    end: int
    stretches: tuple[CpuSpan, ...]
    releases: tuple[tuple[int, str], ...]


class Arrivals:
    """The least time between the first and the last of 2, 3, ... consecutive arrivals, in cycles."""

    def __init__(self) -> None:
        self.count = 0
        self.distances: list[int] = []
        self._last: list[int] = []

    def add(self, cycles: int) -> None:
        """Add an arrival."""
        for index, earlier in enumerate(reversed(self._last)):
            span = cycles - earlier
            if index == len(self.distances):
                self.distances.append(span)
            elif span < self.distances[index]:
                self.distances[index] = span
        self._last.append(cycles)
        if len(self._last) > KEPT_DISTANCES:
            del self._last[0]
        self.count += 1


@dataclass(slots=True)
class ObservedTask:
    """The measurements of one task; times are in cycles."""

    computation: int = 0
    response: int = 0
    activations: int = 0
    arrivals: Arrivals = field(default_factory=Arrivals)
    #: The longest time in each gate.  The key has the gates that were held before, and the gate as its last element.
    gates: dict[tuple[str, ...], int] = field(default_factory=dict)
    worst: Activation | None = None
    #: The CPU time up to the first wait, and when that was.
    start_up: int = 0
    first_wait_at: int | None = None
    # The running activation.
    ready_at: int | None = None
    used: int = 0
    waits: bool = False
    #: The gates that are held, and the CPU time in each so far.
    held: dict[str, int] = field(default_factory=dict)
    #: The gates that are held, each with the gates that were held before it.
    paths: dict[str, tuple[str, ...]] = field(default_factory=dict)


@dataclass(slots=True)
class ObservedInterrupt:
    """The measurements of an interrupt or a Swi: its longest run, and its arrivals."""

    computation: int = 0
    arrivals: Arrivals = field(default_factory=Arrivals)


class Observer:
    """Measures from a trace: `trace.listen(observer)`.  After `begin`, activations that run already do not count."""

    def __init__(self) -> None:
        self.tasks: dict[str, ObservedTask] = {}
        self.above: dict[str, ObservedInterrupt] = {}
        #: The names for gates that replace those of the kernel.
        self.gate_names: dict[str, str] = {}
        self._running = ""
        #: The running interrupts and Swis, the innermost last: the name, and the CPU time so far.
        self._stack: list[tuple[str, int]] = []
        self._owner: dict[str, str] = {}
        self._waiting: dict[str, list[str]] = {}
        self._since = 0
        self._stretches: list[CpuSpan] = []
        self._ends: list[int] = []
        self._releases: list[tuple[int, str]] = []
        self._counting = False
        self._handlers: dict[str, Callable[[int, str], None]] = {
            "switch": self._switch, "ready": self._ready, "block": self._block, "gate enter": self._gate_enter,
            "gate wait": self._gate_wait, "gate leave": self._gate_leave, "hwi": self._hwi, "hwi end": self._hwi_end,
            "swi": self._swi, "swi end": self._swi_end,
        }  # fmt: skip

    def __call__(self, cycles: int, kind: str, name: str) -> None:
        """Take in a trace event."""
        handler = self._handlers.get(kind)
        if handler is not None:
            handler(cycles, name)

    def begin(self) -> None:
        """Measure from now on.  Activations that run already do not count."""
        self._counting = True
        for seen in self.tasks.values():
            seen.ready_at = None

    def _account(self, cycles: int) -> None:
        used = cycles - self._since
        if used <= 0:
            return
        begin, self._since = self._since, cycles
        gate = ""
        if self._stack:
            who, so_far = self._stack[-1]
            self._stack[-1] = (who, so_far + used)
        else:
            who = self._running
            if who == IDLE or not who:
                if not any(seen.ready_at is not None for seen in self.tasks.values()):
                    self._stretches.clear()
                    self._ends.clear()
                    self._releases.clear()
                return
            seen = self._seen(who)
            seen.used += used
            for held in seen.held:
                seen.held[held] += used
                gate = held
        self._stretches.append(CpuSpan(who, begin, cycles, gate))
        self._ends.append(cycles)

    def _seen(self, name: str) -> ObservedTask:
        seen = self.tasks.get(name)
        if seen is None:
            seen = self.tasks[name] = ObservedTask()
        return seen

    def _switch(self, cycles: int, name: str) -> None:
        self._account(cycles)
        self._running = name

    def _ready(self, cycles: int, name: str) -> None:
        self._account(cycles)
        seen = self._seen(name)
        if seen.waits:
            seen.waits = False
            return
        seen.used = 0
        if self._counting:
            seen.ready_at = cycles
            seen.arrivals.add(cycles)
            self._releases.append((cycles, name))

    def _block(self, cycles: int, name: str) -> None:
        self._account(cycles)
        seen = self._seen(name)
        if seen.first_wait_at is None and not seen.waits:
            seen.start_up, seen.first_wait_at = seen.used, cycles
        if seen.waits or seen.ready_at is None:
            return
        ready, seen.ready_at = seen.ready_at, None
        seen.activations += 1
        seen.computation = max(seen.computation, seen.used)
        response = cycles - ready
        if response > seen.response:
            seen.response = response
            stretches = self._stretches[bisect_left(self._ends, ready + 1) :]
            releases = [(at, who) for at, who in self._releases if at >= ready]
            seen.worst = Activation(name, ready, cycles, tuple(stretches), tuple(releases))

    def _gate_enter(self, cycles: int, name: str) -> None:
        self._account(cycles)
        self._enter(self._running, name)

    def _enter(self, task: str, gate: str) -> None:
        seen = self._seen(task)
        seen.paths[gate] = (*seen.held, gate)
        seen.held[gate] = 0
        self._owner[gate] = task
        if task in self._waiting.get(gate, ()):
            self._waiting[gate].remove(task)

    def _gate_wait(self, cycles: int, name: str) -> None:
        self._account(cycles)
        self._seen(self._running).waits = True
        self._waiting.setdefault(name, []).append(self._running)

    def _gate_leave(self, cycles: int, name: str) -> None:
        self._account(cycles)
        owner = self._owner.pop(name, "")
        seen = self._seen(owner)
        if name in seen.held:
            stay = seen.held.pop(name)
            path = seen.paths[name]
            if self._counting:
                for outer in range(1, len(path)):
                    seen.gates.setdefault(path[:outer], 0)
                seen.gates[path] = max(stay, seen.gates.get(path, 0))
        # `GateMutexPri` has made the next owner ready already.  With `GateMutex`, the next owner's `enter` comes later.
        for task in [task for task in self._waiting.get(name, ()) if not self._seen(task).waits][:1]:
            self._enter(task, name)

    def _hwi(self, cycles: int, name: str) -> None:
        # The core's interrupt entry took its cycles before the kernel's trace event.
        self._begin_above(cycles - INTERRUPT_ENTRY_CYCLES, f"Hwi:{name}")

    def _hwi_end(self, cycles: int, name: str) -> None:
        self._end_above(cycles + INTERRUPT_EXIT_CYCLES)

    def _swi(self, cycles: int, name: str) -> None:
        self._begin_above(cycles, f"Swi:{name}")

    def _swi_end(self, cycles: int, name: str) -> None:
        self._end_above(cycles)

    def _begin_above(self, cycles: int, name: str) -> None:
        self._account(cycles)
        self._stack.append((name, 0))
        if self._counting:
            self.above.setdefault(name, ObservedInterrupt()).arrivals.add(cycles)

    def _end_above(self, cycles: int) -> None:
        self._account(cycles)
        if self._stack:
            name, used = self._stack.pop()
            if name in self.above:
                self.above[name].computation = max(self.above[name].computation, used)

    def names(self) -> Sequence[str]:
        """The tasks that have ended an activation."""
        return [name for name, seen in self.tasks.items() if seen.activations and name != IDLE]

    def measured(
        self, tasks: Mapping[str, tuple[int, int]], *, periods_ns: Mapping[str, int] | None = None,
        around_gate_cycles: int = 0,
    ) -> TaskSet:  # fmt: skip
        """The measurements as a task set.

        `tasks` gives the priority and the deadline of each task (in ns; 0: the period).  `periods_ns` gives the known
        periods; a shorter distance counts as jitter.  Other tasks have the distances that were measured.
        """
        found = []
        for name in self.names():
            priority, deadline_ns = tasks[name]
            seen = self.tasks[name]
            arrival = _arrival(seen.arrivals, (periods_ns or {}).get(name))
            sections = self._sections(seen, around_gate_cycles, ())
            found.append(
                TaskModel(
                    name, priority, arrival, seen.computation * NS_PER_CYCLE, deadline_ns or arrival.period_ns,
                    sections, seen.start_up * NS_PER_CYCLE,
                )
            )  # fmt: skip
        above = tuple(
            Interrupt(name, _arrival(seen.arrivals, None), seen.computation * NS_PER_CYCLE)
            for name, seen in self.above.items()
            if seen.computation
        )
        return TaskSet(tuple(found), above)

    def _sections(self, seen: ObservedTask, around_gate_cycles: int, held: tuple[str, ...]) -> tuple[Section, ...]:
        return tuple(
            Section(
                self.gate_names.get(path[-1], path[-1]), (cycles + around_gate_cycles) * NS_PER_CYCLE,
                self._sections(seen, around_gate_cycles, path),
            )
            for path, cycles in seen.gates.items()
            if path[:-1] == held
        )  # fmt: skip


def _arrival(arrivals: Arrivals, period_ns: int | None) -> Arrival:
    """The measured arrivals.  After a single one nothing is known; its period counts as an hour."""
    spans = [span * NS_PER_CYCLE for span in arrivals.distances]
    if period_ns is None:
        return Arrival(max(1, spans[0]), distances_ns=tuple(spans)) if spans else Arrival(3600 * 10**9)
    jitter = max((number * period_ns - span for number, span in enumerate(spans, 1)), default=0)
    return Arrival(period_ns, max(0, jitter))
