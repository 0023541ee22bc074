"""Everything that a run puts out: bytes on the line and every write of the firmware to a register, with time.

An output is a stream of (cycles, value); of a write to one half of a 32-bit register (CMPA), the value of that half.
Registers of the ePWM modules are the motors', GPIO registers the pins'; the others are what configures peripherals and
talks to the gyro.  Not recorded: what peripherals do to their own registers; SCITXBUF, whose bytes are the line's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, TypeAlias

from emulator.clock import Clock
from emulator.registers.cell import Cell
from emulator.registers.core import ALL, HIGH, Block

#: (cycles, value) in order.
Stream: TypeAlias = list[tuple[int, int]]


class Kind(Enum):
    """What an output is."""

    UART = "UART"
    PWM = "PWM"
    GPIO = "GPIO"
    REGISTER = "register"


def kind_of(name: str) -> Kind:
    """The kind of the output `name`: "UART", or a register as C calls it."""
    if name == Kind.UART.value:
        return Kind.UART
    if name.startswith("EPwm"):
        return Kind.PWM
    return Kind.GPIO if name.startswith("Gpio") else Kind.REGISTER


@dataclass(slots=True)
class Outputs:
    """What one run put out."""

    #: Output -> its stream.
    streams: dict[str, Stream] = field(default_factory=dict)
    #: Why it ended before its time; empty if it did not.
    stopped: str = ""
    end_cycles: int = 0

    @property
    def uart(self) -> Stream:
        """Bytes from the robot, each at the end of its stop bit."""
        return self.streams.setdefault(Kind.UART.value, [])


def record(outputs: Outputs, blocks: Mapping[str, Block], clock: Clock) -> None:
    """Have every register write of `blocks` from now on stand in `outputs`."""
    for block in blocks.values():
        for register in block:
            if register.name == "SCITXBUF":
                continue
            register.follow("write", _Tap(register, clock, outputs.streams), "write")


class _Tap(dict[str, Any]):
    """Stands in a register's way.  A register tells its followers whenever its access changes (a clock gate): the tap
    then lays itself over the new access."""

    def __init__(self, register: Cell, clock: Clock, streams: dict[str, Stream]) -> None:
        super().__init__()
        self._register, self._clock, self._streams = register, clock, streams
        self._laying = False
        self._within = False

    def __setitem__(self, _name: str, write: Any) -> None:
        if self._laying:
            return
        self._laying = True
        register, modify = self._register, self._register.modify

        def tapped_write(word: int, lanes: int = ALL) -> None:
            self._put(word, lanes)
            write(word, lanes)

        def tapped_modify(keep: int, bits: int, lanes: int) -> None:
            self._put(bits, lanes)
            self._within = True  # the modify may itself be a read and a write
            try:
                modify(keep, bits, lanes)
            finally:
                self._within = False

        register.modify = tapped_modify
        register.intercept(register.read, tapped_write)
        self._laying = False

    def _put(self, word: int, lanes: int) -> None:
        if not self._within:
            value = word >> 16 if lanes == HIGH else word & lanes
            self._streams.setdefault(self._register.path, []).append((self._clock.now, value))
