"""The robot's line, opened: a device name or any URL of pyserial."""

from __future__ import annotations

from typing import Final

import serial

#: The robot's line (thesis 2.2.1: 9600 bit/s, 8 data bits, 1 stop bit).
BAUD: Final = 9600


def open_line(port: str, *, read_timeout_s: float, write_timeout_s: float) -> serial.Serial:
    """Open `port`; writing has a time limit where pyserial has one (not for rfc2217://).

    Raises ValueError, one line that names the port.
    """
    try:
        try:
            return serial.serial_for_url(port, baudrate=BAUD, timeout=read_timeout_s, write_timeout=write_timeout_s)
        except NotImplementedError:
            return serial.serial_for_url(port, baudrate=BAUD, timeout=read_timeout_s)
    except (serial.SerialException, OSError, ValueError) as error:
        raise ValueError(lost(port, error)) from None


def lost(port: str, error: Exception) -> str:
    """What went wrong with a port, in one line that names it."""
    reason = " ".join((getattr(error, "strerror", None) or str(error) or type(error).__name__).split())
    return reason if port in reason else f"{port}: {reason}"
