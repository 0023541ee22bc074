"""Receivers that take a new message for the rest of one that was cut off.

A receiver for characters has a state that a `switch` tests for each of them.  Within a message the characters come one
after the other.  If much more time passes there than ever before, and the state has not changed when the next one
comes, nothing looks at the time.  That alone is no defect: a character may begin a message in any state.  It is one if
the receiver does not go on as it always has after the first character of a message.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Final

from emulator.clock import CYCLES_PER_MS
from hil.drivers.followed import Ages

#: Sources that give characters.
_CHARACTERS: Final = re.compile(r"Sci\w+Regs\.")
#: So many messages show how long a receiver usually waits within one.
_MESSAGES: Final = 5
#: More time than ever before, by this factor; at least as long as this.
_LONGER: Final = 10
_LEAST: Final = CYCLES_PER_MS // 2


@dataclass(frozen=True, slots=True)
class CutMessage:
    """A receiver went on in the middle of a message: in which state, after which time, and the longest time before."""

    source: str
    state: int
    pause: int
    longest: int


@dataclass(slots=True)
class ReceiverState:
    """What one `switch` does with the characters of a source."""

    #: The state between messages: the one at the first character.
    idle: int
    last: int
    #: The longest time to a character within a message; how many messages began.
    longest: int = 0
    messages: int = 1
    #: States after the first character of a message.
    begun: set[int] = field(default_factory=set)
    #: The character before was the first of a message.
    first: bool = True
    #: It came much too late for the state.
    late: CutMessage | None = None

    def take(self, source: str, state: int, came: int) -> CutMessage | None:
        """The next character meets a state.  Returns what shows now to have been wrong with the one before."""
        pause, self.last = came - self.last, came
        late, self.late = self.late, None
        wrong = late if late is not None and self.messages >= _MESSAGES and state not in self.begun else None
        if self.first:
            self.begun.add(state)
        self.first = False
        if state == self.idle:
            self.first = pause > _LONGER * max(self.longest, _LEAST)
            self.messages += self.first
        elif self.messages < _MESSAGES or pause < _LONGER * max(self.longest, _LEAST):
            self.longest = max(self.longest, pause)
        else:
            self.late = CutMessage(source, state, pause, self.longest)
        return wrong


class Receivers:
    """The receivers of one program, by the identity of their `switch`."""

    def __init__(self) -> None:
        self._known: dict[int, ReceiverState] = {}

    def take(self, switch: int, state: object, given: Ages) -> CutMessage | None:
        """A `switch` meets a state; `given` are the ages of what its function works with."""
        newest = max(given.items(), key=lambda item: item[1], default=("", 0))
        if not isinstance(state, int) or not _CHARACTERS.match(newest[0]):
            return None
        known = self._known.get(switch)
        if known is None:
            self._known[switch] = ReceiverState(state, newest[1])
            return None
        return known.take(newest[0], state, newest[1]) if newest[1] > known.last else None
