"""A generated function: the writer's result, with all that linking needs."""

from __future__ import annotations

from dataclasses import dataclass
from types import FunctionType
from typing import Final

from emulator.c28x.emit.names import FunctionNames
from emulator.c28x.sites import Place, Site
from emulator.c28x.tree import Where
from emulator.clock import Clock

#: How time is charged: a compiled clock is fastest called, an interpreted one where its attributes are used in place.
CALLED: Final = not isinstance(Clock.charge, FunctionType)
#: The numbers of places in a function's text begin here, so that they can be told from all others when it is linked:
#: beyond what arithmetic of 64 bits gives, and beyond what Python itself folds (128 bits).
FIRST_NUMBER: Final = 1 << 130


@dataclass(frozen=True, slots=True)
class EmittedFunction:
    """A function as Python: its text, the source line of each line, its places by number, what it refers to.

    `counted` are the statements that are counted, by counter; the first is the function itself.
    """

    text: str
    lines: tuple[int, ...]
    places: tuple[tuple[Place, Site | None], ...]
    names: FunctionNames
    counted: tuple[Where, ...] = ()
