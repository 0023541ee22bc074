"""A message that is cut off on a serial line: does the program still understand the one after it?

When the usual time of the run is over, the lines fall silent, and the program gets one of the messages that it has had
again: three times whole, once the first half of it, then three times whole.  Before each there is a long pause.  What
it begins after the last character of each whole message, before the cut, is how it takes the message.  If part of that
does not run for the whole message after the half one, the receiver has taken its beginning for the missing rest.

Modelled
    Lines to a SCI with messages apart from each other, in programs of C or Python, with or without SYS/BIOS.
Not modelled
    Messages that a program only takes as an answer, or only once: what it does with them again is nothing, and so
    nothing is told.  A line of text that ends with CR or LF may lose the line after a cut one, because a person or
    a master ends the remains with an empty line; it must understand the next ones.

If the run itself has a line of text that nobody finishes, and then another line, the program is meant to cope with it.
Then these two are what is sent, and the second one must be understood.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Final

from emulator.c28x.coverage import CountedPlace, Coverage
from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place
from emulator.clock import CYCLES_PER_MS
from emulator.signals import SerialFrame, SerialLine
from hil.board import Board
from hil.drivers.sources import TOGETHER
from hil.image import Image

#: The pauses before the messages.  The longer one comes before whole messages only.  CHOICE: 0.6 s, because receivers
#: of frames wait for a few characters' time, some for half a second.
PAUSE: Final = 600 * CYCLES_PER_MS
#: The time that a program has to take a message.
_TAKEN: Final = 150 * CYCLES_PER_MS
#: Characters of a message: at least, at most.
_LENGTHS: Final = range(2, 65)
#: So many messages show what the program usually gets.
_MESSAGES: Final = 2
#: In a run with a line that is not finished, at least this part of the messages end with CR or LF.
_FINISHED: Final = 0.75
#: Characters of one message are not farther apart than this many of their own length.
_APART: Final = 3
#: Pauses before whole messages ahead of the cut, before the half, and before whole ones behind it.
_BEFORE: Final = (1, 1, 2)
_AFTER: Final = (1, 1, 1)
#: The time of a trial, without that of the characters.
TRIAL: Final = (sum(_BEFORE) + 1 + sum(_AFTER)) * (PAUSE + _TAKEN)

#: What has been begun how often.
Begun = dict[CountedPlace, int]


@dataclass(eq=False)
class SentMessage:
    """A message that was sent again, and what had been begun when.

    `quiet`: a pause before it; `steps`: before each of its characters ended, the first time before it began, and when
    the time to take it was over.
    """

    quiet: Begun
    steps: list[Begun]

    @property
    def idle(self) -> set[CountedPlace]:
        """What runs without any message."""
        return ran(self.quiet, self.steps[0])

    @property
    def characters(self) -> list[set[CountedPlace]]:
        """What runs for each of its characters."""
        return [ran(before, after) for before, after in pairwise(self.steps)]

    @property
    def within(self) -> set[CountedPlace]:
        """What runs before it is complete."""
        return ran(self.steps[0], self.steps[-2])

    @property
    def complete(self) -> set[CountedPlace]:
        """What runs when it is complete."""
        return ran(self.steps[-2], self.steps[-1])


def ran(before: Begun, after: Begun) -> set[CountedPlace]:
    """What has been begun between two times."""
    return {place for place, count in after.items() if count > before.get(place, 0)}


def messages_of(frames: list[SerialFrame]) -> list[list[SerialFrame]]:
    """The characters of a line, as messages."""
    found: list[list[SerialFrame]] = []
    for frame in frames:
        length = frame.end - frame.start
        if found and frame.start - found[-1][-1].end < max(TOGETHER, _APART * length):
            found[-1].append(frame)
        else:
            found.append([frame])
    return found


def _usual(messages: list[list[SerialFrame]]) -> list[SerialFrame]:
    """The last message of the most frequent length; empty: there is none that can be cut."""
    lengths = Counter(len(message) for message in messages)
    if len(messages) < _MESSAGES or max(lengths) not in _LENGTHS:
        return []
    length = max(lengths, key=lambda each: (lengths[each], each))
    return next(message for message in reversed(messages) if len(message) == length) if length > 1 else []


def _text(message: list[SerialFrame]) -> bytes:
    return bytes(frame.data & 0xFF for frame in message)


def _ends_line(message: list[SerialFrame]) -> bool:
    return message[-1].data in b"\r\n"


def _unfinished(messages: list[list[SerialFrame]]) -> tuple[list[SerialFrame], list[SerialFrame]] | None:
    """A line of text that is not finished, and the line behind it, which the run also has behind a finished one.

    Somebody who types slowly finishes few messages: they are the parts of lines.
    """
    finished = sum(map(_ends_line, messages))
    behind = {_text(message) for before, message in pairwise(messages) if _ends_line(before) and _ends_line(message)}
    for cut, message in pairwise(messages):
        if not _ends_line(cut) and _text(message) in behind and finished >= _FINISHED * len(messages):
            return cut, message
    return None


@dataclass(frozen=True)
class _Plan:
    """A message, and what is sent of one that is cut off before it; `own`: the run itself has both."""

    cut: list[SerialFrame]
    message: list[SerialFrame]
    own: bool = False

    @classmethod
    def of(cls, messages: list[list[SerialFrame]]) -> _Plan | None:
        """What to send, when these were the messages of a line; None: nothing."""
        found = _unfinished(messages)
        if found is not None:
            return cls(*found, own=True)
        message = _usual(messages)
        return cls(message[: len(message) // 2], message) if message else None


class CutTrial:
    """Sends messages to one image, and judges what its program does with them."""

    def __init__(self, image: Image) -> None:
        self._image = image
        self._board: Board = image.board
        self._coverage: Coverage = image.linked.coverage
        self._lines: dict[str, SerialLine] = {
            f"Sci{letter.lower()}Regs": sci.receiver.line for letter, sci in image.board.sci.items()
        }
        self._heard: dict[str, list[SerialFrame]] = {name: [] for name in self._lines}
        self._ends = [line.sent.connect(self._heard[name].append) for name, line in self._lines.items()]
        #: The lines that are still to be tried, with what to send; None: the usual time is not over.
        self._waiting: list[tuple[str, _Plan]] | None = None
        self._until = 0

    def until(self, usual: int) -> int:
        """The end of the run: not before all lines have been tried."""
        now = self._board.clock.now
        if now < usual:
            return usual
        if self._waiting is None:
            chosen = {name: _Plan.of(messages_of(frames)) for name, frames in self._heard.items()}
            self._waiting = [(name, plan) for name, plan in chosen.items() if plan is not None]
            for line in self._board.serial_pins.values():
                line.disturb(lambda frame: ())
        if now >= self._until:
            if not self._waiting:
                return now
            name, plan = self._waiting.pop(0)
            self._try(name, plan)
        return self._until

    def _try(self, name: str, plan: _Plan) -> None:
        sent: list[SentMessage] = []
        half: list[SentMessage] = []
        at = self._board.clock.now
        steps = [
            *((pauses, plan.message, sent) for pauses in _BEFORE), (1, plan.cut, half),
            *((pauses, plan.message, sent) for pauses in _AFTER),
        ]  # fmt: skip
        for pauses, characters, into in steps:
            at += pauses * PAUSE
            at = self._send(name, characters, at, into)
        # Behind everything that happens at that time, the result is known.
        self._board.clock.schedule(at + 1, partial(self._judge, name, plan, sent))
        self._until = at + 2

    def _send(self, name: str, characters: list[SerialFrame], at: int, into: list[SentMessage]) -> int:
        """Plan a message.  Returns the end of the time to take it."""
        clock = self._board.clock
        later = at - characters[0].start
        for frame in characters:
            moved = replace(frame, start=frame.start + later, end=frame.end + later)
            clock.schedule(moved.end, partial(self._lines[name].send, moved))
        end = characters[-1].end + later
        begun: list[Begun] = []

        def look() -> None:
            begun.append(self._coverage.begun())

        for moment in (at - PAUSE + 1, at, *(frame.end + later - 1 for frame in characters[1:])):
            clock.schedule(moment, look)

        def taken() -> None:
            look()
            into.append(SentMessage(begun[0], begun[1:]))

        clock.schedule(end + _TAKEN, taken)
        return end + _TAKEN

    def _judge(self, name: str, plan: _Plan, sent: list[SentMessage]) -> None:
        before, after = sent[: len(_BEFORE)], sent[len(_BEFORE) :]
        idle = set[CountedPlace]().union(*(each.idle for each in sent))
        takes = set.intersection(*(each.complete for each in before)) - idle
        takes -= set[CountedPlace]().union(*(each.within for each in before))
        lost = takes - after[0].complete
        if not lost:
            return
        again = next((n for n, each in enumerate(after) if lost <= each.complete), 0)
        if again and _ends_line(plan.message) and not plan.own:
            return
        usual = [set[CountedPlace]().union(*same) for same in zip(*(each.characters for each in before), strict=True)]
        other = (ran - known - idle for ran, known in zip(after[0].characters[:-1], usual, strict=False))
        # A receiver that does the same for each character but the last one goes wrong where it keeps them.
        keeps = usual[0] - usual[-1] - idle
        instead = next(filter(None, other), keeps or lost)
        place, missing = _place(self._image, instead), _place(self._image, lost)
        pause, text = PAUSE // CYCLES_PER_MS, _text(plan.message).hex(" ")
        count = again or len(after)
        cut = (
            f"the line {_text(plan.cut).decode('latin-1')!r} that the run itself does not finish" if plan.own
            else f"a message that ended after {len(plan.cut)} of {len(plan.message)} characters"
        )  # fmt: skip
        lost_ones = "the next whole one is" if count == 1 else f"the next {count} whole ones are"
        self._board.findings.report_at(
            place, "cut-message",
            f"after {cut}, and {pause} ms of silence, {lost_ones} not understood",
            object=f"{name}.SCIRXBUF", how="dynamic",
            details=(
                f"tried after the usual time, with the message {text} on a line that is silent otherwise; "
                f"{len(before)} times before, it was understood",
                f"what did not run: {missing}",
            ),
        )  # fmt: skip


def _place(image: Image, places: set[CountedPlace]) -> Place:
    """The first of them that is a statement."""
    first = min(places, key=lambda place: (not place.number, place.file, place.function, place.number))
    c_file = image.board.findings.sources.get(first.file, "")
    return Place(first.where.file, first.where.line, first.function, c_file, first.where.column)


def cut_messages(run: Callable[[Callable[[Image], CutTrial]], None]) -> list[Finding]:
    """The findings of a separate run.  `run(prepare)` passes a new image to `prepare`, then runs the program on it."""
    images: list[Image] = []

    def prepare(image: Image) -> CutTrial:
        images.append(image)
        return CutTrial(image)

    run(prepare)
    return [finding for image in images for finding in image.board.findings.of("cut-message")]
