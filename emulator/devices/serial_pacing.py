"""Characters on a serial line at their exact times, and how a receiver of another speed decodes them.

Modelled: 8N1 frames back to back, fractional bit times without drift, reception at the middle of the receiver's bits.
Not modelled: parity, noise on the line, characters that merge because the speeds differ too much.
Time: one event for each character, at the end of its stop bit.
Sources: asynchronous serial format (TRM SCI chapter describes the same frame).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from emulator.clock import SYSCLK_HZ, Clock, ClockEvent
from emulator.signals import SerialFrame, SerialLine

#: Start bit, eight data bits, stop bit.
FRAME_BITS = 10


class LinePacer:
    """The transmitter of a line: queues bytes and sends them one after the other, `baud` bits a second."""

    __slots__ = ("_baud", "_burst_start", "_clock", "_event", "_line", "_next_baud", "_queue", "_sent")

    def __init__(self, clock: Clock, line: SerialLine, baud: int) -> None:
        if baud <= 0:
            raise ValueError(f"line {line.name}: {baud} baud; expected more than 0")
        self._clock = clock
        self._line = line
        self._baud = self._next_baud = baud
        self._queue: deque[int] = deque()
        self._event: ClockEvent | None = None
        self._burst_start = 0
        self._sent = 0

    @property
    def pending(self) -> int:
        """Bytes whose stop bit has not ended."""
        return len(self._queue)

    @property
    def idle_at(self) -> int:
        """The cycle when the stop bit of the last queued byte ends; now if no byte is queued."""
        return self._edge(self._sent + len(self._queue)) if self._queue else self._clock.now

    def set_baud(self, baud: int) -> None:
        """Set the speed from the next character on.  The character on the line ends at the old speed."""
        if baud <= 0:
            raise ValueError(f"line {self._line.name}: {baud} baud; expected more than 0")
        self._next_baud = baud

    def send(self, data: Iterable[int]) -> None:
        """Append bytes; the first start bit falls now if the line is idle."""
        self._queue.extend(data)
        if self._event is None and self._queue:
            self._restart(self._clock.now)

    def clear(self) -> None:
        """Drop all waiting characters, and the one on the line."""
        self._queue.clear()
        self._clock.cancel(self._event)
        self._event = None

    def _edge(self, frames: int) -> int:
        """The end of the n-th character of the burst, rounded from the exact fraction."""
        return self._burst_start + (2 * frames * FRAME_BITS * SYSCLK_HZ + self._baud) // (2 * self._baud)

    def _restart(self, time: int) -> None:
        self._baud = self._next_baud
        self._burst_start = time
        self._sent = 0
        self._event = self._clock.schedule(self._edge(1), self._stop_bit)

    def _stop_bit(self) -> None:
        end = self._clock.now
        frame = SerialFrame(self._queue.popleft(), self._edge(self._sent), end, SYSCLK_HZ / self._baud)
        self._sent += 1
        # The next character is planned first, so that a listener may queue more.
        self._event = None
        if self._queue:
            if self._next_baud != self._baud:
                self._restart(end)
            else:
                self._event = self._clock.schedule(self._edge(self._sent + 1), self._stop_bit)
        self._line.send(frame)


def received(frame: SerialFrame, bit_cycles: float) -> tuple[int, bool]:
    """The byte that a receiver with its own bit time decodes from a frame, and whether the stop bit was high.

    It samples the middle of each bit, counted from the start bit's edge.  After the frame the line is idle (high).
    """
    ratio = bit_cycles / frame.bit_cycles
    if frame.data_bits == 8 and frame.parity is None and 0.98 < ratio < 1.02:
        return frame.data, not frame.framing_error
    wave = frame.data & ((1 << frame.data_bits) - 1)
    if frame.parity is not None:
        ones = wave.bit_count() & 1
        wave |= (ones ^ (frame.parity == "odd")) << frame.data_bits
    stop_at = 1 + frame.data_bits + (frame.parity is not None)
    wave = wave << 1 | (0 if frame.framing_error else 1) << stop_at | -1 << (stop_at + 1)
    byte = 0
    for bit in range(8):
        byte |= (wave >> int((bit + 1.5) * ratio) & 1) << bit
    return byte, bool(wave >> int(9.5 * ratio) & 1)
