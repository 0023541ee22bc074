"""Finds drivers that convert the AN output of an LV-MaxSonar-EZ too early, while it moves, or too often.

Nothing here changes the voltage.  Conversions less than `SAME_READING_CYCLES` apart are one reading: the mean of a
burst reduces the converter's noise, but is no new range.  Reported are (CHOICE of the figures):

* `stale-sample`: three readings of one held range within one cycle of the sensor (49 ms);
* `slew-read`: a voltage that is more than `NEITHER_IN` inches from the range before and from the range to come;
* `startup-read`: a reading before the first range has settled; `not-configured`: the driver has never started a range.

The converter reads the voltage very often.  So `converted` is called only at the first conversion of a reading.  It
returns until when it need not be called again.
Sources: EZ pin description AN, timing description (AN moves until 44.3 ms of the cycle, then holds).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Protocol

from emulator.clock import CYCLES_PER_MS, NEVER
from emulator.devices.lv_maxsonar_analog import HeldVoltage
from emulator.devices.report import DeviceReport, Mark

SAME_READING_CYCLES: Final = CYCLES_PER_MS
NEITHER_IN: Final = 2.0
#: This many ranges are not checked after one that was reported, because keeping the calls takes time.
PAUSE: Final = 15


class MeasuringSonar(Protocol):
    """The properties of the sensor that are used here."""

    name: str
    vcc_v: float
    cycle_cycles: int
    readings: int
    ping_interval: int

    @property
    def idle(self) -> bool:
        """Whether the sensor is ready and was never started."""


class SonarReadings:
    """Watches conversions of one sensor's AN."""

    __slots__ = (
        "_counting", "_mark", "_mark_then", "_pause", "_report", "_sensor", "_slew_told", "_times",
    )  # fmt: skip

    def __init__(self, sensor: MeasuringSonar, report: DeviceReport, mark: Callable[[], Mark]) -> None:
        self._sensor, self._report, self._mark = sensor, report, mark
        #: The number of ranges whose readings need not be counted.
        self._pause = 0
        self.moved()

    def moved(self) -> None:
        """A new range is on its way."""
        #: The times of the readings that count for the held range, newest last; the calls of the last one.
        self._times: list[int] = []
        self._mark_then: Mark = ()
        self._counting = not self._pause
        self._pause = max(0, self._pause - 1)
        self._slew_told = False

    def converted(self, held: HeldVoltage, cycles: int, volts: float) -> int:
        """AN (`held`) was converted at `cycles`.  Returns until when it need not be called again."""
        sensor = self._sensor
        first = sensor.readings == 0 or (sensor.readings == 1 and cycles < held.end)
        if first:
            self._too_early()
            return cycles + SAME_READING_CYCLES
        if self._counting:
            self._again(cycles)
        if held.start < cycles < held.end and not self._slew_told:
            self._slewing(held, volts)
        if self._counting:
            return cycles + SAME_READING_CYCLES
        if self._slew_told or cycles >= held.end or not self._wide(held):
            return NEVER
        return max(held.start + 1, cycles + SAME_READING_CYCLES)

    def _too_early(self) -> None:
        name = f"sonar {self._sensor.name}"
        if self._sensor.idle:
            self._report(
                "not-configured",
                f"AN of {name} was converted though RX was never high for 20 us: the sensor has measured nothing",
                object=f"{name} RX",
            )  # fmt: skip
        else:
            self._report(
                "startup-read", f"AN of {name} was converted before its first range: it holds no range yet",
                object=f"{name} AN",
            )  # fmt: skip

    def _again(self, cycles: int) -> None:
        """Another reading of the range that is held."""
        sensor, taken = self._sensor, self._times
        taken.append(cycles)
        if len(taken) > 2 and cycles - taken[-3] < sensor.cycle_cycles and self._mark_then:
            gap = (cycles - taken[-3]) // 2
            interval = sensor.ping_interval or sensor.cycle_cycles
            times = round(interval / gap)
            message = (
                f"AN of sonar {sensor.name} is converted every {gap / CYCLES_PER_MS:.1f} ms and holds a range for "
                f"{interval / CYCLES_PER_MS:.1f} ms: about {times} readings of 1 range"
            )
            finding = self._report(
                "stale-sample", message, object=f"sonar {sensor.name} AN", value=times, since=self._mark_then
            )
            if finding is not None and isinstance(finding.value, int) and times > finding.value:
                # How long a range is held is known only from the second range on.
                finding.value, finding.message = times, message
            elif sensor.ping_interval:
                self._pause = PAUSE
            self._counting = False
            self._mark_then = ()
        elif len(taken) > 1 and cycles - taken[-2] < sensor.cycle_cycles:
            self._mark_then = self._mark()

    def _wide(self, held: HeldVoltage) -> bool:
        """Whether the voltage passes through ranges that were never measured."""
        return abs(held.target_v - held.from_v) > 2 * NEITHER_IN * self._inch_v

    @property
    def _inch_v(self) -> float:
        return self._sensor.vcc_v / 512.0

    def _slewing(self, held: HeldVoltage, volts: float) -> None:
        inch_v = self._inch_v
        before, after = abs(volts - held.from_v) / inch_v, abs(volts - held.target_v) / inch_v
        if before > NEITHER_IN and after > NEITHER_IN:
            self._slew_told = True
            self._report(
                "slew-read",
                f"AN of sonar {self._sensor.name} was converted while it moves from {held.from_v / inch_v:.0f} to "
                f"{held.target_v / inch_v:.0f} inches: it reads {volts / inch_v:.0f} inches, which was never measured",
                object=f"sonar {self._sensor.name} AN", value=round(volts / inch_v),
            )  # fmt: skip
