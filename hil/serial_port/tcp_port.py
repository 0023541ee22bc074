"""A TCP server for pyserial's ``socket://host:port``.  It carries only the bytes of the line.

It serves one program at a time, as a serial port does; a second connection waits in the queue until the first is
closed.  A new client begins with the next whole frame.  Frames that are sent while nobody is connected are dropped and
counted.  The receive buffer is small, so that a fast writer is slowed to the speed of the line.  The buffers on the
client's side cannot be controlled.
"""

from __future__ import annotations

import contextlib
import socket
from collections.abc import Sequence
from typing import Final

from hil.serial_port.base import SerialPort
from hil.serial_port.frames import DEFAULT_KEEP, Delivery
from hil.serial_url import PortError

#: CHOICE: about 4 s of a line of 9600 baud, in each direction.  The operating system rounds it up.
SOCKET_BUFFER: Final = 4096


class TcpPort(SerialPort):
    """A listening socket that serves one program at a time."""

    scheme = "socket"

    def __init__(self, host: str, port: int, *, keep: int = DEFAULT_KEEP, deliver: Delivery = Delivery.FRAMES) -> None:
        """Listen on `host`:`port` (port 0: any free one).  Raises PortError if that is not possible."""
        super().__init__(keep=keep, deliver=deliver)
        family = socket.AF_INET6 if ":" in host else socket.AF_INET
        self._listener = socket.socket(family, socket.SOCK_STREAM)
        try:
            self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SOCKET_BUFFER)
            self._listener.bind((host, port))
            self._listener.listen(4)
        except (OSError, OverflowError) as error:
            self._listener.close()
            reason = getattr(error, "strerror", None) or str(error)
            raise PortError(f"cannot listen on {host}:{port}: {reason}") from None
        self._listener.setblocking(False)
        bound = self._listener.getsockname()[1]
        self.address = f"{self.scheme}://{f'[{host}]' if ':' in host else host}:{bound}"
        self._client: socket.socket | None = None

    @property
    def connected(self) -> bool:
        """Whether a program is connected."""
        return self._client is not None

    def wait_fds(self) -> Sequence[int]:
        """The client's socket; without a client, the listening socket."""
        return ((self._client or self._listener).fileno(),)

    def transmit(self, now_cycles: int) -> None:
        """Send frames to the client; drop them if there is none."""
        self._accept()
        if self._client is None:
            self.outbound.settle(now_cycles)
            self.outbound.discard()
            return
        super().transmit(now_cycles)

    def receive(self, room: int) -> bytes:
        """At most `room` bytes from the connected program."""
        self._accept()
        return super().receive(room)

    def close(self) -> None:
        """Close the connection and stop listening."""
        self._hang_up()
        self._listener.close()

    def _accept(self) -> None:
        if self._client is not None:
            return
        try:
            client, _ = self._listener.accept()
        except (BlockingIOError, ConnectionError):
            return
        client.setblocking(False)
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        client.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SOCKET_BUFFER)
        self._client = client
        self.counters.connections += 1
        self.outbound.discard()
        self._connected()

    def _connected(self) -> None:
        """A program has just connected."""

    def _hang_up(self) -> None:
        if self._client is not None:
            with contextlib.suppress(OSError):
                self._client.close()
            self._client = None
        self._transit = b""

    def _write(self, data: bytes) -> int:
        if self._client is None:
            return 0
        try:
            return self._client.send(data)
        except BlockingIOError:
            return 0
        except OSError:
            return -1  # what it sent before it went is still to be read; that read hangs up

    def _read(self, room: int) -> bytes:
        if self._client is None:
            return b""
        try:
            data = self._client.recv(room)
        except BlockingIOError:
            return b""
        except OSError:
            data = b""
        if not data:
            self._hang_up()
        return data
