"""Bit fields: which bits of a register they are, and how they answer the CPU.  Part of `core.py`."""

from __future__ import annotations

import enum
from typing import TYPE_CHECKING, Any, Final, overload

if TYPE_CHECKING:
    from emulator.registers.core import Register

LOW: Final = 0x0000FFFF
HIGH: Final = 0xFFFF0000
ALL: Final = 0xFFFFFFFF


class Access(enum.Enum):
    """How a field answers the CPU.  A closed set, named as in the manual."""

    RW = "read, write"
    R = "read only"
    W = "write only, reads 0"
    W1C = "read; write 1 to clear"
    W1S = "read; write 1 to set"
    R0W1 = "write 1 to act, reads 0"
    RSV = "reserved"


RW = Access.RW
R = Access.R
W = Access.W
W1C = Access.W1C
W1S = Access.W1S
R0W1 = Access.R0W1
RSV = Access.RSV


class F:
    """A bit field: `F(hi, lo, access, reset, text)` or, for one bit, `F(bit, access, reset, text)`.

    `modelled=False` marks a field that exists on silicon but does nothing here: using it is reported by name.
    """

    __slots__ = ("access", "hi", "lane", "lo", "mask", "modelled", "name", "reset", "text", "width")

    def __init__(self, hi: int, *rest: Any, modelled: bool = True) -> None:
        lo = rest[0] if isinstance(rest[0], int) else hi
        access, reset, text = rest[-3:]
        if not 0 <= lo <= hi <= 31 or not isinstance(access, Access):
            raise ValueError(f"field [{hi}:{lo}] {access!r}: expected 31 >= hi >= lo >= 0 and an Access")
        self.name = ""
        self.hi, self.lo = hi, lo
        self.width = hi - lo + 1
        self.mask = ((1 << self.width) - 1) << lo
        self.access: Access = access
        self.reset: int = reset
        self.text: str = text
        self.modelled = modelled
        #: The bits of the access that the compiler makes for this field.
        self.lane = ALL if lo < 16 <= hi else (HIGH if lo >= 16 else LOW)

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, register: None, owner: type) -> F: ...
    @overload
    def __get__(self, register: Register, owner: type) -> int: ...
    def __get__(self, register: Register | None, owner: type) -> F | int:
        if register is None:
            return self
        return (register.read() & self.mask) >> self.lo

    def __set__(self, register: Register, value: int) -> None:
        register.modify(~self.mask, value << self.lo & self.mask, self.lane)
