"""`sprintf`, `snprintf` and `printf` of `stdio.h`, and `puts` and `putchar`.

Modelled
    A conversion is `% [-+ #0] [width|*] [.prec|.*] [h|l|L] conv`, where `conv` is one of d i u x X o c s p f F e E g G
    %.  Arguments are read by words, so a wrong width shifts the arguments after it (`varargs.py`).  A text that is
    longer than its buffer is reported and written.
Not modelled
    `printf`, `puts` and `putchar` print to the console of a debugger, which does not exist here (`unmodelled`).  `%n`,
    `%a`, `ll` and wide characters are reported (`printf-format`) and printed unchanged.
Time
    CHOICE, in the order of magnitude of the library: cycles for a call, a character and a conversion, and ten times as
    many for a float.
Sources
    ISO C, fprintf; CC 6: widths.  CHOICE: a float prints the digits of its value, correctly rounded.
"""

from __future__ import annotations

import math
import re
from typing import Any, Final

from emulator.c28x.memory import Pointer
from emulator.c28x.number_text import report_signed_fraction
from emulator.c28x.rts_strings import Strings
from emulator.c28x.varargs import ArgumentBlock, Varargs, signed16, signed32

_SPECIFICATION: Final = re.compile(
    r"%(?P<flags>[-+ #0]*)(?P<width>\*|\d*)(?:\.(?P<precision>\*|\d*))?(?P<length>[hlL]?)(?P<kind>.)",
    re.DOTALL | re.ASCII,
)
_CALL: Final = 200
_CHARACTER: Final = 12
_CONVERSION: Final = 120
_FLOAT: Final = 1200


class Printing(Strings):
    """Formatted output into a buffer."""

    def sprintf(self, buf: Pointer | None, form: Pointer | None, *arguments: tuple[Any, Any]) -> int:
        """Print into `buf`, without a limit.  Returns the number of characters before the NUL."""
        return self._into("sprintf", buf, None, form, Varargs(self._runtime, arguments))

    def snprintf(self, buf: Pointer | None, n: int, form: Pointer | None, *arguments: tuple[Any, Any]) -> int:
        """Print at most `n` words including the NUL.  Returns the length of the complete text."""
        return self._into("snprintf", buf, n, form, Varargs(self._runtime, arguments))

    def printf(self, form: Pointer | None, *arguments: tuple[Any, Any]) -> int:
        """Print to the debugger's console; returns the number of characters."""
        self._charge(_CALL)
        text = self._formatted("printf", self._text(form, "printf"), Varargs(self._runtime, arguments))
        return self._shown("printf", text)

    def vprintf(self, form: Pointer | None, given: Pointer | None) -> int:
        """`printf` with a `va_list`."""
        self._charge(_CALL)
        return self._shown("vprintf", self._formatted("vprintf", self._text(form, "vprintf"), self._list(given)))

    def vsprintf(self, buf: Pointer | None, form: Pointer | None, given: Pointer | None) -> int:
        """`sprintf` with a `va_list`."""
        return self._into("vsprintf", buf, None, form, self._list(given))

    def vsnprintf(self, buf: Pointer | None, n: int, form: Pointer | None, given: Pointer | None) -> int:
        """`snprintf` with a `va_list`."""
        return self._into("vsnprintf", buf, n, form, self._list(given))

    def va_arg_at(self, given: Pointer | None, words: int) -> Pointer | None:
        """A pointer to the next argument of the list at `given`; moves the list past it (the macro `va_arg`)."""
        at: Pointer | None = given.read() if given is not None else None
        if at is None or given is None:
            return None
        at = at.at(at.addr & 1 if words > 1 else 0)
        if isinstance(at.obj, ArgumentBlock) and at.offset + words > at.obj.words:
            self._runtime.findings.report("varargs-missing", "va_arg reads more arguments than were passed")
        given.store(at.at(words))
        return at

    def _list(self, given: Pointer | None) -> Varargs:
        """The remaining arguments of a `va_list`."""
        block = given.obj if given is not None else None
        if given is None or not isinstance(block, ArgumentBlock):
            message = "the list was not begun by va_start, or its function has returned"
            self._runtime.findings.report("varargs-missing", message)
            return Varargs(self._runtime, ())
        found = Varargs(self._runtime, block.arguments)
        found.begin(given.offset)
        return found

    def puts(self, text: Pointer | None) -> int:
        """Print a line to the debugger's console; returns 0."""
        self._shown("puts", self._text(text, "puts") + "\n")
        return 0

    def putchar(self, character: int) -> int:
        """Print a character to the debugger's console; returns it."""
        self._shown("putchar", chr(character & 0xFFFF))
        return character

    def _shown(self, name: str, text: str) -> int:
        self._charge(_CHARACTER * len(text))
        message = f"{name} prints to the console of a debugger, which is not modelled"
        self._runtime.findings.report("unmodelled", message, object=name)
        return len(text)

    def _into(self, name: str, buf: Pointer | None, room: int | None, form: Pointer | None, va: Varargs) -> int:
        self._charge(_CALL)
        text = self._formatted(name, self._text(form, name), va)
        self._charge(_CHARACTER * len(text))
        kept = text if room is None else text[: max(room - 1, 0)]
        if room != 0:
            self._write(name, buf, 0, kept + "\0")
        return len(text)

    def _formatted(self, name: str, form: str, va: Varargs) -> str:
        def converted(found: re.Match[str]) -> str:
            return self._conversion(name, form, found, va)

        text = _SPECIFICATION.sub(converted, form)
        report_signed_fraction(self._runtime.findings, form, text)
        return text

    def _conversion(self, name: str, form: str, found: re.Match[str], va: Varargs) -> str:
        """The text of one conversion specification."""
        kind, flags = found["kind"], set(found["flags"])
        if kind == "%":
            return "%"
        self._charge(_FLOAT if kind in "fFeEgG" else _CONVERSION)
        width = signed16(va.word()) if found["width"] == "*" else int(found["width"] or 0)
        given = found["precision"]
        precision = None if given is None else signed16(va.word()) if given == "*" else int(given or 0)
        if precision is not None and precision < 0:
            precision = None
        if width < 0:
            flags, width = flags | {"-"}, -width
        if kind in "diuxXo":
            sign, text = self._integer(kind, flags, precision, va, long=found["length"] in ("l", "L"))
            zeros = precision is None
        elif kind in "fFeEgG":
            value = va.long_double() if found["length"] == "L" else va.double()
            text = f"%{'#' if '#' in flags else ''}.{6 if precision is None else precision}{kind}" % abs(value)
            sign, zeros = _sign(math.copysign(1.0, value) < 0.0, flags), math.isfinite(value)
        elif kind == "c":
            sign, text, zeros = "", chr(va.word()), False
        elif kind == "s":
            pointer, _ = va.pointer()
            most = {} if precision is None else {"most": precision}
            sign, text, zeros = "", self._text(pointer, name, **most), False
        elif kind == "p":
            sign, text, zeros = "", f"{va.pointer()[1]:x}", False
        else:
            message = f"{name} does not know {found[0]}: it prints the letters and takes no argument"
            self._runtime.findings.report("printf-format", message, object=form)
            return found[0]
        if "-" in flags:
            return (sign + text).ljust(width)
        if "0" in flags and zeros:
            return sign + text.rjust(width - len(sign), "0")
        return (sign + text).rjust(width)

    @staticmethod
    def _integer(kind: str, flags: set[str], precision: int | None, va: Varargs, *, long: bool) -> tuple[str, str]:
        """The sign or prefix of an integer, and its digits."""
        word = va.long() if long else va.word()
        signed = kind in "di"
        value = (signed32(word) if long else signed16(word)) if signed else word
        digits = "" if precision == 0 and value == 0 else format(abs(value), kind if kind in "xXo" else "d")
        digits = digits.rjust(precision or 0, "0")
        if "#" in flags and kind == "o" and not digits.startswith("0"):
            digits = "0" + digits
        if "#" in flags and kind in "xX" and value:
            return "0" + kind, digits
        return _sign(value < 0, flags) if signed else "", digits


def _sign(negative: bool, flags: set[str]) -> str:
    return "-" if negative else "+" if "+" in flags else " " if " " in flags else ""
