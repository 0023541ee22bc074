"""L3G4200D three-axis gyro on SPI or I2C.

Modelled: 4-wire SPI framing (RW, MS, bursts, words of any length inside one chip select), I2C framing with both
addresses while chip select is high, the whole register file, output data rates, power-down, sleep and normal mode,
paths and filters, BDU, BLE, FIFO, STATUS, interrupt generator, INT1 and DRDY pins, self test, temperature,
imperfections of a specimen.
Not modelled: 3-wire SPI (SIM is stored and reported), set-up and hold times of both buses, supply, BOOT beyond its bit.
Time: lazy.  Samples have a grid of whole cycles that begins when a setting takes effect.  They are computed when the
firmware reads.  There is an event for each sample only while a pin reports samples.  `rate_source` is called in the
order of the sample times, which may be in the past.  A sample that was not read, and that nothing keeps (bypass or
stream mode, no interrupt enabled), is computed only if it is still in the memory of the filters in the path.
Sources: L3G sections on SPI, I2C, registers, FIFO.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import ClassVar, Final

from emulator.clock import CYCLES_PER_MS, NEVER, SYSCLK_HZ, Clock, ClockEvent
from emulator.devices import l3g4200d_registers as r
from emulator.devices.l3g4200d_fifo import DEPTH, SampleFifo
from emulator.devices.l3g4200d_i2c import I2cFrame
from emulator.devices.l3g4200d_interrupt import InterruptGenerator
from emulator.devices.l3g4200d_output import OutputRegisters
from emulator.devices.l3g4200d_readings import TURN_ON_CYCLES, GyroReadings
from emulator.devices.l3g4200d_signal import Digits, GyroUnit, SignalPath
from emulator.devices.l3g4200d_spi import GREATEST_CLOCK_HZ, SpiFrame
from emulator.devices.report import DeviceReport, DiscardedReports, Mark
from emulator.signals import Wire

#: CHOICE: duration of BOOT, from ST's example for a register-identical part.
BOOT_CYCLES: Final = 10 * CYCLES_PER_MS

_BY_ADDRESS: Final = {register.address: register for register in r.REGISTERS}
_WRITABLE: Final = {a: d.writable for a, d in _BY_ADDRESS.items() if d.access is r.Rw.RW}
# Under their own names, because every byte of a measurement compares with them.
OUT_X_L: Final = r.OUT_X_L
OUT_Z_H: Final = r.OUT_Z_H
CTRL_REG4: Final = r.CTRL_REG4
_STILL: tuple[float, float, float] = (0.0, 0.0, 0.0)


class L3G4200D:
    """The device.

    For the bus: `select`, `exchange`, `i2c`, `int1`, `drdy`.  For the world: `set_rate_source`, `set_temperature`.  For
    tests: `force_samples`.

    `rate_source(cycles)` returns rad/s about x, y, z, positive counter-clockwise.  `ideal` is the perfect specimen:
    no offset, noise, LPF1 delay or settling, exact data rate.  `report(rule, message)` is called for mistakes of the
    driver; `mark()` returns the value that `report` takes as `since` (`report.py`).
    `sdo` is the level of that pin on an I2C, where it is the lowest bit of the address.
    `temperature_zero_c` is where OUT_TEMP reads 0 (CHOICE: the sheet leaves the offset open).
    """

    #: Address -> name, for code that decodes the bus.
    register_names: ClassVar[dict[int, str]] = {register.address: register.name for register in r.REGISTERS}

    def __init__(
        self,
        clock: Clock,
        *,
        rng: random.Random,
        ideal: bool = True,
        temperature_c: float = 25.0,
        temperature_zero_c: float = 25.0,
        unit: GyroUnit | None = None,
        rate_source: Callable[[int], tuple[float, float, float]] | None = None,
        int1: Wire | None = None,
        drdy: Wire | None = None,
        report: DeviceReport | None = None,
        mark: Callable[[], Mark] | None = None,
        sdo: int = 0,
    ) -> None:
        self.clock = clock
        self.unit = unit or (GyroUnit() if ideal else GyroUnit.drawn(rng))
        self.rate_source = rate_source or (lambda _cycles: _STILL)
        self.int1 = int1 or Wire("L3G4200D.INT1")
        self.drdy = drdy or Wire("L3G4200D.DRDY")
        self.report: DeviceReport = report or DiscardedReports()
        self.readings = GyroReadings(clock, self.report, mark or tuple)
        #: Axis of an idle output that the present transaction has read, -1 for none.
        self.idle_axis = -1
        #: Axes whose outputs are never filled, and whether the next read finds an enabled FIFO in bypass mode.
        self._idle_axes = 7
        self._bypassed = False
        self.path = SignalPath(self.unit, rng, temperature_c)
        self._forced: Callable[[int], Digits] | None = None
        self.fifo = SampleFifo()
        self.spi = SpiFrame(self, self.report)
        #: The device on an I2C: `bus.attach(gyro.i2c.address, gyro.i2c)`.
        self.i2c = I2cFrame(self, self.spi, sdo, self.report)
        #: For the bus: chip select and words of the bus go directly to the framing.
        self.select = self.spi.select
        self.exchange = self.spi.exchange
        self.greatest_clock_hz = GREATEST_CLOCK_HZ
        self._event: ClockEvent | None = None
        self._second_cycles = float(SYSCLK_HZ)
        self.interrupt = InterruptGenerator()
        self._temperature_c = temperature_c
        self._temperature_zero_c = temperature_zero_c
        self._special: dict[int, Callable[[], int]] = {
            r.CTRL_REG5: self._read_ctrl_reg5,
            r.REFERENCE: self._read_reference,
            r.OUT_TEMP: self._read_out_temp,
            r.STATUS_REG: self._read_status,
            r.FIFO_SRC_REG: self._read_fifo_src,
            r.INT1_SRC: self._read_int1_src,
            r.WHO_AM_I: self._read_who_am_i,
        }
        #: How often the identity was read before anything was written.
        self.asked = 0
        self.written = False
        self.reset()

    def reset(self) -> None:
        """Power on at the present time: registers at their reset values, power-down, outputs zero."""
        now = self.clock.now
        self.registers = [0] * 64
        for register in r.REGISTERS:
            self.registers[register.address] = register.reset
        self.fifo.configure(False, 0, 0)
        self.interrupt.configure(0, [0, 0, 0], 0)
        self.readings.settled_at = self.readings.period = 0
        self.outputs = OutputRegisters(self.fifo, now, self.readings)
        self.spi.reset()
        self.i2c.reset()
        self._index = 0
        self._index_base = 0
        self._time_base = now
        self._period = 0
        self._next_sample = NEVER
        self._awake_since = now
        self._boot_end = now
        self._temperature_tick = 0
        self._temperature_byte = 0
        self.clock.cancel(self._event)
        self._event = None
        self._apply_settings()

    # For the world

    def set_rate_source(self, source: Callable[[int], tuple[float, float, float]]) -> None:
        """Set the source of its rotation from now on: rad/s about x, y, z at a virtual time in cycles."""
        self.rate_source = source

    @property
    def temperature_c(self) -> float:
        """The temperature of the die."""
        return self._temperature_c

    def set_temperature(self, temperature_c: float) -> None:
        """Set the temperature of the die from now on.  OUT_TEMP shows it at its next refresh."""
        self._catch_up()
        self._latch_temperature()
        self._temperature_c = temperature_c
        self.path.set_temperature(temperature_c)

    def force_samples(self, samples: Callable[[int], Digits] | None) -> None:
        """Make each sample from now on `samples(cycles)`: x, y, z in digits, whatever the rate.  None: by the rate."""
        self._catch_up()
        self._forced = samples

    @property
    def last_sample_index(self) -> int:
        """Number of the sample that the latest output byte came from; 0 before the first."""
        return self.outputs.last_sample_index

    @property
    def last_sample_cycles(self) -> int:
        """Virtual time of that sample."""
        return self.outputs.last_sample_cycles

    @property
    def samples_read_twice(self) -> int:
        """The number of reads of a high byte that had been read before for the same sample."""
        return self.outputs.samples_read_twice

    @property
    def period_cycles(self) -> int:
        """Time between samples, 0 while none are taken."""
        return self._period

    # For the bus

    def after(self, address: int) -> int:
        """The next address of a burst.

        With the FIFO in use OUT_Z_H is followed by OUT_X_L.  CHOICE: in bypass the pointer runs on, and wraps at the
        end of the six address bits.
        """
        if address == OUT_Z_H and self.fifo.in_use:
            return OUT_X_L
        return address + 1 & 0x3F

    # Register file

    def read_register(self, address: int) -> int:
        """One byte as the serial interface reads it, with its side effects.  Reserved addresses read 0 (CHOICE)."""
        if OUT_X_L <= address <= OUT_Z_H:
            if self.clock.now >= self._next_sample:
                self._catch_up()
            if self._bypassed or self.idle_axis >= 0 or self._idle_axes >> (address - OUT_X_L >> 1) & 1:
                self._check_use(address - OUT_X_L >> 1)
            byte = self.outputs.read(address, self.registers[CTRL_REG4])
            if self._pins_in_use:
                self._update_pins()
            return byte
        special = self._special.get(address)
        if special is not None:
            return special()
        if address not in _BY_ADDRESS:
            self.report("device-register", f"L3G4200D: reserved register {address:#04x} was read")
            return 0
        return self.registers[address]

    def _check_use(self, axis: int) -> None:
        """Report the read of an output that is never filled, or that an enabled FIFO in bypass mode does not feed."""
        if self._bypassed:
            self._bypassed = False
            self.readings.bypassed()
        if not self._idle_axes >> axis & 1:
            self.idle_axis = -1  # a burst from OUT_X on, for the sake of a later axis
        elif not self.registers[r.CTRL_REG1] & 8:
            self.readings.idle(axis, powered=False)
        else:
            self.idle_axis = axis

    def deselected(self) -> None:
        """The transaction read only axes that are disabled."""
        self.readings.idle(self.idle_axis, powered=True)
        self.idle_axis = -1

    def write_register(self, address: int, byte: int) -> None:
        """One byte as the serial interface writes it."""
        self.written = True
        writable = _WRITABLE.get(address)
        if writable is None:
            kind = "read-only" if address in _BY_ADDRESS else "reserved"
            self.report("device-register", f"L3G4200D: {kind} register {address:#04x} was written with {byte:#04x}")
            return
        self._catch_up()
        if address == r.CTRL_REG2 and byte & 0xC0:
            self.report("device-register", f"L3G4200D: CTRL_REG2 was written with {byte:#04x}; bits 7:6 must stay 0")
        if address == r.CTRL_REG4 and byte & 1:
            self.report("unmodelled", "L3G4200D: CTRL_REG4.SIM (3-wire SPI) is not modelled: SDO stays released")
        if address == r.CTRL_REG1:
            self._write_ctrl_reg1(self.registers[address], byte)
        self.registers[address] = byte & writable
        if address == r.CTRL_REG5 and byte & 0x80:
            self._boot_end = self.clock.now + BOOT_CYCLES
        self._apply_settings()

    def _write_ctrl_reg1(self, old: int, new: int) -> None:
        """A change of rate or power restarts the sample grid; a newly enabled axis starts without flags."""
        now = self.clock.now
        self._latch_temperature()
        was_on, is_on = bool(old & 8), bool(new & 8)
        was_sampling, sampling = was_on and bool(old & 7), is_on and bool(new & 7)
        if is_on and not was_on:
            self._awake_since = now
            self._temperature_tick = 0
            self.readings.settled_at = now + TURN_ON_CYCLES
        for axis in range(3):
            if new >> axis & 1 and not old >> axis & 1:
                self.outputs.enable_axis(axis)
        if sampling and not was_sampling:
            self.path.restart()
        if not sampling:
            self._period = 0
        elif not was_sampling or (old ^ new) & 0xC0:
            # CHOICE: the first sample comes one period after the setting.
            self._period = self._of_rate(new >> 6)
            self._time_base = now
            self._index_base = self._index
        self.readings.period = self._period
        self._plan_sample()

    def _of_rate(self, rate: int) -> int:
        return round(self._second_cycles / (r.ODR_HZ[rate] * (1.0 + self.unit.odr_error)))

    def set_second(self, cycles: float) -> None:
        """Set the length of a second of its own oscillator.  The grid of samples goes on from the latest sample."""
        self._catch_up()
        self._second_cycles = cycles
        if self._period:
            self._time_base += (self._index - self._index_base) * self._period
            self._index_base = self._index
            self._period = self.readings.period = self._of_rate(self.registers[r.CTRL_REG1] >> 6)
            self._plan_sample()
            self._plan_event()

    def _apply_settings(self) -> None:
        regs = self.registers
        self.path.configure(
            regs[r.CTRL_REG1], regs[r.CTRL_REG2], regs[r.CTRL_REG4], regs[r.CTRL_REG5], regs[r.REFERENCE]
        )
        fifo_ctrl = regs[r.FIFO_CTRL_REG]
        self.fifo.configure(bool(regs[r.CTRL_REG5] & 0x40), fifo_ctrl >> 5, fifo_ctrl & 0x1F)
        thresholds = [regs[a] << 8 | regs[a + 1] for a in (r.INT1_THS_XH, r.INT1_THS_XH + 2, r.INT1_THS_XH + 4)]
        self.interrupt.configure(regs[r.INT1_CFG], thresholds, regs[r.INT1_DURATION])
        self.four_wire = not regs[CTRL_REG4] & 1
        self._idle_axes = ~regs[r.CTRL_REG1] & 7 if regs[r.CTRL_REG1] & 8 else 7
        self._bypassed = bool(regs[r.CTRL_REG5] & 0x40 and not fifo_ctrl >> 5)
        ctrl3 = regs[r.CTRL_REG3]
        #: Whether the level of a pin depends on samples.
        self._pins_in_use = bool(ctrl3 & 0x0F) or bool(ctrl3 & 0x80 and self.interrupt.enabled)
        self.outputs.restart_set()
        self._update_pins()
        self._plan_event()

    def _read_who_am_i(self) -> int:
        self.asked += not self.written
        return self.registers[r.WHO_AM_I]

    def _read_ctrl_reg5(self) -> int:
        word = self.registers[r.CTRL_REG5]
        return word if self.clock.now < self._boot_end else word & 0x7F

    def _read_reference(self) -> int:
        if self.path.resets_on_reference_read:
            self._catch_up()
            self.path.reset_high_pass()
        return self.registers[r.REFERENCE]

    def _read_out_temp(self) -> int:
        self._latch_temperature()
        return self._temperature_byte

    def _latch_temperature(self) -> None:
        """OUT_TEMP, -1 LSB per degree.  CHOICE: refreshed on leaving power-down and every second from there."""
        if not self.registers[r.CTRL_REG1] & 8:
            return
        tick = (self.clock.now - self._awake_since) // SYSCLK_HZ + 1
        if tick > self._temperature_tick:
            self._temperature_tick = tick
            self._temperature_byte = round(self._temperature_zero_c - self._temperature_c) & 0xFF

    def _read_status(self) -> int:
        self._catch_up()
        return self.outputs.status(self.registers[r.CTRL_REG1] & 7)

    def _read_fifo_src(self) -> int:
        self._catch_up()
        return self.fifo.source()

    def _read_int1_src(self) -> int:
        self._catch_up()
        word = self.interrupt.read_source()
        self._update_pins()
        return word

    # Samples

    def _catch_up(self) -> None:
        """Take the samples that are due and can still have an effect."""
        now = self.clock.now
        if now < self._next_sample:
            return
        due = self._index_base + (now - self._time_base) // self._period
        while self._index < due:
            if not (self.interrupt.enabled or self.fifo.needs_every_sample or self._forced):
                keep = self.path.memory_samples + (DEPTH if self.fifo.active else 1)
                self._index = max(self._index, due - keep)
            self._take_sample()
        self._plan_sample()

    def _plan_sample(self) -> None:
        """Compute when the next sample on the grid is due."""
        after = self._index + 1 - self._index_base
        self._next_sample = self._time_base + after * self._period if self._period else NEVER

    def _take_sample(self) -> None:
        self._index += 1
        cycles = self._time_base + (self._index - self._index_base) * self._period
        awake_s = (cycles - self._awake_since) / SYSCLK_HZ
        if self._forced is None:
            out, watched = self.path.sample(self.rate_source(cycles), awake_s)
        else:
            out = watched = self._forced(cycles)
        sample = self.outputs.update(out, self.registers[r.CTRL_REG1], self._index, cycles)
        if self.fifo.active:
            self.fifo.push(sample)
        if self.interrupt.enabled and self.interrupt.step(watched):
            self.fifo.trigger()
            if self.path.resets_on_interrupt:
                self.path.reset_high_pass()

    # Pins

    def _plan_event(self) -> None:
        """Schedule one event for the next change of a pin that no access causes."""
        self.clock.cancel(self._event)
        self._event = None
        now = self.clock.now
        change = NEVER
        if self._period and self._pins_in_use:
            change = self._time_base + ((now - self._time_base) // self._period + 1) * self._period
        if self.registers[r.CTRL_REG3] & 0x40 and now < self._boot_end < change:
            change = self._boot_end
        if change < NEVER:
            self._event = self.clock.schedule(change, self._on_event)

    def _on_event(self) -> None:
        self._catch_up()
        self._update_pins()
        self._plan_event()

    def _update_pins(self) -> None:
        """INT1 obeys H_Lactive and PP_OD; DRDY is push-pull and active high, the OR of what is enabled."""
        ctrl3 = self.registers[r.CTRL_REG3]
        active = bool(ctrl3 & 0x80 and self.interrupt.active) or bool(ctrl3 & 0x40 and self.clock.now < self._boot_end)
        level = int(active) ^ (ctrl3 >> 5 & 1)
        self.int1.drive("L3G4200D", None if ctrl3 & 0x10 and level else level)
        drdy = 0
        if ctrl3 & 0x0F:
            source = self.fifo.source()
            drdy = (
                (ctrl3 >> 3 & self.outputs.status(self.registers[r.CTRL_REG1] & 7) >> 3 & 1)
                | (ctrl3 >> 2 & source >> 7 & 1)
                | (ctrl3 >> 1 & source >> 6 & 1)
                | (ctrl3 & source >> 5 & 1)
            )
        self.drdy.drive("L3G4200D", drdy)
