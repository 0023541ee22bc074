"""Writes a trace as MCAP, for robotics viewers (Foxglove, Lichtblick): poses, sensors, frames, findings.

Messages are JSON with their JSON schema.  Poses and findings have the published schemas `foxglove.PoseInFrame` and
`foxglove.Log`, which viewers show in their 3D and log panels.  The others are plain numbers and texts with their time.

    /pose/true, /pose/odometry      the true pose of the robot, and its odometry, in the frame `floor`
    /sensors/PIN_PART_SIGNAL        volts of a conversion
    /faces/PART_FACE                the value of a face of a part
    /spi/BUS                        words on an SPI bus
    /frames/PIN                     a line of bytes on a serial pin; its time is that of its last byte
    /findings                       the findings of the detectors

Kernel events, pins and registers are not written, because robotics viewers have no panel for them.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from hil.instruments.serial_lines import serial_lines
from hil.instruments.trace_file import NS_PER_CYCLE, RecordedTrace

_NUMBER: Final = {"type": "number"}
_INTEGER: Final = {"type": "integer"}
_TEXT: Final = {"type": "string"}


def _object(**properties: Any) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": list(properties)}


_TIME: Final = _object(sec=_INTEGER, nsec=_INTEGER) | {"title": "time"}
#: The level of a finding in `foxglove.Log`.
_WARNING: Final = 3
#: Matches file and line in the text of a place: `TaskUS (Sonar.c:139:9)`.
_PLACE: Final = re.compile(r"\(([^()]+?):(\d+)")

#: The name of a schema -> its fields.
SCHEMAS: Final[Mapping[str, dict[str, Any]]] = {
    "foxglove.PoseInFrame": _object(
        timestamp=_TIME,
        frame_id=_TEXT,
        pose=_object(
            position=_object(x=_NUMBER, y=_NUMBER, z=_NUMBER),
            orientation=_object(x=_NUMBER, y=_NUMBER, z=_NUMBER, w=_NUMBER),
        ),
    ),
    "foxglove.Log": _object(timestamp=_TIME, level=_INTEGER, message=_TEXT, name=_TEXT, file=_TEXT, line=_INTEGER),
    "hil.Volts": _object(timestamp=_TIME, volts=_NUMBER),
    "hil.Number": _object(timestamp=_TIME, number=_NUMBER),
    "hil.SpiWord": _object(timestamp=_TIME, sent=_INTEGER, received=_INTEGER),
    "hil.Frame": _object(timestamp=_TIME, text=_TEXT),
}

#: Cycle, topic, schema, fields without the time.
_Message = tuple[int, str, str, dict[str, Any]]


def write_mcap(path: str | Path, trace: RecordedTrace) -> None:
    """Write a trace to `path`."""
    from mcap.writer import Writer

    with open(path, "wb") as file:
        writer = Writer(file)
        writer.start(library="c2000-hil")  # its own default names the version of the package
        schemas: dict[str, int] = {}
        channels: dict[str, int] = {}
        for cycles, topic, schema, fields in sorted(_messages(trace), key=lambda message: message[0]):
            if schema not in schemas:
                described = json.dumps({"title": schema} | SCHEMAS[schema]).encode()
                schemas[schema] = writer.register_schema(schema, "jsonschema", described)
            if topic not in channels:
                channels[topic] = writer.register_channel(topic, "json", schemas[schema])
            time_ns = cycles * NS_PER_CYCLE
            seconds, nanoseconds = divmod(time_ns, 10**9)
            message = {"timestamp": {"sec": seconds, "nsec": nanoseconds}} | fields
            writer.add_message(channels[topic], time_ns, json.dumps(message).encode(), time_ns)
        writer.finish()  # type: ignore[no-untyped-call]


def _topic(channel: str, name: str) -> str:
    """A topic, in which characters that viewers would split at are replaced."""
    return f"/{channel}/{re.sub(r'[^A-Za-z0-9_]+', '_', name)}"


def _messages(trace: RecordedTrace) -> Iterator[_Message]:
    for cycles, channel, name, value in trace.events:
        match channel:
            case "pose":
                yield cycles, _topic("pose", name), "foxglove.PoseInFrame", _pose(*value)
            case "adc":
                yield cycles, _topic("sensors", name), "hil.Volts", {"volts": value}
            case "sensors" | "variables" | "faces":
                yield cycles, _topic(channel, name), "hil.Number", {"number": value}
            case "spi":
                yield cycles, _topic("spi", name), "hil.SpiWord", {"sent": value[0], "received": value[1]}
            case "findings":
                at = _PLACE.search(value["place"])
                yield cycles, "/findings", "foxglove.Log", {
                    "level": _WARNING, "message": value["message"], "name": f"{name} {value['task']}".rstrip(),
                    "file": at[1] if at else "", "line": int(at[2]) if at else 0,
                }  # fmt: skip
    for line in serial_lines(trace):
        yield line.end, _topic("frames", line.pin), "hil.Frame", {"text": line.content.decode("latin-1")}


def _pose(x_m: float, y_m: float, heading_rad: float) -> dict[str, Any]:
    """A pose on the floor.  The heading is a rotation about the vertical axis."""
    return {
        "frame_id": "floor",
        "pose": {
            "position": {"x": x_m, "y": y_m, "z": 0},
            "orientation": {"x": 0, "y": 0, "z": math.sin(heading_rad / 2), "w": math.cos(heading_rad / 2)},
        },
    }
