"""A chip with SYS/BIOS and the detectors.  Firmware is linked to it.  It has no devices."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from random import Random
from typing import Any, Final

from emulator.c28x.link import Linked
from emulator.chip import ADC_PIE, CAN_PIE, I2C_PIE, SCI_PIE, SPI_PIE, Chip
from emulator.connections import Connections
from emulator.device_functions import DeviceFunctions
from emulator.peripherals.cpu_timer import CpuTimer
from emulator.peripherals.dma import CHANNELS, PERINTFRC, RUN
from emulator.peripherals.pie import DIRECT_VECTORS, vector_id
from emulator.registers.can import CAN_CTL
from emulator.registers.cell import Cell
from emulator.registers.core import ALL
from emulator.registers.cpu_timer import TCR
from emulator.registers.i2c import I2CMDR
from emulator.seed import check_seed
from emulator.sysbios.heap_mem import HEAP_WORDS
from emulator.sysbios.kernel import Kernel
from emulator.sysbios.watch.kernel_watch import KernelWatch

#: The kernel's tick takes 5 us on the robot (TFG 3.4.2, figure 39); see `emulator/sysbios/costs.py`.
KERNEL_COST_SCALE: Final = 2.4
#: The vectors of the CPU timers 0 to 2.
_TIMER_VECTORS: Final = (vector_id(1, 7), *DIRECT_VECTORS)


class System(Chip):
    """One F28377S with its kernel.

    `seed` decides everything that varies between specimens and runs; `ideal` switches noise off.  `vrefhi_v`,
    `board_pulls`, `spi_pins` and `i2c_pins` are as in `Chip`; `kernel_cost_scale` is the factor on what the kernel's
    calls cost (`emulator/sysbios/costs.py`), `heap_words` the size of the heap behind `malloc`.
    """

    def __init__(
        self, *, seed: int = 0, ideal: bool = True, vrefhi_v: float = 3.0,
        board_pulls: Mapping[int, int] | None = None, spi_pins: Mapping[str, tuple[int, int, int]] | None = None,
        i2c_pins: Mapping[str, tuple[int, int]] | None = None, kernel_cost_scale: float = KERNEL_COST_SCALE,
        heap_words: int = HEAP_WORDS,
    ) -> None:  # fmt: skip
        check_seed(seed)
        super().__init__(
            rng=Random(f"{seed}:board"), ideal=ideal, vrefhi_v=vrefhi_v, board_pulls=board_pulls, spi_pins=spi_pins,
            i2c_pins=i2c_pins,
        )  # fmt: skip
        self.seed = seed
        self.ideal = ideal
        self.device_functions = DeviceFunctions(self)
        self.kernel = Kernel(
            self.clock, self.cpu, self.findings, self.trace, pie_set_vector=self.pie.set_vector,
            pie_enable=self._pie_enable, pie_acknowledge=self._pie_acknowledge, start_tick=self._start_tick,
            memory=self.memory, string_at=self.memory.string_at,
            cost_scale=kernel_cost_scale, heap_words=heap_words, start_up=self._start_up,
        )  # fmt: skip

        #: The check for missing connections (`not-connected`), if an image is watched.
        self.connections: Connections | None = None

    def _check_connections(self) -> None:
        """Check for missing connections.  If `main` has called BIOS_start, none of its statements run any more."""
        if self.connections is not None:
            self.connections.started_up |= self.kernel.started
            self.connections.finish()

    # Functions of the chip that the kernel needs

    def _start_up(self) -> None:
        """The start-up of SYS/BIOS enables the PIE before main; firmware without it does so itself."""
        self.register("PieCtrlRegs", "PIECTRL").write(1, ALL)

    def _pie_line(self, vector: int) -> tuple[Cell, int]:
        """PIEIER of a vector, and its bit."""
        first, offset = (32, 0) if vector < 128 else (128, 8)
        group, n = divmod(vector - first, 8)
        return self.register("PieCtrlRegs", f"PIEIER{group + 1}"), 1 << n + offset

    def _pie_enable(self, vector: int, on: bool) -> bool:
        register, bit = self._pie_line(vector)
        before = register.value
        register.write(before | bit if on else before & ~bit, ALL)
        return bool(before & bit)

    def _pie_acknowledge(self, group: int) -> None:
        self.register("PieCtrlRegs", "PIEACK").write(1 << group - 1, ALL)

    def _watchdog_reset(self) -> None:
        """CHOICE: a program under the kernel ends here.  Its pins are as after a reset.  A restart is a new run."""
        if self.kernel.started:
            self._check_connections()  # after the reset, the registers show nothing of what the program has set up
            self.reset_peripherals("WDRSn")
            self.kernel.stop()

    def _start_tick(self, period_register: int, _handler: Callable[[], None]) -> CpuTimer:
        """CPU timer 2: stop, load, run with its interrupt."""
        timer = self.blocks["CpuTimer2Regs"].registers
        timer["TCR"].write(1 << 4, ALL)
        timer["PRD"].write(period_register, ALL)
        timer["TPR"].write(0, ALL)
        timer["TPRH"].write(0, ALL)
        timer["TCR"].write(1 << 15 | 1 << 14 | 1 << 5, ALL)
        return self.timers[2]

    # Externs of device_h.py

    def externs(self) -> Mapping[str, Callable[..., Any]]:
        """The functions that the headers declare, as this chip and its kernel implement them."""
        return {**self.kernel.externs, **self.device_functions.externs}

    def watch(self, linked: Linked) -> KernelWatch:
        """Watch an image that was linked with `watch`, for errors that show only between threads."""
        watch = KernelWatch(self.kernel, linked, transfers=self.dma.moving)
        self.connections = Connections(self, linked)
        self.kernel.ending.connect(self._check_connections)
        self.kernel.ending.connect(linked.runtime.finish)
        watch.vectors(self.vectors, self._pie_line)
        for letter in self.adc:
            watch.adc(*(self.blocks[f"Adc{letter.lower()}{part}Regs"] for part in ("", "Result")))
        for letter, (receive, transmit) in SPI_PIE.items():
            block = f"Spi{letter.lower()}Regs"
            watch.spi(self.blocks[block])
            self._gate(watch, receive, (block, "SPICTL", 1 << 0), (block, "SPIFFRX", 1 << 5))
            self._gate(watch, transmit, (block, "SPIFFTX", 1 << 5))
            for select in self.spi_bus[letter].selects:
                watch.select(self.blocks[block], select)
        for letter, (basic, fifo) in I2C_PIE.items():
            block = f"I2c{letter.lower()}Regs"
            self._gate(watch, basic, (block, "I2CIER", 0x3F))
            self._gate(watch, fifo, (block, "I2CFFTX", 1 << 5), (block, "I2CFFRX", 1 << 5))
        for letter, sci in self.sci.items():
            block = f"Sci{letter.lower()}Regs"
            watch.sci(self.blocks[block], sci.character_cycles)
            receive, transmit = SCI_PIE[letter]
            self._gate(watch, receive, (block, "SCIFFRX", 1 << 5), (block, "SCICTL2", 1 << 1))
            self._gate(watch, transmit, (block, "SCIFFTX", 1 << 5), (block, "SCICTL2", 1 << 0))
        for letter, lines in CAN_PIE.items():
            block = f"Can{letter.lower()}Regs"
            watch.can(self.blocks[block])
            for line, enable in zip(lines, (CAN_CTL.IE0, CAN_CTL.IE1), strict=True):
                self._gate(watch, line, (block, "CAN_CTL", enable.mask))
        for n, number in enumerate(_TIMER_VECTORS):
            tcr = self.register(f"CpuTimer{n}Regs", "TCR")
            interrupt = tcr, TCR.TIE.mask
            # A timer that stands sends nothing more.
            watch.interrupt(
                number, (self._pie_line(number) if n == 0 else interrupt, (interrupt,), ((tcr, TCR.TSS.mask),))
            )
        for register, begins, number in self._beginnings():
            watch.starts(number, register, begins)
        return watch

    def _beginnings(self) -> Iterator[tuple[Cell, Callable[[int], bool], int]]:
        """Registers by which a program starts an operation that ends in an interrupt.

        Each with a test for the words that start it, and the interrupt's vector.
        """
        for letter, lines in SPI_PIE.items():
            for line in lines:
                yield self.register(f"Spi{letter.lower()}Regs", "SPITXBUF"), lambda word: True, vector_id(*line)
        for letter, ends in ADC_PIE.items():
            for line in ends:
                yield self.register(f"Adc{letter.lower()}Regs", "ADCSOCFRC1"), bool, vector_id(*line)
        for letter, lines in I2C_PIE.items():
            for line in lines:
                register = self.register(f"I2c{letter.lower()}Regs", "I2CMDR")
                yield register, lambda word: bool(word & I2CMDR.STT.mask), vector_id(*line)
        for n in range(1, CHANNELS + 1):
            register = self.register("DmaRegs", f"CH{n}.CONTROL")
            yield register, lambda word: bool(word & (RUN | PERINTFRC)), vector_id(7, n)
        for n, number in enumerate(_TIMER_VECTORS):
            yield self.register(f"CpuTimer{n}Regs", "TCR"), lambda word: not word & TCR.TSS.mask, number

    def _gate(self, watch: KernelWatch, pie: tuple[int, int], *enables: tuple[str, str, int]) -> None:
        """Register the enables of an interrupt: it comes through if its PIEIER bit and one of them are set."""
        group, n = pie
        bits = [(self.register(block, name), mask) for block, name, mask in enables]
        ier = self.register("PieCtrlRegs", f"PIEIER{group}")
        watch.interrupt(32 + 8 * (group - 1) + n - 1, ((ier, 1 << n - 1), tuple(bits), ()))
