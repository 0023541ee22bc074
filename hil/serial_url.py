"""The one place where a serial port of this computer is opened: by its name, or by any URL of pyserial."""

from __future__ import annotations

from typing import Final

import serial

#: The robot's line (thesis 2.2.1: 9600 bit/s, 8 data bits, 1 stop bit).
BAUD: Final = 9600


class PortError(ValueError):
    """A port that cannot be opened, or has gone away: one line that says which and what would help."""


def open_url(url: str, *, read_timeout_s: float, write_timeout_s: float) -> serial.Serial:
    """Open `url` at the robot's baud rate; 0 s: never wait.

    pyserial's rfc2217:// cannot limit the time of a write, and says so only after it has connected: there a write
    waits for the network.  Raises PortError.
    """
    limit_s = None if url.lower().startswith("rfc2217:") else write_timeout_s
    try:
        return serial.serial_for_url(url, baudrate=BAUD, timeout=read_timeout_s, write_timeout=limit_s)
    except (OSError, ValueError) as error:  # serial.SerialException is an OSError; ValueError: no such kind of URL
        raise PortError(f"cannot open the serial port {url}: {_reason(error)}") from None


def gone(url: str, error: Exception) -> PortError:
    """A port that was open and has failed."""
    return PortError(f"{url}: the port has gone away ({_reason(error)})")


def _reason(error: Exception) -> str:
    """What the system or pyserial says, in one line."""
    return " ".join((getattr(error, "strerror", None) or str(error) or type(error).__name__).split())
