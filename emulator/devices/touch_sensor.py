"""LEGO touch sensor 9843: a switch with 2.2 kOhm in series to ground, read by a pin with a pull-up.

Modelled: active low, the voltage divider with the pull-up against the pin's thresholds, contact bounce.
Not modelled: travel and force.
Time: one event for each bounce of a realistic sensor, none for an ideal one.
Sources: NXT (published measurements of the switch: 2.2 kOhm).
"""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Final

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US, Clock, ClockEvent
from emulator.signal import Signal
from emulator.signals import Wire

SERIES_OHM: Final = 2_200.0
#: CHOICE: contact bounce lasts 1 to 10 ms (unconfirmed), with one to four bounces.
BOUNCE_CYCLES: Final = (1 * CYCLES_PER_MS, 10 * CYCLES_PER_MS)
MAX_BOUNCES: Final = 4


class TouchSensor:
    """The switch on `pin`.  With `pull_up_ohm` None the pin's own pull counts (without one the pin floats).

    `threshold_v` is where the pin's input changes (CHOICE: half-way between 0.8 V and 2.0 V; between those no level is
    guaranteed, and `guaranteed_low` tells whether a closed switch is surely low).
    """

    def __init__(
        self,
        clock: Clock,
        pin: Wire,
        *,
        rng: random.Random,
        ideal: bool = True,
        pull_up_ohm: float | None = 10_000.0,
        supply_v: float = 3.3,
        low_v: float = 0.8,
        threshold_v: float = 1.4,
    ) -> None:
        if pull_up_ohm is not None and pull_up_ohm <= 0.0:
            raise ValueError(f"touch sensor on {pin.name}: pull-up of {pull_up_ohm} ohm; expected more than 0, or None")
        self.clock = clock
        self.pin = pin
        self.ideal = ideal
        self.pressed = False
        #: (pressed): the button is pressed or released.
        self.pressed_changed: Signal[bool] = Signal()
        #: The last argument of `press`, and of `feed`, which overrides it.
        self._asked = False
        self._fed: bool | None = None
        self._closed = False
        self._rng = rng
        self._events: list[ClockEvent] = []
        #: Voltage of the pin while the contact is closed.
        self.pressed_v = 0.0 if pull_up_ohm is None else supply_v * SERIES_OHM / (pull_up_ohm + SERIES_OHM)
        #: Whether that is a low level by the pin's data sheet.
        self.guaranteed_low = self.pressed_v <= low_v
        self._closed_level = 0 if self.pressed_v < threshold_v else 1
        if pull_up_ohm is not None:
            pin.set_pull(1)

    def press(self, pressed: bool) -> None:
        """Press or release the button now.  While `feed` overrides it, this takes effect afterwards."""
        self._asked = pressed
        if self._fed is None:
            self._push(pressed)

    def feed(self, pressed: bool | None) -> None:
        """Press or release the button from now on, whatever `press` says.  None: `press` counts again."""
        self._fed = pressed
        self._push(self._asked if pressed is None else pressed)

    def _push(self, pressed: bool) -> None:
        if pressed == self.pressed:
            return
        self.pressed = pressed
        for event in self._events:
            self.clock.cancel(event)
        self._events.clear()
        if not self.ideal:
            self._plan_bounces(pressed)
        self._contact(pressed)
        self.pressed_changed.emit(pressed)

    def _plan_bounces(self, final: bool) -> None:
        """Schedule pairs of changes after the first contact; the last change, to the final state, ends the bounce."""
        duration = self._rng.randint(*BOUNCE_CYCLES)
        bounces = self._rng.randint(1, MAX_BOUNCES)
        inside = sorted(self._rng.sample(range(CYCLES_PER_US, duration), 2 * bounces - 1))
        now = self.clock.now
        state = final
        for offset in (*inside, duration):
            state = not state
            self._events.append(self.clock.schedule(now + offset, self._change(state)))

    def _change(self, closed: bool) -> Callable[[], None]:
        return lambda: self._contact(closed)

    def _contact(self, closed: bool) -> None:
        if closed != self._closed:
            self._closed = closed
            self.pin.drive("touch sensor", self._closed_level if closed else None)
