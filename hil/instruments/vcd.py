"""Writes a trace as VCD (IEEE 1364, four-state value change dump), for GTKWave and PulseView.  The time base is 1 ns.

Pins are bits; bytes, words and registers are vectors; volts and poses are reals.  A task is a vector: 0 is blocked, 1
ready, 2 running, 3 waiting at a gate.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from hil.instruments.timeline import TaskState, spans
from hil.instruments.trace_file import NS_PER_CYCLE, PARTS, RecordedTrace

_STATES: Final = {TaskState.READY: 1, TaskState.RUNNING: 2, TaskState.WAITING: 3}

#: Cycle, scope, name, type, bits, value.
_Change = tuple[int, str, str, str, int | None, Any]


def write_vcd(path: str | Path, trace: RecordedTrace) -> None:
    """Write a trace to `path`."""
    from vcd import VCDWriter

    changes = sorted((change for change in _changes(trace)), key=lambda change: change[0])
    with open(path, "w", encoding="ascii", errors="replace", newline="\n") as file, VCDWriter(
        file, timescale="1 ns", date="", version="c2000-hil"
    ) as writer:
        variables = {}
        for _, scope, name, kind, bits, value in changes:
            if (scope, name) not in variables:
                unknown = "x" if kind != "real" else float(value)
                variables[scope, name] = writer.register_var(scope, _identifier(name), kind, bits, init=unknown)
        for cycles, scope, name, _, _, value in changes:
            writer.change(variables[scope, name], cycles * NS_PER_CYCLE, value)


def _identifier(name: str) -> str:
    """A name, in which characters that readers of VCD do not accept are replaced."""
    return re.sub(r"[^A-Za-z0-9_.]+", "_", name)


def _changes(trace: RecordedTrace) -> Iterator[_Change]:
    for cycles, channel, name, value in trace.events:
        match channel:
            case "pins":
                yield cycles, "pins", name, "wire", 1, value
            case "serial":
                yield cycles, "serial", name, "reg", 16, value
            case "spi":
                for side, word in zip(PARTS["spi"], value, strict=True):
                    yield cycles, "spi", f"{name} {side}", "reg", 16, word
            case "registers":
                block, _, register = name.partition(".")
                yield cycles, block, register, "reg", 32, value
            case "adc" | "sensors" | "variables" | "faces":
                yield cycles, channel, name, "real", None, float(value)
            case "pose":
                for part, number in zip(PARTS["pose"], value, strict=True):
                    yield cycles, name, part, "real", None, float(number)
    events = [(cycles, name, value) for cycles, channel, name, value in trace.events if channel == "kernel"]
    by_lane: dict[str, list[tuple[int, int, int]]] = {}
    for span in spans(events, {}, trace.end):
        by_lane.setdefault(span.lane, []).append((span.begin, span.end, _STATES[span.state]))
    for lane, found in by_lane.items():
        found.sort()
        yield 0, "tasks", lane, "reg", 2, 0
        for n, (begin, end, state) in enumerate(found):
            yield begin, "tasks", lane, "reg", 2, state
            if n + 1 == len(found) or found[n + 1][0] > end:
                yield end, "tasks", lane, "reg", 2, 0
