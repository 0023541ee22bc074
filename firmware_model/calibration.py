"""How long each C file's code takes, relative to the cost table of the translator (`emulator/c28x/passes/costs.py`).

CHOICE: the code generator's settings and the flash wait states of the original are not known, so factors bring whole
tasks to the times measured on the robot (TFG figures 37 and 39).  Three are the fewest with which every task keeps to
those figures, and they predict a task that is left out of the fit better than one factor a task does: the table in
`hil/README.md`, `python -m tests.calibration`.  What the tasks consist of besides is fixed elsewhere: conversions of
315 ns, SPI bytes of 8 us, gates of 4 us (TFG 3.4.3), `System_sprintf`.  `hil tasks` prints what comes out, and how sure
it is.
"""

from __future__ import annotations

from typing import Final

#: By TaskUS.
_US: Final = 2.1
#: Code that works on registers, by TaskGYRO and TaskSERVO.
_GYRO_AND_WHEELS: Final = 4.0
#: What all tasks share, by TaskNAVIGATION: gates alone take almost all of its 28 us, so what is between them is short.
_SHARED: Final = 0.3
#: Full name of a module, so that a user's own `spi` is not meant -> factor on the cycles of the cost table.
CALIBRATION: Final[dict[str, float]] = {
    "firmware_model.us": _US,
    "firmware_model.gyro": _GYRO_AND_WHEELS,
    "firmware_model.board_support.spi": _GYRO_AND_WHEELS,
    "firmware_model.board_support.servos": _GYRO_AND_WHEELS,
    "firmware_model.board_support.encoder": _GYRO_AND_WHEELS,
    "firmware_model.board_support.pwm": _GYRO_AND_WHEELS,
    "firmware_model.main_robot": _SHARED,
    "firmware_model.servidores": _SHARED,
}
#: The tasks that these factors were fitted to.
CALIBRATED_TASKS: Final = frozenset({"TaskUS", "TaskGYRO", "TaskNAVIGATION", "TaskSERVO", "TaskODO"})
