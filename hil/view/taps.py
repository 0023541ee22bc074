"""Who touches a register: the observer behind "last writer" and "step to the next register access".

It stands in front of the access functions of every register, as linked firmware finds them, again whenever a module's
clock is switched.  While it is off the registers are bound as if it did not exist: it costs nothing.

Not seen: what a peripheral itself changes in its registers (flags, counters, results); that is no write of the CPU.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from types import CodeType, FrameType
from typing import Any

from emulator.registers.cell import Cell
from emulator.registers.fields import ALL
from hil.bench import Bench

#: seen(register, "read" or "write", word): the access is about to happen; of a read the word is not known, -1.
Seen = Callable[[Cell, str, int], None]


@dataclass(frozen=True, slots=True)
class Writer:
    """Who wrote a register last."""

    cycles: int
    #: Empty where no firmware stood behind the write: the kernel's or the start-up's own.
    file: str
    line: int
    function: str
    task: str
    word: int


class _Sentry(dict[str, Any]):
    """Follows the access functions of a register, and puts its own before each new set."""

    def __init__(self, register: Cell, taps: Taps) -> None:
        super().__init__()
        self._register = register
        self._taps = taps
        self._mine: Callable[..., None] | None = None
        register.follow("write", self, "write")

    def __setitem__(self, _name: str, write: Callable[[int, int], None]) -> None:
        register, taps = self._register, self._taps
        if not taps.on or write is self._mine:
            return
        read, modify = register.read, register.modify

        def read_seen() -> int:
            taps.seen(register, "read", -1)
            return read()

        def write_seen(word: int, lanes: int = ALL) -> None:
            taps.seen(register, "write", word)
            write(word, lanes)

        def modify_seen(keep: int, bits: int, lanes: int) -> None:
            taps.seen(register, "write", register.value & keep | bits)
            modify(keep, bits, lanes)

        self._mine = write_seen
        # The general way reads and writes through the register, where both are seen anyway.
        if modify != register._modify:
            register.modify = modify_seen
        register.intercept(read_seen if taps.reads else read, write_seen)


class Taps:
    """All registers of a bench.  `writers` is kept while `recording`; `step` is told every access while it is set."""

    def __init__(self, bench: Bench) -> None:
        self._cpu = bench.board.cpu
        self._clock = bench.clock
        self._findings = bench.findings
        self._registers = [register for block in bench.board.blocks.values() for register in block]
        self._sentries: list[_Sentry] = []
        #: As it is recorded: time, code, line, task, word.
        self.writers: dict[Cell, tuple[int, CodeType | None, int, str, int]] = {}
        self.recording = False
        self.step: Seen | None = None
        self.on = self.reads = False

    def set(self, *, recording: bool | None = None, step: Seen | None = None) -> None:
        """What is wanted from now on; `recording` None leaves it as it is."""
        if recording is not None:
            self.recording = recording
        self.step = step
        on, reads = self.recording or step is not None, step is not None
        if (on, reads) == (self.on, self.reads):
            return
        self.on, self.reads = on, reads
        if on and not self._sentries:
            self._sentries = [_Sentry(register, self) for register in self._registers]
        else:
            for register in self._registers:
                register.bind()

    def seen(self, register: Cell, access: str, word: int) -> None:
        """An access is about to happen."""
        if self.recording and access == "write" and (self._cpu.eallow or not register.eallow):
            # The write of a statement comes straight from its frame; others have board code between.
            frame: FrameType | None = sys._getframe(2)
            sources = self._findings.sources
            while frame is not None and frame.f_code.co_filename not in sources:
                frame = frame.f_back
            task = self._findings.context()
            if frame is None:
                self.writers[register] = (self._clock.now, None, 0, task, word)
            else:
                self.writers[register] = (self._clock.now, frame.f_code, frame.f_lineno, task, word)
        if self.step is not None:
            self.step(register, access, word)

    def writer(self, register: Cell) -> Writer | None:
        """Who wrote a register last."""
        known = self.writers.get(register)
        if known is None:
            return None
        cycles, code, line, task, word = known
        if code is None:
            return Writer(cycles, "", 0, "", task, word)
        return Writer(cycles, code.co_filename, line, code.co_name, task, word)
