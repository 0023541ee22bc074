"""What of a board can be fed, ADC inputs by their pin and faces of parts, and how each is fed.

Sensors that can compute their value on demand follow a course to the cycle: an ADC input, a gyro, a sonar, the encoder
of a motor.  A switch, or any other face, is set when the course changes, and along a curve every millisecond.
CHOICE: a gyro that is fed turns about z only.  A sonar is fed with a wall that it always detects.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import floor, inf, pi, radians
from typing import Final

from emulator.clock import CYCLES_PER_MS, NEVER, SYSCLK_HZ, ClockEvent
from emulator.devices.l3g4200d import L3G4200D
from emulator.devices.lv_maxsonar import LvMaxSonar
from emulator.devices.lv_maxsonar_beam import INCH_M, Echo
from emulator.devices.lv_maxsonar_ring import SonarRing
from emulator.devices.nxt_motor import EDGES_PER_REVOLUTION, NxtMotor
from emulator.devices.touch_sensor import TouchSensor
from emulator.signals import AnalogWire, QuadratureWire
from hil.board import Board, Part
from hil.feeds.course import Constant, Course

Undo = Callable[[], None]
#: (cycles, value): what a sensor has seen.
OnValue = Callable[[int, float], object]

_EDGE_RAD: Final = 2.0 * pi / EDGES_PER_REVOLUTION
#: An encoder moves at least this often, as in the world: its edges come to who did not ask.
_SAMPLE_CYCLES: Final = 10 * CYCLES_PER_MS

#: Units that a column may have instead of its input's: that unit, how much it is of it, and what is added.
#: CHOICE: the count of an encoder means the middle between two edges.
UNITS: Final = {
    "deg/s": ("rad/s", radians(1.0), 0.0), "dps": ("rad/s", radians(1.0), 0.0),
    "deg": ("rad", radians(1.0), 0.0), "rev": ("rad", 2.0 * pi, 0.0), "edges": ("rad", _EDGE_RAD, 0.5 * _EDGE_RAD),
    "cm": ("m", 1e-2, 0.0), "mm": ("m", 1e-3, 0.0), "in": ("m", INCH_M, 0.0), "mV": ("V", 1e-3, 0.0),
}  # fmt: skip


@dataclass
class Input(ABC):
    """An input that sees one number."""

    board: Board
    name: str
    unit: str
    low: float = -inf
    high: float = inf

    @abstractmethod
    def feed(self, course: Course) -> Undo:
        """Let the input see a course from now on; the returned function gives it back to the physics."""

    def log(self, on_value: OnValue) -> Undo | None:
        """Call `on_value` for each value that it sees from now on, with the cycle; returns None if that is not
        possible."""
        return None

    def scale(self, unit: str) -> tuple[float, float]:
        """The factor and the offset that convert a number of a unit.  Raises ValueError."""
        if unit in ("", self.unit):
            return 1.0, 0.0
        base, factor, offset = UNITS.get(unit, ("", 1.0, 0.0))
        if base != self.unit:
            known = [self.unit, *(name for name, (base, *_) in UNITS.items() if base == self.unit)]
            raise ValueError(f"{self.name} in {unit!r}: must be in {', '.join(filter(None, known)) or 'no unit'}")
        return factor, offset

    def check(self, value: float) -> None:
        """Raise ValueError for a value that the input cannot have."""
        if not self.low <= value <= self.high:
            raise ValueError(f"{value:g}: {self.name} must be {self.low:g} to {self.high:g} {self.unit}".rstrip())


@dataclass
class AdcInput(Input):
    """An analog input of the chip."""

    @property
    def _wire(self) -> AnalogWire:
        return self.board.analog[self.name[5]][int(self.name[6:])]

    def feed(self, course: Course) -> Undo:
        """Feed the volts at the pin, whatever is soldered there; they are read at each conversion."""
        return self._wire.replace("feed", course.at, steady=isinstance(course, Constant))


@dataclass
class YawRate(Input):
    """The yaw rate of a gyro."""

    gyro: L3G4200D | None = None

    def feed(self, course: Course) -> Undo:
        """Feed the rate, which is read at each sample."""
        return self._turned_by(lambda _source: lambda cycles: (0.0, 0.0, course.at(cycles)))

    def log(self, on_value: OnValue) -> Undo:
        """Report the rate of each sample."""

        def of(source: Rates) -> Rates:
            def rates(cycles: int) -> tuple[float, float, float]:
                x, y, z = source(cycles)
                on_value(cycles, z)
                return x, y, z

            return rates

        return self._turned_by(of)

    def _turned_by(self, change: Callable[[Rates], Rates]) -> Undo:
        gyro = self.gyro
        assert gyro is not None
        before = gyro.rate_source
        gyro.set_rate_source(change(before))
        return lambda: gyro.set_rate_source(before)


Rates = Callable[[int], tuple[float, float, float]]


@dataclass
class YawDigits(Input):
    """The samples of a gyro, behind its filters and its errors."""

    gyro: L3G4200D | None = None

    def feed(self, course: Course) -> Undo:
        """Feed the digits of z, which are read at each sample; x and y are 0."""
        gyro = self.gyro
        assert gyro is not None
        gyro.force_samples(lambda cycles: (0, 0, round(course.at(cycles))))
        return lambda: gyro.force_samples(None)


@dataclass
class Range(Input):
    """The range of a sonar."""

    sensor: LvMaxSonar | None = None

    def feed(self, course: Course) -> Undo:
        """Feed the distance, which is read at each ping."""
        sensor = self.sensor
        assert sensor is not None
        before = sensor.range_source
        sensor.set_range_source(lambda _name, cycles: Echo(course.at(cycles)))
        return lambda: sensor.set_range_source(before)


@dataclass
class Shaft(Input):
    """The shaft angle that the encoder of a motor sees.  The motor turns as before, but its own edges are not used."""

    motor: NxtMotor | None = None
    #: Its encoder as the chip sees it, whatever stands between.
    pins: QuadratureWire | None = None

    def feed(self, course: Course) -> Undo:
        """Feed the angle, which is read when the encoder is read; every edge has its own time."""
        assert self.motor is not None
        return _FedShaft(self.board, self.motor, course).end

    def log(self, on_value: OnValue) -> Undo:
        """Report each edge, at its time."""
        assert self.pins is not None
        edge = 0
        on_value(self.board.clock.now, 0.5 * _EDGE_RAD)

        def moved(edges: int, start: int, end: int) -> None:
            nonlocal edge
            sense, count = (1, edges) if edges > 0 else (-1, -edges)
            for index in range(1, count + 1):
                edge += sense
                on_value(start + (end - start) * index // count, (edge + 0.5) * _EDGE_RAD)

        return self.pins.moved.connect(moved)


class _FedShaft:
    """A shaft that only a course turns."""

    def __init__(self, board: Board, motor: NxtMotor, course: Course) -> None:
        self._clock = board.clock
        self._motor = motor
        self._pins = motor.encoder
        self._course = course
        motor.encoder = QuadratureWire(f"{self._pins.name} of the fed shaft")
        #: The same encoder on a shaft of its own, which places the edges of a steady turn.
        self._shaft = NxtMotor(motor.bridge, self._pins, motor.params)
        self._done = self._last = self._clock.now
        self._angle_rad = course.at(self._done)
        self._edge = floor(self._angle_rad / _EDGE_RAD)
        # It begins where the encoder stands: only what it turns from there counts.
        self._shaft.angle_rad = self._angle_rad - self._edge * _EDGE_RAD
        self._stop_listening = self._pins.looked_at.connect(self._advance)
        self._event: ClockEvent | None = self._clock.after(_SAMPLE_CYCLES, self._sample)

    def end(self) -> None:
        """Return to the motor's shaft, from the present count of the encoder."""
        self._advance()
        self._stop_listening()
        self._clock.cancel(self._event)
        self._motor.encoder = self._pins

    def _sample(self) -> None:
        self._advance()
        self._event = self._clock.after(_SAMPLE_CYCLES, self._sample)

    def _advance(self) -> None:
        now, course = self._clock.now, self._course
        while self._done < now:
            start, end = self._done, min(course.after(self._done), now)
            self._done = end  # first: who hears of an edge may look again
            angle_rad = course.at(end)
            if course.smooth:
                turned = angle_rad - self._angle_rad
                self._angle_rad = angle_rad
                self._shaft.turn(turned, start, end, turned * SYSCLK_HZ / int(end - start))
            else:
                edge = floor(angle_rad / _EDGE_RAD)
                if edge != self._edge:
                    edges, self._edge = edge - self._edge, edge
                    last, self._last = self._last, end
                    self._pins.move(edges, max(last, start) if abs(edges) > 1 else last, end)


@dataclass
class TouchInput(Input):
    """A touch sensor."""

    sensor: TouchSensor | None = None

    def feed(self, course: Course) -> Undo:
        """Feed the switch, which is pressed from 0.5 on, at the times of the course; another press takes effect
        afterwards."""
        sensor = self.sensor
        assert sensor is not None
        player = _Player(self.board, course, lambda value: sensor.feed(value >= 0.5))

        def undo() -> None:
            player.end()
            sensor.feed(None)

        return undo

    def log(self, on_value: OnValue) -> Undo:
        """Report each press and each release."""
        sensor, clock = self.sensor, self.board.clock
        assert sensor is not None
        on_value(clock.now, float(sensor.pressed))
        return sensor.pressed_changed.connect(lambda pressed: on_value(clock.now, float(pressed)))


@dataclass
class FaceInput(Input):
    """A face of any part that can be set."""

    part: Part | None = None

    def feed(self, course: Course) -> Undo:
        """Set the face when the course changes; at the end restore its earlier value, if that is known."""
        part, face = self.part, self.name.rpartition(".")[2]
        assert part is not None
        before = part.value(face)
        player = _Player(self.board, course, lambda value: part.put(face, value))

        def undo() -> None:
            player.end()
            if before is not None:
                part.put(face, before)

        return undo


class _Player:
    """Sets a value along a course: now, and whenever the course changes."""

    def __init__(self, board: Board, course: Course, put: Callable[[float], None]) -> None:
        self._clock, self._course, self._put = board.clock, course, put
        self._event: ClockEvent | None = None
        self._play()

    def _play(self) -> None:
        now = self._clock.now
        self._put(self._course.at(now))
        after = self._course.after(now)
        self._event = None if after == NEVER else self._clock.schedule(after, self._play)

    def end(self) -> None:
        """End the feed."""
        self._clock.cancel(self._event)


def of_part(board: Board, part: Part) -> Iterator[Input]:
    """The inputs of a part that can be fed."""
    name, device = part.name, part.device
    found: list[Input] = []
    if isinstance(device, L3G4200D):
        found = [YawRate(board, f"{name}.yaw_rate_rad_s", "rad/s", -35.0, 35.0, device),
                 YawDigits(board, f"{name}.yaw_digits", "", -32768, 32767, device)]  # fmt: skip
    elif isinstance(device, SonarRing):
        sensors = device.sensors.items()
        found = [Range(board, f"{name}.{each}_range_m", "m", 0.0, 10.0, sensor) for each, sensor in sensors]
    elif isinstance(device, LvMaxSonar):
        found = [Range(board, f"{name}.range_m", "m", 0.0, 10.0, device)]
    elif isinstance(device, NxtMotor):
        a, b = (int(part.pins[each].removeprefix("GPIO")) if each in part.pins else -1 for each in "AB")
        pins = board.encoder_pins.get((a, b), device.encoder)
        found = [Shaft(board, f"{name}.angle_rad", "rad", -1e6, 1e6, device, pins)]
    elif isinstance(device, TouchSensor):
        found = [TouchInput(board, f"{name}.pressed", "", 0, 1, device)]
    yield from found
    for face in part.faces:
        if part.is_set(face.name) and f"{name}.{face.name}" not in [each.name for each in found]:
            yield FaceInput(board, f"{name}.{face.name}", face.unit, face.low, face.high, part)


def inputs(board: Board) -> Iterator[Input]:
    """The inputs of all parts of a board that can be fed."""
    for part in board.parts.values():
        yield from of_part(board, part)


def find(board: Board, name: str) -> Input:
    """An input by its name, `PART.FACE` or `ADCINA3`.  Raises ValueError with the known names."""
    pin = re.fullmatch(r"ADCIN([A-Z])(\d{1,2})", name)
    if pin is not None:
        wires = board.analog.get(pin[1], ())
        if int(pin[2]) < len(wires):
            return AdcInput(board, f"ADCIN{pin[1]}{int(pin[2])}", "V", -1.0, 5.0)
        there = ", ".join(f"ADCIN{adc}0 to {len(each) - 1}" for adc, each in board.analog.items())
        raise ValueError(f"no input {name!r}: this chip has {there}")
    for each in inputs(board):
        if each.name == name:
            return each
    there = ", ".join([*(each.name for each in inputs(board)), "and its pins ADCIN.."])
    raise ValueError(f"no input {name!r}: {type(board).__name__} has {there}")
