"""Virtual time: integer SYSCLK cycles and one queue of events.

One cycle is 5 ns (SYSCLK 200 MHz, F2837xS data sheet).  Time passes in two ways only: the CPU executes
(`charge`), or the CPU is idle and time moves on to the next event (`advance_to`).

What happens within one charge::

    now += cycles
    while an event is due:   now = its own time;  its callback runs      (peripherals, devices, world)
    now = the CPU's time
    attention                                                            (interrupts, then task switches)

So a callback always sees `now` equal to the time it was scheduled for, however coarse the charge was, and
interrupts are taken only between two charges of the CPU.  Equal times run by priority, then in the order
they were scheduled: two runs of one seed are the same run.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from mypy_extensions import i64

SYSCLK_HZ: Final = 200_000_000
CYCLES_PER_US: Final = SYSCLK_HZ // 1_000_000
CYCLES_PER_MS: Final = SYSCLK_HZ // 1_000
#: No time.  It is the highest power of two that compiled code keeps in a machine word.
NEVER: Final = 1 << 61
#: Cycles from any time that a board reaches to any time that is meant.
FAR: Final = 1 << 60


class ClockEvent:
    """Something that happens at a time.  Whoever schedules it keeps it, to cancel it or to schedule it again.

    A subclass with a `run` of its own is called without the detour of a stored callable: for what happens most.
    """

    __slots__ = ("callback", "number", "priority", "time")

    def __init__(self, callback: Callable[[], None], priority: int = 0) -> None:
        self.callback = callback
        self.priority: i64 = priority
        #: When it is due, or was, in cycles.
        self.time: i64 = 0
        #: Its number in the order of scheduling; 0 while it does not wait.
        self.number: i64 = 0

    @property
    def waits(self) -> bool:
        """Whether it is still to come."""
        return self.number != 0

    def run(self) -> None:
        """Do what happens."""
        self.callback()


def _never() -> None:
    """The callback of the event at NEVER, which never runs."""


def no_attention() -> None:
    """The attention callback when nothing has the CPU: no interrupt is taken."""


class Clock:
    """The time of one board.

    `now` and `next` are plain attributes because translated firmware inlines
    ``clock.now += n`` / ``if clock.now >= clock.next: clock.run_due()``.
    """

    __slots__ = ("_attention", "_cancelled", "_sequence", "_waiting", "need_attention", "next", "now", "waited")

    def __init__(self) -> None:
        self.now: i64 = 0
        self.next: i64 = NEVER
        #: The cycles of polls, delays and idling.  Time skips them; they are not executed one by one.
        self.waited: i64 = 0
        #: Whether the CPU must look for interrupts or task switches (`request_attention`).
        self.need_attention = False
        self._attention: Callable[[], None] = no_attention
        #: The events that wait, the soonest last: what is scheduled as the next thing to happen (a conversion, a
        #: transfer) moves no other one.  The first is one that never comes, so that there is always a last one.
        self._waiting = [ClockEvent(_never)]
        self._waiting[0].time = NEVER
        self._sequence: i64 = 0
        self._cancelled = 0

    def schedule(self, time: int, callback: Callable[[], None], priority: int = 0) -> ClockEvent:
        """Run `callback` at `time` (absolute cycles).  Lower `priority` runs first among equal times.

        Raises ValueError for a time that has passed.
        """
        event = ClockEvent(callback, priority)
        self.start(event, time)
        return event

    def after(self, cycles: int, callback: Callable[[], None], priority: int = 0) -> ClockEvent:
        """Run `callback` `cycles` from now."""
        return self.schedule(self.now + cycles, callback, priority)

    def start(self, event: ClockEvent, time: i64) -> None:
        """Run an event at `time` (absolute cycles), and not when it was to run before, if it waits already.

        Raises ValueError for a time that has passed.
        """
        if time < self.now:
            raise ValueError(f"event at cycle {time} lies before now ({self.now})")
        if event.number:
            self.cancel(event)
        self._sequence = number = self._sequence + 1
        event.time = time
        event.number = number
        # Its place is behind later ones and before equal ones, which were scheduled earlier.  Mostly it is the last.
        waiting = self._waiting
        first, end = 0, len(waiting)
        last = waiting[-1]
        if time < last.time or (time == last.time and event.priority < last.priority):
            first = end
        while first < end:
            middle = (first + end) // 2
            other = waiting[middle]
            if other.time < time or (other.time == time and other.priority <= event.priority):
                end = middle
            else:
                first = middle + 1
        waiting.insert(first, event)
        if time < self.next:
            self.next = time

    def cancel(self, event: ClockEvent | None) -> None:
        """Forget an event.  Cancelling one that does not wait, or None, does nothing."""
        if event is None or not event.number:
            return
        event.number = 0
        self._cancelled += 1
        waiting = self._waiting
        waiting.remove(event)
        self.next = waiting[-1].time
        if self.need_attention and self.next > self.now:
            self.next = self.now

    def next_besides(self, event: ClockEvent) -> i64:
        """The time before which nothing but `event` is due."""
        waiting = self._waiting
        return waiting[-2].time if waiting[-1] is event else waiting[-1].time

    def serve_with(self, attention: Callable[[], None]) -> None:
        """Give the CPU to a new owner: `attention` is called, at the CPU's time, after events that requested it.

        There is one owner at a time: the core, then a kernel that takes the CPU over, `no_attention` after the program.
        """
        self._attention = attention

    @property
    def server(self) -> Callable[[], None]:
        """The attention callback of the CPU's owner."""
        return self._attention

    def request_attention(self) -> None:
        """Have the CPU look as soon as it can for a latched interrupt or a ready task."""
        self.need_attention = True
        # A request from a register access is seen at the next charge.
        if self.next > self.now:
            self.next = self.now

    def charge(self, cycles: i64) -> None:
        """The CPU executes for `cycles`."""
        self.now = now = self.now + cycles
        if now >= self.next:
            self.run_due()

    def run_due(self) -> None:
        """Run what is due up to `now`, then give the CPU's owner its chance to switch."""
        waiting = self._waiting
        cpu_time = self.now
        while True:
            time = waiting[-1].time
            if time > cpu_time:
                break
            event = waiting.pop()
            event.number = 0
            self.now = time
            event.run()
        self.next = time
        self.now = cpu_time
        if self.need_attention:
            self.need_attention = False
            self._attention()

    def advance_to(self, time: i64) -> None:
        """Move the time of an idle CPU to `time`.  It stops at each event on the way."""
        while self.next <= time:
            if self.next > self.now:
                self.waited += self.next - self.now
                self.now = self.next
            self.run_due()
        if time > self.now:
            self.waited += time - self.now
            self.now = time

    def delay(self, cycles: i64) -> None:
        """A busy wait of `cycles` *executed* cycles: pre-emption makes it longer, as on the chip."""
        remaining = cycles
        while remaining > 0:
            step = min(remaining, max(self.next - self.now, 0))
            remaining -= step
            self.now += step
            self.waited += step
            if self.now >= self.next:
                self.run_due()

    def poll(self, iteration_cycles: i64) -> i64:
        """Move the time of a loop that only polls a flag to its first iteration at or after the next event.

        Equal to running the iterations one by one, because between events no register changes.
        Returns the time then; NEVER, without moving, when no event is left: then nothing can end the poll.
        """
        now, due = self.now, self.next
        if due <= now:
            self.now = now + iteration_cycles
        elif due - now < FAR:
            cpu_time = due + (now - due) % iteration_cycles
            self.waited += cpu_time - now
            # The poll nearly always waits for this event alone: it runs as in `run_due`, which would look for more.
            event = self._waiting.pop()
            self.next = self._waiting[-1].time
            self.now = due
            event.number = 0
            event.run()
            self.now = cpu_time
            if cpu_time < self.next:
                return cpu_time
        else:
            return NEVER
        self.run_due()
        return self.now

    def skip_turns(self, cycles: i64, until: i64) -> None:
        """Skip whole turns of a loop, of `cycles` each, that end before the next event and not after `until`."""
        end = min(self.next - 1, until)
        if 0 < cycles <= end - self.now < FAR:
            skipped = (end - self.now) // cycles * cycles
            self.now += skipped
            self.waited += skipped

    @property
    def scheduled(self) -> int:
        """How many events were ever scheduled."""
        return self._sequence

    @property
    def events_run(self) -> int:
        """How many events have run since the clock was made."""
        return self._sequence - self._cancelled - self.pending

    def waiting(self) -> list[Callable[[], None]]:
        """The callbacks of the events that wait, the soonest first."""
        return [event.callback for event in self._waiting[:0:-1]]

    @property
    def pending(self) -> int:
        """How many events wait."""
        return len(self._waiting) - 1


def us(cycles: int) -> float:
    """Cycles as microseconds."""
    return cycles / CYCLES_PER_US


def ms(cycles: int) -> float:
    """Cycles as milliseconds."""
    return cycles / CYCLES_PER_MS


def seconds(cycles: int) -> float:
    """Cycles as seconds."""
    return cycles / SYSCLK_HZ
