"""Tasks that wait for ever: for each other (`deadlock`), or for a post that never comes (`never-posted`).

In a deadlock a task pends on a semaphore while it holds a gate, and the only task that posts the semaphore waits for
that gate; or semaphores begin with 0, and each is posted only behind waits for another of them, or for itself.
`gates.py` finds cycles of gates alone.

A task that still waits without a timeout at the end of a run is `never-posted` if no statement of the program ends
such a wait.  A wait with a timeout whose result the program tests is `always-timeout`, if no wait for that object ever
ended by a post.  Part of a program, without its `main`, gets no such finding: the rest may post.

A Swi with a trigger that no statement changes or reads is `not-connected`: `Swi_post` does not wait for it.
"""

from __future__ import annotations

from functools import partial
from typing import Any, Final

from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.sites import Place
from emulator.sysbios.clock import ClockObject
from emulator.sysbios.core import WAIT_FOREVER
from emulator.sysbios.event import Event
from emulator.sysbios.scheduler import Task
from emulator.sysbios.semaphore import Semaphore
from emulator.sysbios.swi import Swi
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.gates import Gates
from emulator.sysbios.watch.names import HandleNames, calls_before, first_argument
from emulator.sysbios.watch.posters import Posters
from emulator.sysbios.watch.statements import StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Gate, Thread, ThreadWatch
from emulator.trace import Trace

#: A function that waits, and the function that ends such a wait.
ENDS: Final = {
    "Semaphore_pend": "Semaphore_post", "Event_pend": "Event_post", "Mailbox_pend": "Mailbox_post",
    "Mailbox_post": "Mailbox_pend",
}  # fmt: skip
#: The functions that post a software interrupt, at once or after several calls.
POSTS_OF_SWI: Final = ("Swi_post", "Swi_or", "Swi_inc", "Swi_dec", "Swi_andn")
#: The functions for which the trigger of a Swi has a meaning: they change it, or read it.
USES_OF_TRIGGER: Final = (*POSTS_OF_SWI[1:], "Swi_getTrigger")


class Standstill:
    """Listens to pends.  When a task blocks while another waits for a gate, it looks for tasks that never run again."""

    def __init__(
        self, threads: ThreadWatch, locator: StatementLocator, names: HandleNames, findings: Findings, gates: Gates,
        posters: Posters, calls: Calls, linked: Linked,
    ) -> None:  # fmt: skip
        self._threads = threads
        self._locator = locator
        self._names = names
        self._findings = findings
        self._gates = gates
        self._posters = posters
        self._linked = linked
        self._pends: dict[Thread, tuple[Semaphore, StatementNumber]] = {}
        #: Waits for events and mailboxes: the function, the kernel object, and the statement.
        self._waits: dict[Thread, tuple[str, Any, StatementNumber]] = {}
        #: Waits for events: the bits that must all be posted, and the bits of which one must be posted.
        self._wanted: dict[Thread, tuple[int, int]] = {}
        #: The Clocks that were created, and those of them that `Clock_create` did not start.
        self._clocks: dict[ClockObject, StatementNumber] = {}
        self._idle: dict[ClockObject, StatementNumber] = {}
        #: Waits with a timeout that came to its end: the thread, the function and the object, by the statement.
        self._timed_out: dict[StatementNumber, tuple[Thread, str, Any]] = {}
        #: What a wait with a timeout has got.
        self._answered: set[Any] = set()
        for function in ("Semaphore_pend", "Event_pend", "Mailbox_pend"):
            calls.after(function, callback=partial(self._ended, function))
        calls.before("Semaphore_pend", callback=self._pending)
        calls.after("Semaphore_pend", callback=self._pended)
        for function in ENDS:
            if function != "Semaphore_pend":
                calls.before(function, callback=partial(self._waiting, function))
                calls.after(function, callback=self._waited)
        #: Software interrupts that were created.
        self._swis: dict[Swi, StatementNumber] = {}
        #: Those with a trigger, each by its parameters.  Another Swi of the same parameters may have got it by chance.
        self._triggered: dict[tuple[Any, int], Swi] = {}
        calls.after("Clock_create", callback=self._created)
        calls.after("Swi_create", callback=self._swi_created)

    def listen(self, trace: Trace) -> None:
        """Listen to tasks that block."""
        trace.listen(self._blocks, "block", each_tick=False)

    def _blocks(self, _cycles: int, _kind: str, _name: str) -> None:
        if self._pends and self._gates.anybody_waits:
            self._report_deadlocks()

    def _pending(self, semaphore: Semaphore, timeout: int) -> None:
        forever = timeout & self._threads.kernel.tasks.timeout_mask == WAIT_FOREVER
        if forever and self._threads.current.is_task:
            self._pends[self._threads.current] = semaphore, self._locator.here()

    def _pended(self, taken: int, semaphore: Semaphore, timeout: int) -> None:
        self._pends.pop(self._threads.current, None)

    def _waiting(self, function: str, what: Any, *arguments: Any) -> None:
        forever = arguments[-1] & self._threads.kernel.tasks.timeout_mask == WAIT_FOREVER
        if forever and self._threads.current.is_task:
            self._waits[self._threads.current] = function, what, self._locator.here()
            if function == "Event_pend":
                self._wanted[self._threads.current] = arguments[0], arguments[1]

    def _waited(self, *_arguments: Any) -> None:
        self._waits.pop(self._threads.current, None)

    def _ended(self, function: str, result: int, what: Any, *arguments: Any) -> None:
        timeout = arguments[-1] & self._threads.kernel.tasks.timeout_mask
        if result:
            self._answered.add(what)
        elif timeout not in (0, WAIT_FOREVER) and self._threads.current.is_task:
            self._timed_out.setdefault(self._locator.here(), (self._threads.current, function, what))

    def _created(self, clock: ClockObject | None, *_arguments: Any) -> None:
        if clock is None:
            return
        self._clocks[clock] = self._locator.here()
        if not clock.active:
            self._idle[clock] = self._clocks[clock]

    def _swi_created(self, swi: Swi | None, _function: Any, params: Any, *_arguments: Any) -> None:
        if swi is not None:
            self._swis[swi] = self._locator.here()
            if swi.initial_trigger:
                self._triggered.setdefault((params, swi.initial_trigger), swi)

    def finish(self) -> None:
        """Report waits that no statement ends, Clocks that no statement starts and Swis that no statement posts."""
        if not self._names.whole:
            return
        pends = {thread: ("Semaphore_pend", *pend) for thread, pend in self._pends.items() if not pend[0].count}
        for thread, (function, what, statement) in {**self._waits, **pends}.items():
            place, end = self._locator.place(statement), ENDS[function]
            brought = isinstance(what, Event) and self._names.brings(what)
            name = self._names.of(what)
            if place is not None and not brought and isinstance(what, Event) and self._names.could(end, what):
                self._never(thread, what, name, place)
            if place is not None and not brought:
                self._once(thread, what, name, place)
            if place is None or brought or self._names.could(end, what):
                continue
            self._findings.report_at(
                place, "never-posted", f"{thread} waits in {function} for {name} without a timeout, and no statement "
                f"calls {end} for it", object=name, how="dynamic", task=thread.name,
            )  # fmt: skip
        for statement, (thread, function, what) in self._timed_out.items():
            place = self._locator.place(statement)
            if place is None or what in self._answered or self._names.brings(what):
                continue
            if self._names.could(ENDS[function], what) or place[:2] in self._names.idle_calls(function):
                continue
            name = self._names.of(what)
            self._findings.report_at(
                place, "always-timeout", f"{thread} tests whether {function} gets {name}, and no statement calls "
                f"{ENDS[function]} for it: each wait times out", object=name, how="dynamic", task=thread.name,
            )  # fmt: skip
        self._rings({what: (thread, statement) for thread, (_, what, statement) in pends.items()})
        for clock, statement in self._idle.items():
            place = self._locator.place(statement)
            if place is not None and not clock.active and not self._names.could("Clock_start", clock):
                self._findings.report_at(
                    place, "clock-not-started", f"the Clock of {clock.name} is created without startFlag, and no "
                    "statement starts it: its function never runs", object=clock.name, how="dynamic",
                )  # fmt: skip

        for swi, statement in self._swis.items():
            place, posts = (
                self._locator.place(statement),
                [post for post in POSTS_OF_SWI if self._names.could(post, swi)],
            )
            why = "" if posts else "no statement posts it"
            # Swi_andn posts the Swi when all bits of its trigger are 0.
            left = swi.initial_trigger & ~self._names.bits("Swi_andn", swi) if posts == ["Swi_andn"] else 0
            if left:
                why = f"no Swi_andn takes bits {left:#x} off its trigger {swi.initial_trigger:#x}"
            if place is not None and why:
                self._findings.report_at(
                    place, "never-posted", f"the Swi {self._names.of(swi)} is created, and {why}: its function never "
                    "runs", object=self._names.of(swi), how="dynamic",
                )  # fmt: skip
        self._triggers()

    def _triggers(self) -> None:
        """Report Swis that wait for a trigger, in a program that only calls Swi_post, which does not look at it."""
        if any(map(self._names.mentions, USES_OF_TRIGGER)):
            return
        for swi in self._triggered.values():
            created, posts = self._locator.place(self._swis[swi]), self._names.places("Swi_post", swi)
            if created is None or not self._names.could("Swi_post", swi):
                continue
            place = posts[0] if len(posts) == 1 else created
            name, trigger = self._names.of(swi), swi.initial_trigger
            self._findings.report_at(
                place, "not-connected", f"the Swi {name} has the trigger {trigger}, which no statement changes "
                "(Swi_dec, Swi_inc, Swi_or, Swi_andn) or reads: each Swi_post posts it at once", object=name,
                how="dynamic", details=() if place == created else (f"it is created at {created}",),
            )  # fmt: skip

    def _never(self, thread: Thread, event: Event, name: str, place: Place) -> None:
        """Report bits of an event that a task waits for and no statement posts."""
        posted = self._names.bits("Event_post", event)
        both, either = self._wanted.get(thread, (0, 0))
        if both & ~posted or (either and not both and not either & posted):
            missing = both & ~posted or either
            self._findings.report_at(
                place, "never-posted", f"{thread} waits in Event_pend for bits {missing:#x} of {name} without a "
                "timeout, and no statement posts them", object=name, how="dynamic", task=thread.name,
            )  # fmt: skip

    def _once(self, thread: Thread, what: Any, name: str, place: Place) -> None:
        """Report a wait that only the functions of Clocks end, which run once and have run."""
        ended: list[Place] = []
        for path in self._names.callers(ENDS[self._function(thread)], what):
            of = [clock for clock in self._clocks if path == self._linked.path_of(clock.function)]
            if not of or not self._names.only_given_to(path, "Clock_create"):
                return
            if any(clock.active or clock.period or self._names.could("Clock_start", clock) for clock in of):
                return
            ended += filter(None, (self._locator.place(self._clocks[clock]) for clock in of))
        if ended:
            self._findings.report_at(
                ended[0], "never-posted", f"this Clock has no period, so its function runs once; {thread} waits again "
                f"for {name} without a timeout, which nothing else posts", object=name, how="dynamic", task=thread.name,
                details=(f"it waits at {place}",),
            )  # fmt: skip

    def _rings(self, forever: dict[Semaphore, tuple[Thread, StatementNumber]]) -> None:
        """Report semaphores that nobody has ever got, each of which is posted only behind a wait for one of them."""
        timed = {
            what: (thread, statement) for statement, (thread, _, what) in self._timed_out.items()
            if isinstance(what, Semaphore)
        }  # fmt: skip
        waits = {what: wait for what, wait in {**timed, **forever}.items() if what not in self._answered}
        behind = {what: self._behind(what, set(waits)) for what in waits}
        while out := [what for what, others in behind.items() if not others <= set(behind) or not others]:
            for what in out:
                del behind[what]
        while behind:
            ring = [next(iter(behind))]
            while (then := min(behind[ring[-1]], key=self._names.of)) not in ring:
                ring.append(then)
            ring = ring[ring.index(then) :]
            # It is told at a wait without a timeout, if it has one.
            begin = next((n for n, what in enumerate(ring) if what in forever), 0)
            self._report_ring(ring[begin:] + ring[:begin], waits, behind, forever=ring[begin] in forever)
            # What is posted behind a wait for one of the ring is no ring of its own.
            told = set(ring)
            while told & set(behind):
                for what in told & set(behind):
                    del behind[what]
                told |= {what for what, others in behind.items() if others & told}

    def _report_ring(
        self, ring: list[Semaphore], waits: dict[Semaphore, tuple[Thread, StatementNumber]],
        behind: dict[Semaphore, set[Semaphore]], *, forever: bool,
    ) -> None:  # fmt: skip
        (thread, statement), name = waits[ring[0]], self._names.of(ring[0])
        place = self._locator.place(statement)
        if place is None:
            return
        posted = "".join(
            f", which is posted only behind a wait for {' or '.join(sorted(map(self._names.of, behind[what])))}"
            for what in ring
        )
        self._findings.report_at(
            place, "deadlock" if forever else "always-timeout",
            f"{thread} waits for {name}{posted}: none of them is ever posted", object=name, how="dynamic",
            task=thread.name, details=tuple(
                f"{waits[what][0]} waits for {self._names.of(what)} in {self._locator.text(waits[what][1])}"
                for what in ring[1:]
            ),
        )  # fmt: skip

    def _behind(self, semaphore: Semaphore, waited: set[Semaphore]) -> set[Semaphore]:
        """Those of the semaphores `waited` of which a wait comes before each post of `semaphore`, one for each post.

        Empty if a post has no such wait before it, or if no statement is known to post it.
        """
        found: set[Semaphore] = set()
        if semaphore.count or not self._names.could("Semaphore_post", semaphore):
            return found
        paths = {what: self._names.objects(what) for what in waited}
        bodies = {function.path: function.body for function in self._names.functions}
        for path in self._names.callers("Semaphore_post", semaphore):
            for post, before in calls_before(bodies[path], "Semaphore_post", "Semaphore_pend"):
                if first_argument(post) not in {None, *paths[semaphore]}:
                    continue
                of = {first_argument(wait) for wait in before}
                waits = [what for what in waited if of & paths[what]]
                if not waits:
                    return set()
                found.add(semaphore if semaphore in waits else waits[0])
        return found

    def _function(self, thread: Thread) -> str:
        """The function in which a thread waits."""
        return self._waits[thread][0] if thread in self._waits else "Semaphore_pend"

    def _report_deadlocks(self) -> None:
        """Report tasks that never run again.

        It starts with all waiting tasks, and removes those that can still be released until none is left to remove.
        """
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
                self._report_deadlock(self._threads.of(task), what, self._threads.of(what.owner))

    def _needs(self, what: Gate | Semaphore) -> set[Task]:
        """The tasks of which one must run to end a wait; empty if something else can end it too."""
        if not isinstance(what, Semaphore):
            return set() if what.free or what.owner is None else {what.owner}
        return self._posters.of(what) or set()

    def _report_deadlock(self, producer: Thread, gate: Gate, consumer: Thread) -> None:
        semaphore, statement = self._pends[consumer]
        place = self._locator.place(statement)
        if place is None:
            return
        awaited, held = self._names.of(semaphore), self._names.of(gate)
        self._findings.report_at(
            place, "deadlock", f"{consumer} waits for {awaited} while it holds {held}, and {producer}, which would "
            f"post {awaited}, waits for {held}: neither runs again", object=held, how="dynamic", task=consumer.name,
            details=(f"{producer} waits in {self._locator.text(self._gates.statement(producer))}",),
        )  # fmt: skip
