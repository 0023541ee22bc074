"""LV-MaxSonar-EZ (MB10x0) ultrasonic range finder.

Modelled: power-up, calibration at the first command, 49 ms cycle, RX sampled at the end of a cycle and qualified for
20 us when idle, chaining pulse on TX, serial `Rddd`, PW, the analog value (`lv_maxsonar_analog`), whole inches from 6
to 254 and 255 for no echo, cross-talk between sensors on one `SonarAir`, a blind range learned at calibration,
an interrupted supply (`set_power`), an oscillator that differs from the chip's (`set_second`).
Not modelled: temperature compensation (there is none), warm-up drift of the near range, the inverted voltage of the
serial line (frames are sent as a receiver behind an inverter sees them), BW switched while running.
Time: in a ring, three events for each cycle (end of cycle, end of the TX pulse, RX qualified); free running, one.  PW
and the serial output add events when they are wired.
Sources: EZ features, pin description, timing description.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US, SYSCLK_HZ, Clock, ClockEvent
from emulator.devices.lv_maxsonar_analog import RISE_TAU, HeldVoltage
from emulator.devices.lv_maxsonar_beam import INCH_M, Echo
from emulator.devices.lv_maxsonar_readings import SonarReadings
from emulator.devices.report import DeviceReport, Mark
from emulator.signals import AnalogWire, SerialFrame, SerialLine, Wire

POWER_UP_CYCLES: Final = 250 * CYCLES_PER_MS
CYCLE_CYCLES: Final = 49 * CYCLES_PER_MS
LISTEN_CYCLES: Final = 37_500 * CYCLES_PER_US
SLEW_END_CYCLES: Final = 44_300 * CYCLES_PER_US
START_PULSE_CYCLES: Final = 20 * CYCLES_PER_US
PER_INCH_CYCLES: Final = 147 * CYCLES_PER_US
CROSS_TALK_CYCLES: Final = 38 * CYCLES_PER_MS

#: CHOICE: length of the chaining pulse; the sheet asks for at least 20 us at the next RX.
TX_PULSE_CYCLES: Final = 100 * CYCLES_PER_US

#: The sensor takes 147 us for an inch there and back, whatever the weather.
NOMINAL_SOUND_M_S: Final = 2.0 * INCH_M / 147e-6

FLOOR_IN: Final = 6
CEILING_IN: Final = 254
NOTHING_IN: Final = 255
#: An object nearer than this during calibration may become invisible at its distance.
CALIBRATION_CLEAR_IN: Final = 14

#: CHOICE: standard deviation of a realistic specimen's ranging before the inch is cut off.
JITTER_IN: Final = 0.1

_BAUD: Final = 9600


class SonarAir:
    """The air that the sensors of one robot share: they hear each other's pings.

    `cross_source(from_name, to_name, cycles)` is the path length in metres of a ping by way of a reflector to the
    other sensor, or None when nothing arrives.  It is called only when the other sensor listens within 38 ms.
    """

    __slots__ = ("_sensors", "cross_source")

    def __init__(self, cross_source: Callable[[str, str, int], float | None] | None = None) -> None:
        self.cross_source = cross_source or (lambda _from, _to, _cycles: None)
        self._sensors: list[LvMaxSonar] = []

    def set_cross_source(self, source: Callable[[str, str, int], float | None]) -> None:
        """Set the source of path lengths from one sensor to another from now on."""
        self.cross_source = source

    def add(self, sensor: LvMaxSonar) -> None:
        """A sensor begins to share this air."""
        self._sensors.append(sensor)

    @property
    def started(self) -> bool:
        """Whether one of the sensors has been started."""
        return any(sensor.busy or sensor.readings for sensor in self._sensors)

    def ping(self, source: LvMaxSonar, cycles: int) -> None:
        """`source` pings now.  Sensors that listen may hear it, and it may hear pings that were sent just before."""
        for other in self._sensors:
            if other is source:
                continue
            if cycles < other.listening_until:
                self._carry(source, other, cycles)
            if other.readings and cycles - other.last_ping_cycles < other.scaled(CROSS_TALK_CYCLES):
                self._carry(other, source, other.last_ping_cycles)

    def _carry(self, source: LvMaxSonar, listener: LvMaxSonar, cycles: int) -> None:
        path_m = self.cross_source(source.name, listener.name, cycles)
        if path_m is not None:
            listener.receive_ping(cycles + listener.scaled(path_m / listener.sound_m_s * SYSCLK_HZ))


class LvMaxSonar:
    """One sensor.

    For the bus: `rx` (start), `tx` (chaining pulse, driven), `analog` (AN), optional `pw` and `serial` (with
    `bw_high=False`).  For the world: `range_source(name, cycles)`, called at each ping; `last_reading_in`,
    `last_ping_cycles`, `readings`.  `period_factor` is this specimen's cycle relative to 49 ms.
    """

    def __init__(
        self,
        clock: Clock,
        *,
        name: str,
        analog: AnalogWire,
        rx: Wire,
        tx: Wire | None,
        vcc_v: float = 3.3,
        rng: random.Random,
        ideal: bool = True,
        period_factor: float = 1.0,
        range_source: Callable[[str, int], Echo | None] | None = None,
        air: SonarAir | None = None,
        sound_m_s: float = NOMINAL_SOUND_M_S,
        bw_high: bool = True,
        pw: Wire | None = None,
        serial: SerialLine | None = None,
        powered_up: bool = False,
        report: DeviceReport | None = None,
        mark: Callable[[], Mark] | None = None,
    ) -> None:
        """`powered_up`: power came on long ago, and the sensor waits for its first command."""
        if not 2.5 <= vcc_v <= 5.5:
            raise ValueError(f"LV-MaxSonar {name}: supply {vcc_v} V; expected 2.5 to 5.5 V")
        if not 0.9 <= period_factor <= 1.1:
            raise ValueError(f"LV-MaxSonar {name}: period factor {period_factor}; expected 0.9 to 1.1")
        self.clock = clock
        self.name = name
        self.rx = rx
        self.tx = tx
        self.vcc_v = vcc_v
        self.ideal = ideal
        self.sound_m_s = sound_m_s
        self.range_source = range_source or (lambda _name, _cycles: None)
        self.air = air or SonarAir()
        self.air.add(self)
        self._period_factor = period_factor
        #: The factor by which its times, in cycles, are longer than they should be.
        self._longer = 1.0
        self.cycle_cycles = self.scaled(CYCLE_CYCLES * period_factor)
        self.bw_high = bw_high
        #: The reading of the latest ping in inches (0 before the first), its time, and the number of readings.
        self.last_reading_in = 0
        self.last_ping_cycles = 0
        self.readings = 0
        self.listening_until = 0
        self._rng = rng
        self._pw = pw
        self._serial = serial
        self._previous_in = 0
        self._calibrated = False
        self._ready = False
        self._busy = False
        self._start: ClockEvent | None = None
        #: The end of start-up, of calibration, or of the cycle of ranging.
        self._next: ClockEvent | None = None
        self._tx_fall: ClockEvent | None = None
        self._pw_fall: ClockEvent | None = None
        self._blind_in: int | None = None
        self._scale = 1.0 if ideal else _supply_error(vcc_v, rng)
        self._near_error_in = {} if ideal else _near_errors(rng)
        #: Cycles between the latest two pings, 0 before there are two.
        self.ping_interval = 0
        self._watch = watch = None if report is None else SonarReadings(self, report, mark or tuple)
        #: AN.  CHOICE: 0 V until the first reading.
        self.held = HeldVoltage(
            0.0, 0.0 if ideal else vcc_v / 1024.0, rng.getrandbits(32) if not ideal else 0,
            None if watch is None else watch.converted,
        )  # fmt: skip
        analog.follow(name, self.held)
        # RX is pulled up inside the sensor; TX idles low (inverted RS-232).
        rx.set_pull(1)
        rx.changed.connect(self._rx_changed)
        if tx is not None:
            tx.drive(name, 0)
        if pw is not None:
            pw.drive(name, 0)
        if powered_up:
            self._calibrated = self._ready = True
        else:
            self._next = clock.after(POWER_UP_CYCLES, self._powered_up)

    @property
    def busy(self) -> bool:
        """Whether a calibration or ranging cycle is running."""
        return self._busy

    @property
    def idle(self) -> bool:
        """Whether neither it nor another sensor of its ring has ever been started."""
        return self._ready and not self.air.started

    @property
    def blind_in(self) -> int | None:
        """The distance in inches of an object that was too near during calibration and has been ignored since."""
        return self._blind_in

    def set_range_source(self, source: Callable[[str, int], Echo | None]) -> None:
        """Set the source of its ranges from now on."""
        self.range_source = source

    def set_second(self, cycles: float) -> None:
        """Set the length of a second of its own oscillator, from the next ranging cycle on."""
        self._longer = cycles / SYSCLK_HZ
        self.cycle_cycles = self.scaled(CYCLE_CYCLES * self._period_factor)
        self.held.rise_tau = RISE_TAU * self._longer

    def scaled(self, cycles: float) -> int:
        """The true length of a time of its own that should last `cycles`."""
        return round(cycles * self._longer)

    def set_power(self, on: bool) -> None:
        """Its supply fails, or comes back.

        Without supply it forgets all, and AN and TX are at ground.  With supply it starts up again.
        """
        for event in (self._next, self._start, self._pw_fall, self._tx_fall):
            self.clock.cancel(event)
        self._start = None
        self._busy = self._ready = self._calibrated = False
        self.last_reading_in = self.ping_interval = self.listening_until = 0
        self._blind_in = None
        self.held.move(0.0, self.clock.now, self.clock.now, finish=True)
        # A read is not reported as one before the first measurement: the sensor had measured before.
        self.held.set_conversion_callback(None)
        self._lower_tx()
        self._lower_pw()
        if on:
            self._next = self.clock.after(self.scaled(POWER_UP_CYCLES), self._powered_up)

    def receive_ping(self, cycles: int) -> None:
        """Another sensor's sound arrives at `cycles`.  Before the sensor's own echo, it gives a phantom range."""
        flight = cycles - self.last_ping_cycles
        if flight > 0 and cycles < self.listening_until:
            phantom = self._inches(flight / self._longer / PER_INCH_CYCLES)
            if phantom < self.last_reading_in:
                self._finish_range(phantom, cycles)

    # Start

    def _powered_up(self) -> None:
        self._ready = True
        if self.rx.level:
            self._begin()

    def _rx_changed(self, level: int) -> None:
        """RX has changed.  It counts after 20 us of high level; within a cycle only its level at the end counts."""
        if not level:
            self.clock.cancel(self._start)
            self._start = None
        elif self._ready and not self._busy and self._start is None:
            self._start = self.clock.after(self.scaled(START_PULSE_CYCLES), self._begin)

    def _begin(self) -> None:
        self._start = None
        self._busy = True
        if self._calibrated:
            self._range()
        else:
            # CHOICE: the calibration cycle precedes the range cycle of the first command, whichever it is.
            self._next = self.clock.after(self.cycle_cycles, self._calibration_done)

    def _calibration_done(self) -> None:
        self._calibrated = True
        if self._watch is not None:
            self.held.set_conversion_callback(self._watch.converted)
        echo = None if self.ideal else self.range_source(self.name, self.clock.now)
        # CHOICE: "may be ignored" has a probability of one half.
        if echo is not None and echo.range_m / INCH_M < CALIBRATION_CLEAR_IN and self._rng.random() < 0.5:
            self._blind_in = math.floor(echo.range_m / INCH_M)
        self._range()

    # One ranging cycle

    def _range(self) -> None:
        now = self.clock.now
        echo = self.range_source(self.name, now)
        while echo is not None and not self._is_detected(echo):
            echo = echo.behind
        flight_in = math.inf if echo is None else 2.0 * echo.range_m / self.sound_m_s / 147e-6
        reading = self._inches(flight_in)
        self._previous_in = self.last_reading_in
        self.ping_interval = now - self.last_ping_cycles if self.readings else 0
        self.last_ping_cycles = now
        self.readings += 1
        listen = self.scaled(LISTEN_CYCLES)
        self.listening_until = now + listen
        if self._pw is not None:
            self._pw.drive(self.name, 1)
        self._finish_range(
            reading, now + (listen if reading == NOTHING_IN else self.scaled(flight_in * PER_INCH_CYCLES))
        )
        self.air.ping(self, now)
        self._next = self.clock.schedule(now + self.cycle_cycles, self._cycle_done)
        if self._serial is not None and not self.bw_high:
            # CHOICE: the five characters end with the cycle (5.2 ms; the sheet speaks of the last 4.7 ms).
            self.clock.schedule(now + self.cycle_cycles - round(50 * SYSCLK_HZ / _BAUD), self._send_serial)

    def _is_detected(self, echo: Echo) -> bool:
        if self._blind_in is not None and abs(math.floor(echo.range_m / INCH_M) - self._blind_in) <= 1:
            return False
        if self.ideal:
            return echo.strength >= 0.5
        return self._rng.random() < echo.strength

    def _inches(self, flight_in: float) -> int:
        """The range that the sensor reports for a time of flight in inches (of 147 us).  It is cut to whole inches."""
        if flight_in == math.inf:
            return NOTHING_IN
        measured = flight_in * self._scale
        if not self.ideal:
            measured += self._near_error_in.get(math.floor(measured), 0.0) + self._rng.gauss(0.0, JITTER_IN)
        inches = math.floor(measured + 1e-9)
        if inches > CEILING_IN:
            return NOTHING_IN
        return max(FLOOR_IN, inches)

    def _finish_range(self, reading_in: int, echo: int) -> None:
        """The result of this cycle is known at `echo`: the analog value begins to move, and PW falls."""
        self.last_reading_in = reading_in
        self.held.move(
            reading_in * self.vcc_v / 512.0,
            echo,
            self.last_ping_cycles + self.scaled(SLEW_END_CYCLES),
            finish=reading_in == self._previous_in,
        )
        if self._watch is not None:
            self._watch.moved()
        if self._pw is not None:
            self.clock.cancel(self._pw_fall)
            self._pw_fall = self.clock.schedule(echo, self._lower_pw)

    def _lower_pw(self) -> None:
        if self._pw is not None:
            self._pw.drive(self.name, 0)

    def _cycle_done(self) -> None:
        """End of the cycle: RX is sampled, then TX tells the next sensor.

        CHOICE: the pulse comes at the very end, so a ring of n sensors takes n cycles.
        """
        if self.rx.level:
            self._range()
        else:
            self._busy = False
        if self.tx is not None and self.bw_high:
            self.tx.drive(self.name, 1)
            self._tx_fall = self.clock.after(self.scaled(TX_PULSE_CYCLES), self._lower_tx)

    def _lower_tx(self) -> None:
        if self.tx is not None:
            self.tx.drive(self.name, 0)

    def _send_serial(self) -> None:
        """`Rddd` and a carriage return at 9600 baud, 8N1."""
        bit = SYSCLK_HZ / _BAUD
        now = self.clock.now
        for i, data in enumerate(b"R%03d\r" % self.last_reading_in):
            frame = SerialFrame(data, now + round(10 * i * bit), now + round(10 * (i + 1) * bit), bit)
            self.clock.schedule(frame.end, partial(self._send_frame, frame))

    def _send_frame(self, frame: SerialFrame) -> None:
        if self._serial is not None:
            self._serial.send(frame)


def _supply_error(vcc_v: float, rng: random.Random) -> float:
    """Range read over true range: 1-2 % long at 3.3 V, within 1 % at 5 V (CHOICE: a straight line between)."""
    low = min(1.0, max(0.0, (5.0 - vcc_v) / (5.0 - 3.3)))
    return 1.0 + low * rng.uniform(0.01, 0.02) + (1.0 - low) * rng.uniform(-0.01, 0.01)


def _near_errors(rng: random.Random) -> dict[int, float]:
    """Errors by distance from 6 to 20 inches, where the echo can cancel.

    CHOICE: one inch in ten is wrong, by up to two inches, always the same for one specimen.
    """
    return {inch: rng.uniform(-2.0, 2.0) for inch in range(FLOOR_IN, 21) if rng.random() < 0.1}
