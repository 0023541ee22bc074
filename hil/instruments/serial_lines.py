"""Gathers the bytes on serial pins to lines.  A line ends with a carriage return."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from hil.instruments.trace_file import RecordedTrace

_END: Final = 0x0D
#: The most bytes of a line.  A longer one is cut.
_LONGEST: Final = 80


@dataclass(frozen=True, slots=True)
class ReceivedLine:
    """A line: the cycles of its first and of its last byte, the pin, and the bytes."""

    begin: int
    end: int
    pin: str
    content: bytes


class Lines:
    """Gathers the bytes of all pins, which come in the order of time."""

    def __init__(self) -> None:
        self._held: dict[str, tuple[int, int, bytearray]] = {}

    def take(self, cycles: int, pin: str, byte: int) -> ReceivedLine | None:
        """Take in a byte.  Returns the line that it ends, or None."""
        begin, _, content = self._held.pop(pin, (cycles, cycles, bytearray()))
        content.append(byte & 0xFF)
        if byte == _END or len(content) >= _LONGEST:
            return ReceivedLine(begin, cycles, pin, bytes(content))
        self._held[pin] = begin, cycles, content
        return None

    def rest(self) -> Iterator[ReceivedLine]:
        """The lines without an end."""
        for pin, (begin, end, content) in self._held.items():
            yield ReceivedLine(begin, end, pin, bytes(content))


def serial_lines(trace: RecordedTrace) -> Iterator[ReceivedLine]:
    """The lines of all serial pins, in the order of their ends.  Lines without an end come last."""
    lines = Lines()
    for cycles, _, pin, byte in trace.of("serial"):
        line = lines.take(cycles, pin, byte)
        if line is not None:
            yield line
    yield from lines.rest()
