"""Size, mass and friction of the robot, and what a pose is.

Sources
    TFG annex 1 main_Robot.c (wheel radius 0.027 m, track 0.13 m); everything else is a CHOICE and said so.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from random import Random
from typing import NamedTuple


class Pose(NamedTuple):
    """Middle between the wheels; heading counter-clockwise from +x, not wrapped."""

    x_m: float
    y_m: float
    heading_rad: float


@dataclass(frozen=True, slots=True)
class RobotParams:
    """Radius and track are the firmware's; everything else is a CHOICE for a LEGO robot of about this size."""

    wheel_radius_m: float = 0.027
    track_m: float = 0.13
    mass_kg: float = 0.75
    yaw_inertia_kg_m2: float = 0.004
    #: Share of the weight on the two driven wheels; a caster carries the rest.
    driven_share: float = 0.8
    tyre_friction: float = 0.8
    rolling_resistance: float = 0.02
    body_radius_m: float = 0.095
    #: The body's middle lies this far ahead of the axle.
    body_ahead_m: float = 0.025
    wall_friction: float = 0.2
    #: The bumper, as wide as the track, covers this much to each side of straight ahead, from the middle of the body.
    bumper_half_angle_deg: float = 45.0
    #: Pressed when nothing is left of the way to the obstacle, released when this much is.
    bumper_travel_m: float = 0.002
    #: Lasting slip of the wheels, as a fraction of the rolled way.
    slip_left: float = 0.0
    slip_right: float = 0.0

    def individual(self, random: Random) -> RobotParams:
        """One robot out of many: wheels that lose up to 1 % of their way, differing by up to 0.3 %."""
        common = random.uniform(0.0, 0.01)
        return replace(
            self,
            slip_left=common + random.uniform(-0.0015, 0.0015),
            slip_right=common + random.uniform(-0.0015, 0.0015),
            tyre_friction=self.tyre_friction * random.uniform(0.8, 1.0),
        )
