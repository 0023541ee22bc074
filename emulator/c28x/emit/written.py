"""A generated function: the result of the writer, with all that the linker needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from emulator.c28x.emit.names import FunctionNames
from emulator.c28x.sites import Place, Site
from emulator.c28x.tree import Where

#: Places in a function's text are numbered from here, so that the linker can tell them from all other numbers: 64-bit
#: arithmetic does not reach them, nor does constant folding in Python (128 bits).
FIRST_NUMBER: Final = 1 << 130


@dataclass(frozen=True, slots=True)
class EmittedFunction:
    """A function as Python: its text, the source line of each line, its places by number, the names that it refers to.

    `counted` are the places of the counted statements, by counter; the first is that of the function itself.
    """

    text: str
    lines: tuple[int, ...]
    places: tuple[tuple[Place, Site | None], ...]
    names: FunctionNames
    counted: tuple[Where, ...] = ()
