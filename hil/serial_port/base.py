"""What every serial port of the bench is: a place where a PC program meets the robot's line.

A port never blocks.  `transmit` hands over what it can and keeps the rest in a bounded buffer; `receive` reads
no more than the line has room for, so a writer faster than the line fills the kernel's buffer and is held back
there, as at a real port.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence

from hil.serial_port.frames import DEFAULT_KEEP, Counters, Delivery, OutboundQueue


class SerialPort(ABC):
    """The PC's side of the robot's serial line."""

    #: What a PC program opens (a device name or a pyserial URL).
    address: str

    def __init__(self, *, keep: int = DEFAULT_KEEP, deliver: Delivery = Delivery.FRAMES) -> None:
        self.counters = Counters()
        self.outbound = OutboundQueue(self.counters, keep=keep, deliver=deliver)
        #: Bytes in transit: taken from the buffer, not yet accepted by the system.
        self._transit = b""

    def robot_sent(self, byte: int, end_cycles: int) -> None:
        """A byte of the robot, at the end of its stop bit."""
        self.outbound.push(byte, end_cycles)

    def transmit(self, now_cycles: int) -> None:
        """Hand over what became visible up to now, as far as the other side takes it."""
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
        """At most `room` bytes that the PC sent, b"" if none."""
        if room <= 0:
            return b""
        data = self._read(room)
        self.counters.bytes_to_robot += len(data)
        return data

    @abstractmethod
    def wait_fds(self) -> Sequence[int]:
        """File descriptors whose readability means that `receive` has something to do."""

    @abstractmethod
    def close(self) -> None:
        """Give everything back.  Closing twice does nothing."""

    def _ready_for_more(self) -> bool:
        return True

    def _encode(self, piece: bytes) -> bytes:
        return piece

    @abstractmethod
    def _write(self, data: bytes) -> int:
        """Write without waiting; how many bytes were accepted, -1 if the listener is gone."""

    @abstractmethod
    def _read(self, room: int) -> bytes:
        """Read without waiting."""
