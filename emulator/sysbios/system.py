"""`xdc.runtime.System`: formatted output with its exact format grammar, and the end of the program.

Modelled
    A conversion is `% [-] [0] [width|*] [.prec|.*] [l|L] conv` in this order.  `conv` is one of d i u x o p c s, or
    `$S` or `$F`.  Anything else is printed unchanged and takes no argument.  `%f` takes its double.  It prints `f`, or
    four digits without rounding if `%f` is in `extended_formats`.  Arguments are read by words (varargs.py).  SysMin
    has a circular buffer, which becomes visible at a flush.
Not modelled
    `$L` (labels), `System_aprintf`, `System_atexit`.  The conversion buffer of 16 words on the stack: a zero padding
    above 16 writes beyond its end, which is reported (`printf-outbuf`).  CHOICE: the characters are printed as if
    there were room.
Time
    `print_call`, and the time of each character, conversion and digit when it is produced.  So a print can be
    pre-empted between two conversions.
Sources
    XDCtools 3.24 `xdc/runtime/System.c` (System_doPrint, System_formatNum), `System.xdt` (printfExtend), `Text.c`
    (putSite).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from emulator.c28x.arithmetic import f32
from emulator.c28x.number_text import report_signed_fraction
from emulator.c28x.varargs import Varargs, signed16, signed32
from emulator.sysbios.core import KernelCore, KernelError

DIGITS: Final = "0123456789abcdef"
OUTPUT_BUFFER: Final = 16
LONG_MAX: Final = 0x7FFFFFFF
SYSMIN_BUFFER: Final = 1024
Arguments = tuple[tuple[Any, Any], ...]


def text_of(pointer: Any) -> str:
    """A C string (or a Python one) as text: one character per word up to the NUL."""
    if isinstance(pointer, str):
        return pointer
    characters = []
    index = 0
    while (code := pointer.at(index).read()) != 0:
        characters.append(chr(code & 0xFFFF))
        index += 1
    return "".join(characters)


class _Printer:
    """Prints one format string (`System_doPrint`)."""

    __slots__ = ("_core", "_cost_character", "_cost_conversion", "_cost_digit", "_float", "_put", "_va", "count")

    def __init__(self, core: KernelCore, put: Callable[[str], None], va: Varargs, floats: bool) -> None:
        self._core = core
        self._put = put
        self._va = va
        self._float = floats
        self._cost_character = core.costs["print_character"]
        self._cost_conversion = core.costs["print_conversion"]
        self._cost_digit = core.costs["print_digit"]
        self.count = 0

    def _out(self, text: str) -> None:
        for character in text:
            self._put(character)
        self.count += len(text)
        self._core.clock.charge(self._cost_character * len(text))

    def number(self, value: int, padding: int, base: int, *, minus: bool = False) -> str:
        """`System_formatNum`: the sign, zeros up to `padding` characters in all (sign included), and the digits."""
        digits = ""
        while True:
            digits = DIGITS[value % base] + digits
            value //= base
            if not value:
                break
        self._core.clock.charge(self._cost_digit * len(digits))
        if minus:
            padding -= 1
        digits = digits.rjust(max(padding, 0), "0")
        text = f"-{digits}" if minus else digits
        if len(text) > OUTPUT_BUFFER:
            self._core.findings.report(
                "printf-outbuf", f"{len(text)} characters go into a conversion buffer of {OUTPUT_BUFFER}", value=text
            )
        return text

    def run(self, form: str) -> None:
        """Print `form`."""
        at, literal = 0, ""
        end = len(form)

        def char() -> str:
            nonlocal at
            at += 1
            return form[at - 1] if at <= end else "\0"

        while at < end:
            character = char()
            if character != "%":
                literal += character
                continue
            if literal:
                self._out(literal)
                literal = ""
            self._core.clock.charge(self._cost_conversion)
            character = char()
            left = character == "-"
            if left:
                character = char()
            zeros = character == "0"
            if zeros:
                character = char()
            width, precision = 0, -1
            if character == "*":
                width = signed16(self._va.word())
                character = char()
                if width < 0:
                    left, width = True, -width
            else:
                while character.isdigit() and character.isascii():
                    width = width * 10 + int(character)
                    character = char()
            if character == ".":
                precision = 0
                character = char()
                if character == "*":
                    precision = max(0, signed16(self._va.word()))
                    character = char()
                else:
                    while character.isdigit() and character.isascii():
                        precision = precision * 10 + int(character)
                        character = char()
            padding = max(width if zeros else 0, precision)
            long = character in "lL" and character != ""
            if long:
                character = char()
            at = self._convert(character, long, left, width, precision, padding, form, at)
        if literal:
            self._out(literal)

    def _convert(
        self, character: str, long: bool, left: bool, width: int, precision: int, padding: int, form: str, at: int
    ) -> int:
        """Print one conversion; returns the index where the format goes on."""
        va = self._va
        if character in ("d", "i"):
            value = signed32(va.long()) if long else signed16(va.word())
            text = self.number(abs(value), padding, 10, minus=value < 0)
        elif character in ("u", "x", "o"):
            value = va.long() if long else va.word()
            text = self.number(value, padding, {"u": 10, "x": 16, "o": 8}[character])
        elif character == "p":
            text = "@" + self.number(va.pointer()[1], 8, 16)
        elif character == "c":
            text = chr(va.word())
        elif character == "s":
            pointer, address = va.pointer()
            text = text_of(pointer) if pointer is not None else "" if address else "(null)"
            if precision != -1:
                text = text[:precision]
        elif character == "$":
            return self._extended(form, at, precision, left, width)
        elif character == "f" and self._float:
            text = self._fixed(va.double(), padding)
        else:
            if character == "f":
                va.double()
            if character not in ("%", "\0"):
                taken = "takes the double" if character == "f" else "takes no argument"
                unknown = f"%{'l' if long else ''}{character}"
                message = f"System_printf does not know {unknown}: it prints {character!r} and {taken}"
                self._core.findings.report("printf-format", message, object=form)
            text = character if character != "\0" else ""
        self._out(text.ljust(width) if left else text.rjust(width))
        return at

    def _extended(self, form: str, at: int, precision: int, left: bool, width: int) -> int:
        """`%$S` prints a format with the following arguments, `%$F` file and line.  The width pads at the end."""
        kind = form[at] if at < len(form) else ""
        before = self.count
        if kind == "S":
            pointer, _ = self._va.pointer()
            if pointer is not None:
                self.run(text_of(pointer))
        elif kind == "F":
            pointer, _ = self._va.pointer()
            self._site(text_of(pointer) if pointer is not None else "", signed16(self._va.word()), precision)
        elif kind == "L":
            self._va.pointer()
            self._core.findings.report("unmodelled", "System_printf %$L (labels) prints nothing here", object=form)
        else:
            self._out(kind.ljust(width) if left else kind.rjust(width))
            return at + 1
        self._out(" " * max(0, width - (self.count - before)))
        return at + 1

    def _site(self, file: str, line: int, precision: int) -> None:
        """`Text_putSite`: print file and line, each only if a given precision leaves room for it."""
        room = precision if precision >= 0 else 0x7FFF
        if room <= 0 or line == 0:
            return
        if file and room >= len(file) + 4:
            self._out(f'"{file}", ')
            room -= len(file) + 4
        if room >= 17:
            self._out(f"line {line}: ")

    def _fixed(self, value: float, padding: int) -> str:
        """`%f` as the optional code prints it: computed in float32, four digits without rounding.

        The precision is ignored.
        """
        minus = value < 0.0
        if minus:
            value = -value
            padding -= 1
        if not value <= f32(float(LONG_MAX)):
            return "(error)"
        whole = min(int(value), LONG_MAX)
        fraction = int(f32(f32(value - f32(float(whole))) * f32(1e4)))
        digits = self.number(whole, padding, 10)
        return ("-" if minus else "") + digits + "." + self.number(fraction, 4, 10)


class SystemModule:
    """`System_*`.  `flushed` is the text that a debugger's console would show."""

    def __init__(self, core: KernelCore, *, extended_formats: str, exit_program: Callable[[int], None]) -> None:
        self.core = core
        self.flushed = ""
        self._buffer = ""
        self._floats = "%f" in extended_formats
        self._exit_program = exit_program

    def _print(self, put: Callable[[str], None], form: Any, arguments: Arguments) -> int:
        self.core.clock.charge(self.core.costs["print_call"])
        if form is None:
            return 0
        shown: list[str] = []

        def show(character: str) -> None:
            shown.append(character)
            put(character)

        printer = _Printer(self.core, show, Varargs(self.core, arguments), self._floats)
        text = text_of(form)
        printer.run(text)
        report_signed_fraction(self.core.findings, text, "".join(shown))
        return printer.count

    def _into(self, buf: Any, room: int | None, form: Any, arguments: Arguments) -> int:
        """Print into a C buffer, at most `room` words with the NUL."""
        index = 0

        def put(character: str) -> None:
            nonlocal index
            if room is None or index < room - 1:
                buf.at(index).write(signed16(ord(character)))
                index += 1

        count = self._print(put, form, arguments)
        if form is not None and (room is None or room > 0):
            buf.at(index).write(0)
        return count

    def _keep(self, character: str) -> None:
        self._buffer = (self._buffer + character)[-SYSMIN_BUFFER:]

    # C functions

    def System_sprintf(self, buf: Any, form: Any, *arguments: tuple[Any, Any]) -> int:
        """Print into `buf` without a limit.  Returns the number of characters before the NUL.

        If `buf` is NULL, it prints to the output.
        """
        return self.System_printf(form, *arguments) if buf is None else self._into(buf, None, form, arguments)

    def System_snprintf(self, buf: Any, n: int, form: Any, *arguments: tuple[Any, Any]) -> int:
        """Print at most `n` words, NUL included.  Returns the length without that limit (newer XDCtools only)."""
        return self._into(buf, n, form, arguments)

    def System_printf(self, form: Any, *arguments: tuple[Any, Any]) -> int:
        """Print into SysMin's buffer of 1024 characters.  The oldest are lost, and nothing is shown before a flush."""
        return self._print(self._keep, form, arguments)

    def System_flush(self) -> None:
        """Show the content of SysMin's buffer."""
        self.core.clock.charge(self.core.costs["system_service"])
        self.flushed += self._buffer
        self._buffer = ""

    def System_abort(self, text: Any) -> None:
        """End the program with a message."""
        raise KernelError("System_abort", text_of(text) if text is not None else "")

    def System_exit(self, status: int) -> None:
        """End the program: output is flushed, then the CPU spins."""
        self.System_flush()
        self._exit_program(status)
