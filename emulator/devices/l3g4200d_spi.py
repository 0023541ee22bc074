"""SPI framing of the L3G4200D: bits in and out, bytes to and from the register file.

Modelled: RW and MS bits, six address bits, bursts of any length, words of any length inside one chip select, SDO
released during the address byte and during writes, wrong clock modes, transactions cut inside a byte.
Not modelled: 3-wire mode, set-up and hold times.  With chip select high the pins are those of `l3g4200d_i2c.py`.
Time: none of its own.
Sources: L3G section on the SPI bus interface; LIS3DH's section on it describes the same frame.
"""

from __future__ import annotations

from typing import Final, Protocol

from emulator.devices.fixed_address import FixedAddress
from emulator.devices.report import DeviceReport, Mark, mark_of


class RegisterFile(Protocol):
    """The functions of a device that the framing uses."""

    def read_register(self, address: int) -> int:
        """One byte, with its side effects."""

    def write_register(self, address: int, byte: int) -> None:
        """One byte."""

    def after(self, address: int) -> int:
        """The address that follows in a burst with MS = 1."""

    #: Whether SDO carries the answer (SIM = 0).
    four_wire: bool
    #: Axis of an idle output that this transaction has read, -1 for none.
    idle_axis: int

    @property
    def register_names(self) -> dict[int, str]:
        """Address -> name."""

    def deselected(self) -> None:
        """A transaction that has read an idle output has ended."""


#: A period of SPC is 100 ns at least (data sheets of L3G4200D and LIS3DH, SPI slave timing values).
GREATEST_CLOCK_HZ: Final = 10e6


class SpiFrame:
    """The transaction in progress.  `report` is called for errors in the framing of this `part`."""

    __slots__ = (
        "_address",
        "_answer",
        "_bits",
        "_command",
        "_file",
        "_fixed",
        "_late_bit",
        "_mark",
        "_part",
        "_report",
        "_shift",
        "began",
        "selected",
    )

    def __init__(self, file: RegisterFile, report: DeviceReport, part: str = "L3G4200D") -> None:
        self._file = file
        self._part = part
        self._report = report
        self._fixed = FixedAddress(file.register_names, report, part, "MS")
        self._mark = mark_of(report)
        #: Whether chip select is low.
        self.selected = False
        self.reset()

    def reset(self) -> None:
        """No transaction."""
        self.selected = False
        self._bits = 0
        self._shift = 0
        self._answer = 0
        self._address = 0
        self._command = 0
        self._late_bit = 0
        #: Where the driver has sent the command byte.
        self.began: Mark = ()

    def select(self, level: int) -> None:
        """Chip select: 0 opens a transaction, 1 ends it."""
        if level and self.selected and self._bits & 7:
            self._report("spi-transaction-cut", f"{self._part}: chip select rose after {self._bits & 7} bits of a byte")
        if self._file.idle_axis >= 0:
            self._file.deselected()
        self.selected = level == 0
        self._bits = 0
        self._shift = 0
        self._late_bit = 0

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int | None:
        """Shift `length` bits; cpol and cpha as usual (mode = 2 cpol + cpha).  Modes 0 and 3 fit this device.

        SDO is driven from the second byte of a read on.  CHOICE: if only a part of a word is driven, its other bits
        read 0; in modes 1 and 2 both ends sample where the other shifts, so each sees the stream one bit late.
        """
        if not self.selected:
            return None
        if length != 8 or self._bits & 7 or cpol != cpha:
            return self._exchange_bits(out_bits, length, cpol, cpha)
        # The word is one byte of the frame, as usual.  `_shift_word` would give the same result bit by bit.
        self._bits += 8
        if self._bits == 8:
            self._command = out_bits & 0xFF
            self._address = out_bits & 0x3F
            self.began = self._mark()
            return None
        file, address = self._file, self._address
        if self._command & 0x40:
            self._address = file.after(address)
        else:
            self._fixed.byte((self._bits >> 3) - 1, address, self._command > 0x7F, self.began)
        if self._command & 0x80:
            answer = file.read_register(address)
            return answer if file.four_wire else None
        file.write_register(address, out_bits & 0xFF)
        return None

    def _exchange_bits(self, out_bits: int, length: int, cpol: int, cpha: int) -> int | None:
        if cpol == cpha:
            return self._shift_word(out_bits, length)
        self._report("spi-mode", f"{self._part}: cpol={cpol}, cpha={cpha}; it samples on rising edges (mode 0 or 3)")
        late = (self._late_bit << length | out_bits & ((1 << length) - 1)) >> 1
        self._late_bit = out_bits & 1
        answer = self._shift_word(late, length)
        return None if answer is None else answer >> 1

    def _shift_word(self, out_bits: int, length: int) -> int | None:
        answer = 0
        driven = False
        left = length
        while left:
            position = self._bits & 7
            take = min(8 - position, left)
            left -= take
            reading = self._bits >= 8 and self._command & 0x80
            if position == 0:
                self._shift = 0
                if reading:
                    self._answer = self._file.read_register(self._address)
            answer <<= take
            if reading and self._file.four_wire:
                driven = True
                answer |= self._answer >> (8 - position - take) & ((1 << take) - 1)
            self._shift = self._shift << take | out_bits >> left & ((1 << take) - 1)
            self._bits += take
            if not self._bits & 7:
                self._byte_done(self._shift)
        return answer if driven else None

    def _byte_done(self, byte: int) -> None:
        if self._bits == 8:
            self._command = byte
            self._address = byte & 0x3F
            self.began = self._mark()
            return
        address = self._address
        if self._command & 0x40:
            self._address = self._file.after(address)
        else:
            self._fixed.byte((self._bits >> 3) - 1, address, self._command > 0x7F, self.began)
        if not self._command & 0x80:
            self._file.write_register(address, byte)
