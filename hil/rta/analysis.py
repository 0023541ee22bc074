"""Response-time analysis with fixed priorities: the exact analysis, and the simpler bounds of a course.

Modelled
    The analysis uses the busy window (Joseph and Pandya 1986; Lehoczky 1990 and Tindell 1994 for deadlines beyond the
    period and for release jitter).  Blocking is computed under three protocols:

    ceiling      Immediate ceiling.  The blocking time is the longest single critical section of a task of lower
                 priority in a gate that a task of this priority or above enters, too.
    inheritance  Sha, Rajkumar, Lehoczky 1990.  Each task of lower priority blocks at most once, and each gate at most
                 once; the worst such choice counts.  `GateMutexPri` does this as long as no gate is entered within
                 another: the owner's priority is raised when a task of higher priority waits, and lowered at `leave`.
    none         The owner keeps its lower priority, and tasks in between run before it.  All tasks down to the lowest
                 owner that matters count as tasks of higher priority, with the work that was left from before.

    With nested gates, `GateMutexPri` raises only the owner of the gate, not the task for which this owner waits, and
    lowers it at the first `leave`.  Then no bound better than `none` holds, and `inheritance` is computed as `none`.
    Tasks that may wait in a circle have no bound, except under `ceiling`, where no task waits.
    Tasks of one priority delay each other.  CHOICE: each counts as if it had the higher priority, so the bound is safe.
Not modelled
    Tasks that wait during an activation for anything but a gate (`Task_sleep`).
Time
    Times are whole nanoseconds, without rounding.
Sources
    TFG 3.4.4 for `course_bound_ns`; Liu and Layland 1973; Bini, Buttazzo and Buttazzo 2003 for the hyperbolic bound.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cache, partial
from math import prod
from typing import Final

from hil.rta.task_set import Arrival, Section, TaskModel, TaskSet

#: The search ends after this number of activations in one busy window: the utilisation is 1, or close to it.
_MAX_ACTIVATIONS: Final = 10_000
#: The number of arrivals in a window of a length, and the computation time of each.
_Demand = tuple[Callable[[int], int], int]


class Protocol(StrEnum):
    """The protocol of a gate: what happens to the owner's priority while a task of higher priority waits."""

    NONE = "none"
    INHERITANCE = "inheritance"
    CEILING = "ceiling"


@dataclass(frozen=True, slots=True)
class ResponseBound:
    """The result for one task.  None: there is no bound, because the utilisation is too high."""

    task: TaskModel
    blocking_ns: int
    #: From the nominal release, with the task's own jitter, to the end.
    response_ns: int | None
    #: From the moment at which the task is ready to the end.
    ready_to_end_ns: int | None
    course_bound_ns: int

    @property
    def slack_ns(self) -> int | None:
        """The time between response and deadline; negative if the deadline is missed."""
        return None if self.response_ns is None else self.task.deadline_ns - self.response_ns

    @property
    def in_time(self) -> bool:
        """Whether the deadline is kept."""
        return self.response_ns is not None and self.response_ns <= self.task.deadline_ns


@dataclass(frozen=True, slots=True)
class StartUp:
    """When a task has finished its own start-up, from the start of the kernel, and how many releases wait by then."""

    task: TaskModel
    ready_ns: int | None
    releases: int


@dataclass(frozen=True, slots=True)
class Bounds:
    """Tests that use only the utilisation.  They hold for rate-monotonic priorities and deadlines equal to periods."""

    utilisation: float
    liu_layland: float
    hyperbolic: float

    @property
    def liu_layland_holds(self) -> bool:
        """Whether the bound of Liu and Layland holds.  If not, this shows nothing."""
        return self.utilisation <= self.liu_layland

    @property
    def hyperbolic_holds(self) -> bool:
        """Whether the product of U + 1 is at most 2 (hyperbolic bound).  If not, this shows nothing."""
        return self.hyperbolic <= 2


def blocking_ns(task_set: TaskSet, task: TaskModel, protocol: Protocol) -> int:
    """The longest time for which critical sections of tasks of lower priority can block `task`.

    Under `none` it is only the time of their sections; `response` adds the tasks that run in between.
    """
    below, ceilings = _sections_that_block(task_set, task)
    if protocol is Protocol.CEILING:
        return max((time for sections in below for time in sections.values()), default=0)
    gates = sorted(gate for gate, ceiling in ceilings.items() if ceiling >= task.priority)

    @cache
    def worst(index: int, left: frozenset[str]) -> int:
        if index == len(below):
            return 0
        sections = below[index]
        choices = (sections[gate] + worst(index + 1, left - {gate}) for gate in left if gate in sections)
        return max(worst(index + 1, left), *choices, 0)

    return worst(0, frozenset(gates))


def _sections_that_block(task_set: TaskSet, task: TaskModel) -> tuple[Sequence[Mapping[str, int]], Mapping[str, int]]:
    """For each task of lower priority, its longest section in each gate that a task of this priority or above enters.
    """
    ceilings = task_set.ceilings()
    found = []
    for other in task_set.tasks:
        if other.priority >= task.priority:
            continue
        sections: dict[str, int] = {}
        for section in other.stays:
            if ceilings[section.gate] >= task.priority:
                sections[section.gate] = max(section.time_ns, sections.get(section.gate, 0))
        if sections:
            found.append(sections)
    return found, ceilings


def course_bound_ns(task_set: TaskSet, task: TaskModel, blocked_ns: int) -> int:
    """The sufficient test of TFG 3.4.4.

    Each task of higher priority counts as often as its period fits in the deadline, rounded up.
    """
    above = sum(
        -(-task.deadline_ns // other.arrival.period_ns) * other.computation_ns
        for other in task_set.tasks
        if other.priority > task.priority
    )
    return above + task.computation_ns + blocked_ns


def analyse(
    task_set: TaskSet, protocol: Protocol = Protocol.INHERITANCE, *, blocked_ns: Mapping[str, int] | None = None
) -> tuple[ResponseBound, ...]:
    """Analyse all tasks, the highest priority first.  `blocked_ns` replaces computed blocking times by given ones."""
    found: dict[str, ResponseBound] = {}
    alone = protocol is Protocol.NONE or (protocol is Protocol.INHERITANCE and task_set.nested)
    stuck = _stuck(task_set) if alone else frozenset()
    for task in reversed(task_set.by_priority()):  # the lowest priority first: `none` needs the tasks below
        blocked = blocking_ns(task_set, task, Protocol.INHERITANCE if alone else protocol)
        below: list[tuple[TaskModel, int | None]] = []
        if blocked_ns is not None:
            blocked = blocked_ns[task.name]
        elif alone:
            below = [(other, found[other.name].response_ns) for other in _run_between(task_set, task)]
        computed = None if task.name in stuck else _responses(task_set, task, 0 if below else blocked, below)
        whole, ready = computed or (None, None)
        found[task.name] = ResponseBound(task, blocked, whole, ready, course_bound_ns(task_set, task, blocked))
    return tuple(found[task.name] for task in task_set.by_priority())


def _stuck(task_set: TaskSet) -> frozenset[str]:
    """The tasks that may wait for ever: they enter a gate of a circle, or a gate whose owner waits in a circle."""
    gates = set(task_set.circles())
    orders = [order for task in task_set.tasks for section in task.sections for order in section.orders()]
    while more := {held for held, entered in orders if entered in gates} - gates:
        gates |= more
    return frozenset(task.name for task in task_set.tasks if any(stay.gate in gates for stay in task.stays))


def _run_between(task_set: TaskSet, task: TaskModel) -> Sequence[TaskModel]:
    """The tasks of lower priority that can run while `task`, or one above it, waits for a gate without inheritance."""
    lowest = task.priority
    while True:
        gates = {section.gate for other in task_set.tasks if other.priority >= lowest for section in other.stays}
        owners = [other.priority for other in task_set.tasks if any(stay.gate in gates for stay in other.stays)]
        if min(owners, default=lowest) >= lowest:
            return [other for other in task_set.tasks if lowest <= other.priority < task.priority]
        lowest = min(owners)


def _demand(task_set: TaskSet, items: Sequence[TaskModel]) -> list[_Demand]:
    """The demand of tasks on the processor in a window, with their task switches."""
    return [(item.arrival.count, item.computation_ns + 2 * task_set.switch_ns) for item in items]


def _responses(
    task_set: TaskSet, task: TaskModel, blocked_ns: int, below: Sequence[tuple[TaskModel, int | None]]
) -> tuple[int, int] | None:
    """The worst response times in a whole busy window: from the nominal release, and from the moment of being ready."""
    equal_or_above = [other for other in task_set.tasks if other is not task and other.priority >= task.priority]
    switches = 2 * task_set.switch_ns
    load = sum(interrupt.utilisation for interrupt in task_set.interrupts) + sum(
        (item.computation_ns + switches) / item.arrival.mean_ns
        for item in (task, *equal_or_above, *(other for other, _ in below))
    )
    if load > 1 + 1e-12:
        return None
    others = _demand(task_set, equal_or_above)
    others += [(interrupt.arrival.count, interrupt.computation_ns) for interrupt in task_set.interrupts]
    for other, response in below:
        if response is None:
            return None
        # Work that was released before the window, by up to its response time, may still run in the window.
        others.append((partial(_with_carry_in, other.arrival, response), other.computation_ns + switches))
    own, arrival = task.computation_ns + switches, task.arrival
    window = worst = worst_ready = 0
    for number in range(_MAX_ACTIVATIONS):
        work = (number + 1) * own + blocked_ns
        found = _least_window(work, max(window, work), others, _MAX_ACTIVATIONS * arrival.period_ns)
        if found is None:
            return None
        window = found
        nominal = _earliest(arrival, number)
        worst = max(worst, window - nominal)
        worst_ready = max(worst_ready, window - max(0, nominal))
        if arrival.count(window) <= number + 1:
            return worst, worst_ready
    return None


def _least_window(work_ns: int, at_least_ns: int, others: Sequence[_Demand], most_ns: int) -> int | None:
    """The shortest window that has room for `work_ns` and for the demand of the others in it."""
    window = at_least_ns
    while (longer := work_ns + sum(count(window) * time for count, time in others)) > window:
        window = longer
        if window > most_ns:
            return None
    return window


def _with_carry_in(arrival: Arrival, response_ns: int, window_ns: int) -> int:
    return arrival.count(window_ns + response_ns)


def _earliest(arrival: Arrival, number: int) -> int:
    """The nominal time of the release with this number, if the first release is ready at 0 with its whole jitter."""
    distances = arrival.distances_ns
    if not distances or not distances[-1]:
        return number * arrival.period_ns - arrival.jitter_ns
    rounds, rest = divmod(number, len(distances))
    return rounds * distances[-1] + (distances[rest - 1] if rest else 0)


def bounds(task_set: TaskSet) -> Bounds:
    """The results of the tests that use only the utilisation."""
    count = len(task_set.tasks) + len(task_set.interrupts)
    shares = [task.utilisation for task in task_set.tasks]
    shares += [interrupt.utilisation for interrupt in task_set.interrupts]
    return Bounds(
        task_set.utilisation, count * (2 ** (1 / count) - 1) if count else 1.0, prod(share + 1 for share in shares)
    )


def most_computation_ns(task_set: TaskSet, name: str, protocol: Protocol = Protocol.INHERITANCE) -> int | None:
    """The longest computation time of one task with which all deadlines are kept; None if there is none.

    Everything else, also the sections of the task, stays as it is.
    """
    task = next(task for task in task_set.tasks if task.name == name)

    def holds_with(computation_ns: int) -> bool:
        longer = replace(task, computation_ns=computation_ns)
        changed = tuple(longer if other is task else other for other in task_set.tasks)
        return all(response.in_time for response in analyse(replace(task_set, tasks=changed), protocol))

    if not holds_with(task.computation_ns):
        return None
    return _largest(holds_with, task.computation_ns, task.deadline_ns + 1)


def most_growth(task_set: TaskSet, protocol: Protocol = Protocol.INHERITANCE) -> float | None:
    """The factor by which the computation times of all tasks, and their sections, may grow; None if it is below 1."""

    def longer(sections: Sequence[Section], thousandths: int) -> tuple[Section, ...]:
        return tuple(
            Section(section.gate, -(-section.time_ns * thousandths // 1000), longer(section.inner, thousandths))
            for section in sections
        )

    def holds_with(thousandths: int) -> bool:
        tasks = tuple(
            replace(
                task, computation_ns=-(-task.computation_ns * thousandths // 1000),
                sections=longer(task.sections, thousandths),
            )
            for task in task_set.tasks
        )  # fmt: skip
        return all(response.in_time for response in analyse(replace(task_set, tasks=tasks), protocol))

    if not task_set.tasks or not holds_with(1000):
        return None
    fullest = max(task.computation_ns / task.deadline_ns for task in task_set.tasks)
    return _largest(holds_with, 1000, int(1000 / fullest) + 2) / 1000


def _largest(holds_with: Callable[[int], bool], low: int, high: int) -> int:
    """The greatest whole number for which `holds_with` is true.  It is true for `low` and false for `high`."""
    while high - low > 1:
        middle = (low + high) // 2
        if holds_with(middle):
            low = middle
        else:
            high = middle
    return low


def start_up(task_set: TaskSet, first_release_ns: int = 0) -> tuple[StartUp, ...]:
    """When each task has finished its own start-up, while the tasks above already get their releases.

    The kernel starts at 0, and the releases begin at `first_release_ns`.  There is no blocking: no task has entered a
    gate yet.
    """
    found = []
    for task in task_set.by_priority():
        above = [other for other in task_set.tasks if other is not task and other.priority >= task.priority]
        work = task.start_up_ns + sum(other.start_up_ns for other in above)
        others: list[_Demand] = [
            (partial(_from, first_release_ns, count), time) for count, time in _demand(task_set, above)
        ]
        others += [(interrupt.arrival.count, interrupt.computation_ns) for interrupt in task_set.interrupts]
        ready = _least_window(work, work, others, 1000 * (work + task.arrival.period_ns))
        releases = 0 if ready is None else task.arrival.count(ready - first_release_ns)
        found.append(StartUp(task, ready, releases))
    return tuple(found)


def _from(first_ns: int, count: Callable[[int], int], window_ns: int) -> int:
    return count(window_ns - first_ns)
