"""Feeding the inputs of a machine: by Python's own things, or by a line of text.

feed(bench, "ADCINA3", 1.25)
feed(bench, "gyro.yaw_rate_rad_s", ([0.0, 1.0, 2.0], [0, 90, 0]), how="linear", unit="deg/s")
feed(bench, "sonars.FRONT_range_m", lambda time_s: 1.0 + 0.5 * sin(time_s))
feed(bench, "ADCINA3", "physics")
load("sonars.FRONT_range_m=[[0, 2], [1.5, 0.5]],linear").feed(bench)
"""

from __future__ import annotations

import json
import re
from array import array
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any, Final, Protocol, TypeAlias

from emulator.clock import Clock
from hil.board import Board
from hil.feeds.course import HOW, Computed, Constant, Course, GeneratedCourse, Points, cycles_of
from hil.feeds.files import Column, read
from hil.feeds.inputs import Input, find

#: The source that ends a feed.
PHYSICS: Final = "physics"
#: A number; times in s and values; a function of the time; a generator of `(time_s, value)`; the path of a file, of
#: which the column of that input is taken (or its only one); "physics".
Source: TypeAlias = (
    float | tuple[Sequence[float], Sequence[float]] | Callable[[float], float] | Iterator[tuple[float, float]] | str
    | Path
)  # fmt: skip
FORM: Final = (
    "expected [INPUT=]FILE[#COLUMN][,linear], INPUT=[[SECONDS,VALUE],...][,linear], INPUT=NUMBER or INPUT=physics"
)
_INPUT: Final = re.compile(r"\s*([^=/\\]*\.\w+|ADCIN\w*)\s*=(.*)", re.DOTALL)


class FeedTarget(Protocol):
    """A machine whose inputs can be fed, such as `hil.running.RunningBoard`."""

    board: Board
    clock: Clock
    #: How long start-up takes.
    start_up_cycles: int
    #: What is fed, and what ends it.
    feeds: dict[str, Callable[[], None]]


def feed(
    machine: FeedTarget, name: str, source: Source | Column, *, how: str = "hold", unit: str = "",
    from_now: bool = False,
) -> None:
    """Let an input see a source instead of the physics, or of its earlier feed.

    Times count from the end of start-up, or `from_now`; those of a trace file from power-up.  Raises ValueError.
    """
    if how not in HOW:
        raise ValueError(f"how {how!r}: must be {' or '.join(HOW)}")
    into = find(machine.board, name)
    if isinstance(source, str | Path) and source != PHYSICS:
        source = column_of(read(source), name, str(source))
    course = None
    if source != PHYSICS:
        origin = machine.clock.now if from_now else machine.start_up_cycles
        try:
            course = _course(into, source, how, unit, origin)
        except TypeError as error:
            raise ValueError(f"feed of {name}: {error}") from None
    before = machine.feeds.pop(into.name, None)
    if before is not None:
        before()
    if course is not None:
        machine.feeds[into.name] = into.feed(course)


def _course(into: Input, source: Any, how: str, unit: str, origin: int) -> Course:
    if isinstance(source, Column):
        return _points(into, source, how, unit or source.unit, 0 if source.from_power_up else origin)
    factor, offset = into.scale(unit)

    def check(value: float, time_s: float) -> None:
        try:
            if not isfinite(value):
                raise ValueError(f"{value}: {into.name} must be a number")
            into.check(value)
        except ValueError as error:
            raise ValueError(f"feed at {time_s:g} s: {error}") from None

    if callable(source):
        return Computed(lambda time_s: source(time_s) * factor + offset, check, origin)
    if isinstance(source, Iterator):
        return GeneratedCourse(((time_s, value * factor + offset) for time_s, value in source), check, how, origin)
    if isinstance(source, tuple):
        times, values = source
        if len(times) != len(values) or not len(times):
            raise ValueError(
                f"feed of {into.name}: {len(times)} times, {len(values)} values: expected as many of both, at least 1"
            )
        column = Column(f"feed of {into.name}", into.name)
        for index, (time_s, value) in enumerate(zip(times, values, strict=True)):
            check(float(value) * factor + offset, time_s)
            column.add(cycles_of(float(time_s)), float(value), index)
        return _points(into, column, how, unit, origin)
    value = float(source) * factor + offset
    check(value, 0.0)
    return Constant(value)


def _points(into: Input, column: Column, how: str, unit: str, origin: int) -> Points:
    factor, offset = into.scale(unit)
    values = column.values
    if (factor, offset) != (1.0, 0.0):
        values = array("d", [value * factor + offset for value in values])
    if not into.low <= min(values) <= max(values) <= into.high:
        index = next(i for i, value in enumerate(values) if not into.low <= value <= into.high)
        try:
            into.check(values[index])
        except ValueError as error:
            raise ValueError(f"{column.where(index)}: {error}") from None
    return Points(column.times, values, how, origin)


def column_of(columns: list[Column], name: str, file: str, *, named: bool = False) -> Column:
    """The column of that name; if no column was `named`, the only column, whatever its name is.  Raises ValueError."""
    for column in columns:
        if column.name == name:
            return column
    if len(columns) == 1 and not named:
        return columns[0]
    there = ", ".join(column.name for column in columns)
    raise ValueError(f"{file}: no column {name!r}: there are {there}")


@dataclass(frozen=True)
class DeclaredFeed:
    """A feed that a text declares, with the content of its file."""

    text: str
    #: Input -> its source.
    sources: dict[str, float | str | tuple[list[float], list[float]] | Column]
    how: str = "hold"

    def feed(self, machine: FeedTarget) -> None:
        """Feed a machine.  Raises ValueError."""
        for name, source in self.sources.items():
            try:
                feed(machine, name, source, how=self.how)
            except ValueError as error:
                # Arrays may be long.
                said = name if isinstance(source, tuple) else self.text
                where = f"{source.file if isinstance(source, Column) else said}: "
                raise ValueError(f"{'' if str(error).startswith(where[:-2]) else where}{error}") from None


def load(text: str) -> DeclaredFeed:
    """A feed of the command line, its file read: `run.trace`, `gyro.yaw_rate_rad_s=a.csv#yaw,linear`, `ADCINA3=1.2`,
    `ADCINA3=[[0, 1.2], [1, 2.4]]`.

    A file without an input feeds all that it names.  Raises ValueError; OSError.
    """
    rest, how = text.strip(), "hold"
    for word in HOW:
        if rest.endswith(f",{word}"):
            rest, how = rest.removesuffix(f",{word}"), word
    named = _INPUT.fullmatch(rest)
    if named is None:
        if not rest:
            raise ValueError(f"feed {text!r}: {FORM}")
        return DeclaredFeed(text, {column.name: column for column in read(rest)}, how)
    name, source = named[1], named[2].strip()
    if source == PHYSICS:
        return DeclaredFeed(text, {name: PHYSICS})
    try:
        return DeclaredFeed(text, {name: float(source)})
    except ValueError:
        pass
    if source.startswith("["):
        return DeclaredFeed(text, {name: _arrays(name, source)}, how)
    file, _, wanted = source.partition("#")
    if not file:
        raise ValueError(f"feed {text!r}: {FORM}")
    return DeclaredFeed(text, {name: column_of(read(file), wanted or name, file, named=bool(wanted))}, how)


def _arrays(name: str, text: str) -> tuple[list[float], list[float]]:
    """Times and values of `[[0, 1.2], [1, 2.4]]`.  Raises ValueError."""
    try:
        pairs = json.loads(text)
        return [float(time_s) for time_s, _ in pairs], [float(value) for _, value in pairs]
    except (ValueError, TypeError, OverflowError, RecursionError):
        raise ValueError(f"feed of {name}: expected [[SECONDS,VALUE],...], such as [[0,1.2],[1,2.4]]") from None
