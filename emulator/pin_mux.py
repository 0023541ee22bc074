"""The pin multiplexer between peripherals and pins: a signal passes while the pin is set to it.

The GPIO module holds the mux registers; `Gpio` reports their changes.  Mux numbers are (GMUX << 2) + MUX, as in the pin
table of the data sheet (DS, signal multiplexing; HDR pin_map).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Final, Protocol, TypeAlias

from emulator.can_bus import CanPort
from emulator.clock import Clock, ClockEvent
from emulator.signal import Signal
from emulator.signals import DutyWire, I2cBus, PwmWire, QuadratureWire, SerialFrame, SerialLine, SpiBus, Wire

#: Priority of an event that runs after all changes of pins in the same cycle.
_SAMPLE_PRIORITY: Final = 3
#: The pins that can carry a signal, each with its mux number there.
Routes: TypeAlias = Mapping[int, int]


class Pads(Protocol):
    """GPIO as the multiplexer sees it: the function of each pin, its input after inversion and qualification."""

    def mux(self, pin: int) -> int:
        """The function of a pin."""

    @property
    def mux_changed(self) -> Signal[int, int]:
        """(pin, mux): after every change of a pin's function."""

    def input(self, pin: int) -> int:
        """The level that a module sees of a pin."""

    @property
    def input_changed(self) -> Sequence[Signal[int]]:
        """A signal for each pin, (level): every change of the level that a module sees."""


class Crossbar:
    """Connects the module signals of one chip with its pins, by pin and mux number.  `pads` has the present setting."""

    def __init__(self, clock: Clock, pads: Pads, pins: Sequence[Wire]) -> None:
        self._clock = clock
        self._pads = pads
        self._mux = pads.mux
        self._pins = pins
        self._duties: dict[int, list[tuple[int, PwmWire, DutyWire]]] = {}
        #: Pin -> the functions to call when its mux changes.
        self._followers: dict[int, list[Callable[[], None]]] = {}
        pads.mux_changed.connect(self._changed)

    def _carried(self, routes: Routes) -> bool:
        """Whether a pin carries the signal."""
        return any(self._mux(pin) == mux for pin, mux in routes.items())

    def _nowhere(self, routes: Routes, what: str, beside: Iterable[Routes] = ()) -> str:
        """Why no pin carries `what`: the function of one of its pins instead; empty if a pin carries it.

        It is the pin nearest to one that carries a signal of `beside`, those of the same module: boards have them side
        by side.  If none does, it is the first.
        """
        if self._carried(routes):
            return ""
        carriers = [pin for other in beside for pin, mux in other.items() if self._mux(pin) == mux]
        pin = min(routes, key=lambda pin: min((abs(pin - other) for other in carriers), default=0))
        mux = routes[pin]
        return f"GPIO{pin} has function {self._mux(pin)}, where {what} is function {mux}"

    def _follow(self, routes: Iterable[int], follow: Callable[[], None]) -> None:
        for pin in routes:
            self._followers.setdefault(pin, []).append(follow)
        follow()

    def bus(self, bus: I2cBus | CanPort, lines: Sequence[Routes], wired: Sequence[int]) -> None:
        """Connect a module with its bus while each of `lines` (SDA, SCL; CANTX, CANRX) has a pin.

        `wired` are the pins that lead to the bus; what is on other pins does not reach it.  Empty: all pins lead to it.
        """
        on_bus = _on_bus(lines, wired)

        def follow() -> None:
            bus.connected = all(map(self._carried, on_bus))
            bus.missing = next(filter(None, (self._nowhere(routes, bus.name, lines) for routes in lines)), "")

        for routes in lines:
            self._follow(routes, follow)

    def spi(self, bus: SpiBus, lines: Sequence[Routes], wired: Sequence[int]) -> None:
        """Connect a master with its bus while CLK, the last of `lines` (SIMO, SOMI, CLK), has a pin; see `bus`.

        SIMO and SOMI carry the bits while they have a pin: a part that only listens needs no SOMI.
        """
        on_bus = _on_bus(lines, wired)

        def follow() -> None:
            bus.simo, bus.somi, bus.connected = map(self._carried, on_bus)
            bus.no_simo, bus.no_somi, bus.missing = (
                self._nowhere(routes, f"{line} of {bus.name}", lines)
                for routes, line in zip(lines, ("SIMO", "SOMI", "CLK"), strict=True)
            )

        for routes in lines:
            self._follow(routes, follow)

    def level_out(self, routes: Routes, driver: str, level: int) -> Callable[[int], None]:
        """A function that puts the level of a module's output on the pins muxed to it; `level` is the first level."""
        pins: list[Wire] = []

        def put(new: int) -> None:
            nonlocal level
            level = new
            for pin in pins:
                pin.drive(driver, new)

        def follow() -> None:
            for pin in pins:
                pin.drive(driver, None)
            pins[:] = [self._pins[pin] for pin, mux in routes.items() if self._mux(pin) == mux]
            put(level)

        self._follow(routes, follow)
        return put

    def serial_out(self, source: SerialLine, routes: Routes, pin_lines: dict[int, SerialLine]) -> None:
        """Put the frames of a transmitter on each pin that is muxed to it."""
        lines: list[SerialLine] = []

        def forward(frame: SerialFrame) -> None:
            for line in lines:
                line.send(frame)

        def follow() -> None:
            lines[:] = [pin_lines[pin] for pin, mux in routes.items() if self._mux(pin) == mux]

        source.sent.connect(forward)
        self._follow(routes, follow)
        self._follow_line(source, routes)

    def serial_in(self, target: SerialLine, routes: Routes, pin_lines: dict[int, SerialLine]) -> None:
        """Give the frames on a pin to the receiver while the pin is muxed to it."""
        for pin, mux in routes.items():
            line = pin_lines[pin]

            def forward(frame: SerialFrame, pin: int = pin, mux: int = mux) -> None:
                if self._mux(pin) == mux:
                    target.send(frame)
                elif target.missing:
                    target.miss(pin)

            def hold(low: bool, pin: int = pin, mux: int = mux) -> None:
                if self._mux(pin) == mux or not low:
                    target.hold_low(low)

            line.sent.connect(forward)
            line.break_changed.connect(hold)
        self._follow_line(target, routes)

    def _follow_line(self, line: SerialLine | DutyWire, routes: Routes) -> None:
        def follow() -> None:
            line.missing = self._nowhere(routes, line.name)

        self._follow(routes, follow)

    def quadrature_in(
        self, target: QuadratureWire, a: Routes, b: Routes, sources: Mapping[tuple[int, int], QuadratureWire]
    ) -> None:
        """Give the edges of an encoder on a pair of pins (A, B) to the module while both are muxed to it.

        Edges of plain pin levels reach it too, with A and B each on any of its pins.
        """
        stops: list[Callable[[], None]] = []
        lines = QuadratureLevels(self._clock, self._pads, target)

        def follow() -> None:
            for stop in stops:
                stop()
            stops.clear()
            for (pin_a, pin_b), source in sources.items():
                if self._mux(pin_a) == a[pin_a] and self._mux(pin_b) == b[pin_b]:
                    stops.append(source.moved.connect(target.move))
                    stops.append(target.looked_at.connect(source.sync))
            target.missing_a = self._nowhere(a, f"{target.name}A", (b,))
            target.missing_b = self._nowhere(b, f"{target.name}B", (a,))
            lines.connect(self._carrier(a), self._carrier(b))

        self._follow({**a, **b}, follow)

    def level_in(self, routes: Routes, listener: Callable[[int], None]) -> None:
        """Call `listener(level)` at every change of the pin that carries an input.  A new pin is no change."""
        carrier: int | None = None
        stop: Callable[[], None] | None = None

        def follow() -> None:
            nonlocal carrier, stop
            pin = self._carrier(routes)
            if pin != carrier:
                if stop is not None:
                    stop()
                carrier, stop = pin, None if pin is None else self._pads.input_changed[pin].connect(listener)

        self._follow(routes, follow)

    def _carrier(self, routes: Routes) -> int | None:
        """The pin that carries an input (the first of several); None if no pin does."""
        return next((pin for pin, mux in routes.items() if self._mux(pin) == mux), None)

    def duty_out(self, source: PwmWire, routes: Routes, targets: Mapping[int, DutyWire]) -> None:
        """Put a PWM output on the pins muxed to it: its level on the pin, its duty on the target.

        If a pin is not muxed to it, or is in high impedance, the target has the level of the pin.
        """
        for pin, mux in routes.items():
            self._duties.setdefault(pin, []).append((mux, source, targets[pin]))
            route = partial(self._route, pin)
            # Report it after the change: before it, a listener would still see the old duty.
            source.duty_changed.connect(route)
            self._pins[pin].noticed.connect(route)
            route()
        self._follow_line(source, routes)

    def _route(self, pin: int, _level: int = 0) -> None:
        for mux, source, target in self._duties[pin]:
            if self._mux(pin) == mux and not source.released:
                target.set(source.duty, source.period_cycles)
                return
        for _, _, target in self._duties[pin]:
            target.set(float(self._pins[pin].level), 0)

    def _changed(self, pin: int, mux: int) -> None:
        for at, source, _ in self._duties.get(pin, ()):
            self._pins[pin].follow(source.name, source if mux == at else None)
        if pin in self._duties:
            self._route(pin)
        for follow in self._followers.get(pin, ()):
            follow()


class QuadratureLevels:
    """Turns the levels of the pins A and B into quadrature edges, for square waves on the pins of an eQEP.

    The decoder samples once a cycle.  If both lines change in one cycle, that is a clash.  The levels are those that
    GPIO gives to modules, after inversion and qualification.
    """

    #: (A, B) -> quarter of a line: A leads B going forward.
    _QUARTER: Final = {(0, 0): 0, (1, 0): 1, (1, 1): 2, (0, 1): 3}

    def __init__(self, clock: Clock, pads: Pads, target: QuadratureWire) -> None:
        self._clock, self._pads, self._target = clock, pads, target
        self._lines: tuple[int | None, int | None] = (None, None)
        self._stops: list[Callable[[], None]] = []
        self._quarter = 0
        self._sample_event: ClockEvent | None = None

    def connect(self, a: int | None, b: int | None) -> None:
        """Take A and B from these pins.  None: no pin carries the line, so it is low (CHOICE)."""
        if (a, b) == self._lines:
            return
        for stop in self._stops:
            stop()
        self._lines = a, b
        changed = self._pads.input_changed
        self._stops = [changed[pin].connect(self._changed) for pin in self._lines if pin is not None]
        # CHOICE: a change to other pins is no edge.
        self._quarter = self._now()

    def _now(self) -> int:
        a, b = [0 if pin is None else self._pads.input(pin) for pin in self._lines]
        return self._QUARTER[a, b]

    def _changed(self, _level: int) -> None:
        if self._sample_event is None:
            self._sample_event = self._clock.after(0, self._sample, priority=_SAMPLE_PRIORITY)

    def _sample(self) -> None:
        self._sample_event = None
        before, self._quarter = self._quarter, self._now()
        steps = (self._quarter - before) & 3
        target, now = self._target, self._clock.now
        # Take the pair's position from the pins.  Their levels were not known here before one of them changed.
        target.position += (before - target.position) & 3
        if steps == 2:
            target.clash(now)
        elif steps:
            target.move(1 if steps == 1 else -1, now, now)


def _on_bus(lines: Sequence[Routes], wired: Sequence[int]) -> list[Routes]:
    """The routes of each line that lead to a bus."""
    return [{pin: routes[pin] for pin in wired if pin in routes} or routes for routes in lines]
