"""Faults of wheels: edges that are lost, phases that are swapped, a wheel that slips or blocks.

CHOICE: a lost edge is that of a dirty slit: the count is one less, the direction stays.  Swapped phases count
backwards.  A slipping wheel loses a part of its distance.  A blocked wheel is held by more torque than its motor has
(NXT: stall 0.5 N.m).
"""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, Final

from emulator.devices.nxt_motor import NxtMotor
from emulator.registers.cell import Cell
from emulator.signals import QuadratureWire
from hil.faults.effect import Effect, FaultTarget, MountedFault
from hil.faults.kinds import FaultKind, FaultParameter

_SIDE: Final = FaultParameter("side", "", "which wheel", "left", choices=("left", "right"), type=str)
_HOLD_NM: Final = 5.0


class _OfWheel(Effect):
    """A fault of a wheel."""

    def __init__(self, mounted: MountedFault) -> None:
        super().__init__(mounted)
        name = f"{self.text('side')} motor"
        motor = self.board.find(NxtMotor).get(name)
        if motor is None:
            raise ValueError(f"this board has no {name}")
        self.motor = motor
        gpio = int(self.board.part(name).pins["A"].removeprefix("GPIO"))
        module = self.module_at(gpio, ("EQEP1A", "EQEP2A", "EQEP3A"))
        #: Where its count comes into the firmware.
        self.counts: list[Cell] = []
        if module is not None:
            registers = self.board.blocks[f"EQep{module[4]}Regs"].registers
            self.counts = [registers[each] for each in ("QPOSCNT", "QPOSLAT", "QPOSILAT", "QPOSSLAT")]

    @classmethod
    def check_machine(cls, machine: FaultTarget) -> None:
        """Raises ValueError for a board without wheels."""
        if not machine.board.find(NxtMotor):
            raise ValueError("this board has no motor with an encoder")


class _OfEdges(_OfWheel):
    """A fault of the wire between shaft and pins."""

    def begin(self) -> None:
        """Begin the fault: the shaft's edges go through `edges` until its end."""
        pins = self.motor.encoder
        shaft = QuadratureWire(f"{pins.name} at the shaft")
        shaft.moved.connect(lambda edges, start, end: pins.move(self.edges(edges), start, end))
        self.motor.encoder = shaft
        self.on_end(lambda: setattr(self.motor, "encoder", pins))

    @abstractmethod
    def edges(self, edges: int) -> int:
        """Return the edges in place of those of a movement."""


class EdgeLost(_OfEdges):
    """Some edges are lost."""

    def edges(self, edges: int) -> int:
        """Return the edges in place of those of a movement."""
        left = 0
        for _ in range(abs(edges)):
            if self.chosen_by_rate():
                self.fired(*self.counts)
            else:
                left += 1
        return left if edges > 0 else -left


class PhasesSwapped(_OfEdges):
    """The phases A and B are swapped."""

    def edges(self, edges: int) -> int:
        """Return the edges in place of those of a movement."""
        self.fired(*self.counts)
        return -edges


class _WheelOnFloorFault(_OfWheel):
    """A fault of a wheel that rolls on the floor of a world."""

    def __init__(self, mounted: MountedFault) -> None:
        super().__init__(mounted)
        self.world: Any = getattr(self.machine, "world", None)

    @classmethod
    def check_machine(cls, machine: FaultTarget) -> None:
        """Raise ValueError for a board that is in no world."""
        super().check_machine(machine)
        if getattr(machine, "world", None) is None:
            raise ValueError("this board is in no world")

    def hamper(self, **how: float) -> None:
        """Hamper the wheel from now on, until the end of the fault."""
        self.world.sync_now()
        self.world.robot.hamper(**how)
        self.on_end(self._free)

    def _free(self) -> None:
        self.world.sync_now()
        self.world.robot.hamper()

    def moved(self, _edges: int, _start: int, _end: int) -> None:
        """Report that the fault fired: the wheel has turned."""
        self.fired(*self.counts)


class WheelSlips(_WheelOnFloorFault):
    """The wheel turns more than it rolls."""

    def begin(self) -> None:
        """Begin the fault."""
        self.hamper(**{f"slip_{self.text('side')}": self.number("percent") / 100.0})
        self.on_end(self.motor.encoder.moved.connect(self.moved))


class WheelBlocked(_WheelOnFloorFault):
    """The wheel cannot turn."""

    def begin(self) -> None:
        """Begin the fault."""
        self.hamper(**{f"hold_{self.text('side')}_nm": _HOLD_NM})
        bridge = self.motor.bridge
        for wire in (bridge.in1, bridge.in2):
            self.on_end(wire.duty_changed.connect(self._driven))
        self._driven()

    def _driven(self) -> None:
        """Report that the fault fired when the motor is driven: a blocked wheel shows only then."""
        if self.motor.bridge.in1.duty != self.motor.bridge.in2.duty:
            self.fired(*self.counts)


KINDS = (
    FaultKind("encoder-edge-lost", "Edges of an encoder are lost.", "a motor with encoder", EdgeLost, (_SIDE,),
              FaultParameter("rate", "", "probability for each edge", 0.05, 0.0, 1.0)),
    FaultKind("encoder-phases-swapped", "A and B of an encoder are swapped: it counts backwards.",
              "a motor with encoder", PhasesSwapped, (_SIDE,)),
    FaultKind("wheel-slips", "A wheel slips and loses a part of its distance.", "a robot in its world", WheelSlips,
              (_SIDE, FaultParameter("percent", "%", "of its way", 30.0, 0.0, 99.0))),
    FaultKind("wheel-blocked", "A wheel cannot turn.", "a robot in its world", WheelBlocked, (_SIDE,)),
)  # fmt: skip
