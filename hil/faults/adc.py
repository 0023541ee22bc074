"""Faults of an ADC: a bit of its codes that is stuck, a reference that drifts, an input without its wire, held or
shorted, a dead converter.

CHOICE: a broken input reads what the sampling capacitor holds, the code of the conversion before (TRM, ADC input
model: nothing recharges it); 0 before the first.  A drifting reference scales finished codes, so that noise scales too.
"""

from __future__ import annotations

import re
from abc import abstractmethod
from typing import TYPE_CHECKING

from emulator.clock import SYSCLK_HZ
from hil.faults.effect import Effect, MountedFault
from hil.faults.kinds import FaultKind, FaultParameter

if TYPE_CHECKING:
    from hil.board import Board

_INPUT = FaultParameter("input", "", "ADC and channel, as A2", type=str)


class _OfInput(Effect):
    """A fault of one input."""

    def __init__(self, mounted: MountedFault) -> None:
        super().__init__(mounted)
        found = re.fullmatch(r"([A-D])(\d{1,2})", self.text("input").upper())
        if found is None or int(found[2]) > 15:
            raise ValueError(f"input: {self.text('input')!r} is not one of A0 to D15")
        self.adc, self.channel = found[1], int(found[2])

    def begin(self) -> None:
        """Begin the fault."""
        self.on_end(self.board.adc[self.adc].inject_fault(self.faulty_code))

    @abstractmethod
    def faulty_code(self, soc: int, channel: int, code: int) -> int:
        """Return the code in place of `code`."""

    def reported(self, soc: int, before: int, after: int) -> int:
        """Report that the fault fired if the code has changed, and return the new code."""
        if after != before:
            self.fired(self.board.blocks[f"Adc{self.adc.lower()}ResultRegs"].registers[f"ADCRESULT{soc}"])
        return after


class BitStuck(_OfInput):
    """One bit of the codes of an input is stuck."""

    def faulty_code(self, soc: int, channel: int, code: int) -> int:
        """Return the code in place of `code`."""
        if channel != self.channel:
            return code
        bit = 1 << self.whole("bit")
        return self.reported(soc, code, code | bit if self.whole("value") else code & ~bit)


class ChannelOpen(_OfInput):
    """The wire to an input is broken."""

    _held = 0

    def faulty_code(self, soc: int, channel: int, code: int) -> int:
        """Return the code in place of `code`."""
        if channel != self.channel:
            self._held = code
            return code
        return self.reported(soc, code, self._held)


class InputHeld(_OfInput):
    """An input keeps its last voltage."""

    _held: int | None = None

    def faulty_code(self, soc: int, channel: int, code: int) -> int:
        """Return the code in place of `code`."""
        if channel != self.channel:
            return code
        if self._held is None:
            self._held = code
        return self.reported(soc, code, self._held)


class InputShorted(_OfInput):
    """An input is shorted to one voltage."""

    def faulty_code(self, soc: int, channel: int, code: int) -> int:
        """Return the code in place of `code`."""
        if channel != self.channel:
            return code
        top = _full_scale(self.board, self.adc)
        return self.reported(soc, code, min(top, int(self.number("volts") / self.board.vrefhi_v * (top + 1))))


def _full_scale(board: Board, adc: str) -> int:
    """The largest code, of 12 or 16 bits by ADCCTL2.RESOLUTION."""
    return 0xFFFF if board.blocks[f"Adc{adc.lower()}Regs"].registers["ADCCTL2"].value & 0x40 else 0xFFF


class ReferenceDrift(Effect):
    """The reference of an ADC drifts from its nominal voltage."""

    _began = 0

    def begin(self) -> None:
        """Begin the fault."""
        self._began = self.clock.now
        self.on_end(self.board.adc[self.text("adc")].inject_fault(self._drifted_code))

    def _drifted_code(self, soc: int, _channel: int, code: int) -> int:
        over = self.number("over") * SYSCLK_HZ
        share = 1.0 if over <= 0.0 else min(1.0, int(self.clock.now - self._began) / over)
        adc = self.text("adc")
        top = _full_scale(self.board, adc)
        after = min(top, int((code + 0.5) / (1.0 + share * self.number("percent") / 100.0)))
        if after != code:
            self.fired(self.board.blocks[f"Adc{adc.lower()}ResultRegs"].registers[f"ADCRESULT{soc}"])
        return after


class ConverterDead(Effect):
    """An ADC does not convert: started SOCs stay pending, and no interrupt flag is set."""

    def begin(self) -> None:
        """Begin the fault."""
        self.on_end(self.board.adc[self.text("adc")].stop_converting())
        self.fired(self.board.blocks[f"Adc{self.text('adc').lower()}Regs"].registers["ADCINTFLG"])


_ADC = FaultParameter("adc", "", "which", "A", choices=("A", "B", "C", "D"), type=str)
KINDS = (
    FaultKind(
        "adc-bit-stuck", "A bit of every code of one ADC input is stuck.", "any board", BitStuck,
        (_INPUT, FaultParameter("bit", "", "which, 0 is the lowest", 3, 0, 15, type=int),
         FaultParameter("value", "", "what it is stuck at", 1, 0, 1, type=int)),
    ),
    FaultKind(
        "adc-reference-drift", "VREFHI of an ADC drifts: codes shrink as it grows.", "any board", ReferenceDrift,
        (_ADC, FaultParameter("percent", "%", "how far, at last", 5.0, -50.0, 50.0),
         FaultParameter("over", "s", "how long it takes to go there", 1.0, 0.0)),
    ),
    FaultKind(
        "adc-channel-open", "The wire to an ADC input is broken: it reads the charge of the conversion before.",
        "any board", ChannelOpen, (_INPUT,),
    ),
    FaultKind(
        "adc-input-held", "An ADC input keeps the voltage that it had.", "any board", InputHeld, (_INPUT,),
    ),
    FaultKind(
        "adc-input-shorted", "An ADC input is shorted to one voltage.", "any board", InputShorted,
        (_INPUT, FaultParameter("volts", "V", "which", 0.0, 0.0, 3.6)),
    ),
    FaultKind("adc-dead", "An ADC stops converting.", "any board", ConverterDead, (_ADC,)),
)  # fmt: skip
