"""The bench of dimmer.c: a CAN node that orders, a PC with a serial line, and a photodiode."""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.can_bus import CanFrame, CanPart
from emulator.clock import CYCLES_PER_MS
from hil.board import Board

#: Lines of the PC, one each 15 ms.
LINES: Final = (b"gain 7\n", b"?\n", b"off\n", b"gain 11\n")
RUN_MS: Final = 200
#: From when to when the PC is off: its line is low.
OFF_MS: Final = 75
ON_MS: Final = 77


class Photodiode:
    """Half of the supply."""

    def volts(self, cycles: int) -> float:
        """The voltage at a time."""
        return 1.5


class Bench(Board):
    """A wall switch on CAN-A, which sends a brightness each 10 ms; a PC on SCI-B, which is off once.

    A photodiode is at ADCINB4.
    """

    def solder(self) -> None:
        """Connect all of it."""
        switch = self.on_can("switch", CanPart(250_000), bus="A")
        self.on_adc("photodiode", Photodiode(), adc="B", channel=4)
        pc = self.to_pc(tx_gpio=18, rx_gpio=19, baud=115200)
        for number, ms in enumerate(range(5, RUN_MS, 10)):
            frame = CanFrame(0x210, bytes((20 + number, 0xFF - 20 - number)))
            self.clock.schedule(ms * CYCLES_PER_MS, partial(switch.send, frame))
            self.clock.schedule((ms + 3) * CYCLES_PER_MS, partial(switch.send, CanFrame(0x2A0, b"\x00\x00\x01")))
        for number, ms in enumerate(range(8, RUN_MS, 15)):
            self.clock.schedule(ms * CYCLES_PER_MS, partial(pc.feed, LINES[number % len(LINES)]))
        for ms, low in (OFF_MS, True), (ON_MS, False):
            self.clock.schedule(ms * CYCLES_PER_MS, partial(self.serial_pins[19].hold_low, low))
