"""How the options stand in the world: where they sit on the robot, and what they see or feel of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, sin
from typing import Final

from emulator.clock import SYSCLK_HZ
from emulator.devices.lis3dh import GRAVITY_M_S2
from hil.robot.options.five_sonars import DIAGONALS
from hil.robot.options.names import FIVE_SONARS
from hil.world.geometry import cast
from hil.world.sonar_rays import DEFAULT_MOUNTS, SonarMount
from hil.world.world import World

DIAGONAL_MOUNTS: Final[Mapping[str, SonarMount]] = {
    name: SonarMount(one.x_m, one.y_m, one.bearing_rad) for name, one in DIAGONALS.items()
}
#: CHOICE: the LiDAR is above the middle of the body, high enough to see over the sonars; its 0 is straight ahead.
LIDAR_AHEAD_M: Final = 0.025


def sonar_mounts(options: Sequence[str]) -> Mapping[str, SonarMount]:
    """The sonars of a robot with these options."""
    return {**DEFAULT_MOUNTS, **DIAGONAL_MOUNTS} if FIVE_SONARS in options else DEFAULT_MOUNTS


class AccelerometerMotion:
    """What an accelerometer over the middle of the axle feels: the means since it was asked last, in m/s2.

    Ahead it is the change of speed, to the left speed times yaw rate (no wheel slips sideways), up the weight.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._cycles = -1
        self._last = (0.0, 0.0)

    def __call__(self, cycles: int) -> tuple[float, float, float]:
        """Along x, y and z."""
        world = self._world
        world.sync(cycles)
        robot = world.robot
        speed, sideways = robot.v_m_s, robot.v_m_s * robot.w_rad_s
        (before, sideways_before), since = self._last, cycles - self._cycles
        known = self._cycles >= 0 and since > 0
        self._cycles, self._last = cycles, (speed, sideways)
        if not known:
            return 0.0, sideways, GRAVITY_M_S2
        return (speed - before) * SYSCLK_HZ / since, 0.5 * (sideways + sideways_before), GRAVITY_M_S2


class LidarView:
    """What a LiDAR sees: walls and obstacles, all of them high enough."""

    def __init__(self, world: World) -> None:
        self._world = world

    def __call__(self, clockwise_rad: float, cycles: int) -> float:
        """How far it is in a direction, in metres."""
        world = self._world
        world.sync(cycles)
        x, y, heading = world.pose
        x += LIDAR_AHEAD_M * cos(heading)
        y += LIDAR_AHEAD_M * sin(heading)
        look = heading - clockwise_rad
        return cast(x, y, cos(look), sin(look), world.map.walls, world.posts)[0]
