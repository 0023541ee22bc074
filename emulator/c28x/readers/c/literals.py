"""Constants as C writes them: numbers, characters, strings."""

from __future__ import annotations

import re
from typing import Final

from emulator.c28x import build
from emulator.c28x.ctypes import FLOAT, LONG_DOUBLE, FloatType
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import Expr, Where

_SIMPLE: Final = {
    "n": 10, "t": 9, "r": 13, "0": 0, "a": 7, "b": 8, "f": 12, "v": 11, "\\": 92, "'": 39, '"': 34, "?": 63,
}  # fmt: skip
_CHARACTER: Final = re.compile(r"\\x([0-9a-fA-F]+)|\\([0-7]{1,3})|\\(.)|(.)", re.S)
#: The types of floating constants with a suffix.
_SUFFIXED: Final = {"f": FLOAT, "l": LONG_DOUBLE}
_STRINGS: Final = re.compile(r'"((?:[^"\\]|\\.)*)"', re.S)


def number(text: str, where: Where, double: FloatType) -> Expr:
    """An integer or floating constant; `double` is the type of one without a suffix.  Raises SourceError."""
    lower = text.lower()
    hexadecimal = lower.startswith("0x")
    if not hexadecimal and not lower.startswith("0b") and any(c in lower for c in ".e"):
        return build.floating(float(lower.rstrip("fl")), where, _SUFFIXED.get(lower[-1], double))
    if hexadecimal and "p" in lower:
        return build.floating(float.fromhex(lower.rstrip("fl")), where, _SUFFIXED.get(lower[-1], double))
    digits = lower.rstrip("ul")
    marks = lower[len(digits) :]
    suffix = ("u" if "u" in marks else "") + "l" * marks.count("l")
    decimal = not digits.startswith("0") or digits == "0"
    base = 16 if hexadecimal else 2 if digits.startswith("0b") else 10 if decimal else 8
    value = int(digits if base in (10, 8) else digits[2:], base)
    try:
        return build.integer(value, where, decimal=decimal, suffix=suffix)
    except SourceError:
        raise SourceError.at(where, f"{text} does not fit into 64 bits") from None


def character(text: str, where: Where) -> Expr:
    """A character constant: an int.  Raises SourceError unless it has exactly one character."""
    codes = characters(text.removeprefix("L")[1:-1], where)
    if not codes:
        raise SourceError.at(where, "an empty character constant")
    if len(codes) > 1:
        raise SourceError.at(where, f"{text} has {len(codes)} characters: write one, or a string")
    return build.character(codes[0], where)


def string(text: str, where: Where) -> Expr:
    """A string literal; adjacent literals are joined."""
    parts = [chr(code) for part in _STRINGS.findall(text) for code in characters(part, where)]
    return build.string("".join(parts), where)


def characters(text: str, where: Where) -> list[int]:
    """The codes of the characters between the quotes; escapes are replaced.  Raises SourceError."""
    codes: list[int] = []
    for found in _CHARACTER.finditer(text):
        hexadecimal, octal, escape, plain = found.groups()
        code = int(hexadecimal, 16) if hexadecimal else int(octal, 8) if octal else ord(plain) if plain else -1
        if code < 0:
            known = _SIMPLE.get(escape)
            if known is None:
                raise SourceError.at(where, f"\\{escape} is not an escape of C")
            code = known
        codes.append(code & 0xFFFF)
    return codes
