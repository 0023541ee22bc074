"""The IQmath library by the C names of its functions (`_IQ24div`, `_atoIQN`), and the compiler's own IQ functions.

Modelled
    All functions of the library in the formats 1 to 30 (1 to 29 if the library has no more), exact to the last bit
    (`iq_arithmetic.py`); the compiler's `__IQmpy`, `__IQxmpy`, `__IQsat` and `__IQ`.  For functions that do not
    saturate (`_IQmpy`, `_IQrmpy`, `_IQmpyIQX`), a product that does not fit in 32 bits is reported (`overflow`).
    CHOICE: `__IQ(A, N)` takes a float, where the compiler takes a `long double`.
Not modelled
    IQmathCPP.h: there is no C++.
Time
    The cycles of the benchmark in the sources of the library, with call and return, and with the tables in a ROM of one
    wait state.  If there are several, by format or path, the least is used.  For `__IQmpy` and the other functions of
    the compiler, the cycles of their instructions (`passes/costs.py`).
Sources
    IQmath library of C2000Ware: its header, and the benchmarks in its sources; SPRU514, "Intrinsics": `__IQxmpy` as
    the header's `_IQmpyIQX` needs it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any, Final

from emulator.c28x import iq_arithmetic as iq
from emulator.c28x.arithmetic import bits_float, f32
from emulator.c28x.memory import Pointer
from emulator.c28x.passes.costs import CALL
from emulator.c28x.rts_printf import Printing

#: The formats of most functions, and of those whose results do not fit format 30.
ALL: Final = range(1, 31)
_NOT_30: Final = range(1, 30)
#: Function of the library -> its implementation, its cycles with call and return, its formats.  `_IQ24div` is "div".
_OF_FORMAT: Final[Mapping[str, tuple[Callable[..., int], int, range]]] = MappingProxyType({
    "rsmpy": (iq.saturated_product, 26, ALL), "mpyI32int": (iq.whole_part_of_product, 28, ALL),
    "mpyI32frac": (iq.fraction_of_product, 34, ALL), "int": (iq.whole_part, 15, ALL), "frac": (iq.fraction, 18, ALL),
    "div": (iq.divide, 70, ALL), "sqrt": (iq.square_root, 68, ALL), "isqrt": (iq.inverse_square_root, 73, ALL),
    "mag": (iq.magnitude, 93, ALL), "sin": (iq.sine, 47, ALL), "cos": (iq.cosine, 45, ALL),
    "sinPU": (iq.sine_of_turns, 41, ALL), "cosPU": (iq.cosine_of_turns, 39, ALL),
    "atan2": (iq.arc_tangent, 114, ALL), "atan2PU": (iq.arc_tangent_turns, 127, ALL),
    # CHOICE: their sources have no benchmark.  The cycles are those of a square root and five products; the arc cosine
    # calls the arc sine.
    "asin": (iq.arc_sine, 154, _NOT_30), "acos": (iq.arc_cosine, 170, _NOT_30),
    "exp": (iq.exponential, 168, ALL), "log": (iq.logarithm, 148, ALL),
})  # fmt: skip
_ROUNDED_PRODUCT: Final = 18
_TO_FLOAT: Final = 22
_TEXT: Final = 200
_CHARACTER: Final = 40
#: The name of a function of one format.
_NAME: Final = re.compile(r"_IQ([1-9]\d?)([a-zA-Z]\w*)", re.ASCII)
#: The other functions -> the methods that implement them.
_OTHERS: Final = MappingProxyType({
    "__IQmpy": "_product", "__IQxmpy": "_shifted_product", "__IQsat": "_between", "__IQ": "_of_float",
    "_atoIQN": "_from_text", "__IQNtoa": "_to_text",
})  # fmt: skip
#: Functions with two arguments; the others have one.
OF_TWO: Final = frozenset({"rmpy", "rsmpy", "mpyI32int", "mpyI32frac", "div", "mag", "atan2", "atan2PU"})


def formats() -> dict[str, range]:
    """Name without its format -> its formats, for all functions of the library that return a number."""
    return {"rmpy": ALL, **{name: range_ for name, (_, _, range_) in _OF_FORMAT.items()}}


class IQmath(Printing):
    """The library's functions of one image."""

    def named(self, name: str) -> Callable[..., Any] | None:
        """The function with the C name `name`; None if the library does not have it."""
        if name in _OTHERS:
            found: Callable[..., Any] = getattr(self, _OTHERS[name])
            return found
        parts = _NAME.fullmatch(name)
        q, kind = (int(parts[1]), parts[2]) if parts is not None else (0, "")
        if kind in _OF_FORMAT and q in _OF_FORMAT[kind][2]:
            compute, cycles, _ = _OF_FORMAT[kind]
            return partial(self._computed, compute, cycles, q)
        if kind in ("rmpy", "toF") and q in ALL:
            return partial(self._rounded_product if kind == "rmpy" else self._to_float, q)
        return None

    def _computed(self, compute: Callable[..., int], cycles: int, q: int, *numbers: int) -> int:
        self._charge(max(cycles - CALL, 0))
        return compute(*numbers, q)

    def _rounded_product(self, q: int, a: int, b: int) -> int:
        self._charge(_ROUNDED_PRODUCT - CALL)
        return self._low_word(f"_IQ{q}rmpy({a}, {b})", a * b + (1 << q - 1) >> q)

    def _to_float(self, q: int, a: int) -> float:
        self._charge(_TO_FLOAT - CALL)
        return bits_float(iq.to_float_bits(a, q))

    def _low_word(self, call: str, value: int) -> int:
        """The lower 32 bits of a product.  A product that does not fit is reported."""
        kept = iq.wrap32(value)
        if kept != value:
            message = f"{call} is {value}, which does not fit 32 bits: it becomes {kept}"
            self._runtime.findings.report("overflow", message, object=call.partition("(")[0], value=value)
        return kept

    # Functions of the compiler

    def _product(self, a: int, b: int, q: int) -> int:
        return self._low_word(f"__IQmpy({a}, {b}, {q})", a * b >> (q & 63))

    def _shifted_product(self, a: int, b: int, n: int) -> int:
        """The upper 32 bits of the product, after a shift left by `n` (right by -n)."""
        by = 32 - n
        return self._low_word(f"__IQxmpy({a}, {b}, {n})", a * b >> by if by >= 0 else a * b << -by)

    def _between(self, a: int, most: int, least: int) -> int:
        return max(min(a, most), least)

    def _of_float(self, value: float, q: int) -> int:
        return iq.saturate32(int(f32(value) * (1 << q)))

    # Text

    def _from_text(self, text: Pointer | None, q: int) -> int:
        characters = self._text(text, "_atoIQN")
        self._charge(min(_TEXT + _CHARACTER * len(characters), 800))
        return iq.from_text(characters, q)

    def _to_text(self, to: Pointer | None, form: Pointer | None, a: int, q: int) -> int:
        """Print a number with a format such as `%3.5f`: at most 3 characters before the point, and 5 from it on.

        Returns 0; 1 if the format is too narrow; 2 if it is not possible.
        """
        given = self._text(form, "__IQNtoa")
        error, text = iq.to_text(given, a, q)
        self._charge(min(_TEXT + _CHARACTER * len(text), 800))
        if error != 2:
            self._write("__IQNtoa", to, 0, text + "\0")
        return error
