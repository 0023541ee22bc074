"""Bytes on serial pins as lines: what follows each other on a pin up to a carriage return."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from hil.instruments.trace_file import RecordedTrace

_END: Final = 0x0D
#: What has no end is cut here.
_LONGEST: Final = 80


@dataclass(frozen=True, slots=True)
class ReceivedLine:
    """A line: the cycles of its first and of its last byte, the pin, and the bytes."""

    begin: int
    end: int
    pin: str
    content: bytes


class Lines:
    """Bytes of all pins as they come, in the order of time."""

    def __init__(self) -> None:
        self._held: dict[str, tuple[int, int, bytearray]] = {}

    def take(self, cycles: int, pin: str, byte: int) -> ReceivedLine | None:
        """A byte; the line, if it ends one."""
        begin, _, content = self._held.pop(pin, (cycles, cycles, bytearray()))
        content.append(byte & 0xFF)
        if byte == _END or len(content) >= _LONGEST:
            return ReceivedLine(begin, cycles, pin, bytes(content))
        self._held[pin] = begin, cycles, content
        return None

    def rest(self) -> Iterator[ReceivedLine]:
        """What has no end."""
        for pin, (begin, end, content) in self._held.items():
            yield ReceivedLine(begin, end, pin, bytes(content))


def serial_lines(trace: RecordedTrace) -> Iterator[ReceivedLine]:
    """The lines of all serial pins, in the order in which they end; what has no end comes last."""
    lines = Lines()
    for cycles, _, pin, byte in trace.of("serial"):
        line = lines.take(cycles, pin, byte)
        if line is not None:
            yield line
    yield from lines.rest()
