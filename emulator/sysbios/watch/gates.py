"""How gates are used: `gate-key`, `gate-not-left`, `gate-unused`, `gate-order`, `deadlock`, `blocking-in-interrupt`.

A gate may be entered in one function and left in another.  It counts as forgotten when the function that entered it has
returned and its task then waits for something else, or ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, Final

from emulator.c28x.findings import Findings
from emulator.c28x.sites import Place
from emulator.c28x.tree import Return
from emulator.clock import SYSCLK_HZ, ms
from emulator.sysbios.core import HWI, SWI
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.gate_exits import ENTER, exits
from emulator.sysbios.watch.names import HandleNames
from emulator.sysbios.watch.statements import Call, StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Gate, Thread, ThreadWatch
from emulator.trace import Trace

#: In a run of at least this many cycles, a statement that enters a gate should have run.
LONG_ENOUGH: Final = 5 * SYSCLK_HZ


class GateEntry:
    """A gate that a thread has entered and not left; `call`: the running call of the C function that entered it."""

    __slots__ = ("call", "gate", "key", "statement")

    def __init__(self, gate: Gate, key: int, statement: StatementNumber, call: Call | None) -> None:
        self.gate = gate
        self.key = key
        self.statement = statement
        self.call = call


@dataclass(slots=True)
class Edge:
    """A thread entered one gate while it held another."""

    thread: Thread
    statement: StatementNumber
    #: All gates that were held then.
    held: frozenset[Gate]


class Gates:
    """Listens to the calls that enter and leave gates, and to the calls that make a task wait."""

    def __init__(
        self, threads: ThreadWatch, locator: StatementLocator, names: HandleNames, findings: Findings, calls: Calls
    ) -> None:
        self._threads = threads
        self._locator = locator
        self._names = names
        self._findings = findings
        self._clock = findings.clock
        self._created: dict[Gate, StatementNumber] = {}
        self._used: set[Gate] = set()
        self._entries: dict[Thread, list[GateEntry]] = {}
        self._entering_now: dict[Thread, tuple[Gate, StatementNumber]] = {}
        self._waits: dict[Thread, tuple[Gate, StatementNumber]] = {}
        self._since: dict[Thread, int] = {}
        self._order: dict[Gate, dict[Gate, list[Edge]]] = {}
        calls.after("GateMutexPri_create", "GateMutex_create", callback=self._create)
        calls.before(*ENTER, callback=self._entering)
        calls.after(*ENTER, callback=self._entered)
        calls.before("GateMutexPri_leave", "GateMutex_leave", callback=self._leaving)
        calls.before("Semaphore_pend", callback=self._pending)
        calls.before("Event_pend", callback=self._pending_event)
        calls.before("Mailbox_pend", callback=partial(self._pending_mailbox, "Mailbox_pend"))
        calls.before("Mailbox_post", callback=partial(self._pending_mailbox, "Mailbox_post"))
        calls.before("Task_sleep", callback=self._sleeping)

    def listen(self, trace: Trace) -> None:
        """Listen to tasks that wait for a gate, and to tasks that block."""
        trace.listen(self._gate_waits, "gate wait", each_tick=False)
        trace.listen(self._blocks, "block", each_tick=False)

    def _gate_waits(self, _cycles: int, _kind: str, _name: str) -> None:
        thread = self._threads.current
        if thread not in self._entering_now:
            return
        self._waits[thread] = self._entering_now[thread]
        self._since[thread] = self._clock.now
        self._cycle(thread)

    def _blocks(self, _cycles: int, _kind: str, name: str) -> None:
        blocked = self._threads.named(name)
        if blocked is not None and blocked is self._threads.current and blocked not in self._waits:
            self._forgotten(blocked, "waits or ends")

    def waits_for(self, thread: Thread) -> Gate | None:
        """The gate that a task waits for."""
        wait = self._waits.get(thread)
        return wait[0] if wait is not None else None

    @property
    def anybody_waits(self) -> bool:
        """Whether any task waits for a gate."""
        return bool(self._waits)

    def waiting(self, gate: Gate) -> list[tuple[Thread, int]]:
        """The tasks that wait for a gate, each with the cycle at which its wait began."""
        return [(thread, self._since[thread]) for thread, (wanted, _) in self._waits.items() if wanted is gate]

    def statement(self, thread: Thread) -> StatementNumber:
        """The statement at which a task waits for a gate."""
        wait = self._waits.get(thread)
        return wait[1] if wait is not None else 0

    def entry(self, thread: Thread, gate: Gate) -> GateEntry | None:
        """Where a thread entered a gate that it has not left."""
        return next((entry for entry in reversed(self._entries.get(thread, [])) if entry.gate is gate), None)

    def finish(self) -> None:
        """Report what shows only at the end of a run."""
        entered = {path for function in ENTER for path in self._names.passed(function)}
        for gate, statement in list(self._created.items()):
            place = self._locator.place(statement)
            if gate in self._used or place is None:
                del self._created[gate]
                continue
            nowhere = None not in entered and not self._names.objects(gate) & entered
            if nowhere or self._clock.now >= LONG_ENOUGH:
                name = self._names.of(gate)
                why = "no statement enters it" if nowhere else f"it was not entered in {ms(self._clock.now):.0f} ms"
                self._findings.report_at(
                    place, "gate-unused", f"{name} is created, but {why}", object=name, how="dynamic"
                )
                del self._created[gate]
        self._exits()

    def _exits(self) -> None:
        """Report paths through the source that do not leave a gate, unless the run has reported this gate already."""
        kept = {finding.object for finding in self._findings.of("gate-not-left")}
        for function, found in exits(self._names):
            statement, name, entered = found.statement, found.name, found.entered
            at = statement.where
            if name not in kept:
                on = "the function returns" if isinstance(statement, Return) else "the loop goes on"
                self._findings.report_at(
                    Place(at.file, at.line, function.name, function.c_file, at.column), "gate-not-left",
                    f"{name} was entered in line {entered.line}, and {on} without leaving it", object=name,
                    how="dynamic",
                )  # fmt: skip

    # Listeners

    def _create(self, gate: Gate, *_arguments: Any) -> None:
        self._created[gate] = self._locator.here()

    def _entering(self, gate: Gate) -> None:
        self._used.add(gate)
        thread = self._threads.current
        if self._in_interrupt(f"{type(gate).__name__}_enter", gate) or not thread.is_task:
            return
        statement = self._locator.here()
        self._entering_now[thread] = (gate, statement)
        held = self._threads.gates(thread)
        if gate in held:
            entry = self.entry(thread, gate)
            if entry is not None and (entry.statement, entry.call) == (statement, self._locator.call()):
                self._entered_again(thread, gate)
            self._forgotten(thread, "enters it again", only=gate)
            return
        for other in held:
            self._ordered(other, gate, Edge(thread, statement, held))

    def _entered(self, key: int, gate: Gate) -> None:
        thread = self._threads.current
        self._waits.pop(thread, None)
        if not thread.is_task:
            return
        entry = GateEntry(gate, key, self._locator.here(), self._locator.call())
        self._entries.setdefault(thread, []).append(entry)
        thread.entered.append(gate)

    def _leaving(self, gate: Gate, key: int) -> None:
        thread = self._threads.current
        if not thread.is_task:
            return
        thread.left[gate] = self._clock.now
        entry = self.entry(thread, gate)
        if entry is None:
            if key:  # With key 0 the kernel itself reports it.
                name = self._names.of(gate)
                message = f"{name} is left by {thread} with key {key}, but {thread.name} has not entered it"
                self._findings.report("gate-key", message, object=name, value=key)
            return
        self._entries[thread].remove(entry)
        thread.entered.remove(gate)
        if entry.key != key:
            name = self._names.of(gate)
            effect = "stays taken for ever" if key else "is free although the outer enter still needs it"
            self._findings.report(
                "gate-key", f"{name} is left by {thread} with key {key}, but its enter gave {entry.key}: the gate "
                f"{effect}", object=name, value=key, details=(f"entered in {self._locator.text(entry.statement)}",),
            )  # fmt: skip
            if key and not entry.key:
                thread.entered.append(gate)

    def _pending(self, semaphore: Any, timeout: int) -> None:
        if timeout:
            self._in_interrupt("Semaphore_pend", semaphore)

    def _pending_event(self, event: Any, _and_mask: int, _or_mask: int, timeout: int) -> None:
        if timeout:
            self._in_interrupt("Event_pend", event)

    def _pending_mailbox(self, function: str, mailbox: Any, _message: Any, timeout: int) -> None:
        if timeout:
            self._in_interrupt(function, mailbox)

    def _sleeping(self, ticks: int) -> None:
        if ticks:
            self._in_interrupt("Task_sleep", None)

    def _in_interrupt(self, function: str, handle: Any) -> bool:
        if self._threads.kernel.core.thread_type not in (HWI, SWI):
            return False
        thread = self._threads.current
        name = self._names.of(handle) if handle is not None else ""
        what = f"{function}({name})" if name else function
        why = "an interrupt cannot block, and an assertion of the kernel ends the program"
        message = f"{what} is called by {thread}: {why}"
        self._findings.report("blocking-in-interrupt", message, object=name or function)
        return True

    # Forgotten gates

    def _forgotten(self, thread: Thread, when: str, only: Gate | None = None) -> None:
        for entry in self._entries.get(thread, ()):
            gate = entry.gate
            if entry.key or gate.free or gate.owner is not thread.what or (only is not None and gate is not only):
                continue
            place = self._locator.place(entry.statement)
            if place is None or (entry.call is not None and self._locator.running(entry.call)):
                continue
            name = self._names.of(gate)
            self._findings.report_at(
                place, "gate-not-left", f"{name} is entered by {thread} in {place.function}, which returns without "
                f"leaving it: {thread.name} {when} while it holds it", object=name, how="dynamic",
                details=(f"{when} in {self._locator.text(self._locator.here())}",),
            )  # fmt: skip

    def _entered_again(self, thread: Thread, gate: Gate) -> None:
        """One call reaches the same enter statement again, in a loop, without having left the gate."""
        name = self._names.of(gate)
        self._findings.report(
            "gate-not-left", f"{thread} enters {name} again in the next turn of a loop, and has not left it: the enter "
            "is a nested one, whose leave does not give the gate back", object=name,
        )  # fmt: skip

    # Order

    def _ordered(self, first: Gate, second: Gate, edge: Edge) -> None:
        edges = self._order.setdefault(first, {}).setdefault(second, [])
        if any(entry.thread is edge.thread and entry.held == edge.held for entry in edges):
            return
        edges.append(edge)
        path = self._path(second, first, [edge])
        if path is not None:
            others = ", ".join(str(entry.thread) for entry in path)
            held, entered = self._names.of(first), self._names.of(second)
            self._findings.report(
                "gate-order", f"{edge.thread} enters {entered} while it holds {held}, and {others} in the opposite "
                "order: a deadlock is possible", object=entered,
                details=tuple(f"{entry.thread} in {self._locator.text(entry.statement)}" for entry in path),
            )  # fmt: skip

    def _path(self, start: Gate, end: Gate, taken: list[Edge]) -> list[Edge] | None:
        """Edges of different threads that lead from `start` to `end`; None if there are none.

        No two of the edges share a held gate: a common gate would exclude the deadlock.
        """
        for gate, edges in self._order.get(start, {}).items():
            for edge in edges:
                if any(edge.thread is before.thread or edge.held & before.held for before in taken):
                    continue
                if gate is end:
                    return [edge]
                rest = self._path(gate, end, [*taken, edge])
                if rest is not None:
                    return [edge, *rest]
        return None

    def _cycle(self, thread: Thread) -> None:
        """The task is about to wait.  Report a deadlock if the gate's owner, directly or not, waits for this task."""
        chain = [thread]
        while True:
            wait = self._waits.get(chain[-1])
            owner = wait[0].owner if wait is not None and not wait[0].free else None
            if wait is None or owner is None:
                return
            other = self._threads.of(owner)
            if other is thread:
                break
            if other in chain:
                return
            chain.append(other)
        told = []
        for member in chain:
            gate, statement = self._waits[member]
            told.append(f"{member} waits for {self._names.of(gate)} in {self._locator.text(statement)}")
        gates = " and ".join(self._names.of(self._waits[task][0]) for task in chain)
        self._findings.report(
            "deadlock", f"{' and '.join(map(str, chain))} wait for each other, for {gates}: none of them runs again",
            object=self._names.of(self._waits[thread][0]), details=tuple(told[1:]),
        )  # fmt: skip
