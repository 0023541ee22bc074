"""The base class of the bench's serial ports, through which a PC program uses the robot's line.

A port never blocks.  `transmit` sends as many bytes as the other side accepts, and keeps the rest in a bounded buffer.
`receive` reads no more bytes than the line has room for.  So a program that writes faster than the line fills the
operating system's buffer and has to wait, as at a real port.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence

from hil.serial_port.frames import DEFAULT_KEEP, Counters, Delivery, OutboundQueue


class SerialPort(ABC):
    """The PC's side of the robot's serial line."""

    #: The device name or pyserial URL that a PC program opens.
    address: str

    def __init__(self, *, keep: int = DEFAULT_KEEP, deliver: Delivery = Delivery.FRAMES) -> None:
        self.counters = Counters()
        self.outbound = OutboundQueue(self.counters, keep=keep, deliver=deliver)
        #: Bytes in transit: taken from the buffer, but not accepted by the system yet.
        self._transit = b""

    def robot_sent(self, byte: int, end_cycles: int) -> None:
        """Take in a byte of the robot, at the end of its stop bit."""
        self.outbound.push(byte, end_cycles)

    def transmit(self, now_cycles: int) -> None:
        """Send the bytes that became visible up to now, as far as the other side accepts them."""
        self.outbound.settle(now_cycles)
        while True:
            if not self._transit:
                if not self._ready_for_more():
                    return
                piece = self.outbound.take()
                if not piece:
                    return
                self._transit = self._encode(piece)
            accepted = self._write(self._transit)
            if accepted < 0:
                self.outbound.count_dropped(self._transit)
                self._transit = b""
            if accepted <= 0:
                return
            self.counters.bytes_delivered += accepted
            self._transit = self._transit[accepted:]

    def receive(self, room: int) -> bytes:
        """At most `room` bytes from the PC; b"" if there are none."""
        if room <= 0:
            return b""
        data = self._read(room)
        self.counters.bytes_to_robot += len(data)
        return data

    @abstractmethod
    def wait_fds(self) -> Sequence[int]:
        """The file descriptors that are readable when `receive` has something to do."""

    @abstractmethod
    def close(self) -> None:
        """Release everything.  A second call does nothing."""

    def _ready_for_more(self) -> bool:
        return True

    def _encode(self, piece: bytes) -> bytes:
        return piece

    @abstractmethod
    def _write(self, data: bytes) -> int:
        """Write without waiting.  Returns how many bytes were accepted, or -1 if nobody is connected any more."""

    @abstractmethod
    def _read(self, room: int) -> bytes:
        """Read without waiting."""
