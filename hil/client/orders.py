"""The robot's orders as bytes: ``#STOP\\r``, ``#MISN\\r``, ``#TELE\\r``, ``#SETRv,w\\r``, ``#CALB\\r``, ``#INIT\\r``.

Source: the thesis' protocol.c (annex 1) and its console (annex 2).
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import reduce
from operator import xor
from typing import Final

from hil.longest import LONGEST_S

#: Words of the command line -> the four letters of the order.
KEYWORDS: Final = {
    "stop": "STOP",
    "mission": "MISN",
    "tele": "TELE",
    "calibrate": "CALB",
    "init": "INIT",
}
#: The size of the firmware's frame buffer in bytes.  On the real robot, too, a longer order would overrun it.
LONGEST_ORDER: Final = 80

_TIMED = re.compile(r"(?P<time>\d+(?:\.\d*)?|\.\d+):(?P<order>.+)", re.DOTALL)
_SETR = re.compile(r"(?:setr|set)\s*(?P<v>[^\s,]+)[\s,]+(?P<w>[^\s,]+)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class TimedOrder:
    """An order and its time, in seconds since the robot was ready."""

    time_s: float
    data: bytes


def order(keyword: str) -> bytes:
    """The bytes of the order for a word of `KEYWORDS`.  Raises ValueError for another word."""
    letters = KEYWORDS.get(keyword.lower())
    if letters is None:
        raise ValueError(f"no order {keyword!r}: there are {', '.join(KEYWORDS)} and set V W")
    return f"#{letters}\r".encode("ascii")


def set_reference(v_m_s: float, w_rad_s: float) -> bytes:
    """The order ``#SETRv,w\\r``: linear speed in m/s, angular speed in rad/s.  It takes effect in telemanipulation.

    The numbers have no exponent, because no console sends one.  Raises ValueError for a speed that is not finite.
    """
    return f"#SETR{_decimal(v_m_s)},{_decimal(w_rad_s)}\r".encode("ascii")


def checked(data: bytes) -> bytes:
    """An order with a checksum: `*`, and the exclusive or of the characters after `#` as two hexadecimal digits.

    Only the corrected firmware knows it (`PROTO-damage-unseen`).  After one such order, the firmware refuses all orders
    without a checksum but STOP.
    """
    body = data.removeprefix(b"#").removesuffix(b"\r")
    return b"#" + body + f"*{reduce(xor, body, 0):02X}\r".encode("ascii")


def parse_order(text: str) -> bytes:
    """The bytes of an order as a user writes it: ``mission``, ``MISN``, ``set 0.2 0``, ``SETR0.2,0``, or raw ``#....``.

    Raises ValueError for any other text.
    """
    text = text.strip()
    if text.startswith("#"):
        data = text.encode("utf-8").removesuffix(b"\\r") + b"\r"
        if len(data) > LONGEST_ORDER:
            raise ValueError(f"order of {len(data)} bytes: the robot's buffer has {LONGEST_ORDER}")
        return data
    setr = _SETR.fullmatch(text)
    if setr is not None:
        return set_reference(number(setr["v"], "V"), number(setr["w"], "W"))
    for word, letters in KEYWORDS.items():
        if text.lower() in (word, letters.lower()):
            return order(word)
    known = f"{', '.join(KEYWORDS)}, set V W, the four letters of one of them, or # and raw characters"
    raise ValueError(f"no order {text!r}: write {known}")


def parse_timed_order(text: str) -> TimedOrder:
    """Parse ``TIME:ORDER``, or ``ORDER`` alone for time 0.  Raises ValueError."""
    timed = _TIMED.fullmatch(text.strip())
    if timed is None:
        return TimedOrder(0.0, parse_order(text))
    time_s = number(timed["time"], "the time of an order")
    if time_s > LONGEST_S:
        raise ValueError(f"{text!r}: the time of an order must be at most {LONGEST_S:.0f} s")
    return TimedOrder(time_s, parse_order(timed["order"]))


def parse_words(words: list[str]) -> list[bytes]:
    """Parse several orders from the command line: ``tele set 0.2 0.0``.  Raises ValueError."""
    orders: list[bytes] = []
    rest = list(words)
    while rest:
        word = rest.pop(0)
        if word.lower() in ("set", "setr"):
            if len(rest) < 2:
                raise ValueError("set needs two numbers: set V W (m/s, rad/s)")
            orders.append(set_reference(number(rest.pop(0), "V"), number(rest.pop(0), "W")))
        else:
            orders.append(parse_order(word))
    return orders


def number(text: str, name: str) -> float:
    """Parse a finite decimal number.  Raises ValueError, which names `name`."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{name} is {text!r}: must be a number such as 0.2")
    return value


def _decimal(value: float) -> str:
    if not math.isfinite(value) or abs(value) > 1000:
        raise ValueError(f"speed {value}: must be a finite number, at most 1000")
    text = f"{value:.6f}".rstrip("0")
    return text + "0" if text.endswith(".") else text
