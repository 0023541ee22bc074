"""What a test waits for: a pin, a frame, a task, a register, a time, a finding, a condition; `a | b` for either.

`Timeline.until` arms a trigger, which then calls `fire(value)`.  Times are virtual.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable
from fnmatch import fnmatchcase
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.clock import SYSCLK_HZ, Event, ms
from emulator.registers.cell import Cell
from hil.board import Board
from hil.testing.case import ExpectedFinding
from hil.testing.outside import pin_of
from hil.testing.uart import Uart

Fire = Callable[[Any], None]
Disarm = Callable[[], None]
#: How often a condition is looked at, in cycles.
SAMPLE_CYCLES: Final = SYSCLK_HZ // 10_000


class Subscription:
    """A listener that gets nothing after `end`, not even the rest of an emission under way."""

    __slots__ = ("_fire", "_on", "_stop")

    def __init__(self, fire: Fire) -> None:
        self._fire = fire
        self._on = True
        self._stop: Disarm = _nothing

    def until(self, stop: Disarm) -> None:
        """It is connected; `stop` disconnects it."""
        self._stop = stop

    def __call__(self, value: Any) -> None:
        """It happened."""
        if self._on:
            self._fire(value)

    def end(self) -> None:
        """Hear nothing more."""
        self._on = False
        self._stop()


def _nothing() -> None:
    """Does nothing: for a trigger that had nothing to connect."""


class Trigger(ABC):
    """Something that happens.  `str()` says what, for the message of a time-out."""

    @abstractmethod
    def arm(self, fire: Fire) -> Disarm:
        """Call `fire(value)` when it happens; returns what ends the watch."""

    def instead(self) -> str:
        """The present state instead, in a few words, for the message of a time-out."""
        return ""

    def __or__(self, other: Trigger) -> Either:
        return Either(self, other)


class Either(Trigger):
    """The trigger that fires first; gives its value."""

    def __init__(self, *triggers: Trigger) -> None:
        self.triggers = triggers

    def arm(self, fire: Fire) -> Disarm:
        """Arm all."""
        ends = [trigger.arm(fire) for trigger in self.triggers]

        def end() -> None:
            for each in ends:
                each()

        return end

    def instead(self) -> str:
        """The state of each, where it has one."""
        return "; ".join(text for text in (t.instead() for t in self.triggers) if text)

    def __str__(self) -> str:
        return " or ".join(map(str, self.triggers))


class Pin(Trigger):
    """GPIOn has a level, or with `edge` changes to it.  Gives the level."""

    def __init__(self, board: Board, gpio: int, level: int, *, edge: bool) -> None:
        self._wire = pin_of(board, gpio)
        self._level = level
        self._edge = edge

    def arm(self, fire: Fire) -> Disarm:
        """Listen to the wire."""
        watch = Subscription(lambda level: fire(level) if level == self._level else None)
        watch.until(self._wire.changed.connect(watch))
        if not self._edge:
            watch(self._wire.level)
        return watch.end

    def instead(self) -> str:
        """The level."""
        return f"{self._wire.name} is {self._wire.level}"

    def __str__(self) -> str:
        return f"{'change of ' if self._edge else ''}{self._wire.name} to {self._level}"


class Frame(Trigger):
    """Bytes on a line that match a pattern, behind what was waited for before.  Gives the match."""

    def __init__(self, uart: Uart, pattern: bytes) -> None:
        self._uart = uart
        self._pattern = re.compile(pattern, re.DOTALL)

    def arm(self, fire: Fire) -> Disarm:
        """Look at what is unread, now and after each byte."""

        def look(_byte: Any) -> None:
            found = self._pattern.search(self._uart.unread)
            if found:
                watch.end()
                self._uart.skip(found.end())
                fire(found)

        watch = Subscription(look)
        watch.until(self._uart.byte_received.connect(watch))
        watch(None)
        return watch.end

    def instead(self) -> str:
        """What came."""
        return f"received {self._uart.unread!r}"

    def __str__(self) -> str:
        return f"frame {self._pattern.pattern!r}"


class TaskEvent(Trigger):
    """An event of the kernel's trace about a name (a pattern such as `Task*`).  Gives the name."""

    def __init__(self, board: Board, kinds: tuple[str, ...], name: str, text: str) -> None:
        self._board = board
        self._kinds = kinds
        self._name = name
        self._text = text

    def arm(self, fire: Fire) -> Disarm:
        """Listen to the trace."""
        watch = Subscription(lambda event: fire(event[1]) if self._fits(*event) else None)
        watch.until(self._board.trace.listen(lambda _cycles, kind, name: watch((kind, name))))
        return watch.end

    def _fits(self, kind: str, name: str) -> bool:
        return kind in self._kinds and fnmatchcase(name, self._name)

    def instead(self) -> str:
        """The names of the threads that exist."""
        names = ", ".join(task.name for task in self._board.kernel.tasks.all)
        return f"tasks: {names}" if names else "no task exists"

    def __str__(self) -> str:
        return f"{self._name} {self._text}"


class Written(Trigger):
    """The firmware writes a register, or the given value to it.  Gives the whole word."""

    def __init__(self, register: Cell, value: int | None) -> None:
        self._register = register
        self._value = value
        self._last: int | None = None

    def arm(self, fire: Fire) -> Disarm:
        """Tap the register."""

        def look(_register: Cell, _access: str, word: int, _mask: int) -> None:
            self._last = word
            if self._value is None or word == self._value:
                fire(word)

        self._register.tap(look)
        return lambda: self._register.untap(look)

    def instead(self) -> str:
        """The last word written."""
        return "it was not written" if self._last is None else f"last written {self._last:#06x}"

    def __str__(self) -> str:
        value = "" if self._value is None else f" with {self._value:#06x}"
        return f"write of {self._register.path}{value}"


class Time(Trigger):
    """A virtual time since power-up has come.  Gives the time in seconds."""

    def __init__(self, board: Board, time_s: float) -> None:
        self._clock = board.clock
        self._time_s = time_s

    def arm(self, fire: Fire) -> Disarm:
        """An event at that time, or at once."""
        event = self._clock.schedule(
            max(self._clock.now, round(self._time_s * SYSCLK_HZ)), lambda: fire(self._clock.now / SYSCLK_HZ)
        )
        return lambda: self._clock.cancel(event)

    def instead(self) -> str:
        """The time."""
        return f"it is {ms(self._clock.now):.3f} ms"

    def __str__(self) -> str:
        return f"time {self._time_s:g} s"


class Found(Trigger):
    """A finding of a rule (or pattern), at its first occurrence from now on.  Gives the finding."""

    def __init__(self, board: Board, rule: str) -> None:
        self._findings = board.findings
        self._rule = rule

    def arm(self, fire: Fire) -> Disarm:
        """Listen to the findings."""

        def look(finding: Finding) -> None:
            if fnmatchcase(finding.rule, self._rule):
                fire(finding)

        watch = Subscription(look)
        watch.until(self._findings.found.connect(watch))
        return watch.end

    def instead(self) -> str:
        """What was found."""
        return f"found {', '.join(sorted({f.rule for f in self._findings})) or 'nothing'}"

    def __str__(self) -> str:
        return f"finding {self._rule}"


class Holds(Trigger):
    """A condition of the test's own holds, looked at every `SAMPLE_CYCLES`.  Gives what it returned."""

    def __init__(self, board: Board, condition: Callable[[], Any], text: str) -> None:
        self._clock = board.clock
        self._condition = condition
        self._text = text

    def arm(self, fire: Fire) -> Disarm:
        """Look now and again."""
        pending: Event | None = None

        def look() -> None:
            nonlocal pending
            value = self._condition()
            if value:
                fire(value)
            else:
                pending = self._clock.after(SAMPLE_CYCLES, look)

        look()
        return lambda: self._clock.cancel(pending)

    def __str__(self) -> str:
        return self._text


class When:
    """The fixture `when`: makes triggers for one board."""

    def __init__(self, board: Board, uart: Callable[[], Uart]) -> None:
        self._board = board
        self._uart = uart

    def pin(self, gpio: int, level: int) -> Trigger:
        """GPIO`gpio` is `level`, now or later."""
        return Pin(self._board, gpio, level, edge=False)

    def rises(self, gpio: int) -> Trigger:
        """GPIO`gpio` changes from 0 to 1."""
        return Pin(self._board, gpio, 1, edge=True)

    def falls(self, gpio: int) -> Trigger:
        """GPIO`gpio` changes from 1 to 0."""
        return Pin(self._board, gpio, 0, edge=True)

    def frame(self, pattern: bytes | str, uart: Uart | None = None) -> Trigger:
        """The firmware sends bytes that match the regular expression, on `uart` or the robot's line."""
        raw = pattern.encode("latin-1") if isinstance(pattern, str) else pattern
        return Frame(uart or self._uart(), raw)

    def runs(self, task: str) -> Trigger:
        """A task, Swi or Hwi (by name or pattern) gets the CPU."""
        return TaskEvent(self._board, ("switch", "swi", "hwi"), task, "running")

    def blocks(self, task: str) -> Trigger:
        """A task blocks: on a semaphore, a gate, a sleep, or at its end."""
        return TaskEvent(self._board, ("block",), task, "blocked")

    def posted(self, semaphore: str) -> Trigger:
        """A semaphore is posted."""
        return TaskEvent(self._board, ("post",), semaphore, "posted")

    def written(self, register: str, value: int | None = None) -> Trigger:
        """The firmware writes `AdcaRegs.ADCSOCFRC1` (any word, or `value`)."""
        block, _, name = register.partition(".")
        return Written(self._board.register(block, name), value)

    def time(self, time_s: float) -> Trigger:
        """`time_s` seconds since power-up."""
        return Time(self._board, time_s)

    def finding(self, rule: str = "*") -> Trigger:
        """A finding of a rule, or of one that fits the pattern.  Raises ValueError for a rule that does not exist."""
        ExpectedFinding(rule, required=False)
        return Found(self._board, rule)

    def holds(self, condition: Callable[[], Any], text: str = "the condition") -> Trigger:
        """`condition()` is true; looked at every 100 us."""
        return Holds(self._board, condition, text)
