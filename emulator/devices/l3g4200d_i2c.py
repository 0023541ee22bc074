"""I2C framing of the L3G4200D: bytes to and from the register file, which SPI uses too.

Modelled: the sub-address with auto-increment in bit 7; bursts of reads and writes; a repeated START that changes the
direction; the sub-address, which stays between transactions; no answer while chip select is low, which selects SPI.
Not modelled: set-up and hold times, a stretched clock.
Time: none of its own.
Sources: L3G section on the I2C bus interface.
CHOICE: a read without a sub-address continues where the last transaction ended.
"""

from __future__ import annotations

from typing import Final

from emulator.devices.fixed_address import FixedAddress
from emulator.devices.l3g4200d_spi import RegisterFile, SpiFrame
from emulator.devices.report import DeviceReport

#: The 7-bit address with SDO at ground.
ADDRESS: Final = 0x68
#: In the sub-address.
AUTO_INCREMENT: Final = 0x80


class I2cFrame:
    """The device as a target on a bus: `bus.attach(frame.address, frame)`.  `sdo` is the level of its pin SDO."""

    __slots__ = ("_address", "_bytes", "_file", "_fixed", "_increment", "_spi", "_sub_next", "sdo")

    def __init__(self, file: RegisterFile, spi: SpiFrame, sdo: int, report: DeviceReport) -> None:
        self._file = file
        self._fixed = FixedAddress(file.register_names, report, "L3G4200D", "bit 7 of the sub-address")
        self._spi = spi
        self.sdo = sdo
        self.reset()

    def reset(self) -> None:
        """No transaction."""
        self._address = 0
        self._increment = False
        #: The number of data bytes since the device was addressed.
        self._bytes = 0
        #: Whether the next byte written is the sub-address.
        self._sub_next = False

    @property
    def address(self) -> int:
        """The 7-bit address: SDO is its lowest bit."""
        return ADDRESS | self.sdo

    def start(self) -> None:
        """A START or a repeated START.  It ends the transaction under way."""
        if self._file.idle_axis >= 0:
            self._file.deselected()

    def stop(self) -> None:
        """A STOP."""
        self.start()

    def addressed(self, reading: bool) -> bool:
        """Acknowledged while the pins are those of an I2C."""
        self._sub_next = not reading
        self._bytes = 0
        return not self._spi.selected

    def write(self, byte: int) -> bool:
        """The sub-address, then bytes for the registers from there on."""
        if self._sub_next:
            self._sub_next = False
            self._address = byte & 0x7F
            self._increment = bool(byte & AUTO_INCREMENT)
        else:
            self._file.write_register(self._next(False), byte)
        return True

    def read(self) -> int:
        """The register at the sub-address."""
        return self._file.read_register(self._next(True))

    def _next(self, reading: bool) -> int:
        address = self._address
        self._bytes += 1
        if self._increment:
            self._address = self._file.after(address)
        else:
            self._fixed.byte(self._bytes, address, reading, ())
        return address
