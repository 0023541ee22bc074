"""Faces of parts, set from outside by a line of text: `infrared.distance_m=0.4`, `2.5:infrared.distance_m=0.1`.

A number and a colon in front is a virtual time, in seconds after start-up; without one the face has the value from
power-up on.  What is set stays until it is set again, also against a world.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from hil.board import Board
from hil.longest import LONGEST_S

FORM: Final = "expected [TIME:]PART.FACE=VALUE"
_TIMED: Final = re.compile(r"(\d+(?:\.\d*)?|\.\d+):(.*)", re.DOTALL)

#: Part, face, what it is now; None: the part does not tell.
FaceValue = tuple[str, str, float | None]


@dataclass(frozen=True, slots=True)
class FaceSetting:
    """A face that is set; `time_s` after start-up, None: from power-up on."""

    part: str
    face: str
    value: float
    time_s: float | None = None


def parse(text: str, board: Board) -> FaceSetting:
    """What a text sets of a board.

    Raises ValueError, in one line that names part, face, unit and range, for what the board does not have or the face
    cannot be.
    """
    timed = _TIMED.fullmatch(text)
    time_s, rest = (float(timed[1]), timed[2]) if timed else (None, text)
    if time_s is not None and time_s > LONGEST_S:
        raise ValueError(f"{text!r}: its time must be at most {LONGEST_S:.0f} s")
    left, equals, number = rest.partition("=")
    name, dot, face_name = left.strip().rpartition(".")
    if not (equals and dot):
        raise ValueError(f"{text!r}: {FORM}; {_offered(board)}")
    part = board.part(name)
    face = part.face(face_name)
    try:
        value = float(number)
    except ValueError:
        raise ValueError(f"{name}.{face_name} = {number!r}: must be a number; {face}") from None
    part.check(face_name, value)
    return FaceSetting(name, face_name, value, time_s)


def parse_all(texts: Iterable[str], board: Board) -> list[FaceSetting]:
    """Several of them, in their order."""
    return [parse(text, board) for text in texts]


def face_values(board: Board) -> tuple[FaceValue, ...]:
    """What each face of each part is now."""
    return tuple((part.name, face.name, part.value(face.name)) for part in board.parts.values() for face in part.faces)


def _offered(board: Board) -> str:
    faces = [f"{part.name}.{face}" for part in board.parts.values() for face in part.faces]
    return f"{type(board).__name__} has {', '.join(faces) or 'no faces'}"
