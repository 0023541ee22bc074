"""EPWMSYNCPER: the pulse of an ePWM that loads the DACs of comparator subsystems, starts their ramps, clears latches.

With HRPCTL.PWMSYNCSEL = 0 it comes when the counter is at TBPRD, with 1 when it is at 0.  The clock has an event for it
only while there is a listener and the counter runs.
Not modelled: PWMSYNCSELX, which selects CMPC and CMPD as its source.
Part of `epwm.py`.  Sources: TRM ePWM, time-base submodule; HDR F2837xS_epwm.h.
"""

from __future__ import annotations

from collections.abc import Callable

from emulator.clock import Clock, ClockEvent
from emulator.peripherals.epwm_shadow import AT_PERIOD, AT_ZERO
from emulator.registers.epwm import EPwmRegs
from emulator.registers.epwm_output import HRPCTL
from emulator.signal import Signal


class SyncPulse:
    """EPWMSYNCPER of one module.

    `next_point(points)` is the cycle when the counter next reaches 0 or TBPRD; None: never.  `follow(reschedule, on)`
    is called when this begins (or ceases) to need changes of the counter's path.
    """

    __slots__ = ("_clock", "_event", "_follow", "_next_point", "_select", "_used", "pulsed")

    def __init__(
        self, clock: Clock, regs: EPwmRegs, next_point: Callable[[int], int | None],
        follow: Callable[[Callable[[], None], bool], None],
    ) -> None:  # fmt: skip
        self._clock = clock
        self._next_point, self._follow = next_point, follow
        self._select = regs.registers["HRPCTL"]
        self._used = False
        #: Every pulse.
        self.pulsed: Signal[[]] = Signal(self._wanted)
        self._event: ClockEvent | None = None
        regs.bind("HRPCTL", write=self._write_HRPCTL)

    def _wanted(self, wanted: bool) -> None:
        self._used = wanted
        self._follow(self.reschedule, wanted)
        self.reschedule()

    def reschedule(self) -> None:
        """Schedule the pulse anew: the counter's path, the choice or the listeners have changed."""
        if self._event is not None:
            self._clock.cancel(self._event)
            self._event = None
        if self._used:
            time = self._next_point(AT_ZERO if self._select.value & HRPCTL.PWMSYNCSEL.mask else AT_PERIOD)
            if time is not None:
                self._event = self._clock.schedule(time, self._pulse)

    def _pulse(self) -> None:
        self._event = None
        self.reschedule()
        self.pulsed.emit()

    def _write_HRPCTL(self, word: int, lanes: int) -> None:
        self._select.store(word)
        self.reschedule()
