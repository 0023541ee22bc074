"""LIS3DH three-axis accelerometer on SPI.

Modelled: 4-wire SPI framing (`l3g4200d_spi`, the same frame), WHO_AM_I, CTRL_REG0 to CTRL_REG6, STATUS_REG and the
outputs; power-down, low-power (8 bits), normal (10) and high-resolution mode (12), every output data rate, full scales
of 2, 4, 8 and 16 g, enabled axes, BDU, BLE, overrun; offset, noise and data rate of a specimen.
Not modelled: FIFO, interrupt generators and pins, click and sleep detection, high-pass filter, self test, auxiliary
converter and thermometer, 3-wire SPI, I2C; BOOT beyond its bit; the boot of some 5 ms after power-up (it answers at
once).  A write that switches one of them on is reported as `unmodelled`; its registers keep what was written.
Time: one event for each sample while it is on, none in power-down.  A sample is the mean motion over the sample's
period.  The source of the motion is called when the period ends.
Sources: LIS3DH data sheet (DocID17530 Rev 2): 3.2.1 operating modes (tables 10 to 12), 6.2 SPI bus interface, 7
register mapping, 8 register description, table 4 mechanical characteristics.  Addresses, bits, data rates and mg a
digit are also those of ST's driver (STMicroelectronics/lis3dh-pid, `lis3dh_reg.h` and `.c`).  The figures of table 4
for noise and zero-g level were not compared with the text of the sheet.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from math import sqrt
from typing import ClassVar, Final

from emulator.clock import SYSCLK_HZ, Clock, ClockEvent
from emulator.devices.l3g4200d_spi import GREATEST_CLOCK_HZ, SpiFrame
from emulator.devices.report import DeviceReport, DiscardedReports

WHO_AM_I: Final = 0x0F
CTRL_REG0: Final = 0x1E
CTRL_REG1: Final = 0x20
CTRL_REG4: Final = 0x23
STATUS_REG: Final = 0x27
OUT_X_L: Final = 0x28
OUT_Z_H: Final = 0x2D
IDENTITY: Final = 0x33

GRAVITY_M_S2: Final = 9.80665

#: Registers that can be written, with their values after power-up.
_WRITABLE: Final = {
    0x1E: 0x10, 0x1F: 0, 0x20: 0x07, 0x21: 0, 0x22: 0, 0x23: 0, 0x24: 0, 0x25: 0, 0x26: 0, 0x2E: 0, 0x30: 0, 0x32: 0,
    0x33: 0, 0x34: 0, 0x36: 0, 0x37: 0, 0x38: 0, 0x3A: 0, 0x3B: 0, 0x3C: 0, 0x3D: 0, 0x3E: 0, 0x3F: 0,
}  # fmt: skip
#: Registers that are only read, besides STATUS_REG and the outputs: STATUS_REG_AUX, the OUT_ADC, the sources.
_READ_ONLY: Final = frozenset((*range(0x07, 0x0E), WHO_AM_I, STATUS_REG, *range(0x28, 0x2E), 0x2F, 0x31, 0x35, 0x39))
#: Bits that switch on what is not modelled: register -> (bits, what it is).
_UNMODELLED: Final = {
    0x1F: (0xC0, "TEMP_CFG_REG (auxiliary converter, thermometer)"),
    0x21: (0x0F, "CTRL_REG2 (high-pass filter)"),
    0x22: (0xFE, "CTRL_REG3 (INT1)"),
    0x23: (0x07, "CTRL_REG4.ST, SIM (self test, 3-wire SPI)"),
    0x24: (0x40, "CTRL_REG5.FIFO_EN"),
    0x25: (0xF8, "CTRL_REG6 (INT2)"),
    0x30: (0x3F, "INT1_CFG"),
    0x34: (0x3F, "INT2_CFG"),
    0x38: (0x3F, "CLICK_CFG"),
    0x3E: (0x7F, "ACT_THS (sleep to wake)"),
}
#: CTRL_REG0: bit 7 disconnects a pull-up of SDO, the others must stay as they are.
CTRL_REG0_FIXED: Final = 0x10
#: Data rates by CTRL_REG1.ODR in Hz; 8 is of low-power mode alone, 9 is another one there.  1620: table 12 of the sheet
#: and ST's driver; drivers of others call it 1.6 kHz.
ODR_HZ: Final = (0, 1, 10, 25, 50, 100, 200, 400, 0, 1344)
LOW_POWER_ODR_HZ: Final = (*ODR_HZ[:8], 1620, 5376)
#: Bits of a sample, and thousandths of g a digit by CTRL_REG4.FS: high resolution, normal, low power.
HIGH_RESOLUTION: Final = (12, (1, 2, 4, 12))
NORMAL: Final = (10, (4, 8, 16, 48))
LOW_POWER: Final = (8, (16, 32, 64, 192))

#: CHOICE: noise density at 2 g, in g per root of Hz, the same in each mode and full scale.
NOISE_G: Final = 220e-6
#: CHOICE: zero-g level of a specimen in g, evenly distributed between the typical figures.
OFFSET_G: Final = 0.040
#: CHOICE: the data rate of a specimen is within 2 % (the sheet gives no figure).
ODR_SPREAD: Final = 0.02
#: Table 11, for a change of mode: 7 periods to high resolution, else 1.
#: CHOICE: it takes the same time from power-down, and the first sample comes when the output has settled.
SETTLING_PERIODS: Final = (1, 7)


class Lis3dh:
    """The device.  For the bus: `select`, `exchange`.  For the world: `set_motion_source`.

    `motion_source(cycles)` returns the specific force along x, y and z in m/s2: at rest on a table (0, 0, +9.81).
    It is called once when a measurement begins, and at the end of each period; it returns the mean over the period.
    """

    #: Address -> name, for code that decodes the bus.
    register_names: ClassVar[dict[int, str]] = {
        WHO_AM_I: "WHO_AM_I", CTRL_REG0: "CTRL_REG0", 0x1F: "TEMP_CFG_REG", STATUS_REG: "STATUS_REG",
        **{CTRL_REG1 + n: f"CTRL_REG{1 + n}" for n in range(6)},
        **{OUT_X_L + n: f"OUT_{'XYZ'[n // 2]}_{'LH'[n % 2]}" for n in range(6)},
    }  # fmt: skip

    def __init__(
        self,
        clock: Clock,
        *,
        rng: random.Random,
        ideal: bool = True,
        motion_source: Callable[[int], tuple[float, float, float]] | None = None,
        report: DeviceReport | None = None,
    ) -> None:
        self._clock = clock
        self._rng = rng
        self._ideal = ideal
        self._report: DeviceReport = report or DiscardedReports()
        self.motion_source = motion_source or _at_rest
        self.offset_g = [0.0 if ideal else rng.uniform(-OFFSET_G, OFFSET_G) for _ in range(3)]
        self._rate = 1.0 if ideal else 1.0 + rng.uniform(-ODR_SPREAD, ODR_SPREAD)
        self._event: ClockEvent | None = None
        #: Read by the framing: whether SDO answers (always); the disabled axis that a transaction read, if it read no
        #: other axis (else -1).
        self.four_wire = True
        self.idle_axis = -1
        self._enabled_read = False
        self._spi = SpiFrame(self, self._report, "LIS3DH")
        self.exchange = self._spi.exchange
        self.greatest_clock_hz = GREATEST_CLOCK_HZ
        self.reset()

    def reset(self) -> None:
        """Power on: registers at their reset values, power-down."""
        self._clock.cancel(self._event)
        self._event = None
        self.registers = [0] * 64
        for address, byte in _WRITABLE.items():
            self.registers[address] = byte
        self.registers[WHO_AM_I] = IDENTITY
        #: Samples taken since power-up.
        self.samples = 0
        self._period = 0
        self._base = 0
        self._taken = 0
        #: Left-justified output words; the newest words while a read holds the outputs (BDU); halves that were read.
        self._words = [0, 0, 0]
        self._newer: list[int | None] = [None, None, None]
        self._halves = [0, 0, 0]
        self._status = 0

    def set_motion_source(self, source: Callable[[int], tuple[float, float, float]]) -> None:
        """Set the source of its motion from now on."""
        self.motion_source = source

    def select(self, level: int) -> None:
        """Chip select: 0 opens a transaction, 1 ends it."""
        self._spi.select(level)
        self._enabled_read = False

    # The settings in CTRL_REG1 and CTRL_REG4

    @property
    def mode(self) -> tuple[int, tuple[int, int, int, int]]:
        """Bits of a sample, and thousandths of g a digit by full scale."""
        if self.registers[CTRL_REG1] & 8:
            return LOW_POWER
        return HIGH_RESOLUTION if self.registers[CTRL_REG4] & 8 else NORMAL

    @property
    def odr_hz(self) -> int:
        """Samples a second; 0 in power-down."""
        setting = self.registers[CTRL_REG1] >> 4
        rates = LOW_POWER_ODR_HZ if self.registers[CTRL_REG1] & 8 else ODR_HZ
        return rates[setting] if setting < len(rates) else 0

    # The register file, for the framing

    def after(self, address: int) -> int:
        """The address that follows in a burst."""
        return (address + 1) & 0x3F

    def deselected(self) -> None:
        """The transaction read only axes that are disabled."""
        name = "XYZ"[self.idle_axis]
        self._idle(self.idle_axis, f"{name}en", "the axis is disabled")
        self.idle_axis = -1

    def _idle(self, axis: int, field: str, why: str) -> None:
        """Report the read of an output that is never filled."""
        self._report(
            "not-configured",
            f"LIS3DH.OUT_{'XYZ'[axis]} was read while CTRL_REG1.{field} = 0: {why}, and the value is old",
            object=f"LIS3DH.CTRL_REG1.{field}", since=self._spi.began,
        )  # fmt: skip

    def read_register(self, address: int) -> int:
        """One byte, with its side effects."""
        if address == STATUS_REG:
            return self._status_byte()
        if OUT_X_L <= address <= OUT_Z_H:
            return self._read_output(address - OUT_X_L)
        return self.registers[address]

    def write_register(self, address: int, byte: int) -> None:
        """One byte from the bus."""
        if address not in _WRITABLE:
            kind = "read-only" if address in _READ_ONLY else "reserved"
            self._report("device-register", f"LIS3DH: {kind} register {address:#04x} was written with {byte:#04x}")
            return
        if address == CTRL_REG0 and byte & 0x7F != CTRL_REG0_FIXED:
            self._report("device-register", f"LIS3DH: CTRL_REG0 = {byte:#04x}: bits 6 to 0 must be 0010000")
        bits, what = _UNMODELLED.get(address, (0, ""))
        if byte & bits:
            self._report("unmodelled", f"LIS3DH: {what} = {byte:#04x} is kept, and has no effect here")
        before = (self.odr_hz, self.mode)
        self.registers[address] = byte
        if address == CTRL_REG1 and byte >> 4 and not self.odr_hz:
            self._report("device-register", f"LIS3DH: CTRL_REG1 = {byte:#04x}: no data rate of this mode")
        if self.registers[CTRL_REG1] & 8 and self.registers[CTRL_REG4] & 8 and address in (CTRL_REG1, CTRL_REG4):
            self._report("device-register", "LIS3DH: CTRL_REG1.LPen and CTRL_REG4.HR are both set: not allowed")
        if (self.odr_hz, self.mode) != before:
            self._begin()

    def _status_byte(self) -> int:
        """ZYXOR ZOR YOR XOR ZYXDA ZDA YDA XDA.  CHOICE: the bits of the set mean every axis that is enabled."""
        enabled = self.registers[CTRL_REG1] & 7
        status = self._status
        if enabled and status & enabled == enabled:
            status |= 0x08
        if enabled and status >> 4 & enabled == enabled:
            status |= 0x80
        return status

    def _read_output(self, index: int) -> int:
        axis, high = index >> 1, index & 1
        if not self.registers[CTRL_REG1] >> 4:
            self._idle(axis, "ODR", "the device is in power-down")
        elif self.registers[CTRL_REG1] >> axis & 1:
            self._enabled_read, self.idle_axis = True, -1
        elif not self._enabled_read:
            self.idle_axis = axis
        word = self._words[axis]
        self._halves[axis] |= 1 << high
        if self._halves[axis] == 3:
            self._halves[axis] = 0
            newer = self._newer[axis]
            if newer is not None:
                self._words[axis] = newer
                self._newer[axis] = None
        if high:
            # CHOICE: a read of the high byte consumes the sample, as in the gyro of this maker.
            self._status &= ~(0x11 << axis)
        # BLE swaps the bytes, in high resolution alone.
        big = self.registers[CTRL_REG4] & 0x48 == 0x48
        return word >> 8 & 0xFF if high != big else word & 0xFF

    # Samples

    def _begin(self) -> None:
        """A new rate or mode: the grid of samples begins now."""
        self._clock.cancel(self._event)
        self._event = None
        if not self.odr_hz:
            return
        self._period = round(SYSCLK_HZ / (self.odr_hz * self._rate))
        self._base = self._clock.now
        self._taken = SETTLING_PERIODS[1 if self.mode == HIGH_RESOLUTION else 0] - 1
        self._event = self._clock.schedule(self._base + self._taken * self._period, self._prime)

    def _prime(self) -> None:
        """The period of the first sample begins."""
        self.motion_source(self._clock.now)
        self._plan()

    def _plan(self) -> None:
        self._taken += 1
        self._event = self._clock.schedule(self._base + self._taken * self._period, self._sample)

    def _sample(self) -> None:
        now = self._clock.now
        felt = self.motion_source(now)
        bits, scales = self.mode
        mg = scales[self.registers[CTRL_REG4] >> 4 & 3]
        enabled = self.registers[CTRL_REG1]
        held = self.registers[CTRL_REG4] & 0x80
        self.samples += 1
        for axis in range(3):
            if not enabled >> axis & 1:
                continue
            value_g = felt[axis] / GRAVITY_M_S2 + self.offset_g[axis]
            if not self._ideal:
                value_g += self._rng.gauss(0.0, self.noise_g)
            # CHOICE: it reaches the last digit, so more than 16 g, as users of the part report.
            limit = 1 << (bits - 1)
            digits = min(max(round(1000.0 * value_g / mg), -limit), limit - 1)
            word = digits << (16 - bits) & 0xFFFF
            if held and self._halves[axis]:
                self._newer[axis] = word
            else:
                self._words[axis] = word
            self._status |= (0x11 if self._status >> axis & 1 else 0x01) << axis
        self._plan()

    @property
    def noise_g(self) -> float:
        """Standard deviation of a realistic sample: the density over the mode's bandwidth."""
        return NOISE_G * sqrt(self.odr_hz / (9.0 if self.mode == HIGH_RESOLUTION else 2.0))


def _at_rest(_cycles: int) -> tuple[float, float, float]:
    return 0.0, 0.0, GRAVITY_M_S2
