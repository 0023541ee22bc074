"""Buffers that are written while an interrupt sends them: `buffer-rewritten`.

The buffer is the object that a Hwi or Swi reads last before it writes the transmit register.  The transmission ends
when the transmitter has sent all that was written and gets nothing new for the time of two characters.  Until then the
words after the last one read are still to be sent.  A write to them is reported, unless the interrupt has signalled
that it has read all.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x.findings import Finding, Findings
from emulator.c28x.memory import Object
from emulator.clock import us
from emulator.sysbios.watch.statements import StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Thread, ThreadWatch

#: After this many character times without a new character, the transmission has ended.
GRACE: Final = 2


class BufferInTransmission:
    """A buffer that is being sent.

    `offset`, `clock` and `statement`: the word that was read last, the thread's clock at that time, and the statement.
    `until`: the cycle when everything written so far has been sent.  `character`: the cycles of one character.
    """

    __slots__ = ("character", "clock", "offset", "register", "statement", "thread", "until")

    def __init__(
        self, register: str, thread: Thread, offset: int, clock: int, statement: StatementNumber, until: int,
        character: int,
    ) -> None:  # fmt: skip
        self.register = register
        self.thread = thread
        self.offset = offset
        self.clock = clock
        self.statement = statement
        self.until = until
        self.character = character


class Transmission:
    """Listens to accesses of objects, and to writes to a transmit register."""

    def __init__(self, threads: ThreadWatch, locator: StatementLocator, findings: Findings) -> None:
        self._threads = threads
        self._locator = locator
        self._findings = findings
        self._clock = findings.clock
        self._read: dict[Thread, tuple[Object, int, StatementNumber]] = {}
        #: Buffers that are being sent.
        self.sending: dict[Object, BufferInTransmission] = {}
        #: Register -> the cycle when its transmitter has sent everything.
        self._dry: dict[str, int] = {}
        self._found: dict[Object, Finding] = {}

    def touch(self, obj: Object, offset: int, write: bool) -> None:
        """The running thread reads or writes a word."""
        if write:
            sending = self.sending.get(obj)
            if sending is not None and self._threads.current is not sending.thread:
                self._written(obj, offset, sending, self._threads.current)
        elif obj.words > 2:
            thread = self._threads.current
            if not thread.is_task:
                self._read[thread] = (obj, offset, self._locator.here())

    def sent(self, register: str, character_cycles: int) -> None:
        """The running thread writes a character to a transmit register."""
        now = self._clock.now
        until = self._dry[register] = max(now, self._dry.get(register, 0)) + character_cycles
        thread = self._threads.current
        found = self._read.pop(thread, None)
        if found is not None:
            obj, offset, statement = found
            self.sending[obj] = BufferInTransmission(
                register, thread, offset, thread.clock, statement, until, character_cycles
            )

    def _written(self, obj: Object, offset: int, sending: BufferInTransmission, thread: Thread) -> None:
        if self._clock.now >= sending.until + GRACE * sending.character:
            del self.sending[obj]
            return
        if offset <= sending.offset or thread.knows(sending.thread, sending.clock):
            return
        path = obj.declaration.path
        known = self._found.get(obj)
        if known is not None:
            known.count += 1
            return
        finding = self._findings.report(
            "buffer-rewritten", f"{path} is written by {thread} at word {offset} while {sending.thread} sends it to "
            f"{sending.register} and is at word {sending.offset}: a mixture of old and new content is sent",
            object=path, declaration=str(obj.declaration), value=offset,
            details=(
                f"{sending.thread} reads it in {self._locator.text(sending.statement)}; the transmitter is busy until "
                f"{us(sending.until):.1f} us",
            ),
        )  # fmt: skip
        if finding is not None:
            self._found[obj] = finding
