"""The robot's board when it is switched on: its sonars get their power with the chip, not long before."""

from typing import Any

from hil.robot.board import RobotBoard


class SwitchedOn(RobotBoard):
    """The robot's board, sonars without power until now."""

    def __init__(self, **options: Any) -> None:
        super().__init__(sonars_powered_up=False, **options)
