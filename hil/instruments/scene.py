"""The events of the channel `scene`, about a robot in its world: their names and values, in metres and radians.

    walls             [[ax, ay, bx, by], ...]
    posts             [[name, x, y, radius], ...]: everything round
    start             [x, y, heading]: the pose at the start, which is the origin of the robot's own frame
    robot, believed   [x, y, heading]: the true pose, and the odometry of the firmware, both in the world's frame
    state             the name of the state in the firmware
    bumper            1 while something presses the bumper, else 0
    happened          an event that gets a mark: "bump"
    mount NAME        [x, y, bearing]: the place and direction of a sonar on the robot
    sonar NAME        [measured, ray, echo]: the distance that the firmware measured; the distance to the first object
                      straight ahead; the distance to the object that returns the first echo.  null: there is none
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final


def _numbers(value: Any, count: int) -> bool:
    return isinstance(value, list) and len(value) == count and all(map(is_number, value))


def is_number(value: Any) -> bool:
    """Whether it is a number that a length or an angle can have: none has 20 digits, or is infinite."""
    return isinstance(value, int | float) and abs(value) < 2.0**64


def _pose(value: Any) -> bool:
    return _numbers(value, 3)


def _walls(value: Any) -> bool:
    return isinstance(value, list) and all(_numbers(wall, 4) for wall in value)


def _posts(value: Any) -> bool:
    return isinstance(value, list) and all(
        isinstance(post, list) and len(post) == 4 and isinstance(post[0], str) and _numbers(post[1:], 3)
        for post in value
    )


def _ranges(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(each is None or is_number(each) for each in value)


def _text(value: Any) -> bool:
    return isinstance(value, str)


#: The first word of a name -> a function that checks its value.
_SHAPES: Final[Mapping[str, Callable[[Any], bool]]] = {
    "walls": _walls, "posts": _posts, "start": _pose, "robot": _pose, "believed": _pose, "state": _text,
    "bumper": lambda value: value in (0, 1), "happened": _text, "mount": _pose, "sonar": _ranges,
}  # fmt: skip


def fits(name: str, value: Any) -> bool:
    """Whether a value is valid for that name of the channel."""
    shape = _SHAPES.get(name.partition(" ")[0])
    return shape is not None and shape(value)
