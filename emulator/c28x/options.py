"""The options of a translation."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import FunctionType
from typing import Final

from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.clock import Clock

#: Whether time is charged by a call: that is fastest with a compiled clock, in-line attribute access without one.
CHARGE_BY_CALL: Final = not isinstance(Clock.charge, FunctionType)


@dataclass
class CompileOptions:
    """Options of the translation."""

    #: Write locals to the stack memory at return (for the fill policy `stack`).
    residue: bool = False
    #: Keep a function's locals for tests.
    keep_locals: bool = False
    #: Call `Runtime.touch` at every load and store of an object that other threads can reach.
    watch: bool = False
    #: Count how often each statement is begun (`coverage.py`).
    coverage: bool = False
    #: Call `Position.hold`, if it is set, before each statement.
    steps: bool = False
    #: Call `Position.follow`, if it is set, with each statement before it begins, and with the locals.
    follow: bool = False
    #: Charge time by a call and not in line: faster with a compiled clock, slower without.
    charge_by_call: bool = CHARGE_BY_CALL
    #: Report what the typed tree shows without running it.
    static: bool = False
    #: Functions (`module.name`, or a pattern) that are called from outside of the image: `static` does not report them
    #: as never called, nor their parameters as unused.
    entries: frozenset[str] = frozenset()
    #: A division of floats gives the IEEE result.  (`float_division` decides only how long it takes.)
    ieee: bool = True
    #: The build that decides how long a float division takes: a name in `FLOAT_DIVISIONS`.
    float_division: str = DEFAULT_FLOAT_DIVISION
    #: Arrays (`module.function.name`) that have more elements than the source says.
    room: dict[str, int] = field(default_factory=dict)
    #: Full name of a module, or of a function in it -> factor on its cycles.
    calibration: dict[str, float] = field(default_factory=dict)
