"""Reads the meaning of a field's value from the description of the field: `EPWMSYNCPER at: 0 TBPRD, 1 zero`.

Descriptions name values as `0 NAME, 1 NAME` or `1 = NAME`, at their beginning or after a colon or semicolon.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

#: Where a value is named: after what, the value or the values from-to, an equals sign.
_NAMED: Final = re.compile(r"(^|: |; |, | is )(\d+)(?:( and | to |-)(\d+))?( =)? (?=\S)")
_END: Final = re.compile(r";|\. |\.$")


@dataclass(frozen=True, slots=True)
class NamedValues:
    """The values `low` to `high` of a field are called `text`."""

    low: int
    high: int
    text: str


@lru_cache(maxsize=4096)
def named(description: str) -> tuple[NamedValues, ...]:
    """The values that a description names; none if it names none."""
    found = list(_NAMED.finditer(description))
    while found and found[0][1] == ", ":  # an enumeration begins with its first value
        del found[0]
    if len(found) == 1 and not (found[0][5] or found[0][1] == "; "):
        return ()  # "29 bits of identifier"
    values = []
    for at, match in enumerate(found):
        until = found[at + 1].start() if at + 1 < len(found) else len(description)
        text = _END.split(description[match.end() : until])[0].strip()
        low, high = int(match[2]), int(match[4] or match[2])
        if match[3] in (" to ", "-"):
            text = f"{low}{match[3]}{high} {text}"
        values.append(NamedValues(low, high, text))
    return tuple(values)


def meaning(description: str, value: int) -> str:
    """The meaning of a value; "" if the description does not give it."""
    return next((each.text for each in named(description) if each.low <= value <= each.high), "")
