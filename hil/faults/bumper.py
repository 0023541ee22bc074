"""Faults of a touch sensor: it is stuck, or its contact bounces by itself."""

from __future__ import annotations

from typing import Final

from emulator.devices.touch_sensor import TouchSensor
from emulator.registers.cell import Cell
from emulator.signals import Wire
from hil.board import Board
from hil.faults.effect import Effect, FaultTarget, MountedFault
from hil.faults.kinds import FaultKind, FaultParameter

_DRIVER: Final = "touch sensor"


class _OfBumper(Effect):
    """A fault of the contact: the sensor drives a wire without a pin, and the fault drives the pin."""

    def __init__(self, mounted: MountedFault) -> None:
        super().__init__(mounted)
        self.bumper = _bumper(self.board)
        part = next(part for part in self.board.parts.values() if part.device is self.bumper)
        gpio = int(part.pins["S"].removeprefix("GPIO"))
        self.pin = self.board.pins[gpio]
        self.data: Cell = self.board.blocks["GpioDataRegs"].registers[f"GP{'ABCDEF'[gpio // 32]}DAT"]
        #: What the contact would do.
        self.contact = Wire("contact", pull=1)

    @classmethod
    def check_machine(cls, machine: FaultTarget) -> None:
        """Raises ValueError for a board without a touch sensor."""
        _bumper(machine.board)

    def take(self) -> None:
        """Let the fault drive the pin from now on."""
        self.contact.drive(_DRIVER, 0 if self.pressed_pin else None)
        self.bumper.pin = self.contact
        self.on_end(self._back)

    @property
    def pressed_pin(self) -> bool:
        """Whether the sensor pulls the pin now."""
        return _DRIVER in self.pin.drivers()

    def _back(self) -> None:
        self.bumper.pin = self.pin
        self.put(self.contact.level == 0)

    def put(self, closed: bool) -> None:
        """Set the level of the pin."""
        self.pin.drive(_DRIVER, 0 if closed else None)

    def compare(self, _level: int = 0) -> None:
        """Report that the fault fired if the pin has another level than the contact would give."""
        if self.contact.level != self.pin.level:
            self.fired(self.data)


def _bumper(board: Board) -> TouchSensor:
    return board.only(TouchSensor, "touch sensor")


class BumperStuck(_OfBumper):
    """The switch is always pressed, or never."""

    def begin(self) -> None:
        """Begin the fault."""
        self.take()
        self.put(self.text("state") == "pressed")
        self.on_end(self.contact.changed.connect(self.compare))
        self.compare()


class Bouncing(_OfBumper):
    """The contact bounces by itself."""

    def begin(self) -> None:
        """Begin the fault."""
        self.take()
        self.repeat(self.number("rate"), self._turn)

    def _turn(self) -> None:
        self.put(not self.pressed_pin)
        self.compare()


KINDS = (
    FaultKind("bumper-stuck", "The bumper's contact is stuck.", "a touch sensor", BumperStuck,
              (FaultParameter("state", "", "how", "pressed", choices=("pressed", "released"), type=str),)),
    FaultKind("bumper-bouncing", "The bumper's contact opens and closes by itself.", "a touch sensor", Bouncing, (),
              FaultParameter("rate", "Hz", "changes, at random times", 50.0, 0.1, 10_000.0)),
)  # fmt: skip
