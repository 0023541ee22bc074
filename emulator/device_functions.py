"""What the device header and TI's start-up files give a C program besides registers: `device_h.py` declares it.

Each function does to the modelled registers what TI's does, in its order, through the registers' own access: protected
ones between EALLOW and an EDIS that does not nest.  What those files do to modules that are not modelled (PLL, flash
wait states, trims, unbonded pins) is left out.  CHOICE: the time of a call is a sum over its register accesses.
Sources: HDR F2837xS_SysCtrl.c, F2837xS_PieCtrl.c, F2837xS_PieVect.c, F2837xS_Gpio.c, F2837xS_CpuTimers.c,
F2837xS_Adc.c, F2837xS_can.c, F2837xS_Dma.c, F2837xS_ECap.c, F2837xS_EPwm.c, F2837xS_EQep.c, F2837xS_Spi.c,
F2837xS_usDelay.asm.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

from emulator.c28x.memory import Pointer
from emulator.c28x.passes import costs
from emulator.chip import ADC_PIE, ECAP_INPUT, XINT_INPUT, Chip, delay_us
from emulator.peripherals.dma import CHANNELS, ERRCLR, HARDRESET, PERINTCLR, RUN
from emulator.peripherals.sysctrl import GATES
from emulator.registers.cell import Cell
from emulator.registers.core import ALL, LOW
from emulator.registers.gpio import PIN_COUNT, PORTS

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
#: The flash has no wait states here, nobody else has it, every pin is bonded, and TI leaves two functions empty.
_WITHOUT_EFFECT: Final = (
    "InitFlash", "InitFlash_Bank0", "InitFlash_Bank1", "SeizeFlashPump", "SeizeFlashPump_Bank0",
    "SeizeFlashPump_Bank1", "ReleaseFlashPump", "GPIO_EnableUnbondedIOPullups", "InitECap", "InitECapGpio",
)  # fmt: skip


@dataclass(frozen=True)
class _Pins:
    """Pins that get one function, their pull-up, and the qualification of inputs (None: left as it is)."""

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
        without_effect: dict[str, Callable[..., Any]] = dict.fromkeys(_WITHOUT_EFFECT, self._nothing)
        self.externs = functions | timers | inputs | pins | without_effect | self._dma_functions()

    @staticmethod
    def _nothing() -> None:
        """What a function does that has nothing to do here."""

    # The core

    def EALLOW(self) -> None:
        """Protected registers may be written."""
        self._cpu.eallow = True

    def EDIS(self) -> None:
        """They may not."""
        self._cpu.eallow = False

    def EINT(self) -> None:
        """Clear INTM: what is latched and enabled is taken at once."""
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

    def DELAY_US(self, microseconds: float) -> None:
        """A busy wait, of fractions too."""
        delay_us(self._clock, microseconds)

    def F28x_usDelay(self, loops: int) -> None:
        """A busy wait of five cycles a loop and nine around them; a count below 0 is as short as 0."""
        self._clock.delay(_LOOP * max(loops, 0) + _LOOP_CALL)

    def SysCtl_delay(self, count: int) -> None:
        """The same, of driverlib."""
        self.F28x_usDelay(count)

    # Start-up

    def InitSysCtrl(self) -> None:
        """Watchdog off, and the clock of every module on, the time bases of the ePWM modules included."""
        with self._unprotected():
            self._write("WdRegs", "WDCR", 0x0068)
            self._clocks_on()

    def InitPeripheralClocks(self) -> None:
        """The clock of every module on; like InitSysCtrl, without the watchdog."""
        with self._unprotected():
            self._clocks_on()

    def ServiceDog(self) -> None:
        """The two keys of the watchdog."""
        with self._unprotected():
            self._write("WdRegs", "WDKEY", 0x0055)
            self._write("WdRegs", "WDKEY", 0x00AA)

    def DisableDog(self) -> None:
        """The watchdog off, its prescaler as it was."""
        with self._unprotected():
            register = self._chip.register("WdRegs", "WDCR")
            self._put(register, register.read() | 0x0068)

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
        """A routine that only stops in every vector, and the PIE on.

        CHOICE: one that is taken is reported, and the program goes on.
        """
        self._chip.vectors.clear()
        self._cpu.eallow = False
        self._clock.charge(costs.REGISTER * 224)
        self._write("PieCtrlRegs", "PIECTRL", 1)

    def InitGpio(self) -> None:
        """Every pin a GPIO input, synchronous, with its latch at 0; pull-ups stay as they are."""
        with self._unprotected():
            for letter in PORTS:
                self._write("GpioCtrlRegs", f"GP{letter}LOCK", 0)
            for letter in PORTS:
                for name in self._chip.blocks["GpioCtrlRegs"].registers:
                    if name.startswith(f"GP{letter}") and not name.endswith("PUD"):
                        self._write("GpioCtrlRegs", name, 0)
                for action in ("DAT", "SET", "CLEAR", "TOGGLE"):
                    self._write("GpioDataRegs", f"GP{letter}{action}", 0)

    def _clocks_on(self) -> None:
        for name in GATES:
            register = self._chip.register("CpuSysRegs", name)
            self._put(register, sum(f.mask for f in register.fields.values() if f.modelled))

    # Pins

    def GPIO_SetupPinMux(self, gpioNumber: int, cpu: int, muxPosition: int) -> None:
        """Give a pin a function (GMUX << 2 | MUX) and an owner, by way of the function GPIO."""
        pin = self._pin(gpioNumber)
        if pin is None:
            return
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

    def _set_pair(self, pin: int, register: str, value: int) -> None:
        """The two bits of a pin in one of the registers that have 16 pins each."""
        shift = 2 * (pin % 16)
        self._set(f"GP{PORTS[pin // 32]}{register}{pin % 32 // 16 + 1}", 3 << shift, value << shift)

    def GPIO_WritePin(self, gpioNumber: int, outVal: int) -> None:
        """Set or clear the latch of a pin."""
        pin = self._pin(gpioNumber)
        if pin is None:
            return
        port, bit = pin
        self._write("GpioDataRegs", port + ("SET" if outVal else "CLEAR"), 1 << bit)

    def GPIO_ReadPin(self, gpioNumber: int) -> int:
        """The level of a pin."""
        pin = self._pin(gpioNumber)
        if pin is None:
            return 0
        port, bit = pin
        self._clock.charge(costs.REGISTER)
        return self._chip.register("GpioDataRegs", f"{port}DAT").read() >> bit & 1

    def _input_pin(self, number: int) -> Callable[[int], None]:
        def choose(pin: int) -> None:
            with self._unprotected():
                self._write("InputXbarRegs", f"INPUT{number}SELECT", pin)

        return choose

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
            self._clock.charge(2 * costs.REGISTER)
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
        """Those that each channel has, by their names in C."""
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
        """Source and destination, and where they wrap to."""
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
        self._clock.charge(2 * costs.REGISTER)
        self._chip.register(block, name).modify(~mask, bits & mask, ALL)

    @contextmanager
    def _unprotected(self) -> Iterator[None]:
        """Between EALLOW and EDIS."""
        self._cpu.eallow = True
        yield
        self._cpu.eallow = False

    def _write(self, block: str, name: str, word: int) -> None:
        self._put(self._chip.register(block, name), word)

    def _put(self, register: Cell, word: int) -> None:
        self._clock.charge(costs.REGISTER)
        register.write(word, ALL)

    def _set(self, name: str, mask: int, bits: int) -> None:
        register = self._chip.register("GpioCtrlRegs", name)
        self._put(register, register.read() & ~mask | bits)

    def _pin(self, n: int) -> tuple[str, int] | None:
        """The prefix of a pin's port, and its bit there.  Of a pin that does not exist nothing is touched."""
        if n >= PIN_COUNT:
            message = f"GPIO{n} does not exist: pins are 0 to {PIN_COUNT - 1}, and the access goes beyond the last port"
            self._findings.report("index", message, object=f"GPIO{n}", value=n)
            return None
        return f"GP{PORTS[n // 32]}", n % 32
