"""A pseudo-terminal, which a program on this machine opens like a serial device.

It is set to raw mode without echo before anybody can open it.  Otherwise the robot would receive its own frames.  The
robot's process keeps the slave open all the time, so programs can open and close it without hanging up the line.

If nobody reads, the operating system would keep the *oldest* 20 KB (minutes of frames) and refuse the newest.  So the
port counts the unread frames through the slave.  If more than `keep` are unread, it takes all of them back and writes
only the newest again.  So a late reader gets the latest frames, whole and in order.  If a reader has read a part of a
frame, the rest of that frame stays in front of them, so a slow reader gets whole frames, too.

Not modelled: the baud rate, parity and modem lines that a program sets (the line is always 9600 8N1).
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import struct
import termios
import tty
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from hil.serial_port.base import SerialPort
from hil.serial_port.frames import DEFAULT_KEEP, Delivery, split_units
from hil.serial_port.link import PortLink
from hil.serial_url import PortError

#: The line discipline reports at most this number of bytes as unread.
KERNEL_READ_BUFFER: Final = 4095


class PtyPort(SerialPort):
    """A raw pseudo-terminal, optionally under a stable name."""

    def __init__(
        self,
        link: str | Path | None = None,
        *,
        keep: int = DEFAULT_KEEP,
        deliver: Delivery = Delivery.FRAMES,
        link_records: Path | None = None,
    ) -> None:
        super().__init__(keep=keep, deliver=deliver)
        try:
            self._master, self._slave = os.openpty()
        except OSError as error:
            raise PortError(f"no pseudo-terminal available ({error.strerror}); use --listen instead") from None
        self._link: PortLink | None = None
        try:
            tty.setraw(self._slave, termios.TCSANOW)
            os.set_blocking(self._master, False)
            os.set_blocking(self._slave, False)
            self.device = os.ttyname(self._slave)
            if link is not None:
                self._link = PortLink(link, self.device, records=link_records)
        except BaseException:
            os.close(self._master)
            os.close(self._slave)
            raise
        self.address = str(link) if link is not None else self.device
        #: The newest bytes written.  They show how many frames are unread.
        self._recent = b""
        self._closed = False

    def wait_fds(self) -> Sequence[int]:
        """The master: readable when a program has written."""
        return (self._master,)

    def unread(self) -> int:
        """The number of unread bytes in the slave, as far as the operating system has passed them on."""
        (count,) = struct.unpack("i", fcntl.ioctl(self._slave, termios.FIONREAD, b"\0\0\0\0"))
        return int(count)

    def transmit(self, now_cycles: int) -> None:
        """Send frames, and keep only the newest of those that nobody has read."""
        # A program that claimed the terminal for itself (TIOCEXCL) and left would lock everybody out, because
        # the slave is never closed for good.
        with contextlib.suppress(OSError):
            fcntl.ioctl(self._slave, termios.TIOCNXCL)
        super().transmit(now_cycles)

    def close(self) -> None:
        """Remove the link and close both ends."""
        if self._closed:
            return
        self._closed = True
        if self._link is not None:
            self._link.close()
        os.close(self._master)
        os.close(self._slave)

    def _ready_for_more(self) -> bool:
        if not self.outbound.has_piece:
            return False
        unread = self.unread()
        if unread and self._recent[-unread:].count(b"\r") >= self.outbound.keep:
            self._reclaim()
        return True

    def _reclaim(self) -> None:
        """Take back all unread bytes and write the newest frames again, with room for one more."""
        taken = b""
        while chunk := self._steal():
            taken += chunk
        units = split_units(taken)
        # A reader has read the beginning of the first frame, and waits for its end.
        begun = units[:1] if units and not units[0].startswith(b"#") else []
        whole = units[len(begun) :]
        surplus = max(0, sum(unit.endswith(b"\r") for unit in whole) - (self.outbound.keep - 1))
        for unit in whole[:surplus]:
            self.outbound.count_dropped(unit)
            self.counters.bytes_delivered -= len(unit)
        rest = b"".join(begun + whole[surplus:])
        self._recent = b""
        written = self._put(rest)
        if written < len(rest):  # cannot be: the buffer was just emptied; counted rather than assumed
            self.counters.bytes_dropped += len(rest) - written

    def _steal(self) -> bytes:
        try:
            return os.read(self._slave, 65536)
        except BlockingIOError:
            return b""

    def _put(self, data: bytes) -> int:
        try:
            count = os.write(self._master, data) if data else 0
        except BlockingIOError:
            return 0
        self._recent = (self._recent + data[:count])[-KERNEL_READ_BUFFER:]
        return count

    def _write(self, data: bytes) -> int:
        return self._put(data)

    def _read(self, room: int) -> bytes:
        try:
            return os.read(self._master, room)
        except BlockingIOError:
            return b""
