"""Accesses to registers, for "last writer" and "step to the next register access" (`emulator.registers.taps`).

The taps cost nothing while they are off.  They do not see what a peripheral itself changes in its registers (flags,
counters, results), because that is no write of the CPU.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from emulator.c28x.sites import Place
from emulator.registers.cell import Cell
from hil.running import RunningBoard

#: `step(register, "read" or "write", word)` is called before the access.  For a read, the word is 0.
Accessed = Callable[[Cell, str, int], None]


@dataclass(frozen=True, slots=True)
class LastWriter:
    """The last writer of a register."""

    cycles: int
    #: The statement of the firmware.  None: the kernel or the start-up code wrote the register.
    place: Place | None
    task: str
    word: int


class RegisterTaps:
    """The taps on all registers of a chip.  `writers` is updated while `recording`; `step` gets each access if set."""

    def __init__(self, bench: RunningBoard) -> None:
        self._cpu = bench.board.cpu
        self._clock = bench.clock
        self._findings = bench.findings
        self._registers = [register for block in bench.board.blocks.values() for register in block]
        #: The last write of each register: time, number of the statement, task, word.
        self.writers: dict[Cell, tuple[int, int, str, int]] = {}
        self.recording = False
        self.step: Accessed | None = None
        self._on = self._reads = False

    def set(self, *, recording: bool | None = None, step: Accessed | None = None) -> None:
        """Set what is recorded from now on.  With `recording` None, that setting stays."""
        if recording is not None:
            self.recording = recording
        self.step = step
        on, reads = self.recording or step is not None, step is not None
        if (on, reads) == (self._on, self._reads):
            return
        self._on, self._reads = on, reads
        for register in self._registers:
            if on:
                register.tap(self._seen, reads=reads)
            else:
                register.untap(self._seen)

    def _seen(self, register: Cell, access: str, word: int, _mask: int) -> None:
        if self.recording and access == "write" and (self._cpu.eallow or not register.eallow):
            findings = self._findings
            self.writers[register] = (self._clock.now, findings.position.innermost(), findings.context(), word)
        if self.step is not None:
            self.step(register, access, word)

    def writer(self, register: Cell) -> LastWriter | None:
        """The last writer of a register."""
        known = self.writers.get(register)
        if known is None:
            return None
        cycles, at, task, word = known
        return LastWriter(cycles, self._findings.places[at] if at else None, task, word)
