"""Static check of the time of an echo that becomes a distance and is not halved: `echo-not-halved`.

    mm = echo_us * 343 / 1000;          /* the sound goes there and back: / 2000 */

A time in microseconds (or another power of ten of a second, by its name) is multiplied by a speed of sound, and no
other factor than powers of ten is in the product.  The source speaks of an echo, a sonar or ultrasound.

Silent if the module halves a time, a distance or what a function returns anywhere, and if it speaks of a sound that
goes one way only (a beacon, a wind meter).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import Final

from emulator.c28x.passes.declared import words_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Binary, Call, Expr, Load, Variable
from emulator.c28x.tree_queries import (
    PRODUCT,
    number_of,
    operands,
    outermost,
    own_nodes,
    parts,
    source_text,
    statements,
    within,
)

_ECHO: Final = re.compile(r"echo|sonar|ultra.?s|hc.?sr04|maxsonar|\bping|there and back|round.?trip", re.IGNORECASE)
_ONE_WAY: Final = re.compile(r"one.?way|beacon|anemo|wind|hydrophone|single.?path|two.?part", re.IGNORECASE)
#: Words of the names of times in seconds, or in a thousandth, millionth or billionth of one.
_SECONDS: Final = frozenset((
    "s", "sec", "secs", "seconds", "ms", "msec", "millis", "us", "usec", "usecs", "micros", "microseconds", "ns",
    "nsec",
))  # fmt: skip
#: Words of what may be halved in place of the product.
_HALVED: Final = _SECONDS | frozenset((
    "time", "echo", "pulse", "width", "flight", "tof", "travel", "trip", "duration", "edge", "capture", "count",
    "counts", "ticks", "sound", "speed", "range", "distance", "dist", "mm", "cm", "m", "inch", "inches", "way", "path",
    "length", "high", "value", "result", "reading",
))  # fmt: skip
#: The first digits of the speed of sound in air, from 0 to 30 degrees, and of the time that it takes for a length.
_SPEED: Final = (3.31, 3.495)
_SLOWNESS: Final = (2.86, 3.02)


def check_echoes(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the products of a time and the speed of sound that stand for a distance and are not halved."""
    for module in modules:
        if not _ECHO.search(module.text) or _ONE_WAY.search(module.text):
            continue
        if any(_halves(p) for function in module.functions for p in within(function.body)):
            continue
        for function in module.functions:
            for s in statements(function.body):
                for product in outermost(own_nodes(s), PRODUCT):
                    time = _time_of_echo(product)
                    if time:
                        text = source_text(product)
                        message = (
                            f"{text} is the way of the sound in {time}, there and back: the distance is half of it"
                        )
                        reports[module].report(function, s.where, "echo-not-halved", message, object=text)


def _time_of_echo(product: Binary) -> str:
    """The name of the time of which a product is the way of the sound; empty: it is none, or half of it."""
    factor, sound, times = 1.0, False, list[Expr]()
    for e, up in operands(product, PRODUCT):
        value = number_of(e)
        if value is None:
            times.append(e)
            if not up:
                return ""
        elif value <= 0:
            return ""
        else:
            factor *= value if up else 1 / value
            low, high = _SPEED if up else _SLOWNESS
            sound = sound or low <= _digits(value) < high
    if len(times) != 1 or not sound or not _SPEED[0] <= _digits(factor) < _SPEED[1]:
        return ""
    name = _name(times[0])
    return name if _SECONDS.intersection(words_of(name)) else ""


def _digits(value: float) -> float:
    """A number as one digit and its fraction: 3.43 of 343 and of 0.0343."""
    return value / math.pow(10, math.floor(math.log10(value) + 1e-9))


def _name(e: Expr) -> str:
    match e:
        case Load(lvalue=lvalue):
            root = lvalue.root
            return lvalue.text or (root.declaration.name if isinstance(root, Variable) else "")
        case Call(function=function):
            return function.name
    return ""


def _halves(p: object) -> bool:
    """Whether an expression is half of what may be the time or the distance."""
    match p:
        case Binary(op="/", left=e, right=by) if number_of(by) in (2, 4):
            pass
        case Binary(op=">>", left=e, right=by) if number_of(by) in (1, 2):
            pass
        case Binary(op="*", left=e, right=by) if number_of(by) == 0.5:
            pass
        case Binary(op="*", left=by, right=e) if number_of(by) == 0.5:
            pass
        case _:
            return False
    return any(
        isinstance(q, Call) or (isinstance(q, Load) and _HALVED.intersection(words_of(_name(q)))) for q in parts(e)
    )
