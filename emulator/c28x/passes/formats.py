"""Static check of formats: the arguments that the format of a `sprintf` call reads, compared with those it gets.

It checks only a format that is a literal in the call.  A wrong width or sign gets no message from the compiler.  A
surplus argument is valid C, but useless.  A conversion that C does not have (`100 %\r`) is a percent sign that is not
written twice.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Final

from emulator.c28x.ctypes import ArrayType, CType, Double64, FloatType, FunctionType, HandleType, IntType, PointerType
from emulator.c28x.tree import Call, Conditional, Expr, Load, LValue, String, Variable
from emulator.c28x.tree_queries import bare, source_text

#: Function -> the index of the format among its parameters.
_FORMATS: Final = {
    "printf": 0, "sprintf": 1, "snprintf": 2, "System_printf": 0, "System_sprintf": 1, "System_snprintf": 2,
}  # fmt: skip
#: A conversion of a format.
SPECIFICATION: Final = re.compile(
    r"%[-+ #0]*(?P<width>\*|\d*)(?:\.(?P<precision>\*|\d*))?(?P<length>hh?|ll?|L|)(?P<kind>.)", re.DOTALL | re.ASCII
)


def check_format(e: Call, double: FloatType, report: Callable[[str, str, str], None]) -> None:
    """Report arguments of a call that do not fit its format: `report(rule, message, object)`.

    `double` is the type of that name.
    """
    form = format_of(e)
    if form is None:
        return
    unknown = _unknown(form)
    if unknown is not None:
        shown = repr(unknown)[1:-1]
        report("printf-format", f"{e.function.name} does not know {shown}: %% prints a percent sign", form)
        return
    wanted = _conversions(form, double)
    if wanted is None:
        return
    for (conversion, what, fits), given in zip(wanted, e.extra, strict=False):
        if not fits(given.ctype):
            text = source_text(given)
            report("varargs-type", f"{conversion} reads {what}, and {text} is of type {given.ctype}", text)
            return  # the later arguments are shifted
    if len(wanted) > len(e.extra):
        conversion = wanted[len(e.extra)][0]
        report("varargs-missing", f"nothing is passed for {conversion} of {form!r}", form)
    elif len(wanted) < len(e.extra):
        text = source_text(e.extra[len(wanted)])
        report("varargs-surplus", f"{text} is passed, and {form!r} does not print it", text)


def format_of(e: Call) -> str | None:
    """The format of a call, if it is a literal; None for any other call."""
    place = _FORMATS.get(e.function.name)
    if place is None or not e.function.ctype.variadic or place >= len(e.arguments):
        return None
    form = bare(e.arguments[place])
    return form.text if isinstance(form, String) else None


def printed(e: Call) -> Iterator[tuple[Expr, str, str]]:
    """The arguments that the format of a call prints, each with the texts before and behind its conversion."""
    text = format_of(e) or ""
    given = iter(e.extra)
    for one in SPECIFICATION.finditer(text):
        if one["kind"] == "%":
            continue
        taken = [next(given, None) for _ in range(1 + [one["width"], one["precision"]].count("*"))]
        if taken[-1] is not None:
            yield taken[-1], text[: one.start()], text[one.end() :]


def shortest(text: str) -> int:
    """The characters that a format prints at least, without the NUL."""
    return len(SPECIFICATION.sub("", text)) + sum(_least(one) for one in SPECIFICATION.finditer(text))


def longest(e: Call, most: Callable[[Expr], int]) -> int:
    """The characters that a call can print, without the NUL, if its numbers reach `most`; other things are shortest."""
    found = shortest(format_of(e) or "")
    for value, before, after in printed(e):
        text = format_of(e) or ""
        one = SPECIFICATION.fullmatch(text[len(before) : len(text) - len(after)])
        if one is None or "*" in (one["width"], one["precision"]):
            continue
        length = 0
        if one["kind"] in "diu":
            length = len(str(most(value)))
        elif one["kind"] == "s" and one["precision"] is None:
            length = max(map(len, _texts(value)), default=0)
        found += max(0, length - _least(one))
    return found


def _texts(e: Expr) -> list[str]:
    """The literals that a value may be, as far as they are known."""
    match bare(e):
        case String(text=text):
            return [text]
        case Conditional(then=then, otherwise=otherwise):
            return _texts(then) + _texts(otherwise)
        case Load(lvalue=LValue(root=Variable(initial=list() as initial, ctype=ArrayType()), indices=[_])):
            return [text for value in initial for text in _texts(value)]
    return []


def _least(one: re.Match[str]) -> int:
    """The characters that a conversion prints at least."""
    kind, width, precision = one["kind"], one["width"], one["precision"]
    least = int(width) if width and width != "*" else 0
    if kind in "diuxXo" and precision and precision != "*":
        return max(least, int(precision))
    return max(least, 0 if kind == "s" or (kind in "diuxXo" and precision is not None) else 1)


def _unknown(text: str) -> str | None:
    """A conversion of a format that no C has: its kind is not a letter; None: there is none."""
    for one in SPECIFICATION.finditer(text):
        if one["kind"] != "%" and not one["kind"].isalpha():
            return one[0]
    return "%" if SPECIFICATION.sub("", text).endswith("%") else None


def _int(ctype: CType) -> bool:
    return isinstance(ctype, IntType) and ctype.words == 1


def _long(ctype: CType) -> bool:
    return ctype.words == 2 and not isinstance(ctype, FloatType)


def _float(ctype: CType) -> bool:
    return isinstance(ctype, FloatType) and not isinstance(ctype, Double64)


def _double(ctype: CType) -> bool:
    return isinstance(ctype, Double64)


def _address(ctype: CType) -> bool:
    return isinstance(ctype, PointerType | HandleType | FunctionType)


def _pointer(ctype: CType) -> bool:
    return _address(ctype) or _long(ctype)


def _conversions(text: str, double: FloatType) -> list[tuple[str, str, Callable[[CType], bool]]] | None:
    """(text, what it reads, test of a type) of each conversion; None if one is not known."""
    found: list[tuple[str, str, Callable[[CType], bool]]] = []
    for one in SPECIFICATION.finditer(text):
        written, kind, length = one[0], one["kind"], one["length"]
        if kind == "%":
            continue
        found += [(f"* of {written}", "an int", _int) for part in ("width", "precision") if one[part] == "*"]
        if kind in "diuxXoc" and length in ("", "h", "hh"):
            found.append((written, "an int, one word", _int))
        elif kind in "diuxXo" and length == "l":
            found.append((written, "a long, two words", _long))
        elif kind in "fFeEgG" and (length == "L" or (length in ("", "l") and isinstance(double, Double64))):
            found.append((written, f"a {'long double' if length == 'L' else 'double'}, four words", _double))
        elif kind in "fFeEgG" and length in ("", "l"):
            found.append((written, "a float", _float))
        elif kind == "s" and not length:
            found.append((written, "the address of a text", _address))
        elif kind == "p" and not length:
            found.append((written, "an address", _pointer))
        else:
            return None
    return found
