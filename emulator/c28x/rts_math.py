"""`math.h` of the run-time support library: functions of `float`, and (with an `l`) of `long double`.

Results are correctly rounded (CHOICE: the library's own last bit is not published).  Cycles are CHOICE, in the order of
magnitude of the FPU library.  A NaN or an infinity that a function returns for finite arguments is reported.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

from emulator.c28x.arithmetic import f32
from emulator.c28x.runtime import Runtime

#: How many times as long a function takes in 64 bits.
_SOFTWARE: Final = 10


class Mathematics:
    """Functions of real numbers; `wide`: of `long double`, not of `float`."""

    def __init__(self, runtime: Runtime, *, wide: bool = False) -> None:
        self._runtime = runtime
        self._wide = wide

    def _charge(self, cycles: int) -> None:
        self._runtime.clock.charge(cycles)

    def _value(self, cycles: int, function: Callable[..., float], *arguments: float) -> float:
        """The value of `function`, which takes so many cycles in 32 bits.

        It is NaN where the function is undefined, and infinity on overflow and at poles.
        """
        self._charge(_SOFTWARE * cycles if self._wide else cycles)
        try:
            result = function(*arguments)
        except ValueError:
            result = -math.inf if function is math.log and arguments[0] == 0.0 else math.nan
        except OverflowError:
            result = math.inf
        except ZeroDivisionError:
            result = math.inf
        if not self._wide:
            result = f32(result)
        if not math.isfinite(result) and all(math.isfinite(a) for a in arguments):
            name = function.__name__
            given = ", ".join(repr(a) for a in arguments)
            self._runtime.findings.report("nan", f"{name}({given}) is {result!r}", object=name, value=arguments[0])
        return result

    def sin(self, x: float) -> float:
        """The sine of an angle in radians."""
        return self._value(80, math.sin, x)

    def cos(self, x: float) -> float:
        """The cosine of an angle in radians."""
        return self._value(80, math.cos, x)

    def tan(self, x: float) -> float:
        """The tangent of an angle in radians."""
        return self._value(120, math.tan, x)

    def asin(self, x: float) -> float:
        """The arc sine in radians."""
        return self._value(140, math.asin, x)

    def acos(self, x: float) -> float:
        """The arc cosine in radians."""
        return self._value(140, math.acos, x)

    def atan(self, x: float) -> float:
        """The arc tangent in radians."""
        return self._value(100, math.atan, x)

    def atan2(self, y: float, x: float) -> float:
        """The angle of the point (x, y) in radians."""
        return self._value(120, math.atan2, y, x)

    def exp(self, x: float) -> float:
        """e to the power of x."""
        return self._value(120, math.exp, x)

    def log(self, x: float) -> float:
        """The natural logarithm."""
        return self._value(120, math.log, x)

    def pow(self, x: float, y: float) -> float:
        """x to the power of y."""
        return self._value(250, math.pow, x, y)

    def sqrt(self, x: float) -> float:
        """The square root; NaN for a negative number."""
        return self._value(40, math.sqrt, x)

    def floor(self, x: float) -> float:
        """The largest whole number not above x."""
        return self._value(20, _whole_below, x)

    def ceil(self, x: float) -> float:
        """The smallest whole number not below x."""
        return self._value(20, _whole_above, x)

    def fmod(self, x: float, y: float) -> float:
        """The remainder of x / y, with the sign of x."""
        return self._value(150, math.fmod, x, y)

    def fabs(self, x: float) -> float:
        """The absolute value."""
        self._charge(4)
        return abs(x)


def _whole_above(x: float) -> float:
    return -_whole_below(-x)


def _whole_below(x: float) -> float:
    return float(math.floor(x)) if math.isfinite(x) else x
