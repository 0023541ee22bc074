"""How long each C file's code takes, relative to the cost table of the translator (`emulator/c28x/passes/costs.py`).

CHOICE: the code generator's settings and the flash wait states of the original are not known, so one factor a module
brings whole tasks to the times measured on the robot (TFG figures 37 and 39).  What they consist of besides is fixed
elsewhere: conversions of 315 ns, SPI bytes of 8 us, gates of 4 us (TFG 3.4.3), `System_sprintf`.  `hil tasks` prints
what comes out, and how sure it is.
"""

from __future__ import annotations

from typing import Final

#: Full name of a module, so that a user's own `spi` is not meant -> factor on the cycles of the cost table.
CALIBRATION: Final[dict[str, float]] = {
    "firmware_model.us": 2.1,
    "firmware_model.gyro": 3.9,
    "firmware_model.board_support.spi": 3.9,
    "firmware_model.board_support.servos": 4.0,
    "firmware_model.board_support.encoder": 4.0,
    "firmware_model.board_support.pwm": 4.0,
    # Gates alone take almost all of TaskNAVIGATION's 28 us, so what is between them is short.
    "firmware_model.main_robot": 0.15,
    "firmware_model.servidores": 0.5,
}
#: The tasks that these factors were fitted to.
CALIBRATED_TASKS: Final = frozenset({"TaskUS", "TaskGYRO", "TaskNAVIGATION", "TaskSERVO", "TaskODO"})
