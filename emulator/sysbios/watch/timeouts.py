"""How waits with a timeout end: `gate-across-wait`, `timeout-ignored`, `wait-untested`.

`gate-across-wait`: a task that waits while it holds a gate delays all other tasks that want the gate.  A driver may do
so on purpose, for the interrupt that ends its transfer.  So it is reported only if another task waited at the gate for
long, and only time ended the wait: a timeout or Task_sleep.

`timeout-ignored`: a pend on a mailbox that timed out leaves the message unchanged.

`wait-untested`: a pend on a semaphore that only interrupts post; what follows is for what the interrupt brings, and
nothing tests whether it came.  Or a pend on a mailbox whose result nothing uses, while what follows uses the message.
The rule is `timeout-ignored`, although no message was missing, if the message is a local without a value before.
"""

from __future__ import annotations

from functools import partial
from typing import Any, Final

from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.sites import Place
from emulator.c28x.tree import Variable
from emulator.clock import CYCLES_PER_MS, ms
from emulator.sysbios.core import HWI, WAIT_FOREVER
from emulator.sysbios.mailbox import Mailbox
from emulator.sysbios.semaphore import Semaphore
from emulator.sysbios.watch.after_wait import ignored_waits, message_tested, message_used, only_received, used_again
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.gates import Gates
from emulator.sysbios.watch.names import HandleNames
from emulator.sysbios.watch.statements import StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Thread, ThreadWatch

#: A task may wait at a gate for so long while the owner's wait times out, or while the owner sleeps: an EEPROM needs
#: time to write, a sonar needs time to measure (CHOICE).
TIMEOUT_CYCLES: Final = 20 * CYCLES_PER_MS
SLEEP_CYCLES: Final = 100 * CYCLES_PER_MS
#: Report when this many pends in a row got no message.
SILENCES: Final = 2


class TimeoutWatch:
    """Listens to pends and sleeps."""

    def __init__(
        self, threads: ThreadWatch, locator: StatementLocator, names: HandleNames, findings: Findings, gates: Gates,
        calls: Calls, linked: Linked,
    ) -> None:  # fmt: skip
        self._threads, self._locator, self._names, self._findings = threads, locator, names, findings
        self._gates, self._clock, self._linked = gates, findings.clock, linked
        self._began: dict[Thread, int] = {}
        #: The kernel objects that interrupts have posted, and those that other threads have posted.
        self._by_interrupt: set[Any] = set()
        self._by_others: set[Any] = set()
        #: Statement -> how many of its pends in a row got no message, since the last that got one.
        self._silences: dict[StatementNumber, int] = {}
        self._ignored: set[tuple[str, int]] | None = None
        #: File and line of the pends that two missing messages have shown.
        self._told: set[tuple[str, int]] = set()
        #: Waits with a timeout for a semaphore or a message: the statement, the kernel's object and the ticks.
        self._pends: dict[StatementNumber, tuple[Semaphore | Mailbox, int]] = {}
        calls.before("Semaphore_post", "Event_post", "Mailbox_post", callback=self._posting)
        for name in ("Semaphore_pend", "Event_pend", "Mailbox_pend", "Mailbox_post"):
            calls.before(name, callback=self._begins)
            calls.after(name, callback=partial(self._ended, name))
        calls.before("Task_sleep", callback=self._begins)
        calls.after("Task_sleep", callback=self._slept)
        calls.before("Mailbox_pend", callback=self._awaits_message)
        calls.after("Mailbox_pend", callback=self._message)

    def _posting(self, what: Any, *_arguments: Any) -> None:
        in_interrupt = self._threads.kernel.core.thread_type == HWI
        (self._by_interrupt if in_interrupt else self._by_others).add(what)

    def finish(self) -> None:
        """Report waits for interrupts of which nothing tests the result."""
        places = {self._locator.place(statement): pend for statement, pend in self._pends.items()}
        waited = {place[:2]: (place, *pend) for place, pend in places.items() if place is not None}
        functions = {function.path: function for function in self._names.functions}
        for function in functions.values() if waited and self._names.whole else ():
            for wait in ignored_waits(function, "Semaphore_pend"):
                at = waited.get((wait.statement.where.file, wait.statement.where.line))
                if at is None or at[1] not in self._by_interrupt or at[1] in self._by_others:
                    continue
                place, semaphore, timeout = at
                if not isinstance(semaphore, Semaphore):
                    continue
                posters = [functions[path] for path in self._names.callers("Semaphore_post", semaphore)]
                used = used_again(wait, function, posters)
                if used is None:
                    continue
                name = self._names.of(semaphore)
                self._findings.report_at(
                    place, "wait-untested",
                    f"nothing tests whether an interrupt has posted {name} within {timeout} ticks: "
                    + (f"what follows uses {used} again" if used else "what follows goes on without it"),
                    object=name, how="dynamic",
                )  # fmt: skip
            for wait in ignored_waits(function, "Mailbox_pend"):
                at = waited.get((wait.statement.where.file, wait.statement.where.line))
                buffer = message_used(wait)
                if at is not None and buffer is not None and isinstance(at[1], Mailbox):
                    garbage = only_received(buffer, wait, function)
                    if garbage or not message_tested(wait, buffer):
                        self._unread(at[0], at[1], at[2], buffer, garbage=garbage)

    def _unread(self, place: Place, mailbox: Mailbox, timeout: int, buffer: Variable, *, garbage: bool) -> None:
        """Report a pend on a mailbox whose result nothing uses, if no missing message has shown it."""
        if place[:2] in self._told:
            return
        message, name = buffer.declaration.name, self._names.of(mailbox)
        without = f"{message}, which has no value before the first message" if garbage else f"{message} again"
        self._findings.report_at(
            place, "timeout-ignored" if garbage else "wait-untested",
            f"nothing tests whether {name} gave a message within {timeout} ticks: what follows uses {without}",
            object=name, how="dynamic",
        )  # fmt: skip

    def _begins(self, *arguments: Any) -> None:
        if len(arguments) == 2 and isinstance(arguments[0], Semaphore):
            self._awaits(arguments[0], arguments[1])
        self._began[self._threads.current] = self._clock.now

    def _awaits(self, what: Semaphore | Mailbox, ticks: int) -> None:
        """A thread begins to wait for a semaphore or a message."""
        timeout = ticks & self._threads.kernel.tasks.timeout_mask
        if timeout not in (0, WAIT_FOREVER):
            self._pends[self._locator.here()] = what, timeout

    def _awaits_message(self, mailbox: Mailbox, _message: Any, ticks: int) -> None:
        self._awaits(mailbox, ticks)

    def _ended(self, function: str, result: int, what: Any, *arguments: Any) -> None:
        timeout = arguments[-1] if arguments else 0
        # A semaphore that nobody has posted yet may be one that an interrupt posts.
        unknown = function == "Semaphore_pend" and what not in self._by_others
        if timeout and timeout != WAIT_FOREVER and not result and what not in self._by_interrupt and not unknown:
            self._check_gates(f"{function}({self._names.of(what)}), which times out", TIMEOUT_CYCLES)

    def _slept(self, _result: None, ticks: int) -> None:
        self._check_gates(f"Task_sleep({ticks})", SLEEP_CYCLES)

    def _check_gates(self, waits: str, limit_cycles: int) -> None:
        """A wait has ended by time alone.  Report tasks that waited too long at a gate that the task held meanwhile."""
        thread = self._threads.current
        began = self._began.get(thread, self._clock.now)
        for gate in thread.entered if self._gates.anybody_waits else ():
            for other, since in self._gates.waiting(gate):
                stood = self._clock.now - max(since, began)
                if stood > limit_cycles and other is not thread:
                    name = self._names.of(gate)
                    self._findings.report(
                        "gate-across-wait",
                        f"{thread} holds {name} during {waits}: {other} was blocked at it for {ms(stood):.0f} ms",
                        object=name, value=round(ms(stood), 3),
                        details=(f"{other} waits in {self._locator.text(self._gates.statement(other))}",),
                    )  # fmt: skip

    def _message(self, taken: int, mailbox: Mailbox, message: Any, timeout: int) -> None:
        """A pend on a mailbox has returned, with a message or with none."""
        statement = self._locator.here()
        if taken:
            self._silences[statement] = 0
        elif timeout and timeout != WAIT_FOREVER and statement in self._silences:
            self._silences[statement] += 1
            place = self._locator.place(statement)
            if self._silences[statement] == SILENCES and place is not None and place[:2] in self._ignored_pends():
                name = self._names.of(mailbox)
                self._told.add(place[:2])
                self._findings.report(
                    "timeout-ignored",
                    f"{name} gave no message in {timeout} ticks, and this statement does not test the result: what "
                    "follows uses the last message again", object=name,
                )  # fmt: skip

    def _ignored_pends(self) -> set[tuple[str, int]]:
        """File and line of the pends on a mailbox whose result the program does not use."""
        if self._ignored is None:
            self._ignored = {
                (wait.statement.where.file, wait.statement.where.line)
                for function in self._names.functions for wait in ignored_waits(function, "Mailbox_pend")
            }  # fmt: skip
        return self._ignored
