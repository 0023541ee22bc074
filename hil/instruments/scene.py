"""What the channel `scene` tells of a robot in its world: names, and what the value of each is, in metres and radians.

    walls             [[ax, ay, bx, by], ...]
    posts             [[name, x, y, radius], ...]: everything round
    start             [x, y, heading]: where the robot was put down, so where its own frame lies
    robot, believed   [x, y, heading]: where it is, and where its firmware believes to be, both in the world's frame
    state             what its firmware calls its state
    bumper            1: something pushes it, 0
    happened          what is worth a mark: "bump"
    mount NAME        [x, y, bearing]: where a sonar sits on the robot, and looks
    sonar NAME        [measured, ray, echo]: by the firmware; the first thing straight ahead; what the sound comes back
                      from first.  null: not told, nothing there
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Any, Final


def _numbers(value: Any, count: int) -> bool:
    return isinstance(value, list) and len(value) == count and all(map(_number, value))


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and isfinite(value)


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
    return isinstance(value, list) and len(value) == 3 and all(each is None or _number(each) for each in value)


def _text(value: Any) -> bool:
    return isinstance(value, str)


#: First word of a name -> whether a value is one.
_SHAPES: Final[Mapping[str, Callable[[Any], bool]]] = {
    "walls": _walls, "posts": _posts, "start": _pose, "robot": _pose, "believed": _pose, "state": _text,
    "bumper": lambda value: value in (0, 1), "happened": _text, "mount": _pose, "sonar": _ranges,
}  # fmt: skip


def fits(name: str, value: Any) -> bool:
    """Whether a value is what the channel tells under that name."""
    shape = _SHAPES.get(name.partition(" ")[0])
    return shape is not None and shape(value)
