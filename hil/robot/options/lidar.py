"""A LiDAR: the RPLIDAR A1M8 on SCI-B.

The thesis names no part; this is a common one with a serial line and a published protocol.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import inf
from typing import Final

from emulator.devices.rplidar_a1 import RplidarA1
from hil.board import Board, Face

#: CHOICE: pins of SCI-B that no other part of the robot uses (multiplexer 6).
TX_GPIO: Final = 70
RX_GPIO: Final = 71


@dataclass(frozen=True, slots=True)
class _SetDistance:
    """A round wall, where a face was put and no world is."""

    distance_m: float

    def __call__(self, _clockwise_rad: float, _cycles: int) -> float:
        return self.distance_m


def solder(board: Board) -> RplidarA1:
    """Put it on the board."""
    device = RplidarA1(
        board.clock, board.serial_pins[TX_GPIO], board.serial_pins[RX_GPIO], rng=board.rng("lidar"), ideal=board.ideal,
        report=board.reports,
    )  # fmt: skip
    device.set_distance_source(_SetDistance(inf))
    face = Face("distance_m", "m", 0.0, inf, partial(_put, device), partial(_is_put, device))
    return board.add("lidar", device, pins={"RX": f"GPIO{TX_GPIO}", "TX": f"GPIO{RX_GPIO}"}, faces=[face])


def _put(device: RplidarA1, distance_m: float) -> None:
    device.set_distance_source(_SetDistance(distance_m))


def _is_put(device: RplidarA1) -> float | None:
    source = device.distance_source
    return source.distance_m if isinstance(source, _SetDistance) else None
