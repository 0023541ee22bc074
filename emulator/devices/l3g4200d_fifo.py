"""The 32-level sample memory of the L3G4200D.

Modelled: the five modes of FM[2:0], watermark, overrun, empty, unread count, the trigger by INT1.
Not modelled: nothing of the data sheet.
Time: none of its own; samples are pushed by the device in the order of their times.
Sources: L3G section on FIFO, FIFO_CTRL_REG, FIFO_SRC_REG.
"""

from __future__ import annotations

from collections import deque
from typing import Final, NamedTuple

from emulator.devices.l3g4200d_registers import FifoMode

DEPTH: Final = 32


class Sample(NamedTuple):
    """One XYZ set in digits, with its number and the virtual time of its sampling."""

    x: int
    y: int
    z: int
    number: int
    cycles: int


class SampleFifo:
    """Sample memory: `push` at sample times, `oldest` and `pop` by the reader."""

    __slots__ = ("_mode", "_sets", "_triggered", "active", "enabled", "in_use", "watermark")

    def __init__(self) -> None:
        self.enabled = False
        self.watermark = 0
        self._mode: int = FifoMode.BYPASS
        self._triggered = False
        self._sets: deque[Sample] = deque()
        #: Whether a mode other than bypass is selected: then a burst wraps from OUT_Z_H to OUT_X_L.
        self.in_use = False
        #: Whether the output registers are fed from the memory rather than by the newest sample.
        self.active = False

    def configure(self, enabled: bool, mode: int, watermark: int) -> None:
        """FIFO_EN, FM and WTM as written.

        CHOICE: a change of mode other than to bypass keeps the content (the sheet asks to restart through bypass);
        the undefined codes 101-111 act as bypass.
        """
        mode = mode if mode <= FifoMode.BYPASS_TO_STREAM else FifoMode.BYPASS
        if not enabled or mode == FifoMode.BYPASS or not self.enabled:
            self._sets.clear()
        if mode != self._mode or not enabled:
            self._triggered = False
        self.enabled = enabled
        self._mode = mode
        self.watermark = watermark
        self._decide()

    def _decide(self) -> None:
        """Decide how samples are stored until mode or trigger change."""
        self.in_use = self.enabled and self._mode != FifoMode.BYPASS
        self.active = self.in_use and (self._mode != FifoMode.BYPASS_TO_STREAM or self._triggered)

    @property
    def stops_when_full(self) -> bool:
        """Whether the present phase keeps the first 32 sets and drops later ones."""
        return self._mode == FifoMode.FIFO or (self._mode == FifoMode.STREAM_TO_FIFO and self._triggered)

    @property
    def needs_every_sample(self) -> bool:
        """Whether every sample must be pushed, because the memory fills until it stops."""
        return self.active and self.stops_when_full and len(self._sets) < DEPTH

    @property
    def level(self) -> int:
        """Unread sets, 0..32."""
        return len(self._sets)

    def trigger(self) -> None:
        """The INT1 event of the two trigger modes."""
        self._triggered = True
        self._decide()

    def push(self, sample: Sample) -> None:
        """A new sample by the rule of the mode."""
        if not self.active:
            return
        if len(self._sets) >= DEPTH:
            if self.stops_when_full:
                return
            self._sets.popleft()
        self._sets.append(sample)

    def oldest(self) -> Sample | None:
        """The set that the output registers show, or None when empty."""
        return self._sets[0] if self._sets else None

    def pop(self) -> None:
        """The set was read completely."""
        if self._sets:
            self._sets.popleft()

    def source(self) -> int:
        """FIFO_SRC_REG.

        CHOICE: WTM at level >= WTM[4:0], as the data sheet words it; 0 while the memory is not in use.
        CHOICE: FSS saturates at 31, and 32 is told by OVRN.
        """
        level = len(self._sets)
        word = min(level, 31)
        if not level:
            word |= 0x20
        if level >= DEPTH:
            word |= 0x40
        if self.active and level >= self.watermark:
            word |= 0x80
        return word
