"""A task set as a TOML sheet.

    # all times in microseconds
    switch_us = 0                      # one task switch, if the computation times do not contain it

    [[task]]
    name = "TaskGYRO"
    priority = 5
    period_us = 5000                   # for a sporadic task, the least time between two releases
    deadline_us = 5000                 # default: the period
    computation_us = 42.97
    jitter_us = 0                      # how late a release may come
    start_up_us = 0                    # the computation time before its first wait
    sections = [{ gate = "GYRO", time_us = 4.05 }]   # longest time in each gate; may contain `sections`

    [[interrupt]]                      # above all tasks
    name = "Clock"
    period_us = 1000
    computation_us = 5

An error names file, key and line.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from hil.files import parse_toml, read_text
from hil.rta.task_set import NS_PER_US, Arrival, Interrupt, Section, TaskModel, TaskSet

_TOP: Final = ("task", "interrupt", "switch_us")
_TASK: Final = (
    "name", "priority", "period_us", "deadline_us", "computation_us", "jitter_us", "start_up_us", "sections",
)  # fmt: skip
_INTERRUPT: Final = ("name", "period_us", "computation_us", "jitter_us")
_SECTION: Final = ("gate", "time_us", "sections")


def load_sheet(path: Path) -> TaskSet:
    """The task set of a sheet.  Raises ValueError with file, line and key; OSError if it cannot be read."""
    return parse_sheet(read_text(path), str(path))


def parse_sheet(text: str, name: str) -> TaskSet:
    """The task set of the text of a sheet; `name` is its name in errors."""
    table = parse_toml(text, name)
    return _Sheet(text, name).task_set(table)


class _Sheet:
    """Reads a sheet.  It keeps the text to find the lines of errors."""

    def __init__(self, text: str, name: str) -> None:
        self._lines = text.splitlines()
        self._name = name
        #: (kind, index) of the table that is being read.  The line of an error is in that table.
        self._at: tuple[str, int] | None = None

    def task_set(self, table: Mapping[str, Any]) -> TaskSet:
        self._known(table, _TOP, "the sheet")
        tasks = self._tables(table, "task")
        if not tasks:
            raise self._error("task", "there is no [[task]]")
        read = []
        for index, entry in enumerate(tasks):
            self._at = ("task", index)
            read.append(self._task(entry))
        interrupts = []
        for index, entry in enumerate(self._tables(table, "interrupt")):
            self._at = ("interrupt", index)
            interrupts.append(self._interrupt(entry))
        self._at = None
        switch_ns = self._time(table, "switch_us", 0)
        try:
            return TaskSet(tuple(read), tuple(interrupts), switch_ns=switch_ns, name=self._name)
        except ValueError as error:
            raise self._error("name", str(error)) from None

    def _task(self, entry: Mapping[str, Any]) -> TaskModel:
        self._known(entry, _TASK, "[[task]]")
        arrival = self._arrival(entry)
        computation = self._positive(entry, "computation_us")
        sections = self._sections(entry, computation, ())
        priority = self._need(entry, "priority")
        if isinstance(priority, bool) or not isinstance(priority, int) or not 1 <= priority <= 31:
            raise self._error("priority", f"{priority!r} must be a whole number from 1 to 31 (the most urgent)")
        return TaskModel(
            self._text(entry, "name"), priority, arrival, computation,
            self._time(entry, "deadline_us", arrival.period_ns) or arrival.period_ns, sections,
            self._time(entry, "start_up_us", 0),
        )  # fmt: skip

    def _sections(self, around: Mapping[str, Any], time_ns: int, held: tuple[str, ...]) -> tuple[Section, ...]:
        """The sections of a task, or those within a section; `held` are the gates that are held already."""
        found = []
        for entry in self._tables(around, "sections"):
            self._known(entry, _SECTION, "a section")
            gate, time = self._text(entry, "gate"), self._positive(entry, "time_us")
            if gate in held:
                raise self._error("gate", f"{gate!r} is held already")
            found.append(Section(gate, time, self._sections(entry, time, (*held, gate))))
        if sum(section.time_ns for section in found) > time_ns:
            raise self._error("sections", f"they take longer than the whole {'section' if held else 'computation'}")
        return tuple(found)

    def _interrupt(self, entry: Mapping[str, Any]) -> Interrupt:
        self._known(entry, _INTERRUPT, "[[interrupt]]")
        return Interrupt(
            self._text(entry, "name"), self._arrival(entry), self._positive(entry, "computation_us")
        )  # fmt: skip

    def _arrival(self, entry: Mapping[str, Any]) -> Arrival:
        return Arrival(self._positive(entry, "period_us"), self._time(entry, "jitter_us", 0))

    def _tables(self, entry: Mapping[str, Any], key: str) -> Sequence[Mapping[str, Any]]:
        value = entry.get(key, [])
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            raise self._error(key, "it must be a list of tables")
        return value

    def _known(self, entry: Mapping[str, Any], keys: Sequence[str], what: str) -> None:
        for key in entry:
            if key not in keys:
                raise self._error(key, f"{what} has no such key: there are {', '.join(keys)}")

    def _need(self, entry: Mapping[str, Any], key: str) -> Any:
        if key not in entry:
            raise self._error(key, "it is missing")
        return entry[key]

    def _text(self, entry: Mapping[str, Any], key: str) -> str:
        value = self._need(entry, key)
        if not isinstance(value, str) or not value:
            raise self._error(key, f"{value!r} must be a text")
        return value

    def _positive(self, entry: Mapping[str, Any], key: str) -> int:
        self._need(entry, key)
        value = self._time(entry, key, 0)
        if not value:
            raise self._error(key, "it must be more than 0")
        return value

    def _time(self, entry: Mapping[str, Any], key: str, default_ns: int) -> int:
        value = entry.get(key)
        if value is None:
            return default_ns
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < 1e12:
            raise self._error(key, f"{value!r} must be a time in microseconds, 0 or more")
        return round(value * NS_PER_US)

    def _error(self, key: str, message: str) -> ValueError:
        return ValueError(f"{self._name}:{self._line(key)}: {key}: {message}")

    def _line(self, key: str) -> int:
        """The line of a key in the table that is being read; if it has no such key, the line of the table."""
        first, last = 0, len(self._lines)
        if self._at is not None:
            kind, index = self._at
            header = re.compile(rf"\s*\[\[\s*{kind}\s*\]\]")
            starts = [number for number, line in enumerate(self._lines) if header.match(line)]
            if index < len(starts):
                first = starts[index]
                any_header = re.compile(r"\s*\[")
                later = (n for n in range(first + 1, last) if any_header.match(self._lines[n]))
                last = next(later, last)
        word = re.compile(rf"(?:^|[\s{{,\[])[\"']?{re.escape(key)}[\"']?\s*(?:=|\])")
        found = (number for number in range(first, last) if word.search(self._lines[number].partition("#")[0]))
        return next(found, first) + 1
