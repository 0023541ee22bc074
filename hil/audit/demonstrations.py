"""Every demonstration by the id of its entry, in the order of the catalogue."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from hil.audit import gyro, main_robot, odometry, protocol, servidores, thesis, us
from hil.audit.evidence import Evidence
from hil.audit.rig import Fixes

DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    name: demonstration
    for module in (us, gyro, odometry, protocol, servidores, main_robot, thesis)
    for name, demonstration in module.DEMONSTRATIONS.items()
}
