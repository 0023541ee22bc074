"""AT24C256 serial EEPROM: 32768 bytes on an I2C.

Modelled: byte and page write (64 bytes, rolling over within the page); the self-timed write cycle, which begins with a
STOP; no acknowledgment while it lasts, so that a driver can poll for its end; current address, random and sequential
read (rolling over at the end of the memory); address pins; write protection.  A write over the end of its page is
reported, and a driver that addresses the device in its write cycle each time, and does not ask again.
Not modelled: endurance, the software reset by clocks without a STOP, supply, set-up and hold times.
Time: lazy.  The memory changes at the first access after the end of a write cycle.
Sources: AT24C256 data sheet: device addressing, write and read operations, AC characteristics (tWR at most 5 ms; 10 ms
for the older ones).  CHOICE: a cycle takes `write_cycle_ms`, by default that maximum, which a driver must allow for.
CHOICE: bytes whose message ends in a repeated START instead of a STOP are not written.  A protected device acknowledges
bytes that it does not write, and has no write cycle.
"""

from __future__ import annotations

from typing import Final

from emulator.clock import CYCLES_PER_MS, Clock
from emulator.devices.report import DeviceReport, DiscardedReports, Mark, mark_of

SIZE: Final = 32768
PAGE: Final = 64
#: The 7-bit address with A2, A1 and A0 at ground.
ADDRESS: Final = 0x50
#: The value of bytes that were never written.
ERASED: Final = 0xFF
#: tWR, at most.
WRITE_CYCLE_MS: Final = 5.0
#: CHOICE: who was refused and addresses the device only after so many further write cycles does not poll for the end.
PATIENT_CYCLES: Final = 4
#: So many times in a row it is no accident.
GIVEN_UP: Final = 3


class At24c256:
    """The device: `bus.attach(eeprom.address, eeprom)`.  `pins` are A2, A1, A0 as a number.

    `write_protect` is the level of WP, which a board may change at any time.  `report(rule, message)` is called for
    mistakes of the driver.
    """

    __slots__ = (
        "_address_bytes", "_clock", "_cycle_cycles", "_cycle_end", "_first", "_given_up", "_latches", "_mark",
        "_memory", "_pointer", "_refused", "_report", "_sent", "_stopped_by", "_writing", "address", "write_protect",
    )  # fmt: skip

    def __init__(
        self, clock: Clock, pins: int = 0, *, write_cycle_ms: float = WRITE_CYCLE_MS, report: DeviceReport | None = None
    ) -> None:
        if not 0 <= pins <= 7:
            raise ValueError(f"address pins {pins}: expected A2, A1, A0 as a number 0..7")
        self._clock = clock
        self._report: DeviceReport = report or DiscardedReports()
        self._mark = mark_of(self._report)
        self._cycle_cycles = round(write_cycle_ms * CYCLES_PER_MS)
        self.address = ADDRESS | pins
        self.write_protect = 0
        self._memory = bytearray([ERASED]) * SIZE
        #: The current address, and how many bytes of a new address are still to come.
        self._pointer = self._address_bytes = 0
        #: Address -> byte, of the present message and of the write cycle; the end of the write cycle.
        self._latches: dict[int, int] = {}
        #: The first address of the message's data, and the number of bytes.
        self._first = self._sent = 0
        self._writing: dict[int, int] = {}
        self._cycle_end = 0
        #: Who has begun the write cycle; when the device refused its address (None: it has not since); how often in a
        #: row nobody has asked again.
        self._stopped_by: Mark = ()
        self._refused: int | None = None
        self._given_up = 0

    @property
    def memory(self) -> bytearray:
        """The content of the device now."""
        self._finish_write()
        return self._memory

    def _finish_write(self) -> None:
        if self._writing and not self.busy:
            for place, byte in self._writing.items():
                self._memory[place] = byte
            self._writing = {}

    @property
    def busy(self) -> bool:
        """Whether a write cycle is under way."""
        return self._clock.now < self._cycle_end

    def start(self) -> None:
        """A START or a repeated START.  A message that has had no STOP writes nothing."""
        self._latches = {}
        self._sent = 0

    def addressed(self, reading: bool) -> bool:
        """Acknowledged unless a write cycle is under way."""
        now = self._clock.now
        if self._refused is not None and now - self._refused > PATIENT_CYCLES * self._cycle_cycles:
            self._given_up, self._refused = self._given_up + 1, None
        elif self._refused is not None:
            self._given_up = -GIVEN_UP  # it polls: a refusal now and then is no defect
        if self.busy:
            if self._refused is None and self._given_up >= GIVEN_UP - 1:
                self._report(
                    "eeprom-busy",
                    f"AT24C256: it was addressed in its write cycle, and refused, {self._given_up + 1} times in a row; "
                    "nobody asked again until long after the end of the cycle",
                    object=f"AT24C256 {self.address:#04x}", since=self._stopped_by,
                )  # fmt: skip
            self._refused = now
            return False
        self._refused = None
        self._address_bytes = 0 if reading else 2
        return True

    def write(self, byte: int) -> bool:
        """Take a byte: first two bytes of address, the upper one first, then data."""
        if self._address_bytes:
            self._address_bytes -= 1
            self._pointer = (self._pointer << 8 | byte) % SIZE
        else:
            if not self._sent:
                self._first = self._pointer
            self._sent += 1
            self._latches[self._pointer] = byte
            page = self._pointer - self._pointer % PAGE
            self._pointer = page + (self._pointer + 1) % PAGE
        return True

    def read(self) -> int:
        """The byte at the current address.  The address then moves on."""
        byte = self.memory[self._pointer]
        self._pointer = (self._pointer + 1) % SIZE
        return byte

    def stop(self) -> None:
        """A STOP: write the data of the message."""
        if self._latches and not self.write_protect:
            self._finish_write()
            self._writing, self._cycle_end = self._latches, self._clock.now + self._cycle_cycles
            self._stopped_by = self._mark()
            beyond = self._first % PAGE + self._sent - PAGE
            if beyond > 0:
                page = self._first - self._first % PAGE
                self._report(
                    "eeprom-page",
                    f"AT24C256: {self._sent} bytes were written from {self._first:#06x} on, over the end of the page: "
                    f"the last {beyond} went to {page:#06x} and behind",
                    object=f"AT24C256 {self.address:#04x}", value=self._first,
                )  # fmt: skip
        self._latches = {}
        self._sent = 0
