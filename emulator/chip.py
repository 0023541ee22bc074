"""The TMS320F28377S: its register blocks at their addresses, its peripherals, and the wiring between them.

The addresses of the instances come from the DS memory map and HDR.  The chip's connections to the outside are pins
(`pins[n]` is GPIOn), analog inputs and the buses behind the pin multiplexer.  A board (`hil/board.py`) connects devices
to them.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from functools import partial
from random import Random
from typing import Any, Final, ParamSpec, TypeVar

from emulator.blocks import BLOCKS, UNMODELLED, UNMODELLED_AT
from emulator.c28x.findings import Cause, Findings
from emulator.c28x.memory import Memory
from emulator.can_bus import CanBus, CanPort
from emulator.clock import CYCLES_PER_US, Clock
from emulator.cpu import Cpu
from emulator.peripherals.adc import Adc
from emulator.peripherals.adc_socs import ADCEXTSOC, TRIGSELS
from emulator.peripherals.can import Can
from emulator.peripherals.cmpss import Cmpss
from emulator.peripherals.cpu_timer import CpuTimer
from emulator.peripherals.dac import Dac
from emulator.peripherals.dma import Dma
from emulator.peripherals.dma_checks import Region
from emulator.peripherals.ecap import ECap
from emulator.peripherals.epwm import EPwm
from emulator.peripherals.epwm_xbar import TRIPS, EPwmXbar
from emulator.peripherals.eqep import EQep
from emulator.peripherals.gpio import Gpio
from emulator.peripherals.i2c import I2c
from emulator.peripherals.input_xbar import InputXbar
from emulator.peripherals.output_xbar import OUTPUTS, OutputXbar
from emulator.peripherals.pie import Pie
from emulator.peripherals.pie_vectors import VectorTable
from emulator.peripherals.sci import Sci
from emulator.peripherals.spi import Spi
from emulator.peripherals.sysctrl import SysCtrl
from emulator.peripherals.temperature_sensor import TemperatureSensor
from emulator.peripherals.watchdog import Watchdog
from emulator.peripherals.xbar import XbarFlags
from emulator.peripherals.xint import Xint
from emulator.pin_functions import PIN_FUNCTIONS
from emulator.pin_mux import Crossbar
from emulator.registers.adc import AdcRegs, AdcResultRegs
from emulator.registers.can import CanRegs
from emulator.registers.cell import Cell
from emulator.registers.cmpss import CmpssRegs
from emulator.registers.core import ALL, HIGH, LOW, Block
from emulator.registers.cpu import CpuRegs
from emulator.registers.dac import DacRegs
from emulator.registers.dma import DmaClaSrcSelRegs, DmaRegs
from emulator.registers.ecap import ECapRegs
from emulator.registers.epwm import EPwmRegs
from emulator.registers.epwm_xbar import EPwmXbarRegs
from emulator.registers.eqep import EQepRegs
from emulator.registers.gpio import GpioCtrlRegs, GpioDataRegs
from emulator.registers.i2c import I2cRegs
from emulator.registers.input_xbar import InputXbarRegs
from emulator.registers.output_xbar import OutputXbarRegs
from emulator.registers.pie import PieCtrlRegs
from emulator.registers.pie_vectors import PieVectTable
from emulator.registers.sci import SciRegs
from emulator.registers.spi import SpiRegs
from emulator.registers.sysctrl import LPMCR, AnalogSubsysRegs, ClkCfgRegs, CpuSysRegs, DevCfgRegs
from emulator.registers.unmodelled import UnmodelledBlock
from emulator.registers.watchdog import WdRegs
from emulator.registers.xbar import XbarRegs
from emulator.registers.xint import XintRegs
from emulator.signal import Signal
from emulator.signals import AnalogWire, DutyWire, I2cBus, Level, PwmWire, QuadratureWire, SerialLine, SpiBus, Wire
from emulator.trace import Trace

B = TypeVar("B", bound=Block)
P = ParamSpec("P")

GPIO_COUNT: Final = 169
EPWM_COUNT: Final = 12
EQEP_COUNT: Final = 3
ECAP_COUNT: Final = 6
#: PIE group and number of each module's interrupts: ADCINT1 to 4, and the event; those of receiver and transmitter; of
#: the I2C its basic one and that of the FIFOs.
ADC_PIE: Final = {x: BLOCKS[f"Adc{x.lower()}Regs"].pie[:4] for x in "ABCD"}
ADCEVT_PIE: Final = {x: BLOCKS[f"Adc{x.lower()}Regs"].pie[4] for x in "ABCD"}
SPI_PIE: Final = {x: BLOCKS[f"Spi{x.lower()}Regs"].pie for x in "ABC"}
I2C_PIE: Final = {x: BLOCKS[f"I2c{x.lower()}Regs"].pie for x in "AB"}
SCI_PIE: Final = {x: BLOCKS[f"Sci{x.lower()}Regs"].pie for x in "ABCD"}
CAN_PIE: Final = {x: BLOCKS[f"Can{x.lower()}Regs"].pie for x in "AB"}
XINT_PIE: Final = dict(enumerate(BLOCKS["XintRegs"].pie, 1))
#: External interrupt -> its input of the Input X-BAR (DS).
XINT_INPUT: Final = {1: 4, 2: 5, 3: 6, 4: 13, 5: 14}
#: The input of the Input X-BAR that is also ADCEXTSOC (DS).
EXTSOC_INPUT: Final = 5
#: eCAP -> its input of the Input X-BAR (DS).
ECAP_INPUT: Final = {n: 6 + n for n in range(1, ECAP_COUNT + 1)}
#: The last eCAP of each sync chain.  CHOICE: eCAP1 to 3 are one, eCAP4 to 6 the other, because SYNCSELECT has fields
#: for the sync-in of eCAP1 and of eCAP4 only (HDR F2837xS_sysctrl.h).
ECAP_CHAIN_ENDS: Final = (3, 6)
#: The inputs that the other X-BARs can choose too (TRM, X-BAR).
XBAR_INPUTS: Final = range(1, 7)
#: TZ1 to TZ3 are INPUT1 to INPUT3; TZ4 is the error of an eQEP (TRM, trip-zone submodule).
XBAR_TRIPS: Final = (1, 2, 3)
EQEP_TRIP: Final = 4
#: Trip inputs of the digital compare that are inputs of the Input X-BAR of the same number (TRM, digital compare).
INPUT_TRIPINS: Final = (1, 2, 3, 6)
#: The triggers of the DMA that there are here, by their numbers in DMACHSRCSEL (HDR): the first of each ADC's four
#: ADCINT, behind which its event follows; the external interrupts; SPITXDMA of each SPI, behind which SPIRXDMA follows.
DMA_ADC: Final = {letter: 1 + 5 * x for x, letter in enumerate("ABCD")}
DMA_XINT: Final = {n: 28 + n for n in XINT_PIE}
DMA_SPI: Final = {letter: 109 + 2 * x for x, letter in enumerate("ABC")}
#: The triggers of the DMA that trigger ADCs too: TRIGSEL -> number.  They are CPU timers, SOCA and SOCB.
DMA_TRIGSEL: Final = {1 + n: 68 + n for n in range(3)} | {5 + n: 36 + n for n in range(2 * EPWM_COUNT)}
DMA_SOURCES: Final = frozenset((
    *(first + n for first in DMA_ADC.values() for n in range(5)), *DMA_XINT.values(), *DMA_TRIGSEL.values(),
    *(first + n for first in DMA_SPI.values() for n in range(2)),
))  # fmt: skip
#: Inputs of an ADC, and those of them that are the same pins for all four (DS, analog subsystem).
ADC_INPUTS: Final = 16
SHARED_ADC_INPUTS: Final = (14, 15)
#: DAC -> the ADC input that is its output pin (DS, analog subsystem).
DAC_OUTPUT: Final = {"A": ("A", 0), "B": ("A", 1), "C": ("B", 1)}
#: The ADC input of the temperature sensor (TI's example of it).
TEMPERATURE_INPUT: Final = ("A", 13)
#: CMPSS -> the ADC input that is its CMPINxP; CMPINxN is the next one (DS, analog subsystem).
CMPSS_INPUT: Final = {
    1: ("A", 2), 2: ("A", 4), 3: ("B", 2), 4: ("A", 14), 5: ("C", 4), 6: ("C", 2), 7: ("D", 0), 8: ("D", 2),
}  # fmt: skip


class Chip:
    """One F28377S.

    `vdda_v` is the analog supply.  `ideal` switches the noise of the ADCs off.  `board_pulls` are pull resistors of the
    board, GPIO -> level.  `spi_pins` are the pins (SIMO, SOMI, CLK) of the board's SPI bus, `i2c_pins` those (SDA, SCL)
    of its I2C bus, with pull-ups.  Without them, every pin that carries such a signal reaches the bus.  Out of reset
    the start-up code of the C run-time has run: the watchdog is disabled and SYSCLK is 200 MHz.  The clock of every
    peripheral is still off (TRM: off until enabled).
    """

    def __init__(
        self, *, rng: Random, ideal: bool = True, vrefhi_v: float = 3.0, vdda_v: float = 3.3,
        board_pulls: Mapping[int, int] | None = None,
        spi_pins: Mapping[str, tuple[int, int, int]] | None = None,
        i2c_pins: Mapping[str, tuple[int, int]] | None = None,
    ) -> None:  # fmt: skip
        self.clock = clock = Clock()
        self.findings = findings = Findings(clock)
        self.trace = Trace(clock)
        self.cpu = cpu = Cpu(clock, findings)
        made = {name: instance.kind(name, instance.base, cpu) for name, instance in BLOCKS.items()}
        #: Register blocks by their names in C.
        self.blocks: dict[str, Block] = {name: block for name, block in made.items() if name != "PieVectTable"}
        pulls = {pin: 1 for lines in (i2c_pins or {}).values() for pin in lines} | dict(board_pulls or {})
        self.pins = [Wire(f"GPIO{n}", pulls.get(n, 0)) for n in range(GPIO_COUNT)]
        self.analog = self._analog_inputs()
        self.pie = Pie(clock, cpu, self._block("PieCtrlRegs", PieCtrlRegs))
        core, vectors = CpuRegs("CPU", 0, cpu), made["PieVectTable"]
        assert isinstance(vectors, PieVectTable)
        low_power = self.register("CpuSysRegs", "LPMCR")
        cpu.deeper = lambda: bool(low_power.value & LPMCR.LPM.mask)
        core.bind("IER", read=lambda: cpu.ier, write=lambda word, _lanes: cpu.write_ier(word), steady=True)
        core.bind("IFR", read=lambda: cpu.ifr, write=lambda word, _lanes: cpu.write_ifr(word), steady=True)
        self.vectors = VectorTable(cpu, self.pie, vectors)
        #: Blocks that C names and whose registers are not words of the memory here.
        self._named: dict[str, Block] = {"CPU": core, "PieVectTable": vectors}
        #: Blocks that are not modelled; only those that have been used are created.
        self._unmodelled: dict[str, UnmodelledBlock] = {}
        #: What is not modelled and was reached by a number.
        self._told: set[str] = set()
        self.sysctrl = SysCtrl(
            cpu, self._block("CpuSysRegs", CpuSysRegs), self._block("ClkCfgRegs", ClkCfgRegs),
            self._block("DevCfgRegs", DevCfgRegs), self._block("AnalogSubsysRegs", AnalogSubsysRegs),
        )  # fmt: skip
        self.temperature_sensor = TemperatureSensor(
            self._block("AnalogSubsysRegs", AnalogSubsysRegs), self.analog[TEMPERATURE_INPUT[0]][TEMPERATURE_INPUT[1]]
        )
        self.gpio = Gpio(
            clock, cpu, self._block("GpioCtrlRegs", GpioCtrlRegs), self._block("GpioDataRegs", GpioDataRegs), self.pins
        )
        self.crossbar = Crossbar(clock, self.gpio, self.pins)
        #: Listener -> the function that disconnects it.  A setting of the registers connects it.
        self._stops: dict[Hashable, Callable[[], None]] = {}
        #: The hardware triggers by TRIGSEL.  ADCs in which one starts something listen to it; so does a DMA that waits.
        self.triggered: dict[int, Signal[[]]] = {trigsel: Signal() for trigsel in TRIGSELS}
        self.triggered[ADCEXTSOC] = Signal(self._listen_to_external_soc)
        self.input_xbar = InputXbar(
            cpu, self._block("InputXbarRegs", InputXbarRegs), level=self.gpio.input,
            pin_changed=self.gpio.input_changed,
        )  # fmt: skip
        self.xint = {n: self._xint(n) for n in XINT_INPUT}
        #: The triggers that some channel of the DMA waits for.
        self._dma_sources: frozenset[int] = frozenset()
        self.adc = {letter: self._adc(letter, vrefhi_v, None if ideal else rng) for letter in ADC_PIE}
        self.dac = {letter: self._dac(letter, vrefhi_v) for letter in DAC_OUTPUT}
        self.spi_bus = {letter: SpiBus(f"SPI-{letter}") for letter in SPI_PIE}
        self.spi = {letter: self._spi(letter, (spi_pins or {}).get(letter, ())) for letter in SPI_PIE}
        self.i2c_bus = {letter: I2cBus(f"I2C-{letter}") for letter in I2C_PIE}
        self.i2c = {letter: self._i2c(letter, (i2c_pins or {}).get(letter, ())) for letter in I2C_PIE}
        self.can_bus = {letter: CanBus(clock, f"CAN-{letter}") for letter in CAN_PIE}
        self.can = {letter: self._can(letter) for letter in CAN_PIE}
        self.serial_pins: dict[int, SerialLine] = {}
        self.sci = {letter: self._sci(letter) for letter in SCI_PIE}
        #: The behaviours of blocks that need no wiring of their own.
        self._uniform = {name: self._behaviour(name) for name in BLOCKS if BLOCKS[name].behaviour}
        self.timers: list[CpuTimer] = [self._uniform[f"CpuTimer{n}Regs"] for n in range(3)]
        self.sysctrl.timer2_changed.connect(self.timers[2].set_tick)
        #: Pairs of pins (A, B) that are neighbours in the pin table.
        self.encoder_pins: dict[tuple[int, int], QuadratureWire] = {}
        self._eqep_errors = 0
        self.eqep = {n: self._eqep(n) for n in range(1, EQEP_COUNT + 1)}
        self.ecap = {n: self._ecap(n) for n in ECAP_INPUT}
        self.pwm_outputs: dict[str, DutyWire] = {}
        self.epwm = {n: self._epwm(n) for n in range(1, EPWM_COUNT + 1)}
        self.cmpss = {n: self._cmpss(n, vdda_v, vrefhi_v) for n in CMPSS_INPUT}
        signals = self._xbar_signals()
        self.xbar_flags = XbarFlags(self._block("XbarRegs", XbarRegs), signals)
        self.epwm_xbar = EPwmXbar(
            cpu, self._block("EPwmXbarRegs", EPwmXbarRegs), signals, used=self.xbar_flags.follow
        )  # fmt: skip
        outputs = [f"OUTPUTXBAR{n}" for n in range(1, OUTPUTS + 1)]
        self.output_xbar = OutputXbar(
            cpu, self._block("OutputXbarRegs", OutputXbarRegs), signals, used=self.xbar_flags.follow,
            put=[self.crossbar.level_out(PIN_FUNCTIONS[name], name, 0) for name in outputs],
        )  # fmt: skip
        self.watchdog = Watchdog(
            clock, cpu, self._block("WdRegs", WdRegs), self._watchdog_reset, *self._interrupts("WdRegs"),
            enabled_at_reset=False,
        )
        self._registers_at: dict[int, Cell] = {}
        byte_registers: dict[int, Cell] = {}
        for block in self.blocks.values():
            for register in block:
                if block.byte_peripheral:
                    self._registers_at |= dict.fromkeys(range(register.address, register.address + 4), register)
                    byte_registers[register.address] = register
                    continue
                for half in range(register.bits // 16):
                    self._registers_at[register.address + half] = register
        #: Entries of the vector table by their word address, and the lower words that were written to them.
        self._vectors_at = {cell.address: cell for cell in vectors}
        self._lower_words: dict[int, int] = {}
        self.memory = Memory(self._read_word, self._write_word, byte_registers)
        self.dma = self._dma()
        self._gates()

    def _block(self, name: str, kind: type[B]) -> B:
        block = self.blocks[name]
        assert isinstance(block, kind)
        return block

    # Instances

    def _behaviour(self, name: str) -> Any:
        """Create the behaviour of block `name` from the clock, the core, its registers and the table of blocks."""
        instance = BLOCKS[name]
        assert instance.behaviour is not None
        trigger = {"trigger": self.triggered[instance.trigsel].emit} if instance.trigsel else {}
        return instance.behaviour(self.clock, self.cpu, self.blocks[name], *self._interrupts(name), **trigger)

    def _interrupts(self, name: str) -> list[Callable[[], None]]:
        """The interrupts of block `name`, in the order of its line in the table.  Call one for a pulse."""
        instance = BLOCKS[name]
        own = [partial(self.cpu.raise_line, instance.line)] if instance.line else []
        return [*(self.pie.line(*interrupt) for interrupt in instance.pie), *own]

    def _lspclk(self) -> int:
        return self.sysctrl.lspclk_divider

    def _epwmclk(self) -> int:
        return self.sysctrl.epwmclk_divider

    def _analog_inputs(self) -> dict[str, list[AnalogWire]]:
        """The inputs of each ADC by number; ADC-A's are called ADCIN0 to 15, as the others' shared ones."""
        first = [AnalogWire(f"ADCIN{n}") for n in range(ADC_INPUTS)]
        others = {
            letter: [
                first[n] if n in SHARED_ADC_INPUTS else AnalogWire(f"ADCIN{letter}{n}") for n in range(ADC_INPUTS)
            ]
            for letter in ADC_PIE
            if letter != "A"
        }
        return {"A": first, **others}

    def _adc(self, letter: str, vrefhi_v: float, noise: Random | None) -> Adc:
        x = letter.lower()
        *interrupts, event = self._interrupts(f"Adc{x}Regs")
        return Adc(
            self.clock, self.cpu, self._block(f"Adc{x}Regs", AdcRegs), self._block(f"Adc{x}ResultRegs", AdcResultRegs),
            self.analog[letter], interrupts, event, vrefhi_v=vrefhi_v,
            noise_lsb=0.0 if noise is None else 1.0, random=noise,
            left_by=lambda n: self.pie.left_by(*ADC_PIE[letter][n]),
            routine=lambda n: self.pie.routine(*ADC_PIE[letter][n]),
            awaited=partial(self._awaits, letter),
            selected=partial(self._given_to_dma, letter),
            trigger_changed=partial(self._adc_trigger_changed, letter),
        )  # fmt: skip

    def _awaits(self, letter: str, n: int) -> bool:
        """Whether anything uses ADCINT(n+1).  If a missing acknowledge holds the interrupt back, that is reported."""
        interrupt = ADC_PIE[letter][n]
        to_cpu = self.pie.enabled(*interrupt) and not self.pie.is_blocked(*interrupt)
        return to_cpu or DMA_ADC[letter] + n in self._dma_sources

    def _given_to_dma(self, letter: str, n: int) -> Cause | None:
        """The statement that has given ADCINT(n+1) to the DMA, if its interrupt is not enabled."""
        return None if self.pie.enabled(*ADC_PIE[letter][n]) else self.dma.selected(DMA_ADC[letter] + n)

    def _dac(self, letter: str, vrefhi_v: float) -> Dac:
        adc, channel = DAC_OUTPUT[letter]
        regs = self._block(f"Dac{letter.lower()}Regs", DacRegs)
        return Dac(self.cpu, regs, self.analog[adc][channel], vdac_v=vrefhi_v, vrefhi_v=vrefhi_v)

    def _cmpss(self, n: int, vdda_v: float, vdac_v: float) -> Cmpss:
        adc, channel = CMPSS_INPUT[n]
        pins = self.analog[adc]
        return Cmpss(
            self.clock, self.cpu, self._block(f"Cmpss{n}Regs", CmpssRegs), pins[channel], pins[channel + 1], number=n,
            vdda_v=vdda_v, vdac_v=vdac_v, sync_listen=partial(self._listen_to_sync, n), epwms=EPWM_COUNT,
        )  # fmt: skip

    def _xbar_signals(self) -> dict[str, Level]:
        """The signals that the ePWM and Output X-BARs can choose, by name."""
        signals: dict[str, Level] = {f"INPUT{n}": self.input_xbar.signal(n) for n in XBAR_INPUTS}
        signals |= {f"ECAP{n}.OUT": ecap.output for n, ecap in self.ecap.items()}
        for cmpss in self.cmpss.values():
            for half in (cmpss.high, cmpss.low):
                signals |= {wire.name: wire for wire in (half.trip, half.trip_out)}
        return signals

    def _listen_to_sync(self, n: int, epwm: int, on: bool) -> None:
        """Connect EPWMSYNCPER of an ePWM to CMPSS `n` (`on`), or disconnect it."""
        self._listen(("EPWMSYNCPER", n), self.epwm[epwm].synced, self.cmpss[n].sync, on)

    def _adc_trigger_changed(self, letter: str, trigsel: int, on: bool) -> None:
        """A hardware trigger starts conversions of an ADC from now on (`on`), or no longer."""
        self._listen((letter, trigsel), self.triggered[trigsel], partial(self.adc[letter].trigger, trigsel), on)

    def _listen(self, who: Hashable, signal: Signal[P], listener: Callable[P, object], on: bool) -> None:
        """Connect `listener` to a signal for `who` (`on`), or disconnect it.  A connected one moves to the end."""
        stop = self._stops.pop(who, None)
        if stop is not None:
            stop()
        if on:
            self._stops[who] = signal.connect(listener)

    def _spi(self, letter: str, wired: tuple[int, ...]) -> Spi:
        bus = self.spi_bus[letter]
        self.crossbar.spi(bus, [PIN_FUNCTIONS[f"SPI{line}{letter}"] for line in ("SIMO", "SOMI", "CLK")], wired)
        name = f"Spi{letter.lower()}Regs"
        spi = Spi(
            self.clock, self.cpu, self._block(name, SpiRegs), bus, *self._interrupts(name),
            select=self.crossbar.level_out(PIN_FUNCTIONS[f"SPISTE{letter}"], bus.name, 1),
            lspclk_divider=self._lspclk,
            on_blocked=partial(self.pie.flag_left, *SPI_PIE[letter][0], f"{name}.SPIFFRX.RXFFINT"),
        )  # fmt: skip
        self.sysctrl.dividers_changed.connect(spi.clock_changed)
        return spi

    def _i2c(self, letter: str, wired: tuple[int, ...]) -> I2c:
        bus = self.i2c_bus[letter]
        self.crossbar.bus(bus, [PIN_FUNCTIONS[f"{line}{letter}"] for line in ("SDA", "SCL")], wired)
        name = f"I2c{letter.lower()}Regs"
        return I2c(self.clock, self.cpu, self._block(name, I2cRegs), bus, *self._interrupts(name))

    def _can(self, letter: str) -> Can:
        port = CanPort(f"CAN{letter}")
        self.crossbar.bus(port, [PIN_FUNCTIONS[f"CAN{line}{letter}"] for line in ("TX", "RX")], ())
        name = f"Can{letter.lower()}Regs"
        can = Can(
            self.clock, self.cpu, self._block(name, CanRegs), port, self.can_bus[letter],
            tuple(self._interrupts(name)),
            clock_cycles=partial(self.sysctrl.can_cycles, letter), on_blocked=partial(self._can_blocked, letter),
        )  # fmt: skip
        self.sysctrl.dividers_changed.connect(can.clock_changed)
        return can

    def _can_blocked(self, letter: str, line: int) -> None:
        """An interrupt line of a CAN is active while its global flag is still set."""
        flag = f"Can{letter.lower()}Regs.CAN_GLB_INT_FLG.INT{line}_FLG"
        self.pie.flag_left(*CAN_PIE[letter][line], flag)

    def join_can(self) -> None:
        """Connect the transceivers of CAN-A and CAN-B to one bus, that of CAN-A."""
        self.can["B"].connect(self.can_bus["A"])
        if self.can_bus["B"] is not self.can_bus["A"]:
            self.can_bus["B"].join(self.can_bus["A"])
            self.can_bus["B"] = self.can_bus["A"]

    def _sci(self, letter: str) -> Sci:
        tx, rx = SerialLine(f"SCITXD{letter}"), SerialLine(f"SCIRXD{letter}")
        tx_pins, rx_pins = PIN_FUNCTIONS[tx.name], PIN_FUNCTIONS[rx.name]
        for pin in (*tx_pins, *rx_pins):
            self.serial_pins.setdefault(pin, SerialLine(f"GPIO{pin}"))
        self.crossbar.serial_out(tx, tx_pins, self.serial_pins)
        self.crossbar.serial_in(rx, rx_pins, self.serial_pins)
        name = f"Sci{letter.lower()}Regs"
        return Sci(
            self.clock, self.cpu, self._block(name, SciRegs), tx, rx, *self._interrupts(name),
            lspclk_divider=self._lspclk,
            on_blocked=partial(self.pie.flag_left, *SCI_PIE[letter][0], f"{name}.SCIFFRX.RXFFINT"),
        )  # fmt: skip

    def _xint(self, n: int) -> Xint:
        regs = self._block("XintRegs", XintRegs)
        pulse = partial(self._pulse, self.pie.line(*XINT_PIE[n]), DMA_XINT[n])
        return Xint(self.clock, regs, n, pulse, partial(self._listen_to_xint, n))

    def _listen_to_xint(self, n: int, on: bool) -> None:
        """External interrupt `n` was enabled or disabled."""
        self._listen(("XINT", n), self.input_xbar.changed[XINT_INPUT[n]], self.xint[n].edge, on)

    def _listen_to_external_soc(self, on: bool) -> None:
        """ADCEXTSOC starts conversions of some ADC from now on (`on`), or of none any more."""
        self._listen("ADCEXTSOC", self.input_xbar.changed[EXTSOC_INPUT], self._external_soc, on)

    def _external_soc(self, level: int) -> None:
        """INPUT5, which XINT2 sees too: ADCEXTSOC.  CHOICE: its rising edge is the trigger."""
        if level:
            self.triggered[ADCEXTSOC].emit()

    def _dma(self) -> Dma:
        return Dma(
            self.clock, self.cpu, self._block("DmaRegs", DmaRegs), self._block("DmaClaSrcSelRegs", DmaClaSrcSelRegs),
            self._interrupts("DmaRegs"),
            read=self._bus_read, write=self._bus_write, region=self._region,
            bridges=lambda: self.blocks["CpuSysRegs"].registers["SECMSEL"].value,
            listen=self._dma_listens, level_is_active=self._level_is_active, known=DMA_SOURCES,
        )  # fmt: skip

    def _region(self, address: int) -> Region | None:
        """The object at an address, for the DMA."""
        found = self.memory.find(address)
        return None if found is None else Region(found.base, found.words, found.declaration.path)

    def _bus_read(self, address: int, words: int) -> int:
        """A read by the DMA.  A 32-bit register is read in one access."""
        register, half = self._bus_register(address)
        if register is not None and words == 2 and register.bits == 32 and not half:
            return register.bus_read()
        if words == 2:
            return self._bus_read(address, 1) | self._bus_read(address + 1, 1) << 16
        return self.memory.read_word(address) if register is None else register.bus_read() >> 16 * half & 0xFFFF

    def _bus_write(self, address: int, words: int, value: int) -> None:
        """A write by the DMA.  A 32-bit register is written in one access."""
        register, half = self._bus_register(address)
        if register is not None and words == 2 and register.bits == 32 and not half:
            register.bus_write(value, ALL)
        elif words == 2:
            self._bus_write(address, 1, value & 0xFFFF)
            self._bus_write(address + 1, 1, value >> 16)
        elif register is None:
            self.memory.write_word(address, value)
        elif register.bits == 16:
            register.bus_write(value, ALL)
        elif half:
            register.bus_write(register.value & LOW | value << 16, HIGH)
        else:
            register.bus_write(register.value & HIGH | value, LOW)

    def _bus_register(self, address: int) -> tuple[Cell | None, int]:
        """The register at an address where no object lies, and the half of it that the address names."""
        register = self._registers_at.get(address) if self.memory.find(address) is None else None
        return register, 0 if register is None else register.half_at(address)

    def _dma_listens(self, sources: frozenset[int]) -> None:
        """Connect the triggers that the DMA waits for, and disconnect all others."""
        self._dma_sources = sources
        for letter, first in DMA_ADC.items():
            for source, pulsed in enumerate(self.adc[letter].pulsed, first):
                self._listen(("DMA", source), pulsed, partial(self.dma.trigger, source), source in sources)
        for letter, transmit in DMA_SPI.items():
            for source in (transmit, transmit + 1):
                requested = self.spi[letter].requested(receive=source != transmit)
                self._listen(("DMA", source), requested, partial(self.dma.level, source), source in sources)
        for trigsel, source in DMA_TRIGSEL.items():
            self._listen(("DMA", source), self.triggered[trigsel], partial(self.dma.trigger, source), source in sources)

    def _pulse(self, line: Callable[[], None], source: int) -> None:
        """An interrupt of a module that also triggers the DMA."""
        line()
        if source in self._dma_sources:
            self.dma.trigger(source)

    def _level_is_active(self, source: int) -> bool:
        """Whether a trigger is a level of an SPI FIFO that is active now."""
        for letter, transmit in DMA_SPI.items():
            if source in (transmit, transmit + 1):
                return self.spi[letter].at_level(receive=source != transmit)
        return False

    def _eqep(self, n: int) -> EQep:
        inside = QuadratureWire(f"EQEP{n}")
        a_pins, b_pins = PIN_FUNCTIONS[f"EQEP{n}A"], PIN_FUNCTIONS[f"EQEP{n}B"]
        pairs = {(a, b): QuadratureWire(f"GPIO{a}/{b}") for a, b in zip(a_pins, b_pins, strict=True)}
        self.encoder_pins |= pairs
        self.crossbar.quadrature_in(inside, a_pins, b_pins, pairs)
        name = f"EQep{n}Regs"
        eqep = EQep(
            self.clock, self.cpu, self._block(name, EQepRegs), inside, *self._interrupts(name),
            error=partial(self._eqep_error, n),
            on_blocked=partial(self.pie.flag_left, *BLOCKS[name].pie[0], f"{name}.QFLG.INT", at_once=True),
        )  # fmt: skip
        self.crossbar.level_in(PIN_FUNCTIONS[f"EQEP{n}I"], eqep.index_level)
        self.crossbar.level_in(PIN_FUNCTIONS[f"EQEP{n}S"], eqep.strobe_level)
        return eqep

    def _eqep_error(self, n: int, on: bool) -> None:
        """EQEPnERR: a phase error.  CHOICE: TZ4 of every ePWM is low while any eQEP has one."""
        self._eqep_errors = self._eqep_errors | 1 << n if on else self._eqep_errors & ~(1 << n)
        for epwm in self.epwm.values():
            epwm.trip_input(EQEP_TRIP, 0 if self._eqep_errors else 1)

    def _ecap(self, n: int) -> ECap:
        name = f"ECap{n}Regs"
        return ECap(
            self.clock, self.cpu, self._block(name, ECapRegs), *self._interrupts(name),
            listen=partial(self._listen_to_capture, n), sync_out=partial(self._sync_after, n),
            on_blocked=partial(self.pie.flag_left, *BLOCKS[name].pie[0], f"{name}.ECFLG.INT"),
        )  # fmt: skip

    def _listen_to_capture(self, n: int, on: bool) -> None:
        """Connect the input of eCAP `n` (`on`), or disconnect it."""
        self._listen(("eCAP", n), self.input_xbar.changed[ECAP_INPUT[n]], self.ecap[n].edge, on)

    def _sync_after(self, n: int) -> None:
        """The sync-out of eCAP `n`, which the next one of its chain takes."""
        if n not in ECAP_CHAIN_ENDS:
            self.ecap[n + 1].sync_in()

    def _epwm(self, n: int) -> EPwm:
        a, b = PwmWire(f"EPWM{n}A"), PwmWire(f"EPWM{n}B")
        for source in (a, b):
            pins = PIN_FUNCTIONS[source.name]
            targets = {pin: self.pwm_outputs.setdefault(f"GPIO{pin}", DutyWire(f"GPIO{pin}")) for pin in pins}
            self.crossbar.duty_out(source, pins, targets)
        # TRIGSEL 5, 6 are ePWM1 SOCA and SOCB, and so on.
        name = f"EPwm{n}Regs"
        interrupt, trip_interrupt = self._interrupts(name)
        return EPwm(
            self.clock, self.cpu, self._block(name, EPwmRegs), a, b, number=n,
            interrupt=interrupt, soc_a=self.triggered[3 + 2 * n].emit,
            soc_b=self.triggered[4 + 2 * n].emit, trip_interrupt=trip_interrupt,
            trip_listen=partial(self._listen_to_trip, n), tripin_listen=partial(self._listen_to_tripin, n),
            on_blocked=partial(self.pie.flag_left, *BLOCKS[name].pie[0], f"{name}.ETFLG.INT"),
            trip_held=partial(self.pie.flag_left, *BLOCKS[name].pie[1], f"{name}.TZFLG.INT"),
            epwmclk_divider=self._epwmclk,
        )  # fmt: skip

    def _listen_to_trip(self, n: int, k: int, on: bool) -> None:
        """Connect TZk of ePWM `n` (`on`), or disconnect it.

        TZ5 and TZ6 are never low: this clock does not fail, and no debugger stops this CPU.
        """
        if k not in XBAR_TRIPS:
            return
        hear = partial(self.epwm[n].trip_input, k)
        self._listen(("TZ", n, k), self.input_xbar.changed[k], hear, on)
        if on:
            hear(self.input_xbar.input(k))

    def _listen_to_tripin(self, n: int, k: int, on: bool) -> None:
        """Connect TRIPINk of ePWM `n` (`on`), or disconnect it.  One that comes from no X-BAR is low."""
        if k not in (*INPUT_TRIPINS, *TRIPS):
            return
        source: Level = self.input_xbar.signal(k) if k in INPUT_TRIPINS else self.epwm_xbar.trips[k]
        hear = partial(self.epwm[n].tripin, k)
        self._listen(("TRIPIN", n, k), source.changed, hear, on)
        if on:
            hear(source.level)

    def _behaviours(self) -> dict[str, Any]:
        """The behaviours of blocks with a clock gate, by name."""
        return {
            **self._uniform, "DmaRegs": self.dma,
            **{f"Adc{x.lower()}Regs": adc for x, adc in self.adc.items()},
            **{f"Dac{x.lower()}Regs": dac for x, dac in self.dac.items()},
            **{f"Spi{x.lower()}Regs": spi for x, spi in self.spi.items()},
            **{f"I2c{x.lower()}Regs": i2c for x, i2c in self.i2c.items()},
            **{f"Can{x.lower()}Regs": can for x, can in self.can.items()},
            **{f"Sci{x.lower()}Regs": sci for x, sci in self.sci.items()},
            **{f"Cmpss{n}Regs": cmpss for n, cmpss in self.cmpss.items()},
            **{f"EQep{n}Regs": eqep for n, eqep in self.eqep.items()},
            **{f"ECap{n}Regs": ecap for n, ecap in self.ecap.items()},
            **{f"EPwm{n}Regs": epwm for n, epwm in self.epwm.items()},
        }

    def _gates(self) -> None:
        """Connect each clock gate and soft reset as the table of blocks says; then the special cases."""
        gate, soft_reset = self.sysctrl.gate, self.sysctrl.soft_reset
        behaviours = self._behaviours()
        for name, instance in BLOCKS.items():
            behaviour: Any = behaviours.get(name)
            if instance.gate:
                register, field = instance.gate.split(".")
                gate(register, field, self.blocks[name], on_clock=getattr(behaviour, "set_clock", None))
            if instance.reset:
                register, field = instance.reset.split(".")
                soft_reset(register, field, behaviour.reset)
        for epwm in self.epwm.values():
            gate("PCLKCR0", "TBCLKSYNC", on_clock=epwm.set_tbclksync)
            self.sysctrl.dividers_changed.connect(epwm.clock_changed)

    def _watchdog_reset(self) -> None:
        """CHOICE: the watchdog's reset is reported.  Functions that are called without a kernel go on."""

    def reset_peripherals(self, cause: str) -> None:
        """Reset peripherals and pins, except X-BARs and XINTs.  `cause` is a field of RESC."""
        self.cpu.intm = True
        self.gpio.reset()
        for behaviour in self._behaviours().values():
            if hasattr(behaviour, "reset"):
                behaviour.reset()
        self.pie.reset()
        self.watchdog.reset()
        self.sysctrl.reset(cause)

    # Access by address

    def register(self, block: str, name: str) -> Cell:
        """The register that C calls `block.name`.  Raises ValueError for one that does not exist."""
        if block in UNMODELLED:
            if block not in self._unmodelled:
                self._unmodelled[block] = UnmodelledBlock(block, self.cpu)
            return self._unmodelled[block].register(name)
        found = self.blocks.get(block) or self._named.get(block)
        registers = found.registers if found is not None else {}
        if name not in registers:
            raise ValueError(f"this chip has no register {block}.{name}")
        return registers[name]

    def blames_unmodelled(self, name: str) -> bool:
        """Whether a wait for the register `name` that never ends does so because its peripheral is not modelled."""
        block, _, register = name.partition(".")
        return block in self._unmodelled and self._unmodelled[block].blames_unmodelled(register)

    def signal_of(self, pin: int) -> str:
        """The module signal that GPIO`pin` is set to; empty if no modelled module has it."""
        function = self.gpio.mux(pin)
        return next((signal for signal, pins in PIN_FUNCTIONS.items() if pins.get(pin) == function), "")

    def register_at(self, address: int) -> Cell | None:
        """The register that begins at a word address; None if none does."""
        cell = self._registers_at.get(address)
        return cell if cell is not None and cell.address == address else None

    def _read_word(self, addr: int) -> int | None:
        register = self._registers_at.get(addr)
        if register is None:
            vector = self._read_vector(addr)
            if vector is None:
                self._note_unmodelled(addr)
            return vector
        return register.read() >> 16 * register.half_at(addr) & 0xFFFF

    def _write_word(self, addr: int, word: int) -> bool:
        register = self._registers_at.get(addr)
        if register is None:
            written = self._write_vector(addr, word)
            if not written:
                self._note_unmodelled(addr)
            return written
        if register.bits == 16:
            register.write(word & 0xFFFF, ALL)
        elif register.half_at(addr):
            register.write(register.value & LOW | (word & 0xFFFF) << 16, HIGH)
        else:
            register.write(register.value & HIGH | word & 0xFFFF, LOW)
        return True

    def _note_unmodelled(self, addr: int) -> None:
        """Report once that a word belongs to something that the chip has and the emulator does not model."""
        for name, (first, last) in UNMODELLED_AT.items():
            if first <= addr <= last and name not in self._told:
                self._told.add(name)
                message = f"{addr:#x} belongs to {name}, which is not modelled: writes have no effect, it reads 0"
                self.findings.report("unmodelled", message, object=name)

    def _read_vector(self, addr: int) -> int | None:
        """Read half of an entry of the vector table: half of the address of its routine."""
        vector = self._vectors_at.get(addr & ~1)
        if vector is None:
            return None
        routine: Any = vector.read()
        return (self.memory.code_address(routine) if routine else 0) >> 16 * (addr & 1) & 0xFFFF

    def _write_vector(self, addr: int, word: int) -> bool:
        """Write half of an entry of the vector table.  Writing the upper half completes the address."""
        vector = self._vectors_at.get(addr & ~1)
        if vector is None:
            return False
        if addr & 1:
            routine: Any = self.memory.code_at((word & 0xFFFF) << 16 | self._lower_words.pop(addr & ~1, 0))
            vector.write(routine or 0, ALL)
        else:
            self._lower_words[addr] = word & 0xFFFF
        return True

    def enable_line(self, line: int, on: bool = True) -> None:
        """Set or clear a bit of IER."""
        bit = 1 << line - 1
        self.cpu.write_ier(self.cpu.ier | bit if on else self.cpu.ier & ~bit)


def delay_us(clock: Clock, microseconds: float) -> None:
    """DELAY_US: a busy wait of executed cycles, exact at 200 MHz (HDR F2837xS_usDelay.asm)."""
    clock.delay(round(microseconds * CYCLES_PER_US))
