"""What a register access does wrong without anybody noticing: EALLOW off, clock off, reserved and unmodelled bits.

Each function wraps, or stands for, one access function of `cell.Cell`; `Cell.bind` chooses them, so that an
access with nothing to check costs nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from emulator.registers.fields import ALL

if TYPE_CHECKING:
    from emulator.registers.cell import Cell

Write = Callable[[int, int], None]


def watching(register: Cell, write: Write) -> Write:
    """Report a change of a field that exists on silicon and does nothing here."""

    def write_watched(word: int, lanes: int = ALL) -> None:
        touched = (word ^ register.value) & register.unmodelled_mask & lanes
        if touched:
            for name, f in register.fields.items():
                if touched & f.mask:
                    register.block.cpu.findings.report(
                        "unmodelled",
                        f"{register.path}.{name} ({f.text}) is not modelled: setting it has no effect here",
                        object=f"{register.path}.{name}", value=(word & f.mask) >> f.lo,
                    )  # fmt: skip
        write(word, lanes)

    return write_watched


def protecting(register: Cell, write: Write) -> Write:
    """Drop the write, and report it, while EALLOW is off."""
    cpu = register.block.cpu

    def write_protected(word: Any, lanes: int = ALL) -> None:  # a vector holds a function
        if cpu.eallow:
            write(word, lanes)
        else:
            since = f" since {cpu.findings.places[cpu.edis_at]}" if cpu.edis_at else ""
            cpu.findings.report(
                "eallow", f"{register.path} is protected and EALLOW is off{since}: the write was dropped silently",
                object=register.path, value=word if isinstance(word, int) else None,
            )  # fmt: skip

    return write_protected


def refusing_reserved(register: Cell, write: Write) -> Write:
    """Report ones written to reserved bits, unless the register is filled and not set.

    That is a word of all ones, and, where most bits are reserved, one with ones in all of these (`~mask`).
    """
    every = (1 << register.bits) - 1
    reserved = register.reserved_mask & ~register.reset_value
    filled = reserved if reserved.bit_count() > register.bits // 2 else every

    def write_checked(word: int, lanes: int = ALL) -> None:
        if word & reserved & lanes and word & filled != filled:
            register.block.cpu.findings.report(
                "reserved-field",
                f"{register.path} was written with {word:#06x}: bits {word & reserved & lanes:#06x} are reserved "
                "and must be written 0",
                object=register.path, value=word,
            )  # fmt: skip
        write(word, lanes)

    return write_checked


def gated_read(register: Cell) -> Callable[[], int]:
    """The read of a module whose clock is off."""

    def read_gated() -> int:
        # CHOICE: the registers of a gated module read 0 (usually observed, unconfirmed).
        register.block.cpu.findings.report(
            "clock-gated", f"{register.path} was read while its module's clock is off: it reads 0",
            object=register.path,
        )  # fmt: skip
        return 0

    return read_gated


def gated_write(register: Cell) -> Write:
    """The write to a module whose clock is off."""

    def write_gated(word: int, lanes: int = ALL) -> None:
        register.block.cpu.findings.report(
            "clock-gated", f"{register.path} was written while its module's clock is off: nothing is stored",
            object=register.path, value=word,
        )  # fmt: skip

    return write_gated
