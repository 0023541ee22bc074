"""Named wires: the only way in which peripherals, devices and the bench meet.

A wire carries what its kind of signal needs and no more: a logic level with tri-state drivers, a voltage, a
PWM duty (with edges for who wants them), quadrature edges, UART frames, SPI words, I2C bytes.  Who drives and who
listens is decided by a board.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final, Protocol

from emulator.clock import NEVER


class LevelSource(Protocol):
    """Something whose level can be asked at any time, and that tells its edges only while somebody wants them."""

    @property
    def level(self) -> int | None:
        """The level now; None: high impedance."""

    def stays_until(self) -> int:
        """The first cycle at which the level may be another one without an event; NEVER: there is none."""

    def on_change(self, listener: Callable[[int | None], None]) -> None:
        """Call `listener(level)` at every edge from now on."""

    def forget(self, listener: Callable[[int | None], None]) -> None:
        """End an `on_change`."""


class Wire:
    """A logic level with any number of tri-state drivers and a pull.

    `level` is 0 or 1.  Drivers that disagree give 0 (the stronger pull-down of a push-pull stage) and are
    visible as `contention`.  With nobody driving, `pull` decides.

    A driver may be a `LevelSource` (`follow`).  Its level is asked when somebody looks, and it makes edges only while
    somebody wants them: a listener of `on_change`, or an `attend` without its `leave`.
    """

    __slots__ = (
        "_attention", "_computed", "_drivers", "_level", "_listeners", "_overhearing", "_sources", "contention", "name",
        "pull",
    )  # fmt: skip

    def __init__(self, name: str, pull: int = 0) -> None:
        self.name = name
        self.pull = pull
        self.contention = False
        self._level = pull
        self._drivers: dict[str, int] = {}
        self._listeners: list[Callable[[int], None]] = []
        self._overhearing: list[Callable[[int], None]] = []
        #: Drivers that are computed, each with what hears its edges.
        self._sources: dict[str, tuple[LevelSource, Callable[[int | None], None]]] = {}
        self._attention = 0
        #: Who is told when the wire begins and ends to have a computed level.
        self._computed: list[Callable[[bool], None]] = []

    @property
    def level(self) -> int:
        """0 or 1, now."""
        if self._sources and not self._attention:
            self._look()
        return self._level

    def stays_until(self) -> int:
        """The first cycle at which the level may be another one without an event; NEVER: there is none."""
        if self._attention:
            return NEVER
        return min((source.stays_until() for source, _ in self._sources.values()), default=NEVER)

    def drive(self, driver: str, level: int | None) -> None:
        """`driver` puts `level` on the wire; None releases it (high impedance)."""
        if level is None:
            self._drivers.pop(driver, None)
        else:
            self._drivers[driver] = level
        self._resolve()

    def follow(self, driver: str, source: LevelSource | None) -> None:
        """`driver` puts the level of `source` on the wire, whatever that is at each instant; None ends it."""
        was_computed = bool(self._sources)
        old = self._sources.pop(driver, None)
        if old is not None and self._attention:
            old[0].forget(old[1])
        if source is None:
            if old is not None:
                self.drive(driver, None)
        else:
            hear = partial(self.drive, driver)
            self._sources[driver] = source, hear
            if self._attention:
                source.on_change(hear)
            self.drive(driver, source.level)
        computed = bool(self._sources)
        if computed != was_computed:
            for listener in self._computed:
                listener(computed)

    def set_pull(self, pull: int) -> None:
        """Change the level of the undriven wire."""
        self.pull = pull
        self._resolve()

    def on_change(self, listener: Callable[[int], None]) -> None:
        """Call `listener(level)` at every change of the level."""
        self.attend()
        self._listeners.append(listener)

    def forget(self, listener: Callable[[int], None]) -> None:
        """End an `on_change`."""
        self._listeners.remove(listener)
        self.leave()

    def overhear(self, listener: Callable[[int], None], computed: Callable[[bool], None] | None = None) -> None:
        """Call `listener(level)` at the changes that come to light anyway: computed levels make no edges for it.

        `computed(True)` is called when a first source begins to drive the wire, `computed(False)` when the last ends.
        """
        self._overhearing.append(listener)
        if computed is not None:
            self._computed.append(computed)

    def attend(self) -> None:
        """Somebody wants every edge from now on, and hears them in another way than by `on_change`."""
        self._attention += 1
        if self._attention == 1 and self._sources:
            for source, hear in self._sources.values():
                source.on_change(hear)
            self._look()

    def leave(self) -> None:
        """End an `attend`."""
        self._attention -= 1
        if not self._attention:
            for source, hear in self._sources.values():
                source.forget(hear)

    def driven(self) -> bool:
        """Whether any driver is active."""
        return bool(self._drivers)

    def drivers(self) -> set[str]:
        """Who drives the wire now."""
        return set(self._drivers)

    def _look(self) -> None:
        for driver, (source, _) in self._sources.items():
            self.drive(driver, source.level)

    def _resolve(self) -> None:
        drivers = self._drivers
        if len(drivers) == 1:
            # The usual wire: one driver, nobody to contend with.
            (level,) = drivers.values()
            self.contention = False
        else:
            levels = set(drivers.values())
            self.contention = len(levels) > 1
            level = min(levels) if levels else self.pull
        if level != self._level:
            self._level = level
            for listener in self._overhearing:
                listener(level)
            for listener in self._listeners:
                listener(level)


class AnalogWire:
    """A voltage.  `source(cycles) -> volts` is asked when somebody samples: what drives the wire, told to listeners.

    Outside of the chip one source is connected; while the chip itself drives the wire, that one does not count.
    A source that is `steady` gives one voltage until another one takes its place, which `on_step` tells; any other
    may change from one cycle to the next without a word.
    """

    __slots__ = (
        "_connected", "_connected_steady", "_driven", "_driven_steady", "_listeners", "_step_listeners", "name",
        "source",
    )  # fmt: skip

    def __init__(self, name: str) -> None:
        self.name = name
        self._connected: Callable[[int], float] = lambda _cycles: 0.0
        self._connected_steady = True
        self._driven: Callable[[int], float] | None = None
        self._driven_steady = False
        self._listeners: list[Callable[[int, float], None]] = []
        self._step_listeners: list[Callable[[], None]] = []
        self.source: Callable[[int], float] = self._connected

    def connect(self, source: Callable[[int], float], *, steady: bool = False) -> None:
        """What the outside of the chip has on the wire from now on: `source(cycles) -> volts`."""
        self._connected, self._connected_steady = source, steady
        self._choose()
        self._step()

    def drive(self, source: Callable[[int], float] | None, *, steady: bool = False) -> None:
        """What the chip drives the wire with; None: it lets go."""
        self._driven, self._driven_steady = source, steady
        self._choose()
        self._step()

    @property
    def steady(self) -> bool:
        """Whether the voltage stays as it is until `on_step` tells that it does not."""
        return self._connected_steady if self._driven is None else self._driven_steady

    def volts(self, cycles: int) -> float:
        """The voltage, for a part that always sees it: no sample, of which anybody is told."""
        return (self._driven or self._connected)(cycles)

    def on_step(self, listener: Callable[[], None]) -> None:
        """Call `listener()` whenever something else drives the wire from now on."""
        self._step_listeners.append(listener)

    def on_sample(self, listener: Callable[[int, float], None]) -> None:
        """Call `listener(cycles, volts)` whenever somebody samples; without a listener it costs nothing."""
        self._listeners.append(listener)
        self._choose()

    def _choose(self) -> None:
        self.source = self._driven or self._connected
        if self._listeners:
            self.source = partial(self._heard, self.source)

    def _step(self) -> None:
        for listener in self._step_listeners:
            listener()

    def _heard(self, source: Callable[[int], float], cycles: int) -> float:
        volts = source(cycles)
        for listener in self._listeners:
            listener(cycles, volts)
        return volts


class DutyWire:
    """A PWM output seen by something slower than its period: duty 0..1 and period in cycles.

    A steady level is duty 0 or 1 with period 0.  `missing` says why no pin carries the output, while none does.
    """

    __slots__ = ("_after", "_listeners", "duty", "missing", "name", "period_cycles")

    def __init__(self, name: str) -> None:
        self.name = name
        self.duty = 0.0
        self.period_cycles = 0
        self.missing = ""
        self._listeners: list[Callable[[], None]] = []
        self._after: list[Callable[[], None]] = []

    def before_change(self, listener: Callable[[], None]) -> None:
        """Call `listener()` just *before* the duty changes, so that a plant can be integrated up to now."""
        self._listeners.append(listener)

    def after_change(self, listener: Callable[[], None]) -> None:
        """Call `listener()` when a new duty is on the wire."""
        self._after.append(listener)

    def set(self, duty: float, period_cycles: int) -> None:
        """Put a new duty on the wire."""
        if duty != self.duty or period_cycles != self.period_cycles:
            for listener in self._listeners:
                listener()
            self.duty = duty
            self.period_cycles = period_cycles
            for listener in self._after:
                listener()


class PwmWire(DutyWire):
    """An output of an ePWM: its duty for what is slower than its period, its level and edges for what is not.

    The module gives `ask() -> level` and `until() -> cycle` of the next edge, and is told by `watch()` whenever
    `watched` has changed: whether somebody wants the edges, which it then reports by `tell`.  `released`: the output is
    in high impedance, its duty means nothing.
    """

    __slots__ = ("_edges", "_told", "ask", "released", "until", "watch", "watched")

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.released = False
        self.watched = False
        self.ask: Callable[[], int | None] = lambda: 0
        self.until: Callable[[], int] = lambda: NEVER
        self.watch: Callable[[], None] = lambda: None
        self._told: int | None = 0
        self._edges: list[Callable[[int | None], None]] = []

    @property
    def level(self) -> int | None:
        """The level now; None: high impedance."""
        return self.ask()

    def stays_until(self) -> int:
        """The first cycle at which the level may be another one without an event; NEVER: there is none."""
        return NEVER if self.watched else self.until()

    def on_change(self, listener: Callable[[int | None], None]) -> None:
        """Call `listener(level)` at every edge."""
        self._edges.append(listener)
        if not self.watched:
            self._told = self.ask()
            self.watched = True
            self.watch()

    def forget(self, listener: Callable[[int | None], None]) -> None:
        """End an `on_change`."""
        self._edges.remove(listener)
        if not self._edges:
            self.watched = False
            self.watch()

    def tell(self, level: int | None) -> None:
        """The output has this level now; who wants edges is told if that is one."""
        if level != self._told:
            self._told = level
            for listener in list(self._edges):
                listener(level)

    def put(self, duty: float, period_cycles: int, released: bool) -> None:
        """`set`, and go to high impedance or leave it."""
        if released == self.released:
            self.set(duty, period_cycles)
            return
        for listener in self._listeners:
            listener()
        self.released, self.duty, self.period_cycles = released, duty, period_cycles
        for listener in self._after:
            listener()


class QuadratureWire:
    """The A/B pair of an incremental encoder, in whole edges (4 a line).

    The source reports `move(edges, start, end)`: `edges` equally spaced between two times; positive means A
    leads B.  A reader calls `sync` first, so that a lazily integrated plant has moved up to now.  `missing` says why
    no pins carry the pair, while none do.
    """

    __slots__ = ("_clashes", "_listeners", "missing", "name", "position", "sync")

    def __init__(self, name: str) -> None:
        self.name = name
        self.position = 0
        self.missing = ""
        self.sync: Callable[[], None] = lambda: None
        self._listeners: list[Callable[[int, int, int], None]] = []
        self._clashes: list[Callable[[int], None]] = []

    def on_edges(self, listener: Callable[[int, int, int], None]) -> None:
        """Call `listener(edges, start_cycles, end_cycles)` for every movement."""
        self._listeners.append(listener)

    def on_clash(self, listener: Callable[[int], None]) -> None:
        """Call `listener(cycles)` when both lines changed at once: nobody can say which way."""
        self._clashes.append(listener)

    def clash(self, cycles: int) -> None:
        """A and B changed in the same cycle."""
        self.position += 2
        for listener in self._clashes:
            listener(cycles)

    def move(self, edges: int, start: int, end: int) -> None:
        """The shaft turned by `edges` between the virtual times `start` and `end`."""
        if edges:
            self.position += edges
            for listener in self._listeners:
                listener(edges, start, end)


@dataclass(frozen=True, slots=True)
class SerialFrame:
    """One asynchronous character on a line.

    `start` and `end` are cycles of the start bit's edge and of the end of the stop bit; `bit_cycles` the
    length of a bit as sent, which a receiver compares with its own.  `parity` is None, "even" or "odd".
    """

    data: int
    start: int
    end: int
    bit_cycles: float
    data_bits: int = 8
    parity: str | None = None
    stop_bits: int = 1
    framing_error: bool = False


class SerialLine:
    """One direction of an asynchronous serial link.

    `missing` says why no pin carries the line, while none does.
    """

    __slots__ = ("_break_listeners", "_listeners", "_missed", "broken", "missing", "name")

    def __init__(self, name: str) -> None:
        self.name = name
        self.broken = False
        self.missing = ""
        self._listeners: list[Callable[[SerialFrame], None]] = []
        self._missed: list[Callable[[int], None]] = []
        self._break_listeners: list[Callable[[bool], None]] = []

    def on_frame(self, listener: Callable[[SerialFrame], None]) -> None:
        """Call `listener(frame)` at the end of each frame's stop bit."""
        self._listeners.append(listener)

    def on_break(self, listener: Callable[[bool], None]) -> None:
        """Call `listener(low)` when the line goes permanently low, and when it is released."""
        self._break_listeners.append(listener)

    def on_missed(self, listener: Callable[[int], None]) -> None:
        """Call `listener(pin)` for each frame that came to a pin of this line while none carried it."""
        self._missed.append(listener)

    def miss(self, pin: int) -> None:
        """A frame came to GPIO`pin`, which is not set to this line."""
        for listener in self._missed:
            listener(pin)

    def send(self, frame: SerialFrame) -> None:
        """Called by the transmitter when the stop bit has ended."""
        for listener in self._listeners:
            listener(frame)

    def hold_low(self, low: bool) -> None:
        """Pull the line low (unpowered or resetting peer), or release it."""
        if low != self.broken:
            self.broken = low
            for listener in self._break_listeners:
                listener(low)


class SpiSlave(Protocol):
    """What an SPI device offers to a bus."""

    def select(self, level: int) -> None:
        """Chip select changed: 0 selects (active low), 1 ends the transaction."""

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int | None:
        """Shift `length` bits in and out, most significant first; None leaves SDO in high impedance."""


class SpiBus:
    """SIMO, SOMI and CLK with the slaves hung on it; chip selects are `Wire`s.

    `connected` is False while the pins belong to somebody else (`missing` says which): then words reach no slave, and
    nobody answers.
    """

    __slots__ = ("_deselected", "_slaves", "_word_listeners", "addressed", "connected", "idle_in", "missing", "name")

    def __init__(self, name: str, idle_in: int = 0) -> None:
        self.name = name
        self.idle_in = idle_in
        self.connected = True
        self.missing = ""
        #: Whether somebody was selected at the end of the latest word (or nobody could be).
        self.addressed = True
        self._slaves: list[tuple[Wire, SpiSlave]] = []
        self._deselected: Callable[[Wire], None] = lambda _chip_select: None
        self._word_listeners: list[Callable[[int, int], None]] = []

    def attach(self, chip_select: Wire, slave: SpiSlave) -> None:
        """Hang `slave` on the bus, selected by a low level of `chip_select`."""
        self._slaves.append((chip_select, slave))
        chip_select.on_change(slave.select)
        chip_select.on_change(lambda level: self._deselected(chip_select) if level else None)

    @property
    def selects(self) -> list[Wire]:
        """The chip selects of the slaves, each once."""
        return list({id(select): select for select, _ in self._slaves}.values())

    def on_deselect(self, listener: Callable[[Wire], None]) -> None:
        """Call `listener(chip_select)` when a chip select has risen; the master's, there is one."""
        self._deselected = listener

    def on_word(self, listener: Callable[[int, int], None]) -> None:
        """Call `listener(simo, somi)` at the end of each word that the pins carried: its bits on both lines."""
        self._word_listeners.append(listener)

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int:
        """One word; what nobody drives reads as `idle_in` on every bit."""
        answer = (1 << length) - 1 if self.idle_in else 0
        self.addressed = not self._slaves
        if self.connected:
            for chip_select, slave in self._slaves:
                if chip_select.level == 0:
                    self.addressed = True
                    bits = slave.exchange(out_bits, length, cpol, cpha)
                    if bits is not None:
                        answer = bits
            for listener in self._word_listeners:
                listener(out_bits, answer)
        return answer


class I2cTarget(Protocol):
    """What an I2C device offers to a bus.  Every device of a bus sees its STARTs and STOPs."""

    def start(self) -> None:
        """A START, or a repeated one: whoever was addressed is so no more."""

    def addressed(self, reading: bool) -> bool:
        """Its address with R/W = `reading`; whether it acknowledges."""

    def write(self, byte: int) -> bool:
        """A byte from the controller; whether it is acknowledged."""

    def read(self) -> int:
        """The byte that it puts on SDA."""

    def stop(self) -> None:
        """A STOP."""


#: 7-bit addresses that the bus specification leaves to devices (the others mean something else: general call, 10 bits).
FIRST_I2C_ADDRESS: Final = 0x08
LAST_I2C_ADDRESS: Final = 0x77


class I2cBus:
    """SDA and SCL, both open drain with their pull-ups, and the targets hung on them by their 7-bit addresses.

    `connected` is False while the pins belong to somebody else (`missing` says which): then no target sees anything,
    and nobody acknowledges.  `taken` tells that a second controller, which is none of the modelled ones, has the bus.
    """

    __slots__ = ("_addressed", "_taken_listeners", "_targets", "connected", "missing", "name", "taken")

    def __init__(self, name: str) -> None:
        self.name = name
        self.connected = True
        self.missing = ""
        self.taken = False
        self._targets: list[tuple[int, I2cTarget]] = []
        self._addressed: list[I2cTarget] = []
        self._taken_listeners: list[Callable[[bool], None]] = []

    def attach(self, address: int, target: I2cTarget) -> None:
        """Hang `target` on the bus under its 7-bit `address`.  Raises ValueError for one that no device can have."""
        if not FIRST_I2C_ADDRESS <= address <= LAST_I2C_ADDRESS:
            raise ValueError(f"I2C address {address:#04x}: want {FIRST_I2C_ADDRESS:#04x}..{LAST_I2C_ADDRESS:#04x}")
        self._targets.append((address, target))

    def on_taken(self, listener: Callable[[bool], None]) -> None:
        """Call `listener(taken)` at the START and at the STOP of a second controller."""
        self._taken_listeners.append(listener)

    def take(self, taken: bool) -> None:
        """A second controller makes a START, or its STOP."""
        if taken != self.taken:
            self.taken = taken
            for listener in self._taken_listeners:
                listener(taken)

    def start(self) -> None:
        """A START or a repeated START."""
        self._addressed.clear()
        if self.connected:
            for _, target in self._targets:
                target.start()

    def address(self, address: int, reading: bool) -> bool:
        """The byte behind a START; whether somebody acknowledges."""
        if self.connected:
            self._addressed += [target for own, target in self._targets if own == address and target.addressed(reading)]
        return bool(self._addressed)

    def write(self, byte: int) -> bool:
        """A byte to who was addressed; whether one of them acknowledges."""
        acknowledged = False
        for target in self._addressed:
            acknowledged |= target.write(byte)
        return acknowledged

    def read(self) -> int:
        """The byte on SDA: each one addressed can pull its bits low, and with nobody they stay high."""
        byte = 0xFF
        for target in self._addressed:
            byte &= target.read()
        return byte

    def stop(self) -> None:
        """A STOP."""
        self._addressed.clear()
        if self.connected:
            for _, target in self._targets:
                target.stop()
