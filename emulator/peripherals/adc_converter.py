"""The analog half of an ADC module: it converts the voltage of a pin to a code, with the times of the data sheet.

Modelled: the transfer functions of 12-bit single-ended and 16-bit differential conversions (the two combinations that
are not supported use the same formulas); clamping; noise in LSB; the meaningless codes of a core without power; codes
that a test forces or a fault changes.
Not modelled: gain, offset and linearity errors, settling of the sampling capacitor.
Time: none of its own; the caller gives the cycle at which the sample is taken.
Sources: DS ADC timing tables and electrical characteristics; TRM ADC.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from random import Random
from typing import Final

from emulator.c28x.findings import Cause, Findings
from emulator.noise import Gaussian
from emulator.signals import AnalogWire

#: DS ADC timing: tEOC, tLAT in SYSCLK after the window, by PRESCALE.  1 is an invalid divider (CHOICE: as 0).
TIMING_12_BIT: Final = (
    (11, 13), (11, 13), (21, 23), (26, 28), (31, 34), (36, 39), (41, 44), (46, 49),
    (51, 55), (56, 60), (61, 65), (66, 70), (71, 76), (76, 81), (81, 86), (86, 91),
)  # fmt: skip
TIMING_16_BIT: Final = (
    (31, 32), (31, 32), (60, 61), (75, 75), (90, 91), (104, 106), (119, 120), (134, 134),
    (149, 150), (163, 165), (178, 179), (193, 193), (208, 209), (222, 224), (237, 238), (252, 252),
)  # fmt: skip
#: DS: shortest window, 75 ns for 12 bits and 320 ns for 16, as ACQPS.
ACQPS_MIN_12_BIT: Final = 14
ACQPS_MIN_16_BIT: Final = 63
#: DS: ADCCLK is at most 50 MHz, so at 200 MHz the divider is at least 4.
PRESCALE_MIN: Final = 6
#: An `acqps_min` that no window reaches, so that every conversion is checked.
ALWAYS: Final = 512


class Converter:
    """Reference, noise and forced codes of one ADC.  Voltages in volts, noise in LSB rms."""

    __slots__ = ("_ctl2", "_faults", "_forced", "_random", "_vrefhi_v",
                 "acqps_min", "busy_cycles", "differential", "full_scale", "name", "noise", "noise_lsb",
                 "pins", "plain", "span_v", "t_eoc", "t_lat", "vreflo_v")  # fmt: skip

    def __init__(self, name: str, pins: Sequence[AnalogWire], vrefhi_v: float, vreflo_v: float, noise_lsb: float,
                 random: Random | None) -> None:  # fmt: skip
        """Raises ValueError for a wrong number of pins, a reference that is not positive, or noise without `random`."""
        if len(pins) != 16:
            raise ValueError(f"{name}: {len(pins)} pins: expected the 16 of ADCIN0..15")
        if vrefhi_v <= vreflo_v:
            raise ValueError(f"{name}: VREFHI {vrefhi_v} V must lie above VREFLO {vreflo_v} V")
        if noise_lsb < 0 or (noise_lsb > 0 and random is None):
            raise ValueError(f"{name}: noise of {noise_lsb} LSB: expected 0 or more, and a random.Random above 0")
        self.name = name
        self.pins = tuple(pins)
        self._vrefhi_v, self.vreflo_v, self.span_v = vrefhi_v, vreflo_v, vrefhi_v - vreflo_v
        self.noise_lsb, self._random = noise_lsb, random or Random(0)
        #: The noise of each code.
        self.noise = Gaussian(self._random)
        self._forced: Callable[[int], int] | None = None
        #: Injected faults.  Each returns the new code for (soc, channel, code).
        self._faults: tuple[Callable[[int, int, int], int], ...] = ()
        self.configure(0)

    def configure(self, ctl2: int) -> None:
        """Follow ADCCTL2: resolution, signal mode and times."""
        self._ctl2 = ctl2
        prescale, bits16 = ctl2 & 0xF, bool(ctl2 & 0x40)
        self.differential = bool(ctl2 & 0x80)
        self.full_scale = 65536 if bits16 else 4096
        self.t_eoc, self.t_lat = (TIMING_16_BIT if bits16 else TIMING_12_BIT)[prescale]
        # TRM: busy lasts 4 ADCCLK beyond the window; the divider is 1 for 0 and 1, else (PRESCALE + 2)/2.
        self.busy_cycles = 4 if prescale < 2 else 2 * (prescale + 2)
        self.acqps_min = ACQPS_MIN_16_BIT if bits16 else ACQPS_MIN_12_BIT
        if prescale < PRESCALE_MIN or self.differential != bits16:
            self.acqps_min = ALWAYS
        self._simplify()

    def _simplify(self) -> None:
        """Determine whether a code is just the scaled voltage of one pin plus noise."""
        self.plain = self._forced is None and not self.differential and not self._faults

    def inject_fault(self, by: Callable[[int, int, int], int]) -> None:
        """Replace each code by `by(soc, channel, code)` from now on, after the faults that are active already."""
        self._faults = (*self._faults, by)
        self._simplify()

    def remove_fault(self, by: Callable[[int, int, int], int]) -> None:
        """Remove a fault that `inject_fault` has added."""
        self._faults = tuple(each for each in self._faults if each is not by)
        self._simplify()

    def check_use(
        self, findings: Findings, soc: int, acqps: int, powered: bool, *, prescale_by: Cause | None,
        mode_by: Cause | None,
    ) -> None:  # fmt: skip
        """Report errors that spoil the conversion that begins and that no chip detects.

        `prescale_by` and `mode_by`: the statements that chose the clock, and resolution and signal mode; None: none.
        """
        name, ctl2 = f"{self.name}.ADCSOC{soc}CTL", f"{self.name}.ADCCTL2"
        bits16 = bool(self._ctl2 & 0x40)
        shortest = ACQPS_MIN_16_BIT if bits16 else ACQPS_MIN_12_BIT
        prescale = self._ctl2 & 0xF
        if not powered:
            findings.report("adc-not-powered", f"{name}: conversion begun before 500 us with ADCPWDNZ = 1: the result "
                            "is garbage", object=name)  # fmt: skip
        if acqps < shortest:
            findings.report("adc-window", f"{name}.ACQPS = {acqps} is too short a window: {shortest} at least",
                            object=name, value=acqps)  # fmt: skip
        if prescale < PRESCALE_MIN:
            findings.report("adc-clock", f"{ctl2}.PRESCALE = {prescale} makes ADCCLK too fast (50 MHz): {PRESCALE_MIN} "
                            "at least", object=ctl2, value=prescale, cause=prescale_by)  # fmt: skip
        if self.differential != bits16:
            findings.report("adc-mode", f"{ctl2}: only 12 bits single-ended and 16 bits differential work",
                            object=ctl2, value=self._ctl2, cause=mode_by)  # fmt: skip

    def force_codes(self, codes: Iterable[int] | Callable[[int], int] | None) -> None:
        """Yield `codes` (16 bits) whatever the volts: in order, or `codes(soc)`.  None: volts again."""
        if codes is None or callable(codes):
            self._forced = codes
            self._simplify()
            return
        rest: Iterator[int] = iter(codes)

        def take(soc: int) -> int:
            code = next(rest, None)
            if code is None:
                raise ValueError(f"{self.name}: no forced code is left for the conversion of SOC{soc}")
            return code

        self._forced = take
        self._simplify()

    def code(self, soc: int, channel: int, cycles: int, powered: bool) -> int:
        """The code of `channel` as it stood at `cycles`."""
        code = self._fault_free_code(soc, channel, cycles, powered)
        for inject_fault in self._faults:
            code = inject_fault(soc, channel, code)
        return code

    def _fault_free_code(self, soc: int, channel: int, cycles: int, powered: bool) -> int:
        """The code of a converter without injected faults."""
        if self._forced is not None:
            return self._forced(soc) & 0xFFFF
        if not powered:
            # CHOICE: an unpowered core gives a random (seeded) code; the manual is silent.
            return self._random.randrange(self.full_scale)
        if self.differential:
            # CHOICE: the formula of sister parts, unconfirmed here.
            plus = self.pins[channel & 14].source.volts(cycles)
            minus = self.pins[channel | 1].source.volts(cycles)
            level = self.full_scale * (plus - minus + self._vrefhi_v) / (2 * self._vrefhi_v)
        else:
            level = self.full_scale * (self.pins[channel].source.volts(cycles) - self.vreflo_v) / self.span_v
        if self.noise_lsb:
            level += self.noise.value(self.noise_lsb)
        if level <= 0.0:
            return 0
        code = int(level)
        return code if code < self.full_scale else self.full_scale - 1
