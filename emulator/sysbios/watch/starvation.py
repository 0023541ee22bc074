"""Tasks that are ready and do not run: `starvation`, and the `busy-wait` that often causes it.

The running statement is sampled at every tick of the kernel.  A statement in DelayUs or in a polling loop is a busy
wait.  So a busy wait is measured with the resolution of the tick, one millisecond by default.  The tick may not
interrupt a Hwi or Swi.  There the time is taken exactly from the argument of DelayUs.
"""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass
from typing import Any, Final

from emulator.c28x.findings import Finding, Findings
from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US, ms, us
from emulator.sysbios.scheduler import READY, Task
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.releases import Releases
from emulator.sysbios.watch.statements import Call, StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Thread, ThreadWatch
from emulator.trace import Trace

#: A ready task without a period is starved after this time.
STARVED_CYCLES: Final = 100 * CYCLES_PER_MS
#: A busy wait is reported from this many ticks on.  Task_sleep counts ticks, so it cannot replace a shorter wait.
BUSY_TICKS: Final = 2
#: In a Hwi or Swi, a busy wait is reported from this time on.
BUSY_INTERRUPT_US: Final = 100
#: The samples of this many ticks are kept.
_SAMPLES: Final = 10_000
_TICK: Final = "Clock_tick"

_DOING: Final = {"delay": "was in DelayUs", "poll": "polled", "": "computed"}
#: A thread that has asked so often in vain without waiting, and has not blocked since, asks instead of waiting.
VAIN_PENDS: Final = 20

#: Thread, statement, and what it does there: "poll", "delay" or "" (it computes).
Sample = tuple[Thread, StatementNumber, str]


class ReadyTask:
    """A task that is ready and does not run."""

    __slots__ = ("finding", "since", "usage")

    def __init__(self, since: int, usage: list[int]) -> None:
        self.since = since
        self.usage = usage
        self.finding: Finding | None = None


@dataclass(slots=True)
class BusyWait:
    """A busy wait that several ticks in a row found at the same statement."""

    call: Call | None
    sample: Sample
    #: The number of the call of DelayUs, to tell one call from the next.
    delay: int
    since: int
    finding: Finding | None = None


class StarvationWatch:
    """Listens to the scheduler and samples at the tick."""

    def __init__(
        self, threads: ThreadWatch, locator: StatementLocator, findings: Findings, releases: Releases, calls: Calls,
        starved_cycles: int = STARVED_CYCLES,
    ) -> None:  # fmt: skip
        self._threads = threads
        self._locator = locator
        self._findings = findings
        self._clock = findings.clock
        self._releases = releases
        self._starved_cycles = starved_cycles
        self._waiting: dict[Thread, ReadyTask] = {}
        self._running: Thread | None = None
        self._samples: deque[tuple[int, Sample]] = deque(maxlen=_SAMPLES)
        self._busy: BusyWait | None = None
        #: Statements by which a thread has asked in vain without waiting since it last blocked, and how often.
        self._vain: dict[Thread, Counter[StatementNumber]] = {}
        #: Thread -> microseconds that it waits in DelayUs now; the number of calls of DelayUs so far.
        self._delays: dict[Thread, float] = {}
        self._calls = 0
        calls.before("DelayUs", "DELAY_US", callback=self._delay)
        calls.after("DelayUs", "DELAY_US", callback=self._delayed)
        calls.after("Semaphore_pend", "Mailbox_pend", "Event_pend", callback=self._pended)

    def listen(self, trace: Trace) -> None:
        """Listen to the scheduler and to the tick."""
        trace.listen(self._readied, "ready", each_tick=False)
        trace.listen(self._switched, "switch", each_tick=False)
        trace.listen(self._ticked, "hwi", each_tick=False)
        trace.ticks_joined.connect(self._idle)

    def _readied(self, cycles: int, _kind: str, name: str) -> None:
        thread = self._threads.named(name)
        if thread is not None and thread.level > 0:
            self._waiting[thread] = ReadyTask(cycles, self._threads.usage())

    def _idle(self, _ticks: int, _interrupt_cycles: int, _swi_cycles: int) -> None:
        """Ticks have passed in which only the idle task ran: no busy wait goes on."""
        self._busy = None

    def _ticked(self, cycles: int, _kind: str, name: str) -> None:
        if name == _TICK:
            self._tick(cycles)

    def finish(self) -> None:
        """Judge the tasks that still wait for the CPU at the end of the run."""
        for thread, waiting in self._waiting.items():
            self._judge(thread, waiting, self._clock.now)

    def _switched(self, cycles: int, _kind: str, _name: str) -> None:
        old, new = self._running, self._threads.current
        if old is not None and old.level > 0 and isinstance(old.what, Task) and old.what.mode == READY:
            self._waiting[old] = ReadyTask(cycles, self._threads.usage())
        elif old is not None:
            self._vain.pop(old, None)
        self._running = new
        waiting = self._waiting.pop(new, None)
        if waiting is not None:
            self._judge(new, waiting, cycles)

    # Sampling

    def _tick(self, cycles: int) -> None:
        found = self._locator.sample()
        thread = self._threads.interrupted
        if found is None:
            self._busy = None
        else:
            statement, polls, call = found
            sample = (thread, statement, "poll" if polls else "delay" if thread in self._delays else "")
            self._samples.append((cycles, sample))
            self._sample_statement(cycles, sample, call)
        for waiting_thread, waiting in self._waiting.items():
            if waiting.finding is None:
                self._judge(waiting_thread, waiting, cycles)

    def _sample_statement(self, cycles: int, sample: Sample, call: Call | None) -> None:
        """A tick has found this statement.  Report a busy wait that has lasted long enough and keeps a task waiting."""
        thread, statement, kind = sample
        busy = self._busy
        if busy is None or busy.call is not call or busy.sample != sample or busy.delay != self._calls:
            self._busy = BusyWait(call, sample, self._calls, cycles) if kind else None
            return
        lasted = cycles - busy.since
        tick = self._threads.kernel.clocks.tick_period_us * CYCLES_PER_US
        lower = self._threads.ready_below(thread.level)
        if lasted < BUSY_TICKS * tick or not lower:
            return
        place = self._locator.place(statement)
        if place is None:
            return
        what = f"DelayUs({self._delays[thread]:g})" if kind == "delay" and thread in self._delays else "a polling loop"
        if busy.finding is None:
            busy.finding = self._findings.report_at(
                place, "busy-wait", f"{thread} busy-waits in {what} while {' and '.join(map(str, lower[:3]))} "
                f"could run: a task should block while it waits", object=thread.name,
                value=us(lasted), how="dynamic", task=thread.name,
            )  # fmt: skip
        elif isinstance(busy.finding.value, float):
            busy.finding.value = max(busy.finding.value, us(lasted))

    def _pended(self, taken: int, *arguments: Any) -> None:
        if not taken and arguments[-1] == 0:  # BIOS_NO_WAIT
            self._vain.setdefault(self._threads.current, Counter())[self._locator.here()] += 1

    def _delay(self, microseconds: float) -> None:
        self._calls += 1
        self._delays[self._threads.current] = microseconds

    def _delayed(self, _result: None, microseconds: float) -> None:
        thread = self._threads.current
        self._delays.pop(thread, None)
        if thread is not self._threads.main and not thread.is_task and microseconds >= BUSY_INTERRUPT_US:
            self._findings.report(
                "busy-wait", f"{thread} waits {microseconds:g} us in DelayUs: nothing of its level or below can run "
                "in this time, and no task", object=thread.name, value=float(microseconds),
            )  # fmt: skip

    # Starvation

    def _judge(self, thread: Thread, waiting: ReadyTask, now: int) -> None:
        waited = now - waiting.since
        limit = self._releases.period(thread) or self._starved_cycles
        if waited <= limit:
            return
        blamed = self._blamed(thread, waiting.since)
        used = [(other, cycles) for other, cycles in self._threads.used_since(waiting.usage) if other is not thread]
        if blamed is None or not used:
            return
        (culprit, statement, kind), ticks = blamed
        doing = f"{_DOING[kind]} here at {ticks} of the ticks"
        asked = self._vain.get(culprit)
        if not kind and asked is not None and asked.total() >= VAIN_PENDS:
            (statement, _times), doing = asked.most_common(1)[0], "never blocks: it asks here with BIOS_NO_WAIT"
        place = self._locator.place(statement)
        if place is None:
            return
        share = next((cycles for other, cycles in used if other is culprit), 0)
        message = (
            f"{thread} was ready from {ms(waiting.since):.3f} ms and got no CPU for {ms(waited):.3f} ms: {culprit} "
            f"used it for {ms(share):.3f} ms and {doing}"
        )
        details = tuple(f"{other} ran for {ms(cycles):.3f} ms of it" for other, cycles in used[:4])
        if waiting.finding is None:
            waiting.finding = self._findings.report_at(
                place, "starvation", message, object=thread.name, value=us(waited), details=details, how="dynamic",
                task=culprit.name,
            )  # fmt: skip
        finding = waiting.finding
        if finding is not None and us(waited) > finding.value:
            finding.message, finding.value, finding.details = message, us(waited), details

    def _blamed(self, thread: Thread, since: int) -> tuple[Sample, int] | None:
        """The busy wait at which other threads were found most often; without one, the statement.  With its ticks."""
        counted: Counter[Sample] = Counter()
        for time, sample in reversed(self._samples):
            if time < since:
                break
            if sample[0] is not thread:
                counted[sample] += 1
        waits = Counter({sample: count for sample, count in counted.items() if sample[2]})
        most = (waits or counted).most_common(1)
        return most[0] if most else None
