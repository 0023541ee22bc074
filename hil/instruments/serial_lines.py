"""Bytes on serial pins as lines: what follows each other on a pin up to a carriage return."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from hil.instruments.trace_file import Trace

_END: Final = 0x0D
#: What has no end is cut here.
_LONGEST: Final = 80


@dataclass(frozen=True, slots=True)
class Line:
    """A line: the cycles of its first and of its last byte, the pin, and the bytes."""

    begin: int
    end: int
    pin: str
    content: bytes


def serial_lines(trace: Trace) -> Iterator[Line]:
    """The lines of all serial pins, in the order in which they end; what has no end comes last."""
    held: dict[str, tuple[int, int, bytearray]] = {}
    for cycles, _, pin, byte in trace.of("serial"):
        begin, _, content = held.pop(pin, (cycles, cycles, bytearray()))
        content.append(byte & 0xFF)
        if byte == _END or len(content) >= _LONGEST:
            yield Line(begin, cycles, pin, bytes(content))
        else:
            held[pin] = begin, cycles, content
    for pin, (begin, end, content) in held.items():
        yield Line(begin, end, pin, bytes(content))
