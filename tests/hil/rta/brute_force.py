"""Tasks without gates on one processor, nanosecond by event: written without any formula of `hil.rta`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import lcm

from hil.rta.task_set import TaskModel


def worst_responses(tasks: Sequence[TaskModel], offsets: Mapping[str, int]) -> dict[str, int]:
    """The worst time from release to end of each task over two hyperperiods after the last offset.

    Each is released at its offset and then every period; the most urgent one runs, of two the one released first.
    """
    end = max(offsets.values()) + 2 * lcm(*(task.arrival.period_ns for task in tasks))
    releases = sorted(
        (time, -task.priority, task.name, task.computation_ns)
        for task in tasks
        for time in range(offsets[task.name], end, task.arrival.period_ns)
    )
    worst = dict.fromkeys((task.name for task in tasks), 0)
    ready: list[list[int | str]] = []
    now = index = 0
    while index < len(releases) or ready:
        if not ready:
            now = max(now, releases[index][0])
        while index < len(releases) and releases[index][0] <= now:
            time, minus_priority, name, left = releases[index]
            ready.append([minus_priority, time, name, left])
            index += 1
        ready.sort(key=lambda job: (job[0], job[1]))
        job = ready[0]
        until = releases[index][0] if index < len(releases) else now + int(job[3])
        step = min(int(job[3]), until - now)
        now += step
        job[3] = int(job[3]) - step
        if not job[3]:
            worst[str(job[2])] = max(worst[str(job[2])], now - int(job[1]))
            ready.pop(0)
    return worst
