"""The run-time support library: the functions of `stdlib.h` that `rts.py` declares, and their cycles.

Cycles are CHOICE, in the order of magnitude of the library.  `math.h`, `string.h` and `stdio.h` are in `rts_math.py`,
`rts_strings.py` and `rts_printf.py`, the IQmath library in `rts_iqmath.py`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from fractions import Fraction
from typing import Any, Final

from emulator.c28x.arithmetic import TINY, bits_float, f32, float_bits
from emulator.c28x.memory import Pointer
from emulator.c28x.rts_math import Mathematics
from emulator.c28x.rts_printf import Printing
from emulator.c28x.runtime import Runtime

_NUMBER: Final = re.compile(r"[ \t\n\v\f\r]*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)", re.ASCII)
_SPECIAL: Final = re.compile(r"[ \t\n\v\f\r]*([+-]?)(nan|inf(?:inity)?)", re.IGNORECASE)


class Rts(Printing):
    """Library functions of one image."""

    def _number(self, text: str) -> float:
        found = _NUMBER.match(text)
        if found is None:
            special = _SPECIAL.match(text)
            if special is None:
                return 0.0
            value = math.nan if special.group(2).lower() == "nan" else math.inf
            return -value if special.group(1) == "-" else value
        return round_decimal(found.group(1))

    def atof(self, text: Pointer | None) -> float:
        """Convert a decimal number to float32, correctly rounded; 0 if the text is not a number."""
        characters = self._text(text, "atof")
        self._charge(60 + 40 * min(len(characters), 16))
        return self._number(characters)

    def strtold(self, text: Pointer | None, end: Pointer | None) -> float:
        """Convert a decimal number to a `long double`.  Where it ends goes to `end`, unless that is NULL.

        CHOICE: a number without an end in sight (a NaN, an infinity) is not read.
        """
        characters = self._text(text, "strtold")
        self._charge(60 + 80 * min(len(characters), 24))
        found = _NUMBER.match(characters)
        if end is not None and text is not None:
            end.write(text.at(0 if found is None else found.end()))
        return 0.0 if found is None else float(found.group(1))

    def atoi(self, text: Pointer | None) -> int:
        """Convert a decimal number to an int.  It wraps at 16 bits.  A check of a wider use gets the whole number."""
        whole = self._runtime.parsed_number = self.atol(text)
        value = whole & 0xFFFF
        return value - 0x10000 if value > 0x7FFF else value

    def atol(self, text: Pointer | None) -> int:
        """Convert a decimal number to a long.  It wraps at 32 bits."""
        characters = self._text(text, "atol")
        self._charge(30 + 12 * min(len(characters), 12))
        found = re.match(r"\s*([+-]?\d+)", characters, re.ASCII)
        value = int(found.group(1)) & 0xFFFFFFFF if found else 0
        return value - (1 << 32) if value > 0x7FFFFFFF else value

    def abs(self, x: int) -> int:
        """The absolute value of an int.  -32768 stays, because 32768 does not fit."""
        return self._magnitude(x, 16, "abs")

    def labs(self, x: int) -> int:
        """The absolute value of a long.  -2147483648 stays, because 2147483648 does not fit."""
        return self._magnitude(x, 32, "labs")

    def _magnitude(self, x: int, bits: int, name: str) -> int:
        self._charge(4)
        if x == -(1 << bits - 1):
            message = f"{name}({x}) does not fit {bits} bits: it stays {x}"
            self._runtime.findings.report("overflow", message, object=name, value=x)
            return x
        return x if x >= 0 else -x


def library(runtime: Runtime) -> dict[str, Callable[..., Any]]:
    """The functions of the library by name; those of `long double` in `math.h` have an `l` behind it."""
    wide = Mathematics(runtime, wide=True)
    return _named(Rts(runtime)) | {f"{name}l": function for name, function in _named(wide).items()}


def _named(functions: Mathematics) -> dict[str, Callable[..., Any]]:
    return {name: getattr(functions, name) for name in dir(functions) if not name.startswith("_")}


def round_decimal(text: str) -> float:
    """The float32 that is nearest to a decimal string.  It is rounded only once; through a double it would be twice.

    CHOICE: a denormal result is kept as bits; the FPU flushes it when the firmware computes with it.
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
