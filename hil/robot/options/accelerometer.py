"""An accelerometer: the LIS3DH, of the maker and the register layout of the robot's gyro, on the gyro's bus.

The thesis names no part.  CHOICE: it lies over the middle of the axle as the gyro does, x ahead, y to the left, z up.
"""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.devices.lis3dh import GRAVITY_M_S2, Lis3dh
from hil.board import Board, Face

#: CHOICE: SPI-A with the gyro, and a chip select of its own, pulled up.
BUS: Final = "A"
CS_GPIO: Final = 64


class _SetAcceleration:
    """What it feels where faces were put, and no world moves it: at rest, until they are."""

    def __init__(self) -> None:
        self.felt_m_s2 = [0.0, 0.0, GRAVITY_M_S2]

    def __call__(self, _cycles: int) -> tuple[float, float, float]:
        x, y, z = self.felt_m_s2
        return x, y, z


def solder(board: Board) -> Lis3dh:
    """Put it on the board."""
    device = Lis3dh(board.clock, rng=board.rng("accelerometer"), ideal=board.ideal, report=board.reports)
    device.set_motion_source(_SetAcceleration())
    board.pins[CS_GPIO].set_pull(1)
    faces = [
        Face(f"{axis}_m_s2", "m/s2", -200.0, 200.0, partial(_put, device, index), partial(_is_put, device, index))
        for index, axis in enumerate("xyz")
    ]
    return board.on_spi("accelerometer", device, bus=BUS, select=CS_GPIO, faces=faces)


def _put(device: Lis3dh, axis: int, value_m_s2: float) -> None:
    source = device.motion_source
    if not isinstance(source, _SetAcceleration):
        source = _SetAcceleration()
        device.set_motion_source(source)
    source.felt_m_s2[axis] = value_m_s2


def _is_put(device: Lis3dh, axis: int) -> float | None:
    source = device.motion_source
    return source.felt_m_s2[axis] if isinstance(source, _SetAcceleration) else None
