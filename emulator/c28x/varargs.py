"""The extra arguments of a variadic C function, as words on the stack.

Arguments are on the stack in 16-bit words, low word first; those of 32 and 64 bits begin on even words.  If a format
reads another width than was passed, all later arguments are shifted, as on the chip.  CHOICE: the first argument is on
an even word; words after the last argument read 0; a `long double` lies there itself, not by its address.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from emulator.c28x.arithmetic import bits_double, bits_float
from emulator.c28x.ctypes import CType, FloatType
from emulator.c28x.findings import Findings
from emulator.c28x.heap_block import HeapBlock
from emulator.c28x.memory import Memory, to_words


class Reporter(Protocol):
    """An owner of findings: the kernel's core, or a runtime."""

    double: FloatType

    @property
    def findings(self) -> Findings:
        """The findings of the board."""


class Varargs:
    """A `va_list` over `(ctype, value)` pairs, as the translator passes them."""

    __slots__ = ("_at", "_objects", "_reporter", "_words")

    def __init__(self, reporter: Reporter, arguments: tuple[tuple[Any, Any], ...]) -> None:
        self._reporter = reporter
        self._at = 0
        self._words: list[int] = []
        #: Word offset -> pointer that starts there, so that `%s` gets the object and not only its address.
        self._objects: dict[int, Any] = {}
        for ctype, value in arguments:
            self._push(ctype, value)

    def _push(self, ctype: CType, value: Any) -> None:
        if ctype.words > 1 and len(self._words) & 1:
            self._words.append(0)
        if isinstance(value, int | float):
            self._words += to_words(value, ctype)
            return
        self._objects[len(self._words)] = value
        self._words += to_words(getattr(value, "addr", 0) if value else 0, ctype)

    def _word(self) -> int:
        if self._at >= len(self._words):
            self._reporter.findings.report("varargs-missing", "the format reads more arguments than were passed")
            self._at += 1
            return 0
        self._at += 1
        return self._words[self._at - 1]

    def begin(self, words: int) -> None:
        """Continue at this word: `va_arg` has already read the words before it."""
        self._at = words

    def word(self) -> int:
        """`va_arg(va, int)`: the next word, unsigned."""
        return self._word()

    def long(self) -> int:
        """`va_arg(va, long)`: the next two words, from an even word on, unsigned."""
        self._at += self._at & 1
        low = self._word()
        return low | self._word() << 16

    def double(self) -> float:
        """`va_arg(va, double)`: two words under the COFF ABI, four under the EABI."""
        return self.long_double() if self._reporter.double.words > 2 else bits_float(self.long())

    def long_double(self) -> float:
        """`va_arg(va, long double)`: four words."""
        low = self.long()
        return bits_double(low | self.long() << 32)

    def pointer(self) -> tuple[Any, int]:
        """`va_arg(va, void *)`: the pointer passed there (None for NULL, or if it was no pointer), and its address."""
        self._at += self._at & 1
        value = self._objects.get(self._at)
        address = self.long()
        if value is None and address:
            self._reporter.findings.report(
                "varargs-type", f"the format reads a pointer where {address:#x} was passed", value=address
            )
        return (value or None), address


class ArgumentBlock(HeapBlock):
    """The same words as an object in memory: the `va_list` of a variadic function of the firmware points to it."""

    __slots__ = ("arguments",)

    def __init__(self, memory: Memory, base: int, arguments: Sequence[tuple[CType, Any]]) -> None:
        self.arguments = tuple(arguments)
        places, end = [], 0
        for ctype, value in self.arguments:
            end += end & 1 if ctype.words > 1 else 0
            places.append((end, ctype, value))
            end += ctype.words
        super().__init__(memory, "...", None, base, max(end, 1))
        for at, ctype, value in places:
            self.claim(at, ctype)
            self.data[at] = value


def signed16(word: int) -> int:
    """A word as a signed `int`."""
    return (word + 0x8000 & 0xFFFF) - 0x8000


def signed32(value: int) -> int:
    """Two words as a signed `long`."""
    return (value + 0x80000000 & 0xFFFFFFFF) - 0x80000000
