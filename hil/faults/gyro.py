"""Faults of the gyro and its SPI: MISO stuck, chip select lost, reset in mid-run, wrong WHO_AM_I, bias, saturation.

A reset leaves it in power-down with its registers at their reset values (L3G, register file): its outputs are 0.
Saturated, it gives the ends of its 16 bits.  With its chip select lost nobody drives MISO.
"""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from typing import Final

from emulator.devices.l3g4200d import L3G4200D
from emulator.devices.l3g4200d_registers import WHO_AM_I
from emulator.registers.cell import Cell
from emulator.signals import SpiBus, SpiSlave
from hil.board import Board
from hil.faults.effect import Effect, FaultTarget, MountedFault
from hil.faults.kinds import FaultKind, FaultParameter

_AXES: Final = ("x", "y", "z")
_AXIS: Final = FaultParameter("axis", "", "which", "z", choices=_AXES, type=str)
#: Twice the widest range of the part.
_TOO_FAST_RAD_S: Final = radians(4000.0)
#: `(out_bits, length, answer)`: another answer of a device; None: it drives nothing.
Answer = Callable[[int, int, "int | None"], "int | None"]


class _OfGyro(Effect):
    """A fault of the gyro."""

    def __init__(self, mounted: MountedFault) -> None:
        super().__init__(mounted)
        self.gyro = _gyro(self.board)
        self._part = next(part for part in self.board.parts.values() if part.device is self.gyro)
        letter, self.bus = _bus(self.board, self.gyro)
        #: Where a word of its bus comes into the chip.
        self.received: Cell = self.board.blocks[f"Spi{letter.lower()}Regs"].registers["SPIRXBUF"]

    @classmethod
    def check_machine(cls, machine: FaultTarget) -> None:
        """Raises ValueError for a board without a gyro on an SPI."""
        _bus(machine.board, _gyro(machine.board))

    def tamper(self, with_answer: Answer, *, cut: bool = False) -> None:
        """Let `with_answer(out_bits, length, answer)` change the answers of the gyro, until the end of the fault.

        `cut`: the gyro gets no words.
        """
        slave = _on(self.bus, self.gyro)
        before = slave if isinstance(slave, TamperedSlave) else TamperedSlave(self.bus, self.gyro)
        before.add(with_answer, cut=cut)
        self.on_end(lambda: before.remove(with_answer))

    def turns(self, change: Callable[[tuple[float, float, float]], tuple[float, float, float]]) -> None:
        """Change the rate that the gyro measures, until the end of the fault."""
        source = self.gyro.rate_source
        self.gyro.set_rate_source(lambda cycles: change(source(cycles)))
        self.on_end(lambda: self.gyro.set_rate_source(source))


def _gyro(board: Board) -> L3G4200D:
    return board.only(L3G4200D, "gyro")


def _bus(board: Board, gyro: L3G4200D) -> tuple[str, SpiBus]:
    """The SPI bus of a gyro, and its letter.  Raises ValueError if it is on none."""
    for letter, bus in board.spi_bus.items():
        if _on(bus, gyro) is not None:
            return letter, bus
    raise ValueError("the gyro of this board is on no SPI")


def _on(bus: SpiBus, gyro: L3G4200D) -> SpiSlave | None:
    """The slave that gets the gyro's words on a bus: the gyro, or the one that was put before it."""
    return next((slave for slave in bus.slaves if getattr(slave, "slave", slave) is gyro), None)


class TamperedSlave:
    """A slave in front of a device: it changes the answers of the device."""

    def __init__(self, bus: SpiBus, slave: SpiSlave) -> None:
        self.slave = slave
        self._bus = bus
        self._changes: list[Answer] = []
        #: What keeps words from the device.
        self._cuts: list[Answer] = []
        bus.replace(slave, self)

    def add(self, change: Answer, *, cut: bool) -> None:
        """Add a change after the present ones; `cut`: the device gets no words."""
        self._changes.append(change)
        if cut:
            self._cuts.append(change)

    def remove(self, change: Answer) -> None:
        """Remove a change.  After the last one, the device is on the bus itself again."""
        self._changes.remove(change)
        if change in self._cuts:
            self._cuts.remove(change)
        if not self._changes:
            self._bus.replace(self, self.slave)

    def select(self, level: int) -> None:
        """Do nothing: the device follows its chip select itself."""

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int | None:
        """Exchange a word."""
        answer = None if self._cuts else self.slave.exchange(out_bits, length, cpol, cpha)
        for change in self._changes:
            answer = change(out_bits, length, answer)
        return answer


class MisoStuck(_OfGyro):
    """MISO is stuck at a level."""

    def begin(self) -> None:
        """Begin the fault."""
        self.tamper(self._stuck)

    def _stuck(self, _out_bits: int, length: int, answer: int | None) -> int:
        stuck = (1 << length) - 1 if self.whole("level") else 0
        if stuck != (self._idle(length) if answer is None else answer):
            self.fired(self.received)
        return stuck

    def _idle(self, length: int) -> int:
        return (1 << length) - 1 if self.bus.idle_in else 0


class SelectLost(_OfGyro):
    """The chip select does not reach the gyro."""

    def begin(self) -> None:
        """Begin the fault."""
        self.gyro.select(1)
        self.tamper(self._nothing, cut=True)

    def _nothing(self, _out_bits: int, _length: int, answer: int | None) -> int | None:
        self.fired(self.received)
        return answer


class GyroReset(_OfGyro):
    """The gyro loses its supply for a moment."""

    def begin(self) -> None:
        """Begin the fault."""
        rate_hz = self.number("rate")
        if rate_hz:
            self.repeat(rate_hz, self._reset)
        self._reset()

    def _reset(self) -> None:
        self.gyro.reset()
        self.fired(self.received)


class WhoAmI(_OfGyro):
    """WHO_AM_I is that of another part, or of no known part."""

    def begin(self) -> None:
        """Begin the fault."""
        self._address = self._bits = -1
        select = self.board.pins[int(self._part.pins["CS"].removeprefix("GPIO"))]
        self.on_end(select.changed.connect(self._selected))
        self.tamper(self._read)

    def _selected(self, _level: int) -> None:
        self._bits = 0

    def _read(self, out_bits: int, length: int, answer: int | None) -> int | None:
        begun, self._bits = self._bits, self._bits + length
        if begun == 0 and length >= 8:
            command = out_bits >> (length - 8)
            self._address = command & 0x3F if command & 0x80 else -1
        if self._address != WHO_AM_I or answer is None or not begun < 16 <= self._bits:
            return answer
        # The register's byte is the second of the frame: the last bits of this word up to bit 16 of it.
        after = self._bits - 16
        wrong = answer & ~(0xFF << after) | self.whole("value") << after
        if wrong != answer:
            self.fired(self.received)
        return wrong


class BiasJump(_OfGyro):
    """The zero-rate level jumps."""

    def begin(self) -> None:
        """Begin the fault."""
        self.turns(self._turned)

    def _turned(self, rates: tuple[float, float, float]) -> tuple[float, float, float]:
        self.fired(self.received)
        bias = radians(self.number("dps"))
        x, y, z = (rate + bias * (axis == self.text("axis")) for axis, rate in zip(_AXES, rates, strict=True))
        return x, y, z


class GyroSaturation(_OfGyro):
    """An axis is at the end of its range."""

    def begin(self) -> None:
        """Begin the fault."""
        self.turns(self._turned)

    def _turned(self, rates: tuple[float, float, float]) -> tuple[float, float, float]:
        self.fired(self.received)
        end = _TOO_FAST_RAD_S if self.text("sign") == "+" else -_TOO_FAST_RAD_S
        x, y, z = (end if axis == self.text("axis") else rate for axis, rate in zip(_AXES, rates, strict=True))
        return x, y, z


_NEEDS: Final = "a gyro L3G4200D on an SPI"
KINDS = (
    FaultKind("gyro-miso-stuck", "MISO of the gyro's bus stays at one level.", _NEEDS, MisoStuck,
              (FaultParameter("level", "", "which", 1, 0, 1, type=int),)),
    FaultKind("gyro-select-lost", "The gyro's chip select does not reach it.", _NEEDS, SelectLost),
    FaultKind("gyro-reset", "The gyro is reset: power-down, registers at their reset values.", _NEEDS, GyroReset,
              rate=FaultParameter("rate", "Hz", "how often again, at random times; 0: once", 0.0, 0.0, 100.0)),
    FaultKind("gyro-who-am-i", "WHO_AM_I of the gyro is not 0xD3.", _NEEDS, WhoAmI,
              (FaultParameter("value", "", "what WHO_AM_I reads", 0x33, 0, 0xFF, type=int),)),
    FaultKind("gyro-bias-jump", "The zero-rate level of an axis jumps.", _NEEDS, BiasJump,
              (_AXIS, FaultParameter("dps", "deg/s", "by how much", 20.0, -2000.0, 2000.0))),
    FaultKind("gyro-saturation", "An axis is at the end of its range.", _NEEDS, GyroSaturation,
              (_AXIS, FaultParameter("sign", "", "which end", "+", choices=("+", "-"), type=str))),
)  # fmt: skip
