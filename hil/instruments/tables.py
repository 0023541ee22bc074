"""A trace as tables: CSV, NumPy, Parquet, and as text that one can read."""

from __future__ import annotations

import csv
import json
from pathlib import Path

from hil.instruments.trace_file import NS_PER_CYCLE, Trace


def write_csv(path: str | Path, trace: Trace) -> None:
    """A row an event: time in s, channel, name, value (JSON where it is more than a number or a word)."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("time_s", "channel", "name", "value"))
        for cycles, channel, name, value in trace.events:
            shown = value if isinstance(value, int | float | str) else json.dumps(value, sort_keys=True)
            writer.writerow((f"{cycles * NS_PER_CYCLE * 1e-9:.9f}", channel, name, shown))


def write_npz(path: str | Path, trace: Trace) -> None:
    """Two arrays for each name of a channel with numbers: `CHANNEL/NAME/time_s` and `CHANNEL/NAME/value`."""
    import numpy as np

    columns: dict[str, tuple[list[float], list[object]]] = {}
    for cycles, channel, name, value in trace.events:
        if channel not in ("kernel", "findings"):
            times, values = columns.setdefault(f"{channel}/{name}", ([], []))
            times.append(cycles * NS_PER_CYCLE * 1e-9)
            values.append(value)
    arrays = {}
    for key, (times, values) in columns.items():
        arrays[f"{key}/time_s"] = np.array(times)
        arrays[f"{key}/value"] = np.array(values)
    with open(path, "wb") as file:
        np.savez_compressed(file, **arrays)  # type: ignore[arg-type]


def write_text(path: str | Path, trace: Trace) -> None:
    """A line an event; bytes of a serial pin that follow each other are one line."""
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        text: dict[str, tuple[int, list[int]]] = {}

        def say(cycles: int, channel: str, told: str) -> None:
            file.write(f"{cycles * NS_PER_CYCLE * 1e-9:16.9f} s  {channel:9s} {told}\n")

        def end_of(name: str) -> None:
            begin, held = text.pop(name)
            say(begin, "serial", f"{name}: {bytes(byte & 0xFF for byte in held)!r}")

        for cycles, channel, name, value in trace.events:
            if channel == "serial":
                held = text.setdefault(name, (cycles, []))[1]
                held.append(value)
                if value == 0x0D or len(held) >= 80:
                    end_of(name)
            elif channel == "spi":
                say(cycles, channel, f"{name}: sent {value[0]:#06x}, received {value[1]:#06x}")
            elif channel == "findings":
                say(cycles, channel, f"{name} {value['place']} {value['task']}: {value['message']}")
            elif channel == "registers":
                say(cycles, channel, f"{name} = {value:#x}")
            else:
                say(cycles, channel, f"{name} {value}")
        for name in list(text):
            end_of(name)
