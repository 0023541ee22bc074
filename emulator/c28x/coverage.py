"""How often each statement of the firmware starts.  Images linked with `CompileOptions.coverage` count it.

A statement counts each time the firmware reaches it; a loop counts each evaluation of its test (a `do` at the line of
the test).  The `break` that ends a case does not count as a statement.
A loop that only polls counts once each time the firmware reaches it, and turns that change nothing do not count where
time skips them (`Linked.skip_turns`): neither are run one by one.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from emulator.c28x.tree import Where


@dataclass
class FileCoverage:
    """One source file.  `lines`: line -> hits; `functions`: name -> (line, calls)."""

    lines: dict[int, int] = field(default_factory=dict)
    functions: dict[str, tuple[int, int]] = field(default_factory=dict)


class CountedPlace(NamedTuple):
    """What has a counter: a function of a file (`number` is 0), or its statement of that number."""

    file: str
    function: str
    number: int
    where: Where


class Coverage:
    """The counters of several images.  Images that share a function share its counters."""

    def __init__(self) -> None:
        self._counts: dict[tuple[str, str, tuple[Where, ...]], list[int]] = {}

    def counters(self, file: str, function: str, counted: Sequence[Where]) -> list[int]:
        """The counters of a function of `file`, one per place in `counted`; the first one counts its calls."""
        return self._counts.setdefault((file, function, tuple(counted)), [0] * len(counted))

    def begun(self) -> dict[CountedPlace, int]:
        """How often each counted place has been begun so far: the beginnings of functions, and their statements."""
        return {
            CountedPlace(file, function, n, place): count
            for (file, function, counted), counts in self._counts.items()
            for n, (place, count) in enumerate(zip(counted, counts, strict=True))
        }

    def data(self) -> list[list[Any]]:
        """All counters as lists, texts and numbers, for another process."""
        return [
            [file, function, [[where.file, where.line, where.column] for where in counted], counts]
            for (file, function, counted), counts in self._counts.items()
        ]

    def add(self, data: Iterable[Sequence[Any]]) -> None:
        """Add the counts of another process."""
        for file, function, counted, counts in data:
            own = self.counters(file, function, [Where(*place) for place in counted])
            own[:] = [mine + other for mine, other in zip(own, counts, strict=True)]

    def files(self) -> dict[str, FileCoverage]:
        """The counts by source file.

        The hits of a line are those of its most frequent statement; several functions on one line are added up.
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
