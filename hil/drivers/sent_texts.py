"""Looks at the characters that a program sends: a number with a sign behind its point is no number (`fraction-text`).

A program without `sprintf` makes its texts itself, character by character.  What it sends is text as well.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x.number_text import signed_fraction
from emulator.registers.cell import Cell
from hil.board import Board

_OF_NUMBERS: Final = frozenset("+-.0123456789")
#: A number has at most so many characters, with the one before it.
_KEPT: Final = 16


class SentTexts:
    """Listens to what the CPU gives the transmitters of the SCIs in a run."""

    def __init__(self, board: Board) -> None:
        self._findings = board.findings
        #: By register: what was sent last, from the character before a number on; the first number that is wrong.
        self._sent: dict[str, str] = {}
        self._first: dict[str, str] = {}
        for letter in board.sci:
            board.register(f"Sci{letter.lower()}Regs", "SCITXBUF").tap(self._written)

    def _written(self, cell: Cell, access: str, word: int, mask: int) -> None:
        if access != "write":
            return
        before = self._sent.get(cell.path, "")
        character = chr(word & 0xFF)
        if character in _OF_NUMBERS:
            self._sent[cell.path] = (before + character)[-_KEPT:]
            return
        self._sent[cell.path] = character
        number = signed_fraction(before)
        if not number:
            return
        # A fixed text says the same again and again ("0.-3").
        if self._first.setdefault(cell.path, number) != number and not self._findings.of("fraction-text"):
            message = f"a number is sent as {number}: a negative number has a negative rest, too"
            self._findings.report("fraction-text", message, object=cell.path, value=number)
