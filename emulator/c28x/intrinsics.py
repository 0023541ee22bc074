"""Functions that TI's compiler knows without a declaration (SPRU514, "Intrinsics"), as far as they act on the core."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from emulator.clock import Clock


class Core(Protocol):
    """What the intrinsics act on."""

    intm: bool
    clock: Clock

    def disable_interrupts(self) -> bool:
        """Set INTM."""

    def enable_interrupts(self) -> None:
        """Clear INTM."""


def intrinsics(cpu: Core) -> dict[str, Callable[..., Any]]:
    """Name -> what it does.

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

    return {
        "__disable_interrupts": disable, "__enable_interrupts": enable, "__restore_interrupts": restore,
        "__idle_cycles": idle,
    }  # fmt: skip
