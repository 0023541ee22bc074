"""All outputs of a run: bytes on the line and every write of the firmware to a register, with time.

An output is a stream of (cycles, value).  For an assignment to a field the value is that field, at its place in the
word; for a write to the high half of a 32-bit register (CMPA) it is that half.
Registers of the ePWM modules drive the motors, GPIO registers the pins; the others configure peripherals or talk to the
gyro.  Not recorded: changes of registers by their peripherals; SCITXBUF, whose bytes are those of the line.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import TypeAlias

from emulator.clock import Clock
from emulator.registers.cell import Cell
from emulator.registers.core import Block
from emulator.registers.fields import LOW

#: (cycles, value) in order.
Stream: TypeAlias = list[tuple[int, int]]


class OutputKind(Enum):
    """The kind of an output."""

    UART = "UART"
    PWM = "PWM"
    GPIO = "GPIO"
    REGISTER = "register"


def kind_of(name: str) -> OutputKind:
    """The kind of the output `name`: "UART", or a register as C calls it."""
    if name == OutputKind.UART.value:
        return OutputKind.UART
    if name.startswith("EPwm"):
        return OutputKind.PWM
    return OutputKind.GPIO if name.startswith("Gpio") else OutputKind.REGISTER


@dataclass(slots=True)
class RunOutputs:
    """All outputs of one run."""

    #: Output -> its stream.
    streams: dict[str, Stream] = field(default_factory=dict)
    #: Why it ended before its time; empty if it did not.
    stopped: str = ""
    end_cycles: int = 0

    @property
    def uart(self) -> Stream:
        """Bytes from the robot, each at the end of its stop bit."""
        return self.streams.setdefault(OutputKind.UART.value, [])


def record(outputs: RunOutputs, blocks: Mapping[str, Block], clock: Clock) -> None:
    """Record every register write of `blocks` in `outputs` from now on."""

    def put(register: Cell, _access: str, word: int, mask: int) -> None:
        value = (word & mask) >> (0 if mask & LOW else 16)
        outputs.streams.setdefault(register.path, []).append((clock.now, value))

    for block in blocks.values():
        for register in block:
            if register.name != "SCITXBUF":
                register.tap(put)
