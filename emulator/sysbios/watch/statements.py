"""Where the firmware stands: the statement that runs, and the statement at which a suspended task waits.

A statement is kept as its number (`emulator.c28x.sites`), 0 if there is none.  A number is cheap to keep and to
compare.  It becomes a `Place` only when a finding needs it.
"""

from __future__ import annotations

from emulator.c28x.findings import Findings
from emulator.c28x.position import INTERRUPT, Calls, interrupted
from emulator.c28x.sites import Place
from emulator.sysbios.scheduler import Task

#: The number of a statement; 0: none.
StatementNumber = int
#: The identity of a call (`emulator.c28x.sites.Calls`).
Call = Calls
#: A function of the firmware: its file and name.
Function = tuple[str, str]


class StatementLocator:
    """Finds the running statements, and translates their numbers."""

    def __init__(self, findings: Findings) -> None:
        self._position = findings.position
        self._places = findings.places

    def place(self, statement: StatementNumber) -> Place | None:
        """The place of a statement, for a finding; None for 0."""
        return self._places[statement] if statement else None

    def takes(self, statement: StatementNumber) -> bool:
        """Whether the statement clears an object that a statement just before it has read."""
        return self._places[statement].kind == "takes"

    def text(self, statement: StatementNumber) -> str:
        """The place of a statement as text, for a sentence."""
        return str(self._places[statement]) if statement else "no statement of the firmware"

    def function(self, statement: StatementNumber) -> Function:
        """The function in which a statement stands."""
        place = self._places[statement]
        return place.file, place.function

    def here(self) -> StatementNumber:
        """The innermost firmware statement that is executing."""
        position = self._position
        return position.at or position.innermost()

    def frames(self) -> list[Place]:
        """Where each function stands that is executing, innermost first."""
        return [self._places[statement] for statement, _ in self._position.frames()]

    def call(self) -> Call | None:
        """The identity of the innermost firmware call that is executing."""
        position = self._position
        return position.calls if position.at else next((calls for _, calls in position.frames()), None)

    def outermost_call(self) -> Call | None:
        """The identity of the call with which the code that runs now began: of a task's function, or of a routine."""
        calls, outermost = self._position.calls, None
        while calls is not None and len(calls) == 2:
            calls, outermost = calls[1], calls
        return outermost

    def running(self, call: Call) -> bool:
        """Whether a call has not returned: it is on the call stack of the code that runs now."""
        return self._position.within(call)

    def of(self, task: Task, current: Task | None) -> StatementNumber:
        """The statement at which `task` was interrupted or suspended.  0 before its first statement."""
        position = self._position if task is current else task
        return interrupted(position.at, position.calls)[0]

    def sample(self) -> tuple[StatementNumber, bool, Call | None] | None:
        """The statement that a just taken interrupt has interrupted, whether the statement only polls, and its call.

        None if no firmware was interrupted: the idle loop, or an interrupt that has not reached its first statement.
        """
        calls = self._position.calls
        while calls is not None and len(calls) == 2:
            calls = calls[1]
        if calls is None:
            return None
        assert calls[2] is INTERRUPT
        statement, call = calls[0], calls[1]
        return (statement, self._places[statement].kind in ("poll", "idle"), call) if statement else None
