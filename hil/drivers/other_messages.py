"""Other messages than those of the run: does the program write outside of an object, or compute a wrong number?

When the usual time of the run is over, a line that has had messages gets more of them:

    the same messages with other numbers in them: the limits between what the program takes and what it refuses are
    searched, for the numbers that it compares with, and their neighbours;
    the messages without a pause between them;
    a message that is far too long.

The check of a message (a sum, an exclusive or) is made anew, if it is known how: all messages of the run must agree.

A number that a right master never sends may do what it wants.  So what such a number shows is certain only if the
program takes the number, and refuses other ones in the same place: then it was meant for it.  Else it is a note.  That
messages come without a pause, or that one is too long, is no fault of the program: then it must not leave its objects.

Modelled
    Lines to a SCI, in programs of C or Python, with or without SYS/BIOS.  Numbers in text, and of one or two octets.
Not modelled
    A CRC.  Messages of a CAN.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Callable, Generator, Iterable, Iterator
from dataclasses import replace
from functools import partial, reduce
from operator import xor
from typing import Final, Literal, NamedTuple

from emulator.c28x.coverage import CountedPlace
from emulator.c28x.findings import Finding
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Call, Compare, Const
from emulator.c28x.tree_queries import bare, own_nodes, statements
from emulator.clock import CYCLES_PER_MS
from emulator.signals import SerialFrame, SerialLine
from hil.drivers.cut_messages import messages_of, ran
from hil.image import Image

#: A pause before each message, and the time that a program has to take it.
_PAUSE: Final = 30 * CYCLES_PER_MS
_TAKEN: Final = 60 * CYCLES_PER_MS
#: So many numbers of a line's messages are varied, in so many places of each; at most this many messages are sent.
_VARIED: Final = 12
_PLACES: Final = 8
_MOST: Final = 120
#: A message is sent so often to see how it is taken; so often without a pause.
_ALIKE: Final = 2
_ROW: Final = 4
#: The characters of a message that is too long.
_LONG: Final = 300
#: The time of all that.
OTHERS: Final = _MOST * (_PAUSE + _TAKEN)

#: What must not happen whatever comes.
OUTSIDE: Final = frozenset({
    "index", "unsigned-wrap-index", "table-short", "pointer-outside", "null-dereference", "memcpy-outside",
})  # fmt: skip
#: What must not happen with a number that is taken.
WRONG: Final = OUTSIDE | {
    "overflow", "widened-late", "unsigned-wrap", "narrowed", "float-to-int", "division-by-zero", "shift-range",
}  # fmt: skip


class _Number(NamedTuple):
    """A number in a message: where it is, how it is written, and which it is."""

    start: int
    end: int
    value: int
    kind: str
    write: Callable[[int], bytes]
    most: int

    def put(self, text: bytes, value: int) -> bytes:
        """The message with another number."""
        return text[: self.start] + self.write(value) + text[self.end :]


class OtherMessages:
    """Sends messages to one image, and keeps what its program shows then."""

    def __init__(self, image: Image, modules: Iterable[Module]) -> None:
        self._board = image.board
        self._coverage = image.linked.coverage
        self._constants = sorted(_constants(modules))
        self._lines: dict[str, SerialLine] = {
            f"Sci{letter.lower()}Regs": sci.receiver.line for letter, sci in image.board.sci.items()
        }
        self._heard: dict[str, list[SerialFrame]] = {name: [] for name in self._lines}
        for name, line in self._lines.items():
            line.sent.connect(self._heard[name].append)
        self._steps: Iterator[int] | None = None
        self._until = 0
        self._left = _MOST
        self._known: set[int] = set()
        #: What runs without any message.
        self._idle: set[CountedPlace] = set()
        self.found: list[Finding] = []

    def until(self, usual: int) -> int:
        """The end of the run: not before all messages have been sent."""
        now = self._board.clock.now
        if now < usual:
            return usual
        if self._steps is None:
            heard = {name: messages_of(frames) for name, frames in self._heard.items() if frames}
            for line in self._board.serial_pins.values():
                line.disturb(lambda frame: ())
            self._steps = self._all(heard)
        while self._until <= now:
            following = next(self._steps, None)
            if following is None:
                return now
            self._until = following
        return self._until

    def _all(self, heard: dict[str, list[list[SerialFrame]]]) -> Iterator[int]:
        self._known = {id(finding) for finding in self._board.findings}
        for name, messages in heard.items():
            length = messages[-1][0].end - messages[-1][0].start
            base = replace(messages[-1][0], start=0, end=length)
            send = partial(self._send, name, base)
            texts = list(dict.fromkeys(bytes(frame.data & 0xFF for frame in message) for message in messages))
            renew = next(one for one in _CHECKS if all(one(text) == text for text in texts))
            if any(map(_WHOLE.fullmatch, texts)):  # parts of lines are what somebody types
                texts = list(filter(_WHOLE.fullmatch, texts))
            row = b"".join((texts * _ROW)[: max(_ROW, len(texts))])
            yield from self._outside(send, row, "messages without a pause")
            done = set[tuple[bytes, str]]()
            for text in texts:
                varied = len(done)
                for number in _numbers(text, texts, checked=renew(text[:-1] + b"\0") != text[:-1] + b"\0"):
                    same = renew(number.put(text, 0)), f"{number.kind} at {number.start}"
                    if same not in done and len(done) < _VARIED:
                        done.add(same)
                        yield from self._vary(send, text, number, renew)
                if len(done) > varied:
                    yield from send(text)
            yield from self._outside(send, _too_long(texts[-1]), "a message that is too long")

    def _vary(
        self, send: Callable[[bytes], Generator[int, None, set[CountedPlace]]], text: bytes, number: _Number,
        renew: Callable[[bytes], bytes],
    ) -> Iterator[int]:  # fmt: skip
        """Send a message with other numbers, as far as it is known how the program takes it."""
        takes = yield from send(text)
        for _ in range(_ALIKE - 1):
            takes &= yield from send(text)
        takes -= self._idle
        if not takes or self._left < 2 * len(bin(len(self._constants))):
            return
        self._new()
        values = [value for value in self._constants if 0 <= value <= number.most and value != number.value]
        refused: list[int] = []
        seen: list[tuple[int, bool, Finding]] = []
        middle = bisect_left(values, number.value)
        for side in (values[middle:], values[:middle][::-1]):
            # The numbers before `low` are taken, that at `high` is refused.
            low, high, tried = 0, len(side), len(side) - 1
            while low < high:
                taken = takes <= (yield from send(renew(number.put(text, side[tried]))))
                refused += [] if taken else [side[tried]]
                seen += ((side[tried], taken, finding) for finding in self._new() if finding.rule in WRONG)
                low, high = (tried + 1, high) if taken else (low, tried)
                tried = (low + high) // 2
        for value, taken, finding in seen:
            sure = taken and bool(refused)
            for again in (refused[-1], value) * _ALIKE if sure else ():  # the state may have decided, not the number
                sure &= (takes <= (yield from send(renew(number.put(text, again))))) == (again == value)
            how = f"after the usual time, with {value} in place of {number.value} in the message {_shown(text)}"
            more = (f"the program takes {value} and refuses {refused[-1]}",) if sure else ()
            self._keep(finding, (how, *more), sure=sure)

    def _outside(
        self, send: Callable[[bytes], Generator[int, None, set[CountedPlace]]], text: bytes, what: str
    ) -> Iterator[int]:  # fmt: skip
        """Send what comes by chance."""
        self._new()
        yield from send(text)
        for finding in self._new():
            if finding.rule in OUTSIDE:
                self._keep(finding, (f"after the usual time, with {what}: {_shown(text)}",), sure=True)

    def _send(self, name: str, base: SerialFrame, text: bytes) -> Generator[int, None, set[CountedPlace]]:
        """Send a message; gives what ran when it was complete, and not before."""
        clock, length = self._board.clock, base.end
        if self._left <= 0 or not text:
            return set()
        self._left -= 1
        counts = [self._coverage.begun()]
        at = clock.now + _PAUSE
        for n, character in enumerate(text):
            frame = replace(base, data=character, start=at + n * length, end=at + (n + 1) * length)
            clock.schedule(frame.end, partial(self._lines[name].send, frame))
        end = at + len(text) * length
        for moment in (at, end - 1, end + _TAKEN):
            yield moment
            counts.append(self._coverage.begun())
        self._idle |= ran(counts[0], counts[1])
        return ran(counts[2], counts[3]) - ran(counts[1], counts[2])

    def _new(self) -> list[Finding]:
        """The findings since the last call."""
        new = [finding for finding in self._board.findings if id(finding) not in self._known]
        self._known |= {id(finding) for finding in new}
        return new

    def _keep(self, finding: Finding, details: tuple[str, ...], *, sure: bool) -> None:
        how = finding.how if sure else "generated"
        self.found.append(replace(finding, details=(*finding.details, *details), how=how))


#: A line of text with its end.
_WHOLE: Final = re.compile(rb"[ -~]*[\r\n]+")
_TEXT: Final = re.compile(rb"[ -~]+[\r\n]*")
#: The check of a line of text: two hexadecimal digits.
_HEX: Final = re.compile(rb"(.*?)(\*?)([0-9A-Fa-f]{2})([\r\n]*)", re.DOTALL)
_CODES: Final[tuple[Callable[[bytes], int], ...]] = (
    sum, lambda octets: reduce(xor, octets, 0), lambda octets: -sum(octets), lambda octets: ~sum(octets),
)  # fmt: skip


def _last_octet(code: Callable[[bytes], int], start: int, text: bytes) -> bytes:
    """A message whose last octet is the check of those from `start` on."""
    return text[:-1] + bytes([code(text[start:-1]) & 0xFF])


def _last_digits(code: Callable[[bytes], int], start: int, text: bytes) -> bytes:
    """A line whose last digits are the check of its characters from `start` on."""
    found = _HEX.fullmatch(text)
    if found is None:
        return b""
    digits = b"%02X" % (code(found[1][start:]) & 0xFF)
    return found[1] + found[2] + (digits.lower() if found[3].islower() else digits) + found[4]


def _unchecked(text: bytes) -> bytes:
    return text


#: How the check of a message can be made; the last one: it has none.
_CHECKS: Final[tuple[Callable[[bytes], bytes], ...]] = (
    *(partial(way, code, start) for way in (_last_octet, _last_digits) for code in _CODES for start in (0, 1, 2)),
    _unchecked,
)  # fmt: skip


def _numbers(text: bytes, texts: list[bytes], *, checked: bool) -> list[_Number]:
    """The numbers in one of the messages `texts`.  `checked`: its end is a check."""
    found: list[_Number] = []
    if _TEXT.fullmatch(text):
        widest = max((len(digits) for other in texts for digits in re.findall(rb"\d+", other)), default=0)
        check = _HEX.fullmatch(text) if checked else None
        for each in re.finditer(rb"\d+", text[: check.start(3) if check else None]):
            width = len(each[0]) if each[0].startswith(b"0") else 1
            write = partial(_decimal, width)
            found.append(_Number(each.start(), each.end(), int(each[0]), "text", write, 10 ** max(widest, width) - 1))
        return found[:_PLACES]
    columns = [set(column) for column in zip(*(other for other in texts if len(other) == len(text)), strict=True)]
    open_ = [len(values) > 1 or values == {0} for values in columns]
    end = len(text) - checked
    for at in range(1, end):
        if len(columns[at]) == 1 and any(len(values) > 1 for values in columns[1:end]):
            continue  # it is the same in all of them, where others differ
        orders: tuple[tuple[Literal["big", "little"], int], ...] = (("big", at - 1), ("little", at))
        pairs = [
            (order, first) for order, first in orders
            if 0 < first < end - 1 and all(open_[first : first + 2])
        ]  # fmt: skip
        if not any({0} in columns[first : first + 2] for _, first in pairs):
            found.append(_Number(at, at + 1, text[at], "octet", partial(int.to_bytes, length=1, byteorder="big"), 0xFF))
        for order, first in pairs:
            value = int.from_bytes(text[first : first + 2], order)
            write = partial(int.to_bytes, length=2, byteorder=order)
            found.append(_Number(first, first + 2, value, order, write, 0xFFFF))
    return found[:_PLACES]


def _decimal(width: int, value: int) -> bytes:
    return b"%0*d" % (width, value)


def _too_long(text: bytes) -> bytes:
    """A message that goes on and on."""
    if not _TEXT.fullmatch(text):
        return text[:1] * _LONG
    body = text.rstrip(b"\r\n")
    return body + body[-1:] * (_LONG - len(body)) + text[len(body) :]


def _constants(modules: Iterable[Module]) -> set[int]:
    """The numbers that a program compares with or passes to its functions, their neighbours, and 0 and limits."""
    found = {0, 1, 0x7F, 0xFF, 0x7FFF, 0xFFFF, 9, 99, 999, 9999, 99999}
    for module in modules:
        for function in module.functions:
            for s in statements(function.body):
                for e in own_nodes(s):
                    compared = [e.left, e.right] if isinstance(e, Compare) else []
                    for operand in map(bare, e.arguments if isinstance(e, Call) else compared):
                        if isinstance(operand, Const) and isinstance(operand.value, int):
                            found |= {operand.value - 1, int(operand.value), operand.value + 1}
    return found


def _shown(text: bytes) -> str:
    kept = text[:40]
    shown = repr(kept.decode("latin-1")) if _TEXT.fullmatch(text) else kept.hex(" ")
    return shown + (" ..." if len(text) > len(kept) else "")


def other_messages(
    modules: Iterable[Module], run: Callable[[Callable[[Image], OtherMessages]], None]
) -> list[Finding]:  # fmt: skip
    """The findings of a separate run.  `run(prepare)` passes a new image to `prepare`, then runs the program on it."""
    trials: list[OtherMessages] = []

    def prepare(image: Image) -> OtherMessages:
        trials.append(trial := OtherMessages(image, modules))
        return trial

    run(prepare)
    return [finding for trial in trials for finding in trial.found]
