"""ePWM: counter, shadow registers, action qualifier, software force, dead band, trip zone, event trigger.

Modelled: up, down, up-down and stopped counting, prescalers, TBCLKSYNC, TBCTR writes, TBSTS; TBPRD, CMPA, CMPB, AQCTLA,
    AQCTLB and AQCSFRC with shadow, load points and immediate mode; all six action-qualifier events with their priority,
    toggles included; AQSFRC one-shot and AQCSFRC continuous force; the dead band (`epwm_dead_band.py`) with the shadows
    of DBCTL, DBRED and DBFED; phase load by SWFSYNC and `sync_in`; one-shot and cycle-by-cycle trips by TZ1 to TZ6 and
    by software (`epwm_trip_zone.py`), and by the digital compare with its blanking window (`epwm_digital_compare.py`);
    interrupt, SOCA and SOCB with prescalers; EPWMSYNCPER (`epwm_sync_pulse.py`); clock gate (`set_clock`).  Outputs are
    duties, levels and, while they have a listener, edges (`epwm_outputs.py`).
Not modelled: half-cycle clocking and high resolution of the dead band, chopper, TZCTL2, T1/T2 events, CMPC/CMPD, global
    load and XLINK, loads at sync, high resolution, edge filter, capture and valley switching, the sync output.  Setting
    one of these is reported.
Time: a TBCLK is no event.  TBCTR is computed when it is read.  An output is put on its wire as duty and period when an
    active value changes, which is the cycle of the shadow load.  Events exist only while a shadow waits to be loaded;
    for enabled triggers; for EPWMSYNCPER while a CMPSS uses it; for the end of a cycle-by-cycle trip; and for the edges
    of an output that has a listener.  One more comes at the next TBCLK after TBCTR or TBSTS was read, where a poll
    continues.  The wire shows the steady waveform at once, although the first period may still differ.
Sources: TRM ePWM (type 4); HDR F2837xS_epwm.h.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

from emulator.clock import Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.epwm_action_qualifier import Phases, act, event_phases
from emulator.peripherals.epwm_checks import CompareBeyondPeriod, EPwmChecks
from emulator.peripherals.epwm_dead_band import SWITCHES
from emulator.peripherals.epwm_digital_compare import DigitalCompare
from emulator.peripherals.epwm_event_trigger import EventTrigger
from emulator.peripherals.epwm_outputs import EpwmOutputs, Output, SwallowedPulse
from emulator.peripherals.epwm_shadow import AT_PERIOD, AT_ZERO, LOAD_POINTS, Shadow
from emulator.peripherals.epwm_sync_pulse import SyncPulse
from emulator.peripherals.epwm_time_base import DOWN, UP_DOWN, TimeBase
from emulator.peripherals.epwm_trip_zone import TripZone
from emulator.registers.core import HIGH, F
from emulator.registers.epwm import AQCSFRC, AQCTL, AQSFRC, CMPCTL, TBCTL, TBPHS, TBSTS, EPwmRegs
from emulator.registers.epwm_output import DBCTL, DBCTL2
from emulator.signal import Signal
from emulator.signals import PwmWire

# CMPCTL
_CMPA_FULL: Final = CMPCTL.SHDWAFULL.mask
_CMPB_FULL: Final = CMPCTL.SHDWBFULL.mask


def _field(word: int, field: F) -> int:
    return (word & field.mask) >> field.lo


class EPwm:
    """One ePWM module, EPWM`number`.

    `interrupt` is pulsed on the module's PIE line of group 3, `trip_interrupt` on that of group 2; `soc_a` and `soc_b`
    are pulsed towards the ADC.  Call `trip_input` with the level of TZn.  `trip_listen(n, on)` is called when the
    module begins (or ceases) to need TZn; answer with a call of `trip_input`.  `tripin` and `tripin_listen` are the
    same for TRIPINn.  `on_blocked()` is called for an event that gives no interrupt because ETFLG.INT is set.
    `epwmclk_divider()` is SYSCLK / EPWMCLK (CLKCFG.PERCLKDIVSEL): call `clock_changed` when it changes.
    CHOICE: `stopped_loads`: a counter that stands at 0 while TBCLK runs loads what waits for 0, one TBCLK later.  So
    TI's example, which sets up period and compare before it starts the counter, has its first SOC where it says.
    """

    __slots__ = (
        "_checks", "_cmpa", "_cmpb", "_cmpctl", "_csfrc", "_dbctl", "_dbfed", "_dbred", "_digital_compare", "_divider",
        "_load_event", "_load_points", "_next_check", "_on_path", "_outputs", "_prd", "_shadows", "_stopped_loads",
        "_sync_pulse", "_tbclksync", "_time_base", "_triggers", "_trip_zone", "clock", "cpu", "number", "regs",
    )  # fmt: skip

    def __init__(self, clock: Clock, cpu: Cpu, regs: EPwmRegs, output_a: PwmWire, output_b: PwmWire, *, number: int,
                 interrupt: Callable[[], None], soc_a: Callable[[], None], soc_b: Callable[[], None],
                 trip_interrupt: Callable[[], None] = lambda: None, trip_held: Callable[[], object] = lambda: None,
                 trip_listen: Callable[[int, bool], None] = lambda _n, _on: None,
                 tripin_listen: Callable[[int, bool], None] = lambda _n, _on: None,
                 on_blocked: Callable[[], object] = lambda: None, epwmclk_divider: Callable[[], int] = lambda: 2,
                 stopped_loads: bool = True) -> None:  # fmt: skip
        self.clock = clock
        self.cpu = cpu
        self.regs = regs
        self.number = number
        self._divider = epwmclk_divider
        self._tbclksync = False
        self._load_event: ClockEvent | None = None
        self._next_check: ClockEvent | None = None
        self._load_points = 0
        self._stopped_loads = stopped_loads
        self._time_base = TimeBase(clock)
        self._checks = EPwmChecks(clock, cpu, regs)
        registers = regs.registers
        self._prd = Shadow(registers["TBPRD"])
        self._cmpa = Shadow(registers["CMPA"], shift=16)
        self._cmpb = Shadow(registers["CMPB"], shift=16)
        self._cmpctl = registers["CMPCTL"]
        self._csfrc = Shadow(registers["AQCSFRC"])
        control_a = Shadow(registers["AQCTLA"], immediate=True)
        control_b = Shadow(registers["AQCTLB"], immediate=True)
        self._dbctl = Shadow(registers["DBCTL"], immediate=True, used=SWITCHES)
        self._dbred = Shadow(registers["DBRED"], immediate=True)
        self._dbfed = Shadow(registers["DBFED"], immediate=True)
        self._shadows = (
            self._prd, self._cmpa, self._cmpb, control_a, control_b, self._csfrc, self._dbctl, self._dbred, self._dbfed
        )
        self._trip_zone = TripZone(
            clock, regs, self._refresh, trip_interrupt, self._next_point, trip_listen, trip_held,
            self._checks.old_trip,
        )  # fmt: skip
        self._outputs = EpwmOutputs(
            clock, self._time_base,
            Output(0, output_a, control_a, AQCSFRC.CSFA), Output(1, output_b, control_b, AQCSFRC.CSFB),
            compare=(self._cmpa, self._cmpb), csfrc=self._csfrc, dead_band=(self._dbctl, self._dbred, self._dbfed),
            trip_zone=self._trip_zone, settled=self._update_outputs,
        )  # fmt: skip
        self._triggers = EventTrigger(
            clock, regs, self._time_base, self._phases, interrupt, on_blocked, soc_a, soc_b
        )  # fmt: skip
        #: Functions to call when the path of the counter changes, while they are needed.
        self._on_path: list[Callable[[], None]] = []
        self._sync_pulse = SyncPulse(clock, regs, self._next_point, self._follow_path)
        self._digital_compare = DigitalCompare(
            clock, cpu, regs, self._time_base, self._trip_zone, next_point=self._next_point, listen=tripin_listen,
            soc=self._triggers.digital_compare, sync=self.sync_in, follow=self._follow_path,
        )  # fmt: skip
        bind = regs.bind
        bind("TBCTL", write=self._write_TBCTL)
        bind("TBCTR", read=self._read_TBCTR, write=self._write_TBCTR)
        bind("TBSTS", read=self._read_TBSTS, write=self._write_TBSTS)
        bind("TBPRD", write=self._shadow_writer(self._prd))
        bind("CMPCTL", write=self._write_CMPCTL)
        bind("CMPA", write=self._shadow_writer(self._cmpa, HIGH, _CMPA_FULL))
        bind("CMPB", write=self._shadow_writer(self._cmpb, HIGH, _CMPB_FULL))
        bind("AQCTL", write=self._write_AQCTL)
        bind("AQCTLA", write=self._shadow_writer(control_a))
        bind("AQCTLB", write=self._shadow_writer(control_b))
        bind("AQSFRC", write=self._write_AQSFRC)
        bind("AQCSFRC", write=self._shadow_writer(self._csfrc))
        bind("DBCTL", write=self._write_DBCTL)
        bind("DBCTL2", write=self._write_DBCTL2)
        bind("DBRED", write=self._shadow_writer(self._dbred))
        bind("DBFED", write=self._shadow_writer(self._dbfed))
        self.reset()

    def reset(self) -> None:
        """Module reset (power-on or SOFTPRES2).  TBCLKSYNC and the clock gate belong to the system and stay."""
        self.clock.cancel(self._load_event)
        self.clock.cancel(self._next_check)
        self._load_event = self._next_check = None
        self._triggers.reset()
        self._checks.reset()
        self.regs.reset()
        self._time_base.reset()
        self._time_base.change(tick=self._tick())
        for shadow in self._shadows:
            shadow.reset()
        self._outputs.reset()
        self._trip_zone.reset()
        self._digital_compare.reset()
        self._rearrange()

    # -- for the world -------------------------------------------------------------------------------------------

    def set_tbclksync(self, on: bool) -> None:
        """PCLKCR0.TBCLKSYNC: starts and stops TBCLK of all modules together."""
        self._tbclksync = on
        self._settle()
        self._time_base.change(enabled=on and self.regs.clocked)
        self._rearrange()

    def set_clock(self, on: bool) -> None:
        """PCLKCR2 switched the module's clock: registers keep their state, the counter freezes."""
        self._settle()
        self.regs.set_clock(on)
        self._time_base.change(enabled=on and self._tbclksync)
        self._rearrange()

    def clock_changed(self) -> None:
        """EPWMCLKDIV was written: `epwmclk_divider` gives another value."""
        self._settle()
        self._time_base.change(tick=self._tick())
        self._rearrange()

    def sync_in(self) -> None:
        """A pulse at the sync input: with PHSEN the counter continues from TBPHS."""
        self.regs.TBSTS.value |= TBSTS.SYNCI.mask
        control = self.regs.TBCTL.value
        if control & TBCTL.PHSEN.mask:
            self._settle()
            up = bool(control & TBCTL.PHSDIR.mask) if self._time_base.mode == UP_DOWN else None
            self._time_base.change(count=_field(self.regs.TBPHS.value, TBPHS.TBPHS), up=up)
            self._rearrange()

    def trip_input(self, n: int, level: int) -> None:
        """TZn (1 to 6) has this level from now on; 0 trips."""
        self._trip_zone.input(n, level)

    def tripped_for_ever(self) -> list[int]:
        """The inputs, TZ1 to TZ6, that tripped the module when it chose them, and that have gone since."""
        return self._trip_zone.tripped_for_ever()

    def tripin(self, n: int, level: int) -> None:
        """TRIPINn (1 to 12, 14, 15) of the digital compare has this level from now on."""
        self._digital_compare.input(n, level)

    @property
    def synced(self) -> Signal[[]]:
        """Every EPWMSYNCPER."""
        return self._sync_pulse.pulsed

    def levels(self) -> tuple[int, int]:
        """The levels of outputs A and B at this cycle (high impedance counts as 0)."""
        self._update_outputs()
        a, b = [self._outputs.level(output) or 0 for output in self._outputs.both]
        return a, b

    def _follow_path(self, follow: Callable[[], None], on: bool) -> None:
        """Call `follow()` whenever the counter's path changes (`on`), or no longer."""
        self._on_path = [*(other for other in self._on_path if other != follow), *([follow] if on else [])]

    # -- from active values to the outputs -----------------------------------------------------------------------

    def _tick(self) -> int:
        control = self.regs.TBCTL.value
        high_speed = 2 * _field(control, TBCTL.HSPCLKDIV) or 1
        return self._divider() * high_speed << _field(control, TBCTL.CLKDIV)

    def _phases(self) -> dict[str, Phases]:
        time_base = self._time_base
        return event_phases(time_base.mode, time_base.period, self._cmpa.active, self._cmpb.active)

    def _settle(self, before_this_tick: bool = False) -> None:
        self._outputs.settle(before_this_tick)

    def _update_outputs(self) -> None:
        """Bring the outputs up to now.  The result does not depend on the order of the events of this cycle."""
        if self._load_event is not None and self._load_event.time == self.clock.now:
            self.clock.cancel(self._load_event)
            self._load()
        self._settle()
        self._time_base.change()

    def _rearrange(self, arrived: bool = False) -> None:
        """The path of the counter or an active value has changed: update waveforms, wires and events."""
        self._outputs.arrange(arrived)
        self._schedule_load()
        self._triggers.reschedule()
        self._trip_zone.reschedule()
        for follow in self._on_path:
            follow()
        self._outputs.reschedule()
        self._outputs.report_levels()

    def _refresh(self) -> None:
        self._update_outputs()
        self._rearrange()

    # -- shadow registers ----------------------------------------------------------------------------------------

    def _shadow_writer(self, shadow: Shadow, lanes_used: int = 0xFFFF,
                       full: int = 0) -> Callable[[int, int], None]:  # fmt: skip
        register = shadow.register

        def write(word: int, lanes: int) -> None:
            register.store(word, lanes)
            if not lanes & lanes_used:
                return
            if full:
                period = max(self._prd.register.value, self._prd.active)
                self._checks.compared(register.name, register.value >> 16, period)
            elif shadow is self._prd:
                self._checks.period_written()
            if full and (not self._time_base.running or not self._prd.register.value or self._unseen):
                self._check_use(shadow)
            if shadow.immediate:
                self._settle()
                shadow.load()
                self._time_base.change(period=self._prd.active)
                self._rearrange()
            else:
                shadow.pending = True
                self._cmpctl.value |= full
                # Several registers can wait for one load point.  Its event is scheduled already.
                if self._load_event is None or shadow.points & ~self._load_points:
                    self._schedule_load()

        return write

    @property
    def _unseen(self) -> PwmWire | None:
        """An output that has actions and no pin."""
        for output in self._outputs.both:
            if output.wire.missing and output.control.active:
                return output.wire
        return None

    @property
    def acts_on_pin(self) -> bool:
        """Whether an output that has actions has a pin."""
        return any(output.control.active and not output.wire.missing for output in self._outputs.both)

    @property
    def above(self) -> Mapping[str, Sequence[CompareBeyondPeriod]]:
        """Compare register -> the first value above the period of each statement."""
        return self._checks.above

    @property
    def above_half(self) -> Mapping[str, tuple[int, int]]:
        """Compare register -> its greatest value above half of the period, and that period."""
        return self._checks.above_half

    @property
    def swallowed(self) -> list[SwallowedPulse]:
        """The pulses that the dead band has swallowed for more than a period."""
        return self._outputs.swallowed

    @property
    def unpaired(self) -> PwmWire | None:
        """The output of a pair with a dead band that has no pin, while the other one has."""
        a, b = (output.wire for output in self._outputs.both)
        delayed = self._dbctl.active & DBCTL.OUT_MODE.mask == DBCTL.OUT_MODE.mask
        acting = any(output.control.active for output in self._outputs.both)
        if not delayed or not acting or bool(a.missing) == bool(b.missing):
            return None
        return a if a.missing else b

    def _check_use(self, compare: Shadow) -> None:
        self._checks.duty(
            compare.register.name, stopped=not self._time_base.running, tbclksync=self._tbclksync, unseen=self._unseen
        )

    def _schedule_load(self) -> None:
        """One event at the next point at which a waiting shadow may be loaded; none while nothing waits."""
        points = 0
        for shadow in self._shadows:
            if shadow.pending:
                points |= shadow.points
        if self._load_event is not None:
            self.clock.cancel(self._load_event)
            self._load_event = None
        self._load_points = points
        base = self._time_base
        time = self._next_point(points)
        if time is not None:
            self._load_event = self.clock.schedule(time, self._load)
        elif points & AT_ZERO and base.enabled and base.count() == 0 and self._stopped_loads:
            self._load_event = self.clock.after(base.tick, self._load)

    def _next_point(self, points: int) -> int | None:
        """The cycle (after now) when the counter next reaches one of these load points; None: it never does."""
        base = self._time_base
        if not points or not base.running:
            return None
        return min(base.next_time(phase) for bit, phase in self._load_phases() if points & bit)

    def _load_phases(self) -> tuple[tuple[int, int], tuple[int, int]]:
        period = self._time_base.period
        down = self._time_base.mode == DOWN
        return (AT_ZERO, period if down else 0), (AT_PERIOD, 0 if down else period)

    def _load(self) -> None:
        """CTR = 0 or CTR = TBPRD: load the shadows that wait for this point.  They are active in this TBCLK already."""
        self._load_event = None
        here = self._time_base.phase()
        points = sum({bit for bit, phase in self._load_phases() if phase == here})
        loading = [shadow for shadow in self._shadows if shadow.pending and shadow.points & points]
        new = any(shadow.differs() for shadow in loading)
        if new:
            self._settle(before_this_tick=True)
        for shadow in loading:
            shadow.load()
        if not self._cmpa.pending:
            self._cmpctl.value &= ~_CMPA_FULL
        if not self._cmpb.pending:
            self._cmpctl.value &= ~_CMPB_FULL
        if new:
            self._time_base.change(period=self._prd.active)
            self._rearrange(arrived=self._time_base.running)
        else:  # The values were active already: counter and waveforms go on as they are.
            self._schedule_load()
            self._triggers.reschedule()

    def _configure(self, shadow: Shadow, immediate: bool, points: int) -> None:
        if shadow.configure(immediate, points):
            path = shadow.register.path
            self.cpu.findings.report(
                "epwm-shadow-lost",
                f"{path}: made immediate while a value waited in its shadow: that value never becomes active",
                object=path, value=shadow.register.value,
            )  # fmt: skip

    # -- registers -----------------------------------------------------------------------------------------------

    def _write_TBCTL(self, word: int, lanes: int) -> None:
        register = self.regs.TBCTL
        if (word ^ register.value) & TBCTL.SYNCOSEL.mask and _field(word, TBCTL.SYNCOSEL) in (1, 2):
            self.cpu.findings.report(
                "unmodelled", f"{register.path}.SYNCOSEL: the sync output is not modelled: no module gets the pulse",
                object=f"{register.path}.SYNCOSEL", value=_field(word, TBCTL.SYNCOSEL),
            )  # fmt: skip
        self._settle()
        register.store(word)
        self._configure(self._prd, bool(word & TBCTL.PRDLD.mask), AT_ZERO)
        self._time_base.change(mode=_field(word, TBCTL.CTRMODE), tick=self._tick())
        self._rearrange()
        if word & TBCTL.SWFSYNC.mask:
            self.sync_in()

    def _write_TBCTR(self, word: int, lanes: int) -> None:
        self._settle()
        self._time_base.change(count=word)
        self._rearrange()

    def _read_TBCTR(self) -> int:
        self._mark_next_tick()
        return self._time_base.count()

    def _mark_next_tick(self) -> None:
        """Schedule an event at the next TBCLK, where a poll of the counter goes on."""
        if self._next_check is None and self._time_base.running:
            self._next_check = self.clock.schedule(self._time_base.next_tick(), self._check_again)

    def _check_again(self) -> None:
        self._next_check = None

    def _read_TBSTS(self) -> int:
        self._mark_next_tick()
        register = self.regs.TBSTS
        register.value &= ~TBSTS.CTRDIR.mask
        if self._time_base.up():
            register.value |= TBSTS.CTRDIR.mask
        if self._time_base.reached_maximum():
            register.value |= TBSTS.CTRMAX.mask
        return register.value

    def _write_TBSTS(self, word: int, lanes: int) -> None:
        self._read_TBSTS()
        self.regs.TBSTS.store(word)

    def _write_CMPCTL(self, word: int, lanes: int) -> None:
        register = self._cmpctl
        register.store(word)
        self._configure(self._cmpa, bool(word & CMPCTL.SHDWAMODE.mask), LOAD_POINTS[_field(word, CMPCTL.LOADAMODE)])
        self._configure(self._cmpb, bool(word & CMPCTL.SHDWBMODE.mask), LOAD_POINTS[_field(word, CMPCTL.LOADBMODE)])
        if not self._cmpa.pending:
            register.value &= ~_CMPA_FULL
        if not self._cmpb.pending:
            register.value &= ~_CMPB_FULL
        self._schedule_load()

    def _write_AQCTL(self, word: int, lanes: int) -> None:
        self.regs.AQCTL.store(word)
        a, b = [output.control for output in self._outputs.both]
        self._configure(a, not word & AQCTL.SHDWAQAMODE.mask, LOAD_POINTS[_field(word, AQCTL.LDAQAMODE)])
        self._configure(b, not word & AQCTL.SHDWAQBMODE.mask, LOAD_POINTS[_field(word, AQCTL.LDAQBMODE)])
        self._schedule_load()

    def _write_AQSFRC(self, word: int, lanes: int) -> None:
        self.regs.AQSFRC.store(word)
        reload = _field(word, AQSFRC.RLDCSF)
        self._configure(self._csfrc, reload == 3, LOAD_POINTS[reload])
        self._settle()
        a, b = self._outputs.both
        if word & AQSFRC.OTSFA.mask:
            a.level = act(_field(word, AQSFRC.ACTSFA), a.level)
        if word & AQSFRC.OTSFB.mask:
            b.level = act(_field(word, AQSFRC.ACTSFB), b.level)
        self._time_base.change()
        self._rearrange()

    def _write_DBCTL(self, word: int, lanes: int) -> None:
        control = self._dbctl
        control.register.store(word)
        self._configure(self._dbred, not word & DBCTL.SHDWDBREDMODE.mask, LOAD_POINTS[_field(word, DBCTL.LOADREDMODE)])
        self._configure(self._dbfed, not word & DBCTL.SHDWDBFEDMODE.mask, LOAD_POINTS[_field(word, DBCTL.LOADFEDMODE)])
        if control.immediate:
            self._settle()
            control.load()
            self._time_base.change()
            self._rearrange()
        else:
            control.pending = True
            self._schedule_load()

    def _write_DBCTL2(self, word: int, lanes: int) -> None:
        self.regs.DBCTL2.store(word)
        self._configure(
            self._dbctl, not word & DBCTL2.SHDWDBCTLMODE.mask, LOAD_POINTS[_field(word, DBCTL2.LOADDBCTLMODE)]
        )
        self._schedule_load()
