"""The catalogue: every known defect of this firmware, one module a C file, and of its console.  Data only.

What demonstrates an entry stands in `hil/audit`, what corrects it in `firmware_model/corrections`, both by its id.
"""

from __future__ import annotations

from typing import Final

from firmware_model.catalogue.defect import Defect, DefectKind
from firmware_model.catalogue import console, gyro, main_robot, odometry, protocol, servidores, thesis, us

__all__ = ["CATALOGUE", "Defect", "DefectKind"]

#: In the order of the files, then of the lines.
CATALOGUE: Final[dict[str, Defect]] = {
    defect.id: defect
    for module in (us, gyro, odometry, protocol, servidores, main_robot, console, thesis)
    for defect in module.DEFECTS
}
