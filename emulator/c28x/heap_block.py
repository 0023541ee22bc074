"""Blocks of a heap: objects without a declared type.

C gives such an object the type of what is stored in it (ISO C 6.5 p6): so does this, scalar by scalar.  What has not
been written has none, and is read as never written whatever it is read as; what is written over a part of a scalar
leaves the other words of it as they were.
"""

from __future__ import annotations

from typing import Any

from emulator.c28x.ctypes import UINT, ArrayType, CType
from emulator.c28x.memory import Memory, Object
from emulator.c28x.sites import Place
from emulator.c28x.tree import Declaration


class HeapBlock(Object):
    """A block that a program was given: `declaration` says by what call, and where; `freed` where it was given back."""

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
        """The scalar that starts at word `offset`, as (leaf, type); none of a block that was given back."""
        if self.ended or not 0 <= offset < self.words:
            return None
        ctype = self._types[offset]
        return None if ctype is None else (offset, ctype)

    def claim(self, offset: int, ctype: CType) -> tuple[int, CType] | None:
        """Make the words at `offset` a scalar of this type; None where none can lie: outside, or at an odd address."""
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
        """The block was given back: what it held stays where it lies, as words of nobody."""
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
        """Nothing: what it held lies where everybody finds it."""
        return None

    def _split(self, offset: int) -> None:
        """Take a scalar apart that reaches across the beginning of word `offset`: its words stay what they are."""
        if not 0 < offset < self.words or self._types[offset] is not None:
            return
        found = self.covering(offset)
        assert found is not None
        at, ctype, _ = found
        value, words = self.data[at], ctype.words
        self._types[at : at + words] = [UINT] * words
        self.data[at : at + words] = [None] * words if value is None else list(self._memory.words_of(value, ctype))
