"""Findings: things that a correct driver would not do, with all that is needed to examine them.

A finding belongs to one place, however often the firmware passes it.  The first occurrence keeps its time, task, call
path and value; later ones only count.  Detectors all over the emulator call `Findings.report`.  This module adds the
place in the firmware, the call path, the task and the time, so a detector states only what it knows.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from html import escape
from itertools import islice
from typing import Any

from emulator.c28x.position import Calls, Position, frames
from emulator.c28x.sites import Place, Places
from emulator.clock import Clock, us
from emulator.rules import RULES, Severity, counted
from emulator.signal import Signal


@dataclass(slots=True, repr=False)
class Finding:
    """One defect seen at one place.  `time_cycles` is virtual time in SYSCLK cycles."""

    rule: str
    message: str
    object: str
    declaration: str
    place: Place | None
    call_path: tuple[Place, ...]
    task: str
    time_cycles: int
    value: Any = None
    count: int = 1
    #: More details, one sentence each: the neighbour that is hit, what address 0 holds and who shares it.
    details: tuple[str, ...] = ()
    #: "dynamic": found while the firmware ran; "static": found in the typed tree, without running it.
    how: str = "dynamic"

    @property
    def time_us(self) -> float:
        """Virtual time of the first occurrence in microseconds."""
        return us(self.time_cycles)

    def __repr__(self) -> str:
        where = f" at {_briefly(self.place)}" if self.place else ""
        seen = "in the source" if self.how == "static" else f"{self.task}, {self.time_us / 1e3:.3f} ms, x{self.count}"
        return f"<{self.rule}: {self.object}{where}; {seen}>"

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {
            "rule": self.rule,
            "message": self.message,
            "object": self.object,
            "declaration": self.declaration,
            "c_file": self.place.c_file if self.place else "",
            "function": self.place.function if self.place else "",
            "file": self.place.file if self.place else "",
            "line": self.place.line if self.place else 0,
            "column": self.place.column if self.place else 0,
            "call_path": [str(place) for place in self.call_path],
            "task": self.task,
            "time_us": self.time_us,
            "value": self.value if isinstance(self.value, int | float | str) else None,
            "count": self.count,
            "details": list(self.details),
            "how": self.how,
        }


class Cause:
    """The statement that started something which ends later: its number, its calls, and who ran (as in `Position`)."""

    __slots__ = ("at", "calls", "who")

    def __init__(self) -> None:
        self.at = 0
        self.calls: Calls | None = None
        self.who = ""

    def take(self, position: Position) -> None:
        """Make it the statement that executes now."""
        self.at, self.calls, self.who = position.at, position.calls, position.who


class Findings:
    """The findings of one board, in order of first occurrence."""

    __slots__ = (
        "_by_key", "beginnings", "cause", "clock", "found", "generation", "interrupts", "muted", "occurrences",
        "places", "position", "sources",
    )  # fmt: skip

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        #: Where the firmware is, and the places by number.
        self.position = Position()
        self.places = Places()
        #: Python file of a firmware module -> C file it mirrors; filled by the linker.
        self.sources: dict[str, str] = {}
        #: Where each function of the firmware begins; filled by the linker.
        self.beginnings: dict[Callable[..., Any], Place] = {}
        #: There, of functions of C: whether it is declared `interrupt`, and so returns with IRET; filled by the linker.
        self.interrupts: dict[Place, bool] = {}
        #: The cause of the event that runs now: findings belong to it, not to the task that happens to have the CPU.
        self.cause: Cause | None = None
        #: Reports are not recorded now, because they are consequences of an earlier finding.
        self.muted = False
        #: Increases with every `clear`, so that a detector knows that the finding it remembers is gone.
        self.generation = 0
        #: How often anything was reported or counted.
        self.occurrences = 0
        self._by_key: dict[tuple[str, str, int, str], Finding] = {}
        #: (finding): at each first occurrence.
        self.found: Signal[Finding] = Signal()

    def __iter__(self) -> Iterator[Finding]:
        return iter(self._by_key.values())

    def __len__(self) -> int:
        return len(self._by_key)

    def __getitem__(self, index: int) -> Finding:
        """Finding number `index` in order of occurrence, from 0; -1 is the last one."""
        return list(self)[index]

    def __repr__(self) -> str:
        return f"<{counted(_severity(finding.rule) for finding in self)}>"

    def _repr_html_(self) -> str:
        """The findings as a table for notebooks, the worst first."""
        names = ("severity", "rule", "what", "where", "task", "first (ms)", "times")
        head = "".join(f"<th>{name}</th>" for name in names)
        rows = "".join(
            "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in (
                _severity(finding.rule).value, finding.rule, finding.message, _briefly(finding.place), finding.task,
                f"{finding.time_us / 1e3:.3f}", finding.count,
            )) + "</tr>"
            for finding in sorted(self, key=lambda finding: -_severity(finding.rule).rank)
        )  # fmt: skip
        return f"<p>{escape(repr(self)[1:-1])}</p><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"

    def of(self, rule: str) -> list[Finding]:
        """The findings of one rule."""
        return [finding for finding in self if finding.rule == rule]

    def clear(self) -> None:
        """Forget everything seen so far."""
        self._by_key.clear()
        self.generation += 1

    def context(self) -> str:
        """Who runs now (`Position.who`)."""
        return self.position.who

    def report(
        self, rule: str, message: str, *, object: str = "", declaration: str = "", value: Any = None,
        details: tuple[str, ...] = (), at: int = 0, cause: Cause | None = None, otherwise: Cause | None = None,
    ) -> Finding:  # fmt: skip
        """Record an occurrence of `rule` at the statement that executes now; `at`: its number, if known.

        `cause`: an earlier statement that it belongs to, if known.  `otherwise`: the one that it belongs to if no
        statement executes now.
        """
        cause = cause or self.cause
        path: tuple[Place, ...] = ()
        task = ""
        if cause is None:
            path = self.path(at or self.position.at, self.position.calls)
            cause = None if path else otherwise
        if cause is not None:
            path, task = self.path(cause.at, cause.calls), cause.who
        return self._record(path, task, rule, message, object, declaration, value, details, "dynamic")

    def report_at(
        self, place: Place, rule: str, message: str, *, how: str, object: str = "", declaration: str = "",
        value: Any = None, details: tuple[str, ...] = (), call_path: tuple[Place, ...] = (), task: str = "",
    ) -> Finding:  # fmt: skip
        """Record `rule` at a place that does not execute now: in the typed tree, or at an earlier access.

        `call_path` begins with that place.
        """
        return self._record(call_path or (place,), task, rule, message, object, declaration, value, details, how)

    def _record(
        self, path: tuple[Place, ...], task: str, rule: str, message: str, object: str, declaration: str, value: Any,
        details: tuple[str, ...], how: str,
    ) -> Finding:  # fmt: skip
        place = path[0] if path else None
        key = (rule, place.file if place else "", place.line if place else 0, object)
        known = self._by_key.get(key)
        if known is not None:
            self.count(known)
            return known
        task = task or (self.context() if how == "dynamic" else "")
        self.occurrences += 1
        finding = Finding(
            rule, message, object, declaration, place, path, task, self.clock.now, value, details=details, how=how
        )
        if self.muted:
            return finding
        self._by_key[key] = finding
        self.found.emit(finding)
        return finding

    def count(self, finding: Finding) -> None:
        """A finding has occurred again."""
        finding.count += 1
        self.occurrences += 1

    def mark(self) -> Cause | None:
        """The statement that executes now, as the cause of what it starts; None if none executes."""
        position = self.position
        if not position.at and position.calls is None:
            return None
        cause = Cause()
        cause.take(position)
        return cause

    def path(self, at: int, calls: Calls | None) -> tuple[Place, ...]:
        """The call path of a position, as places, the innermost first.

        Places in functions of our own headers (`<stdlib.h>`) are left out: the path begins at the line that calls them.
        """
        places = [self.places[number] for number, _ in frames(at, calls)]
        own = next((i for i, place in enumerate(places) if not place.file.startswith("<")), 0)
        return tuple(places[own:])

    def here(self, depth: int) -> tuple[Place, ...]:
        """The innermost `depth` places of the firmware that is executing."""
        return tuple(self.places[number] for number, _ in islice(self.position.frames(), depth))


def _briefly(place: Place | None) -> str:
    """A short text of a place, for a narrow column: the file without its folder."""
    return "" if place is None else str(place._replace(file=os.path.basename(place.file)))


def _severity(rule_id: str) -> Severity:
    """The severity of a rule; a warning for an unknown rule."""
    rule = RULES.get(rule_id)
    return Severity.WARNING if rule is None else rule.severity
