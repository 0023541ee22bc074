"""A comparator subsystem (CMPSS): two comparators with a DAC each, a digital filter and a latch behind each.

Modelled: COMPCTL with inversion, both negative inputs and the four choices of CTRIPx and CTRIPOUTx; both 12-bit DACs
    with VDDA or VDAC, loaded at once or by EPWMSYNCPER; hysteresis; the digital filters (`cmpss_filter.py`); the
    latches, and their clearing by software and by EPWMSYNCPER; the ramp generator (`cmpss_ramp.py`); locks; software
    reset.
Not modelled: propagation delay and offset of the comparators, settling of the DACs, power-up (10 us), the two SYSCLK
    of synchronisation: the asynchronous and the synchronous level are the same.  A module without clock does not
    answer the CPU, and continues with its last settings.
Time: the positive input is a voltage that may change at any time.  CHOICE: it is compared when the wire reports a step
    and when a register of the module is accessed; while the comparators are on and an input is not steady, also every
    `compare_cycles` (1 us).  So the time of a crossing is known within that time, and a shorter pulse may be missed.
    The filter samples between two comparisons have the level of the last one.  With steady inputs, only filter and
    ramp have events, and these are exact.
CHOICE: while COMPDACE is 0 all outputs are low, inverted or not.
CHOICE: a comparator goes high above its negative input, and low when it is the hysteresis below it.  The hysteresis is
    COMPHYS times 12 of 4096 parts of the DAC's reference (DS, typical); COMPHYS above 4 counts as 4.
CHOICE: COMPHSTS that rises while EPWMSYNCPER starts the ramp stops the ramp one cycle later.
Sources: TRM CMPSS; DS CMPSS electrical characteristics; HDR F2837xS_cmpss.h.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.clock import NEVER, Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.cmpss_filter import DigitalFilter
from emulator.peripherals.cmpss_ramp import Ramp
from emulator.registers.cmpss import COMPCTL, COMPDACCTL, COMPSTSCLR, CmpssRegs
from emulator.registers.core import ALL
from emulator.signals import AnalogWire, Wire

#: Register -> its bit of COMPLOCK.
LOCKS: Final = {
    "COMPCTL": 1 << 0, "COMPHYSCTL": 1 << 1, "COMPDACCTL": 1 << 2,
    "CTRIPLFILCTL": 1 << 3, "CTRIPLFILCLKCTL": 1 << 3, "CTRIPHFILCTL": 1 << 3, "CTRIPHFILCLKCTL": 1 << 3,
}  # fmt: skip
CODES: Final = 4096
#: The typical hysteresis, in codes, and the most of them.
HYSTERESIS_CODES: Final = 12
MAX_HYSTERESIS: Final = 4
#: Cycles between two comparisons of a voltage that may change without a report.
COMPARE_CYCLES: Final = 200
#: The fields of the high comparator in COMPCTL; those of the low one lie 8 bits further up.
_SOURCE: Final = COMPCTL.COMPHSOURCE.mask
_INVERTED: Final = COMPCTL.COMPHINV.mask
_TRIP: Final = COMPCTL.CTRIPHSEL.lo
_TRIP_OUT: Final = COMPCTL.CTRIPOUTHSEL.lo
_ASYNCHRONOUS: Final = COMPCTL.ASYNCHEN.mask


class ComparatorChannel:
    """The high or the low comparator: its level before inversion, its filter and latch, its two outputs."""

    __slots__ = ("filter", "letter", "limit_v", "raw", "shift", "trip", "trip_out")

    def __init__(self, name: str, letter: str) -> None:
        self.letter = letter
        #: The shift of its fields in COMPCTL, COMPSTS and COMPSTSCLR.
        self.shift = 0 if letter == "H" else 8
        self.raw = 0
        #: Above it the comparator is high, as it is now, if its DAC and the registers stay as they are.
        self.limit_v = 0.0
        self.filter = DigitalFilter()
        self.trip = Wire(f"{name}.CTRIP{letter}")
        self.trip_out = Wire(f"{name}.CTRIPOUT{letter}")

    def put(self, control: int) -> None:
        """Update the outputs: filter and latch have new levels, or COMPCTL has changed."""
        control >>= self.shift
        level = self.filter.level
        latched = self.filter.latched | (level if control & _ASYNCHRONOUS else 0)
        choices = (level, level, self.filter.output, latched)
        self.trip.drive("CMPSS", choices[control >> _TRIP & 3])
        self.trip_out.drive("CMPSS", choices[control >> _TRIP_OUT & 3])


class Cmpss:
    """CMPSS`number` over its registers.

    `high` and `low` have the output wires.  `sync_listen(n, on)` is called when the module begins (or ceases) to need
    EPWMSYNCPER of ePWM `n`; each pulse must call `sync`.  `epwms` is the number of ePWMs.  References are in volts.
    `compare_cycles` may be changed.
    """

    __slots__ = (
        "_both",
        "_clock",
        "_control",
        "_epwms",
        "_event",
        "_findings",
        "_negative",
        "_positive",
        "_quiet",
        "_ramp",
        "_references_v",
        "_regs",
        "_sync_listen",
        "_sync_source",
        "compare_cycles",
        "high",
        "low",
    )  # fmt: skip

    def __init__(
        self, clock: Clock, cpu: Cpu, regs: CmpssRegs, positive: AnalogWire, negative: AnalogWire, *, number: int,
        vdda_v: float, vdac_v: float, sync_listen: Callable[[int, bool], None], epwms: int,
        compare_cycles: int = COMPARE_CYCLES,
    ) -> None:  # fmt: skip
        self._clock, self._findings, self._regs = clock, cpu.findings, regs
        self._positive, self._negative = positive, negative
        self._references_v = vdda_v, vdac_v
        self._sync_listen, self._epwms = sync_listen, epwms
        self.compare_cycles = compare_cycles
        self._control = regs.registers["COMPCTL"]
        self.high, self.low = ComparatorChannel(f"CMPSS{number}", "H"), ComparatorChannel(f"CMPSS{number}", "L")
        self._both = (self.high, self.low)
        self._ramp = Ramp()
        self._event: ClockEvent | None = None
        #: Whether only the positive input can change an output.
        self._quiet = False
        #: The ePWM whose EPWMSYNCPER the module needs; 0: none.
        self._sync_source = 0
        for name in LOCKS:
            regs.bind(name, write=partial(self._write_locked, name))
        regs.bind("COMPSTS", read=self._read_COMPSTS)
        regs.bind("COMPSTSCLR", write=self._write_COMPSTSCLR)
        for half in self._both:
            regs.bind(f"DAC{half.letter}VALS", write=partial(self._write_DACxVALS, half.letter))
        regs.bind("DACHVALA", read=self._read_DACHVALA)
        regs.bind("RAMPSTS", read=self._read_RAMPSTS)
        positive.stepped.connect(self._stepped)
        negative.stepped.connect(self._stepped)

    def reset(self) -> None:
        """Reset of the module (power-on, SOFTPRES14): off, all outputs low, nothing locked."""
        self._regs.reset()
        self._ramp.stand(0)
        for half in self._both:
            half.raw = 0
            half.filter.reset(self._clock.now)
        self._choose_sync()
        self._refresh()

    def sync(self) -> None:
        """A pulse of the EPWMSYNCPER that the module needs."""
        registers = self._regs.registers
        control = registers["COMPDACCTL"].value
        self._settle()
        if control & COMPDACCTL.SWLOADSEL.mask:
            self._load()
        if control & COMPDACCTL.DACSOURCE.mask:
            self._load_ramp()
            self._ramp.fall(
                self._clock.now, registers["RAMPMAXREFA"].value, registers["RAMPDECVALA"].value,
                registers["RAMPDLYA"].value,
            )  # fmt: skip
        clears = registers["COMPSTSCLR"].value
        if clears & COMPSTSCLR.HSYNCCLREN.mask:
            self.high.filter.clear()
        if clears & COMPSTSCLR.LSYNCCLREN.mask:
            self.low.filter.clear()
        self._refresh()

    # -- comparing -----------------------------------------------------------------------------------------------

    @property
    def _on(self) -> bool:
        return bool(self._control.value & COMPCTL.COMPDACE.mask)

    @property
    def _on_ramp(self) -> bool:
        """Whether the DAC of the high comparator gets its code from the ramp."""
        return bool(self._regs.registers["COMPDACCTL"].value & COMPDACCTL.DACSOURCE.mask)

    @property
    def _reference_v(self) -> float:
        return self._references_v[bool(self._regs.registers["COMPDACCTL"].value & COMPDACCTL.SELREF.mask)]

    def _code(self, half: ComparatorChannel, cycles: int) -> int:
        """The code of a comparator's DAC."""
        if half is self.high and self._on_ramp:
            return self._ramp.code(cycles)
        return self._regs.registers[f"DAC{half.letter}VALA"].value

    def _limit(self, half: ComparatorChannel, cycles: int) -> float:
        """The voltage above which a comparator is high before its inversion."""
        if self._control.value >> half.shift & _SOURCE:
            negative_v = self._negative.volts(cycles)
        else:
            negative_v = self._code(half, cycles) * self._reference_v / CODES
        if half.raw:
            steps = min(self._regs.registers["COMPHYSCTL"].value, MAX_HYSTERESIS)
            negative_v -= steps * HYSTERESIS_CODES * self._reference_v / CODES
        return negative_v

    def _settle(self) -> None:
        """Take the filter samples up to now, with the present levels of the comparators."""
        for half in self._both:
            half.filter.settle(self._clock.now)

    def _refresh(self) -> None:
        """Read the inputs, bring the filters up to now, and update the outputs."""
        now, control = self._clock.now, self._control.value
        on = bool(control & COMPCTL.COMPDACE.mask)
        volts = self._positive.volts(now) if on else 0.0
        status = self.high.filter.output
        for half in self._both:
            half.raw = int(volts > self._limit(half, now)) if on else 0
            inverted = on and control >> half.shift & _INVERTED
            half.filter.take(now, half.raw ^ 1 if inverted else half.raw)
        again = NEVER
        if self.high.filter.output and not status and self._ramp.running:
            registers = self._regs.registers
            shadow = registers["COMPDACCTL"].value & COMPDACCTL.RAMPLOADSEL.mask
            self._ramp.stand(registers["RAMPMAXREFS" if shadow else "RAMPMAXREFA"].value)
            # With that code the comparator looks again.
            again = now + 1
        for half in self._both:
            half.put(control)
        self._arrange(again)

    def _arrange(self, time: int) -> None:
        """Schedule one event at the next cycle when something may change (at `time` at the latest), if anything can."""
        if self._event is not None:
            self._clock.cancel(self._event)
            self._event = None
        now, self._quiet = self._clock.now, False
        for half in self._both:
            time = min(time, half.filter.next_change())
        if self._on:
            by_pin = self._control.value & (_SOURCE | _SOURCE << self.low.shift)
            falls = self._ramp.running and self._on_ramp
            if not self._positive.steady or (by_pin and not self._negative.steady):
                self._quiet = time == NEVER and not by_pin and not falls
                time = min(time, now + self.compare_cycles)
            elif falls:
                time = min(time, self._crossing())
        if self._quiet:
            for half in self._both:
                half.limit_v = self._limit(half, now)
        if time < NEVER:
            self._event = self._clock.schedule(time, self._due)

    def _crossing(self) -> int:
        """The cycle when the falling ramp next changes the high comparator, with steady inputs; NEVER: it does not."""
        now, high = self._clock.now, self.high
        volts, late = self._positive.volts(now), max(self._ramp.end, now)
        if high.raw or volts <= self._limit(high, late):
            return NEVER
        early = now
        while late - early > 1:
            middle = (early + late) // 2
            if volts > self._limit(high, middle):
                late = middle
            else:
                early = middle
        return late

    def _due(self) -> None:
        self._event = None
        if self._quiet:
            volts = self._positive.volts(self._clock.now)
            high, low = self.high, self.low
            if (volts > high.limit_v) == high.raw and (volts > low.limit_v) == low.raw:
                self._event = self._clock.after(self.compare_cycles, self._due)
                return
        self._refresh()

    def _stepped(self) -> None:
        """Another source drives one of the inputs."""
        if self._on:
            self._refresh()

    # -- registers -----------------------------------------------------------------------------------------------

    def _load(self) -> None:
        """The codes of the shadow registers become active."""
        registers = self._regs.registers
        for half in self._both:
            registers[f"DAC{half.letter}VALA"].value = registers[f"DAC{half.letter}VALS"].value

    def _load_ramp(self) -> None:
        registers = self._regs.registers
        for name in ("RAMPMAXREF", "RAMPDECVAL", "RAMPDLY"):
            registers[f"{name}A"].value = registers[f"{name}S"].value

    def _choose_sync(self) -> None:
        """Listen to the EPWMSYNCPER that RAMPSOURCE names, if it has any effect."""
        registers = self._regs.registers
        control, clears = registers["COMPDACCTL"].value, registers["COMPSTSCLR"].value
        wanted = control & (COMPDACCTL.SWLOADSEL.mask | COMPDACCTL.DACSOURCE.mask)
        wanted |= clears & (COMPSTSCLR.HSYNCCLREN.mask | COMPSTSCLR.LSYNCCLREN.mask)
        source = 1 + ((control & COMPDACCTL.RAMPSOURCE.mask) >> COMPDACCTL.RAMPSOURCE.lo) if wanted else 0
        if source > self._epwms:
            path = f"{registers['COMPDACCTL'].path}.RAMPSOURCE"
            self._findings.report(
                "unmodelled", f"{path} = {source - 1} names no ePWM (they are 0 to {self._epwms - 1}): no pulse comes",
                object=path, value=source - 1,
            )  # fmt: skip
            source = 0
        if source != self._sync_source:
            before, self._sync_source = self._sync_source, source
            if before:
                self._sync_listen(before, False)
            if source:
                self._sync_listen(source, True)

    def _write_locked(self, name: str, word: int, lanes: int = ALL) -> None:
        registers = self._regs.registers
        register = registers[name]
        if registers["COMPLOCK"].value & LOCKS[name]:
            message = f"{register.path} is locked by COMPLOCK: the write was dropped"
            self._findings.report("locked", message, object=register.path, value=word)
            return
        self._refresh()
        before = register.value
        register.store(word, lanes)
        if name == "COMPDACCTL":
            self._write_COMPDACCTL(before, register.value)
        elif name.startswith("CTRIP"):
            self._write_filter(self.high if name[5] == "H" else self.low, name, word)
        self._refresh()

    def _write_COMPDACCTL(self, before: int, after: int) -> None:
        if not after & COMPDACCTL.SWLOADSEL.mask:
            self._load()
        source = COMPDACCTL.DACSOURCE.mask
        if after & source and not before & source:
            self._load_ramp()
            self._ramp.stand(self._regs.registers["RAMPMAXREFA"].value)
        self._choose_sync()

    def _write_filter(self, half: ComparatorChannel, name: str, word: int) -> None:
        digital, value = half.filter, self._regs.registers[name].value
        if name.endswith("FILCLKCTL"):
            digital.set_period(self._clock.now, value + 1)
            return
        digital.configure(window=1 + (value >> 4 & 0x1F), threshold=1 + (value >> 9 & 0x1F))
        if word >> 15 & 1:
            digital.initialise()

    def _write_DACxVALS(self, letter: str, word: int, lanes: int = ALL) -> None:
        registers = self._regs.registers
        self._settle()
        registers[f"DAC{letter}VALS"].store(word, lanes)
        if not registers["COMPDACCTL"].value & COMPDACCTL.SWLOADSEL.mask:
            self._load()
            self._refresh()

    def _write_COMPSTSCLR(self, word: int, lanes: int = ALL) -> None:
        self._refresh()
        self._regs.registers["COMPSTSCLR"].store(word, lanes)
        if word & COMPSTSCLR.HLATCHCLR.mask:
            self.high.filter.clear()
        if word & COMPSTSCLR.LLATCHCLR.mask:
            self.low.filter.clear()
        self._choose_sync()
        self._refresh()

    def _read_COMPSTS(self) -> int:
        self._refresh()
        status = self._regs.registers["COMPSTS"]
        status.value = sum((half.filter.output | half.filter.latched << 1) << half.shift for half in self._both)
        return status.value

    def _read_DACHVALA(self) -> int:
        return self._code(self.high, self._clock.now)

    def _read_RAMPSTS(self) -> int:
        return self._ramp.value(self._clock.now)
