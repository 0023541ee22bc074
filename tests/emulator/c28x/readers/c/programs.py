"""The programs in C, one a feature, with what their functions give.

A program is a file of `programs/`, or a folder of files that are linked together.  Its comments say what is expected,
derived by hand:

    // average(3, 4) == 3: 7 / 2, truncated

The arguments and the value are Python's numbers; behind the colon stands why.  `// avr: reason` says why another
compiler gives something else, from there to the end of the file; the programs are free of undefined behaviour.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

FOLDER: Final = Path(__file__).parent / "programs"
_EXPECTED: Final = re.compile(r"^// (?P<function>\w+)\((?P<arguments>[^)]*)\) == (?P<value>[^:]+): \S", re.M)
_LIKE: Final = re.compile(r"^//.*\) ==", re.M)
_NOT_AVR: Final = re.compile(r"^// avr: \S", re.M)


@dataclass(frozen=True)
class Expectation:
    """A call and its value; `portable` unless it depends on what differs between the chips."""

    function: str
    arguments: tuple[int | float, ...]
    value: int | float
    portable: bool

    @property
    def call(self) -> str:
        """The call as C writes it."""
        return f"{self.function}({', '.join(_literal(a) for a in self.arguments)})"


@dataclass(frozen=True)
class CProgram:
    """The files of a program, the first of which has the functions that are called."""

    name: str
    files: Mapping[str, str]
    expectations: tuple[Expectation, ...]


def _literal(value: int | float) -> str:
    return f"{value!r}f" if isinstance(value, float) else str(value)


def _read(path: Path) -> CProgram:
    paths = sorted(path.iterdir()) if path.is_dir() else [path]
    paths.sort(key=lambda p: (p.stem != "main", p.name))
    files = {p.name: p.read_text(encoding="utf-8") for p in paths}
    text = files[paths[0].name]
    found = list(_EXPECTED.finditer(text))
    if len(found) != len(_LIKE.findall(text)) or not found:
        raise ValueError(f"{path.name}: an expectation is `// f(1, 2) == 3: why`")
    limit = _NOT_AVR.search(text)
    expectations = tuple(
        Expectation(
            m["function"], ast.literal_eval(f"({m['arguments']},)" if m["arguments"] else "()"),
            ast.literal_eval(m["value"]), limit is None or m.start() < limit.start(),
        )
        for m in found
    )  # fmt: skip
    return CProgram(path.stem, files, expectations)


@cache
def programs() -> tuple[CProgram, ...]:
    """Every program, by name."""
    return tuple(_read(path) for path in sorted(FOLDER.iterdir()))
