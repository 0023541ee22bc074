"""Who looks on when the CPU accesses a register: each tap is told of an access right before it happens.

`Cell.tap` and `Cell.untap` are the way in.  What a peripheral itself changes in its registers (flags, counters,
results) is no access of the CPU.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from emulator.registers.fields import ALL
from emulator.registers.hook import Hook

if TYPE_CHECKING:
    from emulator.registers.cell import Cell

#: `seen(register, access, word, mask)`, `access` being "read" or "write".  `word` is the whole word that is written and
#: `mask` the bits that the statement names: a field assignment writes the others back as it has read them.  Of a read
#: both are 0.
Seen = Callable[["Cell", str, int, int], None]


class RegisterTap:
    """A tap as an object, for registers that are accessed most: a compiled one is told in C."""

    __slots__ = ()

    def told(self, register: Cell, access: str, word: Any, mask: int) -> None:
        """An access, as `Seen` gets it; a vector's word is a function."""
        raise NotImplementedError


class _Calling(RegisterTap):
    """Calls a function."""

    __slots__ = ("_seen",)

    def __init__(self, seen: Seen) -> None:
        self._seen = seen

    def told(self, register: Cell, access: str, word: Any, mask: int) -> None:
        self._seen(register, access, word, mask)


def lay(register: Cell, taps: Mapping[RegisterTap | Seen, bool]) -> None:
    """Lay `taps` (each with whether it wants reads too) over the ways of access that `Cell.bind` has chosen."""
    tapped = Tapped(register, taps)
    if any(taps.values()):
        register.read, register.reads = tapped.read, tapped
    register.modify = tapped.modify_in_two_steps if register.modify == register._modify else tapped.modify
    register.write, register.writes = tapped.write, tapped


class Tapped(Hook):
    """The ways to a register: each tells its taps, and then does what it did without them."""

    __slots__ = ("_modify", "_read", "_reads", "_register", "_told", "_told_reads", "_write", "_writes")

    def __init__(self, register: Cell, taps: Mapping[RegisterTap | Seen, bool]) -> None:
        told = [(tap if isinstance(tap, RegisterTap) else _Calling(tap), reads) for tap, reads in taps.items()]
        self._register = register
        self._read: Callable[[], Any] = register.read
        self._write, self._modify = register.write, register.modify
        self._reads, self._writes = register.reads, register.writes
        self._told = [tap for tap, _ in told]
        self._told_reads = [tap for tap, reads in told if reads]

    def read(self) -> Any:
        """The CPU's read: of a word, or of the function that a vector holds."""
        for tap in self._told_reads:
            tap.told(self._register, "read", 0, 0)
        return self._read() if self._reads is None else self._reads.read()

    def write(self, word: Any, lanes: int = ALL) -> None:
        """The CPU's write: of a word, or of the function that a vector holds."""
        for tap in self._told:
            tap.told(self._register, "write", word, lanes)
        if self._writes is None:
            self._write(word, lanes)
        else:
            self._writes.write(word, lanes)

    def modify(self, keep: int, bits: int, lanes: int) -> None:
        """A read-modify-write in one step."""
        word: int = self._read() & keep | bits  # no effect, or `modify` would be in two steps
        for tap in self._told:
            tap.told(self._register, "write", word, lanes & ~keep)
        self._modify(keep, bits, lanes)

    def modify_in_two_steps(self, keep: int, bits: int, lanes: int) -> None:
        """A read-modify-write whose read is a read of the CPU."""
        word = self._register.read() & keep | bits
        for tap in self._told:
            tap.told(self._register, "write", word, lanes & ~keep)
        self._write(word, lanes)
