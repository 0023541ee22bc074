"""Where the firmware is and what can be reported there: the table of its places, and the shadow call stack.

Every place that can report has a number, and so has every statement that anybody else can notice.  Generated code
stores that number in `Position.at` before the statement runs, and a function that has such statements keeps its
caller's place while it runs.  So whoever wants to know where the firmware stands (a finding, a watch, a debugger) looks
here, whether the code is interpreted or compiled.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import CType
from emulator.c28x.tree import Declaration, Where

#: For a reader, in the place of a function's name.
FILE_SCOPE: Final = "file scope"


class Place(NamedTuple):
    """A statement of the firmware: its file, line, column (0: not known) and function.

    `line` counts in `file`.  `c_file` is the C file that a Python file mirrors, for a C file its own name.
    """

    file: str
    line: int
    function: str
    c_file: str
    column: int = 0
    #: What the statement is besides a statement: "poll" for a loop that only polls, "idle" for one without an end,
    #: "takes" where it clears what the statement before has read (pass `taken`).
    kind: str = ""

    def __str__(self) -> str:
        return f"{self.function or FILE_SCOPE} ({self.file}:{self.numbers})"

    @property
    def numbers(self) -> str:
        """Line and column: `139:9`; `139` if the column is not known, or in Python, where a line is one statement."""
        return f"{self.line}:{self.column}" if self.column and not self.file.endswith(".py") else str(self.line)


@dataclass(slots=True, eq=False)
class Site:
    """One check of the generated code: its place, the object meant and its type, and what only some rules need."""

    where: Where
    ctype: CType
    name: str
    declaration: Declaration | None = None
    #: The length of the array that is subscripted.
    bound: int = 0
    #: The access as it stands in the source.
    text: str = ""
    #: Element of an array: (length, stride in words) of each subscript, the word within the innermost element.
    #: A switch: the last constant of its enumeration (`bound`) and the first (`word`).
    dimensions: tuple[tuple[int, int], ...] = ()
    word: int = 0
    #: Element of a local: the frame of its function, and the word there at which the array begins.
    frame: StackFrame | None = None
    frame_start: int = 0
    #: The unsigned subscript, if it can have wrapped.
    wraps: str = ""
    #: Arithmetic: the wider type that the result is converted to; the rule that a wrap breaks.
    widened: str = ""
    rule: str = ""
    #: "shift" or "sign": what a result out of range is about; "idle": a loop that is written without an end.
    kind: str = ""
    #: An unsigned difference of two variables.
    difference: bool = False
    #: A switch: constants of its enumeration without a case, each with its name.
    constants: tuple[tuple[int, str], ...] = ()
    #: A read of what nobody has written: the switches that lack a case if it happens.
    caseless: frozenset[Where] = frozenset()


@dataclass(frozen=True, slots=True)
class StackFrame:
    """The locals and parameters of a function on the stack: (word of the frame, object), in the order declared."""

    function: str
    objects: tuple[tuple[int, Declaration], ...]


#: What called the running function: (its place, what called that one), None at the bottom of a stack.  The tuple is
#: made anew for each call, so that it is also the identity of the call.  A third member says that the step is no call:
#: an interrupt came, or what runs from one (`INTERRUPT`).
Calls = tuple[Any, ...]
INTERRUPT: Final = "interrupt"


class Position:
    """Where one CPU is in its firmware.

    `at` is the number of the statement that executes (0: none), `calls` what called its function.
    A kernel keeps both for each thread; an interrupt, which runs on the stack of another, adds a step `INTERRUPT`.
    `who` runs: a task's name, `Idle`, `Swi:...`, `Hwi:...`, `main`, or `Isr:...` for an interrupt routine beside the
    kernel.  Whoever hands the CPU on says so here.
    """

    __slots__ = ("at", "calls", "hold", "who")

    def __init__(self) -> None:
        self.at = 0
        self.calls: Calls | None = None
        self.who = "main"
        #: Told the locals before each statement of a function, in an image linked with `CompileOptions.steps`.
        self.hold: Callable[[Mapping[str, Any]], None] | None = None

    def innermost(self) -> int:
        """The statement that executes, else the innermost one that waits for what executes; 0: there is none."""
        if self.at:
            return self.at
        for at, _ in frames(0, self.calls):
            return at
        return 0

    def within(self, call: Calls) -> bool:
        """Whether `call`, the identity of a call, has not returned: it lies under what runs now."""
        calls = self.calls
        while calls is not None:
            if calls is call:
                return True
            calls = calls[1]
        return False

    def frames(self) -> Iterator[tuple[int, Calls | None]]:
        """(place, identity of the call) of every function that runs, the innermost first; interrupts are left out."""
        return frames(self.at, self.calls)


def frames(at: int, calls: Calls | None) -> Iterator[tuple[int, Calls | None]]:
    """As `Position.frames`, of a position that was kept."""
    while True:
        if at:
            yield at, calls
        if calls is None:
            return
        at, calls = calls[0], calls[1]


def interrupted(at: int, calls: Calls | None) -> tuple[int, Calls | None]:
    """Of a position the part below its outermost interrupt: where the thread itself stands."""
    step = calls
    while step is not None:
        if len(step) > 2:
            at, calls = step[0], step[1]
        step = step[1]
    return at, calls


class Places:
    """The places of one board's firmware by number, and the checks that stand there; 0 is no place."""

    __slots__ = ("_places", "_sites")

    def __init__(self) -> None:
        self._places: list[Place] = [Place("", 0, "", "")]
        self._sites: list[Site | None] = [None]

    def __len__(self) -> int:
        return len(self._places)

    def __getitem__(self, number: int) -> Place:
        return self._places[number]

    def site(self, number: int) -> Site:
        """The check that stands at `number`.  Raises KeyError if none does."""
        site = self._sites[number]
        if site is None:
            raise KeyError(number)
        return site

    def add(self, places: Iterable[tuple[Place, Site | None]]) -> int:
        """Number further places, each with its check if it is one; gives the number of the first."""
        first = len(self._places)
        for place, site in places:
            self._places.append(place)
            self._sites.append(site)
        return first
