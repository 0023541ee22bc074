"""An existing serial device by name: a com0com pair on Windows, a USB adapter with a real XBee, any pyserial URL.

The driver of the device buffers what is written.  If it reports how many bytes wait, it gets at most one frame more
than the line has sent.  So old frames are dropped here as whole frames, and not in the driver.
"""

from __future__ import annotations

import io
import os
import select
from collections.abc import Sequence
from typing import Final

import serial

from hil.serial_port.base import SerialPort
from hil.serial_port.frames import DEFAULT_KEEP, Delivery
from hil.serial_url import gone, open_url

#: One frame may wait in the driver.  A frame is at most 48 bytes long ("#ODO " and six 16-bit integers).
MAX_IN_DRIVER: Final = 48


class DevicePort(SerialPort):
    """A serial device of this computer, opened with pyserial.  No call waits for it."""

    def __init__(self, device: str, *, keep: int = DEFAULT_KEEP, deliver: Delivery = Delivery.FRAMES) -> None:
        """Open `device`.  Raises PortError if that is not possible."""
        super().__init__(keep=keep, deliver=deliver)
        self._serial = open_url(device, read_timeout_s=0, write_timeout_s=0)
        self.address = device

    def wait_fds(self) -> Sequence[int]:
        """The device, if the system can wait for it: not on Windows, and not for an rfc2217:// or loop:// URL."""
        fd = self._fd()
        return () if fd is None else (fd,)

    def close(self) -> None:
        """Close the device."""
        self._serial.close()

    def _fd(self) -> int | None:
        """A descriptor for `select`, if there is one."""
        if os.name != "posix" or not self._serial.is_open:
            return None
        try:
            return int(self._serial.fileno())
        except io.UnsupportedOperation:
            return None

    def _ready_for_more(self) -> bool:
        try:
            return int(getattr(self._serial, "out_waiting", 0)) <= MAX_IN_DRIVER  # URLs do not tell
        except OSError:
            return True  # gone: the write says so

    def _write(self, data: bytes) -> int:
        fd = self._fd()
        # pyserial would spin while the driver is full; so ask first.
        if fd is not None and not select.select([], [fd], [], 0)[1]:
            return 0
        try:
            return int(self._serial.write(data) or 0)
        except serial.SerialTimeoutException:
            return 0
        except OSError as error:
            raise gone(self.address, error) from None

    def _read(self, room: int) -> bytes:
        try:
            return bytes(self._serial.read(room))
        except (OSError, TypeError) as error:
            raise gone(self.address, error) from None
