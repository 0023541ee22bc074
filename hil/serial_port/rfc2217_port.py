"""A TCP server for pyserial's ``rfc2217://host:port``: Telnet with the COM port control option (RFC 2217).

The Telnet side is pyserial's own `PortManager`.  The serial port that it manages is only a record of settings, because
the robot's line is always 9600 8N1.  Purging the receive buffer works: it discards the waiting bytes.
A client that breaks the protocol, or never reads what it requests, is disconnected and counted.

Not modelled: break, modem lines that change (CTS, DSR and CD are always on), flow control suspend and resume.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, Final, cast

import serial
from serial.rfc2217 import PortManager

from hil.serial_port.frames import DEFAULT_KEEP, Delivery
from hil.serial_port.tcp_port import TcpPort
from hil.serial_url import BAUD

#: The longest suboption of RFC 2217 that carries data is the signature; 256 is generous.
LONGEST_SUBOPTION: Final = 256
#: Answers of the protocol that a client does not collect; beyond this it is not a serial client.
MAX_CONTROL: Final = 65536
IAC: Final = b"\xff"


class LineSettings:
    """The serial port for `PortManager`: attributes to read and set, and buffers to purge."""

    def __init__(self, forget_output: Callable[[], None]) -> None:
        self.baudrate = BAUD
        self.bytesize = serial.EIGHTBITS
        self.parity = serial.PARITY_NONE
        self.stopbits: float = serial.STOPBITS_ONE
        self.xonxoff = False
        self.rtscts = False
        self.break_condition = False
        self.dtr = True
        self.rts = True
        self.cts = True
        self.dsr = True
        self.cd = True
        self.ri = False
        #: The bytes that the robot sent and the program has not received: the program's *receive* buffer.
        self.reset_input_buffer = forget_output

    def reset_output_buffer(self) -> None:
        """Do nothing: the line has the program's bytes already."""


class Rfc2217Port(TcpPort):
    """A listening socket that speaks RFC 2217."""

    scheme = "rfc2217"

    def __init__(self, host: str, port: int, *, keep: int = DEFAULT_KEEP, deliver: Delivery = Delivery.FRAMES) -> None:
        super().__init__(host, port, keep=keep, deliver=deliver)
        self._manager: PortManager | None = None
        #: Bytes of the protocol that wait to be sent.  They are sent before the next frame, never inside one.
        self._control = bytearray()

    def write(self, data: bytes) -> None:
        """Queue an answer of the protocol.  `PortManager` calls it."""
        self._control += data

    def transmit(self, now_cycles: int) -> None:
        """Send the answers of the protocol, then frames."""
        self._send_control()
        super().transmit(now_cycles)

    def _connected(self) -> None:
        self._control.clear()
        # Its annotation says Serial, but its code uses only what LineSettings and `write` have.
        self._manager = PortManager(cast(Any, LineSettings(self.outbound.discard)), cast(Any, self))
        self._send_control()

    def _hang_up(self) -> None:
        super()._hang_up()
        self._manager = None
        self._control = bytearray()

    def _ready_for_more(self) -> bool:
        return not self._control

    def _send_control(self) -> None:
        # A frame in transit may have been accepted in part: its rest goes first (`SerialPort.transmit`).
        if self._control and not self._transit:
            accepted = self._write(bytes(self._control))
            del self._control[: accepted if accepted >= 0 else len(self._control)]

    def _encode(self, piece: bytes) -> bytes:
        return piece.replace(IAC, IAC + IAC)

    def _read(self, room: int) -> bytes:
        raw = super()._read(room)
        manager = self._manager
        if manager is None or not raw:
            return b""
        data = bytearray()
        try:
            for byte in manager.filter(raw):
                data += byte
            broken = manager.suboption is not None and len(manager.suboption) > LONGEST_SUBOPTION
        except (ValueError, KeyError, IndexError, TypeError, struct.error):
            broken = True  # a suboption that says nothing sensible
        if broken or len(self._control) > MAX_CONTROL:
            self.counters.protocol_errors += 1
            self._hang_up()
        else:
            self._send_control()
        return bytes(data)
