"""How often the statements of firmware are begun: counters that images linked with `CompileOptions.coverage` raise.

A statement is counted when the firmware comes to it, a loop at each look at its test (a `do` at the line of the test);
the `break` that ends a case is no statement of its own.
A loop that only polls is counted once each time the firmware comes to it: its turns are not run one by one.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from emulator.c28x.tree import Where


@dataclass
class FileCoverage:
    """One source file: hits of each line that has a statement; line and calls of each function."""

    lines: dict[int, int] = field(default_factory=dict)
    functions: dict[str, tuple[int, int]] = field(default_factory=dict)


class Coverage:
    """The counters of several images.  A function that they have in common is counted together."""

    def __init__(self) -> None:
        self._counts: dict[tuple[str, str, tuple[Where, ...]], list[int]] = {}

    def counters(self, file: str, function: str, counted: Sequence[Where]) -> list[int]:
        """The counters of a function of `file`: for itself first, then for the statements that begin at `counted`."""
        return self._counts.setdefault((file, function, tuple(counted)), [0] * len(counted))

    def data(self) -> list[list[Any]]:
        """All counters as lists, texts and numbers, for another process."""
        return [
            [file, function, [[where.file, where.line, where.column] for where in counted], counts]
            for (file, function, counted), counts in self._counts.items()
        ]

    def add(self, data: Iterable[Sequence[Any]]) -> None:
        """Add what another process has counted."""
        for file, function, counted, counts in data:
            own = self.counters(file, function, [Where(*place) for place in counted])
            own[:] = [mine + other for mine, other in zip(own, counts, strict=True)]

    def files(self) -> dict[str, FileCoverage]:
        """What was counted, by source file.

        A line has the hits of its statement that was begun most often; where several functions stand, of all of them.
        """
        found: dict[str, FileCoverage] = {}
        for (file, function, (place, *counted)), (calls, *counts) in self._counts.items():
            functions = found.setdefault(file, FileCoverage()).functions
            line, before = functions.get(function, (place.line, 0))
            functions[function] = (min(line, place.line), before + calls)
            most: dict[tuple[str, int], int] = {}
            for where, count in zip(counted, counts, strict=True):
                at = where.file, where.line
                most[at] = max(most.get(at, 0), count)
            for (named, number), count in most.items():
                lines = found.setdefault(named, FileCoverage()).lines
                lines[number] = lines.get(number, 0) + count
        return found
