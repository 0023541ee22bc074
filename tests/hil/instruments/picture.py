"""``python -m tests.hil.instruments.picture FILE``: exports of a trace, as readers see them that did not write them.

The viewers (GTKWave, Perfetto, Foxglove) do not run in CI.  So the VCD is drawn as vcdvcd reads it, the Perfetto trace
by the field numbers of its protocol, the MCAP as its reference reader gives it, beside the decoded text.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Iterable
from contextlib import closing
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from mcap.reader import SeekingReader
from vcdvcd import VCDVCD

from hil.bench import Bench
from hil.instruments.export import export
from hil.instruments.recorder import recorded
from hil.instruments.trace_file import read
from hil.machine import Setup
from tests.hil.instruments.test_trace import fields

#: What the waves show, of each pin that a part is soldered to; for how long, in s.
PINS = ("gyro.CS", "sonars.start", "left_motor.IN1", "SPI_A_sent", "SPI_A_received")
WAVES_S = 0.00045
DRIVE_S = 12.0


def main(file: Path) -> None:
    """Record a drive, export it, read that again, draw it."""
    with tempfile.TemporaryDirectory() as name, closing(Bench(Setup(seed=3))) as bench:
        folder = Path(name)
        with recorded(folder / "drive.trace", bench, ("adc", "pose", "serial")):
            bench.boot()
            bench.feed(b"#MISN\r")
            bench.run_for(DRIVE_S)
        begin = bench.clock.now
        with recorded(folder / "waves.trace", bench, ("kernel", "pins", "spi")):
            bench.run_for(WAVES_S)
        export(read(folder / "drive.trace"), folder / "drive.mcap")
        for suffix in ("vcd", "pftrace", "txt"):
            export(read(folder / "waves.trace"), folder / f"waves.{suffix}")
        figure = Figure(figsize=(13, 8), layout="constrained")
        grid = figure.add_gridspec(2, 2, width_ratios=(3, 2))
        begin_ns = begin * 5
        _waves(figure.add_subplot(grid[0, 0]), VCDVCD(str(folder / "waves.vcd")), begin_ns)
        _tasks(figure.add_subplot(grid[1, 0]), (folder / "waves.pftrace").read_bytes(), begin_ns)
        with open(folder / "drive.mcap", "rb") as content:
            messages = [(channel.topic, m.data) for _, channel, m in SeekingReader(content).iter_messages()]
        _path(figure.add_subplot(grid[0, 1]), messages)
        _text(figure.add_subplot(grid[1, 1]), (folder / "waves.txt").read_text().splitlines())
        figure.savefig(file, dpi=90)


def _waves(axes: Any, found: VCDVCD, begin_ns: int) -> None:
    names = [(pin, s) for pin in reversed(PINS) for s in found.signals if pin in s]
    for row, (_, name) in enumerate(names):
        tv = [(max(time, begin_ns), level) for time, level in found[name].tv if "x" not in level]
        if found[name].size != "1":  # a word: where it changes
            for time, level in tv:
                axes.text((time - begin_ns) / 1e6, row + 0.2, f"|{int(level, 2):02X}", fontsize=8)
            continue
        times = [*(time for time, _ in tv), begin_ns + WAVES_S * 1e9]
        levels = [row + 0.7 * int(level) for _, level in tv]
        axes.step([(time - begin_ns) / 1e6 for time in times], [*levels, levels[-1]], where="post", linewidth=0.8)
    axes.set_yticks([row + 0.35 for row in range(len(names))], [pin for pin, _ in names])
    axes.set_xlim(0, WAVES_S * 1e3)
    axes.set_ylim(-0.2, len(names))
    axes.set_title("waves.vcd, read by vcdvcd", fontsize="medium")
    axes.set_xlabel("ms")


def _tasks(axes: Any, content: bytes, begin_ns: int) -> None:
    tracks: dict[int, str] = {}
    opened: dict[int, int] = {}
    spans: dict[str, list[tuple[float, float]]] = {}
    for _, packet in fields(content):
        inside = dict(fields(_bytes(packet)))
        if 60 in inside:
            described = dict(fields(_bytes(inside[60])))
            tracks[_number(described[1])] = _bytes(described.get(2, b"")).decode()
        elif 11 in inside:
            event = dict(fields(_bytes(inside[11])))
            track, time = _number(event[11]), _number(inside[8])
            if event[9] == 1:
                opened[track] = time
            elif event[9] == 2 and track in opened:
                since = opened.pop(track)
                spans.setdefault(tracks[track], []).append(((since - begin_ns) / 1e6, (time - since) / 1e6))
    names = sorted(name for name in spans if name.startswith("Task"))
    for row, name in enumerate(reversed(names)):
        axes.broken_barh([(a, max(d, 0.002)) for a, d in spans[name]], (row - 0.35, 0.7))
    axes.set_yticks(range(len(names)), list(reversed(names)))
    axes.set_xlim(0, WAVES_S * 1e3)
    axes.set_title("waves.pftrace, read by the field numbers of Perfetto's protocol", fontsize="medium")
    axes.set_xlabel("ms")


def _path(axes: Any, messages: Iterable[tuple[str, bytes]]) -> None:
    paths: dict[str, list[tuple[float, float]]] = {}
    for topic, data in messages:
        if topic.startswith("/pose/"):
            place = json.loads(data)["pose"]["position"]
            paths.setdefault(topic, []).append((place["x"], place["y"]))
    for topic, points in sorted(paths.items()):
        axes.plot(*zip(*points, strict=True), label=topic)
    axes.set_title("drive.mcap, read by the package of the format", fontsize="medium")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.legend(fontsize="small")


def _text(axes: Any, lines: list[str]) -> None:
    axes.axis("off")
    chosen = [line[:64] for line in lines if " spi " in line or " kernel " in line][:24]
    axes.text(0, 1, "\n".join(chosen), family="monospace", fontsize=7.5, verticalalignment="top")
    axes.set_title("waves.txt", fontsize="medium")


def _bytes(value: int | bytes) -> bytes:
    assert isinstance(value, bytes)
    return value


def _number(value: int | bytes) -> int:
    assert isinstance(value, int)
    return value


if __name__ == "__main__":
    main(Path(sys.argv[1]))
