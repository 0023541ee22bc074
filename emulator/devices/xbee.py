"""XBee S1 in transparent mode: one module, and the pair that links robot and PC.

Modelled: DI buffer of 202 bytes with CTS and silent overflow, packetisation by RO or 100 characters, half-duplex radio
(`xbee_radio`), DO buffer that takes or drops whole packets, exact output timing, command mode (`xbee_command`), a host
with another speed.
Not modelled: API mode, parity, RTS (reported when set), sleep, I/O pins, power-up time, break.
Time: one event for each character towards a host, one for each RO silence from a host, two for each packet on the air.
Sources: XB sections on serial data, transparent operation, flow control.
"""

from __future__ import annotations

import random
from typing import Final

from emulator.clock import SYSCLK_HZ, Clock, ClockEvent
from emulator.devices.report import DeviceReport
from emulator.devices.serial_pacing import FRAME_BITS, LinePacer, received
from emulator.devices.xbee_command import CommandMode
from emulator.devices.xbee_parameters import BAUDS, NOMINAL_BAUDS, XBeeSettings
from emulator.devices.xbee_radio import RadioChannel
from emulator.signal import Signal
from emulator.signals import SerialFrame, SerialLine, Wire

DI_BYTES: Final = 202
#: CTS is withdrawn when only this many bytes are free, and given back when this many are free.
CTS_OFF_FREE: Final = 17
CTS_ON_FREE: Final = 34
PACKET_BYTES: Final = 100
#: CHOICE: as large as the DI buffer.
DO_BYTES: Final = 202


class XBeeModule:
    """One module.  For the bus: `din`, `dout` (serial lines) and `cts` (0 = go on).  For the world: its `air`.

    Counters: `di_overflow` bytes and `do_dropped` bytes lost silently, `framing_errors` characters not understood.
    """

    def __init__(
        self,
        clock: Clock,
        din: SerialLine,
        dout: SerialLine,
        air: RadioChannel,
        *,
        name: str,
        baud: int = 9600,
        serial_low: int = 0x40000001,
        cts: Wire | None = None,
        report: DeviceReport | None = None,
    ) -> None:
        if baud not in NOMINAL_BAUDS:
            raise ValueError(f"XBee {name}: {baud} baud; expected one of {', '.join(map(str, NOMINAL_BAUDS))}")
        self.clock = clock
        self.name = name
        self.air = air
        self.cts = cts or Wire(f"XBee {name} CTS")
        self.settings = XBeeSettings(serial_low)
        self.settings.working["BD"] = self.settings.stored["BD"] = NOMINAL_BAUDS.index(baud)
        self.di_overflow = 0
        self.do_dropped = 0
        self.framing_errors = 0
        self._live = dict(self.settings.working)
        self._report = report
        self._pacer = LinePacer(clock, dout, BAUDS[self._live["BD"]])
        self._bit_cycles = 0.0
        self._silence_cycles = 0
        self._di = bytearray()
        self._due = 0
        self._last_character = 0
        self._silence: ClockEvent | None = None
        self._held_back = bytearray()
        self._command = CommandMode(clock, self.settings, self._live, self, report or (lambda _rule, _message: None))
        self._take_effect()
        air.join(self)
        din.sent.connect(self._from_host)

    # State for other parts

    @property
    def command_mode(self) -> bool:
        """Whether the module is in command mode: the host talks to it, not to the other end."""
        return self._command.active

    @property
    def bytes_from_host(self) -> int:
        """The number of bytes from the host that have not reached the other module."""
        return len(self._di) + self._command.waiting + self.air.flying(self)

    @property
    def bytes_to_host(self) -> int:
        """The number of bytes for the host whose stop bit has not ended."""
        return self._pacer.pending + len(self._held_back)

    @property
    def radio_settings(self) -> dict[str, int]:
        """The values in effect."""
        return self._live

    # From the host

    def _from_host(self, frame: SerialFrame) -> None:
        if self._report is not None and (rates := frame.rates_differ(self._bit_cycles)):
            self._report("serial-rate", f"XBee {self.name}: {rates}", cause=frame.rate_set_by)
        byte, stop = received(frame, self._bit_cycles)
        if not stop:
            # CHOICE: a character without a stop bit is dropped.
            self.framing_errors += 1
        elif not self._command.character(byte, frame.start, frame.end):
            self._buffer(byte)

    def _buffer(self, byte: int) -> None:
        """Put a byte into the DI buffer.  RO restarts at the end of each character (CHOICE: not at its start bit)."""
        if len(self._di) >= DI_BYTES:
            self.di_overflow += 1
            return
        self._di.append(byte)
        self._update_cts()
        self._last_character = self.clock.now
        if self._silence_cycles == 0:
            self._due = len(self._di)
        elif len(self._di) - self._due >= PACKET_BYTES:
            self._due += PACKET_BYTES
        if self._due:
            self._send_packet()
        if self._due < len(self._di) and self._silence is None:
            self._silence = self.clock.after(self._silence_cycles, self._silence_over)

    def _silence_over(self) -> None:
        self._silence = None
        silent_from = self._last_character + self._silence_cycles
        if silent_from > self.clock.now:
            self._silence = self.clock.schedule(silent_from, self._silence_over)
        else:
            self._flush()

    def _flush(self) -> None:
        self._due = len(self._di)
        self._send_packet()

    def _send_packet(self) -> None:
        """Send one packet of the bytes that are due, as soon as the air is free.  Bytes go on gathering meanwhile."""
        if not self._due:
            return
        if self.air.busy:
            self.air.wait(self)
            return
        size = min(self._due, PACKET_BYTES)
        payload = bytes(self._di[:size])
        del self._di[:size]
        self._due -= size
        self._update_cts()
        self.air.send(self, payload)

    def _update_cts(self) -> None:
        free = DI_BYTES - len(self._di)
        if self._live["D7"] != 1:
            self.cts.drive(self.name, None)
        elif free <= CTS_OFF_FREE:
            self.cts.drive(self.name, 1)
        elif free >= CTS_ON_FREE or not self.cts.driven():
            self.cts.drive(self.name, 0)

    # From the air

    def radio_free(self) -> None:
        """The channel fell silent."""
        self._send_packet()

    def radio_received(self, payload: bytes) -> None:
        """A packet arrived: it is taken or dropped as a whole.  CHOICE: in command mode it waits for the mode's end."""
        if self.bytes_to_host + len(payload) > DO_BYTES:
            self.do_dropped += len(payload)
        elif self._command.active:
            self._held_back += payload
        else:
            self._pacer.send(payload)

    def radio_failed(self) -> None:
        """No acknowledgement after all tries.  Only the EA counter shows it."""
        working = self.settings.working
        working["EA"] = min(working["EA"] + 1, 0xFFFF)

    # Command mode

    def command_entered(self) -> None:
        """Send the data buffered so far first."""
        self._flush()

    def command_left(self) -> None:
        """Give the data that came from the air meanwhile to the host."""
        if self._held_back:
            self._pacer.send(bytes(self._held_back))
            self._held_back.clear()

    def command_data(self, data: bytes) -> None:
        """Take characters as data that looked like the command sequence and were not."""
        for byte in data:
            self._buffer(byte)

    def reply(self, text: bytes) -> None:
        """Send an answer to the host, after the bytes that are being sent already."""
        self._pacer.send(text)

    def apply(self) -> None:
        """Let the working values take effect, once the answers at the old speed are sent."""
        if self._pacer.pending:
            self.clock.schedule(self._pacer.idle_at, self._take_effect)
        else:
            self._take_effect()

    def restart(self) -> None:
        """FR: stored values, empty buffers."""
        self._command.reset()
        self.settings.reset()
        self._pacer.clear()
        self._held_back.clear()
        self._di.clear()
        self._due = 0
        self.clock.cancel(self._silence)
        self._silence = None
        self._take_effect()

    def _take_effect(self) -> None:
        self._live.update(self.settings.working)
        baud = BAUDS[self._live["BD"]]
        self._pacer.set_baud(baud)
        self._bit_cycles = SYSCLK_HZ / baud
        self._silence_cycles = round(self._live["RO"] * FRAME_BITS * SYSCLK_HZ / baud)
        self._update_cts()


class XBeeLink:
    """A pair of modules between the robot's UART and a PC.

    Robot side: `uart_in` carries the bytes that the robot sends, `uart_out` those that it receives; `robot.cts`.  PC
    side: `feed`, `pending_to_robot`, `received`; the PC's port runs at `pc_baud`.  `feed` takes any number of bytes;
    its caller reads `pending_to_robot` and slows a fast writer down.
    """

    def __init__(
        self,
        clock: Clock,
        uart_in: SerialLine,
        uart_out: SerialLine,
        *,
        rng: random.Random,
        ideal: bool = True,
        baud: int = 9600,
        cts: Wire | None = None,
        air: RadioChannel | None = None,
        report: DeviceReport | None = None,
    ) -> None:
        #: (data, cycles): the PC has received bytes from the robot.
        self.received: Signal[bytes, int] = Signal()
        self.air = air or RadioChannel(clock, rng=rng, ideal=ideal)
        self.robot = XBeeModule(clock, uart_in, uart_out, self.air, name="robot", baud=baud, cts=cts, report=report)
        pc_tx, pc_rx = SerialLine("PC TX"), SerialLine("PC RX")
        self.pc = XBeeModule(clock, pc_tx, pc_rx, self.air, name="PC", baud=baud, serial_low=0x40000002, report=report)
        self._pc_bit_cycles = SYSCLK_HZ / baud
        self._pc_pacer = LinePacer(clock, pc_tx, baud)
        pc_rx.sent.connect(self._to_pc)

    @property
    def pending_to_robot(self) -> int:
        """Bytes fed that the robot's UART has not received yet (nor lost)."""
        return self._pc_pacer.pending + self.pc.bytes_from_host + self.robot.bytes_to_host

    def feed(self, data: bytes) -> None:
        """Bytes written by the PC now; they leave back to back at the speed of its port."""
        self._pc_pacer.send(data)

    def set_pc_baud(self, baud: int) -> None:
        """The PC opens its port at another speed."""
        self._pc_pacer.set_baud(baud)
        self._pc_bit_cycles = SYSCLK_HZ / baud

    def _to_pc(self, frame: SerialFrame) -> None:
        byte, stop = received(frame, self._pc_bit_cycles)
        if stop:
            self.received.emit(bytes((byte,)), frame.end)
