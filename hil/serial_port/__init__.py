"""The ports through which PC programs use the robot's serial line.

base.py      a port                    frames.py        gathers frames, and drops the oldest whole ones
pty_port.py  pseudo-terminal           link.py          its stable name
tcp_port.py  pyserial's socket://      rfc2217_port.py  pyserial's rfc2217://
device_port.py  an existing device
"""

from __future__ import annotations

import os
import re

from hil.serial_port.base import SerialPort
from hil.serial_port.frames import DEFAULT_KEEP, Counters, Delivery, OutboundQueue
from hil.serial_url import PortError

__all__ = [
    "DEFAULT_KEEP",
    "Counters",
    "Delivery",
    "OutboundQueue",
    "PortError",
    "SerialPort",
    "check_choice",
    "open_port",
]

_LISTEN = re.compile(r"(?P<scheme>tcp|socket|rfc2217)://(?P<host>\[[^\]]*\]|[^:/]*):(?P<port>\d{1,5})/?")


def check_choice(*, link: str | None = None, listen: str | None = None, device: str | None = None) -> None:
    """Raise PortError for options that no system can fulfil.  Nothing is opened."""
    if sum(choice is not None for choice in (link, listen, device)) > 1:
        raise PortError("choose one of --link, --listen and --port")
    if link == "" or device == "":
        raise PortError("the name of a port must not be empty")
    if listen is not None:
        _parse_listen(listen)
    elif device is None and os.name != "posix":
        raise PortError("no pseudo-terminals on this system: give --port NAME (com0com) or --listen tcp://:PORT")


def open_port(
    *,
    link: str | None = None,
    listen: str | None = None,
    device: str | None = None,
    keep: int = DEFAULT_KEEP,
    deliver: Delivery = Delivery.FRAMES,
) -> SerialPort:
    """Open the port that the command line selects.  Without a selection, it is a pseudo-terminal.

    `link` names a pseudo-terminal, `listen` is ``tcp://HOST:PORT`` or ``rfc2217://HOST:PORT`` (without HOST:
    loopback), `device` an existing serial device.  Raises PortError, a ValueError with one clear line.
    """
    check_choice(link=link, listen=listen, device=device)
    if device is not None:
        from hil.serial_port.device_port import DevicePort

        return DevicePort(device, keep=keep, deliver=deliver)
    if listen is not None:
        scheme, host, number = _parse_listen(listen)
        if scheme == "rfc2217":
            from hil.serial_port.rfc2217_port import Rfc2217Port

            return Rfc2217Port(host, number, keep=keep, deliver=deliver)
        from hil.serial_port.tcp_port import TcpPort

        return TcpPort(host, number, keep=keep, deliver=deliver)
    from hil.serial_port.pty_port import PtyPort

    return PtyPort(link, keep=keep, deliver=deliver)


def _parse_listen(listen: str) -> tuple[str, str, int]:
    """The scheme, host and port number of an address.  Raises PortError."""
    match = _LISTEN.fullmatch(listen)
    if match is None or int(match["port"]) > 65535:
        raise PortError(f"cannot listen on {listen!r}: give tcp://HOST:PORT or rfc2217://HOST:PORT")
    return match["scheme"], match["host"].strip("[]") or "127.0.0.1", int(match["port"])
