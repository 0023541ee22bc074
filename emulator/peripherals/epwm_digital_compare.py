"""The digital compare of an ePWM module: trip inputs become the events DCAEVT1, DCAEVT2, DCBEVT1 and DCBEVT2.

Modelled: TRIPIN1 to 12, one by one or combined (DCTRIPSEL, DCAHTRIPSEL and its like); the conditions of TZDCSEL;
    DCEVTFILT with its blanking window (DCFCTL, DCFOFFSET, DCFWINDOW and their counters); the choice of DCACTL and
    DCBCTL; what event 1 does besides a trip: SOCA or SOCB, and sync.  The trip zone (`epwm_trip_zone.py`) does what
    events do to outputs and flags.
Not modelled: synchronisation with EPWMCLK (EVTxFRCSYNCSEL): events come at once either way; edge filter, valley
    switching and capture of TBCTR (DCCAPCTL): setting one of their bits is reported.  TRIPIN14 and 15 are never high,
    because this memory has no errors.
Time: an event changes in the cycle of its trip input.  A trip input has a listener only while an event depends on it.
    The clock has events for the blanking window only, while BLANKE is set, an event is filtered and the counter runs.
CHOICE: SOC and sync come at the beginning of an event.
CHOICE: a window or an offset that has begun keeps its length in SYSCLK, whatever happens to TBCLK.
CHOICE: an offset that ends where the next one begins does not end.
CHOICE: DCFOFFSETCNT and DCFWINDOWCNT read 0 while there is no blanking.
CHOICE: a trip input that DCTRIPSEL does not have (12), and PULSESEL 3, are reported and give no event.
Sources: TRM ePWM, digital compare submodule; HDR F2837xS_epwm.h.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.clock import Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.epwm_shadow import AT_PERIOD, AT_ZERO
from emulator.peripherals.epwm_time_base import TimeBase
from emulator.peripherals.epwm_trip_zone import TripZone
from emulator.registers.core import ALL
from emulator.registers.epwm import EPwmRegs
from emulator.registers.epwm_trip import DCACTL, DCFCTL

#: The four events, in the order of their fields and flags: (DCACTL or DCBCTL, event 1 or 2).
EVENTS: Final = (("DCACTL", 1), ("DCACTL", 2), ("DCBCTL", 1), ("DCBCTL", 2))
#: The four signals in the order of their fields in DCTRIPSEL.
SIGNALS: Final = ("DCAH", "DCAL", "DCBH", "DCBL")
#: Value of a field of DCTRIPSEL -> trip inputs as bits (TRIPINn is bit n - 1); 15 is the combination, 12 is none.
_COMBINATION: Final = 15
_RESERVED: Final = 12
#: The order within one cycle: first the point of the counter, then the begin of a window, then the end of a window.
_POINT_PRIORITY: Final = -3
_OPEN_PRIORITY: Final = -2
_CLOSE_PRIORITY: Final = -1
#: PULSESEL -> the points that start the offset counter.
_POINTS: Final = (AT_PERIOD, AT_ZERO, AT_ZERO | AT_PERIOD, 0)


class DigitalCompare:
    """The DC registers.

    `listen(n, on)` is called when the module begins (or ceases) to need TRIPINn; answer with a call of `input`.
    `next_point(points)` is the cycle when the counter next reaches 0 or TBPRD, None while it does not run.  `soc(0)`
    and `soc(1)` are DCAEVT1.soc and DCBEVT1.soc, `sync()` is their sync.  `follow(reschedule, on)` is called when the
    module begins (or ceases) to need changes of the counter's path.
    """

    __slots__ = (
        "_choosing",
        "_clock",
        "_close_event",
        "_close_time",
        "_filter",
        "_findings",
        "_follow",
        "_high",
        "_listen",
        "_listened_inputs",
        "_next_point",
        "_offset_event",
        "_offset_time",
        "_point_event",
        "_regs",
        "_soc",
        "_sync",
        "_time_base",
        "_trip_zone",
        "_window",
    )  # fmt: skip

    def __init__(
        self, clock: Clock, cpu: Cpu, regs: EPwmRegs, time_base: TimeBase, trip_zone: TripZone, *,
        next_point: Callable[[int], int | None], listen: Callable[[int, bool], None], soc: Callable[[int], None],
        sync: Callable[[], None], follow: Callable[[Callable[[], None], bool], None],
    ) -> None:  # fmt: skip
        self._clock, self._findings, self._regs = clock, cpu.findings, regs
        self._time_base, self._trip_zone = time_base, trip_zone
        self._next_point, self._listen = next_point, listen
        self._soc, self._sync, self._follow = soc, sync, follow
        self._filter = regs.registers["DCFCTL"]
        #: Trip inputs that are high, and those that the module listens to (bits).
        self._high = self._listened_inputs = 0
        #: Whether the levels of newly needed inputs are being read, one by one.
        self._choosing = False
        #: Whether the blanking window is open.
        self._window = False
        self._point_event: ClockEvent | None = None
        self._offset_event: ClockEvent | None = None
        self._close_event: ClockEvent | None = None
        self._offset_time = self._close_time = 0
        for name in ("DCTRIPSEL", "TZDCSEL", "DCACTL", "DCBCTL", "DCFCTL", *(f"{signal}TRIPSEL" for signal in SIGNALS)):
            regs.bind(name, write=partial(self._write, name))
        regs.bind("DCFOFFSETCNT", read=self._read_DCFOFFSETCNT)
        regs.bind("DCFWINDOWCNT", read=self._read_DCFWINDOWCNT)

    def reset(self) -> None:
        """Reset the state: no trip input is needed, and no event is active.  The module resets the registers."""
        self._end_blanking()
        self._follow(self.reschedule, False)
        self._choose()

    def input(self, n: int, level: int) -> None:
        """TRIPINn has this level from now on."""
        bit = 1 << n - 1
        self._high = self._high | bit if level else self._high & ~bit
        if not self._choosing:
            self._evaluate()

    # -- from trip inputs to events ------------------------------------------------------------------------------

    def _inputs(self, signal: int) -> int:
        """The trip inputs that make DCAH, DCAL, DCBH or DCBL, as bits."""
        choice = self._regs.DCTRIPSEL.value >> 4 * signal & 0xF
        if choice == _COMBINATION:
            return self._regs.registers[f"{SIGNALS[signal]}TRIPSEL"].value
        return 0 if choice == _RESERVED else 1 << choice

    def _condition(self, event: int) -> int:
        return self._regs.TZDCSEL.value >> 3 * event & 7

    def _holds(self, event: int) -> bool:
        """Whether the condition of an event holds."""
        condition = self._condition(event)
        first = event & 2
        if not 1 <= condition <= 5:
            return False
        high, low = bool(self._high & self._inputs(first)), bool(self._high & self._inputs(first + 1))
        return (not high, high, not low, low, low and not high)[condition - 1]

    def _is_filtered(self, event: int) -> bool:
        """Whether an event is DCEVTFILT (EVT1SRCSEL, EVT2SRCSEL)."""
        control, n = EVENTS[event]
        return bool(self._regs.registers[control].value & (DCACTL.EVT1SRCSEL, DCACTL.EVT2SRCSEL)[n - 1].mask)

    def _passes(self) -> bool:
        """Whether the filter lets its event through now."""
        control = self._filter.value
        if not control & DCFCTL.BLANKE.mask:
            return True
        return self._window == bool(control & DCFCTL.BLANKINV.mask)

    def _evaluate(self) -> None:
        """Update the events: trip inputs, a setting or the window have changed."""
        raw = sum(self._holds(event) << event for event in range(len(EVENTS)))
        filtered = raw >> (self._filter.value & DCFCTL.SRCSEL.mask) & self._passes()
        used = sum(
            (filtered if self._is_filtered(event) else raw >> event & 1) << event for event in range(len(EVENTS))
        )
        for event in self._trip_zone.events(used):
            self._begin(event)

    def _begin(self, event: int) -> None:
        """An event begins: give its SOC and sync pulses."""
        control, n = EVENTS[event]
        word = self._regs.registers[control].value
        if n == 1 and word & DCACTL.EVT1SOCE.mask:
            self._soc(event // 2)
        if n == 1 and word & DCACTL.EVT1SYNCE.mask:
            self._sync()

    def _choose(self) -> None:
        """Listen to the trip inputs that the events depend on, and to no others."""
        wanted = 0
        for event in range(len(EVENTS)):
            condition, first = self._condition(event), event & 2
            if condition in (1, 2, 5):
                wanted |= self._inputs(first)
            if condition in (3, 4, 5):
                wanted |= self._inputs(first + 1)
        before, self._listened_inputs = self._listened_inputs, wanted
        self._high &= wanted
        self._choosing = True
        for n in range(1, 16):
            if (before ^ wanted) >> n - 1 & 1:
                self._listen(n, bool(wanted >> n - 1 & 1))
        self._choosing = False

    # -- the blanking window -------------------------------------------------------------------------------------

    @property
    def _blanks(self) -> bool:
        """Whether a blanking window can have an effect."""
        return bool(self._filter.value & DCFCTL.BLANKE.mask) and any(map(self._is_filtered, range(len(EVENTS))))

    def _end_blanking(self) -> None:
        for event in (self._point_event, self._offset_event, self._close_event):
            self._clock.cancel(event)
        self._point_event = self._offset_event = self._close_event = None
        self._window = False

    def reschedule(self) -> None:
        """Schedule the next point anew, because the path of the counter has changed."""
        self._clock.cancel(self._point_event)
        points = _POINTS[(self._filter.value & DCFCTL.PULSESEL.mask) >> DCFCTL.PULSESEL.lo]
        time = self._next_point(points)
        self._point_event = None if time is None else self._clock.schedule(time, self._point, _POINT_PRIORITY)

    def _point(self) -> None:
        """The counter has reached the point that PULSESEL names: the offset begins."""
        self.reschedule()
        self._clock.cancel(self._offset_event)
        self._offset_event = None
        offset = self._regs.registers["DCFOFFSET"].value
        if offset:
            self._offset_time = self._clock.now + offset * self._time_base.tick
            self._offset_event = self._clock.schedule(self._offset_time, self._open, _OPEN_PRIORITY)
        else:
            self._open()

    def _open(self) -> None:
        """The offset is over: the window begins, or starts again."""
        self._offset_event = None
        length = self._regs.registers["DCFWINDOW"].value
        if length:
            self._clock.cancel(self._close_event)
            self._close_time = self._clock.now + length * self._time_base.tick
            self._close_event = self._clock.schedule(self._close_time, self._close, _CLOSE_PRIORITY)
            self._window = True
            self._evaluate()

    def _close(self) -> None:
        self._close_event = None
        self._window = False
        self._evaluate()

    def _left(self, event: ClockEvent | None, time: int) -> int:
        """The value of a counter that counts down to 0 at `time`, in TBCLK."""
        return -((self._clock.now - time) // self._time_base.tick) if event is not None else 0

    # -- registers -----------------------------------------------------------------------------------------------

    def _write(self, name: str, word: int, lanes: int = ALL) -> None:
        register = self._regs.registers[name]
        register.store(word, lanes)
        if name == "DCTRIPSEL":
            self._check_choices(register.path, register.value)
        if name in ("DCFCTL", "DCACTL", "DCBCTL"):
            self._check_filter()
            self._end_blanking()
            self._follow(self.reschedule, self._blanks)
            if self._blanks:
                self.reschedule()
        self._choose()
        self._evaluate()

    def _check_choices(self, path: str, value: int) -> None:
        for signal, name in enumerate(SIGNALS):
            if value >> 4 * signal & 0xF == _RESERVED:
                self._findings.report(
                    "unmodelled", f"{path}.{name}COMPSEL = {_RESERVED} names no trip input: the signal stays low",
                    object=f"{path}.{name}COMPSEL", value=_RESERVED,
                )  # fmt: skip

    def _check_filter(self) -> None:
        path = f"{self._filter.path}.PULSESEL"
        if self._blanks and not _POINTS[(self._filter.value & DCFCTL.PULSESEL.mask) >> DCFCTL.PULSESEL.lo]:
            self._findings.report(
                "unmodelled", f"{path} = 3 is not modelled: no blanking window comes", object=path, value=3
            )

    def _read_DCFOFFSETCNT(self) -> int:
        return self._left(self._offset_event, self._offset_time)

    def _read_DCFWINDOWCNT(self) -> int:
        return self._left(self._close_event, self._close_time)
