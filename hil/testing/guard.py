"""Ends a driver function that does not return, with a finding at its loop.  So no call of a test hangs.

An endless loop at the end of `main` is right.  Then the caller gets `Idling`, and there is no finding.  In an interrupt
routine, such a loop is a finding.  Interrupt routines that run during a call are guarded like calls.  The finding names
the loop of the innermost function that has not returned for half of the time limit.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial, wraps
from typing import Any, Final, NoReturn

from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.position import Calls
from emulator.c28x.runtime import EndlessPoll, Idling
from emulator.c28x.sites import Place
from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, ClockEvent, seconds
from emulator.cpu import INTERRUPT_ENTRY_CYCLES, INTERRUPT_EXIT_CYCLES
from hil.board import Board
from hil.testing.waits import PollingLoop, PollingLoops

#: The virtual time between two checks of a call.
_CHECK_CYCLES: Final = 10 * CYCLES_PER_MS
#: The computation after which the loop of a call is examined: 10 ms of virtual time, less than half a second here.
_COMPUTED_CYCLES: Final = 2_000_000
#: The number of interrupt routines after which the loop is examined.  They take about as long.
_ROUTINES: Final = 1000
#: The turns of a loop that are still executed after a check has found nothing that could end it.
_TURNS: Final = 2


def guard(board: Board, linked: Linked, limit_s: float) -> None:
    """End each call of a test that takes longer than `limit_s` seconds of virtual time, by EndlessPoll or Idling.

    A call that has computed for long is ended earlier if nothing can end its loop (`PollingLoop.hopeless`).
    """
    watch = _CallWatch(board, linked, limit_s)
    board.vectors.wrap_with(watch.routine)
    functions = linked.functions
    for path, function in functions.items():
        functions[path] = watch.watched(path, function)


@dataclass(slots=True, eq=False)
class _Call:
    """A call that has not returned: its function, and the time and place of its start."""

    path: str
    who: str
    began: int
    computed: int
    #: The number of interrupt routines that were running, and the number that had returned.
    level: int
    routines: int
    halfway: list[Calls | None] = field(default_factory=list)
    #: When a loop was first found hopeless, and the cycles that were executed outside interrupt routines until then.
    hopeless: dict[Place, tuple[int, int]] = field(default_factory=dict)
    events: tuple[ClockEvent, ...] = ()


class _CallWatch:
    """Checks from time to time which calls have not returned.  Most calls return before the first check."""

    def __init__(self, board: Board, linked: Linked, limit_s: float) -> None:
        self._core, self._clock, self._findings = board.cpu, board.clock, linked.runtime.findings
        self._waits = PollingLoops(board, linked)
        self._limit = round(limit_s * SYSCLK_HZ)
        self._every = min(_CHECK_CYCLES, max(1, self._limit // 4))
        #: The calls that have not returned, the innermost last.
        self._calls: list[_Call] = []
        #: The number of interrupt routines that have returned, and their total time.  The time of nested routines
        #: counts twice.
        self._routines = 0
        self._served = 0
        #: The calls of the firmware that had not returned at the last check.
        self._before: list[Calls | None] = []
        self._next: ClockEvent | None = None

    def watched(self, path: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap `function` so that it is ended if it does not return."""
        clock, core, calls = self._clock, self._core, self._calls

        @wraps(function)
        def call(*arguments: Any) -> Any:
            began = clock.now
            one = _Call(
                path, self._findings.context(), began, began - clock.waited, core.in_interrupt, self._routines
            )  # fmt: skip
            calls.append(one)
            if len(calls) == 1:
                self._before.clear()
                self._next = clock.after(self._every, self._check)
            try:
                return function(*arguments)
            finally:
                for event in one.events:
                    clock.cancel(event)
                calls.remove(one)
                if not calls:
                    clock.cancel(self._next)

        return call

    def routine(self, function: Callable[[], Any]) -> Callable[[], Any]:
        """Wrap an interrupt routine in the same way."""
        clock, watched = self._clock, self.watched(function.__qualname__, function)

        @wraps(function)
        def run() -> None:
            began = clock.now
            watched()
            self._routines += 1
            self._served += clock.now - began + INTERRUPT_ENTRY_CYCLES + INTERRUPT_EXIT_CYCLES

        return run

    def _check(self) -> None:
        clock = self._clock
        self._next = clock.after(self._every, self._check)
        for call in reversed(self._calls):
            if not call.events:
                call.events = (
                    clock.schedule(max(clock.now, call.began + self._limit // 2), partial(self._half, call)),
                    clock.schedule(max(clock.now, call.began + self._limit), partial(self._end, call)),
                )
            computed = clock.now - clock.waited - call.computed
            if computed > _COMPUTED_CYCLES or self._routines - call.routines > _ROUTINES:
                self._examine(call)
        self._before[:] = [running for _, running in self._findings.position.frames()]

    def _examine(self, call: _Call) -> None:
        """End a call if nothing can end its loop any more."""
        called = _path_from(self._findings, self._before)
        wait = self._loop(call, called)
        if wait is None or not wait.hopeless:
            call.hopeless.clear()
            return
        # The next turn sees what happened before.  In a poll, time moves on from event to event, and a delay passes;
        # everything else in the loop is executed.
        clock = self._clock
        until = next((other.began for other in self._calls if other.level > call.level), clock.now)
        own = until - self._served - (clock.waited if wait.delays else 0)
        first, executed = call.hopeless.setdefault(wait.place, (clock.now, own))
        if clock.now > first and own - executed >= _TURNS * wait.turn_cycles:
            self._stop(call, called, wait)

    def _loop(self, call: _Call, called: tuple[Place, ...]) -> PollingLoop | None:
        wait = self._waits.at(called[0]) if called else None
        if wait is not None:
            above = tuple(other.path for other in self._calls if other.level > call.level)
            wait.running = above if self._core.in_interrupt > call.level else None
        return wait

    def _half(self, call: _Call) -> None:
        call.halfway.extend(running for _, running in self._findings.position.frames())

    def _end(self, call: _Call) -> None:
        called = _path_from(self._findings, call.halfway)
        if called and called[0].kind == "idle" and not self._core.in_interrupt:
            raise Idling(
                f"{call.path} idles for ever at {called[0]}, as it is written: no call of it returns; a main runs with "
                "the fixture `kernel` (kernel.start(main)), time with advance() and until()"
            )
        if self._core.asleep and not self._core.in_interrupt:
            raise Idling(f"{call.path} sleeps in IDLE: no interrupt that IER lets through has come")
        self._stop(call, called, self._loop(call, called))

    def _stop(self, call: _Call, called: tuple[Place, ...], wait: PollingLoop | None) -> NoReturn:
        lasted = seconds(self._clock.now - call.began)
        message = f"{call.path} has run for {lasted:.2g} s without returning: this loop does not end"
        details = tuple(wait.sentences()) if wait is not None else ()
        rule = "endless-poll" if wait is None else wait.rule
        if called:
            place = called[0] if wait is None else wait.place
            self._findings.report_at(
                place, rule, message, object=call.path, how="dynamic", call_path=(place, *called[1:]),
                details=details, task=call.who,
            )  # fmt: skip
        else:
            self._findings.report("endless-poll", message, object=call.path)
        raise EndlessPoll(message)


def _path_from(findings: Findings, halfway: list[Calls | None]) -> tuple[Place, ...]:
    """The call path of the innermost firmware function that is still one of `halfway`; empty if there is none."""
    for at, running in findings.position.frames():
        if any(running is call for call in halfway):
            return findings.path(at, running)
    return ()
