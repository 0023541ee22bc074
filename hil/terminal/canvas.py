"""Dots in a character screen: braille (2 x 4 dots a character) or half blocks (1 x 2), each dot of one layer.

Pure: no terminal, no colour.  Nothing outside is drawn, and nothing is an error.

A character cell is taken as twice as high as it is wide, so a dot of either raster is a square.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from itertools import groupby
from typing import Final


class Layer(IntEnum):
    """The layer of a dot.  A character has one style: that of its highest layer."""

    NOTHING = 0
    CLOUD = 1
    PATH = 2
    ROBOT = 3
    TEXT = 4


@dataclass(frozen=True, slots=True)
class Raster:
    """How dots form characters."""

    name: str
    #: Dots of one character, across and down.
    across: int
    down: int
    #: Bit of each dot, row by row.
    bits: tuple[int, ...]
    #: Character of each sum of bits.
    characters: str


#: Unicode 10.0, block "Braille Patterns": dots 1 2 3 7 run down on the left, 4 5 6 8 on the right; bit n-1 is dot n.
BRAILLE: Final = Raster(
    "braille", 2, 4, (0x01, 0x08, 0x02, 0x10, 0x04, 0x20, 0x40, 0x80),
    " " + "".join(chr(0x2800 + bits) for bits in range(1, 256)),
)  # fmt: skip
#: For fonts without braille, such as that of Linux' own console.
HALF_BLOCKS: Final = Raster("half blocks", 1, 2, (1, 2), " ▀▄█")

Run = tuple[str, Layer]


class Canvas:
    """A picture of `columns` x `rows` characters; dot (0, 0) is the upper left one."""

    def __init__(self, columns: int, rows: int, raster: Raster = BRAILLE) -> None:
        self.columns = max(0, columns)
        self.rows = max(0, rows)
        self.raster = raster
        self.width = self.columns * raster.across
        self.height = self.rows * raster.down
        self._bits = [0] * (self.columns * self.rows)
        self._layers = [Layer.NOTHING] * (self.columns * self.rows)
        self._letters: dict[int, str] = {}

    def dot(self, x: int, y: int, layer: Layer) -> None:
        """Set a dot."""
        if not (0 <= x < self.width and 0 <= y < self.height):
            return
        raster = self.raster
        cell = y // raster.down * self.columns + x // raster.across
        self._bits[cell] |= raster.bits[y % raster.down * raster.across + x % raster.across]
        if layer > self._layers[cell]:
            self._layers[cell] = layer

    def write(self, column: int, row: int, text: str, layer: Layer = Layer.TEXT) -> None:
        """Put characters, one a cell, over the dots."""
        if not 0 <= row < self.rows:
            return
        for offset, letter in enumerate(text):
            if 0 <= column + offset < self.columns:
                cell = row * self.columns + column + offset
                self._letters[cell] = letter
                self._layers[cell] = layer

    def lines(self) -> list[list[Run]]:
        """The rows as runs of one layer; together as wide as the picture."""
        return [self._line(row) for row in range(self.rows)]

    def _line(self, row: int) -> list[Run]:
        cells = range(row * self.columns, (row + 1) * self.columns)
        return [
            ("".join(self._character(cell) for cell in run), layer)
            for layer, run in groupby(cells, self._layers.__getitem__)
        ]

    def _character(self, cell: int) -> str:
        return self._letters.get(cell) or self.raster.characters[self._bits[cell]]
