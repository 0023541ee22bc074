"""A task set: tasks, interrupts, and the gates that tasks enter.  All times are whole nanoseconds.

Priorities are those of SYS/BIOS: a larger number is a higher priority, and tasks of one priority run in the order in
which they became ready.  Interrupts and Swis are above all tasks.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, field

NS_PER_US = 1000
NS_PER_MS = 1_000_000


@dataclass(frozen=True, slots=True)
class Arrival:
    """The arrivals of releases or interrupts.

    There is at most one in each `period_ns`, and each is up to `jitter_ns` late.  Or `distances_ns` gives the least
    times that 2, 3, 4, ... consecutive arrivals can span; the last of them repeats.
    """

    period_ns: int
    jitter_ns: int = 0
    distances_ns: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        if self.period_ns <= 0:
            raise ValueError(f"a period of {self.period_ns} ns: it must be more than 0")

    def count(self, window_ns: int) -> int:
        """The most arrivals in a half-open window of this length."""
        if window_ns <= 0:
            return 0
        distances = self.distances_ns
        if not distances or not distances[-1]:
            return -(-(window_ns + self.jitter_ns) // self.period_ns)
        rounds = (window_ns - 1) // distances[-1]
        rest = window_ns - rounds * distances[-1]
        return rounds * len(distances) + 1 + sum(span < rest for span in distances[:-1])

    @property
    def mean_ns(self) -> float:
        """The least mean distance of arrivals over a long time."""
        distances = self.distances_ns
        return distances[-1] / len(distances) if distances and distances[-1] else float(self.period_ns)


@dataclass(frozen=True, slots=True)
class Section:
    """The longest time of a task in a gate, from `enter` to `leave`, without pre-emption; `inner`: gates within it."""

    gate: str
    time_ns: int
    inner: tuple[Section, ...] = ()

    def all(self) -> Iterator[Section]:
        """This section, and those within it."""
        yield self
        for section in self.inner:
            yield from section.all()

    def orders(self) -> Iterator[tuple[str, str]]:
        """Pairs of gates: the first is held while the second is entered."""
        for section in self.inner:
            yield from ((self.gate, within.gate) for within in section.all())
            yield from section.orders()


@dataclass(frozen=True, slots=True)
class TaskModel:
    """A task.  `computation_ns` contains its `sections`; `start_up_ns` is the computation before its first wait."""

    name: str
    priority: int
    arrival: Arrival
    computation_ns: int
    deadline_ns: int
    sections: tuple[Section, ...] = ()
    start_up_ns: int = 0

    @property
    def utilisation(self) -> float:
        """Its share of the processor."""
        return self.computation_ns / self.arrival.mean_ns

    @property
    def stays(self) -> Sequence[Section]:
        """All sections of the task, also those within others."""
        return [section for outer in self.sections for section in outer.all()]


@dataclass(frozen=True, slots=True)
class Interrupt:
    """An interrupt or a Swi.  It is above all tasks."""

    name: str
    arrival: Arrival
    computation_ns: int

    @property
    def utilisation(self) -> float:
        """Its share of the processor."""
        return self.computation_ns / self.arrival.mean_ns


@dataclass(frozen=True, slots=True)
class TaskSet:
    """Tasks and interrupts on one processor.

    `switch_ns` is the time of a task switch, if the computation times do not contain it.  It is added twice to each
    activation: for the switch to the task, and for the switch back to the pre-empted task.
    """

    tasks: tuple[TaskModel, ...]
    interrupts: tuple[Interrupt, ...] = ()
    switch_ns: int = 0
    name: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        names = [task.name for task in self.tasks] + [interrupt.name for interrupt in self.interrupts]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"{name!r} occurs twice")

    def by_priority(self) -> Sequence[TaskModel]:
        """The tasks, the highest priority first."""
        return sorted(self.tasks, key=lambda task: -task.priority)

    def ceilings(self) -> dict[str, int]:
        """Gate -> the highest priority of the tasks that enter it."""
        found: dict[str, int] = {}
        for task in self.tasks:
            for section in task.stays:
                found[section.gate] = max(found.get(section.gate, 0), task.priority)
        return found

    @property
    def nested(self) -> bool:
        """Whether a task enters a gate while it holds another."""
        return any(section.inner for task in self.tasks for section in task.sections)

    def circles(self) -> frozenset[str]:
        """The gates of possible deadlocks: each task holds one of them and waits for the next, in a circle.

        CHOICE: a gate around all of them would prevent the deadlock; this is not checked.
        """
        orders = {(*order, task.name) for task in self.tasks for section in task.sections for order in section.orders()}

        def leads(held: str, to: str, by: Set[str]) -> bool:
            return any(
                entered == to or leads(entered, to, by | {name})
                for gate, entered, name in orders
                if gate == held and name not in by
            )

        return frozenset(held for held, entered, name in orders if leads(entered, held, {name}))

    @property
    def utilisation(self) -> float:
        """The sum of C/T over tasks, their switches and interrupts."""
        switches = sum(2 * self.switch_ns / task.arrival.mean_ns for task in self.tasks)
        return (
            sum(task.utilisation for task in self.tasks)
            + sum(interrupt.utilisation for interrupt in self.interrupts)
            + switches
        )
