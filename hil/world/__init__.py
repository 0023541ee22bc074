"""The plane world: walls, a differential-drive robot, what its sonars see.  See README.md."""

import emulator as emulator  # first: it decides whether modules of the world come compiled, too
from hil.world.maps import MapError, WorldMap, builtin_maps, load_map
from hil.world.robot_params import Pose, RobotParams
from hil.world.sonar_rays import SonarMount, SonarRays
from hil.world.world import World

__all__ = [
    "MapError",
    "Pose",
    "RobotParams",
    "SonarMount",
    "SonarRays",
    "World",
    "WorldMap",
    "builtin_maps",
    "load_map",
]
