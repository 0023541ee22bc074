"""The table of places: the statements of the firmware, and what can be reported there.

Every check has a number, and so has every statement that others can notice.  `position.py` says at which the firmware
is.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final, NamedTuple

from emulator.c28x.ctypes import CType
from emulator.c28x.tree import Declaration, Where

#: The text shown in place of a function name.
FILE_SCOPE: Final = "file scope"


class Place(NamedTuple):
    """A statement of the firmware: its file, line, column (0: not known) and function.

    `line` is a line of `file`.  `c_file` is the C file that a Python file mirrors; for a C file, its own name.
    """

    file: str
    line: int
    function: str
    c_file: str
    column: int = 0
    #: The kind of a special statement: "poll" for a loop that only polls, "idle" for an empty loop without an end,
    #: "takes" for a statement that clears what a statement just before has read (pass `taken`).
    kind: str = ""

    def __str__(self) -> str:
        return f"{self.function or FILE_SCOPE} ({self.file}:{self.numbers})"

    @property
    def numbers(self) -> str:
        """Line and column: `139:9`; `139` if the column is not known, and in Python (one statement per line)."""
        return f"{self.line}:{self.column}" if self.column and not self.file.endswith(".py") else str(self.line)


@dataclass(slots=True, eq=False)
class Site:
    """One check of the generated code: its place, its object and type, and data that only some rules need."""

    where: Where
    ctype: CType
    name: str
    declaration: Declaration | None = None
    #: The length of the subscripted array.
    bound: int = 0
    #: The source text of the access.
    text: str = ""
    #: An array element: (length, stride in words) of each subscript; `word` is the word within the innermost element.
    #: A switch: `bound` is the last constant of its enumeration, `word` the first.
    #: An OR of fields: the pairs of terms that may meet.
    dimensions: tuple[tuple[int, int], ...] = ()
    word: int = 0
    #: An element of a local: the frame of its function, and the word of the frame at which the array begins.
    frame: StackFrame | None = None
    frame_start: int = 0
    #: The text of an unsigned subscript that may have wrapped.
    wraps: str = ""
    #: Arithmetic: the wider type that the result is converted to; the rule that a wrap violates.
    widened: str = ""
    rule: str = ""
    #: "shift" or "sign": the cause of a result out of range; "small": only a small negative number counts; "idle": a
    #: loop that is written without an end.  A read of a value never written: "static" if the object is not a local.
    kind: str = ""
    #: The result is an unsigned difference of two variables.
    difference: bool = False
    #: A switch: the constants of its enumeration without a case, with their names.  An OR of fields: the shift of each
    #: term, with its text.
    constants: tuple[tuple[int, str], ...] = ()
    #: A read of a value never written: the switches that have no case for the value if it happens.
    caseless: frozenset[Where] = frozenset()
    #: A part of a regulator: its name; the factor of an integral's share; the sides where nothing limits the integral.
    regulator: str = ""
    scale: float = 1.0
    side: str = ""


@dataclass(frozen=True, slots=True)
class StackFrame:
    """The locals and parameters of a function on the stack: (word of the frame, object), in the order declared."""

    function: str
    objects: tuple[tuple[int, Declaration], ...]


#: Between the first places of two source files lies a multiple of this: a file that changes mostly leaves the others
#: their numbers, and what was compiled with them (`hil build`).
FILE_STEP: Final = 1024


def first_of_file(free: int) -> int:
    """The number of a file's first place; `free` is the first number that is not used."""
    return free + (1 - free) % FILE_STEP


class Places:
    """The places of one board's firmware by number, and their checks; 0 is not a place."""

    __slots__ = ("_places", "_sites")

    def __init__(self) -> None:
        self._places: list[Place] = [Place("", 0, "", "")]
        self._sites: list[Site | None] = [None]

    def __len__(self) -> int:
        return len(self._places)

    def __getitem__(self, number: int) -> Place:
        return self._places[number]

    def site(self, number: int) -> Site:
        """The check with this number.  Raises KeyError if there is none."""
        site = self._sites[number]
        if site is None:
            raise KeyError(number)
        return site

    def skip_to(self, number: int) -> None:
        """Have the next place get `number`; those before it stay free."""
        free = number - len(self._places)
        self._places += self._places[:1] * free
        self._sites += [None] * free

    def add(self, places: Iterable[tuple[Place, Site | None]]) -> int:
        """Number more places, each with its check, if any.  Returns the number of the first."""
        first = len(self._places)
        for place, site in places:
            self._places.append(place)
            self._sites.append(site)
        return first
