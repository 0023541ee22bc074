"""The sources of data outside of the program, and how often each one gives something new.

A source has given something new when its data arrived: when the program takes a received character or frame, at the end
of a conversion, at the edge that an eCAP or eQEP captured, at the edge that caused an interrupt, when a message of a
mailbox is taken.
"""

from __future__ import annotations

import re
from collections import deque
from typing import Any, Final

from emulator.clock import CYCLES_PER_MS
from emulator.registers.cell import Cell
from emulator.registers.pie_vectors import PieVectTable
from hil.board import Board

#: Registers, as `block.register`, that take in data from outside, which may fail to come.
INPUT: Final = re.compile(
    r"(Sci\w*\.SCIRXBUF|I2c\w*\.I2CDRR|Spi\w*\.SPIRXBUF|Adc\w*ResultRegs\.ADCRESULT\d+|ECap\w*\.CAP[1-4]|"
    r"Can\w*\.CAN_IF[123]DAT[AB]|EQep\w*\.QCPRD\w*)$"
)
#: Those of them, and the interrupts, that belong to a sensor and not to a partner who may have nothing to say.
SENSOR: Final = re.compile(r"I2c|Spi|Adc|ECap|EQep|XINT")
#: Those of a bus on which others send what they measure.
BUS: Final = re.compile(r"message object|Can")
#: Interrupts of pins: number of the vector -> name.
PIN_INTERRUPTS: Final = {
    vector.id: f"XINT{n}" for n in range(1, 6) if (vector := getattr(PieVectTable, f"XINT{n}_INT"))
}  # fmt: skip
#: What comes within this time counts as one: the characters of a message, the words of a burst.
TOGETHER: Final = 4 * CYCLES_PER_MS
#: A source is silent after this many times its longest recent interval.  A program that tolerates two or three lost
#: values waits for a shorter time.
PACES: Final = 10
#: Within this many intervals a source does not count as silent.
LOST: Final = 3
#: An interval is known after this many arrivals.
NEW: Final = 5
#: A source that nobody has cut off counts as regular after this many.
REGULAR: Final = 10
#: So many intervals are recent.
_RECENT: Final = 32


class InputSource:
    """The arrivals of one source, in cycles."""

    __slots__ = ("_counted", "_gaps", "count", "last", "name", "pace", "since")

    def __init__(self, name: str, now: int) -> None:
        self.name = name
        #: The last arrival; the first since the last silence; how many there were since, apart from each other.
        self.last = self.since = self._counted = now
        self.count = 1
        #: The longest recent interval between two.
        self.pace = TOGETHER
        self._gaps: deque[int] = deque(maxlen=_RECENT)

    def silent_for(self, now: int) -> int:
        """How long nothing has come, if it is silent; else 0.  It must have been there for some time before."""
        silence, was_there = now - self.last, self.last - self.since
        known = self.count >= NEW and was_there >= (NEW - 1) * self.pace
        return silence if known and silence >= PACES * self.pace else 0

    def was_there_longer(self, now: int) -> bool:
        """Whether it gave something before for as long as it has been silent now."""
        return now - self.last <= self.last - self.since

    def was_lost(self, now: int) -> bool:
        """Whether it is silent, was regular for at least as long, and so has most likely failed."""
        return self.count >= REGULAR and self.silent_for(now) > 0 and self.was_there_longer(now)

    def arrived(self, now: int) -> None:
        """Something new has come."""
        if self.silent_for(now):
            self.since, self._counted, self.count, self.pace = now, now, 1, TOGETHER
            self._gaps.clear()
        elif now - self._counted >= TOGETHER:
            self._gaps.append(max(now - self.last, TOGETHER))
            self.pace = max(self._gaps)
            self.count += 1
            self._counted = now
        self.last = now


def source_of(board: Board, cell: Cell) -> tuple[str, int] | None:
    """The source of what a register holds, and when it arrived; None: it takes in nothing."""
    path = cell.path
    if INPUT.match(path) is None:
        return None
    block, register = cell.block.name, cell.name
    now = board.clock.now
    if block.startswith("Adc"):
        return path, board.adc[block[3].upper()].converted_at(int(register[9:]))
    if block.startswith("ECap"):
        return path, board.ecap[int(block[4])].captured_at
    if block.startswith("EQep"):
        return path, board.eqep[int(block[4])].captured_at
    if block.startswith("Can"):
        command = cell.block.registers.get(f"{register[:7]}CMD")
        number = command.value & 0xFF if command is not None else 0
        return f"message object {number} of {block}" if number else path, now
    return path, now


def input_cells(board: Board) -> list[Cell]:
    """The registers that take in data from outside."""
    return [cell for block in board.blocks.values() for cell in block if INPUT.match(cell.path)]


class ArrivalWatch:
    """Watches the sources of one image for one that falls silent and comes back."""

    def __init__(self, board: Board) -> None:
        self._board = board
        self._sources: dict[str, InputSource] = {}
        #: Whether a source was lost for a while.
        self.lost = False
        for cell in input_cells(board):
            cell.tap(self._read, reads=True)
        board.kernel.mailboxes.taken.connect(lambda mailbox, message: self._arrived(*of_mailbox(mailbox, board)))
        board.vectors.began.connect(self._interrupted)

    def _read(self, cell: Cell, access: str, word: int, mask: int) -> None:
        found = source_of(self._board, cell) if access == "read" else None
        if found is not None:
            self._arrived(*found)

    def _interrupted(self, number: int, name: str) -> None:
        if number in PIN_INTERRUPTS:
            self._arrived(PIN_INTERRUPTS[number], self._board.clock.now)

    def _arrived(self, name: str, at: int) -> None:
        source = self._sources.get(name)
        if source is None:
            self._sources[name] = InputSource(name, at)
        elif at > source.last:
            self.lost = self.lost or source.was_lost(at)
            source.arrived(at)

    def is_lost(self) -> bool:
        """Whether a source was lost, or is at present."""
        now = self._board.clock.now
        return self.lost or any(source.was_lost(now) for source in self._sources.values())


def of_mailbox(mailbox: Any, board: Board) -> tuple[str, int]:
    """A mailbox as a source whose message is taken now."""
    return f"mailbox {mailbox.name}", board.clock.now


__all__ = ["ArrivalWatch", "InputSource", "input_cells", "of_mailbox", "source_of"]
