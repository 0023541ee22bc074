"""Finds priority inversion: `no-inheritance`, `priority-inversion`.

A task waits for a gate or semaphore that a task of lower priority holds.  Meanwhile a task of medium priority runs.

`GateMutexPri` raises the owner's priority when a higher task begins to wait.  It does not raise a task that the owner
itself waits for, and leaving any gate that was entered earlier takes the raise back.  A raise does not help an owner
that sleeps or pends.  `GateMutex` raises nobody.  Neither does a semaphore used as a mutex (created with 1, posted by
the task that took it).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from emulator.c28x.findings import Findings
from emulator.c28x.position import interrupted
from emulator.c28x.sites import Place
from emulator.clock import us
from emulator.sysbios.gate_mutex_pri import GateMutexPri
from emulator.sysbios.scheduler import BLOCKED, Task
from emulator.sysbios.semaphore import Semaphore
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.gate_exits import ENTER
from emulator.sysbios.watch.gates import Gates
from emulator.sysbios.watch.names import HandleNames
from emulator.sysbios.watch.statements import StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Gate, Thread, ThreadWatch
from emulator.trace import Trace


@dataclass(slots=True)
class BlockedTask:
    """The wait of a task for a gate or semaphore that another thread holds."""

    holder: Thread
    usage: list[int]
    since: int
    taken: StatementNumber
    #: The threads that must run before the wait can end.
    helpers: set[Thread] = field(default_factory=set)
    #: Where one of them blocked during the wait, and the call path if this was the holder itself.
    blocked: str = ""
    path: tuple[Place, ...] = ()
    #: A gate that one of them waited for itself: priority inheritance does not reach the owner of this gate.
    chained: str = ""


class Inversion:
    """Measures which threads ran while a task waited."""

    def __init__(
        self,
        threads: ThreadWatch,
        locator: StatementLocator,
        names: HandleNames,
        findings: Findings,
        gates: Gates,
        calls: Calls,
    ) -> None:
        self._threads = threads
        self._locator = locator
        self._names = names
        self._findings = findings
        self._clock = findings.clock
        self._gates = gates
        self._waits: dict[Thread, tuple[Any, BlockedTask]] = {}
        #: Semaphores that were created with 1 and posted only by their taker.
        self._mutexes: dict[Semaphore, tuple[Thread | None, StatementNumber]] = {}
        calls.after(*ENTER, callback=self._entered)
        calls.after("GateMutexPri_leave", "GateMutex_leave", callback=self._on_leave)
        calls.after("Semaphore_create", callback=self._create)
        calls.before("Semaphore_post", callback=self._post)
        calls.before("Semaphore_pend", callback=self._pend)
        calls.after("Semaphore_pend", callback=self._pended)

    def listen(self, trace: Trace) -> None:
        """Listen to tasks that wait for a gate, and to tasks that block; call it after `Gates.listen`."""
        trace.listen(self._gate_waits, "gate wait", each_tick=False)
        trace.listen(self._blocks, "block", each_tick=False)

    def _gate_waits(self, _cycles: int, _kind: str, _name: str) -> None:
        thread = self._threads.current
        gate = self._gates.waits_for(thread)  # `gates` has handled this event already
        if gate is None or gate.owner is None:
            return
        holder = self._threads.of(gate.owner)
        entry = self._gates.entry(holder, gate)
        self._wait(thread, gate, holder, entry.statement if entry is not None else 0)

    def _blocks(self, _cycles: int, _kind: str, name: str) -> None:
        if self._waits:
            self._blocked(name)

    # Listeners

    def _entered(self, key: int, gate: Gate) -> None:
        if self._waits:
            self._judge(self._threads.current, self._names.of(gate))

    def _on_leave(self, _result: None, gate: Gate, key: int) -> None:
        for waited, wait in self._waits.values():
            if waited is gate and gate.owner is not None:
                wait.helpers.add(self._threads.of(gate.owner))

    def _create(self, semaphore: Semaphore, *_arguments: Any) -> None:
        if semaphore.count == 1:
            self._mutexes[semaphore] = (None, 0)

    def _post(self, semaphore: Semaphore) -> None:
        known = self._mutexes.get(semaphore)
        if known is not None:
            if known[0] is not self._threads.current:
                del self._mutexes[semaphore]
            else:
                self._mutexes[semaphore] = (None, 0)

    def _pend(self, semaphore: Semaphore, timeout: int) -> None:
        holder, statement = self._mutexes.get(semaphore, (None, 0))
        thread = self._threads.current
        if holder is not None and timeout and not semaphore.count and thread.is_task and holder is not thread:
            self._wait(thread, semaphore, holder, statement)

    def _pended(self, taken: int, semaphore: Semaphore, timeout: int) -> None:
        thread = self._threads.current
        if self._waits:
            self._judge(thread, self._names.of(semaphore))
        if taken and semaphore in self._mutexes:
            self._mutexes[semaphore] = (thread, self._locator.here())

    # Waits

    def _wait(self, thread: Thread, what: Any, holder: Thread, taken: StatementNumber) -> None:
        wait = BlockedTask(holder, self._threads.usage(), self._clock.now, taken, {holder})
        self._waits[thread] = what, wait
        if isinstance(holder.what, Task) and holder.what.mode == BLOCKED:
            self._stuck(wait, holder)

    def _blocked(self, name: str) -> None:
        """A task blocks.  If other tasks wait for it, note what it waits for."""
        thread = self._threads.named(name)
        for waiting, (_, wait) in self._waits.items():
            if thread is not None and waiting is not thread and thread in wait.helpers:
                self._stuck(wait, thread)

    def _stuck(self, wait: BlockedTask, helper: Thread) -> None:
        """`helper`, which must run to end `wait`, waits itself: for a gate (its owner must run) or for other things."""
        found = self._waits.get(helper)
        if found is not None and not isinstance(found[0], Semaphore):
            wait.chained = self._names.of(found[0])
            wait.helpers |= found[1].helpers
        elif isinstance(helper.what, Task):
            current = self._threads.kernel.tasks.current
            wait.blocked = self._locator.text(self._locator.of(helper.what, current))
            if helper is wait.holder:
                position = self._findings.position if helper.what is current else helper.what
                wait.path = self._findings.path(*interrupted(position.at, position.calls))

    def _judge(self, thread: Thread, name: str) -> None:
        """The wait is over.  Report it if tasks of priorities in between had the CPU meanwhile."""
        found = self._waits.pop(thread, None)
        if found is None:
            return
        wait = found[1]
        between = [
            (other, cycles)
            for other, cycles in self._threads.used_since(wait.usage)
            if other.is_task and 0 < other.level < thread.level and other not in wait.helpers
        ]
        if not between or wait.holder.level >= thread.level:
            return
        middle, cycles = between[0]
        waited = us(self._clock.now - wait.since)
        holder = wait.holder.name
        lends = isinstance(found[0], GateMutexPri)
        rule = "priority-inversion" if wait.blocked or not lends else "no-inheritance"
        if not lends:
            why = f"a {type(found[0]).__name__} has no priority inheritance"
        elif wait.blocked:
            why = f"{holder} blocked in {wait.blocked} and held the gate"
        elif wait.chained:
            why = f"{holder} itself waited for {wait.chained}, and inheritance is not transitive"
        else:
            why = f"{holder} lost the inherited priority before it left the gate"
        message = (
            f"{thread} waited {waited:.1f} us for {name}, held by {wait.holder}, while {middle} ran for "
            f"{us(cycles):.1f} us: {why}"
        )
        taken = f"{holder} took it in {self._locator.text(wait.taken)}"
        if lends and wait.path:  # the cause is the statement at which the holder blocks
            self._findings.report_at(
                wait.path[0], rule, message, object=name, value=waited, how="dynamic", call_path=wait.path, task=holder,
                details=(taken, f"{thread.name} waits in {self._locator.text(self._locator.here())}"),
            )  # fmt: skip
        else:
            self._findings.report(rule, message, object=name, value=waited, details=(taken,))
