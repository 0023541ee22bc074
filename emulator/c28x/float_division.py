"""The time of a float division.  It depends on how the C was built.

The result of a division is a separate choice (`arithmetic.DIVIDERS`).

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
    """The cycles of a division, without those of its operands."""

    cycles: int
    #: The compiler turns a division by a constant into a multiplication.
    constant_multiplies: bool = False


#: The name of a build -> its division.
FLOAT_DIVISIONS: Final[Mapping[str, FloatDivision]] = MappingProxyType({
    # CHOICE: it is not known how the robot's firmware was built.  Its calibration factors were fitted with this time,
    # which lies between that of a fast build and that of a standard build.
    "calibrated": FloatDivision(60),
    # `--tmu_support=tmu0 --fp_mode=relaxed`: one instruction, DIVF32.
    "tmu": FloatDivision(5, constant_multiplies=True),
    # `--fp_mode=relaxed` without TMU.  CHOICE: the code of TI's fast library (EINVF32, two Newton-Raphson steps), but
    # inlined, without its call.
    "fast": FloatDivision(23, constant_multiplies=True),
    # `--fp_mode=strict`, the compiler's default: a call (LCR, 4 cycles) of FS$$DIV, 217 with its return.  CHOICE: what
    # was counted could not be confirmed to be this function, so the number is uncertain.
    "standard": FloatDivision(4 + 217),
})  # fmt: skip
#: The default build.
DEFAULT_FLOAT_DIVISION: Final = "calibrated"


def float_division(build: str) -> FloatDivision:
    """The division of a build.  Raises ValueError for an unknown build."""
    known = FLOAT_DIVISIONS.get(build)
    if known is None:
        raise ValueError(f"float division {build!r}: one of {', '.join(FLOAT_DIVISIONS)}")
    return known
