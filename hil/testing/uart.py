"""The other end of a serial line.  It sends bytes at the baud rate, and keeps the bytes that the firmware sends.

A character without a stop bit (because of another baud rate) is not received; it is counted in `framing_errors`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from emulator.clock import SYSCLK_HZ
from emulator.devices.serial_pacing import LinePacer, received
from emulator.signal import Signal
from emulator.signals import SerialFrame
from hil.board import Board


class Uart:
    """A peer at the pins `tx_gpio` (the chip's transmitter) and `rx_gpio` (its receiver), 8N1 at `baud` bits a second.

    Raises ValueError for pins that no SCI can use, and for a baud rate of 0.
    """

    def __init__(self, board: Board, tx_gpio: int, rx_gpio: int, baud: int) -> None:
        for gpio in (tx_gpio, rx_gpio):
            if gpio not in board.serial_pins:
                pins = ", ".join(map(str, sorted(board.serial_pins)))
                raise ValueError(f"no SCI reaches GPIO{gpio}: one of {pins}")
        if baud <= 0:
            raise ValueError(f"uart({tx_gpio}, {rx_gpio}, {baud}): expected more than 0 baud")
        self._clock = board.clock
        self._bit_cycles = SYSCLK_HZ / baud
        self._heard = bytearray()
        self._read = 0
        #: (byte): the end of each character's stop bit.
        self.byte_received: Signal[int] = Signal()
        #: The number of characters without a stop bit.
        self.framing_errors = 0
        pc = board.pc
        if pc is not None and pc[:3] == (tx_gpio, rx_gpio, baud):
            line = pc.line
            self._feed: Callable[[bytes], None] = line.feed
            self._pending: Callable[[], int] = lambda: line.pending_to_robot
        else:
            pacer = LinePacer(board.clock, board.serial_pins[rx_gpio], baud)
            self._feed, self._pending = pacer.send, lambda: pacer.pending
        board.serial_pins[tx_gpio].sent.connect(self._on_frame)

    def send(self, data: bytes, *, gap_s: float = 0.0) -> None:
        """Send bytes, without a gap or with `gap_s` seconds of silence after each."""
        if not gap_s:
            self._feed(data)
            return
        step = round((10 * self._bit_cycles) + gap_s * SYSCLK_HZ)
        for i in range(len(data)):
            self._clock.after(i * step, partial(self._feed, data[i : i + 1]))

    @property
    def pending(self) -> int:
        """The number of bytes in `send` that the chip has not received yet, without those after a gap."""
        return self._pending()

    @property
    def received(self) -> bytes:
        """All bytes that the firmware has sent."""
        return bytes(self._heard)

    @property
    def unread(self) -> bytes:
        """The bytes after the last frame that a trigger has matched."""
        return bytes(self._heard[self._read :])

    def skip(self, count: int) -> None:
        """Mark `count` unread bytes as read."""
        self._read += count

    def _on_frame(self, frame: SerialFrame) -> None:
        byte, stop = received(frame, self._bit_cycles)
        if not stop:
            self.framing_errors += 1
            return
        self._heard.append(byte)
        self.byte_received.emit(byte)
