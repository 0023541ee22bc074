"""The run-time support library: what the functions of `string.h` and `stdlib.h` in `rts.py` do, and what they cost.

Costs are CHOICE, in the magnitude of the library.  `math.h` stands in `rts_math.py`.
"""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import Final

from emulator.c28x.arithmetic import TINY, bits_float, f32, float_bits
from emulator.c28x.ctypes import CHAR as _CHAR
from emulator.c28x.memory import Pointer
from emulator.c28x.rts_math import Mathematics

_NUMBER: Final = re.compile(r"[ \t\n\v\f\r]*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)", re.ASCII)
_SPECIAL: Final = re.compile(r"[ \t\n\v\f\r]*([+-]?)(nan|inf(?:inity)?)", re.IGNORECASE)
#: A run of characters longer than this ends the scan of a string (a real one runs on through memory).
_LONGEST: Final = 4096
#: A block longer than this ends here: it has gone through all of RAM (CHOICE).
_LARGEST: Final = 0x1C000


class Rts(Mathematics):
    """Library functions of one image."""

    def _text(self, p: Pointer | None, reader: str) -> str:
        """Characters up to NUL, as `reader` scans them."""
        if p is None:
            self._runtime.findings.report("null-dereference", f"{reader} was given NULL")
            return ""
        characters: list[str] = []
        for i in range(_LONGEST):
            value = self._runtime.read_through(p, i, p.target if p.target.words == 1 else _CHAR, reader)
            if value == 0:
                break
            characters.append(chr(value & 0xFFFF))
        self._runtime.touch_block(p, len(characters) + 1, False)
        return "".join(characters)

    def _number(self, text: str) -> float:
        found = _NUMBER.match(text)
        if found is None:
            special = _SPECIAL.match(text)
            if special is None:
                return 0.0
            value = math.nan if special.group(2).lower() == "nan" else math.inf
            return -value if special.group(1) == "-" else value
        return round_decimal(found.group(1))

    def memcpy(self, to: Pointer | None, source: Pointer | None, n: int) -> Pointer | None:
        """Copy `n` words."""
        if to is None or source is None:
            self._runtime.findings.report("null-dereference", "memcpy was given NULL")
            return to
        self._charge(10 + 2 * n)
        self._check_size("memcpy", "reads", source, n, to)
        self._check_size("memcpy", "writes", to, n, source)
        self._check_written(source, n)
        self._runtime.touch_block(source, n, False)
        self._runtime.touch_block(to, n, True)
        self._runtime.memory.copy(to, source, min(n, _LARGEST))
        return to

    def _check_size(self, function: str, verb: str, p: Pointer, n: int, other: Pointer | None) -> None:
        """Report a block that leaves its object, on either side."""
        obj = p.obj
        if obj is None or (p.offset >= 0 and p.offset + n <= obj.words):
            return
        path = obj.declaration.path
        outside = p.offset + n - obj.words if p.offset >= 0 else -p.offset
        octets = any(_counted_in_octets(side, n) for side in (p, other))
        rule = "memcpy-octets" if octets else "memcpy-outside"
        why = f"{n} counts octets; in 16-bit words it is {n // 2}" if octets else "sizes count 16-bit words here"
        hit = self._runtime.memory.neighbour(obj.base + (obj.words if p.offset >= 0 else p.offset))
        self._runtime.findings.report(
            rule, f"{function} of {n} words {verb} {outside} words outside {path} ({obj.words} words): {why}",
            object=path, declaration=str(obj.declaration), value=n, details=(f"what lies there: {hit}",),
        )  # fmt: skip

    def _check_written(self, source: Pointer, n: int) -> None:
        """Report a block of which nothing was ever written (what is partly written is copied as it is)."""
        obj = source.obj
        if obj is None or n == 0:
            return
        found = [obj.leaf(offset) for offset in range(max(source.offset, 0), min(source.offset + n, obj.words))]
        leaves = [leaf for leaf in found if leaf is not None]
        if leaves and all(obj.data[index] is None for index, _ in leaves):
            self._runtime.read_through(source, 0, leaves[0][1], "memcpy")

    def memset(self, to: Pointer | None, value: int, n: int) -> Pointer | None:
        """Set `n` words."""
        if to is None:
            self._runtime.findings.report("null-dereference", "memset was given NULL")
            return to
        self._charge(10 + 2 * n)
        self._check_size("memset", "writes", to, n, None)
        self._runtime.touch_block(to, n, True)
        for i in range(min(n, _LARGEST)):
            self._runtime.memory.store_through(to, i, _CHAR, value)
        return to

    def strlen(self, text: Pointer | None) -> int:
        """Characters before the NUL."""
        length = len(self._text(text, "strlen"))
        self._charge(8 + 4 * length)
        return length

    def atof(self, text: Pointer | None) -> float:
        """A decimal number as float32, correctly rounded; what is no number gives 0."""
        characters = self._text(text, "atof")
        self._charge(60 + 40 * min(len(characters), 16))
        return self._number(characters)

    def atoi(self, text: Pointer | None) -> int:
        """A decimal int; wraps at 16 bits."""
        value = self.atol(text) & 0xFFFF
        return value - 0x10000 if value > 0x7FFF else value

    def atol(self, text: Pointer | None) -> int:
        """A decimal long; wraps at 32 bits."""
        characters = self._text(text, "atol")
        self._charge(30 + 12 * min(len(characters), 12))
        found = re.match(r"\s*([+-]?\d+)", characters, re.ASCII)
        value = int(found.group(1)) & 0xFFFFFFFF if found else 0
        return value - (1 << 32) if value > 0x7FFFFFFF else value

    def abs(self, x: int) -> int:
        """Magnitude of an int; -32768 has none and stays."""
        return self._magnitude(x, 16, "abs")

    def labs(self, x: int) -> int:
        """Magnitude of a long; -2147483648 has none and stays."""
        return self._magnitude(x, 32, "labs")

    def _magnitude(self, x: int, bits: int, name: str) -> int:
        self._charge(4)
        if x == -(1 << bits - 1):
            message = f"{name}({x}) does not fit {bits} bits: it stays {x}"
            self._runtime.findings.report("overflow", message, object=name, value=x)
            return x
        return x if x >= 0 else -x

    def strcmp(self, a: Pointer | None, b: Pointer | None) -> int:
        """Less than, equal to, or greater than 0 as text a stands before, at or behind b."""
        first, second = self._text(a, "strcmp"), self._text(b, "strcmp")
        self._charge(8 + 6 * min(len(first), len(second)))
        return (first > second) - (first < second)

    def strcpy(self, to: Pointer | None, source: Pointer | None) -> Pointer | None:
        """Copy a text with its NUL."""
        return self._put_text("strcpy", to, 0, source)

    def strcat(self, to: Pointer | None, source: Pointer | None) -> Pointer | None:
        """Append a text with its NUL."""
        return self._put_text("strcat", to, len(self._text(to, "strcat")), source)

    def _put_text(self, name: str, to: Pointer | None, at: int, source: Pointer | None) -> Pointer | None:
        text = self._text(source, name)
        self._charge(10 + 4 * len(text))
        if to is None:
            self._runtime.findings.report("null-dereference", f"{name} was given NULL")
            return to
        self._check_size(name, "writes", to, at + len(text) + 1, None)
        self._runtime.touch_block(to, at + len(text) + 1, True)
        for i, character in enumerate([*text, "\0"], at):
            self._runtime.memory.store_through(to, i, _CHAR, ord(character))
        return to

    def memcmp(self, a: Pointer | None, b: Pointer | None, n: int) -> int:
        """Compare `n` words as unsigned numbers."""
        if a is None or b is None:
            self._runtime.findings.report("null-dereference", "memcmp was given NULL")
            return 0
        self._charge(10 + 4 * n)
        for p, other in ((a, b), (b, a)):
            self._check_size("memcmp", "reads", p, n, other)
            self._check_written(p, n)
            self._runtime.touch_block(p, n, False)
        memory = self._runtime.memory
        first = [memory.read_word(a.addr + i) for i in range(min(n, _LARGEST))]
        second = [memory.read_word(b.addr + i) for i in range(min(n, _LARGEST))]
        return (first > second) - (first < second)


def _counted_in_octets(p: Pointer | None, n: int) -> bool:
    """Whether `n` is twice the words from `p` to the end of its object, or twice those of whole 32-bit elements."""
    if p is None or p.obj is None or n % 2:
        return False
    left = p.obj.words - p.offset
    element = p.obj.element
    whole = element is not None and element.words == 2 and n % 4 == 0 and 0 < n // 2 <= left
    return n // 2 == left or whole


def round_decimal(text: str) -> float:
    """The float32 nearest to a decimal string (one rounding: a double in between would round twice).

    CHOICE: a denormal result is kept, as bits; the FPU flushes it when it is computed with.
    """
    value = float(text)
    if 0.0 < abs(value) < TINY:
        return math.copysign(round(abs(Fraction(text)) * (1 << 149)) * 2.0**-149, value)
    nearest = f32(value)
    if math.isinf(nearest) or nearest == 0.0:
        return nearest
    exact = Fraction(text)
    candidates = [nearest]
    bits = float_bits(abs(nearest))
    for neighbour in (bits - 1, bits + 1):
        candidates.append(math.copysign(bits_float(neighbour), nearest))
    finite = [c for c in candidates if math.isfinite(c)]
    return min(finite, key=lambda c: (abs(Fraction(c) - exact), float_bits(c) & 1))
