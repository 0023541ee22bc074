"""Functions that TI's compiler knows without a declaration (SPRU514, "Intrinsics"): interrupt mask, idling, floats."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final, Protocol

from emulator.c28x.arithmetic import divide_ieee, f32
from emulator.c28x.runtime import Idling
from emulator.clock import Clock


def _single(function: Callable[..., float]) -> Callable[..., float]:
    """A function of floats with a float result.  It is NaN outside of the domain, and on overflow."""

    def single(*values: float) -> float:
        try:
            return f32(function(*values))
        except (ValueError, OverflowError):
            return math.nan

    return single


def _estimate(value: float) -> float:
    """A number with the accuracy of the FPU's estimates, which is 8 bits.  CHOICE: it is rounded to 9 bits."""
    fraction, exponent = math.frexp(value)
    return math.ldexp(round(fraction * 512), exponent - 9)


#: EINVF32 and EISQRTF32 (SPRUHS1, FPU): a program improves their estimates by Newton's steps.
#: The trigonometric unit (SPRUHS1, TMU): angles of `pu` are in turns.  CHOICE: the correctly rounded value; the unit's
#: value differs from it in the last bits.
FLOATS: Final[dict[str, Callable[..., Any]]] = {
    name: _single(function)
    for name, function in (
        ("__sin", math.sin), ("__cos", math.cos), ("__atan", math.atan), ("__atan2", math.atan2),
        ("__sinpuf32", lambda x: math.sin(math.tau * x)), ("__cospuf32", lambda x: math.cos(math.tau * x)),
        ("__atanpuf32", lambda x: math.atan(x) / math.tau), ("__sqrt", math.sqrt), ("__divf32", divide_ieee),
        ("__einvf32", lambda x: _estimate(1 / x) if x else math.copysign(math.inf, x)),
        ("__eisqrtf32", lambda x: _estimate(1 / math.sqrt(x)) if x else math.inf),
        ("__fmax", max), ("__fmin", min), ("__fracf32", lambda x: math.modf(x)[0]),
    )
}  # fmt: skip


class InterruptMask(Protocol):
    """The part of the core that the intrinsics act on."""

    intm: bool
    clock: Clock

    def disable_interrupts(self) -> bool:
        """Set INTM."""

    def enable_interrupts(self) -> None:
        """Clear INTM."""

    def idle(self) -> bool:
        """Wait for an enabled interrupt; whether one can come."""


def intrinsics(cpu: InterruptMask) -> dict[str, Callable[..., Any]]:
    """Name of each intrinsic -> its function.

    CHOICE: of ST1, which `__disable_interrupts` returns, only INTM (bit 0) is modelled.
    """

    def disable() -> int:
        masked = int(cpu.intm)
        cpu.disable_interrupts()
        return masked

    def enable() -> int:
        masked = int(cpu.intm)
        cpu.enable_interrupts()
        return masked

    def restore(before: int) -> None:
        if before & 1:
            cpu.disable_interrupts()
        else:
            cpu.enable_interrupts()

    def idle(cycles: int) -> None:
        cpu.clock.delay(cycles)

    def sleep() -> None:
        if not cpu.idle():
            raise Idling("the CPU sleeps in IDLE, and no event is left that could wake it")

    return FLOATS | {
        "__disable_interrupts": disable, "__enable_interrupts": enable, "__restore_interrupts": restore,
        "__idle_cycles": idle, "__idle": sleep,
    }  # fmt: skip
