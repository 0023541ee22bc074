"""What stands between the CPU and the stored word of a register, as an object."""

from __future__ import annotations


class Hook:
    """What an access of the CPU to a register does, as an object: compiled firmware calls its methods in C.

    A function, which `Block.bind` takes as well, gets and gives objects there.  A subclass has the methods that it is
    bound for; the others are never called.
    """

    __slots__ = ()

    def read(self) -> int:
        """What the CPU reads."""
        raise NotImplementedError

    def write(self, word: int, lanes: int) -> None:
        """What a write does, instead of the plain store."""
        raise NotImplementedError
