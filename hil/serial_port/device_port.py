"""An existing serial device by name: a com0com pair on Windows, a USB adapter with a real XBee, any pyserial URL.

The device's own driver buffers what is written; no more than a frame is given to it ahead of the line where the
driver tells how much waits, so that old frames are dropped here, whole, and not there.
"""

from __future__ import annotations

import os
import select
from collections.abc import Sequence
from typing import Final

import serial

from hil.serial_port.base import PortError, SerialPort
from hil.serial_port.frames import DEFAULT_KEEP, Deliver

#: The robot's line (thesis 2.2.1: 9600 bit/s, 8 data bits, 1 stop bit).
BAUD: Final = 9600
#: A frame is at most 48 bytes ("#ODO " and six 16-bit integers): one may wait in the driver.
MOST_IN_DRIVER: Final = 48


class DevicePort(SerialPort):
    """A serial device of this computer, opened with pyserial and never waited for."""

    def __init__(self, device: str, *, keep: int = DEFAULT_KEEP, deliver: Deliver = Deliver.FRAMES) -> None:
        """Open `device`.  Raises PortError if that is not possible."""
        super().__init__(keep=keep, deliver=deliver)
        try:
            try:
                self._serial = serial.serial_for_url(device, baudrate=BAUD, timeout=0, write_timeout=0)
            except NotImplementedError:  # rfc2217:// has no limit on writing
                self._serial = serial.serial_for_url(device, baudrate=BAUD, timeout=0)
        except (serial.SerialException, OSError, ValueError) as error:
            raise PortError(f"cannot open the serial device {device}: {error}") from None
        self.address = device

    def wait_fds(self) -> Sequence[int]:
        """The device where the system can wait for it (not on Windows)."""
        fd = self._fd()
        return () if fd is None else (fd,)

    def close(self) -> None:
        """Close the device."""
        self._serial.close()

    def _fd(self) -> int | None:
        """A descriptor that `select` takes, or None: Windows and URLs without one."""
        if os.name != "posix" or not self._serial.is_open:
            return None
        try:
            return int(self._serial.fileno())
        except (OSError, AttributeError, ValueError):
            return None

    def _ready_for_more(self) -> bool:
        try:
            return int(self._serial.out_waiting) <= MOST_IN_DRIVER
        except (OSError, AttributeError, NotImplementedError):
            return True  # the driver does not tell

    def _write(self, data: bytes) -> int:
        fd = self._fd()
        # pyserial would spin on a full driver; so ask first.
        if fd is not None and not select.select([], [fd], [], 0)[1]:
            return 0
        try:
            return int(self._serial.write(data) or 0)
        except serial.SerialTimeoutException:
            return 0
        except OSError as error:
            raise PortError(f"{self.address}: the device has gone away ({error})") from None

    def _read(self, room: int) -> bytes:
        try:
            return bytes(self._serial.read(room))
        except (OSError, TypeError) as error:
            raise PortError(f"{self.address}: the device has gone away ({error})") from None
