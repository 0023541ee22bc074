"""Converts a trace file to a file for another tool.  The suffix selects the format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

from hil.files import replacing
from hil.instruments import mcap, perfetto, tables, vcd
from hil.instruments.trace_file import RecordedTrace
from hil.page.page import write_page

#: Suffix -> the function that writes the format, and the tools that open it.
FORMATS: Final[Mapping[str, tuple[Callable[[str | Path, RecordedTrace], None], str]]] = MappingProxyType({
    ".vcd": (vcd.write_vcd, "GTKWave, PulseView: pins, words, registers, tasks"),
    ".pftrace": (perfetto.write_perfetto, "ui.perfetto.dev: tasks, interrupts, gates, findings"),
    ".mcap": (mcap.write_mcap, "Foxglove, Lichtblick: poses, sensors, frames, findings"),
    ".csv": (tables.write_csv, "spreadsheets: every event"),
    ".npz": (tables.write_npz, "NumPy: what has numbers"),
    ".parquet": (tables.write_parquet, "pandas, Polars, DuckDB: every number and word"),
    ".html": (write_page, "any browser: the run played again, with findings, frames, tasks"),
    ".txt": (tables.write_text, "people: every event, serial bytes as text"),
})  # fmt: skip


def writer_of(target: str | Path) -> Callable[[str | Path, RecordedTrace], None]:
    """The function that writes the format of a file's suffix.  Raises ValueError for an unknown suffix."""
    suffix = Path(target).suffix.lower()
    known = FORMATS.get(suffix)
    if known is None:
        raise ValueError(f"{target}: no format for {suffix or 'a name without suffix'}: expected {', '.join(FORMATS)}")
    return known[0]


def export(trace: RecordedTrace, target: str | Path) -> None:
    """Write a trace in the format of the suffix of `target`.  Raises ValueError for an unknown suffix."""
    write = writer_of(target)
    with replacing(target) as new:
        write(new, trace)
