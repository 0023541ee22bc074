"""Files with what inputs see: CSV tables, trace files of `hil run --trace`, and CSV that `hil export` made of those.

A table has the time in its first column (`time_s`, `time [ms]`), counted from the end of start-up, and an input a
column, with a unit if it is another than the input's: `gyro.yaw_rate_rad_s [deg/s]`.  An empty cell says nothing, nor
does a line that begins with `#`.  Comma, semicolon (then a comma may stand in numbers) or tabulator; UTF-8.  Times of a
trace count from power-up.
"""

from __future__ import annotations

import csv
import re
from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import Final

from hil.feeds.course import cycles_of
from hil.files import read_text
from hil.instruments import trace_file

#: Channels of a trace with what sensors saw.
CHANNELS: Final = ("adc", "sensors")

_HEADING: Final = re.compile(r"(?P<name>.*?)\s*(?:\[(?P<unit>[^\]]*)\])?")
_TIME: Final = re.compile(r"(?:t|time)(?:_(s|ms|us)|\s*\[(s|ms|us)\])")
_SECONDS: Final = {"s": 1.0, "ms": 1e-3, "us": 1e-6}
_EXPORTED: Final = ["time_s", "channel", "name", "value"]


@dataclass
class Column:
    """The values that one input sees: times in cycles, values, and the line of each in the file."""

    file: str
    name: str
    unit: str = ""
    #: Whether times count from power-up, not from the end of start-up.
    from_power_up: bool = False
    times: array[int] = field(default_factory=lambda: array("q"))
    values: array[float] = field(default_factory=lambda: array("d"))
    lines: array[int] = field(default_factory=lambda: array("q"))

    def where(self, index: int) -> str:
        """File and line of a value."""
        line = f":{self.lines[index]}" if self.lines else ""
        return f"{self.file}{line}: column {self.name!r}"

    def add(self, time: int, value: float, line: int) -> None:
        """Add a value.  Raises ValueError if the time decreases."""
        if self.times and time < self.times[-1]:
            raise ValueError(f"{self.file}:{line}: the time decreases; rows must be in order of time")
        self.times.append(time)
        self.values.append(value)
        self.lines.append(line)


def read(path: str | Path) -> list[Column]:
    """The columns of a file.  Raises ValueError with file, line and column; OSError."""
    text = read_text(path)
    return _of_trace(path) if text.startswith('{"hil_trace"') else _of_table(str(path), _rows(str(path), text))


def _of_trace(path: str | Path) -> list[Column]:
    columns: dict[str, Column] = {}
    for cycles, channel, name, value in trace_file.read(path).of(*CHANNELS):
        _column(columns, str(path), channel, name).add(cycles, float(value), 0)
    for column in columns.values():
        del column.lines[:]
    return _some(columns, str(path))


def _column(columns: dict[str, Column], path: str, channel: str, name: str) -> Column:
    """The column of an event: a conversion has the name of its pin and of the part that is soldered there."""
    wanted = name.partition(" ")[0] if channel == "adc" else name
    return columns.setdefault(wanted, Column(path, wanted, from_power_up=True))


def _some(columns: dict[str, Column], path: str) -> list[Column]:
    if not columns:
        said = " ".join(f"--channel {each}" for each in CHANNELS)
        raise ValueError(f"{path}: no sensor values: record them with hil run --trace FILE {said}")
    return list(columns.values())


def _rows(path: str, text: str) -> Iterator[tuple[int, list[str]]]:
    """Line and cells of each row that is not empty."""
    delimiter = ""
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip(" \t\r,;") or line.startswith("#"):
            continue
        heads = not delimiter
        if heads:
            delimiter = next((each for each in ";\t" if each in line), ",")
        try:
            cells = next(csv.reader([line.rstrip("\r")], delimiter=delimiter, strict=True))
        except csv.Error as error:
            raise ValueError(f"{path}:{number}: {error}") from None
        if delimiter == ";" and not heads:
            cells = [cell.replace(",", ".") for cell in cells]
        yield number, [cell.strip() for cell in cells]


def _of_table(path: str, rows: Iterator[tuple[int, list[str]]]) -> list[Column]:
    first, heading = next(rows, (1, []))
    if heading == _EXPORTED:
        return _of_exported(path, rows)
    time = _TIME.fullmatch(heading[0]) if heading else None
    if time is None or len(heading) < 2:
        raise ValueError(f"{path}:{first}: expected a heading: time_s (or time [ms]), then inputs, such as ADCINA3")
    scale = _SECONDS[time[1] or time[2]]
    columns = []
    for text in heading[1:]:
        named = _HEADING.fullmatch(text)
        assert named is not None
        columns.append(Column(path, named["name"], (named["unit"] or "").strip()))
        if not columns[-1].name:
            raise ValueError(f"{path}:{first}: column {len(columns) + 1} has no name")
        if columns[-1].name in [each.name for each in columns[:-1]]:
            raise ValueError(f"{path}:{first}: more than one column {columns[-1].name!r}")
    last = 0
    for number, cells in rows:
        if len(cells) != len(heading):
            raise ValueError(f"{path}:{number}: {len(cells)} cells, and the heading has {len(heading)}")
        cycles = _time(_number(cells[0], f"{path}:{number}: column {heading[0]!r}") * scale, path, number)
        if number > first + 1 and cycles < last:
            raise ValueError(f"{path}:{number}: column {heading[0]!r}: {cells[0]} decreases; "
                             "rows must be in the order of time")  # fmt: skip
        last = cycles
        for column, cell in zip(columns, cells[1:], strict=True):
            if cell:
                column.add(cycles, _number(cell, f"{path}:{number}: column {column.name!r}"), number)
    for column in columns:
        if not column.times:
            raise ValueError(f"{path}: column {column.name!r} has no value")
    return columns


def _of_exported(path: str, rows: Iterator[tuple[int, list[str]]]) -> list[Column]:
    columns: dict[str, Column] = {}
    for number, cells in rows:
        if len(cells) != len(_EXPORTED):
            raise ValueError(f"{path}:{number}: {len(cells)} cells, and the heading has {len(_EXPORTED)}")
        if cells[1] in CHANNELS:
            cycles = _time(_number(cells[0], f"{path}:{number}: column 'time_s'"), path, number)
            value = _number(cells[3], f"{path}:{number}: column 'value'")
            _column(columns, path, cells[1], cells[2]).add(cycles, value, number)
    return _some(columns, path)


def _time(time_s: float, path: str, line: int) -> int:
    try:
        return cycles_of(time_s)
    except ValueError as error:
        raise ValueError(f"{path}:{line}: {error}") from None


def _number(text: str, where: str) -> float:
    try:
        value = float(text.replace("_", "?"))
    except ValueError:
        raise ValueError(f"{where}: {text!r} is not a number") from None
    if not isfinite(value):
        raise ValueError(f"{where}: {text} is not a number that an input can have")
    return value
