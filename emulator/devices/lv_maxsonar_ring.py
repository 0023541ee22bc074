"""Several LV-MaxSonar-EZ in a ring: each ranges when the one before has finished.

Modelled: TX of each sensor at RX of the next one; the last TX at the first RX through 1 kOhm; the start wire, which a
pin may drive against that resistor and then release.
Not modelled: nothing of the application note.
Time: that of the sensors.
Sources: EZ application note on chaining (constantly looping).
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping

from emulator.clock import Clock
from emulator.devices.lv_maxsonar import LvMaxSonar, SonarAir
from emulator.devices.lv_maxsonar_beam import Echo
from emulator.devices.report import DeviceReport, Mark
from emulator.signals import AnalogWire, Wire


def close_ring(last_tx: Wire, first_rx: Wire) -> None:
    """1 kOhm from the last TX to the first RX: stronger than the pull-up in the sensor, weaker than a pin."""
    last_tx.changed.connect(first_rx.set_pull)
    first_rx.set_pull(last_tx.level)


class SonarRing:
    """Sensors in the order of `analogs` (name -> AN wire), kicked through `start`, the first sensor's RX.

    CHOICE: realistic specimens have cycles within 1 % of 49 ms.
    """

    def __init__(
        self,
        clock: Clock,
        analogs: Mapping[str, AnalogWire],
        start: Wire,
        *,
        rng: random.Random,
        ideal: bool = True,
        vcc_v: float = 3.3,
        range_source: Callable[[str, int], Echo | None] | None = None,
        cross_source: Callable[[str, str, int], float | None] | None = None,
        powered_up: bool = False,
        report: DeviceReport | None = None,
        mark: Callable[[], Mark] | None = None,
    ) -> None:
        if len(analogs) < 2:
            raise ValueError(f"a sonar ring of {len(analogs)}: expected at least 2 sensors")
        self.start = start
        self.air = SonarAir(cross_source)
        self.sensors: dict[str, LvMaxSonar] = {}
        rx = start
        for name, analog in analogs.items():
            tx = Wire(f"sonar {name} TX")
            factor = 1.0 if ideal else rng.uniform(0.99, 1.01)
            self.sensors[name] = LvMaxSonar(
                clock,
                name=name,
                analog=analog,
                rx=rx,
                tx=tx,
                vcc_v=vcc_v,
                rng=rng,
                ideal=ideal,
                period_factor=factor,
                range_source=range_source,
                air=self.air,
                powered_up=powered_up,
                report=report,
                mark=mark,
            )
            rx = tx
        close_ring(rx, start)

    def set_second(self, cycles: float) -> None:
        """Set the length of a second of the sensors' own oscillators from now on."""
        for sensor in self.sensors.values():
            sensor.set_second(cycles)

    def set_power(self, on: bool) -> None:
        """The supply of all sensors fails, or comes back."""
        for sensor in self.sensors.values():
            sensor.set_power(on)

    def set_range_source(self, source: Callable[[str, int], Echo | None]) -> None:
        """Set the source of ranges of each sensor from now on."""
        for sensor in self.sensors.values():
            sensor.set_range_source(source)
