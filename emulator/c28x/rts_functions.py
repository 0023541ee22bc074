"""The run-time support library: what the functions declared in `rts.py` do, and what they cost.

Transcendental functions are correctly rounded float32 (CHOICE: the library's own last bit is not published; the vectors
that compare with other libraries allow for it).  Costs are CHOICE, in the magnitude of the FPU library.
"""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import Final

from emulator.c28x.arithmetic import TINY, bits_float, f32, float_bits
from emulator.c28x.ctypes import CHAR as _CHAR
from emulator.c28x.memory import Pointer
from emulator.c28x.runtime import Runtime

_NUMBER: Final = re.compile(r"[ \t\n\v\f\r]*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)", re.ASCII)
_SPECIAL: Final = re.compile(r"[ \t\n\v\f\r]*([+-]?)(nan|inf(?:inity)?)", re.IGNORECASE)
#: A run of characters longer than this ends the scan of a string (a real one runs on through memory).
_LONGEST: Final = 4096


class Rts:
    """Library functions of one image."""

    def __init__(self, runtime: Runtime) -> None:
        self._runtime = runtime

    def _charge(self, cycles: int) -> None:
        self._runtime.clock.charge(cycles)

    def _text(self, p: Pointer | None) -> str:
        """Characters up to NUL, as a scan would read them."""
        if p is None:
            self._runtime.findings.report("null-dereference", "a string function was given NULL")
            return ""
        characters: list[str] = []
        for i in range(_LONGEST):
            value = self._runtime.memory.load_through(p, i, p.target if p.target.words == 1 else _CHAR)
            if value == 0:
                break
            characters.append(chr(value & 0xFFFF))
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
        self._check_size("memcpy", "reads", source, n)
        self._check_size("memcpy", "writes", to, n)
        self._runtime.memory.copy(to, source, n)
        return to

    def _check_size(self, function: str, verb: str, p: Pointer, n: int) -> None:
        """Report a block that leaves its object, on either side."""
        obj = p.obj
        if obj is None or (p.offset >= 0 and p.offset + n <= obj.words):
            return
        outside = p.offset + n - obj.words if p.offset >= 0 else -p.offset
        self._runtime.findings.report(
            "memcpy-outside",
            f"{function} of {n} words {verb} {outside} words outside {obj.declaration.path} ({obj.words} words): "
            "sizes count 16-bit words here, not octets",
            object=obj.declaration.path, declaration=str(obj.declaration), value=n,
        )  # fmt: skip

    def memset(self, to: Pointer | None, value: int, n: int) -> Pointer | None:
        """Set `n` words."""
        if to is None:
            self._runtime.findings.report("null-dereference", "memset was given NULL")
            return to
        self._charge(10 + 2 * n)
        self._check_size("memset", "writes", to, n)
        for i in range(n):
            self._runtime.memory.store_through(to, i, _CHAR, value)
        return to

    def strlen(self, text: Pointer | None) -> int:
        """Characters before the NUL."""
        length = len(self._text(text))
        self._charge(8 + 4 * length)
        return length

    def atof(self, text: Pointer | None) -> float:
        """A decimal number as float32, correctly rounded; what is no number gives 0."""
        characters = self._text(text)
        self._charge(60 + 40 * min(len(characters), 16))
        return self._number(characters)

    def atoi(self, text: Pointer | None) -> int:
        """A decimal int; wraps at 16 bits."""
        value = self.atol(text) & 0xFFFF
        return value - 0x10000 if value > 0x7FFF else value

    def atol(self, text: Pointer | None) -> int:
        """A decimal long; wraps at 32 bits."""
        characters = self._text(text)
        self._charge(30 + 12 * min(len(characters), 12))
        found = re.match(r"\s*([+-]?\d+)", characters, re.ASCII)
        value = int(found.group(1)) & 0xFFFFFFFF if found else 0
        return value - (1 << 32) if value > 0x7FFFFFFF else value

    def sin(self, x: float) -> float:
        """Sine, radians."""
        self._charge(80)
        return f32(math.sin(x)) if math.isfinite(x) else math.nan

    def cos(self, x: float) -> float:
        """Cosine, radians."""
        self._charge(80)
        return f32(math.cos(x)) if math.isfinite(x) else math.nan

    def sqrt(self, x: float) -> float:
        """Square root; negative gives NaN."""
        self._charge(40)
        return f32(math.sqrt(x)) if x >= 0 else math.nan

    def atan2(self, y: float, x: float) -> float:
        """Angle of (x, y), radians."""
        self._charge(120)
        return f32(math.atan2(y, x))

    def fabs(self, x: float) -> float:
        """Magnitude."""
        self._charge(4)
        return abs(x)


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
