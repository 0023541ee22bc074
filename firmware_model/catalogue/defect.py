"""What an entry of the catalogue says about one defect of the firmware or of its analysis."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, Final

from emulator.rules import Severity


#: The section of the thesis that describes a file.
_SECTIONS: Final = {
    "us.c": "3.1.1", "GYRO.c": "3.1.2", "Odometry.c": "3.1.3", "protocol.c": "3.1.4", "servidores.c": "3.1.5",
    "main_Robot.c": "3.2", "main.py": "3.3.1",
}  # fmt: skip
_NAMED: Final = re.compile(r"TFG (?:annex )?[\dA](?:\.\d+)*")


class DefectKind(Enum):
    """What is wrong: the code, the code against the text that describes it, a figure of the text's analysis, or the
    console on the PC.
    """

    CODE = "code"
    TEXT = "text"
    FIGURE = "figure"
    CONSOLE = "console"


@dataclass(frozen=True, slots=True)
class Defect:
    """One entry.  Every sentence is ours; sources are named by section, those of ISO C as C99 numbers them.

    `severity` is that of the defect for this robot, not its rule's.  Error (grave): in ordinary operation, with nothing
    broken, the robot moves, stops or stands otherwise than ordered, hangs, or uses memory that is none of its objects,
    or what it reports is so wrong that nobody can use it.  Warning: the same under circumstances that the thesis names
    or that happen now and then (a full buffer, a broken part, an unusual order), or a measurable loss of accuracy.
    Note: it costs only time, memory or the reader.
    """

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
    kind: DefectKind = DefectKind.CODE
    #: The entry whose correction takes the function out of the image: "all corrections" is without that one here.
    gone_with: str = ""
    #: Entries whose corrections, each alone, take this defect away too: they rewrite its statement, or its circumstances
    #: do not come any more.
    covered_by: tuple[str, ...] = field(default=(), kw_only=True)
    severity: Severity = field(kw_only=True)
    #: The statement's line in the thesis' C file, or in its main.py; 0 where the text is wrong and not the code.
    line: int = field(default=0, kw_only=True)
    #: What no source says and the defect hangs on; empty: it is certain, it follows from the sources.
    depends_on: str = field(default="", kw_only=True)

    @property
    def in_firmware(self) -> bool:
        """Whether it is the firmware's, so that the firmware can be linked with its correction."""
        return self.kind in (DefectKind.CODE, DefectKind.TEXT)

    @property
    def where(self) -> str:
        """File, line and function."""
        return f"{self.c_file}{f':{self.line}' if self.line else ''}: {self.function}"

    @property
    def section(self) -> str:
        """The section of the thesis that it is about: the first that its source names, else that of its file."""
        named = _NAMED.search(self.function if self.kind is DefectKind.FIGURE else self.source)
        return named[0] if named else f"TFG {_SECTIONS[self.c_file]}"

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {
            "id": self.id, "kind": self.kind.value, "severity": self.severity.value, "c_file": self.c_file,
            "line": self.line, "section": self.section, "function": self.function, "place": self.place, "wrong": self.wrong,
            "source": self.source, "symptom": self.symptom, "rule": self.rule, "correction": self.correction,
            "covered_by": list(self.covered_by), "depends_on": self.depends_on,
        }  # fmt: skip
