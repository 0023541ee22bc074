"""How long dividing two floats takes: it depends on how the C was built.

What a division gives is another matter (`arithmetic.DIVIDERS`): each of the two can be chosen without the other.

Sources: SPRUHS1 (TMU: DIVF32); SPRU514, `--fp_mode` and `--tmu_support` (relaxed: hardware division where there is a
TMU, a constant divisor becomes a multiplication); cycles of the two divisions in software counted in binaries.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final


@dataclass(frozen=True)
class FloatDivision:
    """Cycles of a division, besides those of what is divided."""

    cycles: int
    #: By a constant the compiler multiplies.
    constant_multiplies: bool = False


#: The name of a build -> its division.
FLOAT_DIVISIONS: Final[Mapping[str, FloatDivision]] = MappingProxyType({
    # CHOICE: nothing tells how the robot's firmware was built.  With this price, between those of a fast build and of
    # a standard one, its factors were fitted.
    "calibrated": FloatDivision(60),
    # `--tmu_support=tmu0 --fp_mode=relaxed`: one instruction, DIVF32.
    "tmu": FloatDivision(5, constant_multiplies=True),
    # `--fp_mode=relaxed` without TMU.  CHOICE: what TI's fast library does (EINVF32, two Newton-Raphson steps), but
    # in line, without its call.
    "fast": FloatDivision(23, constant_multiplies=True),
    # `--fp_mode=strict`, the compiler's default: a call (LCR, 4 cycles) of FS$$DIV, 217 with its return.  CHOICE: what
    # was counted could not be confirmed to be this function, so the number is uncertain.
    "standard": FloatDivision(4 + 217),
})  # fmt: skip
#: What it is if nobody says.
DEFAULT_FLOAT_DIVISION: Final = "calibrated"


def float_division(build: str) -> FloatDivision:
    """The division of a build.  Raises ValueError for a name that is none."""
    known = FLOAT_DIVISIONS.get(build)
    if known is None:
        raise ValueError(f"float division {build!r}: one of {', '.join(FLOAT_DIVISIONS)}")
    return known
