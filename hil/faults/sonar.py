"""Faults of a sonar: it detects nothing, always the same range, or the pings of another robot.

A sensor that detects nothing reports its ceiling of 255 inches (EZ, range).  CHOICE: a stuck sensor takes its own
ring-down for an echo.  Foreign pings come at random times; one that comes before the own echo is taken for it, as the
device does with the pings of its own ring.
The firmware meets the fault with the first conversion after AN has settled on it, 44.3 ms after the ping.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.devices.lv_maxsonar import SLEW_END_CYCLES, LvMaxSonar
from emulator.devices.lv_maxsonar_beam import Echo
from emulator.devices.lv_maxsonar_ring import SonarRing
from hil.board import Board
from hil.faults.effect import Effect, FaultTarget, MountedFault
from hil.faults.kinds import FaultKind, FaultParameter

_SENSOR: Final = FaultParameter("sensor", "", "name in the ring: LEFT, FRONT, RIGHT, ...", "FRONT", type=str)


def sensors(board: Board) -> dict[str, tuple[LvMaxSonar, str, int]]:
    """The sonars of a board by name, each with the ADC and channel of its AN output."""
    found = {}
    for ring_name, ring in board.find(SonarRing).items():
        for name, sensor in ring.sensors.items():
            pin = board.part(ring_name).pins[name].removeprefix("ADCIN")
            found[name] = (sensor, pin[0], int(pin[1:]))
    return found


class _OfSensor(Effect):
    """A fault of one sensor."""

    def __init__(self, mounted: MountedFault) -> None:
        super().__init__(mounted)
        found = sensors(self.board)
        wanted = self.text("sensor").upper()
        if wanted not in found:
            raise ValueError(f"no sonar {wanted!r}: {', '.join(found)}")
        self.sensor, self.adc, self.channel = found[wanted]
        self.asked: Callable[[str, int], Echo | None] = self.sensor.range_source

    @classmethod
    def check_machine(cls, machine: FaultTarget) -> None:
        """Raises ValueError for a board without sonars."""
        if not machine.board.find(SonarRing):
            raise ValueError("this board has no sonars")

    def hears(self, source: Callable[[str, int], Echo | None]) -> None:
        """Let `source` give the echo of the sensor, until the end of the fault; `asked` gives the true one."""
        self.asked = self.sensor.range_source
        self.sensor.set_range_source(source)
        self.on_end(lambda: self.sensor.set_range_source(self.asked))

    def pinged(self) -> None:
        """Report that the reading of this ping differs from the true one."""
        self.fired()
        if self.mounted.count == 1:
            self.clock.after(SLEW_END_CYCLES, self._settled)

    def _settled(self) -> None:
        self.mounted.watch(self.results(self.adc, self.channel))


class SonarDeaf(_OfSensor):
    """The sonar detects nothing."""

    def begin(self) -> None:
        """Begin the fault."""
        self.hears(self._nothing)

    def _nothing(self, name: str, cycles: int) -> Echo | None:
        if self.asked(name, cycles) is not None:
            self.pinged()
        return None


class EchoStuck(_OfSensor):
    """The sonar always detects the same echo."""

    def begin(self) -> None:
        """Begin the fault."""
        self.hears(self._same)

    def _same(self, name: str, cycles: int) -> Echo | None:
        echo, stuck = self.asked(name, cycles), self.number("range")
        if echo is None or echo.range_m != stuck:
            self.pinged()
        return Echo(stuck)


class CrossTalk(_OfSensor):
    """Another sonar pings nearby."""

    def begin(self) -> None:
        """Begin the fault."""
        self.repeat(self.number("rate"), self._arrives)

    def _arrives(self) -> None:
        before = self.sensor.last_reading_in
        self.sensor.receive_ping(self.clock.now)
        if self.sensor.last_reading_in != before:
            self.pinged()


KINDS = (
    FaultKind(
        "sonar-deaf", "A sonar hears no echo: it reports its ceiling.", "a ring of sonars", SonarDeaf, (_SENSOR,)
    ),
    FaultKind(
        "sonar-stuck", "A sonar always reports the same range.", "a ring of sonars", EchoStuck,
        (_SENSOR, FaultParameter("range", "m", "the distance that it reports", 0.1524, 0.1524, 6.45)),
    ),
    FaultKind(
        "sonar-cross-talk", "Pings of another sonar arrive: one before the echo counts as the echo.",
        "a ring of sonars", CrossTalk, (_SENSOR,),
        FaultParameter("rate", "Hz", "pings that arrive, at random times", 20.0, 0.01, 1000.0),
    ),
)  # fmt: skip
