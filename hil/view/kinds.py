"""The kinds of signals of the scope (a quantity with a unit, a level, words), and their names."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Final

from hil.view.checkpoints import RewindableRun
from hil.view.probes import faces_of, is_words, pin_number, soldered


class Draw(Enum):
    """How a signal is drawn."""

    LINE = "on the axis of its unit"
    SQUARE = "as a square lane"
    BYTES = "as characters of a serial line"
    WORDS = "as words of a bus"


@dataclass(frozen=True, slots=True)
class SignalKind:
    """The kind of a signal."""

    draw: Draw
    #: The unit of a signal that is drawn on an axis; empty: it is not known.
    unit: str = ""
    #: The part that is connected there: `thermometer CS`.
    part: str = ""


#: The beginning of a signal's name -> its unit.
_UNITS: Final = {"duty ": "duty", "edges ": "ticks", "ADCIN": "V"}


def kind_of(run: RewindableRun, name: str) -> SignalKind:
    """The kind of a signal, from its name, the board and its world."""
    board = run.bench.board
    part = soldered(board).get(name, "")
    if is_words(name):
        if not name.startswith("byte "):
            return SignalKind(Draw.WORDS)
        return SignalKind(Draw.BYTES, part=soldered(board).get(name.removeprefix("byte "), ""))
    if name.startswith("gate ") or pin_number(name) >= 0:
        return SignalKind(Draw.SQUARE, part=part)
    if name in (faces := faces_of(board)):
        device, face_name = faces[name]
        face = device.face(face_name)
        # Yes or no: `1 = pressed`.
        return SignalKind(Draw.SQUARE) if face.unit.startswith("1 =") else SignalKind(Draw.LINE, face.unit)
    if run.stage is not None and name in run.stage.units:
        return SignalKind(Draw.LINE, run.stage.units[name])
    if name.partition(".")[0] in board.blocks:
        return SignalKind(Draw.LINE, "digits")
    return SignalKind(Draw.LINE, next((unit for begin, unit in _UNITS.items() if name.startswith(begin)), ""), part)
