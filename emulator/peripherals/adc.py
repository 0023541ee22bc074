"""One ADC module: SOCs, arbiter, sample and hold, interrupt flags, results.

Modelled: triggers by software, by hardware (`trigger`), by an interrupt (ADCINTSOCSEL) and in bursts; pending and
overflow flags; high priority, and round robin with the RRPOINTER, which keeps its value; sample window; tINT, tEOC and
tLAT for 12 and 16 bits; ADCINTFLG, which stays set until it is cleared, ADCINTOVF, INTxCONT, INTPULSEPOS; power-up
time; clock gating (everything freezes); the post-processing blocks (`adc_ppb.py`); as an option, the erratum of a flag
that is cleared in the cycle that sets it.  What no chip detects is a finding: a window that is too short, an ADCCLK
that is too fast, an unsupported mode, a core without power.
Not modelled: ADCOSDETECT, trims, ADCREV, events to the trip zones.  They are declared, and touching one is reported.
Reported as well: a read of a result while its SOC waits or converts.  The result is then that of an earlier
conversion.  After a hardware trigger this is normal use: the program takes the latest result at any time.  After a
software force it is a defect.
Time: the window opens `sync_cycles` after a trigger that finds the S/H free, or when the conversion before ends.  It
lasts ACQPS + 1 SYSCLK.  Each conversion has one clock event, at its end; with INTPULSEPOS = 0 it has one more, at the
early pulse.  Pending flags, busy, counter and the latch of the result need no events: they are computed when they are
read.  The voltage of the pin at the end of the window is read once the conversion has ended, up to 252 cycles later.
So a source must give the voltage of the time that it is asked for.
Sources: DS ADC timing tables; TRM ADC; ERR ADC interrupts; HDR F2837xS_adc.h.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from random import Random
from typing import Final, Literal

from mypy_extensions import i64

from emulator.c28x.findings import Cause
from emulator.c28x.sites import Place
from emulator.clock import CYCLES_PER_US, NEVER, Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.adc_converter import Converter
from emulator.peripherals.adc_ppb import PostProcessing
from emulator.peripherals.adc_socs import TRIGSELS, Soc, Socs
from emulator.registers.adc import AdcRegs, AdcResultRegs
from emulator.registers.cell import Cell
from emulator.registers.core import ALL
from emulator.registers.hook import Hook
from emulator.signal import Signal
from emulator.signals import AnalogWire

#: TRM: the analog core needs 500 us after ADCPWDNZ = 1.
POWER_UP_CYCLES: Final = 500 * CYCLES_PER_US
#: ADCCTL1
ADCPWDNZ: Final = 0x0080
#: INT1E and INT1SEL of ADCINTSEL1N2; INT2 lies 8 bits higher.
ENABLE: Final = 0x20
SELECT: Final = 0x0F
#: The options for what ADCINTFLGCLR does in the cycle of the EOC.
Collision = Literal["cleared", "erratum", "overflow"]


class Adc:
    """ADC behaviour over its registers.

    `pins` are ADCIN0..15, `interrupts` the pulses ADCINT1..4 to the PIE, `event` that of ADCxEVT.  References in volts;
    noise in LSB rms.
    """

    __slots__ = (
        "_acqps_min",
        "_adcint1",
        "_at_end",
        "_at_pulse",
        "_awaited",
        "_begun",
        "_by_hardware",
        "_cause",
        "_clock",
        "_code",
        "_collision",
        "_converter",
        "_cpu",
        "_ctl1",
        "_ctl2",
        "_eoc_is_plain",
        "_epoch",
        "_event",
        "_extra_work_socs",
        "_findings",
        "_flag_at",
        "_flags_then",
        "_forced",
        "_frozen_at",
        "_full_scale",
        "_interrupts",
        "_intflg",
        "_intovf",
        "_intsel12",
        "_intsel34",
        "_last_soc",
        "_latch",
        "_latch_at",
        "_latch_delay",
        "_latched",
        "_late",
        "_left_by",
        "_mode_by",
        "_noise",
        "_noise_lsb",
        "_notes_collisions",
        "_obeyed",
        "_overflows_then",
        "_plain_from",
        "_position",
        "_ppb",
        "_prescale_by",
        "_pulses",
        "_reads",
        "_ready",
        "_ready_at",
        "_regs",
        "_result_regs",
        "_results",
        "_routine",
        "_sample",
        "_sel_then",
        "_selected",
        "_soc",
        "_socs",
        "_socsel1",
        "_socsel2",
        "_span_v",
        "_start",
        "_stopped_by_fault",
        "_stopping_faults",
        "_sync_cycles",
        "_t_eoc",
        "_trigger_changed",
        "_unlatched",
        "_vreflo_v",
        "conversions",
        "pulsed",
    )  # fmt: skip

    def __init__(self, clock: Clock, cpu: Cpu, regs: AdcRegs, results: AdcResultRegs, pins: Sequence[AnalogWire],
                 interrupts: Sequence[Callable[[], None]], event: Callable[[], None] = lambda: None, *,
                 vrefhi_v: float = 3.0, vreflo_v: float = 0.0, noise_lsb: float = 0.0, random: Random | None = None,
                 sync_cycles: int = 2, any_write_resets_pointer: bool = False, flag_collision: Collision = "cleared",
                 left_by: Callable[[int], Place | None] = lambda n: None,
                 routine: Callable[[int], Place | None] = lambda n: None,
                 awaited: Callable[[int], bool] = lambda n: True,
                 selected: Callable[[int], Cause | None] = lambda n: None,
                 trigger_changed: Callable[[int, bool], None] = lambda _trigsel, _on: None) -> None:  # fmt: skip
        """Raises ValueError for wrong numbers of pins or interrupts, a reference that is not positive, bad noise.

        CHOICE, as the manual is silent: `vrefhi_v` 3.0 V on the LaunchPad; `sync_cycles` from trigger to window;
        `any_write_resets_pointer` (False: only the reset word written to ADCSOCPRICTL returns RRPOINTER to 16).
        `flag_collision`: what ADCINTFLGCLR does in the cycle of the EOC: `erratum` leaves the flag set (ERR),
        `overflow` clears it and sets ADCINTOVF (TRM), `cleared` only clears it (CHOICE: the default, because the CPU is
        charged a block of statements at a time, so that one cycle of its time means little).
        `routine(n)` returns where the routine of ADCINT(n+1) is in the source, and so does `left_by(n)` if that has run
        since the last pulse.
        `awaited(n)` tells whether anything uses that interrupt.  `selected(n)` returns the statement that has given it
        to the DMA, if only the DMA uses it.
        `trigger_changed(trigsel, on)` is called when that hardware trigger begins (or ceases) to start conversions.
        """
        if len(interrupts) != 4:
            raise ValueError(f"{regs.name}: {len(interrupts)} interrupts: expected the 4 pulses ADCINT1..4")
        self._clock, self._cpu, self._findings, self._position = clock, cpu, cpu.findings, cpu.position
        self._regs, self._result_regs = regs, results
        registers = regs.registers
        #: ADCINT1 to 4 and ADCxEVT, for listeners besides the PIE.
        self.pulsed: tuple[Signal[[]], ...] = tuple(Signal(partial(self._listener_changed, n)) for n in range(5))
        self._interrupts = (*interrupts, event)
        #: The function that a pulse calls: the PIE's input itself, as long as nothing else listens.
        self._pulses, self._adcint1 = list(self._interrupts), interrupts[0]
        self._left_by, self._routine, self._awaited, self._selected = left_by, routine, awaited, selected
        self._collision, self._notes_collisions = flag_collision, flag_collision != "cleared"
        self._intflg, self._intovf = registers["ADCINTFLG"], registers["ADCINTOVF"]
        self._intsel12, self._intsel34 = registers["ADCINTSEL1N2"], registers["ADCINTSEL3N4"]
        self._socsel1, self._socsel2 = registers["ADCINTSOCSEL1"], registers["ADCINTSOCSEL2"]
        self._results = tuple(results.registers[f"ADCRESULT{n}"] for n in range(16))
        self._reads = tuple(_AdcResult(self, clock, n, register) for n, register in enumerate(self._results))
        for n, hook in enumerate(self._reads):
            results.bind(f"ADCRESULT{n}", read=hook)
        self._ppb = PostProcessing(
            clock, cpu, regs, results, partial(self._pulse, 4), self._configure, self._result_of_soc0
        )  # fmt: skip
        self._at_end, self._at_pulse = _AtEnd(self), ClockEvent(self._early)
        #: The statement that forced the conversions under way, in the same object each time: `Findings.mark` would make
        #: a new one, 2 % of a mission.
        self._forced = Cause()
        self._cause: Cause | None = None
        self._converter = converter = Converter(regs.name, pins, vrefhi_v, vreflo_v, noise_lsb, random)
        self._vreflo_v, self._span_v = converter.vreflo_v, converter.span_v
        self._noise_lsb, self._noise = converter.noise_lsb, converter.noise
        self._sync_cycles: i64 = sync_cycles
        self._stopped_by_fault = False
        self._stopping_faults = 0
        self._trigger_changed = trigger_changed
        #: The hardware triggers that start a conversion.
        self._obeyed: frozenset[int] = frozenset()
        #: Conversions ended since the object was made.
        self.conversions: i64 = 0
        self._socs = Socs(regs, cpu.findings, converter, self._results, any_write_resets_pointer)
        #: The SOCs that begin at once if they are forced while no conversion is under way.
        self._ready: list[Soc] = []
        self._ctl1, self._ctl2 = registers["ADCCTL1"], registers["ADCCTL2"]
        for name, read, write in (
            ("ADCCTL1", self._read_ADCCTL1, self._write_ADCCTL1),
            ("ADCCTL2", None, self._write_ADCCTL2),
            ("ADCSOCPRICTL", self._read_ADCSOCPRICTL, self._write_ADCSOCPRICTL),
            ("ADCSOCFLG1", self._read_ADCSOCFLG1, None),
            ("ADCSOCFRC1", None, _Force(self)),
            ("ADCCOUNTER", self._read_ADCCOUNTER, None),
            ("ADCINTFLGCLR", None, self._write_ADCINTFLGCLR if self._notes_collisions else None),
            ("ADCINTOVFCLR", None, self._write_ADCINTOVFCLR),
        ):
            regs.bind(name, read=read, write=write)
        for register in (registers["ADCBURSTCTL"], self._intsel34, self._socsel1, self._socsel2):
            regs.bind(register.name, write=partial(self._write_configuration, register))
        for n in range(16):
            regs.bind(f"ADCSOC{n}CTL", write=partial(self._write_ADCSOCxCTL, n))
        regs.bind("ADCREV", read=self._read_ADCREV)
        #: The step of the conversion under way that is next, `_at_pulse` or `_at_end`.
        self._event: ClockEvent | None = None
        self.reset()

    def reset(self) -> None:
        """Reset of the module (power-on, SOFTPRES13): registers, RRPOINTER, conversion under way.

        CHOICE: results read 0 after reset, unconfirmed.
        """
        self._clock.cancel(self._event)
        self._event = None
        self._regs.reset()
        self._result_regs.reset()
        #: The register that the last conversion gave reads `_unlatched` until `_latch_at`; then another conversion may
        #: be under way, `_latch_at` is NEVER and it reads so until `_latched`.
        self._latch: Cell | None = None
        self._latch_at: i64 = 0
        self._latched: i64 = 0
        self._unlatched: i64 = 0
        #: SOCs that hardware or another conversion triggered.
        self._by_hardware = 0
        for hook in self._reads:
            hook.begun = False
        #: The cycle when a flag rose last, and the flags that this cycle has set.
        self._flag_at = self._flags_then = self._overflows_then = -1
        self._socs.reset()
        self._ppb.reset()
        #: The statements that chose the clock, and resolution and signal mode.
        self._prescale_by: Cause | None = None
        self._mode_by: Cause | None = None
        self._begun = 0  # SOCs that have begun a conversion
        self._extra_work_socs = 0xFFFF  # SOCs of which more is to be done when they begin: see `_extra_work`
        self._soc = self._last_soc = self._socs.every[0]
        self._start: i64 = 0
        self._sample: i64 = 0
        self._code: int | None = None  # sampled by an early pulse, not ended yet
        self._sel_then: i64 = 0  # ADCINTSEL1N2 when the conversion under way began
        self._epoch = self._clock.now
        self._ready_at: i64 = NEVER
        self._frozen_at: int | None = None if self._regs.clocked else self._clock.now
        self._configure()

    # --- for the world and tests ---------------------------------------------------------------------------------

    def force_codes(self, codes: Iterable[int] | Callable[[int], int] | None) -> None:
        """Make conversions yield `codes` (16 bits) whatever the volts: in order, or `codes(soc)`.  None: volts again.

        The conversion after the last code of a finite sequence raises ValueError.
        """
        self._converter.force_codes(codes)
        self._configure()

    def converted_at(self, soc: int) -> int:
        """When the last conversion of an SOC (0..15) ended; 0: never."""
        return self._socs.every[soc].converted_at

    def inject_fault(self, by: Callable[[int, int, int], int]) -> Callable[[], None]:
        """Inject a fault: each code becomes `by(soc, channel, code)`.  Returns a function that ends the fault."""
        self._converter.inject_fault(by)
        self._configure()
        return partial(self._remove_fault, by)

    def _remove_fault(self, by: Callable[[int, int, int], int]) -> None:
        self._converter.remove_fault(by)
        self._configure()

    def stop_converting(self) -> Callable[[], None]:
        """Stop the converter until the returned function is called; after several calls, all of theirs."""
        self._stopping_faults += 1
        self.stopped_by_fault = True

        def resume() -> None:
            self._stopping_faults -= 1
            self.stopped_by_fault = self._stopping_faults > 0

        return resume

    @property
    def stopped_by_fault(self) -> bool:
        """Whether the converter is broken: SOCs stay pending and no conversion ends.  Afterwards the SOCs go on."""
        return self._stopped_by_fault

    @stopped_by_fault.setter
    def stopped_by_fault(self, stopped_by_fault: bool) -> None:
        if stopped_by_fault == self._stopped_by_fault:
            return
        self._stopped_by_fault = stopped_by_fault
        if stopped_by_fault and self._event is not None:
            self._clock.cancel(self._event)
            self._event = self._code = None
            self._socs.give_back(self._soc)
            self._configure()
            return
        self._configure()
        if not stopped_by_fault and self._socs.pending and self._frozen_at is None:
            self._begin(self._clock.now + self._sync_cycles)

    # --- triggers ------------------------------------------------------------------------------------------------

    def trigger(self, trigsel: int) -> None:
        """A hardware trigger (TRIGSEL 1..28: CPU timers, ADCEXTSOC, ePWMn SOCA and SOCB).  ValueError for others."""
        if trigsel not in TRIGSELS:
            raise ValueError(f"{self._regs.name}: hardware trigger {trigsel}: expected 1..28")
        if self._frozen_at is not None:
            return
        socs = self._socs.triggered_by(trigsel)
        if socs:
            self._request_by_hardware(socs)

    def _request_by_hardware(self, socs: int) -> None:
        self._cause = None
        self._by_hardware |= socs
        watched = socs & self._ppb.watched
        if watched:
            self._ppb.requested(watched, self._read_ADCCOUNTER())
            self._extra_work_socs |= watched
        self._request(socs)

    def set_clock(self, on: bool) -> None:
        """PCLKCR13 switched the clock: off freezes counter and conversion, on lets them go on."""
        now = self._clock.now
        if not on and self._frozen_at is None:
            self._frozen_at = now
            self._clock.cancel(self._event)
        elif on and self._frozen_at is not None:
            gap = now - self._frozen_at
            self._frozen_at = None
            self._epoch += gap
            self._start += gap
            self._sample += gap
            self._latched += gap
            if self._latch_at != NEVER:
                self._latch_at += gap
            self._ppb.freeze(gap)
            if self._event is not None:
                self._clock.start(self._event, self._event.time + gap)

    def _request(self, socs: int) -> None:
        """Set pending flags and let the arbiter look."""
        if self._event is None:
            self._socs.add(socs)
            if self._stopped_by_fault:
                self._still_latching()
            else:
                self._begin(self._clock.now + self._sync_cycles)
        elif self._clock.now < self._start:
            # The window has not opened.  So its SOC is still pending, and the arbiter has not chosen yet.
            self._socs.give_back(self._soc)
            self._socs.add(socs)
            self._soc = self._last_soc
            self._clock.cancel(self._event)
            self._begin(self._start)
        else:
            self._socs.add(socs)

    def _begin(self, start: i64) -> None:
        """The arbiter gives the S/H to a pending SOC: its window opens at `start`."""
        soc = self._socs.choose()
        n = soc.n
        if soc.window <= self._acqps_min or start < self._ready_at:
            self._check_use(n, soc.window - 1, start >= self._ready_at)
        if self._extra_work_socs >> n & 1:
            self._extra_work(n, start)
        self._last_soc = self._soc
        self._soc = soc
        self._sel_then = self._intsel12.value
        self._still_latching()
        self._start = start
        self._sample = sample = start + soc.window
        if self._late:
            self._event = self._at_end
            self._clock.start(self._at_end, start + soc.cycles)
        else:
            self._event = self._at_pulse
            self._clock.start(self._at_pulse, sample + 1)

    def _extra_work(self, n: int, start: int) -> None:
        """Extra work when SOC `n` begins: its first conversion, or the delay stamp of its hardware trigger."""
        soc = 1 << n
        if not self._begun & soc:
            self._begun |= soc
            self._reads[n].begun = True
            self._configure()
        if soc & self._by_hardware & self._ppb.watched:
            self._ppb.begins(n, start - self._epoch & 0xFFF)
        else:
            self._extra_work_socs &= ~soc

    def _check_use(self, n: int, acqps: int, powered: bool) -> None:
        """Report doubts about a conversion at the statement that forced it.

        A hardware trigger has no statement.  Then the place is the write to ADCSOCxCTL.  A wrong clock or mode has the
        statement that chose it, if one did.
        """
        findings = self._findings
        by_hardware = self._by_hardware >> n & 1
        findings.cause = self._socs.settings.get(n) if by_hardware else self._cause
        try:
            self._converter.check_use(
                findings, n, acqps, powered, prescale_by=self._prescale_by, mode_by=self._mode_by
            )
        finally:
            findings.cause = None

    # --- timed events --------------------------------------------------------------------------------------------

    def _early(self) -> None:
        """One SYSCLK after the window: with INTPULSEPOS = 0 the flag rises here."""
        soc = self._soc
        self._code = self._converter.code(soc.n, soc.channel, self._sample, self._start >= self._ready_at)
        # Do it before the flags, so that a SOC that they trigger finds the conversion under way.
        self._event = self._at_end
        self._clock.start(self._at_end, self._sample + self._t_eoc)
        self._eoc(soc.n, self._sel_then)

    def _end(self) -> None:
        """tEOC: the conversion has ended, the S/H is free, the result will latch at tLAT."""
        findings = self._findings
        findings.cause = self._cause  # what the pin's device reports belongs to the force
        try:
            soc = self._soc
            self._latch = result = soc.result
            self._latch_at = self._clock.now + self._latch_delay
            self._unlatched = result.value
            self.conversions += 1
            soc.converted_at = self._clock.now
            if self._code is not None:
                result.value = self._processed(soc.n, self._code)
                self._code = None
            else:
                if self._start >= self._plain_from:
                    full_scale = self._full_scale
                    level = full_scale * (soc.pin.source.volts(self._sample) - self._vreflo_v) / self._span_v
                    if self._noise_lsb:
                        level += self._noise.value(self._noise_lsb)
                    result.value = int(level if level < full_scale else full_scale - 1.0) if level > 0.0 else 0
                else:
                    powered = self._start >= self._ready_at
                    code = self._converter.code(soc.n, soc.channel, self._sample, powered)
                    result.value = self._processed(soc.n, code)
                flags = self._intflg
                if self._eoc_is_plain and self._intsel12.value & 0x202F == soc.adcint1 and not flags.value & 1:
                    flags.value |= 1  # the EOC drives ADCINT1 and nothing else
                    pulse = self._adcint1
                    pulse()
                else:
                    self._eoc(soc.n, self._sel_then)
            if self._socs.pending:
                self._begin(self._clock.now)
            else:
                self._event = None
        finally:
            findings.cause = None

    def _processed(self, n: int, code: int) -> int:
        """The result that the post-processing blocks make from the code of SOC `n`."""
        return self._ppb.process(n, code, self._converter.full_scale, self._latch_at) if self._ppb.in_use else code

    def _configure(self) -> None:
        """Follow the registers that configure conversions."""
        converter = self._converter
        converter.configure(self._ctl2.value)
        self._t_eoc = converter.t_eoc
        self._latch_delay: i64 = converter.t_lat - converter.t_eoc
        self._acqps_min = converter.acqps_min
        self._late = bool(self._ctl1.value & 0x0004)
        #: A float, because the voltage is one: comparing an int with a float takes twice as long.
        self._full_scale = float(converter.full_scale)
        #: A window that opens at this cycle or later yields the scaled voltage of its pin.
        self._plain_from: i64 = self._ready_at if converter.plain and not self._ppb.in_use else NEVER
        #: Whether an EOC drives only ADCINT1 and ADCINT2.
        self._eoc_is_plain = not (
            self._intsel34.value or self._socsel1.value or self._socsel2.value or self._notes_collisions
        )
        self._socs.configure()
        before, self._obeyed = self._obeyed, self._socs.obeyed()
        for trigsel in sorted(before ^ self._obeyed):
            self._trigger_changed(trigsel, trigsel in self._obeyed)
        self._ready = []
        if self._late and not self._stopped_by_fault:
            for soc in self._socs.every[self._socs.high :]:
                if soc.window > self._acqps_min and self._begun >> soc.n & 1:
                    self._ready.append(soc)

    # --- interrupts --------------------------------------------------------------------------------------------------

    def _eoc(self, soc: int, sel_then: int) -> None:
        """The ADCINTs that the EOC of `soc` drives; ADCINTSEL1N2 was `sel_then` when the conversion began."""
        sel = self._intsel12.value
        if sel != sel_then:
            self._source_changed(soc, sel_then, sel)
        if sel & 0x2F == 0x20 | soc:
            self._raise(0, sel & 0x40)
        if sel & 0x2F00 == 0x2000 | soc << 8:
            self._raise(1, sel & 0x4000)
        sel = self._intsel34.value
        if sel:
            if sel & 0x2F == 0x20 | soc:
                self._raise(2, sel & 0x40)
            if sel & 0x2F00 == 0x2000 | soc << 8:
                self._raise(3, sel & 0x4000)

    def _pulse(self, n: int) -> None:
        """A pulse to the PIE and to other listeners."""
        self._interrupts[n]()
        for listener in self.pulsed[n].listeners:
            listener()

    def _listener_changed(self, n: int, listened: bool) -> None:
        """A first listener besides the PIE connects to a pulse (`listened`), or the last one has gone."""
        self._pulses[n] = partial(self._pulse, n) if listened else self._interrupts[n]
        self._adcint1 = self._pulses[0]

    def _source_changed(self, soc: int, then: int, now: int) -> None:
        """Report an ADCINT that this EOC drove when the conversion began, and that drives another SOC now."""
        for n in range(2):
            was, is_now = then >> 8 * n & (ENABLE | SELECT), now >> 8 * n & (ENABLE | SELECT)
            if was == ENABLE | soc and is_now != was:
                name = f"{self._regs.name}.ADCINTSEL1N2.INT{n + 1}SEL"
                self._findings.report(
                    "adc-flag-shared",
                    f"{name} was changed from {soc} to {is_now & SELECT} while SOC{soc} was converting: its end does "
                    f"not set ADCINT{n + 1}; code that waits for that flag reads another conversion's result, or hangs",
                    object=name, value=is_now & SELECT,
                )  # fmt: skip

    def _raise(self, n: int, cont: int) -> None:
        """The EOC of ADCINT(n+1): flag or overflow, and the pulse."""
        bit = 1 << n
        if self._notes_collisions:
            self._note(bit)
        if self._intflg.value & bit:
            self._intovf.value |= bit
            if not cont:
                self._not_cleared(n)
                return
        else:
            self._intflg.value |= bit
        self._pulses[n]()
        if n < 2 and (self._socsel1.value or self._socsel2.value):
            socs = self._triggered_by(n)
            if socs:
                self._request_by_hardware(socs)

    def _triggered_by(self, n: int) -> int:
        """The SOCs that ADCINT(n+1) triggers, which ADCINT1 and ADCINT2 can."""
        select = self._socsel1.value | self._socsel2.value << 16
        return sum(1 << k for k in range(16) if select >> 2 * k & 3 == n + 1) if n < 2 else 0

    def _not_cleared(self, n: int) -> None:
        if not (self._awaited(n) or self._intflg.is_read or self._triggered_by(n)):
            return  # nothing uses the flag, so it may stay set
        path = f"{self._regs.name}.ADCINTFLG.ADCINT{n + 1}"
        message = f"{path} was still set when the next conversion ended: no interrupt is given for it, and "
        message += "ADCINTOVF is set"
        routine = self._left_by(n)
        if routine is None:
            cause = None if self._intflg.is_read else self._selected(n)
            runs = self._routine(n)
            if runs is not None and self._cpu.routine_at(runs) == self._findings.context():
                message += f": {self._findings.context()} had not come to its clear, a conversion later"
            self._findings.report("flag-not-cleared", message, object=path, cause=cause)
        else:
            self._findings.report_at(
                routine, "flag-not-cleared", message, how="dynamic", object=path, task=self._cpu.routine_at(routine)
            )  # fmt: skip

    def _note(self, bit: int) -> None:
        """Remember what this cycle sets, for a clear in the same cycle."""
        if self._flag_at != self._clock.now:
            self._flag_at = self._clock.now
            self._flags_then = self._overflows_then = 0
        if self._intflg.value & bit:
            self._overflows_then |= bit
        else:
            self._flags_then |= bit

    # --- results -----------------------------------------------------------------------------------------------------

    def _still_latching(self) -> None:
        """Keep track of the last result when a conversion begins: it may not have latched yet."""
        if self._latch_at != NEVER:
            self._latched = self._latch_at
            self._latch_at = NEVER

    def _read_early(self, n: int) -> int:
        """A read while a conversion is under way or latches.  What software forced is an error."""
        register = self._results[n]
        if register is self._latch and self._clock.now < (self._latched if self._latch_at == NEVER else self._latch_at):
            return self._unlatched
        state = self._under_way(n)
        if state and not self._by_hardware >> n & 1:
            flag = self._set_flag(n)
            if flag:
                name = f"{self._regs.name}.ADCINTFLG.{flag}"
                self._findings.report(
                    "flag-not-cleared",
                    f"{name} is still set from before, so a wait for it ends at once: {register.path} was read "
                    f"while SOC{n} {state}, and holds the result of an earlier conversion",
                    object=name, value=register.value,
                )  # fmt: skip
            else:
                self._not_ready(n, f"while SOC{n} {state}: it holds the result of an earlier conversion")
        elif state:
            self._check_last(n, state)
        return register.value

    def _check_last(self, n: int, state: str) -> None:
        """Report a read in the routine of another SOC, which the same trigger has started and which has ended."""
        trigger = self._trigger_of(n)
        for k in range(4):
            select = (self._intsel12, self._intsel34)[k // 2].value >> 8 * (k % 2)
            last = select & SELECT
            if not select & ENABLE or last == n or self._trigger_of(last) != trigger or self._under_way(last):
                continue
            routine = self._routine(k)
            if routine is not None and self._cpu.routine_at(routine) == self._findings.context():
                path = self._results[n].path
                self._findings.report(
                    "result-of-before",
                    f"{path} was read in the routine of ADCINT{k + 1}, which comes at the end of SOC{last}, while "
                    f"SOC{n} of the same trigger {state}: it is the result of the trigger before",
                    object=path, value=self._results[n].value,
                )  # fmt: skip

    def _trigger_of(self, n: int) -> int:
        """TRIGSEL of a SOC."""
        return self._regs.registers[f"ADCSOC{n}CTL"].value >> 20 & 0x1F

    def _read_never(self, n: int) -> int:
        """A read before the first conversion."""
        register = self._results[n]
        if self._ctl1.value & ADCPWDNZ:
            self._not_ready(n, f"before SOC{n} was ever converted: it reads {register.value}")
        else:
            name = f"{self._ctl1.path}.ADCPWDNZ"
            self._findings.report(
                "not-configured",
                f"{register.path} was read while {name} = 0: the converter has no power, and nothing was converted",
                object=name,
            )  # fmt: skip
        return register.value

    def _not_ready(self, n: int, why: str) -> None:
        register = self._results[n]
        self._findings.report(
            "result-not-ready", f"{register.path} was read {why}", object=register.path, value=register.value
        )

    def _under_way(self, soc: int) -> str:
        if self._read_ADCSOCFLG1() >> soc & 1:
            return "waits"
        return "is converting" if self._event is not None and self._soc.n == soc else ""

    def _set_flag(self, soc: int) -> str:
        """The name of a flag that the EOC of `soc` drives and that an earlier EOC has set.

        A flag from this conversion's own early pulse does not count.
        """
        if self._code is not None and self._soc.n == soc:
            return ""
        for n in range(4):
            sel = (self._intsel34 if n > 1 else self._intsel12).value >> 8 * (n & 1)
            if sel & (ENABLE | SELECT) == ENABLE | soc and self._intflg.value >> n & 1:
                return f"ADCINT{n + 1}"
        return ""

    # --- register handlers ---------------------------------------------------------------------------------------

    def _read_ADCCTL1(self) -> int:
        word = self._ctl1.value & 0x0084
        now = self._clock.now
        if self._event is not None and now < self._start:
            return word | self._last_soc.n << 8
        busy = self._start <= now < self._sample + self._converter.busy_cycles and self._sample > 0
        return word | self._soc.n << 8 | (0x2000 if busy else 0)

    def _write_ADCCTL1(self, word: int, lanes: int = ALL) -> None:
        powered = self._ctl1.value & 0x0080
        self._ctl1.store(word, lanes)
        if word & 0x0080 and not powered:
            self._ready_at = self._clock.now + POWER_UP_CYCLES
        elif powered and not word & 0x0080:
            self._ready_at = NEVER
        self._configure()

    def _write_ADCCTL2(self, word: int, lanes: int = ALL) -> None:
        before = self._ctl2.value
        self._ctl2.store(word, lanes)
        changed = before ^ self._ctl2.value
        if changed & 0xF:
            self._prescale_by = self._findings.mark()
        if changed & 0xC0:
            self._mode_by = self._findings.mark()
        self._configure()

    def _write_configuration(self, register: Cell, word: int, lanes: int = ALL) -> None:
        register.store(word, lanes)
        self._configure()

    def _write_ADCSOCxCTL(self, n: int, word: int, lanes: int = ALL) -> None:
        self._socs.write_ADCSOCxCTL(n, word, lanes)
        self._configure()

    def _read_ADCSOCPRICTL(self) -> int:
        waiting = self._event is not None and self._clock.now < self._start
        return self._socs.high | (self._socs.before if waiting else self._socs.pointer) << 5

    def _write_ADCSOCPRICTL(self, word: int, lanes: int = ALL) -> None:
        self._socs.write_ADCSOCPRICTL(word, lanes)
        self._configure()

    def _read_ADCSOCFLG1(self) -> int:
        if self._event is not None and self._clock.now < self._start:
            return self._socs.pending | 1 << self._soc.n
        return self._socs.pending

    def _write_ADCSOCFRC1(self, word: int) -> None:
        self._forced.take(self._position)
        self._cause = self._forced
        start = self._clock.now + self._sync_cycles
        if self._event is None and start >= self._ready_at:
            for soc in self._ready:
                if soc.bit == word:
                    # `_begin` for a round-robin SOC alone: there is nothing to arbitrate and nothing to report.
                    socs = self._socs
                    socs.before = socs.pointer
                    socs.pointer = soc.n
                    self._last_soc = self._soc
                    self._soc = soc
                    self._sel_then = self._intsel12.value
                    self._latched = self._latch_at
                    self._latch_at = NEVER
                    self._start = start
                    self._sample = start + soc.window
                    self._event = self._at_end
                    self._clock.start(self._at_end, start + soc.cycles)
                    return
        if word:
            self._by_hardware &= ~word
            self._request(word)

    def _read_ADCCOUNTER(self) -> int:
        return self._clock.now - self._epoch & 0xFFF

    def _read_ADCREV(self) -> int:
        path = f"{self._regs.name}.ADCREV"
        self._findings.report("unmodelled", f"{path} is not modelled: it reads 0", object=path)
        return 0

    def _result_of_soc0(self) -> int:
        """The last result of SOC0.  The post-processing blocks watch SOC0 out of reset."""
        return self._results[0].value

    def _write_ADCINTFLGCLR(self, word: int, lanes: int = ALL) -> None:
        if self._clock.now == self._flag_at:
            if self._collision == "erratum":
                word &= ~self._flags_then
            else:
                self._intovf.value |= self._flags_then & word
        self._intflg.value &= ~word

    def _write_ADCINTOVFCLR(self, word: int, lanes: int = ALL) -> None:
        if self._clock.now == self._flag_at:  # TRM: hardware wins
            word &= ~self._overflows_then
        self._intovf.value &= ~word


class _AtEnd(ClockEvent):
    """The end of a conversion."""

    __slots__ = ("_adc",)

    def __init__(self, adc: Adc) -> None:
        super().__init__(adc._end)
        self._adc = adc

    def run(self) -> None:
        self._adc._end()


class _Force(Hook):
    """A write to ADCSOCFRC1."""

    __slots__ = ("_adc",)

    def __init__(self, adc: Adc) -> None:
        self._adc = adc

    def write(self, word: int, lanes: int = ALL) -> None:
        self._adc._write_ADCSOCFRC1(word)


class _AdcResult(Hook):
    """A read of ADCRESULTn.  `begun`: its SOC has begun a conversion since the reset."""

    __slots__ = ("_adc", "_clock", "_n", "_register", "begun")

    def __init__(self, adc: Adc, clock: Clock, n: int, register: Cell) -> None:
        self._adc, self._clock, self._n, self._register = adc, clock, n, register
        self.begun = False

    def read(self) -> int:
        if self._clock.now < self._adc._latch_at or not self.begun:
            return self._adc._read_early(self._n) if self.begun else self._adc._read_never(self._n)
        return self._register.value
