"""The trace file: the events of a run, one in each line.

    {"hil_trace": 1, "cycles_per_second": 200000000, "channels": ["kernel", "pins"], "about": {"world": "room"}}
    [200001234, "kernel", "switch", "TaskUS"]
    [200001300, "pins", "GPIO69 sonars.start", 1]

The format is JSON Lines.  The first line is the head of the file.  Each other line is an event: its cycle, its channel,
its name, its value.  Events of ticks during which the CPU was idle are written later, so the lines are not in the order
of time; `read` sorts them.  If a run was killed, the last line may be cut off; `read` skips it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, TextIO

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ
from hil.files import GrowingFile, opened
from hil.instruments import scene

VERSION: Final = 1
NS_PER_CYCLE: Final = 10**9 // SYSCLK_HZ
#: The longest line that is read, in characters.
_LONGEST: Final = 1_000_000

#: Cycle, channel, name, value.
Event = tuple[int, str, str, Any]

#: The time between two samples of a value that has no signal for its changes.
SAMPLE_CYCLES: Final = 50 * CYCLES_PER_MS
#: The keys of `RecordedTrace.about` for the pins of a line to a PC.
TO_PC: Final = "pin to the PC"
FROM_PC: Final = "pin from the PC"

#: Channel -> its content: the names of its events, and their values.
CHANNELS: Final = {
    "kernel": "task switches, ready, block, gates, Hwis, Swis, priorities (kind; name)",
    "pins": "levels of the pins that parts are soldered to (pin and part; 0 or 1)",
    "adc": "conversions of the pins that parts are soldered to (pin and part; volts)",
    "sensors": "what gyros, encoders and bumpers see, fed or not: hil.feeds reads it again (input; its number)",
    "spi": "words on SPI buses (bus; [sent, received])",
    "serial": "bytes on serial pins (pin; byte)",
    "registers": "writes of the CPU to registers (block.register; word)",
    "variables": "variables of the firmware at file scope, looked at every millisecond (module.name; its number)",
    "findings": "what the detectors found (rule; message, place, task, why the source accepts it)",
    "pose": "where the robot is and where it believes to be (true or odometry; [x_m, y_m, heading_rad])",
    "scene": "the robot in its world and what its sonars say, looked at every 50 ms (name; hil/instruments/scene.py)",
    "faces": "what the parts of the board see and do, looked at every 50 ms and at the end (part.face; its number)",
}
#: The channels whose values are several numbers, with the name of each number.
PARTS: Final = {"spi": ("sent", "received"), "pose": ("x_m", "y_m", "heading_rad")}
#: The channels that are recorded by default, because they cost little.  The channel of pins has every edge of a PWM.
DEFAULT: Final = ("kernel", "serial", "findings", "pose", "scene", "faces")


@dataclass(frozen=True, slots=True)
class RecordedTrace:
    """A trace that was read: its channels, and its events in order of time."""

    channels: tuple[str, ...]
    events: list[Event]
    #: What ran, as text: `world`, `seed`, ...; and the pins of a line to a PC (`TO_PC`, `FROM_PC`).
    about: Mapping[str, str] = field(default_factory=dict)

    @property
    def end(self) -> int:
        """The cycle of the last event."""
        return self.events[-1][0] if self.events else 0

    def of(self, *channels: str) -> Iterable[Event]:
        """The events of some channels."""
        return (event for event in self.events if event[1] in channels)

    def only(self, channels: Iterable[str]) -> RecordedTrace:
        """This trace with only some of its channels.  Raises ValueError for a channel that it does not have."""
        wanted = checked(channels)
        missing = set(wanted) - set(self.channels)
        if missing:
            raise ValueError(f"not recorded: {', '.join(sorted(missing))}; recorded are {', '.join(self.channels)}")
        return RecordedTrace(wanted, list(self.of(*wanted)), self.about)


class TraceWriter:
    """Writes a trace.  Each event is written at once."""

    def __init__(
        self, file: TextIO | GrowingFile, channels: Iterable[str], about: Mapping[str, str] | None = None
    ) -> None:
        self._file = file
        header: dict[str, Any] = {"hil_trace": VERSION, "cycles_per_second": SYSCLK_HZ, "channels": list(channels)}
        if about:
            header["about"] = dict(about)
        file.write(json.dumps(header) + "\n")

    def event(self, cycles: int, channel: str, name: str, value: Any) -> None:
        """Write an event as a line."""
        self._file.write(json.dumps((cycles, channel, name, value), separators=(",", ":")) + "\n")


def checked(channels: Iterable[str]) -> tuple[str, ...]:
    """The names of channels, in the order of `CHANNELS`; `all` means all.  Raises ValueError for an unknown one."""
    wanted = list(channels)
    for name in wanted:
        if name not in CHANNELS and name != "all":
            raise ValueError(f"no channel {name!r}: expected all, or some of {', '.join(CHANNELS)}")
    return tuple(CHANNELS) if "all" in wanted else tuple(name for name in CHANNELS if name in wanted)


def read(path: str | Path) -> RecordedTrace:
    """Read a trace file.  Raises ValueError, with the line, if it is none, and OSError if it cannot be read."""
    with opened(path) as file:
        header = _parsed(file.readline(_LONGEST), f"{path}:1")
        if not isinstance(header, dict) or header.get("hil_trace") != VERSION:
            raise ValueError(f"{path}:1: no trace of `hil run --trace`, version {VERSION}")
        channels = header.get("channels")
        if not isinstance(channels, list) or not all(channel in CHANNELS for channel in channels):
            raise ValueError(f"{path}:1: channels: expected some of {', '.join(CHANNELS)}")
        about = header.get("about", {})
        if not isinstance(about, dict) or not all(isinstance(text, str) for text in about.values()):
            raise ValueError(f"{path}:1: about: expected names and texts")
        events: list[Event] = []
        for number, line in enumerate(iter(lambda: file.readline(_LONGEST), b""), 2):
            if not line.endswith(b"\n"):
                if len(line) >= _LONGEST:
                    raise ValueError(f"{path}:{number}: longer than {_LONGEST} characters: expected one event")
                break  # cut off when the run was killed
            events.append(_event(_parsed(line, f"{path}:{number}"), f"{path}:{number}"))
    events.sort(key=lambda event: event[0])
    return RecordedTrace(tuple(channels), events, about)


def _parsed(line: bytes, where: str) -> Any:
    try:
        return json.loads(line)
    except (ValueError, RecursionError):
        raise ValueError(f"{where}: no JSON: expected a trace of `hil run --trace`") from None


def _event(found: Any, where: str) -> Event:
    match found:
        case [int() as cycles, str() as channel, str() as name, value] if 0 <= cycles < 2**63:
            if _fits(channel, name, value):
                return cycles, channel, name, value
    raise ValueError(f"{where}: expected [cycle, channel, name, value] as in the reference of the trace file")


def _fits(channel: str, name: str, value: Any) -> bool:
    match channel:
        case "kernel":
            return isinstance(value, str)
        case "pins" | "serial" | "registers":
            return isinstance(value, int) and 0 <= value < 2**32
        case "adc" | "sensors" | "variables" | "faces":
            return isinstance(value, float) or scene.is_number(value)
        case "scene":
            return scene.fits(name, value)
        case "spi":
            return _numbers(value, 2) and all(isinstance(word, int) and 0 <= word < 2**16 for word in value)
        case "pose":
            return _numbers(value, 3)
        case "findings":
            return isinstance(value, dict) and all(isinstance(value.get(k), str) for k in ("message", "place", "task"))
    return False


def _numbers(value: Any, count: int) -> bool:
    return isinstance(value, list) and len(value) == count and all(map(scene.is_number, value))
