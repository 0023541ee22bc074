"""The pin multiplexer between peripherals and pins: a signal passes while the pin is set to it.

GPIO writes the mux registers; `Gpio` tells who listens.  Mux numbers are (GMUX << 2) + MUX, as in the pin table of
the data sheet (DS, signal multiplexing; HDR pin_map).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from emulator.signals import DutyWire, QuadratureWire, SerialFrame, SerialLine, SpiBus, Wire


class Crossbar:
    """Routes of one chip, by pin and mux number.  `mux(pin)` is the present setting."""

    def __init__(
        self,
        mux: Callable[[int], int],
        on_mux_change: Callable[[Callable[[int, int], None]], None],
        pins: Sequence[Wire],
    ) -> None:
        self._mux = mux
        self._pins = pins
        self._duties: dict[int, list[tuple[int, DutyWire, DutyWire]]] = {}
        #: Pin -> what follows its function: encoder routes, which would else ask the registers at every movement.
        self._encoders: dict[int, list[Callable[[], None]]] = {}
        #: What follows the function of a pin, by pin.
        self._followers: dict[int, list[Callable[[], None]]] = {}
        #: Encoder input -> the pin pairs that can carry it.
        self._pairs: dict[str, list[Sequence[tuple[int, int]]]] = {}
        on_mux_change(self._changed)

    def selected(self, routes: Sequence[tuple[int, int]]) -> bool:
        """Whether every (pin, mux) of `routes` is set."""
        return all(self._mux(pin) == mux for pin, mux in routes)

    def missing(self, routes: Sequence[tuple[int, int]], what: str) -> str:
        """Which pin of `routes` is not set to `what`; empty when all are."""
        for pin, mux in routes:
            if self._mux(pin) != mux:
                return f"GPIO{pin} has function {self._mux(pin)}, where {what} is function {mux}"
        return ""

    def _none_of(self, choices: Sequence[Sequence[tuple[int, int]]], what: str) -> str:
        """Why none of several ways to bring `what` to pins is set; empty when one is."""
        reasons = [self.missing(routes, what) for routes in choices]
        return reasons[0] if all(reasons) else ""

    def _follow(self, routes: Sequence[tuple[int, int]], follow: Callable[[], None]) -> None:
        for pin, _ in routes:
            self._followers.setdefault(pin, []).append(follow)
        follow()

    def spi(
        self, bus: SpiBus, routes: Sequence[tuple[int, int]], others: Sequence[Sequence[tuple[int, int]]]
    ) -> None:  # fmt: skip
        """Words of a module reach its bus while SIMO, SOMI and CLK are all muxed to it.

        `others` are further pins of each of them: where they are set, words go somewhere, but not to the bus.
        """
        choices = [[[first], *([other] for other in more)] for first, more in zip(routes, others, strict=True)]

        def follow() -> None:
            bus.connected = self.selected(routes)
            reasons = [self._none_of(ways, bus.name) for ways in choices]
            bus.missing = next(filter(None, reasons), "")

        self._follow([*routes, *(route for more in others for route in more)], follow)

    def serial_out(self, source: SerialLine, routes: dict[int, int], pin_lines: dict[int, SerialLine]) -> None:
        """Frames of a transmitter appear on each pin muxed to it."""

        def forward(frame: SerialFrame) -> None:
            for pin, mux in routes.items():
                if self._mux(pin) == mux:
                    pin_lines[pin].send(frame)

        source.on_frame(forward)
        self._follow_line(source, routes)

    def serial_in(self, target: SerialLine, routes: dict[int, int], pin_lines: dict[int, SerialLine]) -> None:
        """Frames on a pin reach the receiver while the pin is muxed to it."""
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

            line.on_frame(forward)
            line.on_break(hold)
        self._follow_line(target, routes)

    def _follow_line(self, line: SerialLine, routes: dict[int, int]) -> None:
        choices = [[route] for route in routes.items()]

        def follow() -> None:
            line.missing = self._none_of(choices, line.name)

        self._follow(list(routes.items()), follow)

    def quadrature_in(self, target: QuadratureWire, routes: Sequence[tuple[int, int]], source: QuadratureWire) -> None:
        """Edges of an encoder on two pins reach the module while both are muxed to it."""
        connected = self.selected(routes)
        choices = self._pairs.setdefault(target.name, [])
        choices.append(routes)

        def forward(edges: int, start: int, end: int) -> None:
            if connected:
                target.move(edges, start, end)

        def follow() -> None:
            nonlocal connected
            connected = self.selected(routes)
            target.missing = self._none_of(choices, target.name)

        for pin, _ in routes:
            self._encoders.setdefault(pin, []).append(follow)
        follow()
        source.on_edges(forward)
        target.sync = lambda: source.sync()

    def duty_out(self, pin: int, mux: int, source: DutyWire, target: DutyWire) -> None:
        """A PWM output on its pin: its duty while muxed, the level of the GPIO otherwise."""
        self._duties.setdefault(pin, []).append((mux, source, target))
        # The listener runs before the new duty is stored, so the forwarder is asked afterwards, by the source's owner.
        source.after_change(lambda: self._route(pin))
        self._pins[pin].on_change(lambda _level: self._route(pin))
        self._route(pin)

        def follow() -> None:
            source.missing = self.missing([(pin, mux)], source.name)

        self._follow([(pin, mux)], follow)

    def _route(self, pin: int) -> None:
        for mux, source, target in self._duties[pin]:
            if self._mux(pin) == mux:
                target.set(source.duty, source.period_cycles)
                return
        for _, _, target in self._duties[pin]:
            target.set(float(self._pins[pin].level), 0)

    def _changed(self, pin: int, mux: int) -> None:
        if pin in self._duties:
            self._route(pin)
        for follow in self._encoders.get(pin, ()):
            follow()
        for follow in self._followers.get(pin, ()):
            follow()
