"""Every demonstration by the id of its entry, in the order of the catalogue."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from firmware_model.catalogue import CATALOGUE
from hil.audit import console, gyro, main_robot, odometry, protocol, servidores, thesis, us
from hil.audit.evidence import Evidence
from hil.audit.rig import Fixes

_PLACE: Final = {name: place for place, name in enumerate(CATALOGUE)}
_MODULES: Final = (us, gyro, odometry, protocol, servidores, main_robot, console, thesis)

#: A demonstration without an entry is a KeyError here.
DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = dict(
    sorted(
        (item for module in _MODULES for item in module.DEMONSTRATIONS.items()),
        key=lambda item: _PLACE[item[0]],
    )
)
