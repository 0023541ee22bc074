"""Where the firmware is, and what can be reported there: the table of places, and the shadow call stack.

Every check has a number, and so has every statement that others can notice.  Generated code stores that number in
`Position.at` before the statement runs.  A function with such statements saves the place of its caller while it runs.
Findings, watches and debuggers read the place of the firmware here, whether the code is interpreted or compiled.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

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
    #: "shift" or "sign": the cause of a result out of range; "idle": a loop that is written without an end.
    kind: str = ""
    #: The result is an unsigned difference of two variables.
    difference: bool = False
    #: A switch: the constants of its enumeration without a case, with their names.
    constants: tuple[tuple[int, str], ...] = ()
    #: A read of a value never written: the switches that have no case for the value if it happens.
    caseless: frozenset[Where] = frozenset()


@dataclass(frozen=True, slots=True)
class StackFrame:
    """The locals and parameters of a function on the stack: (word of the frame, object), in the order declared."""

    function: str
    objects: tuple[tuple[int, Declaration], ...]


#: The callers of the running function: (place of the call, callers of the caller); None at the bottom of a stack.  Each
#: call makes a new tuple, so the tuple is also the identity of the call.  A third member (`INTERRUPT`) marks a step
#: that is not a call: an interrupt, or something that runs from one.
Calls = tuple[Any, ...]
INTERRUPT: Final = "interrupt"


class Position:
    """Where one CPU is in its firmware.

    `at` is the number of the statement that executes (0: none); `calls` are the callers of its function.
    A kernel saves both for each thread.  An interrupt runs on the stack of another thread and adds a step `INTERRUPT`.
    `who` is the running thread: a task's name, `Idle`, `Swi:...`, `Hwi:...`, `main`, or `Isr:...` for an interrupt
    routine that the kernel does not manage.  The code that switches threads sets it.
    """

    __slots__ = ("at", "calls", "hold", "who")

    def __init__(self) -> None:
        self.at = 0
        self.calls: Calls | None = None
        self.who = "main"
        #: Called with the locals before each statement, in an image linked with `CompileOptions.steps`.
        self.hold: Callable[[Mapping[str, Any]], None] | None = None

    def innermost(self) -> int:
        """The statement that executes; if none does, the innermost one that was interrupted or has called; 0: none."""
        if self.at:
            return self.at
        for at, _ in frames(0, self.calls):
            return at
        return 0

    def within(self, call: Calls) -> bool:
        """Whether a call has not returned yet; `call` is its identity."""
        calls = self.calls
        while calls is not None:
            if calls is call:
                return True
            calls = calls[1]
        return False

    def frames(self) -> Iterator[tuple[int, Calls | None]]:
        """(place, identity of the call) of every active function, the innermost first, without interrupt steps."""
        return frames(self.at, self.calls)


def frames(at: int, calls: Calls | None) -> Iterator[tuple[int, Calls | None]]:
    """As `Position.frames`, for a saved position."""
    while True:
        if at:
            yield at, calls
        if calls is None:
            return
        at, calls = calls[0], calls[1]


def interrupted(at: int, calls: Calls | None) -> tuple[int, Calls | None]:
    """The part of a position below its outermost interrupt: where the interrupted thread itself is."""
    step = calls
    while step is not None:
        if len(step) > 2:
            at, calls = step[0], step[1]
        step = step[1]
    return at, calls


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

    def add(self, places: Iterable[tuple[Place, Site | None]]) -> int:
        """Number more places, each with its check, if any.  Returns the number of the first."""
        first = len(self._places)
        for place, site in places:
            self._places.append(place)
            self._sites.append(site)
        return first
