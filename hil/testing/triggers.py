"""Triggers for which a test can wait: a pin, a frame, a task, a register, a time, a finding, a condition.

`a | b` fires with either of them.  `Timeline.until` arms a trigger, which then calls `fire(value)`.  Times are virtual.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable
from fnmatch import fnmatchcase
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.clock import SYSCLK_HZ, ClockEvent, ms
from emulator.registers.cell import Cell
from hil.board import Board
from hil.testing.case import ExpectedFinding
from hil.testing.outside import pin_of
from hil.testing.uart import Uart

Fire = Callable[[Any], None]
Disarm = Callable[[], None]
#: The cycles between two evaluations of a condition.
SAMPLE_CYCLES: Final = SYSCLK_HZ // 10_000


class Subscription:
    """A listener that gets nothing after `end`, not even if a signal is being emitted."""

    __slots__ = ("_fire", "_on", "_stop")

    def __init__(self, fire: Fire) -> None:
        self._fire = fire
        self._on = True
        self._stop: Disarm = _nothing

    def until(self, stop: Disarm) -> None:
        """Store `stop`, which disconnects the listener."""
        self._stop = stop

    def __call__(self, value: Any) -> None:
        """Pass a value on."""
        if self._on:
            self._fire(value)

    def end(self) -> None:
        """Disconnect the listener."""
        self._on = False
        self._stop()


def _nothing() -> None:
    """Do nothing.  It ends a trigger that has connected nothing."""


class Trigger(ABC):
    """An event for which a test can wait.  `str()` describes it, for the message of a time-out."""

    @abstractmethod
    def arm(self, fire: Fire) -> Disarm:
        """Call `fire(value)` when it happens.  Returns the function that ends this."""

    def instead(self) -> str:
        """The present state in a few words, for the message of a time-out."""
        return ""

    def __or__(self, other: Trigger) -> Either:
        return Either(self, other)


class Either(Trigger):
    """Fires with the first of several triggers.  Its value is that of the trigger."""

    def __init__(self, *triggers: Trigger) -> None:
        self.triggers = triggers

    def arm(self, fire: Fire) -> Disarm:
        """Arm all triggers."""
        ends = [trigger.arm(fire) for trigger in self.triggers]

        def end() -> None:
            for each in ends:
                each()

        return end

    def instead(self) -> str:
        """The state of each trigger that has one."""
        return "; ".join(text for text in (t.instead() for t in self.triggers) if text)

    def __str__(self) -> str:
        return " or ".join(map(str, self.triggers))


class Pin(Trigger):
    """A GPIO has a level, or with `edge` changes to it.  The value is the level."""

    def __init__(self, board: Board, gpio: int, level: int, *, edge: bool) -> None:
        self._wire = pin_of(board, gpio)
        self._level = level
        self._edge = edge

    def arm(self, fire: Fire) -> Disarm:
        """Listen to the wire of the pin."""
        watch = Subscription(lambda level: fire(level) if level == self._level else None)
        watch.until(self._wire.changed.connect(watch))
        if not self._edge:
            watch(self._wire.level)
        return watch.end

    def instead(self) -> str:
        """The present level."""
        return f"{self._wire.name} is {self._wire.level}"

    def __str__(self) -> str:
        return f"{'change of ' if self._edge else ''}{self._wire.name} to {self._level}"


class Frame(Trigger):
    """Bytes on a line match a pattern, after those of earlier triggers.  The value is the match."""

    def __init__(self, uart: Uart, pattern: bytes) -> None:
        self._uart = uart
        self._pattern = re.compile(pattern, re.DOTALL)

    def arm(self, fire: Fire) -> Disarm:
        """Compare the unread bytes, now and after each byte."""

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
        """The unread bytes."""
        return f"received {self._uart.unread!r}"

    def __str__(self) -> str:
        return f"frame {self._pattern.pattern!r}"


class TaskEvent(Trigger):
    """An event of the kernel's trace about a name (a pattern such as `Task*`).  The value is the name."""

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
    """The firmware writes a register, or a given value to it.  The value of the trigger is the whole word."""

    def __init__(self, register: Cell, value: int | None) -> None:
        self._register = register
        self._value = value
        self._last: int | None = None

    def arm(self, fire: Fire) -> Disarm:
        """Listen to writes of the register."""

        def look(_register: Cell, _access: str, word: int, _mask: int) -> None:
            self._last = word
            if self._value is None or word == self._value:
                fire(word)

        self._register.tap(look)
        return lambda: self._register.untap(look)

    def instead(self) -> str:
        """The last word that was written."""
        return "it was not written" if self._last is None else f"last written {self._last:#06x}"

    def __str__(self) -> str:
        value = "" if self._value is None else f" with {self._value:#06x}"
        return f"write of {self._register.path}{value}"


class Time(Trigger):
    """A virtual time since power-up.  The value is the time in seconds."""

    def __init__(self, board: Board, time_s: float) -> None:
        self._clock = board.clock
        self._time_s = time_s

    def arm(self, fire: Fire) -> Disarm:
        """Schedule an event at that time, or fire at once if it has passed."""
        event = self._clock.schedule(
            max(self._clock.now, round(self._time_s * SYSCLK_HZ)), lambda: fire(self._clock.now / SYSCLK_HZ)
        )
        return lambda: self._clock.cancel(event)

    def instead(self) -> str:
        """The present time."""
        return f"it is {ms(self._clock.now):.3f} ms"

    def __str__(self) -> str:
        return f"time {self._time_s:g} s"


class Found(Trigger):
    """A finding of a rule (or pattern), at its first occurrence from now on.  The value is the finding."""

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
        """The findings so far."""
        return f"found {', '.join(sorted({f.rule for f in self._findings})) or 'nothing'}"

    def __str__(self) -> str:
        return f"finding {self._rule}"


class Holds(Trigger):
    """A condition of the test is true.  It is evaluated every `SAMPLE_CYCLES`.  The value is its result."""

    def __init__(self, board: Board, condition: Callable[[], Any], text: str) -> None:
        self._clock = board.clock
        self._condition = condition
        self._text = text

    def arm(self, fire: Fire) -> Disarm:
        """Evaluate the condition now and regularly from now on."""
        pending: ClockEvent | None = None

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
    """The fixture `when`: creates triggers for one board."""

    def __init__(self, board: Board, uart: Callable[[], Uart]) -> None:
        self._board = board
        self._uart = uart

    def pin(self, gpio: int, level: int) -> Trigger:
        """GPIO`gpio` has the level `level`, now or later."""
        return Pin(self._board, gpio, level, edge=False)

    def rises(self, gpio: int) -> Trigger:
        """GPIO`gpio` changes from 0 to 1."""
        return Pin(self._board, gpio, 1, edge=True)

    def falls(self, gpio: int) -> Trigger:
        """GPIO`gpio` changes from 1 to 0."""
        return Pin(self._board, gpio, 0, edge=True)

    def frame(self, pattern: bytes | str, uart: Uart | None = None) -> Trigger:
        """The firmware sends bytes that match the regular expression, on `uart` or on the robot's line."""
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
        """Virtual time reaches `time_s` seconds since power-up."""
        return Time(self._board, time_s)

    def finding(self, rule: str = "*") -> Trigger:
        """A finding of a rule, or of a rule that matches the pattern.  Raises ValueError for an unknown rule."""
        ExpectedFinding(rule, required=False)
        return Found(self._board, rule)

    def holds(self, condition: Callable[[], Any], text: str = "the condition") -> Trigger:
        """`condition()` is true.  It is evaluated every 100 us."""
        return Holds(self._board, condition, text)
