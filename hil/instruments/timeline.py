"""The states of tasks against time, from the events of the kernel: running, ready (pre-empted) or waiting."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum


class TaskState(Enum):
    """The state of a task.  A blocked task has no span."""

    RUNNING = "running"
    READY = "ready, the CPU is somebody else's"
    WAITING = "waits at a gate"


@dataclass(frozen=True, slots=True)
class Span:
    """A task in one state from `begin` to `end`, in cycles; `raised`: it had an inherited priority."""

    lane: str
    begin: int
    end: int
    state: TaskState
    raised: bool = False


Event = tuple[int, str, str]


class TaskTimeline:
    """Follows the events, and keeps the states.  `spans` are the spans that have ended; a reader may remove them."""

    def __init__(self, base: Mapping[str, int]) -> None:
        self._base = base
        self.spans: list[Span] = []
        self._state: dict[str, tuple[TaskState, int]] = {}
        self._raised: set[str] = set()
        self._waiting: set[str] = set()
        self._nested: list[tuple[str, int]] = []
        self.current = ""

    def close(self, name: str, now: int) -> None:
        """End the state of a task."""
        known = self._state.pop(name, None)
        if known is not None and now > known[1]:
            self.spans.append(Span(name, known[1], now, known[0], name in self._raised))

    def end(self, now: int) -> None:
        """End all states."""
        for name in list(self._state):
            self.close(name, now)

    def open(self, name: str, state: TaskState, now: int) -> None:
        """Begin another state of a task."""
        self.close(name, now)
        self._state[name] = (state, now)

    def take(self, now: int, kind: str, name: str) -> None:
        """Take in an event."""
        match kind:
            case "switch":
                # A task that ran and has not blocked was pre-empted.
                before = self._state.get(self.current)
                if before is not None and self.current != name and before[0] is TaskState.RUNNING:
                    self.open(self.current, TaskState.READY, now)
                self.current = name
                self.open(name, TaskState.RUNNING, now)
            case "ready":
                self._waiting.discard(name)
                if name != self.current:
                    self.open(name, TaskState.READY, now)
            case "block":
                self.close(name, now)
                if name in self._waiting:
                    self.open(name, TaskState.WAITING, now)
            case "gate wait":
                self._waiting.add(self.current)
            case "priority":
                task, _, value = name.partition("=")
                state = self._state.get(task)
                if state is not None:
                    self.open(task, state[0], now)
                raised = value.lstrip("-").isdecimal() and int(value) > self._base.get(task, 16)
                (self._raised.add if raised else self._raised.discard)(task)
            case "hwi" | "swi":
                self._nested.append((f"{kind.title()} {name}", now))
            case "hwi end" | "swi end":
                if self._nested:
                    lane, begin = self._nested.pop()
                    self.spans.append(Span(lane, begin, now, TaskState.RUNNING))


def spans(events: Iterable[Event], base_priorities: Mapping[str, int], now: int) -> list[Span]:
    """The spans of each task, interrupt and Swi up to `now`, from the given events."""
    tasks = TaskTimeline(base_priorities)
    for cycles, kind, name in events:
        tasks.take(cycles, kind, name)
    tasks.end(now)
    return tasks.spans
