"""The wire log: both directions of a serial line with their times, as lines of ASCII.

::

    hil-wire 1
    clock virtual
    setup {"seed": 1, "world": "corridor"}
    > 1002350.105 #MISN\\r
    < 1228612.4 #ODO 0,0,0,1922,300,301\\n\\r
    end 60000000 9f2c01aa

* The first line names the format and its version.  Then come optional lines of a key and a text: ``clock`` (``virtual``
  is the exact time of the emulated robot, ``real`` the time of this computer), ``setup`` (JSON that determines an
  emulated run), ``began`` (date and time), ``port``.
* ``>`` marks bytes to the robot, ``<`` bytes from it.  The time is that of the last byte, in microseconds since the log
  began, with up to three decimals, because a cycle is 5 ns.  After one space the bytes follow.  Printable ASCII is
  written as it is; other bytes, the backslash, and a space at the end are written as ``\\r \\n \\t \\\\ \\xNN``.
* Lines are in the order in which they were complete.  So a frame that began before an order may follow it.
* ``end`` has the time at which recording ended, and the CRC-32 of everything before it.  A log without it was cut.
* Empty lines and lines that begin with ``;`` are comments.

A reader takes every line that it can read, and lists the others in `Recording.problems`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import IO, Final
from zlib import crc32

from hil.files import GrowingFile, read_bytes

MAGIC: Final = "hil-wire"
VERSION: Final = 1
#: A record is an order, a frame or a stretch of noise; `wire.py` writes at most 256 bytes, four characters each.
LONGEST_LINE: Final = 8192

_ESCAPES: Final = {0x0A: "\\n", 0x0D: "\\r", 0x09: "\\t", 0x5C: "\\\\"}
_UNESCAPES: Final = {text[1:]: byte for byte, text in _ESCAPES.items()}
_ESCAPED = re.compile(r"\\(x[0-9a-fA-F]{2}|.?)", re.DOTALL)
_TIME: Final = r"(?P<us>\d{1,15})(?:\.(?P<fraction>\d{1,3}))?"
_RECORD = re.compile(rf"(?P<direction>[<>]) {_TIME} (?P<data>[ -~]*)")
_END = re.compile(rf"end {_TIME} (?P<crc>[0-9a-f]{{8}})")
_HEADER = re.compile(r"(?P<key>[a-z][a-z_]*) (?P<text>[ -~]*)")


class Direction(Enum):
    """The direction of bytes."""

    TO_ROBOT = ">"
    FROM_ROBOT = "<"


@dataclass(frozen=True, slots=True)
class Record:
    """Bytes of one direction.  The time is that of the last byte, in nanoseconds since the log began."""

    time_ns: int
    direction: Direction
    data: bytes


@dataclass(slots=True)
class Recording:
    """The readable part of a log."""

    name: str = ""
    header: dict[str, str] = field(default_factory=dict)
    records: list[Record] = field(default_factory=list)
    #: When recording ended, in nanoseconds; None if the log does not say.
    end_ns: int | None = None
    #: Lines that could not be read or are inconsistent, one sentence each.
    problems: list[str] = field(default_factory=list)

    @property
    def duration_ns(self) -> int:
        """The length of the recording in nanoseconds: up to its end, or else up to its last record."""
        last = self.records[-1].time_ns if self.records else 0
        return last if self.end_ns is None else max(last, self.end_ns)

    def stream(self, direction: Direction) -> bytes:
        """All bytes of one direction."""
        return b"".join(record.data for record in self.records if record.direction is direction)

    def statements(self) -> list[str]:
        """What a user must know before trusting the log, one line each; empty for an intact log."""
        return [f"{self.name}: {problem}" for problem in self.problems]


def escape(data: bytes) -> str:
    """Bytes as printable ASCII."""
    text = "".join(_ESCAPES.get(byte) or (chr(byte) if 0x20 <= byte < 0x7F else f"\\x{byte:02x}") for byte in data)
    return text[:-1] + "\\x20" if text.endswith(" ") else text


def unescape(text: str) -> bytes:
    """The bytes of a text that `escape` has made.  Raises ValueError for an invalid escape."""

    def byte(match: re.Match[str]) -> str:
        code = match[1]
        if len(code) == 3:
            return chr(int(code[1:], 16))
        if code not in _UNESCAPES:
            raise ValueError(f"{match[0]!r} is not an escape")
        return chr(_UNESCAPES[code])

    return _ESCAPED.sub(byte, text).encode("latin-1")


def format_time(time_ns: int) -> str:
    """Nanoseconds as microseconds with as many decimals as needed."""
    us, rest = divmod(time_ns, 1000)
    return f"{us}.{rest:03d}".rstrip("0") if rest else str(us)


class LogWriter:
    """Writes a log line by line.  So the log has everything up to a crash."""

    def __init__(self, file: IO[str] | GrowingFile, header: Mapping[str, str]) -> None:
        self._file = file
        self._crc = 0
        self._line(f"{MAGIC} {VERSION}")
        for key, text in header.items():
            self._line(f"{key} {' '.join(text.split())}".encode("ascii", "backslashreplace").decode())

    def write(self, record: Record) -> None:
        """Append a record."""
        self._line(f"{record.direction.value} {format_time(record.time_ns)} {escape(record.data)}")

    def end(self, time_ns: int) -> None:
        """Write the end of the log."""
        self._line(f"end {format_time(time_ns)} {self._crc:08x}")

    def _line(self, text: str) -> None:
        line = text + "\n"
        self._crc = crc32(line.encode("ascii"), self._crc)
        self._file.write(line)
        self._file.flush()


def read_log(path: Path) -> Recording:
    """Read a wire log.  Raises ValueError if the file is no wire log, OSError if it cannot be read."""
    return parse_log(read_bytes(path), str(path))


def parse_log(data: bytes, name: str) -> Recording:
    """Parse the bytes of a log.  Raises ValueError if they are no log of this version."""
    lines = data.split(b"\n")
    _check_first(lines[0], name)
    recording = Recording(name)
    unfinished = lines.pop()  # what follows the last line feed
    crc = crc32(lines[0] + b"\n") if lines else 0
    unreadable: list[str] = []
    for number, raw in enumerate(lines[1:], 2):
        complaint = _take(raw, recording, crc)
        crc = crc32(raw + b"\n", crc)
        if complaint:
            unreadable.append(f"line {number} {complaint}")
    if unfinished.strip():
        unreadable.append(f"line {len(lines) + 1} is cut")
    if unreadable:
        more = f" and {len(unreadable) - 1} more" if len(unreadable) > 1 else ""
        recording.problems.insert(0, f"{unreadable[0]}{more}: left out")
    if recording.end_ns is None:
        count = len(recording.records)
        plural = "" if count == 1 else "s"
        recording.problems.append(f"is cut off: it has no end record; used is what precedes ({count} record{plural})")
    recording.records.sort(key=lambda record: record.time_ns)
    return recording


def _check_first(line: bytes, name: str) -> None:
    words = line[:LONGEST_LINE].decode("ascii", "replace").split()
    if len(words) != 2 or words[0] != MAGIC:
        raise ValueError(f"{name}: not a wire log (the first line would be '{MAGIC} {VERSION}')")
    if words[1] != str(VERSION):
        raise ValueError(f"{name}: is a wire log of version {words[1][:20]}; this program reads version {VERSION}")


def _take(raw: bytes, recording: Recording, crc: int) -> str:
    """Add the content of a line to `recording`.  Returns what is wrong with the line, or ""."""
    if len(raw) > LONGEST_LINE:
        return "is too long"
    line = raw.removesuffix(b"\r").decode("latin-1")
    if not line or line.startswith(";"):
        return ""
    if recording.end_ns is not None:
        return "comes after the end"
    if match := _RECORD.fullmatch(line):
        try:
            data = unescape(match["data"])
        except ValueError as error:
            return f"is damaged ({error})"
        recording.records.append(Record(_time_ns(match), Direction(match["direction"]), data))
    elif match := _END.fullmatch(line):
        recording.end_ns = _time_ns(match)
        if int(match["crc"], 16) != crc:
            recording.problems.append("was changed since it was recorded (the checksum at its end does not match)")
    elif (match := _HEADER.fullmatch(line)) and not recording.records and match["key"] != "end":
        recording.header.setdefault(match["key"], match["text"])
    else:
        return "is damaged"
    return ""


def _time_ns(match: re.Match[str]) -> int:
    return int(match["us"]) * 1000 + int((match["fraction"] or "0").ljust(3, "0"))
