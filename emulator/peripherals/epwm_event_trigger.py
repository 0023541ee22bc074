"""The event trigger of an ePWM module: interrupt, SOCA and SOCB at every nth event of the counter.

The clock has an event for a trigger only while the trigger is enabled (INTEN, SOCxEN), has a period (xPRD), and the
counter runs.
CHOICE: a counter that stays at 0, because TBPRD is 0, reaches no point and triggers nothing.  TI's eQEP example starts
its counter before it sets the period, and only then configures what its routine reads.
CHOICE: the event counters stop while their trigger is disabled; a new xPRD clears its counter.
CHOICE: SOC pulses come also while ETFLG.SOCx is set (unconfirmed).

SOCA and SOCB can also come from event 1 of the digital compare, which is counted like an event of the counter.

Sources: TRM ePWM, event-trigger submodule.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.clock import Clock, ClockEvent
from emulator.peripherals.epwm_action_qualifier import Phases
from emulator.peripherals.epwm_time_base import TimeBase
from emulator.registers.core import F
from emulator.registers.epwm import ETFLG, ETINTPS, ETPS, ETSEL, ETSOCPS, EPwmRegs

#: Events of the counter by the value of INTSEL and SOCxSEL; 0 is reserved (INTSEL), or event 1 of the digital compare
#: (SOCxSEL), which comes by `digital_compare`.
_SELECT: Final = ((), ("ZRO",), ("PRD",), ("ZRO", "PRD"), ("CAU",), ("CAD",), ("CBU",), ("CBD",))

_ENABLES: Final = ETSEL.INTEN.mask | ETSEL.SOCAEN.mask | ETSEL.SOCBEN.mask


def _field(word: int, field: F) -> int:
    return (word & field.mask) >> field.lo


class _Trigger:
    """One of INT, SOCA, SOCB: its fields, its event, its pulse."""

    __slots__ = (
        "count", "enable", "event", "flag", "name", "period", "pulse", "select", "wide", "wide_count", "wide_period",
    )  # fmt: skip

    def __init__(self, name: str, flag: F, fields: tuple[F, F, F, F], wide: tuple[F, F, F],
                 pulse: Callable[[], None]) -> None:  # fmt: skip
        self.name = name
        self.flag = flag.mask
        self.select, self.enable, self.period, self.count = fields
        self.wide, self.wide_period, self.wide_count = wide
        self.pulse = pulse
        self.event: ClockEvent | None = None


class EventTrigger:
    """ETSEL, ETPS, ETFLG and their companions.  `phases()` gives the counter's events as they are now."""

    __slots__ = (
        "_clock", "_flags", "_interrupt", "_on_blocked", "_phases", "_regs", "_select", "_time_base", "_triggers",
    )  # fmt: skip

    def __init__(self, clock: Clock, regs: EPwmRegs, time_base: TimeBase,
                 phases: Callable[[], dict[str, Phases]], interrupt: Callable[[], None],
                 on_blocked: Callable[[], object], soc_a: Callable[[], None],
                 soc_b: Callable[[], None]) -> None:  # fmt: skip
        """`on_blocked()` is called at an event that ETFLG.INT keeps from being an interrupt."""
        self._clock = clock
        self._on_blocked = on_blocked
        self._regs = regs
        self._time_base = time_base
        self._phases = phases
        self._flags, self._select = regs.registers["ETFLG"], regs.registers["ETSEL"]
        self._interrupt = _Trigger(
            "INT", ETFLG.INT, (ETSEL.INTSEL, ETSEL.INTEN, ETPS.INTPRD, ETPS.INTCNT),
            (ETPS.INTPSSEL, ETINTPS.INTPRD2, ETINTPS.INTCNT2), interrupt,
        )  # fmt: skip
        self._triggers = (
            self._interrupt,
            _Trigger(
                "SOCA", ETFLG.SOCA, (ETSEL.SOCASEL, ETSEL.SOCAEN, ETPS.SOCAPRD, ETPS.SOCACNT),
                (ETPS.SOCPSSEL, ETSOCPS.SOCAPRD2, ETSOCPS.SOCACNT2), soc_a,
            ),
            _Trigger(
                "SOCB", ETFLG.SOCB, (ETSEL.SOCBSEL, ETSEL.SOCBEN, ETPS.SOCBPRD, ETPS.SOCBCNT),
                (ETPS.SOCPSSEL, ETSOCPS.SOCBPRD2, ETSOCPS.SOCBCNT2), soc_b,
            ),
        )  # fmt: skip
        for name in ("ETPS", "ETINTPS", "ETSOCPS"):
            regs.bind(name, write=self._prescaler_writer(name))
        regs.bind("ETSEL", write=self._write_ETSEL)
        regs.bind("ETCLR", write=self._write_ETCLR)
        regs.bind("ETFRC", write=self._write_ETFRC)

    def reset(self) -> None:
        """Cancel scheduled events; the module resets the registers."""
        for trigger in self._triggers:
            self._clock.cancel(trigger.event)
            trigger.event = None

    def reschedule(self) -> None:
        """Schedule the triggers anew: the counter's path, a compare value or a setting has changed."""
        phases: dict[str, Phases] | None = None
        if not self._select.value & _ENABLES and not any(trigger.event for trigger in self._triggers):
            return
        for trigger in self._triggers:
            if trigger.event is not None:
                self._clock.cancel(trigger.event)
                trigger.event = None
            if self._select.value & trigger.enable.mask and self._time_base.counts and self._period(trigger):
                phases = phases or self._phases()
                self._schedule(trigger, phases)

    def _schedule(self, trigger: _Trigger, phases: dict[str, Phases]) -> None:
        names = _SELECT[_field(self._select.value, trigger.select)]
        times = [self._time_base.next_time(phase) for name in names for phase in phases[name]]
        if times:
            # Before a shadow load of the same cycle, which schedules anew from there on.
            trigger.event = self._clock.schedule(min(times), partial(self._due, trigger), priority=-1)

    def _due(self, trigger: _Trigger) -> None:
        if self._time_base.counts:
            self._schedule(trigger, self._phases())
        self._count_event(trigger)

    def digital_compare(self, output: int) -> None:
        """DCAEVT1.soc (0) or DCBEVT1.soc (1)."""
        trigger = self._triggers[1 + output]
        select = self._select.value
        if select & trigger.enable.mask and not _field(select, trigger.select) and self._period(trigger):
            self._count_event(trigger)

    def _count_event(self, trigger: _Trigger) -> None:
        period = self._period(trigger)
        count = min(self._count(trigger) + 1, period)
        if count < period or (trigger is self._interrupt and self._flags.value & trigger.flag):
            # An interrupt that is due waits at the full count until ETCLR.INT.
            self._set_count(trigger, count)
            if count >= period:
                self._on_blocked()
        else:
            self._fire(trigger)

    def _fire(self, trigger: _Trigger) -> None:
        self._set_count(trigger, 0)
        self._flags.value |= trigger.flag
        trigger.pulse()

    # -- prescaler fields: two bits in ETPS or four in ETINTPS, ETSOCPS -------------------------------------------

    def _is_wide(self, trigger: _Trigger) -> bool:
        return bool(self._regs.ETPS.value & trigger.wide.mask)

    def _wide_register(self, trigger: _Trigger) -> str:
        return "ETINTPS" if trigger is self._interrupt else "ETSOCPS"

    def _period(self, trigger: _Trigger) -> int:
        if self._is_wide(trigger):
            return _field(self._regs.registers[self._wide_register(trigger)].value, trigger.wide_period)
        return _field(self._regs.ETPS.value, trigger.period)

    def _count(self, trigger: _Trigger) -> int:
        if self._is_wide(trigger):
            return _field(self._regs.registers[self._wide_register(trigger)].value, trigger.wide_count)
        return _field(self._regs.ETPS.value, trigger.count)

    def _set_count(self, trigger: _Trigger, count: int) -> None:
        wide = self._is_wide(trigger)
        register = self._regs.registers[self._wide_register(trigger) if wide else "ETPS"]
        field = trigger.wide_count if wide else trigger.count
        register.value = register.value & ~field.mask | count << field.lo

    # -- registers -----------------------------------------------------------------------------------------------

    def _prescaler_writer(self, name: str) -> Callable[[int, int], None]:
        register = self._regs.registers[name]

        def write(word: int, lanes: int) -> None:
            before = [self._period(trigger) for trigger in self._triggers]
            register.store(word)
            for trigger, period in zip(self._triggers, before, strict=True):
                if self._period(trigger) != period:
                    self._set_count(trigger, 0)
            self.reschedule()

        return write

    def _write_ETSEL(self, word: int, lanes: int) -> None:
        self._select.store(word)
        self.reschedule()

    def _write_ETCLR(self, word: int, lanes: int) -> None:
        self._flags.value &= ~word
        interrupt = self._interrupt
        period = self._period(interrupt)
        enabled = self._select.value & interrupt.enable.mask
        if word & interrupt.flag and enabled and period and self._count(interrupt) >= period:
            self._fire(interrupt)

    def _write_ETFRC(self, word: int, lanes: int) -> None:
        """Set the flag in any case; give the pulse if the trigger is enabled and no interrupt flag is set already."""
        for trigger in self._triggers:
            if word & trigger.flag:
                standing = trigger is self._interrupt and self._flags.value & trigger.flag
                self._flags.value |= trigger.flag
                if self._select.value & trigger.enable.mask and not standing:
                    trigger.pulse()
