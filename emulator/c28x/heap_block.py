"""Blocks of a heap: objects without a declared type.

Such an object takes the type of what is stored in it (ISO C 6.5 p6); here, each scalar does.  Words that were never
written have no type: they read as never written, whatever the type of the read.  A write over a part of a scalar leaves
its other words unchanged.
"""

from __future__ import annotations

from typing import Any

from emulator.c28x.ctypes import UINT, ArrayType, CType
from emulator.c28x.memory import Memory, Object
from emulator.c28x.sites import Place
from emulator.c28x.tree import Declaration


class HeapBlock(Object):
    """An allocated block: `declaration` tells which call allocated it, and where; `freed`, where it was freed."""

    __slots__ = ("_memory", "_types", "freed")

    def __init__(self, memory: Memory, call: str, place: Place | None, base: int, words: int) -> None:
        ctype = ArrayType(f"unsigned int[{words}]", UINT, words)
        if place is None:
            declaration = Declaration(call, ctype, "", "", 0)
        else:
            declaration = Declaration(call, ctype, place.function, place.file, place.line, column=place.column)
        super().__init__(declaration, base)
        self.element = None
        self.freed = ""
        self._memory = memory
        #: The type of the scalar that begins at each word; None within one.
        self._types: list[CType | None] = [UINT] * words

    def leaf(self, offset: int) -> tuple[int, CType] | None:
        """The scalar that starts at word `offset`, as (leaf, type); a freed block has none."""
        if self.ended or not 0 <= offset < self.words:
            return None
        ctype = self._types[offset]
        return None if ctype is None else (offset, ctype)

    def claim(self, offset: int, ctype: CType) -> tuple[int, CType] | None:
        """Make the words at `offset` a scalar of this type; None if none fits there: outside, or at an odd address."""
        words = ctype.words
        if self.ended or not words or not 0 <= offset <= self.words - words or (words > 1 and self.base + offset & 1):
            return None
        types = self._types
        if types[offset] != ctype:
            self._split(offset)
            self._split(offset + words)
            types[offset : offset + words] = [ctype] + [None] * (words - 1)
            self.data[offset : offset + words] = [None] * words
        return offset, ctype

    def unwritten_as(self, offset: int, ctype: CType) -> tuple[int, CType] | None:
        """A scalar of this type at `offset` if none of its words was ever written."""
        end = offset + ctype.words
        if self.ended or not 0 <= offset <= end <= self.words:
            return None
        for word in range(offset, end):
            found = self.covering(word)
            if found is None or self.data[found[0]] is not None:
                return None
        return self.claim(offset, ctype)

    def end(self) -> None:
        """The block is freed: its contents stay in memory as plain words."""
        if self.ended:
            return
        held = [(at, t, self.data[at]) for at, t in enumerate(self._types) if t is not None]
        self.ended = True
        memory = self._memory
        memory.remove_block(self)
        for at, ctype, value in held:
            if value is not None:
                for i, word in enumerate(memory.words_of(value, ctype)):
                    memory.write_word(self.base + at + i, word)

    def last(self, offset: int, ctype: CType) -> Any:
        """None: the contents of a freed block are plain words in memory."""
        return None

    def _split(self, offset: int) -> None:
        """Split a scalar that extends across the start of word `offset` into words; their values stay."""
        if not 0 < offset < self.words or self._types[offset] is not None:
            return
        found = self.covering(offset)
        assert found is not None
        at, ctype, _ = found
        value, words = self.data[at], ctype.words
        self._types[at : at + words] = [UINT] * words
        self.data[at : at + words] = [None] * words if value is None else list(self._memory.words_of(value, ctype))
