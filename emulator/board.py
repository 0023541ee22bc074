"""The schematic: what is soldered to which pin of the chip, and the kernel that runs on it.

The thesis names the parts and few pins; a pin that it does not name is a CHOICE, made where the LaunchPad's headers
bring it out, and stands once, here.  Numbers that follow from measured behaviour:

* sonars are fed with 3.3 V and VREFHI is 3.0 V, because the calibration slopes of the firmware (0.0551..0.0569 cm a
  count, 12 conversions summed and divided by 2.3) are those of Vcc/512 per inch at 3.3 V over a 3.0 V converter
  within 4 %.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from random import Random
from typing import Any, Final

from emulator.c28x.link import Linked
from emulator.c28x.runtime import Runtime
from emulator.chip import SCI_PIE, SPI_PIE, Chip
from emulator.device_functions import DeviceFunctions
from emulator.device_reports import Reports
from emulator.devices.l3g4200d import L3G4200D
from emulator.devices.lb1836m import Lb1836m
from emulator.devices.lv_maxsonar_ring import SonarRing
from emulator.devices.nxt_motor import NxtMotor, NxtMotorParams
from emulator.devices.touch_sensor import TouchSensor
from emulator.devices.wire_link import WireLink
from emulator.devices.xbee import XBeeLink
from emulator.peripherals.cpu_timer import CpuTimer
from emulator.registers.core import ALL
from emulator.sysbios.kernel import Kernel
from emulator.sysbios.watch import Watch

#: ADCIN of each sonar, in the order of the ring (us.c: SOC0..2 convert channels 2, 3, 4).
SONAR_ADCIN: Final = {"LEFT": 2, "FRONT": 3, "RIGHT": 4}
SONAR_START_GPIO: Final = 69
SONAR_VCC_V: Final = 3.3
VREFHI_V: Final = 3.0
#: CHOICE: the gyro on SPI-A where the LaunchPad has it (SIMO, SOMI, CLK), its chip select next to it.
GYRO_SPI_GPIO: Final = (58, 59, 60)
GYRO_CS_GPIO: Final = 61
#: CHOICE: bumper on header pin 9 of the LaunchPad; GPIO41 on pin 5 is the gyro's interrupt line (TFG annex 1), not
#: used.
BUMPER_GPIO: Final = 43
#: CHOICE: XBee on the first BoosterPack site's UART.
XBEE_TX_GPIO: Final = 89
XBEE_RX_GPIO: Final = 90
XBEE_BAUD: Final = 9600
#: CHOICE: motor bridge inputs (IN1, IN2) and encoder pins (A, B).
LEFT_BRIDGE: Final = ("GPIO2", "GPIO3")
RIGHT_BRIDGE: Final = ("GPIO12", "GPIO13")
LEFT_ENCODER: Final = (10, 11)
RIGHT_ENCODER: Final = (62, 63)
#: Motor supply: the regulator of the robot admits up to 7.5 V (TFG 2.2.1); CHOICE 7.2 V.
MOTOR_SUPPLY_V: Final = 7.2
#: The kernel's tick takes 5 us on the robot (TFG 3.4.2, figure 39); see `emulator/sysbios/costs.py`.
KERNEL_COST_SCALE: Final = 2.4


class Board(Chip):
    """The chip with the robot's parts, and SYS/BIOS.

    `seed` decides everything that varies between specimens and runs; `ideal` gives parts without noise, tolerance or
    bounce; `xbee` puts the radio between SCI and PC, otherwise a wire of the same baud.  What the parts measure comes
    from the world: set `gyro.rate_source`, `sonars.set_range_source`, `bumper.press` and integrate the motors.

    CHOICE: the sonars have had power before the CPU starts (`sonars_powered_up`), as on a bench where the program is
    loaded into a board that is on.  Switched on together, they need 250 ms, and the start pulse of Init_US at 10 ms
    finds none of them ready: the ring never starts.
    """

    def __init__(
        self, *, seed: int = 0, ideal: bool = True, xbee: bool = False, cost_scale: float = KERNEL_COST_SCALE,
        sonars_powered_up: bool = True,
    ) -> None:  # fmt: skip
        rng = Random(f"{seed}:board")
        super().__init__(
            rng=rng, ideal=ideal, vrefhi_v=VREFHI_V, board_pulls={BUMPER_GPIO: 1, GYRO_CS_GPIO: 1},
            spi_pins={"A": GYRO_SPI_GPIO},
        )  # fmt: skip
        clock = self.clock
        self.ideal = ideal
        reports = Reports(self.findings)
        self.gyro = L3G4200D(clock, rng=Random(f"{seed}:gyro"), ideal=ideal, report=reports, mark=reports.mark)
        self.spi_bus["A"].attach(self.pins[GYRO_CS_GPIO], self.gyro)
        self.sonars = SonarRing(
            clock, {name: self.analog["A"][channel] for name, channel in SONAR_ADCIN.items()},
            self.pins[SONAR_START_GPIO], rng=Random(f"{seed}:sonars"), ideal=ideal, vcc_v=SONAR_VCC_V,
            powered_up=sonars_powered_up, report=reports, mark=reports.mark,
        )  # fmt: skip
        self.left_motor = self._motor(LEFT_BRIDGE, LEFT_ENCODER, seed, "left")
        self.right_motor = self._motor(RIGHT_BRIDGE, RIGHT_ENCODER, seed, "right")
        self.bumper = TouchSensor(clock, self.pins[BUMPER_GPIO], rng=Random(f"{seed}:bumper"), ideal=ideal)
        outward, inward = self.serial_pins[XBEE_TX_GPIO], self.serial_pins[XBEE_RX_GPIO]
        self.link: WireLink | XBeeLink
        if xbee:
            self.link = XBeeLink(
                clock, outward, inward, rng=Random(f"{seed}:xbee"), ideal=ideal, baud=XBEE_BAUD,
                report=reports,
            )  # fmt: skip
        else:
            self.link = WireLink(clock, outward, inward, baud=XBEE_BAUD)
        self.device_functions = DeviceFunctions(self)
        self.kernel = Kernel(
            clock, self.cpu, self.findings, self.trace, pie_set_vector=self.pie.set_vector,
            pie_enable=self._pie_enable, pie_acknowledge=self._pie_acknowledge, start_tick=self._start_tick,
            stack_memory=self.memory, memory=self.memory, string_at=self.memory.string_at, cost_scale=cost_scale,
        )  # fmt: skip
        # The start-up of SYS/BIOS enables the PIE before main; firmware without it does so itself.
        self.kernel.at_start.append(lambda: self.register("PieCtrlRegs", "PIECTRL").write(1, ALL))

    def _motor(self, bridge: tuple[str, str], encoder: tuple[int, int], seed: int, side: str) -> NxtMotor:
        params = NxtMotorParams()
        if not self.ideal:
            params = params.individual(Random(f"{seed}:{side} motor"))
        in1, in2 = (self.pwm_outputs[pin] for pin in bridge)
        return NxtMotor(Lb1836m(in1, in2, MOTOR_SUPPLY_V), self.encoder_pins[encoder], params)

    # What the kernel needs of the chip

    def _pie_enable(self, vector: int, on: bool) -> bool:
        first, offset = (32, 0) if vector < 128 else (128, 8)
        group, n = divmod(vector - first, 8)
        register = self.register("PieCtrlRegs", f"PIEIER{group + 1}")
        bit, before = 1 << n + offset, register.value
        register.write(before | bit if on else before & ~bit, ALL)
        return bool(before & bit)

    def _pie_acknowledge(self, group: int) -> None:
        self.register("PieCtrlRegs", "PIEACK").write(1 << group - 1, ALL)

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

    def externs(self, runtime: Runtime) -> Mapping[str, Callable[..., Any]]:
        """What the headers declare and this board implements."""
        runtime.driven = lambda: self.kernel.active
        return {**self.kernel.externs, **self.device_functions.externs}

    def watch(self, linked: Linked) -> Watch:
        """Watch what only shows between the tasks of an image that was linked with `watch`."""
        watch = Watch(self.kernel, linked)
        for letter in self.adc:
            watch.adc(*(self.blocks[f"Adc{letter.lower()}{part}Regs"] for part in ("", "Result")))
        for letter, (receive, transmit) in SPI_PIE.items():
            block = f"Spi{letter.lower()}Regs"
            watch.spi(self.blocks[block])
            self._gate(watch, receive, (block, "SPICTL", 1 << 0), (block, "SPIFFRX", 1 << 5))
            self._gate(watch, transmit, (block, "SPIFFTX", 1 << 5))
        watch.select(self.blocks["SpiaRegs"], self.pins[GYRO_CS_GPIO])
        for letter, sci in self.sci.items():
            block = f"Sci{letter.lower()}Regs"
            watch.sci(self.blocks[block], sci.character_cycles)
            receive, transmit = SCI_PIE[letter]
            self._gate(watch, receive, (block, "SCIFFRX", 1 << 5), (block, "SCICTL2", 1 << 1))
            self._gate(watch, transmit, (block, "SCIFFTX", 1 << 5), (block, "SCICTL2", 1 << 0))
        self._gate(watch, (1, 7), ("CpuTimer0Regs", "TCR", 1 << 14))
        return watch

    def _gate(self, watch: Watch, pie: tuple[int, int], *enables: tuple[str, str, int]) -> None:
        """An interrupt comes through if one of its enables is set, and its PIEIER bit."""
        group, n = pie
        bits = [(self.register(block, name), mask) for block, name, mask in enables]
        ier = self.register("PieCtrlRegs", f"PIEIER{group}")
        watch.interrupt(32 + 8 * (group - 1) + n - 1, ((ier, 1 << n - 1), tuple(bits)))
