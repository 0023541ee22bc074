"""Finds limits, times and other quantities that nobody applies: definitions in a file that nothing uses.

The name says that it is a limit (`SPEED_MAX`), or states a unit (`SETTLING_US`, `COLD_TENTHS`).  It speaks only of
numbers, in a file that uses at least as many of them as it leaves: where most are unused, they are a list of what a
part can do.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.sites import Place
from hil.drivers.unit_names import unit_of_name
from hil.drivers.units import UnitMismatch

#: The words of a name, and those that say that it is a limit.
_WORD: Final = re.compile(r"[A-Za-z]+")
_LIMITS: Final = re.compile(r"MAX|MIN|LIMIT|TIMEOUT|LOW|HIGH|(OVER|UNDER)(VOLTAGE|CURRENT|TEMP|TEMPERATURE|SPEED)?")
_DEFINITION: Final = re.compile(r"^\s*#\s*define\s+(\w+)\s+(?:[-+(\s]|\([A-Za-z][\w ]*\))*\.?\d[\w.]*[)\s]*$")
#: The same in Python, at the beginning of a line.
_CONSTANT: Final = re.compile(r"^([A-Z][A-Z0-9_]*)\s*(?::\s*\w+\s*)?=\s*(?:[-+(\s])*\.?\d[\w.]*[)\s]*$")
_NAME: Final = re.compile(r"[A-Za-z_]\w*")


def _is_limit(name: str) -> bool:
    words = _WORD.findall(name.replace("_", " "))
    return len(words) > 1 and any(_LIMITS.fullmatch(word) for word in words)  # HIGH alone is the level of a pin


def unused_limits(files: Iterable[str]) -> Iterator[UnitMismatch]:
    """The limits that files of C or Python define and that no file uses."""
    files = sorted(file for file in files if file.endswith((".c", ".py")))
    lines = {file: lines_with_comments(file) for file in files}
    times = Counter(name for file in files for code, _ in lines[file] for name in _NAME.findall(code))
    for file in files:
        limits: dict[str, int] = {}
        for number, (code, _) in enumerate(lines[file], 1):
            match = (_DEFINITION if file.endswith(".c") else _CONSTANT).match(code)
            if match is not None and (_is_limit(match[1]) or unit_of_name(match[1]) is not None):
                limits[match[1]] = number
        unused = [name for name in limits if times[name] == 1]
        for name in unused if 2 * len(unused) <= len(limits) else ():
            place = Place(file, limits[name], "", file)
            message = f"nothing uses {name}: the check or wait that it is for may be missing"
            yield UnitMismatch(place, message, name, "limit-unused")
