"""Faults of the radio between robot and PC: packets that are lost, packets that come late.

A lost packet is one of which no try arrived; the modules repeat it no more (XB, MAC retries).
"""

from __future__ import annotations

from abc import abstractmethod

from emulator.clock import CYCLES_PER_MS
from emulator.devices.xbee import XBeeLink
from hil.faults.effect import Effect, FaultTarget, MountedFault
from hil.faults.kinds import FaultKind, FaultParameter


class _OfRadio(Effect):
    """A fault of the radio channel."""

    def __init__(self, mounted: MountedFault) -> None:
        super().__init__(mounted)
        self.air = next(iter(self.board.find(XBeeLink).values())).air

    @classmethod
    def check_machine(cls, machine: FaultTarget) -> None:
        """Raises ValueError for a board without radios."""
        if not machine.board.find(XBeeLink):
            raise ValueError("this board has no radio (--xbee)")

    def begin(self) -> None:
        """Begin the fault."""
        packet = self.packet
        self.air.interferences.append(packet)
        self.on_end(lambda: self.air.interferences.remove(packet))

    @abstractmethod
    def packet(self) -> tuple[bool, int]:
        """Return whether a packet is lost, and how much later it comes."""


class PacketLoss(_OfRadio):
    """Packets are lost."""

    def packet(self) -> tuple[bool, int]:
        """Return whether a packet is lost, and how much later it comes."""
        lost = self.chosen_by_rate()
        if lost:
            self.fired()
        return lost, 0


class PacketLatency(_OfRadio):
    """Packets come late."""

    def packet(self) -> tuple[bool, int]:
        """Return whether a packet is lost, and how much later it comes."""
        if not self.chosen_by_rate():
            return False, 0
        self.fired()
        return False, round(self.number("ms") * CYCLES_PER_MS)


KINDS = (
    FaultKind("radio-loss", "Packets of the radio are lost.", "the radio (--xbee)", PacketLoss, (),
              FaultParameter("rate", "", "probability for each packet", 1.0, 0.0, 1.0)),
    FaultKind("radio-latency", "Packets of the radio come late.", "the radio (--xbee)", PacketLatency,
              (FaultParameter("ms", "ms", "how much later", 200.0, 0.0, 60_000.0),),
              FaultParameter("rate", "", "probability for each packet", 1.0, 0.0, 1.0)),
)  # fmt: skip
