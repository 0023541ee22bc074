"""A shadowed register of an ePWM module: the written value, the active value, and when it is loaded.

Sources: TRM ePWM, TBPRD, counter-compare and action-qualifier shadow registers.
"""

from __future__ import annotations

from typing import Final

from emulator.registers.cell import Cell

#: Load points.
AT_ZERO: Final = 1
AT_PERIOD: Final = 2
#: LOADxMODE and LDAQxMODE: zero, period, both, never.
LOAD_POINTS: Final = (AT_ZERO, AT_PERIOD, AT_ZERO | AT_PERIOD, 0)


class Shadow:
    """One register.  `active` is the value that the hardware uses; the register's word is what the CPU wrote last.

    `shift`: the bit position of the value in the register; `used`: only these bits of it have a shadow.
    CHOICE: reads return what was written last, not the active value (unconfirmed for TBPRD).
    """

    __slots__ = ("_reset_immediate", "_shift", "_used", "active", "immediate", "pending", "points", "register")

    def __init__(self, register: Cell, *, immediate: bool = False, shift: int = 0,
                 used: int = 0xFFFF) -> None:  # fmt: skip
        self.register = register
        self._shift = shift
        self._used = used
        self._reset_immediate = immediate
        self.reset()

    def reset(self) -> None:
        """Active and shadow 0, loading at CTR = 0."""
        self.active = 0
        self.pending = False
        self.immediate = self._reset_immediate
        self.points = AT_ZERO

    def differs(self) -> bool:
        """Whether loading now would change the active value."""
        return self.register.value >> self._shift & self._used != self.active

    def load(self) -> None:
        """Make the shadow active."""
        self.pending = False
        self.active = self.register.value >> self._shift & self._used

    def configure(self, immediate: bool, points: int) -> bool:
        """The mode fields were written.  Returns whether the change to immediate mode lost a waiting value.

        In immediate mode the CPU reads and writes the active register.  A value that waits in the shadow is not loaded,
        and the register shows the active one.
        """
        self.points, self.immediate = points, immediate
        if not (immediate and self.pending):
            return False
        self.pending = False
        lost = self.differs()
        self.register.value = self.register.value & ~(self._used << self._shift) | self.active << self._shift
        return lost
