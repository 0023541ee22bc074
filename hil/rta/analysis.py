"""Response-time analysis with fixed priorities: the exact one, and the bounds that a course adds.

Modelled
    The busy window (Joseph and Pandya 1986; Lehoczky 1990 and Tindell 1994 for deadlines beyond the period and release
    jitter).  Blocking under three protocols:

    ceiling      immediate ceiling: the longest single section of a less urgent task in a gate that a task of this
                 priority or above enters, too.
    inheritance  Sha, Rajkumar, Lehoczky 1990: each less urgent task blocks at most once, each gate at most once; the
                 worst such choice.  `GateMutexPri` does this as long as no gate is entered within another: the owner
                 is raised when a more urgent task waits, and lowered when it leaves.
    none         a less urgent owner keeps its priority, and tasks in between run before it: all tasks down to the least
                 urgent owner that matters count as if they were above, with the work that was left from before.

    With nested gates, `GateMutexPri` raises only the owner of the gate, not the task that this owner waits for, and
    lowers it at the first `leave`.  Then no bound better than `none` holds, and `inheritance` is computed as `none`.
    Tasks that may wait in a circle have no bound, except under `ceiling`, where no task waits.
    Tasks of one priority delay each other (CHOICE: each counts as if it was above the other, which is never too low).
Not modelled
    Tasks that wait in the middle of an activation for anything but a gate (`Task_sleep`).
Time
    Whole nanoseconds, no rounding.
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

#: After so many activations in one busy window the search ends: the processor is full, or next to it.
_MAX_ACTIVATIONS: Final = 10_000
#: How often something comes in a window, and what it takes each time.
_Demand = tuple[Callable[[int], int], int]


class Protocol(StrEnum):
    """How a gate treats its owner while a task of higher priority waits."""

    NONE = "none"
    INHERITANCE = "inheritance"
    CEILING = "ceiling"


@dataclass(frozen=True, slots=True)
class ResponseBound:
    """What was computed of one task.  None: there is no bound, the processor is too full."""

    task: TaskModel
    blocking_ns: int
    #: From the release as it should come, with the task's own jitter.
    response_ns: int | None
    #: From the moment at which it is ready.
    ready_to_end_ns: int | None
    course_bound_ns: int

    @property
    def slack_ns(self) -> int | None:
        """What is left up to the deadline; negative: it is missed."""
        return None if self.response_ns is None else self.task.deadline_ns - self.response_ns

    @property
    def in_time(self) -> bool:
        """Whether the deadline is kept."""
        return self.response_ns is not None and self.response_ns <= self.task.deadline_ns


@dataclass(frozen=True, slots=True)
class StartUp:
    """When a task is ready for its work at last, from the start of the kernel, and how many releases wait by then."""

    task: TaskModel
    ready_ns: int | None
    releases: int


@dataclass(frozen=True, slots=True)
class Bounds:
    """Tests by utilisation alone.  They speak of tasks with D = T whose priorities follow their periods."""

    utilisation: float
    liu_layland: float
    hyperbolic: float

    @property
    def liu_layland_holds(self) -> bool:
        """Whether the first one says yes; no means nothing."""
        return self.utilisation <= self.liu_layland

    @property
    def hyperbolic_holds(self) -> bool:
        """Whether the product of U + 1 is at most 2; no means nothing."""
        return self.hyperbolic <= 2


def blocking_ns(task_set: TaskSet, task: TaskModel, protocol: Protocol) -> int:
    """The longest that less urgent tasks can hold `task` up by their own sections.

    Under `none` it is what their sections take alone; who runs between comes on top in `response`.
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
    """For each less urgent task its longest stay in each gate that a task of this priority, or above, enters."""
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
    """The sufficient test of TFG 3.4.4: every more urgent task as often as it fits into the deadline, rounded up."""
    above = sum(
        -(-task.deadline_ns // other.arrival.period_ns) * other.computation_ns
        for other in task_set.tasks
        if other.priority > task.priority
    )
    return above + task.computation_ns + blocked_ns


def analyse(
    task_set: TaskSet, protocol: Protocol = Protocol.INHERITANCE, *, blocked_ns: Mapping[str, int] | None = None
) -> tuple[ResponseBound, ...]:
    """Every task, the most urgent first.  `blocked_ns` gives blocking times in place of computed ones."""
    found: dict[str, ResponseBound] = {}
    alone = protocol is Protocol.NONE or (protocol is Protocol.INHERITANCE and task_set.nested)
    stuck = _stuck(task_set) if alone else frozenset()
    for task in reversed(task_set.by_priority()):  # the least urgent first: `none` asks for those below
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
    """Tasks that may wait for ever: they enter a gate of a circle, or one that is held by who waits in it."""
    gates = set(task_set.circles())
    orders = [order for task in task_set.tasks for section in task.sections for order in section.orders()]
    while more := {held for held, entered in orders if entered in gates} - gates:
        gates |= more
    return frozenset(task.name for task in task_set.tasks if any(s.gate in gates for s in task.stays))


def _run_between(task_set: TaskSet, task: TaskModel) -> Sequence[TaskModel]:
    """Less urgent tasks that can run while `task`, or one above it, waits for a gate whose owner nobody raises."""
    lowest = task.priority
    while True:
        gates = {section.gate for other in task_set.tasks if other.priority >= lowest for section in other.stays}
        owners = [other.priority for other in task_set.tasks if any(s.gate in gates for s in other.stays)]
        if min(owners, default=lowest) >= lowest:
            return [other for other in task_set.tasks if lowest <= other.priority < task.priority]
        lowest = min(owners)


def _demand(task_set: TaskSet, items: Sequence[TaskModel]) -> list[_Demand]:
    """What tasks ask of the processor in a window, with their switches."""
    return [(item.arrival.count, item.computation_ns + 2 * task_set.switch_ns) for item in items]


def _responses(
    task_set: TaskSet, task: TaskModel, blocked_ns: int, below: Sequence[tuple[TaskModel, int | None]]
) -> tuple[int, int] | None:
    """The worst response over a whole busy window: from the nominal release, and from ready."""
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
        # What was released up to a response before the window may still run in it.
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
    """The least window that holds `work_ns` and all that the others ask for in it."""
    window = at_least_ns
    while (longer := work_ns + sum(count(window) * time for count, time in others)) > window:
        window = longer
        if window > most_ns:
            return None
    return window


def _with_carry_in(arrival: Arrival, response_ns: int, window_ns: int) -> int:
    return arrival.count(window_ns + response_ns)


def _earliest(arrival: Arrival, number: int) -> int:
    """When the release with this number should have come, the first one being ready at 0 as late as it may be."""
    distances = arrival.distances_ns
    if not distances or not distances[-1]:
        return number * arrival.period_ns - arrival.jitter_ns
    rounds, rest = divmod(number, len(distances))
    return rounds * distances[-1] + (distances[rest - 1] if rest else 0)


def bounds(task_set: TaskSet) -> Bounds:
    """What the tests by utilisation say."""
    count = len(task_set.tasks) + len(task_set.interrupts)
    shares = [task.utilisation for task in task_set.tasks] + [i.utilisation for i in task_set.interrupts]
    return Bounds(
        task_set.utilisation, count * (2 ** (1 / count) - 1) if count else 1.0, prod(share + 1 for share in shares)
    )


def most_computation_ns(task_set: TaskSet, name: str, protocol: Protocol = Protocol.INHERITANCE) -> int | None:
    """How long the computation of one task may take, all else as it is, with every deadline kept; None: not even so.

    Its sections stay as they are.
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
    """The factor by which all computation times of tasks (and their sections) may grow; None: it is below 1."""

    def longer(sections: Sequence[Section], thousandths: int) -> tuple[Section, ...]:
        return tuple(
            Section(s.gate, -(-s.time_ns * thousandths // 1000), longer(s.inner, thousandths)) for s in sections
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
    """The last whole number from `low` (kept) to below `high` (not kept) that is kept."""
    while high - low > 1:
        middle = (low + high) // 2
        if holds_with(middle):
            low = middle
        else:
            high = middle
    return low


def start_up(task_set: TaskSet, first_release_ns: int = 0) -> tuple[StartUp, ...]:
    """When each task has done its own start-up, while those above already get their releases.

    The kernel starts at 0; the releases begin at `first_release_ns`.  Blocking does not count: no gate is entered yet.
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
