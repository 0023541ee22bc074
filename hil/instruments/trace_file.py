"""The trace file: what a run did, an event a line.

    {"hil_trace": 1, "cycles_per_second": 200000000, "channels": ["kernel", "pins"], "about": {"world": "room"}}
    [200001234, "kernel", "switch", "TaskUS"]
    [200001300, "pins", "GPIO69 sonars.start", 1]

JSON Lines: the first line says what the file is, each other one is an event: its cycle, its channel, its name, its
value.  Events of ticks that found the CPU idle are told afterwards, so the order of lines is not that of time: `read`
sorts.  A run that was killed leaves a file whose last line may be cut off; it is left out.
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
#: Longest line that is read.
_LONGEST: Final = 1_000_000

#: Cycle, channel, name, value.
Event = tuple[int, str, str, Any]

#: Between two looks at what does not tell by itself that it has changed.
SAMPLE_CYCLES: Final = 50 * CYCLES_PER_MS
#: Names of `RecordedTrace.about`: the pins of a line to a PC.
TO_PC: Final = "pin to the PC"
FROM_PC: Final = "pin from the PC"

#: Channel -> what it holds: the name of its events, and their value.
CHANNELS: Final = {
    "kernel": "task switches, ready, block, gates, Hwis, Swis, priorities (kind; name)",
    "pins": "levels of the pins that parts are soldered to (pin and part; 0 or 1)",
    "adc": "conversions of the pins that parts are soldered to (pin and part; volts)",
    "sensors": "what gyros, encoders and bumpers see, fed or not: hil.feeds reads it again (input; its number)",
    "spi": "words on SPI buses (bus; [sent, received])",
    "serial": "bytes on serial pins (pin; byte)",
    "registers": "writes of the CPU to registers (block.register; word)",
    "variables": "variables of the firmware at file scope, looked at every millisecond (module.name; its number)",
    "findings": "what the detectors found (rule; message, place, task)",
    "pose": "where the robot is and where it believes to be (true or odometry; [x_m, y_m, heading_rad])",
    "scene": "the robot in its world and what its sonars say, looked at every 50 ms (name; hil/instruments/scene.py)",
    "faces": "what the parts of the board see and do, looked at every 50 ms and at the end (part.face; its number)",
}
#: Channels whose values are several numbers: what each of them is.
PARTS: Final = {"spi": ("sent", "received"), "pose": ("x_m", "y_m", "heading_rad")}
#: What is written if nobody says which: what costs little.  Pins have every edge of a motor's PWM.
DEFAULT: Final = ("kernel", "serial", "findings", "pose", "scene", "faces")


@dataclass(frozen=True, slots=True)
class RecordedTrace:
    """A trace that was read: its channels, and its events in the order of time."""

    channels: tuple[str, ...]
    events: list[Event]
    #: What ran, in words: `world`, `seed`, ...; of a line to a PC its pins (`TO_PC`, `FROM_PC`).
    about: Mapping[str, str] = field(default_factory=dict)

    @property
    def end(self) -> int:
        """The cycle of the last event."""
        return self.events[-1][0] if self.events else 0

    def of(self, *channels: str) -> Iterable[Event]:
        """The events of some channels."""
        return (event for event in self.events if event[1] in channels)

    def only(self, channels: Iterable[str]) -> RecordedTrace:
        """The same with some of its channels.  Raises ValueError for one that it does not have."""
        wanted = checked(channels)
        missing = set(wanted) - set(self.channels)
        if missing:
            raise ValueError(f"not recorded: {', '.join(sorted(missing))}; recorded are {', '.join(self.channels)}")
        return RecordedTrace(wanted, list(self.of(*wanted)), self.about)


class TraceWriter:
    """Writes a trace: each event at once."""

    def __init__(
        self, file: TextIO | GrowingFile, channels: Iterable[str], about: Mapping[str, str] | None = None
    ) -> None:
        self._file = file
        header: dict[str, Any] = {"hil_trace": VERSION, "cycles_per_second": SYSCLK_HZ, "channels": list(channels)}
        if about:
            header["about"] = dict(about)
        file.write(json.dumps(header) + "\n")

    def event(self, cycles: int, channel: str, name: str, value: Any) -> None:
        """One line."""
        self._file.write(json.dumps((cycles, channel, name, value), separators=(",", ":")) + "\n")


def checked(channels: Iterable[str]) -> tuple[str, ...]:
    """Names of channels, in their order; `all` means all.  Raises ValueError for one that there is not."""
    wanted = list(channels)
    for name in wanted:
        if name not in CHANNELS and name != "all":
            raise ValueError(f"no channel {name!r}: expected all, or some of {', '.join(CHANNELS)}")
    return tuple(CHANNELS) if "all" in wanted else tuple(name for name in CHANNELS if name in wanted)


def read(path: str | Path) -> RecordedTrace:
    """A trace file.  Raises ValueError, with the line, for what is none; OSError."""
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
        case [int() as cycles, str() as channel, str() as name, value] if cycles >= 0 and _fits(channel, name, value):
            return cycles, channel, name, value
    raise ValueError(f"{where}: expected [cycle, channel, name, value] as in the reference of the trace file")


def _fits(channel: str, name: str, value: Any) -> bool:
    match channel:
        case "kernel":
            return isinstance(value, str)
        case "pins" | "serial" | "registers":
            return isinstance(value, int) and 0 <= value < 2**32
        case "adc" | "sensors" | "variables" | "faces":
            return isinstance(value, int | float)
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
    return isinstance(value, list) and len(value) == count and all(isinstance(item, int | float) for item in value)
