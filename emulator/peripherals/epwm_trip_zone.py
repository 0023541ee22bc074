"""The trip zone of an ePWM module: trips force its outputs, for a time or until software clears them.

Modelled: TZ1 to TZ6 (active low) as one-shot and cycle-by-cycle trips (TZSEL); TZCTL.TZA and TZB, with high impedance
    (then nothing drives the pin); TZFRC.OST and CBC; TZFLG, TZOSTFLG, TZCBCFLG with TZCLR, TZOSTCLR, TZCBCCLR;
    TZCLR.CBCPULSE; TZEINT and the interrupt; the events of the digital compare (`epwm_digital_compare.py`): event 1 as
    a one-shot, event 2 as a cycle-by-cycle trip (TZSEL), all four with actions of their own (TZCTL), flags, interrupts
    and TZFRC.  A one-shot trip lasts until TZCLR.OST.  A cycle-by-cycle trip lasts until the counter comes to the point
    that CBCPULSE names, if the input is inactive by then.  TZFLG.CBC only remembers it.
Not modelled: the actions of TZCTL2, TZCTLDCA and TZCTLDCB that depend on the direction of the counter; the least width
    of a pulse that a latch takes (3 TBCLK): here every pulse trips.
Time: the only event is the end of a cycle-by-cycle trip whose input is inactive.
CHOICE: clearing TZFLG.OST while its input is still low trips again at once, as the manual says of TZFLG.CBC.
CHOICE: the outputs follow TZCTL while they are tripped.  The action of a trip has priority over those of event 1, and
    these over those of event 2 (TRM).  CHOICE: an action that leaves the output unchanged lets the next one act.
CHOICE: an event that TZFRC forces is over at once; only its flags and latches stay.
Sources: TRM ePWM, trip-zone submodule; HDR F2837xS_epwm.h.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.clock import Clock, ClockEvent
from emulator.peripherals.epwm_shadow import LOAD_POINTS
from emulator.registers.core import F
from emulator.registers.epwm import EPwmRegs
from emulator.registers.epwm_trip import TZCLR, TZCTL, TZFLG, TZFRC

_OUTPUTS: Final[tuple[F, F]] = (TZCTL.TZA, TZCTL.TZB)
#: The actions of events 1 and 2 of the digital compare, for each output.
_EVENT_ACTIONS: Final = ((TZCTL.DCAEVT1, TZCTL.DCAEVT2), (TZCTL.DCBEVT1, TZCTL.DCBEVT2))
#: The state of a tripped output (values of TZCTL.TZA and TZB; 2 is low).
HIGH_IMPEDANCE: Final = 0
HIGH: Final = 1
UNTOUCHED: Final = 3
#: TZ1 to TZ6 in TZSEL, TZCBCFLG and (eight bits further up in TZSEL) TZOSTFLG; behind them an event of DCA and of DCB.
_INPUTS: Final = 0x3F
_CAUSES: Final = 0xFF
#: DCAEVT1, DCAEVT2, DCBEVT1, DCBEVT2: bits of a word, which in TZFLG, TZEINT, TZCLR and TZFRC lie further up.
_EVENTS: Final = 0xF
_EVENT_FLAG: Final = TZFLG.DCAEVT1.lo
_ONE_SHOT: Final = 8
_OST: Final = TZFLG.OST.mask
#: Among the causes of a cycle-by-cycle trip: TZFRC.CBC.
_SOFTWARE: Final = 1 << 15
_SOURCES: Final = TZFLG.CBC.mask | TZFLG.OST.mask | _EVENTS << _EVENT_FLAG


class TripZone:
    """The TZ registers.

    `changed()` is called when an output may have been tripped or released; `interrupt` is pulsed.  `next_point(points)`
    is the cycle when the counter next reaches 0 or TBPRD, None while it does not run.  `listen(n, on)` is called when
    the module begins (or ceases) to need TZn; answer with a call of `input`.  `on_blocked()` is called for an enabled
    event that TZFLG.INT holds back.  `stale()` is called when TZFLG.OST gives its interrupt again and again, because
    only TZFLG.INT is cleared.
    """

    __slots__ = (
        "_again",
        "_changed",
        "_clock",
        "_control",
        "_cycle",
        "_event",
        "_events",
        "_flags",
        "_interrupt",
        "_listen",
        "_listened_inputs",
        "_low",
        "_next_point",
        "_on_blocked",
        "_points",
        "_regs",
        "_select",
        "_stale",
        "at_once",
    )  # fmt: skip

    def __init__(self, clock: Clock, regs: EPwmRegs, changed: Callable[[], None], interrupt: Callable[[], None],
                 next_point: Callable[[int], int | None], listen: Callable[[int, bool], None],
                 on_blocked: Callable[[], object] = lambda: None,
                 stale: Callable[[], None] = lambda: None) -> None:  # fmt: skip
        self._clock, self._on_blocked, self._stale = clock, on_blocked, stale
        self._regs = regs
        self._changed = changed
        self._interrupt = interrupt
        self._next_point = next_point
        self._listen = listen
        registers = regs.registers
        self._flags, self._control, self._select = registers["TZFLG"], registers["TZCTL"], registers["TZSEL"]
        #: Inputs that are low, inputs that are listened to, and the causes of a cycle-by-cycle trip that lasts (bits).
        self._low = self._listened_inputs = self._cycle = 0
        #: The events of the digital compare that are active.
        self._events = 0
        #: How often the flag of the same one-shot trip has given an interrupt again.
        self._again = 0
        #: Inputs that were low when TZSEL chose them for a one-shot trip, until TZCLR.OST ends that trip (bits).
        self.at_once = 0
        #: The points of the counter at which a cycle-by-cycle trip ends.
        self._points = LOAD_POINTS[0]
        self._event: ClockEvent | None = None
        for name, write in (
            ("TZSEL", self._write_TZSEL), ("TZCTL", self._write_TZCTL), ("TZEINT", self._write_TZEINT),
            ("TZFRC", self._write_TZFRC), ("TZCLR", self._write_TZCLR), ("TZCBCCLR", self._write_TZCBCCLR),
            ("TZOSTCLR", self._write_TZOSTCLR),
        ):  # fmt: skip
            regs.bind(name, write=write)

    def reset(self) -> None:
        """Reset the state: nothing is tripped, and no input is needed.  The module resets the registers."""
        self._clock.cancel(self._event)
        self._event = None
        self._cycle = self._events = self._again = self.at_once = 0
        self._points = LOAD_POINTS[0]
        self._choose()

    def input(self, n: int, level: int) -> None:
        """TZn has this level from now on; 0 trips."""
        bit = 1 << n - 1
        if not level:
            self._low |= bit
            if (self._select.value | self._select.value >> _ONE_SHOT) & bit:
                self._trip()
        elif self._low & bit:
            self._low &= ~bit
            self.reschedule()

    def tripped_for_ever(self) -> list[int]:
        """TZ1 to TZ6 that were low when TZSEL chose them, and are high now: their trip has stayed (TZFLG.OST)."""
        return [n for n in range(1, 7) if self.at_once & ~self._low & 1 << n - 1]

    def events(self, standing: int) -> list[int]:
        """Set the events of the digital compare that are active from now on (bits).  Returns those that begin."""
        before, self._events = self._events, standing
        if standing == before:
            return []
        self._trip()
        self.reschedule()
        self._changed()
        begun = standing & ~before
        return [n for n in range(begun.bit_length()) if begun >> n & 1]

    def action(self, output: int) -> int:
        """The action on output 0 (A) or 1 (B): HIGH_IMPEDANCE, HIGH, low or UNTOUCHED."""
        tripped = self._cycle or self._flags.value & _OST
        if not tripped and not self._events:
            return UNTOUCHED
        fields = [_OUTPUTS[output]] if tripped else []
        fields += [field for n, field in enumerate(_EVENT_ACTIONS[output]) if self._events >> 2 * output + n & 1]
        actions = [(self._control.value & field.mask) >> field.lo for field in fields]
        return next((action for action in actions if action != UNTOUCHED), UNTOUCHED)

    def reschedule(self) -> None:
        """Schedule the end of a cycle-by-cycle trip anew: the counter's path or a cause has changed."""
        if self._event is not None:
            if self._event.time == self._clock.now:
                return  # the end that is due in this cycle: a shadow load only came first
            self._clock.cancel(self._event)
            self._event = None
        if self._cycle & ~self._present() and self._points:
            time = self._next_point(self._points)
            if time is not None:
                self._event = self._clock.schedule(time, self._end_of_cycle)

    def _present(self) -> int:
        """Inputs and events that hold a cycle-by-cycle trip."""
        events = self._events >> 1
        return (self._low | (events & 1) << 6 | (events >> 2 & 1) << 7) & self._select.value & _CAUSES

    def _once(self) -> int:
        """Inputs and events that hold a one-shot trip."""
        events = self._events
        return (self._low | (events & 1) << 6 | (events >> 2 & 1) << 7) & self._select.value >> _ONE_SHOT & _CAUSES

    def _end_of_cycle(self) -> None:
        self._event = None
        self._cycle &= self._present()
        if self._cycle:
            self.reschedule()
        else:
            self._changed()

    def _trip(self, cycle: int = 0, one_shot: bool = False) -> None:
        """Latch the trips of selected inputs that are low, and trips that software forces."""
        flags = self._flags
        before = self._cycle, flags.value & TZFLG.OST.mask
        flags.value |= self._events << _EVENT_FLAG
        present, once = self._present(), self._once()
        if present or cycle:
            flags.value |= TZFLG.CBC.mask
            self._regs.TZCBCFLG.value |= present
            self._cycle |= present | cycle
        if once or one_shot:
            flags.value |= TZFLG.OST.mask
            self._regs.TZOSTFLG.value |= once
        if (self._cycle, flags.value & TZFLG.OST.mask) != before:
            self.reschedule()
            self._changed()
        if not flags.value & TZFLG.INT.mask:
            if flags.value & self._regs.TZEINT.value & _SOURCES:
                flags.value |= TZFLG.INT.mask
                if before[1] and not (present or once or cycle or one_shot or self._events):
                    self._again += 1
                    if self._again > 1:
                        self._stale()
                self._interrupt()
        elif flags.value & self._regs.TZEINT.value & _SOURCES:
            self._on_blocked()

    def _choose(self) -> None:
        """Listen to the inputs that TZSEL names, and to no others."""
        select = self._select.value
        wanted = (select | select >> _ONE_SHOT) & _INPUTS
        before, self._listened_inputs = self._listened_inputs, wanted
        for n in range(1, 7):
            if (before ^ wanted) >> n - 1 & 1:
                self._listen(n, bool(wanted >> n - 1 & 1))

    def _write_TZSEL(self, word: int, lanes: int) -> None:
        tripped = self._flags.value & _OST
        self._select.store(word)
        self._choose()
        self.reschedule()
        self._trip()
        if not tripped:
            self.at_once = self._once() & _INPUTS

    def _write_TZCTL(self, word: int, lanes: int) -> None:
        self._control.store(word)
        if self._cycle or self._events or self._flags.value & TZFLG.OST.mask:
            self._changed()

    def _write_TZEINT(self, word: int, lanes: int) -> None:
        self._regs.TZEINT.store(word)
        self._trip()

    def _write_TZFRC(self, word: int, lanes: int) -> None:
        standing, forced = self._events, word >> _EVENT_FLAG & _EVENTS
        self._events |= forced
        self._trip(_SOFTWARE if word & TZFRC.CBC.mask else 0, bool(word & TZFRC.OST.mask))
        if forced & ~standing:
            self._events = standing
            self.reschedule()
            self._changed()

    def _write_TZCLR(self, word: int, lanes: int) -> None:
        register = self._regs.TZCLR
        register.store(word)
        self._points = LOAD_POINTS[(register.value & TZCLR.CBCPULSE.mask) >> TZCLR.CBCPULSE.lo]
        self.reschedule()
        tripped = self._flags.value & TZFLG.OST.mask
        self._flags.value &= ~(word & (TZFLG.INT.mask | _SOURCES))
        if word & TZCLR.OST.mask:
            self._again = self.at_once = 0
        if tripped and word & TZCLR.OST.mask and not self._once():
            self._changed()
        self._trip()

    def _write_TZCBCCLR(self, word: int, lanes: int) -> None:
        self._regs.TZCBCFLG.value &= ~word
        self._trip()

    def _write_TZOSTCLR(self, word: int, lanes: int) -> None:
        self._regs.TZOSTFLG.value &= ~word
        self._trip()
