"""Faults of supplies: the motors' sags, the sensors' 3.3 V breaks in.

LB: the bridge works from 2.5 V on.  A brown-out resets the gyro, which answers nothing while it lasts, and drops the
motors' supply to nothing.
Not modelled: the chip's own reset (it is taken to ride through), the sonars (they keep their last reading).
"""

from __future__ import annotations

from emulator.devices.nxt_motor import NxtMotor
from hil.faults.effect import Carrier, Effect, Mounted
from hil.faults.gyro import SelectLost
from hil.faults.kinds import FaultKind, Parameter

#: What is left of a supply that is gone.
_GONE_V = 0.01


class Sag(Effect):
    """The motors' supply falls."""

    def __init__(self, mounted: Mounted) -> None:
        super().__init__(mounted)
        self.motors = list(self.board.find(NxtMotor).values())

    @classmethod
    def suits(cls, machine: Carrier) -> None:
        """Raises ValueError for a board without motors."""
        if not machine.board.find(NxtMotor):
            raise ValueError("this board has no motors")

    def begin(self) -> None:
        """It begins."""
        self.supply(self.number("volts"))

    def supply(self, volts: float) -> None:
        """All motors get so much, until the end."""
        for motor in self.motors:
            bridge = motor.bridge
            # What has passed was at the old supply: whoever turns the shaft brings it up to now.
            motor.encoder.sync()
            self._changes(motor, bridge.supply_v)
            bridge.supply_v = volts
            for wire in (bridge.in1, bridge.in2):
                self.ends_with(wire.duty_changed.connect(self._driven))
        self._driven()

    def _changes(self, motor: NxtMotor, before_v: float) -> None:
        def back() -> None:
            motor.encoder.sync()
            motor.bridge.supply_v = before_v

        self.ends_with(back)

    def _driven(self) -> None:
        if any(motor.bridge.in1.duty != motor.bridge.in2.duty for motor in self.motors):
            self.fired()


class BrownOut(SelectLost):
    """The 3.3 V breaks in."""

    def begin(self) -> None:
        """It begins."""
        super().begin()
        self.ends_with(self.gyro.reset)
        self.gyro.reset()
        self.fired(self.received)
        for motor in self.board.find(NxtMotor).values():
            motor.encoder.sync()
            self._without(motor, motor.bridge.supply_v)
            motor.bridge.supply_v = _GONE_V

    def _without(self, motor: NxtMotor, before_v: float) -> None:
        def back() -> None:
            motor.encoder.sync()
            motor.bridge.supply_v = before_v

        self.ends_with(back)


KINDS = (
    FaultKind("supply-sag", "The motors' supply falls.", "motors", Sag,
              (Parameter("volts", "V", "what is left", 4.0, 0.1, 9.0),)),
    FaultKind("brown-out", "All supplies but the chip's break in: the gyro is reset, the motors stand still.",
              "a gyro L3G4200D on an SPI", BrownOut),
)  # fmt: skip
