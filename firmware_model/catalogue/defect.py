"""What an entry of the catalogue says about one defect of the firmware or of its analysis."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Kind(Enum):
    """What is wrong: the code, the code against the text that describes it, or a figure of the text's analysis."""

    CODE = "code"
    TEXT = "text"
    FIGURE = "figure"


@dataclass(frozen=True, slots=True)
class Defect:
    """One entry.  Every sentence is ours; sources are named by section."""

    #: Never changes: the C file in capitals, and what it is about: `US-accumulator`.
    id: str
    c_file: str
    #: The function, or the object at file scope, or the section of the text.
    function: str
    #: Which statement, in a few words.
    place: str
    #: What is wrong, with numbers and units.
    wrong: str
    #: What makes it wrong: rule of C, data sheet and table, section of the thesis (TFG), or arithmetic.
    source: str
    #: What a user of the robot sees.
    symptom: str
    #: The rule (`emulator.rules`) that the demonstration fails by: a detector, or a property.
    rule: str
    #: What the correction does instead; for a figure, the right figure and how it follows.
    correction: str
    kind: Kind = Kind.CODE
    #: The entry whose correction takes the function out of the image: "all corrections" is without that one here.
    gone_with: str = ""
