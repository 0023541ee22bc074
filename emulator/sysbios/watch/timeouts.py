"""How waits with a timeout end: `gate-across-wait`, `timeout-ignored`.

`gate-across-wait`: a task that waits while it holds a gate delays all other tasks that want the gate.  A driver may do
so on purpose, for the interrupt that ends its transfer.  So it is reported only if another task waited at the gate for
long, and only time ended the wait: a timeout or Task_sleep.

`timeout-ignored`: a pend on a mailbox that timed out leaves the message unchanged.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any, Final

from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.tree import Call, Evaluate, Function
from emulator.c28x.tree_queries import statements
from emulator.clock import CYCLES_PER_MS, ms
from emulator.sysbios.core import HWI
from emulator.sysbios.mailbox import Mailbox
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.gates import Gates
from emulator.sysbios.watch.names import HandleNames
from emulator.sysbios.watch.statements import StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Thread, ThreadWatch

#: A task may wait at a gate for so long while the owner's wait times out, or while the owner sleeps: an EEPROM needs
#: time to write, a sonar needs time to measure (CHOICE).
TIMEOUT_CYCLES: Final = 20 * CYCLES_PER_MS
SLEEP_CYCLES: Final = 100 * CYCLES_PER_MS
FOREVER: Final = 0xFFFF
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
        calls.before("Semaphore_post", "Event_post", "Mailbox_post", callback=self._posting)
        for name in ("Semaphore_pend", "Event_pend", "Mailbox_pend", "Mailbox_post"):
            calls.before(name, callback=self._begins)
            calls.after(name, callback=partial(self._ended, name))
        calls.before("Task_sleep", callback=self._begins)
        calls.after("Task_sleep", callback=self._slept)
        calls.after("Mailbox_pend", callback=self._message)

    def _posting(self, what: Any, *_arguments: Any) -> None:
        in_interrupt = self._threads.kernel.core.thread_type == HWI
        (self._by_interrupt if in_interrupt else self._by_others).add(what)

    def _begins(self, *_arguments: Any) -> None:
        self._began[self._threads.current] = self._clock.now

    def _ended(self, function: str, result: int, what: Any, *arguments: Any) -> None:
        timeout = arguments[-1] if arguments else 0
        # A semaphore that nobody has posted yet may be one that an interrupt posts.
        unknown = function == "Semaphore_pend" and what not in self._by_others
        if timeout and timeout != FOREVER and not result and what not in self._by_interrupt and not unknown:
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
        elif timeout and timeout != FOREVER and statement in self._silences:
            self._silences[statement] += 1
            place = self._locator.place(statement)
            if self._silences[statement] == SILENCES and place is not None and place[:2] in self._ignored_pends():
                name = self._names.of(mailbox)
                self._findings.report(
                    "timeout-ignored",
                    f"{name} gave no message in {timeout} ticks, and this statement does not test the result: what "
                    "follows uses the last message again", object=name,
                )  # fmt: skip

    def _ignored_pends(self) -> set[tuple[str, int]]:
        """File and line of the pends on a mailbox whose result the program does not use."""
        if self._ignored is None:
            modules = self._linked.program.modules.values()
            self._ignored = {
                at for module in modules for function in module.functions for at in _ignored_results(function)
            }
        return self._ignored


def _ignored_results(function: Function) -> Iterator[tuple[str, int]]:
    for statement in statements(function.body):
        if (
            isinstance(statement, Evaluate)
            and isinstance(statement.value, Call)
            and statement.value.function.name == "Mailbox_pend"
        ):
            yield statement.where.file, statement.where.line
