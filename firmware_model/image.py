"""The robot's firmware, linked: the modules of this package, or the C files that stand for them.

    fw = link(board)
    fw.us.Read_Distance(fw.us.US_SENSOR.LEFT)      # a function of us.c, in cm
    fw.gyro.Z_dc_offset                            # a file-scope object of GYRO.c
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

from emulator import image
from emulator.image import Firmware
from emulator.system import System
from firmware_model import c_files
from firmware_model.calibration import CALIBRATION
from firmware_model.corrections import overlays, resolve

#: The C files of the robot, in link order.
MODULES: Final = (
    "firmware_model.robot_types", "firmware_model.us", "firmware_model.gyro", "firmware_model.odometry",
    "firmware_model.protocol", "firmware_model.servidores", "firmware_model.main_robot",
)  # fmt: skip
#: What else a correction may touch.
_CORRECTABLE: Final = (*MODULES, *(f"firmware_model.board_support.{n}" for n in ("xbee", "servos", "spi", "encoder")))


def link(
    system: System, *, modules: Iterable[str] = MODULES, fixes: Iterable[str] = (),
    firmware: Iterable[str | Path] = (), calibration: Mapping[str, float] = CALIBRATION, **options: Any,
) -> Firmware:  # fmt: skip
    """Link the robot's modules to `system`, as `emulator.image.link` does with its `options`.

    `fixes` names corrections of the catalogue to link in, or `all`.  `firmware` names the robot's own C files, or
    folders with them: each takes the place of the module that mirrors it.  Raises ValueError.
    """
    modules, own = tuple(modules), c_files.own(firmware)
    corrections, chosen = overlays(_CORRECTABLE), resolve(fixes)
    own.refuse_corrections(corrections, chosen)
    asked: dict[str, Any] = {"overlays": corrections, "fixes": chosen}
    if own.files or any(name.lower().endswith(".c") for name in modules):
        asked |= own.arguments()
    return image.link(
        system, (*modules, *own.besides), asked=asked, calibration=calibration,
        **options,
    )  # fmt: skip
