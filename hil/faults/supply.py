"""Faults of supplies: the motors' supply sags, the sensors' 3.3 V is interrupted.

A brown-out leaves `volts` of both supplies.  Bridges work from 2.5 V on (LB), sonars too (EZ).  Below, motors have no
current, and sonars are off with AN at ground; they start up again as after power-up, with 250 ms and a calibration at
their first command.  Below 2.4 V (L3G) the gyro is reset, and does not answer until the supply returns.
Not modelled: the chip's own reset; its capacitors are assumed to supply it meanwhile.  The kernel's tasks run on stacks
of Python, so neither they nor the memory of C can begin anew within a run.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.devices.lv_maxsonar_ring import SonarRing
from emulator.devices.nxt_motor import NxtMotor
from hil.faults.effect import Effect, FaultTarget, MountedFault
from hil.faults.gyro import SelectLost
from hil.faults.kinds import FaultKind, FaultParameter
from hil.faults.sonar import sensors

#: L3G: the least supply of the gyro.
_GYRO_V: Final = 2.4
#: A bridge's supply that is too low for it.
_GONE_V: Final = 0.01


def supplied(motor: NxtMotor, volts: float) -> Callable[[], None]:
    """Set the supply of a motor; the returned function restores it."""
    before_v = motor.bridge.supply_v

    def put(volts: float) -> None:
        # What has passed was at the old supply: whoever turns the shaft brings it up to now.
        motor.encoder.sync()
        motor.bridge.supply_v = volts

    put(volts)
    return partial(put, before_v)


class SupplySag(Effect):
    """The motors' supply sags."""

    def __init__(self, mounted: MountedFault) -> None:
        super().__init__(mounted)
        self.motors = list(self.board.find(NxtMotor).values())

    @classmethod
    def check_machine(cls, machine: FaultTarget) -> None:
        """Raises ValueError for a board without motors."""
        if not machine.board.find(NxtMotor):
            raise ValueError("this board has no motors")

    def begin(self) -> None:
        """Begin the fault."""
        self.supply(self.number("volts"))

    def supply(self, volts: float) -> None:
        """Set the supply of all motors, until the end of the fault."""
        for motor in self.motors:
            self.on_end(supplied(motor, volts))
            for wire in (motor.bridge.in1, motor.bridge.in2):
                self.on_end(wire.duty_changed.connect(self._driven))
        self._driven()

    def _driven(self) -> None:
        if any(motor.bridge.in1.duty != motor.bridge.in2.duty for motor in self.motors):
            self.fired()


class BrownOut(SelectLost):
    """The 3.3 V supply is interrupted."""

    def begin(self) -> None:
        """Begin the fault."""
        if self.number("volts") < _GYRO_V:
            super().begin()
            self.on_end(self.gyro.reset)
            self.gyro.reset()
            self.fired(self.received)
        for motor in self.board.find(NxtMotor).values():
            self.on_end(supplied(motor, _GONE_V))
        for ring in self.board.find(SonarRing).values():
            ring.set_power(False)
            self.on_end(partial(ring.set_power, True))
        self.fired(*(cell for _, adc, channel in sensors(self.board).values() for cell in self.results(adc, channel)))


KINDS = (
    FaultKind("supply-sag", "The motors' supply falls.", "motors", SupplySag,
              (FaultParameter("volts", "V", "what is left", 4.0, 0.1, 9.0),)),
    FaultKind("brown-out", "All supplies except the chip's drop: gyro and sonars restart, the motors stop.",
              "a gyro L3G4200D on an SPI", BrownOut,
              (FaultParameter("volts", "V", "what is left; from 2.4 on the gyro bears it", 0.0, 0.0, 2.49),)),
)  # fmt: skip
