"""The 16-deep FIFO that SPI, SCI and I2C share: words, interrupt level, and its FFTX or FFRX register.

The FIFO registers of the modules have the same layout (HDR SPIFFTX, SCIFFTX, I2CFFTX, SPIFFRX, SCIFFRX, I2CFFRX), so
one class serves all.  The I2C has no reset bit for both channels.  It has no overflow either: it accepts no byte when
the FIFO is full.

Modelled: depth, status, level interrupt, reset bit, overflow of the receive FIFO; the level that triggers the DMA
(TRM SPI: fewer words than TXFFIL, or RXFFIL and more; SCI and I2C have none).
Time: none of its own.

The interrupt flag follows a level: it is set while the condition holds, so it is set again if it is cleared while the
condition holds.  The output is a pulse to the PIE whenever flag and enable become true together, and again after each
such clear.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Final

from emulator.registers.cell import Cell
from emulator.signal import Signal

DEPTH: Final = 16
#: It is reported when this many interrupts in a row have left words behind.
SHORT: Final = 3

LEVEL: Final = 0x001F
INT_ENABLE: Final = 1 << 5
INT_CLEAR: Final = 1 << 6
INT_FLAG: Final = 1 << 7
STATUS: Final = 0x1F00
RUN: Final = 1 << 13
#: In FFTX: the FIFO enhancements are on.
ENHANCED: Final = 1 << 14
#: In FFTX: 0 resets both channels.
CHANNELS_RUN: Final = 1 << 15
#: In FFRX.
OVERFLOW_CLEAR: Final = 1 << 14
OVERFLOW: Final = 1 << 15


class Fifo:
    """One direction.  `receive` decides between "at least" and "at most" for the interrupt level.

    `fresh`: a flag that was set while it was not enabled gives its interrupt only while its level still holds.
    `on_blocked()` is called when a word reaches the level and gives no interrupt, because the last flag is still set.
    """

    __slots__ = (
        "_fresh",
        "_interrupt",
        "_line",
        "_on_blocked",
        "_receive",
        "_register",
        "_taken",
        "enabled",
        "requested",
        "short",
        "words",
    )  # fmt: skip

    def __init__(
        self, register: Cell, interrupt: Callable[[], None], *, receive: bool, fresh: bool = False,
        on_blocked: Callable[[], object] | None = None,
    ) -> None:  # fmt: skip
        self._fresh, self._on_blocked = fresh, on_blocked
        self._register = register
        self._interrupt = interrupt
        self._receive = receive
        self._line = False
        #: Whether FIFO mode is on.  The FFENA bit for both directions is in FFTX.
        self.enabled = False
        self.words: deque[int] = deque()
        #: Words taken since the last interrupt; None: it has been acknowledged.
        self._taken: int | None = None
        #: How many interrupts in a row were acknowledged with fewer words taken than their level, and some left.
        self.short = 0
        #: (): the FIFO has changed while the level for the DMA is active.
        self.requested: Signal[[]] = Signal()

    @property
    def at_level(self) -> bool:
        """Whether the level that triggers the DMA is active."""
        value, count = self._register.value, len(self.words)
        if not self.enabled or not value & RUN:
            return False
        return count >= value & LEVEL if self._receive else count < value & LEVEL

    @property
    def running(self) -> bool:
        """Whether the FIFO's own reset bit is released."""
        return bool(self._register.value & RUN)

    @property
    def path(self) -> str:
        """The path of its register."""
        return self._register.path

    def reset(self) -> None:
        """Empty, as after a reset of the module; the owner resets the register."""
        self.words.clear()
        self._taken, self.short = None, 0
        self.enabled = self._line = False

    def clear(self) -> None:
        """Reset the channel: the words are lost, the configuration stays."""
        self.words.clear()
        self.refresh()

    def write(self, word: int, lanes: int) -> None:
        """A CPU write to the FIFO's register."""
        register = self._register
        register.store(word, lanes)
        if word & lanes & INT_CLEAR:
            if self._taken is not None:
                left = self._receive and self.words and 0 < self._taken < register.value & LEVEL
                self.short = self.short + 1 if left else 0
                self._taken = None
            register.value &= ~INT_FLAG
            self._line = False
        if self._receive and word & lanes & OVERFLOW_CLEAR:
            register.value &= ~OVERFLOW
        if not register.value & RUN:
            self.words.clear()
        self.refresh()

    def push(self, word: int) -> bool:
        """Append `word`; False when something was lost.

        A full receive FIFO loses its oldest word and sets the overflow flag; a full transmit FIFO ignores the new one
        (CHOICE: both unconfirmed).  A FIFO held in reset takes nothing.
        """
        register = self._register
        if not register.value & RUN:
            return False
        lost = len(self.words) >= DEPTH
        if lost:
            if not self._receive:
                return False
            self.words.popleft()
            register.value |= OVERFLOW
        self.words.append(word)
        stood = self._line
        self.refresh()
        if stood and self._line and self._on_blocked is not None and len(self.words) >= register.value & LEVEL:
            self._on_blocked()
        return not lost

    def left_behind(self) -> str:
        """A description of `short` for a report."""
        return (
            f"{self.path}: {self.short} times in a row the routine has taken fewer words than the "
            f"{self._register.value & LEVEL} at which its interrupt comes, and has left some for the next one"
        )

    def pop(self) -> int:
        """Take the oldest word.  The caller must check that there is one."""
        word = self.words.popleft()
        if self._taken is not None:
            self._taken += 1
        self.refresh()
        return word

    def refresh(self) -> None:
        """Bring status, flag and interrupt line in step with the words."""
        register = self._register
        count = len(self.words)
        value = register.value & ~STATUS | count << 8
        level = value & LEVEL
        stands = count >= level if self._receive else count <= level
        if self.enabled and value & RUN and stands:
            value |= INT_FLAG
        register.value = value
        line = self.enabled and value & (INT_FLAG | INT_ENABLE) == INT_FLAG | INT_ENABLE
        if line != self._line and (stands or not line or not self._fresh):
            self._line = line
            if line:
                self._taken = 0
                self._interrupt()
        if self.requested.listeners and self.at_level:
            self.requested.emit()
