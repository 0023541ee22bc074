"""The sixteen SOCs of an ADC module: their settings, which of them wait, and which one is converted next.

Part of `adc.py`, whose docstring says what is modelled.
"""

from __future__ import annotations

from typing import Final

from mypy_extensions import i64

from emulator.c28x.findings import Cause, Findings
from emulator.peripherals.adc_converter import Converter
from emulator.registers.adc import AdcRegs
from emulator.registers.cell import Cell
from emulator.registers.core import ALL
from emulator.signals import AnalogWire

#: TRM: RRPOINTER when no round-robin SOC has been converted.
NO_POINTER: Final = 16
#: TRIGSEL of the hardware triggers, and of ADCEXTSOC, which is INPUT5 of the Input X-BAR.
TRIGSELS: Final = range(1, 29)
ADCEXTSOC: Final = 4


class Soc:
    """The decoded settings of one SOC.  They are updated at every write, so that a conversion decodes nothing."""

    __slots__ = ("adcint1", "bit", "channel", "converted_at", "cycles", "n", "pin", "result", "window")

    def __init__(self, n: int, pin: AnalogWire, result: Cell) -> None:
        self.pin, self.result = pin, result
        self.n: i64 = n
        self.bit: i64 = 1 << n
        self.channel: i64 = 0
        #: Cycles of the window, and cycles from its opening to the end of the conversion.
        self.window: i64 = 1
        self.cycles: i64 = 1
        #: The value of INT1E and INT1SEL if the EOC of this SOC drives ADCINT1, and nothing drives ADCINT2.
        self.adcint1: i64 = 0x20 | n
        #: When the last conversion ended; 0: never.
        self.converted_at: i64 = 0


class Socs:
    """SOC0..15 with their arbiter."""

    __slots__ = (
        "_any_write_resets", "_burst", "_converter", "_ctl", "_findings", "_obeying", "_overflows", "_pri",
        "_triggered", "before", "every", "high", "pending", "pointer", "settings",
    )  # fmt: skip

    def __init__(self, regs: AdcRegs, findings: Findings, converter: Converter, results: tuple[Cell, ...],
                 any_write_resets_pointer: bool) -> None:  # fmt: skip
        self._findings, self._converter = findings, converter
        self._any_write_resets = any_write_resets_pointer
        registers = regs.registers
        self._ctl = tuple(registers[f"ADCSOC{n}CTL"] for n in range(16))
        #: The statement that wrote ADCSOCnCTL last.
        self.settings: dict[int, Cause] = {}
        self.every = tuple(Soc(n, converter.pins[n], results[n]) for n in range(16))
        self._burst, self._pri = registers["ADCBURSTCTL"], registers["ADCSOCPRICTL"]
        self._overflows = registers["ADCSOCOVF1"]
        regs.bind("ADCSOCOVFCLR1", write=self._write_ADCSOCOVFCLR1)
        #: How many SOCs from SOC0 on have high priority; the others are converted in round robin.
        self.high = 0
        #: How many SOCs from SOC0 on obey their TRIGSEL, and TRIGSEL -> those that obey it.
        self._obeying = 16
        self._triggered: dict[int, int] = {}
        self.reset()

    def reset(self) -> None:
        """Clear all pending SOCs and reset RRPOINTER.  The owner resets the registers and calls `configure`."""
        #: SOCs that were triggered and have not got the S/H.
        self.pending = 0
        #: RRPOINTER, and as it was before the last `choose`.
        self.pointer: i64 = NO_POINTER
        self.before: i64 = NO_POINTER

    def configure(self) -> None:
        """Follow ADCSOCnCTL, ADCSOCPRICTL and ADCBURSTCTL; the converter has followed ADCCTL2."""
        pins, t_eoc = self._converter.pins, self._converter.t_eoc
        for soc, ctl in zip(self.every, self._ctl, strict=True):
            soc.channel = ctl.value >> 15 & 0xF
            soc.pin = pins[soc.channel]
            soc.window = (ctl.value & 0x1FF) + 1
            soc.cycles = soc.window + t_eoc
        self.high = self._pri.value & 0x1F
        # In burst mode only SOCs of high priority obey their TRIGSEL.
        self._obeying = min(self.high, 16) if self._burst.value & 0x8000 else 16
        self._triggered = {}
        for n, ctl in enumerate(self._ctl[: self._obeying]):
            trigsel = ctl.value >> 20 & 0x1F
            self._triggered[trigsel] = self._triggered.get(trigsel, 0) | 1 << n

    def triggered_by(self, trigsel: int) -> int:
        """The SOCs that a hardware trigger starts: those that select it; in burst mode the next round-robin SOCs."""
        socs = self._triggered.get(trigsel, 0)
        burst, low = self._burst.value, self._obeying
        if low < 16 and burst & 0x3F == trigsel:
            n = self.pointer
            for _ in range((burst >> 8 & 0xF) + 1):
                n = n + 1 if low <= n < 15 else low
                socs |= 1 << n
        return socs

    def obeyed(self) -> frozenset[int]:
        """The hardware triggers that can start any SOC."""
        burst = {self._burst.value & 0x3F} if self._obeying < 16 else set()
        return frozenset(self._triggered.keys() | burst).intersection(TRIGSELS)

    def add(self, socs: int) -> None:
        """Set pending flags.  Set ADCSOCOVF1 for a SOC that is still pending from an earlier trigger."""
        again = self.pending & socs
        self.pending |= socs
        if again:
            self._overflows.value |= again
            name = f"{self._overflows.path}.SOC{(again & -again).bit_length() - 1}"
            self._findings.report(
                "data-lost", f"{name}: triggered again before its conversion began: one conversion is lost", object=name
            )

    def choose(self) -> Soc:
        """Take the SOC that gets the S/H from those that wait (at least one)."""
        pending = self.pending
        self.before = pointer = self.pointer
        if not pending & pending - 1:
            n = pending.bit_length() - 1
            self.pending = 0
        else:
            first = pending & (1 << self.high) - 1
            if not first:
                later = pending >> pointer + 1 << pointer + 1 if pointer < 15 else 0
                first = later or pending
            n = (first & -first).bit_length() - 1
            self.pending = pending & ~(1 << n)
        if n >= self.high:
            self.pointer = n
        return self.every[n]

    def give_back(self, soc: Soc) -> None:
        """Undo the last `choose`: `soc` has not been sampled, so it is pending again."""
        self.pending |= 1 << soc.n
        self.pointer = self.before

    def write_ADCSOCxCTL(self, n: int, word: int, lanes: int = ALL) -> None:
        """Stores the word."""
        register = self._ctl[n]
        register.store(word, lanes)
        cause = self._findings.mark()
        if cause is not None:
            self.settings[n] = cause

    def write_ADCSOCPRICTL(self, word: int, lanes: int = ALL) -> None:
        """Stores the word; the reset word (or, as an option, any) returns RRPOINTER to 16."""
        self._pri.store(word, lanes)
        if self._any_write_resets or word == self._pri.reset_value:
            self.pointer = self.before = NO_POINTER

    def _write_ADCSOCOVFCLR1(self, word: int, lanes: int = ALL) -> None:
        self._overflows.value &= ~word
