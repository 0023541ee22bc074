"""Faults of the serial line to the PC: bits, bytes, bursts, stall, break, wrong baud.

`direction` is that of the bytes: to the chip or from it.  What the firmware meets is the character in SCIRXBUF (of a
lost one: the character that comes in its place); what is spoilt on the way to the PC no access of the firmware meets.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from typing import Final

from emulator.clock import SYSCLK_HZ
from emulator.registers.cell import Cell
from emulator.signals import SerialFrame, SerialLine
from hil.faults.effect import Effect, FaultTarget, MountedFault
from hil.faults.kinds import FaultKind, FaultParameter

_DIRECTION: Final = FaultParameter(
    "direction", "", "of the bytes", "to-chip", choices=("to-chip", "from-chip"), type=str
)
_RATE: Final = FaultParameter("rate", "", "probability for each byte", 1.0, 0.0, 1.0)


class OfLine(Effect):
    """A fault of one direction of the line."""

    def __init__(self, mounted: MountedFault) -> None:
        super().__init__(mounted)
        pc = self.board.pc
        assert pc is not None
        self.inward = "direction" not in mounted.fault.values or self.text("direction") == "to-chip"
        self.line: SerialLine = self.board.serial_pins[pc.rx_gpio if self.inward else pc.tx_gpio]
        self.received: list[Cell] = []
        signal = self.module_at(pc.rx_gpio, [f"SCIRXD{x}" for x in "ABCD"])
        if self.inward and signal is not None:
            self.received = [self.board.blocks[f"Sci{signal[-1].lower()}Regs"].registers["SCIRXBUF"]]

    @classmethod
    def check_machine(cls, machine: FaultTarget) -> None:
        """Raises ValueError for a board without a line to a PC."""
        if machine.board.pc is None:
            raise ValueError(f"{type(machine.board).__name__} has no line to a PC")

    def begin(self) -> None:
        """Begin the fault."""
        self.on_end(self.line.disturb(self.frames))

    @abstractmethod
    def frames(self, frame: SerialFrame) -> Iterable[SerialFrame]:
        """Return the frames in place of a frame."""

    def hit(self) -> None:
        """Report that a character differs from the one that was sent."""
        self.fired(*self.received)

    def later(self, frame: SerialFrame, start: int) -> SerialFrame:
        """Return the same frame with another start time."""
        return replace(frame, start=start, end=start + frame.end - frame.start)


class BitFlipped(OfLine):
    """A data bit is inverted."""

    def frames(self, frame: SerialFrame) -> Iterable[SerialFrame]:
        """Return the frames in place of a frame."""
        if not self.chosen_by_rate():
            return (frame,)
        bit = self.whole("bit")
        self.hit()
        return (replace(frame, data=frame.data ^ 1 << (bit if bit >= 0 else self.rng.randrange(frame.data_bits))),)


class ByteLost(OfLine):
    """A byte is lost."""

    def frames(self, frame: SerialFrame) -> Iterable[SerialFrame]:
        """Return the frames in place of a frame."""
        if not self.chosen_by_rate():
            return (frame,)
        self.hit()
        return ()


class ByteDoubled(OfLine):
    """A byte comes twice; the bytes after it wait."""

    _free_at = 0

    def frames(self, frame: SerialFrame) -> Iterable[SerialFrame]:
        """Return the frames in place of a frame."""
        self._put(frame, twice=False)
        if self.chosen_by_rate():
            self._put(frame, twice=True)
        return ()

    def _put(self, frame: SerialFrame, *, twice: bool) -> None:
        moved = self.later(frame, max(frame.start, self._free_at))
        self._free_at = moved.end
        self.clock.schedule(max(moved.end, self.clock.now), partial(self._arrives, moved, twice))

    def _arrives(self, frame: SerialFrame, twice: bool) -> None:
        if twice:
            self.hit()
        self.line.deliver(frame)


class NoiseBurst(OfLine):
    """Several bytes in a row are replaced by noise."""

    _left = 0

    def frames(self, frame: SerialFrame) -> Iterable[SerialFrame]:
        """Return the frames in place of a frame."""
        if not self._left and self.chosen_by_rate():
            self._left = self.whole("bytes")
        if not self._left:
            return (frame,)
        self._left -= 1
        noise = self.rng.getrandbits(frame.data_bits)
        if noise == frame.data:
            return (frame,)
        self.hit()
        return (replace(frame, data=noise),)


class LineStall(OfLine):
    """Nothing passes; the delayed bytes come afterwards, without pauses."""

    def begin(self) -> None:
        """Begin the fault."""
        self._held: list[SerialFrame] = []
        super().begin()
        self.on_end(self._release)
        # Ends are undone from the last: the line is free first.
        self._ends.reverse()

    def frames(self, frame: SerialFrame) -> Iterable[SerialFrame]:
        """Return the frames in place of a frame."""
        self._held.append(frame)
        self.hit()
        return ()

    def _release(self) -> None:
        at = self.clock.now
        for frame in self._held:
            moved = self.later(frame, at)
            at = moved.end
            self.clock.schedule(moved.end, partial(self.line.deliver, moved))
        self._held.clear()


class HeldLow(OfLine):
    """The line is held low."""

    def begin(self) -> None:
        """Begin the fault."""
        super().begin()
        self.line.hold_low(True)
        self.on_end(lambda: self.line.hold_low(False))
        self.hit()

    def frames(self, frame: SerialFrame) -> Iterable[SerialFrame]:
        """Return the frames in place of a frame."""
        self.hit()
        return ()


class WrongBaud(OfLine):
    """The bits have a wrong length.  As with a drift, the registers at both ends are right."""

    def frames(self, frame: SerialFrame) -> Iterable[SerialFrame]:
        """Return the frames in place of a frame."""
        bit = SYSCLK_HZ / self.number("baud")
        if bit == frame.bit_cycles:
            return (frame,)
        self.hit()
        longer = bit / frame.bit_cycles
        start = frame.end - round((frame.end - frame.start) * longer)
        return (replace(frame, bit_cycles=bit, start=start, drift=frame.drift * longer),)


_NEEDS: Final = "a line to a PC"
KINDS = (
    FaultKind("serial-bit-flipped", "A bit of a byte on the line is flipped.", _NEEDS, BitFlipped,
              (_DIRECTION, FaultParameter("bit", "", "which, 0 is the first on the line; -1: by chance", -1, -1, 7,
                                     type=int)), _RATE),
    FaultKind("serial-byte-lost", "A byte on the line is lost.", _NEEDS, ByteLost, (_DIRECTION,), _RATE),
    FaultKind("serial-byte-doubled", "A byte comes twice.", _NEEDS, ByteDoubled, (_DIRECTION,), _RATE),
    FaultKind("serial-burst", "A run of bytes is noise.", _NEEDS, NoiseBurst,
              (_DIRECTION, FaultParameter("bytes", "", "how long a run is", 8, 1, 1000, type=int)), _RATE),
    FaultKind("serial-stall", "The line passes nothing; held bytes arrive together at the end.", _NEEDS, LineStall,
              (_DIRECTION,)),
    FaultKind("serial-break", "The line is held low.", _NEEDS, HeldLow, (_DIRECTION,)),
    FaultKind("serial-wrong-baud", "The sender uses another baud rate.", _NEEDS, WrongBaud,
              (_DIRECTION, FaultParameter("baud", "bit/s", "the sender's", 4800.0, 110.0, 1e6))),
)  # fmt: skip
