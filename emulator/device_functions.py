"""TI's C functions from the device header and the start-up files; `device_h.py` declares them.

Each function accesses the modelled registers as TI's function does, and in the same order; protected registers between
EALLOW and an EDIS that does not nest.  Accesses to modules that are not modelled (trims, unbonded pins) are left out.
Time.  CHOICE: a call takes the time of TI's C code at the prices of `c28x/passes/costs.py`: a field is read, modified
and written, a loop takes its turns.  For functions that reach their registers through pointers, this is too high.
Where the instructions of TI's compiler for this part were counted (optimised, with call and return), that count is
used, with two wait states an access: GPIO_WritePin 36, GPIO_SetupPinMux 75, GPIO_SetupPinOptions 105.  Waits for the
PLL take the PLL's time (`peripherals/sysctrl.py`): five locks, and 2048 periods of its oscillator.
Sources: HDR F2837xS_SysCtrl.c, F2837xS_PieCtrl.c, F2837xS_PieVect.c, F2837xS_Gpio.c, F2837xS_CpuTimers.c,
F2837xS_Adc.c, F2837xS_can.c, F2837xS_Dma.c, F2837xS_ECap.c, F2837xS_EPwm.c, F2837xS_EQep.c, F2837xS_Spi.c,
F2837xS_TempSensorConv.c, F2837xS_usDelay.asm.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

from emulator.c28x.arithmetic import f32
from emulator.c28x.memory import Pointer
from emulator.c28x.passes import costs
from emulator.c28x.runtime import Idling
from emulator.chip import ADC_PIE, ECAP_INPUT, XINT_INPUT, Chip, delay_us
from emulator.clock import SYSCLK_HZ
from emulator.peripherals.dma import CHANNELS, ERRCLR, HARDRESET, PERINTCLR, RUN
from emulator.peripherals.sysctrl import GATES, PLL_LOCK
from emulator.peripherals.temperature_sensor import OFFSET, SLOPE_Q15
from emulator.registers.cell import Cell
from emulator.registers.core import ALL, LOW
from emulator.registers.gpio import PIN_COUNT, PORTS
from emulator.registers.sysctrl import LPMCR

# Flags of GPIO_SetupPinOptions
_PULLUP: Final = 1 << 0
_INVERT: Final = 1 << 1
_OPENDRAIN: Final = 1 << 2
_QUAL_SHIFT: Final = 4
# CAN_CTL.Init and SWR; CAN_IFxCMD.DIR, Arb, Control and Busy
_CAN_INIT: Final = 1 << 0
_CAN_SWR: Final = 1 << 15
_CAN_DIR: Final = 1 << 23
_CAN_ARB: Final = 1 << 21
_CAN_CONTROL: Final = 1 << 20
_CAN_BUSY: Final = 1 << 15
# F28x_usDelay, in cycles
_LOOP: Final = 5
_LOOP_CALL: Final = 9
#: Functions that do nothing here, with their time: nothing else owns the flash, every pin is bonded, no trim is
#: missing, no debugger stops, and TI leaves two functions empty.
_WITHOUT_EFFECT: Final = {
    **dict.fromkeys(("SeizeFlashPump", "SeizeFlashPump_Bank0", "SeizeFlashPump_Bank1", "ReleaseFlashPump"), 22),
    **dict.fromkeys(("GPIO_EnableUnbondedIOPullups", "GPIO_EnableUnbondedIOPullupsFor100Pin"), 44),
    "ConfigureTMXAnalogTrim": 44, "InitECap": 0, "InitECapGpio": 0, "SetDBGIER": 4,
}  # fmt: skip
#: A field assignment.
_FIELD: Final = 2 * costs.REGISTER + costs.REGISTER_FIELD
#: Cycles of one turn of a loop that writes a word through a pointer, and of one that copies a vector.
_CLEAR_TURN: Final = costs.TURN + costs.POINTER
_COPY_TURN: Final = _CLEAR_TURN + costs.POINTER + 2 * costs.LOAD_MEMORY
#: Cycles of functions besides call and register accesses: the counted instructions of TI's compiler, less those.
_WORK: Final = {
    "GPIO_WritePin": 36 - costs.CALL - costs.REGISTER,
    "GPIO_SetupPinMux": 75 + 2 * 8 - costs.CALL - 4 * _FIELD,
    "GPIO_SetupPinOptions": 105 + 2 * 8 - costs.CALL - 4 * _FIELD,
}  # fmt: skip
#: CHOICE: InitSysCtrl sets the PLL up for the LaunchPad's crystal: XTAL_OSC, 10 MHz times 40, by 2.
_XTAL_OSC: Final = 1
_LAUNCHPAD: Final = (_XTAL_OSC, 40, 0, 1)
_LOCKS: Final = 5
#: Periods of the oscillator during which SYSCLK is measured.
_MEASURED: Final = 0x800
#: NOPs between two writes of CLKSRCCTL1.
_OSCILLATOR_DELAY: Final = 300
#: The code at 0 C in TI's conversion, and CHOICE: the time of the conversion, which was not counted.
_KELVIN: Final = 273
_TEMPERATURE: Final = 60
_VREADST, _RWAIT, _BANK_ACTIVE, _ECC_ON = 0x14, 3, 3, 0xA


@dataclass(frozen=True)
class _Pins:
    """Pins that get one function; their pull-up, and the qualification of inputs (None: unchanged)."""

    pins: range
    function: int
    pull_up: bool = False
    qualification: int | None = None


_EPWM_PINS: Final = [_Pins(range(2 * n - 2, 2 * n), 1 if n <= 8 else 5) for n in range(1, 13)]
_EQEP_PINS: Final = [_Pins(range(16 + 4 * n, 20 + 4 * n), (1, 2, 6)[n - 1], qualification=0) for n in (1, 2, 3)]
_SPIA_PINS: Final = [_Pins(range(16, 20), 1, pull_up=True, qualification=3)]
#: Function -> the pins that it sets up (HDR F2837xS_EPwm.c, F2837xS_EQep.c, F2837xS_Spi.c).
_PINS_OF: Final = {
    **{f"InitEPwm{n}Gpio": [pins] for n, pins in enumerate(_EPWM_PINS, 1)}, "InitEPwmGpio": _EPWM_PINS,
    **{f"InitEQep{n}Gpio": [pins] for n, pins in enumerate(_EQEP_PINS, 1)}, "InitEQepGpio": _EQEP_PINS,
    "InitSpiaGpio": _SPIA_PINS, "InitSpiGpio": _SPIA_PINS,
}  # fmt: skip


class DeviceFunctions:
    """The functions of one chip; `externs` are all of them by their names in C."""

    def __init__(self, chip: Chip) -> None:
        self._chip = chip
        self._cpu, self._clock, self._findings = chip.cpu, chip.clock, chip.findings
        #: The argument of InitTempSensor; a global of TI's file, 0 before the call.
        self._sensor_vrefhi_v = 0.0
        names = (n for n in dir(type(self)) if not n.startswith("_"))
        timers = {
            f"{verb}CpuTimer{n}": self._timer_bit(n, mask, on=on)
            for n in range(3)
            for verb, mask, on in (("Start", 1 << 4, False), ("Stop", 1 << 4, True), ("Reload", 1 << 5, True))
        }
        functions: dict[str, Callable[..., Any]] = {n: getattr(self, n) for n in names}
        inputs = {f"GPIO_SetupXINT{n}Gpio": self._input_pin(number) for n, number in XINT_INPUT.items()}
        inputs |= {f"InitECap{n}Gpio": self._input_pin(number) for n, number in ECAP_INPUT.items()}
        pins: dict[str, Callable[..., Any]] = {
            name: partial(self._pins_of, groups) for name, groups in _PINS_OF.items()
        }
        without_effect: dict[str, Callable[..., Any]] = {
            name: partial(self._nothing, cycles) for name, cycles in _WITHOUT_EFFECT.items()
        }
        for bank in (0, 1):
            functions[f"InitFlash_Bank{bank}"] = partial(self._flash_on, bank)
            functions[f"FlashOff_Bank{bank}"] = partial(self._flash_off, bank)
        functions |= {name: partial(self._low_power, name) for name in ("STANDBY", "HALT", "HIB")}
        self.externs = functions | timers | inputs | pins | without_effect | self._dma_functions()

    def _nothing(self, cycles: int, *_arguments: int) -> None:
        """A function that only takes time."""
        self._clock.charge(cycles)

    # The core

    def EALLOW(self) -> None:
        """Allow writes to protected registers."""
        self._cpu.eallow = True

    def EDIS(self) -> None:
        """Forbid writes to protected registers."""
        self._cpu.edis()

    def EINT(self) -> None:
        """Clear INTM.  Latched and enabled interrupts are taken at once."""
        self._cpu.enable_interrupts()

    def DINT(self) -> None:
        """Set INTM."""
        self._cpu.intm = True

    def ERTM(self) -> None:
        """Clear DBGM, which only a debugger sees."""

    def DRTM(self) -> None:
        """Set DBGM, which only a debugger sees."""

    # Time

    def DelayUs(self, microseconds: int) -> None:
        """A busy wait."""
        delay_us(self._clock, microseconds)

    def InitTempSensor(self, vrefhi_voltage: float) -> None:
        """Switch the sensor on, wait for it, and store the reference voltage for the conversions of its results."""
        with self._unprotected():
            self._assign("AnalogSubsysRegs", "TSNSCTL", "ENABLE", 1)
            self.DELAY_US(1000.0)
        self._sensor_vrefhi_v = vrefhi_voltage

    def GetTemperatureC(self, sensorSample: int) -> int:
        """Convert a result to degrees Celsius: add half a degree, then truncate towards 0."""
        return int(f32(self._kelvin(sensorSample) - _KELVIN))

    def GetTemperatureK(self, sensorSample: int) -> int:
        """Convert a result to Kelvin, rounded."""
        return int(self._kelvin(sensorSample))

    def _kelvin(self, sample: int) -> float:
        """The temperature of a result in Kelvin plus 0.5, in the C's floats; the sample is scaled to 2.5 V first."""
        self._clock.charge(_TEMPERATURE)
        code = int(f32(f32(self._sensor_vrefhi_v / 2.5) * sample))
        degrees_q15 = f32((code - OFFSET) * SLOPE_Q15)
        return f32(f32(f32(degrees_q15 + 16384) + 32768 * _KELVIN) / 32768)

    def DELAY_US(self, microseconds: float) -> None:
        """A busy wait; fractions of a microsecond count."""
        delay_us(self._clock, microseconds)

    def F28x_usDelay(self, loops: int) -> None:
        """A busy wait of five cycles a loop, and nine around them.  A count below 0 counts as 0."""
        self._clock.delay(_LOOP * max(loops, 0) + _LOOP_CALL)

    def SysCtl_delay(self, count: int) -> None:
        """driverlib's function for the same wait as F28x_usDelay."""
        self.F28x_usDelay(count)

    # Start-up

    def InitSysCtrl(self) -> None:
        """Watchdog off, the PLL set up, the clock of every module on, the time bases of the ePWM modules included."""
        self.DisableDog()
        self._nothing(_WITHOUT_EFFECT["GPIO_EnableUnbondedIOPullups"])
        self.InitSysPll(*_LAUNCHPAD)
        self.InitPeripheralClocks()

    def InitPeripheralClocks(self) -> None:
        """The clock of every module on; like InitSysCtrl, without the watchdog."""
        with self._unprotected():
            self._clocks_on()

    def DisablePeripheralClocks(self) -> None:
        """The clock of every module off."""
        with self._unprotected():
            for name in GATES:
                self._write("CpuSysRegs", name, 0)

    def InitSysPll(self, clock_source: int, imult: int, fmult: int, divsel: int) -> None:
        """Set up the PLL to make SYSCLK from an oscillator: lock it five times, and measure the result.

        SYSCLK does not change here.
        """
        clocks = self._chip.blocks["ClkCfgRegs"].registers
        source, multiplier, divider = clocks["CLKSRCCTL1"], clocks["SYSPLLMULT"], clocks["SYSCLKDIVSEL"]
        wanted = fmult << 8 | imult
        known = (source.value & 3, multiplier.value, divider.value)
        self._clock.charge(4 * _FIELD)
        if known == (clock_source, wanted, divsel):
            return
        source.value = source.value & ~3 | clock_source & 3
        if multiplier.value != wanted:
            for _ in range(_LOCKS):
                self._chip.sysctrl.start_pll(wanted)
                self._clock.delay(PLL_LOCK)
        # It is measured while SYSCLK is slower, by the next greater divider.
        self._clock.delay(int(_MEASURED * (imult + fmult / 4) / (2 * divsel + 2)))
        self._chip.sysctrl.run_pll(divsel)
        self._chip.sysctrl.check_sysclk()
        self._cpu.edis()

    def SysIntOsc1Sel(self) -> None:
        """INTOSC1 is the source."""
        self._select_oscillator(2)

    def SysIntOsc2Sel(self) -> None:
        """INTOSC2 is the source."""
        self._select_oscillator(0)
        self._clock.delay(_OSCILLATOR_DELAY)

    def SysXtalOscSel(self) -> None:
        """The crystal is the source."""
        self._select_oscillator(_XTAL_OSC)

    def _select_oscillator(self, number: int) -> None:
        with self._unprotected():
            self._clock.charge(3 * _FIELD)
            self._clock.delay(_OSCILLATOR_DELAY)
            source = self._chip.register("ClkCfgRegs", "CLKSRCCTL1")
            source.value = source.value & ~3 | number

    def IDLE(self) -> None:
        """Wait for an interrupt that IER lets through."""
        with self._unprotected():
            self._clock.charge(_FIELD)
            mode = self._chip.register("CpuSysRegs", "LPMCR")
            mode.value = mode.value & ~LPMCR.LPM.mask
        if not self._cpu.idle():
            raise Idling("the CPU sleeps in IDLE(), and no event is left that could wake it")

    def _low_power(self, name: str) -> None:
        message = f"{name}(): low power is not modelled: the CPU goes on at once"
        self._findings.report("unmodelled", message, object=name)

    # Flash

    def InitFlash(self) -> None:
        """Bank 0."""
        self._flash_on(0)

    def FlashOff(self) -> None:
        """Bank 0 asleep."""
        self._flash_off(0)

    def _flash_on(self, bank: int) -> None:
        """Wait states, cache, prefetch and ECC of a bank; its registers only hold them."""
        block = f"Flash{bank}CtrlRegs"
        self._clock.charge(2 * _WITHOUT_EFFECT["ReleaseFlashPump"])
        with self._unprotected():
            for name, field, value in (
                ("FBAC", "VREADST", _VREADST), ("FPAC1", "PMPPWR", 1), ("FBFALLBACK", "BNKPWR0", _BANK_ACTIVE),
                ("FRD_INTF_CTRL", "DATA_CACHE_EN", 0), ("FRD_INTF_CTRL", "PREFETCH_EN", 0),
                ("FRDCNTL", "RWAIT", _RWAIT),
                ("FRD_INTF_CTRL", "DATA_CACHE_EN", 1), ("FRD_INTF_CTRL", "PREFETCH_EN", 1),
            ):  # fmt: skip
                self._assign(block, name, field, value)
            self._assign(f"Flash{bank}EccRegs", "ECC_ENABLE", "ENABLE", _ECC_ON)
        self._clock.charge(8)

    def _flash_off(self, bank: int) -> None:
        with self._unprotected():
            for name, field, value in (
                ("FBAC", "VREADST", _VREADST), ("FBFALLBACK", "BNKPWR0", 0), ("FPAC1", "PMPPWR", 0)
            ):  # fmt: skip
                self._assign(f"Flash{bank}CtrlRegs", name, field, value)

    # Watchdog and interrupts

    def ServiceDog(self) -> None:
        """The two keys of the watchdog."""
        with self._unprotected():
            for key in (0x0055, 0x00AA):
                self._assign("WdRegs", "WDKEY", "WDKEY", key)

    def DisableDog(self) -> None:
        """The watchdog off, its prescaler as it was."""
        with self._unprotected():
            register = self._chip.register("WdRegs", "WDCR")
            self._clock.charge(costs.REGISTER)
            self._put(register, register.read() & 0x0007 | 0x0068)

    def EnableInterrupts(self) -> None:
        """The PIE on, everything acknowledged, interrupts on."""
        self._write("PieCtrlRegs", "PIECTRL", 1)
        self._write("PieCtrlRegs", "PIEACK", 0xFFFF)
        self.EINT()

    def InitPieCtrl(self) -> None:
        """Interrupts off at the CPU and in the PIE, and nothing latched there."""
        self.DINT()
        self._write("PieCtrlRegs", "PIECTRL", 0)
        for kind in ("PIEIER", "PIEIFR"):
            for group in range(1, 13):
                self._write("PieCtrlRegs", f"{kind}{group}", 0)

    def InitPieVectTable(self) -> None:
        """Write a routine that only stops the program into every vector, and switch the PIE on.

        CHOICE: if such a routine runs, that is reported, and the program goes on.
        """
        self._chip.vectors.clear()
        self._cpu.edis()
        self._clock.charge((costs.REGISTER + _COPY_TURN) * 224)
        self._write("PieCtrlRegs", "PIECTRL", 1)

    def InitGpio(self) -> None:
        """Every pin a GPIO input, synchronous, with its latch at 0; pull-ups stay as they are."""
        with self._unprotected():
            for letter in PORTS:
                self._write("GpioCtrlRegs", f"GP{letter}LOCK", 0)
            for letter in PORTS:
                for name in self._chip.blocks["GpioCtrlRegs"].registers:
                    if name.startswith(f"GP{letter}") and not name.endswith("PUD"):
                        self._clock.charge(_CLEAR_TURN)
                        self._write("GpioCtrlRegs", name, 0)
                for action in ("DAT", "SET", "CLEAR", "TOGGLE"):
                    self._write("GpioDataRegs", f"GP{letter}{action}", 0)

    def _clocks_on(self) -> None:
        for name in GATES:
            register = self._chip.register("CpuSysRegs", name)
            gates = [f.mask for f in register.fields.values() if f.modelled]
            self._clock.charge(_FIELD * len(gates) - costs.REGISTER)
            self._put(register, sum(gates))

    # Pins

    def GPIO_SetupPinMux(self, gpioNumber: int, cpu: int, muxPosition: int) -> None:
        """Give a pin a function (GMUX << 2 | MUX) and an owner, by way of the function GPIO."""
        pin = self._pin(gpioNumber)
        if pin is None:
            return
        self._clock.charge(_WORK["GPIO_SetupPinMux"])
        port, bit = pin
        half, owner = bit // 16 + 1, bit // 8 + 1
        with self._unprotected():
            for name, value in ((f"MUX{half}", 0), (f"GMUX{half}", muxPosition >> 2), (f"MUX{half}", muxPosition & 3)):
                self._set(port + name, 3 << 2 * (bit % 16), value << 2 * (bit % 16))
            self._set(f"{port}CSEL{owner}", 0xF << 4 * (bit % 8), cpu << 4 * (bit % 8))

    def GPIO_SetupPinOptions(self, gpioNumber: int, output: int, flags: int) -> None:
        """Direction, pull-up, open drain or inversion, qualification of a pin."""
        pin = self._pin(gpioNumber)
        if pin is None:
            return
        self._clock.charge(_WORK["GPIO_SetupPinOptions"])
        port, bit = pin
        mask = 1 << bit
        with self._unprotected():
            self._set(port + "DIR", mask, mask if output == 1 else 0)
            if output == 1:
                self._set(port + "ODR", mask, mask if flags & _OPENDRAIN else 0)
                self._set(port + "PUD", mask, 0 if flags & (_OPENDRAIN | _PULLUP) else mask)
            else:
                self._set(port + "PUD", mask, 0 if flags & _PULLUP else mask)
                self._set(port + "INV", mask, mask if flags & _INVERT else 0)
            shift = 2 * (bit % 16)
            self._set(f"{port}QSEL{bit // 16 + 1}", 3 << shift, (flags >> _QUAL_SHIFT & 3) << shift)

    def GPIO_SetupLock(self, gpioNumber: int, flags: int) -> None:
        """Lock or unlock the configuration of a pin."""
        pin = self._pin(gpioNumber)
        if pin is not None:
            self._clock.charge(_WORK["GPIO_WritePin"])  # the same C but for the access
            with self._unprotected():
                self._set(pin[0] + "LOCK", 1 << pin[1], 1 << pin[1] if flags else 0)

    def _pins_of(self, groups: list[_Pins]) -> None:
        """The pins of a module: pull-ups, qualification, function, in that order."""
        for group in groups:
            with self._unprotected():
                for pin in group.pins:
                    self._set(f"GP{PORTS[pin // 32]}PUD", 1 << pin % 32, 0 if group.pull_up else 1 << pin % 32)
                for pin in group.pins if group.qualification is not None else ():
                    self._set_pair(pin, "QSEL", group.qualification or 0)
                for pin in group.pins:
                    if group.function >> 2:
                        self._set_pair(pin, "GMUX", group.function >> 2)
                    self._set_pair(pin, "MUX", group.function & 3)

    def InitAPwm1Gpio(self) -> None:
        """The PWM of eCAP1 through OUTPUTXBAR3 on GPIO5; ends in EDIS."""
        with self._unprotected():
            self._assign("OutputXbarRegs", "OUTPUT3MUX0TO15CFG", "MUX0", 3)
            self._assign("OutputXbarRegs", "OUTPUT3MUXENABLE", "MUX0", 1)
            self._set_pair(5, "MUX", 3)

    def _set_pair(self, pin: int, register: str, value: int) -> None:
        """The two bits of a pin in one of the registers that have 16 pins each."""
        shift = 2 * (pin % 16)
        self._set(f"GP{PORTS[pin // 32]}{register}{pin % 32 // 16 + 1}", 3 << shift, value << shift)

    def GPIO_WritePin(self, gpioNumber: int, outVal: int) -> None:
        """Set or clear the latch of a pin."""
        pin = self._pin(gpioNumber)
        if pin is None:
            return
        self._clock.charge(_WORK["GPIO_WritePin"])
        port, bit = pin
        self._write("GpioDataRegs", port + ("SET" if outVal else "CLEAR"), 1 << bit)

    def GPIO_ReadPin(self, gpioNumber: int) -> int:
        """The level of a pin."""
        pin = self._pin(gpioNumber)
        if pin is None:
            return 0
        self._clock.charge(_WORK["GPIO_WritePin"] + costs.REGISTER)  # the same C but for the access
        port, bit = pin
        return self._chip.register("GpioDataRegs", f"{port}DAT").read() >> bit & 1

    def _input_pin(self, number: int) -> Callable[[int], None]:
        def choose(pin: int) -> None:
            with self._unprotected():
                self._write("InputXbarRegs", f"INPUT{number}SELECT", pin)

        return choose

    # SPI

    def InitSpi(self) -> None:
        """SPI-A in loopback: a master of 16-bit words at 500 kHz."""
        for name, field, value in (
            ("SPICCR", "SPISWRESET", 0), ("SPICCR", "CLKPOLARITY", 0), ("SPICCR", "SPICHAR", 16 - 1),
            ("SPICCR", "SPILBK", 1), ("SPICTL", "MASTER_SLAVE", 1), ("SPICTL", "TALK", 1), ("SPICTL", "CLK_PHASE", 0),
            ("SPICTL", "SPIINTENA", 0), ("SPIBRR", "SPI_BIT_RATE", SYSCLK_HZ // 4 // 500_000 - 1),
            ("SPIPRI", "FREE", 1), ("SPICCR", "SPISWRESET", 1),
        ):  # fmt: skip
            self._assign("SpiaRegs", name, field, value)

    # CPU timers

    def InitCpuTimers(self) -> None:
        """All three stopped, with the longest period."""
        for n in range(3):
            self._load_timer(n, 0xFFFFFFFF)

    def ConfigCpuTimer(self, timer: int, Freq: float, Period: float) -> None:
        """Stop timer `timer`; `Freq` MHz times `Period` us a period, its interrupt on."""
        self._load_timer(timer, int(Freq * Period) - 1 & 0xFFFFFFFF)
        control = self._chip.register(f"CpuTimer{timer}Regs", "TCR")
        control.modify(~(1 << 10 | 1 << 11), 1 << 14, ALL)

    def _load_timer(self, n: int, period: int) -> None:
        block = f"CpuTimer{n}Regs"
        self._write(block, "PRD", period)
        self._write(block, "TPR", 0)
        self._write(block, "TPRH", 0)
        for bit in (1 << 4, 1 << 5):
            self._timer_bit(n, bit, on=True)()

    def _timer_bit(self, n: int, mask: int, *, on: bool) -> Callable[[], None]:
        control = self._chip.register(f"CpuTimer{n}Regs", "TCR")

        def act() -> None:
            self._clock.charge(_FIELD)
            control.modify(~mask, mask if on else 0, ALL)

        return act

    # ADC

    def AdcSetMode(self, adc: int, resolution: int, signalmode: int) -> None:
        """Resolution and signal mode of one ADC: it writes protected registers without an EALLOW of its own.

        The trims come from OTP; this part's OTP is unprogrammed, so the routine skips them.
        """
        if adc >= len(ADC_PIE):
            message = f"AdcSetMode({adc}): the ADCs are ADC_ADCA (0) to ADC_ADCD (3), and nothing is done"
            self._findings.report("not-configured", message, object=f"ADC {adc}", value=adc)
            return
        register = self._chip.register(f"Adc{'abcd'[adc]}Regs", "ADCCTL2")
        self._clock.charge(40)
        register.write(register.read() & ~(1 << 7 | 1 << 6) | (signalmode & 1) << 7 | (resolution & 1) << 6, ALL)

    # DMA

    def InitCAN(self) -> None:
        """CAN-A stopped and reset, none of its objects valid.

        As in TI's code, each field assignment writes the whole command, and so starts a transfer too.
        """
        block = "CanaRegs"
        for mask in (_CAN_INIT, _CAN_SWR):
            self._modify(block, "CAN_CTL", mask, mask)
        for n in (1, 2):
            for mask in (_CAN_DIR, _CAN_ARB, _CAN_CONTROL):
                self._modify(block, f"CAN_IF{n}CMD", mask, mask)
            self._write(block, f"CAN_IF{n}ARB", 0)
            self._write(block, f"CAN_IF{n}MCTL", 0)
        for number in range(1, 33):
            command = self._chip.register(block, f"CAN_IF{2 - number % 2}CMD")
            while command.read() & _CAN_BUSY and self._chip.blocks[block].clocked:
                self._clock.charge(costs.REGISTER)
            self._clock.charge(2 * costs.REGISTER)
            command.modify(~0xFF, number, LOW)
        self._clock.charge(costs.REGISTER)
        self._chip.register(block, "CAN_ES").read()

    def DMAInitialize(self) -> None:
        """The module reset, and running on when a debugger halts."""
        with self._unprotected():
            self._write("DmaRegs", "DMACTRL", HARDRESET)
            self._clock.charge(1)
            self._modify("DmaRegs", "DEBUGCTRL", 1 << 15, 1 << 15)

    def _dma_functions(self) -> dict[str, Callable[..., Any]]:
        """The functions of every channel, by their names in C."""
        found: dict[str, Callable[..., Any]] = {}
        for n in range(1, CHANNELS + 1):
            prefix = f"DMACH{n}"
            found |= {
                f"{prefix}AddrConfig": partial(self._dma_addresses, n),
                f"{prefix}AddrConfig32bit": partial(self._dma_addresses, n),
                f"{prefix}BurstConfig": partial(
                    self._dma_words, n, ("BURST_SIZE", "SRC_BURST_STEP", "DST_BURST_STEP")
                ),
                f"{prefix}TransferConfig": partial(
                    self._dma_words, n, ("TRANSFER_SIZE", "SRC_TRANSFER_STEP", "DST_TRANSFER_STEP")
                ),
                f"{prefix}WrapConfig": partial(
                    self._dma_words, n, ("SRC_WRAP_SIZE", "SRC_WRAP_STEP", "DST_WRAP_SIZE", "DST_WRAP_STEP")
                ),
                f"{prefix}ModeConfig": partial(self._dma_mode, n),
                f"StartDMACH{n}": partial(self._dma_start, n),
            }
        return found

    def _dma_addresses(self, n: int, destination: Pointer, source: Pointer) -> None:
        """Set source and destination, and the addresses that they wrap to."""
        with self._unprotected():
            for side, pointer in (("SRC", source), ("DST", destination)):
                for name in ("BEG_ADDR", "ADDR"):
                    self._write("DmaRegs", f"CH{n}.{side}_{name}_SHADOW", pointer.addr & ALL)

    def _dma_words(self, n: int, names: tuple[str, ...], *words: int) -> None:
        """Sizes and steps."""
        with self._unprotected():
            for name, word in zip(names, words, strict=True):
                self._write("DmaRegs", f"CH{n}.{name}", word & 0xFFFF)

    def _dma_mode(
        self, n: int, persel: int, perinte: int, oneshot: int, cont: int, _synce: int, _syncsel: int, ovrinte: int,
        datasize: int, chintmode: int, chinte: int,
    ) -> None:  # fmt: skip
        """Trigger and mode, field by field; nothing latched; the interrupt on in the PIE."""
        with self._unprotected():
            shift = 8 * ((n - 1) % 4)
            self._modify("DmaClaSrcSelRegs", f"DMACHSRCSEL{1 + (n - 1) // 4}", 0xFF << shift, persel << shift)
            fields = (
                ("PERINTSEL", n), ("PERINTE", perinte), ("ONESHOT", oneshot), ("CONTINUOUS", cont),
                ("OVRINTE", ovrinte), ("DATASIZE", datasize), ("CHINTMODE", chintmode), ("CHINTE", chinte),
            )  # fmt: skip
            for name, value in fields:
                field = self._chip.register("DmaRegs", f"CH{n}.MODE").fields[name]
                self._modify("DmaRegs", f"CH{n}.MODE", field.mask, value << field.lo)
            for bit in (PERINTCLR, ERRCLR):
                self._modify("DmaRegs", f"CH{n}.CONTROL", bit, bit)
            self._modify("PieCtrlRegs", "PIEIER7", 1 << n - 1, 1 << n - 1)

    def _dma_start(self, n: int) -> None:
        """The channel on."""
        with self._unprotected():
            self._modify("DmaRegs", f"CH{n}.CONTROL", RUN, RUN)

    # Accesses

    def _modify(self, block: str, name: str, mask: int, bits: int) -> None:
        """A field assignment."""
        self._clock.charge(_FIELD)
        self._chip.register(block, name).modify(~mask, bits & mask, ALL)

    def _assign(self, block: str, name: str, field: str, value: int) -> None:
        """The same, by the field's name."""
        known = self._chip.register(block, name).fields[field]
        self._modify(block, name, known.mask, value << known.lo)

    @contextmanager
    def _unprotected(self) -> Iterator[None]:
        """Between EALLOW and EDIS."""
        self._cpu.eallow = True
        yield
        self._cpu.edis()

    def _write(self, block: str, name: str, word: int) -> None:
        self._put(self._chip.register(block, name), word)

    def _put(self, register: Cell, word: int) -> None:
        self._clock.charge(costs.REGISTER)
        register.write(word, ALL)

    def _set(self, name: str, mask: int, bits: int) -> None:
        self._modify("GpioCtrlRegs", name, mask, bits)

    def _pin(self, n: int) -> tuple[str, int] | None:
        """The prefix of a pin's port, and the pin's bit there; None for a pin that does not exist."""
        if n >= PIN_COUNT:
            message = f"GPIO{n} does not exist: pins are 0 to {PIN_COUNT - 1}, and the access goes beyond the last port"
            self._findings.report("index", message, object=f"GPIO{n}", value=n)
            return None
        return f"GP{PORTS[n // 32]}", n % 32
