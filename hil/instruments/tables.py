"""Writes a trace as a table (CSV, NumPy, Parquet) or as readable text."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hil.instruments.serial_lines import serial_lines
from hil.instruments.trace_file import NS_PER_CYCLE, PARTS, RecordedTrace


def write_csv(path: str | Path, trace: RecordedTrace) -> None:
    """Write a row for each event: time in s, channel, name, value (JSON if it is more than a number or a word)."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("time_s", "channel", "name", "value"))
        for cycles, channel, name, value in trace.events:
            shown = value if isinstance(value, int | float | str) else json.dumps(value, sort_keys=True)
            writer.writerow((f"{cycles * NS_PER_CYCLE * 1e-9:.9f}", channel, name, shown))


def write_npz(path: str | Path, trace: RecordedTrace) -> None:
    """Write two arrays for each name of a channel with numbers: `CHANNEL/NAME/time_s` and `CHANNEL/NAME/value`."""
    import numpy as np

    columns: dict[str, tuple[list[float], list[object]]] = {}
    for cycles, channel, name, value in trace.events:
        if channel not in ("kernel", "findings", "scene"):
            times, values = columns.setdefault(f"{channel}/{name}", ([], []))
            times.append(cycles * NS_PER_CYCLE * 1e-9)
            values.append(value)
    arrays = {}
    for key, (times, values) in columns.items():
        arrays[f"{key}/time_s"] = np.array(times)
        arrays[f"{key}/value"] = np.array(values)
    with open(path, "wb") as file:
        np.savez_compressed(file, **arrays)  # type: ignore[arg-type]


def write_parquet(path: str | Path, trace: RecordedTrace) -> None:
    """Write a row for each number or word: time in ns, channel, name, and `number` or `text`; the other one is null.

    A value of several numbers becomes several rows, such as `GYRO.sent` or `true.x_m`.  A finding becomes a row with
    its message.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    rows = [row for event in trace.events for row in _numbers_and_words(*event)]
    times, channels, names, numbers, texts = zip(*rows, strict=True) if rows else ((), (), (), (), ())
    repeated = pa.dictionary(pa.int32(), pa.string())
    pq.write_table(pa.table({
        "time_ns": pa.array(times, pa.int64()), "channel": pa.array(channels, repeated),
        "name": pa.array(names, repeated), "number": pa.array(numbers, pa.float64()),
        "text": pa.array(texts, pa.string()),
    }), path)  # fmt: skip


def _numbers_and_words(
    cycles: int, channel: str, name: str, value: Any
) -> Iterator[tuple[int, str, str, float | None, str | None]]:
    parts = PARTS.get(channel)
    named = zip((f"{name}.{part}" for part in parts), value, strict=True) if parts else [(name, value)]
    for part, one in named:
        text = one["message"] if channel == "findings" else one if isinstance(one, str) else None
        if channel == "scene":
            text = json.dumps(one)
        yield cycles * NS_PER_CYCLE, channel, part, None if text is not None else float(one), text


def write_text(path: str | Path, trace: RecordedTrace) -> None:
    """Write a line for each event, in the order of time.  Consecutive bytes of a serial pin become one line."""
    told: list[tuple[int, str, str]] = []
    for line in serial_lines(trace):
        told.append((line.begin, "serial", f"{line.pin}: {line.content!r}"))
    for cycles, channel, name, value in trace.events:
        if channel == "spi":
            told.append((cycles, channel, f"{name}: sent {value[0]:#06x}, received {value[1]:#06x}"))
        elif channel == "findings":
            told.append((cycles, channel, f"{name} {value['place']} {value['task']}: {value['message']}"))
        elif channel == "registers":
            told.append((cycles, channel, f"{name} = {value:#x}"))
        elif channel != "serial":
            told.append((cycles, channel, f"{name} {value}"))
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        for cycles, channel, text in sorted(told, key=lambda line: line[0]):
            file.write(f"{cycles * NS_PER_CYCLE * 1e-9:16.9f} s  {channel:9s} {text}\n")
