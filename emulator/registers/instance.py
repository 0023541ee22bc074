"""A register block of the chip: what a line of the table `emulator/blocks.py` says of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar, cast

from emulator.registers.core import Block

B = TypeVar("B", bound=Block)


@dataclass(frozen=True)
class Instance:
    """Where a block stands, and what of its wiring is the same for every module.

    `gate` is the bit that clocks it and `reset` the one that resets it, as `PCLKCR8.SPI_A` and `SOFTPRES8.SPI_A`; `pie`
    are its interrupts, each a group and a number in it, and `line` one of the CPU's own (13, 14); `trigsel` is the
    number under which the ADCs know its trigger.

    `behaviour(clock, cpu, registers, *interrupts)` is its class in `emulator/peripherals`, with `trigger` besides where
    there is one.  What needs more than that is made in `emulator/chip.py`.
    """

    kind: type[Block]
    base: int
    behaviour: Callable[..., Any] | None = None
    gate: str = ""
    reset: str = ""
    pie: tuple[tuple[int, int], ...] = ()
    line: int = 0
    trigsel: int = 0


def at(
    base: int, kind: type[B], behaviour: Callable[..., Any] | None = None, *, gate: str = "", reset: str = "",
    pie: Sequence[tuple[int, int]] = (), line: int = 0, trigsel: int = 0,
) -> B:  # fmt: skip
    """A block at a word address; the type is for those who write firmware: to them its name means its registers."""
    return cast(B, Instance(kind, base, behaviour, gate, reset, tuple(pie), line, trigsel))
