"""Tasks that wait for each other for ever through a gate and a semaphore: `deadlock`.

A task pends on a semaphore while it holds a gate, and whoever alone posts the semaphore waits for that gate.  A ring of
gates alone is found by `gates.py`.
"""

from __future__ import annotations

from emulator.c28x.findings import Findings
from emulator.sysbios.core import WAIT_FOREVER
from emulator.sysbios.scheduler import Task
from emulator.sysbios.semaphore import Semaphore
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.gates import Gates
from emulator.sysbios.watch.names import Names
from emulator.sysbios.watch.posters import Posters
from emulator.sysbios.watch.spots import Spot, Spots
from emulator.sysbios.watch.threads import Gate, Thread, Threads
from emulator.trace import Trace


class Standstill:
    """Listens to pends, and looks around when a task blocks while another waits for a gate."""

    def __init__(
        self, threads: Threads, spots: Spots, names: Names, findings: Findings, gates: Gates, posters: Posters,
        calls: Calls,
    ) -> None:  # fmt: skip
        self._threads = threads
        self._spots = spots
        self._names = names
        self._findings = findings
        self._gates = gates
        self._posters = posters
        self._pends: dict[Thread, tuple[Semaphore, Spot]] = {}
        calls.before("Semaphore_pend", tell=self._pending)
        calls.after("Semaphore_pend", tell=self._pended)

    def listen(self, trace: Trace) -> None:
        """Be told of tasks that block."""
        trace.listen(self._blocks, "block", each_tick=False)

    def _blocks(self, _cycles: int, _kind: str, _name: str) -> None:
        if self._pends and self._gates.anybody_waits:
            self._look()

    def _pending(self, semaphore: Semaphore, timeout: int) -> None:
        forever = timeout & self._threads.kernel.tasks.timeout_mask == WAIT_FOREVER
        if forever and self._threads.current.is_task:
            self._pends[self._threads.current] = semaphore, self._spots.here()

    def _pended(self, taken: int, semaphore: Semaphore, timeout: int) -> None:
        self._pends.pop(self._threads.current, None)

    def _look(self) -> None:
        """Take away whoever can still be released, again and again: the others never run again."""
        stuck: dict[Task, Gate | Semaphore] = {}
        for thread in self._threads.all:
            gate, pend = self._gates.waits_for(thread), self._pends.get(thread)
            if isinstance(thread.what, Task) and gate is not None:
                stuck[thread.what] = gate
            elif isinstance(thread.what, Task) and pend is not None and not pend[0].count:
                stuck[thread.what] = pend[0]
        while True:
            free = [task for task, what in stuck.items() if not (needs := self._needs(what)) or not needs <= set(stuck)]
            if not free:
                break
            for task in free:
                del stuck[task]
        for task, what in stuck.items():
            if not isinstance(what, Semaphore) and what.owner is not None and isinstance(stuck[what.owner], Semaphore):
                self._tell(self._threads.of(task), what, self._threads.of(what.owner))

    def _needs(self, what: Gate | Semaphore) -> set[Task]:
        """The tasks of which one must run to end a wait; none: others can do it too."""
        if not isinstance(what, Semaphore):
            return set() if what.free or what.owner is None else {what.owner}
        return self._posters.of(what) or set()

    def _tell(self, producer: Thread, gate: Gate, consumer: Thread) -> None:
        semaphore, spot = self._pends[consumer]
        place = self._spots.place(spot)
        if place is None:
            return
        a, b = self._names.of(semaphore), self._names.of(gate)
        self._findings.report_at(
            place, "deadlock", f"{consumer} waits for {a} while it holds {b}, and {producer}, which would post {a}, "
            f"waits for {b}: neither runs again", object=b, how="dynamic", task=consumer.name,
            details=(f"{producer} waits in {self._spots.text(self._gates.spot(producer))}",),
        )  # fmt: skip
