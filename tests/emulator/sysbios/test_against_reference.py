"""Random programs do the same, at the same cycle, on the emulated kernel and on a second one read from its sources.

`HIL_FUZZ=20000` runs that many programs, `HIL_FIRST=5000` begins at another seed.
"""

from __future__ import annotations

import os
from itertools import zip_longest
from typing import Any

import pytest

from tests.emulator.sysbios.random_programs import Emulated, Program, make
from tests.emulator.sysbios.reference import TICK, Record, Reference, Steps

PROGRAMS = int(os.environ.get("HIL_FUZZ", "600"))
FIRST = int(os.environ.get("HIL_FIRST", "0"))
TICKS = 25
END = TICKS * TICK + TICK // 2
#: Enough for each planted fault to show.
FAULTY_PROGRAMS = 400


def test_every_program_runs_as_on_the_reference() -> None:
    for seed in range(FIRST, FIRST + PROGRAMS):
        program = make(seed)
        done, wanted = Emulated(program).run(TICKS), Reference(program, END).run()
        if done != wanted:
            at, pair = next((i, pair) for i, pair in enumerate(zip_longest(done, wanted)) if pair[0] != pair[1])
            before = "\n".join(map(str, wanted[max(0, at - 8) : at]))
            said = f"the kernel: {pair[0]}\nreference:  {pair[1]}\nof {program}"
            pytest.fail(f"seed {seed}, after\n{before}\n{said}", pytrace=False)


def test_the_programs_come_to_every_result_of_every_call() -> None:
    """Waits that end by a post, by their time, or at once; keys of outer and inner gates; events in part and whole."""
    seen: dict[str, set[Any]] = {}
    for seed in range(150):
        for _, _, (what, *_), result in Reference(make(seed), END).run():
            seen.setdefault(what, set()).add(result)
    assert seen["pend"] == seen["enter"] == seen["mutex enter"] == seen["mailbox post"] == {0, 1}
    assert seen["event pend"] >= {0, 1, 2, 3, 4, 5, 6, 7}
    assert None in seen["mailbox pend"]
    assert len(seen["mailbox pend"]) > 50
    assert seen["set priority"] == {1, 2, 3, 4, 5, 6}
    assert set(seen) >= {
        "work", "post", "event post", "leave", "mutex leave", "swi post", "sleep", "yield", "task disable",
        "task restore", "swi disable", "swi restore", "hwi disable", "hwi restore",
    }  # fmt: skip


# The comparison sees what is wrong: each of these is the reference with one fault


class WaitersInOrderOfArrival(Reference):
    def by_priority(self, waiting: list[Record], pri: int) -> int:
        return len(waiting)


class EqualWaitersLastFirst(Reference):
    def by_priority(self, waiting: list[Record], pri: int) -> int:
        return next((i for i, elem in enumerate(waiting) if pri >= elem.task.pri), len(waiting))


class WaitersAlwaysByPriority(Reference):
    def __init__(self, program: Program, end: int) -> None:
        super().__init__(program, end)
        for sem in self.sems:
            sem.mode |= 2


class BinaryCounts(Reference):
    def __init__(self, program: Program, end: int) -> None:
        super().__init__(program, end)
        for sem in self.sems:
            sem.mode &= 2


class PlainGateByPriority(Reference):
    def __init__(self, program: Program, end: int) -> None:
        super().__init__(program, end)
        for mutex in self.mutexes:
            mutex.sem.mode = 2


class InheritedIsKept(Reference):
    def leave(self, task: Record, gate: Record, inner: int) -> Steps:
        gate.original = max(gate.original, task.pri)
        return super().leave(task, gate, inner)


class NothingInherited(Reference):
    def enter(self, task: Record, gate: Record) -> Steps:
        if gate.owner is not None and not gate.free and gate.owner is not task:
            key, pri = self.disable(), gate.owner.pri
            gate.owner.pri = 99
            steps = super().enter(task, gate)
            next(steps)
            gate.owner.pri = pri
            self.restore(key)
            yield
            return 0
        return (yield from super().enter(task, gate))


class TimeoutsOneTickLonger(Reference):
    def clock_start(self, timeout: int, period: int, function: Any) -> Record:
        return super().clock_start(timeout + (not period), period, function)


class LateTicksAreDropped(Reference):
    def clock_work(self) -> None:
        self.missed = min(self.missed, 1)
        super().clock_work()


class EventsConsumeOneMask(Reference):
    def match(self, event: Record, and_mask: int, or_mask: int) -> int:
        posted = event.posted
        matching = super().match(event, and_mask, or_mask)
        event.posted = posted & ~(or_mask or matching)
        return matching


class WokenTasksGoFirst(Reference):
    def unblock(self, task: Record) -> None:
        super().unblock(task)
        self.ready[task.pri].insert(0, self.ready[task.pri].pop())


class TasksSwitchInASwiGate(Reference):
    def restore(self, key: bool) -> None:
        if not key and self.work and self.swi_locked and self.swi_pri < 0:
            self.schedule()
        super().restore(key)


class SwisLastFirst(Reference):
    def swi_queue(self, swi: Record) -> None:
        self.swi_ready.setdefault(swi.pri, []).insert(0, swi)


class RaisedTaskGoesBehind(Reference):
    def set_pri(self, task: Record, pri: int) -> int:
        if task is self.cur and task.ready and pri != task.pri:
            key, old = self.disable(), task.pri
            super().set_pri(task, pri)
            self.ready[pri].append(self.ready[pri].pop(0))
            self.cur_q = -1
            self.restore(key)
            return int(old)
        return super().set_pri(task, pri)


class LettersLastFirst(Reference):
    def mailbox_pend(self, thread: Record, box: Record, timeout: int) -> Steps:
        box.letters.reverse()
        letter = yield from super().mailbox_pend(thread, box, timeout)
        return letter


@pytest.mark.parametrize(
    "faulty",
    [
        WaitersInOrderOfArrival, EqualWaitersLastFirst, WaitersAlwaysByPriority, BinaryCounts, PlainGateByPriority,
        InheritedIsKept, NothingInherited, TimeoutsOneTickLonger, LateTicksAreDropped, EventsConsumeOneMask,
        WokenTasksGoFirst, TasksSwitchInASwiGate, SwisLastFirst, RaisedTaskGoesBehind, LettersLastFirst,
    ],
)  # fmt: skip
def test_a_fault_is_seen(faulty: type[Reference]) -> None:
    """On the reference alone, which the kernel equals: a program with the fault has another trace."""
    assert any(
        faulty(program, END).run() != Reference(program, END).run() for program in map(make, range(FAULTY_PROGRAMS))
    )
