"""The robot's schematic: the parts, and the pins of the chip that they are connected to.

The thesis names the parts and few pins.  A pin that it does not name is a CHOICE among the pins on the LaunchPad's
headers, written only here.  Numbers that follow from measured behaviour:

* The sonars have a supply of 3.3 V and VREFHI is 3.0 V.  With these, Vcc/512 per inch at the converter gives, within
  4 %, the calibration slopes of the firmware (0.0551..0.0569 cm a count, 12 conversions summed and divided by 2.3).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import ClassVar, Final

from emulator.devices.l3g4200d import L3G4200D
from emulator.devices.lb1836m import Lb1836m
from emulator.devices.lis3dh import Lis3dh
from emulator.devices.lv_maxsonar_beam import Echo
from emulator.devices.lv_maxsonar_ring import SonarRing
from emulator.devices.nxt_motor import NxtMotor, NxtMotorParams
from emulator.devices.rplidar_a1 import RplidarA1
from emulator.devices.touch_sensor import TouchSensor
from emulator.devices.wire_link import WireLink
from emulator.devices.xbee import XBeeLink
from hil.board import Board, Face, Pc, Project
from hil.robot.options import accelerometer, lidar
from hil.robot.options.five_sonars import DIAGONALS
from hil.robot.options.names import ACCELEROMETER, FIVE_SONARS, LIDAR, checked

#: ADCIN of each sonar, in the order of the ring (us.c: SOC0..2 convert channels 2, 3, 4).
SONAR_ADCIN: Final = {"LEFT": 2, "FRONT": 3, "RIGHT": 4}
SONAR_START_GPIO: Final = 69
SONAR_VCC_V: Final = 3.3
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
BRIDGES: Final = {"left": (2, 3), "right": (12, 13)}
ENCODERS: Final = {"left": (10, 11), "right": (62, 63)}
#: Motor supply: the regulator of the robot allows up to 7.5 V (TFG 2.2.1).  CHOICE: 7.2 V.
MOTOR_SUPPLY_V: Final = 7.2


@dataclass(frozen=True, slots=True)
class _SetYawRate:
    """The rotation of the gyro when a test sets it, and not a world."""

    yaw_rate_rad_s: float

    def __call__(self, _cycles: int) -> tuple[float, float, float]:
        return 0.0, 0.0, self.yaw_rate_rad_s


@dataclass(frozen=True, slots=True)
class _SetRange:
    """The range of a sonar when a test sets it, and not a world."""

    range_m: float

    def __call__(self, _name: str, _cycles: int) -> Echo:
        return Echo(self.range_m)


class RobotBoard(Board):
    """The chip with the robot's parts.

    `xbee` puts the radio between SCI and PC; otherwise there is a wire of the same baud rate.  The measured quantities
    come from the world (`mounting.py`): call `gyro.set_rate_source`, `sonars.set_range_source`, `bumper.press`, and
    integrate the motors.  `options` are parts that the robot of the thesis does not have (`options/README.md`); a
    subclass may name its own.

    CHOICE: the sonars have power before the CPU starts (`sonars_powered_up`), as on a bench where the program is loaded
    into a board that is on.  If all are switched on together, the sonars need 250 ms.  The start pulse of Init_US at
    10 ms then finds none of them ready, and the ring never starts.
    """

    project: ClassVar[Project | None] = Project("firmware_model")
    bench: ClassVar[str | None] = "hil.bench"
    view: ClassVar[str | None] = "hil.robot.view"
    vrefhi_v: ClassVar[float] = 3.0
    pulls: ClassVar[Mapping[int, int]] = {BUMPER_GPIO: 1, GYRO_CS_GPIO: 1}
    spi_pins: ClassVar[Mapping[str, tuple[int, int, int]]] = {"A": GYRO_SPI_GPIO}
    #: Parts of `options/` that every board of this class has.
    options: Sequence[str] = ()

    def __init__(
        self, *, seed: int = 0, ideal: bool = True, xbee: bool = False, sonars_powered_up: bool = True,
        options: Sequence[str] = (),
    ) -> None:
        self.options = checked((*self.options, *options))
        self.accelerometer: Lis3dh | None = None
        self.lidar: RplidarA1 | None = None
        self._xbee = xbee
        self._sonars_powered_up = sonars_powered_up
        super().__init__(seed=seed, ideal=ideal)

    def solder(self) -> None:
        """Connect every part to its pins."""
        clock, ideal, reports = self.clock, self.ideal, self.reports
        self.gyro = self.on_spi(
            "gyro", L3G4200D(clock, rng=self.rng("gyro"), ideal=ideal, report=reports, mark=reports.mark),
            bus="A", select=GYRO_CS_GPIO,
            faces=[
                Face("yaw_rate_rad_s", "rad/s", -35.0, 35.0, self._turn, self._turned),
                Face(
                    "temperature_c", "degrees C", -40.0, 85.0, lambda value: self.gyro.set_temperature(value),
                    lambda: self.gyro.temperature_c,
                ),
            ],
        )  # fmt: skip
        diagonals = DIAGONALS if FIVE_SONARS in self.options else {}
        sonar_adcin = {**SONAR_ADCIN, **{name: one.adcin for name, one in diagonals.items()}}
        self.sonars = self.add(
            "sonars",
            SonarRing(
                clock, {name: self.analog["A"][channel] for name, channel in sonar_adcin.items()},
                self.pins[SONAR_START_GPIO], rng=self.rng("sonars"), ideal=ideal, vcc_v=SONAR_VCC_V,
                powered_up=self._sonars_powered_up, report=reports, mark=reports.mark,
            ),
            pins={"start": f"GPIO{SONAR_START_GPIO}", **{n: f"ADCINA{ch}" for n, ch in sonar_adcin.items()}},
            faces=[
                Face(f"{name}_range_m", "m", 0.0, 10.0, partial(self._see, name), partial(self._seen, name))
                for name in sonar_adcin
            ],
        )  # fmt: skip
        self.left_motor, self.right_motor = (self._motor(side) for side in ("left", "right"))
        self.bumper = self.add(
            "bumper", TouchSensor(clock, self.pins[BUMPER_GPIO], rng=self.rng("bumper"), ideal=ideal),
            pins={"S": f"GPIO{BUMPER_GPIO}"},
            faces=[
                Face(
                    "pressed", "1 = pressed", 0, 1, lambda pressed: self.bumper.press(bool(pressed)),
                    lambda: self.bumper.pressed,
                )
            ],
        )  # fmt: skip
        outward, inward = self.serial_pins[XBEE_TX_GPIO], self.serial_pins[XBEE_RX_GPIO]
        link: WireLink | XBeeLink
        if self._xbee:
            link = XBeeLink(
                clock, outward, inward, rng=self.rng("xbee"), ideal=ideal, baud=XBEE_BAUD, report=reports
            )
        else:
            link = WireLink(clock, outward, inward, baud=XBEE_BAUD, report=reports)
        self.link = self.add("link", link, pins={"DIN": f"GPIO{XBEE_TX_GPIO}", "DOUT": f"GPIO{XBEE_RX_GPIO}"})
        self.pc = Pc(XBEE_TX_GPIO, XBEE_RX_GPIO, XBEE_BAUD, link)
        if ACCELEROMETER in self.options:
            self.accelerometer = accelerometer.solder(self)
        if LIDAR in self.options:
            self.lidar = lidar.solder(self)

    def _turn(self, yaw_rate_rad_s: float) -> None:
        self.gyro.set_rate_source(_SetYawRate(yaw_rate_rad_s))

    def _turned(self) -> float | None:
        source = self.gyro.rate_source
        return source.yaw_rate_rad_s if isinstance(source, _SetYawRate) else None

    def _see(self, sonar: str, range_m: float) -> None:
        self.sonars.sensors[sonar].set_range_source(_SetRange(range_m))

    def _seen(self, sonar: str) -> float | None:
        source = self.sonars.sensors[sonar].range_source
        return source.range_m if isinstance(source, _SetRange) else None

    def _motor(self, side: str) -> NxtMotor:
        params = NxtMotorParams()
        if not self.ideal:
            params = params.individual(self.rng(f"{side} motor"))
        (in1, in2), (a, b) = BRIDGES[side], ENCODERS[side]
        bridge = Lb1836m(self.pwm_outputs[f"GPIO{in1}"], self.pwm_outputs[f"GPIO{in2}"], MOTOR_SUPPLY_V)
        return self.add(
            f"{side} motor", NxtMotor(bridge, self.encoder_pins[a, b], params),
            pins={"IN1": f"GPIO{in1}", "IN2": f"GPIO{in2}", "A": f"GPIO{a}", "B": f"GPIO{b}"},
        )  # fmt: skip
