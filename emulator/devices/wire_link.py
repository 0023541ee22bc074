"""A wire in place of the radio: the robot's UART straight to the PC.

Modelled: byte-exact timing in both directions at one speed; a UART's reception of a robot with another speed.
Not modelled: noise, breaks, flow control.
Time: towards the robot, one event for each character; from the robot, the events of its own transmitter.
Sources: none needed beyond `serial_pacing`.
"""

from __future__ import annotations

from emulator.clock import SYSCLK_HZ, Clock
from emulator.devices.report import DeviceReport
from emulator.devices.serial_pacing import LinePacer, received
from emulator.signal import Signal
from emulator.signals import SerialFrame, SerialLine


class WireLink:
    """PC side: `feed`, `pending_to_robot`, `received`; robot side: two serial lines.

    `uart_in` carries the bytes that the robot sends, `uart_out` those that it receives.  `feed` takes any number of
    bytes; its caller reads `pending_to_robot` and slows a fast writer down.
    """

    def __init__(
        self,
        clock: Clock,
        uart_in: SerialLine,
        uart_out: SerialLine,
        *,
        baud: int = 9600,
        report: DeviceReport | None = None,
    ) -> None:
        #: (data, cycles): the PC has received bytes from the robot.
        self.received: Signal[bytes, int] = Signal()
        #: Characters from the robot whose stop bit was not seen.  CHOICE: they are dropped, because
        #: a PC's UART marks them as errors.
        self.framing_errors = 0
        self._pacer = LinePacer(clock, uart_out, baud)
        self._bit_cycles = SYSCLK_HZ / baud
        self._report = report
        uart_in.sent.connect(self._from_robot)

    @property
    def pending_to_robot(self) -> int:
        """Bytes fed that the robot's UART has not received yet."""
        return self._pacer.pending

    def feed(self, data: bytes) -> None:
        """Bytes written by the PC now; they leave back to back at the line's speed."""
        self._pacer.send(data)

    def _from_robot(self, frame: SerialFrame) -> None:
        if self._report is not None and (rates := frame.rates_differ(self._bit_cycles)):
            self._report("serial-rate", f"the PC: {rates}", cause=frame.rate_set_by)
        byte, stop = received(frame, self._bit_cycles)
        if stop:
            self.received.emit(bytes((byte,)), frame.end)
        else:
            self.framing_errors += 1
