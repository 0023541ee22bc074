"""Writes a trace for Perfetto (ui.perfetto.dev).

Tasks, interrupts and Swis are tracks, and priorities are counters.  A flow leads from a task that waits at a gate to
the task that holds it.  Bytes and findings are instants.  Orders and frames have a track for each pin.  Volts, sensors
and variables are counters.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from hil.instruments.serial_lines import serial_lines
from hil.instruments.timeline import TaskState, spans
from hil.instruments.trace_file import NS_PER_CYCLE, RecordedTrace

#: One sequence of packets is enough: they are written in the order of time.
_SEQUENCE: Final = 1
_PROCESS: Final = 1


def write_perfetto(path: str | Path, trace: RecordedTrace) -> None:
    """Write a trace to `path`."""
    with open(path, "wb") as file:
        file.write(_PerfettoBuilder(trace).serialized())


class _PerfettoBuilder:
    def __init__(self, trace: RecordedTrace) -> None:
        from perfetto.protos.perfetto.trace.perfetto_trace_pb2 import TrackEvent
        from perfetto.trace_builder.proto_builder import TraceProtoBuilder

        self._trace = trace
        self._kinds: Any = TrackEvent
        self._builder = TraceProtoBuilder()
        self._tracks: dict[str, int] = {}
        #: The time, the order at equal times, and the packet.
        self._packets: list[tuple[int, int, dict[str, Any]]] = []
        process = self._builder.add_packet()
        process.track_descriptor.uuid = _PROCESS
        process.track_descriptor.process.pid = 1
        process.track_descriptor.process.process_name = "F28377S"

    def serialized(self) -> bytes:
        """The bytes of the file."""
        kernel = [(c, name, value) for c, channel, name, value in self._trace.events if channel == "kernel"]
        self._tasks(kernel)
        self._priorities(kernel)
        self._gates(kernel)
        self._instants()
        for time, _, fields in sorted(self._packets, key=lambda packet: packet[:2]):
            packet = self._builder.add_packet()
            packet.timestamp = time * NS_PER_CYCLE
            packet.trusted_packet_sequence_id = _SEQUENCE
            event = packet.track_event
            event.type, event.track_uuid = fields["type"], fields["track"]
            if "name" in fields:
                event.name = fields["name"]
            if "counter" in fields:
                event.counter_value = fields["counter"]
            if "number" in fields:
                event.double_counter_value = fields["number"]
            event.flow_ids.extend(fields.get("flows", ()))
            for name, text in fields.get("annotations", {}).items():
                annotation = event.debug_annotations.add()
                annotation.name, annotation.string_value = name, text
        serialized: bytes = self._builder.serialize()
        return serialized

    def _track(self, name: str, *, counter: bool = False) -> int:
        """The track called `name`.  Its first use writes its description."""
        known = self._tracks.get(name)
        if known is None:
            known = self._tracks[name] = _PROCESS + 1 + len(self._tracks)
            descriptor = self._builder.add_packet().track_descriptor
            descriptor.uuid, descriptor.parent_uuid, descriptor.name = known, _PROCESS, name
            if counter:
                descriptor.counter.SetInParent()
        return known

    def _add(self, cycles: int, order: int, kind: str, track: int, **fields: Any) -> None:
        self._packets.append((cycles, order, {"type": getattr(self._kinds, f"TYPE_{kind}"), "track": track, **fields}))

    def _slice(self, track: int, begin: int, end: int, name: str, **fields: Any) -> None:
        # At one cycle, ends come before beginnings.
        self._add(begin, 1, "SLICE_BEGIN", track, name=name, **fields)
        self._add(end, 0, "SLICE_END", track)

    def _tasks(self, kernel: list[tuple[int, str, str]]) -> None:
        for span in spans(kernel, {}, self._trace.end):
            name = "running" if span.state is TaskState.RUNNING else span.state.value
            self._slice(self._track(span.lane), span.begin, span.end, name)

    def _priorities(self, kernel: list[tuple[int, str, str]]) -> None:
        for cycles, kind, name in kernel:
            if kind == "priority":
                task, _, priority = name.partition("=")
                if priority.lstrip("-").isdigit():
                    track = self._track(f"priority of {task}", counter=True)
                    self._add(cycles, 2, "COUNTER", track, counter=int(priority))

    def _gates(self, kernel: list[tuple[int, str, str]]) -> None:
        current = ""
        holders: dict[str, tuple[str, int]] = {}
        waiting: dict[str, list[tuple[int, str]]] = {}
        flow = 0
        for cycles, kind, name in kernel:
            match kind:
                case "switch":
                    current = name
                case "gate enter":
                    holders[name] = (current, cycles)
                case "gate wait":
                    flow += 1
                    waiting.setdefault(name, []).append((flow, current))
                    self._add(cycles, 3, "INSTANT", self._track(current), name=f"waits for {name}", flows=(flow,))
                case "gate leave":
                    holder, begin = holders.pop(name, (current, cycles))
                    flows = tuple(number for number, _ in waiting.pop(name, ()))
                    track = self._track(f"gate {name}")
                    self._slice(track, begin, cycles, holder, flows=flows)

    def _instants(self) -> None:
        for cycles, channel, name, value in self._trace.events:
            if channel == "findings":
                annotations: Mapping[str, str] = {key: str(text) for key, text in value.items()}
                self._add(cycles, 3, "INSTANT", self._track("findings"), name=name, annotations=annotations)
            elif channel in ("adc", "sensors", "variables", "faces"):
                # The input of a sensor and the face of its part have the same name.
                track = self._track(f"face {name}" if channel == "faces" else name, counter=True)
                self._add(cycles, 2, "COUNTER", track, number=float(value))
            elif channel == "serial":
                self._add(cycles, 3, "INSTANT", self._track(f"serial {name}"), name=_character(value))
        for line in serial_lines(self._trace):
            text = line.content.decode("latin-1").strip()
            self._slice(self._track(f"orders and frames {line.pin}"), line.begin, max(line.end, line.begin + 1), text)


def _character(byte: int) -> str:
    return chr(byte) if 0x20 < byte < 0x7F else f"{byte:#04x}"
