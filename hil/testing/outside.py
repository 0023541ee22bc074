"""Sets the inputs of the chip in a test: volts, ranges, rates, shafts, levels.

The methods have units in their names.  A value stays until it is set again, even if a world would set it.  In a test
with `bench`, the world still determines everything else.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from math import radians
from typing import Any, Final, TypeAlias, TypeVar

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ
from emulator.devices.l3g4200d import L3G4200D
from emulator.devices.lv_maxsonar_beam import Echo
from emulator.devices.lv_maxsonar_ring import SonarRing
from emulator.devices.nxt_motor import NxtMotor
from emulator.devices.touch_sensor import TouchSensor
from emulator.signals import DutyWire, Wire
from hil.board import Board

#: The values of one axis: a constant, or a value for each sample; the last one stays.
Samples: TypeAlias = int | Iterable[int]
T = TypeVar("T")


#: The first letters of signals that ignore levels -> what they receive instead.
_INSTEAD: Final = {
    "SCI": "send characters with uart()", "SPI": "attach a device to the bus", "SDA": "attach a device to the bus",
    "SCL": "attach a device to the bus", "EPW": "the module drives it",
}  # fmt: skip


class Outside:
    """The fixture `outside`: sets the inputs of one board.

    A method for a kind of part raises ValueError if the board has no such part.
    """

    def __init__(self, board: Board) -> None:
        self._board = board
        self._wheels: dict[str, _Wheel] = {}

    # ADC

    def adc_volts(self, channel: int, volts: float | Callable[[float], float], adc: str = "A") -> None:
        """Connect a voltage, or a function of the time in seconds, to input `channel` (0..15) of ADC-A to D.

        The part of the board at that input is disconnected.
        """
        inputs = self._of_adc(self._board.analog, adc)
        if not 0 <= channel < len(inputs):
            raise ValueError(f"ADC channel {channel}: this chip has ADCIN0 to ADCIN{len(inputs) - 1}")
        inputs[channel].unplug()
        if callable(volts):
            inputs[channel].follow("test", lambda cycles: volts(cycles / SYSCLK_HZ))
        else:
            inputs[channel].follow("test", lambda _cycles: volts, steady=True)

    def adc_codes(self, codes: Iterable[int] | None, adc: str = "A") -> None:
        """Make the next conversions of ADC-A to D give these codes (0..4095), whatever the voltage is.

        The last code stays.  None ends this: the voltage counts again.
        """
        converter = self._of_adc(self._board.adc, adc)
        if codes is None:
            converter.force_codes(None)
            return
        samples = _endless(codes)
        converter.force_codes(lambda _soc: next(samples))

    @staticmethod
    def _of_adc(parts: Mapping[str, T], adc: str) -> T:
        if adc not in parts:
            raise ValueError(f"no ADC {adc!r}: {', '.join(parts)}")
        return parts[adc]

    # Sonars

    def sonar_range_m(self, sensor: str, range_m: float | None) -> None:
        """Put a wall `range_m` metres in front of the sonar "LEFT", "FRONT" or "RIGHT".  None: there is no wall."""
        sensors = {n: each for ring in self._board.find(SonarRing).values() for n, each in ring.sensors.items()}
        if sensor not in sensors:
            raise ValueError(f"no sonar {sensor!r}: {', '.join(sensors) or 'this board has none'}")
        echo = None if range_m is None else Echo(range_m)
        sensors[sensor].set_range_source(lambda _name, _cycles: echo)

    # Gyro

    def gyro_rate_rad_s(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
        """Turn the gyro at these rates in rad/s (positive: counter-clockwise) from now on.  This ends `gyro_raw`."""
        self._gyro.force_samples(None)
        self._gyro.set_rate_source(lambda _cycles: (x, y, z))

    def gyro_rate_dps(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
        """Turn the gyro at these rates in degrees per second."""
        self.gyro_rate_rad_s(radians(x), radians(y), radians(z))

    def gyro_raw(self, x: Samples = 0, y: Samples = 0, z: Samples = 0) -> None:
        """Set the next samples of the gyro, in digits (-32768..32767).

        A sequence has a value for each sample; the last one stays.  Samples come at the gyro's data rate, after the
        firmware has switched it on.
        """
        a, b, c = (_endless((values,) if isinstance(values, int) else values) for values in (x, y, z))
        self._gyro.force_samples(lambda _cycles: (next(a), next(b), next(c)))

    def gyro_temperature_c(self, temperature_c: float) -> None:
        """Set the die temperature of the gyro in degrees Celsius."""
        self._gyro.set_temperature(temperature_c)

    @property
    def _gyro(self) -> L3G4200D:
        return self._board.only(L3G4200D, "gyro")

    # Wheels

    def wheel_speed_rad_s(self, side: str, speed_rad_s: float) -> None:
        """Turn the shaft of the wheel "left" or "right" from now on, whatever the motor does (positive: forwards)."""
        self._wheel(side).turn_at(speed_rad_s)

    def _wheel(self, side: str) -> _Wheel:
        motors = {name.removesuffix(" motor"): motor for name, motor in self._board.find(NxtMotor).items()}
        if side not in motors:
            raise ValueError(f"no wheel {side!r}: {', '.join(motors) or 'this board has none'}")
        if side not in self._wheels:
            self._wheels[side] = _Wheel(self._board, motors[side])
        return self._wheels[side]

    # Parts of one's own

    def part(self, name: str) -> Any:
        """The part of the board with the name `name`.  Raises ValueError if there is none."""
        return self._board.part(name).device

    def put(self, name: str, **faces: float) -> None:
        """Set faces of a part: `outside.put("infrared", distance_m=0.3)`.

        Raises ValueError for a face that the part does not have, and for a value outside of the range of the face.
        """
        part = self._board.part(name)
        for face, value in faces.items():
            part.put(face, value)

    # Pins

    def bumper(self, pressed: bool) -> None:
        """Press or release the bumper."""
        self._board.only(TouchSensor, "bumper").press(pressed)

    def drive_pin(self, gpio: int, level: int | None) -> None:
        """Drive GPIO`gpio` from outside with 0 or 1; None releases it.

        Raises ValueError if that would have no effect: the pin belongs to a module that ignores levels, or another
        driver drives it to the other level.
        """
        pin = self._pin(gpio)
        signal = self._board.signal_of(gpio)
        instead = _INSTEAD.get(signal[:3], "")
        if level is not None and instead:
            raise ValueError(f"GPIO{gpio} is {signal}, which does not see levels: {instead}")
        pin.drive("test", level)
        if level is not None and pin.contention:
            others = " and ".join(sorted(pin.drivers() - {"test"}))
            pin.drive("test", None)
            raise ValueError(f"GPIO{gpio} is driven to {1 - level} by {others}: two drivers of one pin")


    def pin(self, gpio: int) -> int:
        """The level of GPIO`gpio`."""
        return self._pin(gpio).level

    def _pin(self, gpio: int) -> Wire:
        return pin_of(self._board, gpio)

    def pwm_duty(self, gpio: int) -> float:
        """The duty (0 to 1) of the ePWM output on GPIO`gpio` (0..23, 145..168)."""
        return self._pwm(gpio).duty

    def pwm_period_s(self, gpio: int) -> float:
        """The period in seconds of the PWM on GPIO`gpio`; 0 for a steady level."""
        return self._pwm(gpio).period_cycles / SYSCLK_HZ

    def _pwm(self, gpio: int) -> DutyWire:
        outputs = self._board.pwm_outputs
        if f"GPIO{gpio}" not in outputs:
            raise ValueError(f"no ePWM reaches GPIO{gpio}: one of {', '.join(outputs)}")
        return outputs[f"GPIO{gpio}"]


def pin_of(board: Board, gpio: int) -> Wire:
    """The pin GPIO`gpio` of the chip.  Raises ValueError if the chip has none."""
    if not 0 <= gpio < len(board.pins):
        raise ValueError(f"pin {gpio}: this chip has GPIO0 to GPIO{len(board.pins) - 1}")
    return board.pins[gpio]


class _Wheel:
    """A shaft that is turned from outside.  It moves every millisecond, and when the encoder is read."""

    def __init__(self, board: Board, motor: NxtMotor) -> None:
        self._clock = board.clock
        self._motor = motor
        self._speed_rad_s = 0.0
        self._since = self._clock.now
        motor.encoder.looked_at.connect(self._sync)
        self._tick()

    def turn_at(self, speed_rad_s: float) -> None:
        """Set the speed from now on."""
        self._sync()
        self._speed_rad_s = self._motor.omega_rad_s = speed_rad_s

    def _sync(self) -> None:
        now, since = self._clock.now, self._since
        if now > since:
            self._since = now
            speed = self._speed_rad_s
            self._motor.turn(speed * int(now - since) / SYSCLK_HZ, since, now, speed)

    def _tick(self) -> None:
        self._sync()
        self._clock.after(CYCLES_PER_MS, self._tick)


def _endless(values: Iterable[int]) -> Iterator[int]:
    """The values, and the last one for ever.  Raises ValueError for none."""
    last: int | None = None
    for last in values:
        yield last
    if last is None:
        raise ValueError("expected at least one value")
    while True:
        yield last
