"""Who looks on when the CPU accesses a register: each tap is told of an access right before it happens.

`Cell.tap` and `Cell.untap` are the way in.  What a peripheral itself changes in its registers (flags, counters,
results) is no access of the CPU.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from emulator.registers.fields import ALL

if TYPE_CHECKING:
    from emulator.registers.cell import Cell

#: `seen(register, access, word, mask)`, `access` being "read" or "write".  `word` is the whole word that is written and
#: `mask` the bits that the statement names: a field assignment writes the others back as it has read them.  Of a read
#: both are 0.
Seen = Callable[["Cell", str, int, int], None]


def lay(register: Cell, taps: Mapping[Seen, bool]) -> None:
    """Lay `taps` (each with whether it wants reads too) over the ways of access that `Cell.bind` has chosen."""
    read, write, modify = register.read, register.write, register.modify
    told = tuple(taps)
    told_reads = tuple(seen for seen, reads in taps.items() if reads)

    def read_seen() -> int:
        for seen in told_reads:
            seen(register, "read", 0, 0)
        return read()

    def write_seen(word: int, lanes: int = ALL) -> None:
        for seen in told:
            seen(register, "write", word, lanes)
        write(word, lanes)

    def modify_seen(keep: int, bits: int, lanes: int) -> None:
        word = read() & keep | bits  # no effect, or `modify` would be in two steps
        for seen in told:
            seen(register, "write", word, lanes & ~keep)
        modify(keep, bits, lanes)

    def modify_in_two_steps(keep: int, bits: int, lanes: int) -> None:
        word = register.read() & keep | bits
        for seen in told:
            seen(register, "write", word, lanes & ~keep)
        write(word, lanes)

    if len(told) == 1:
        (only,) = told

        def write_seen(word: int, lanes: int = ALL) -> None:
            only(register, "write", word, lanes)
            write(word, lanes)

    if told_reads:
        register.read = read_seen
    register.write = write_seen
    register.modify = modify_in_two_steps if modify == register._modify else modify_seen
