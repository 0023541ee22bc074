"""Named wires: the only way in which peripherals, devices and the bench meet.

A wire carries what its kind of signal needs and no more: a logic level with tri-state drivers, a voltage, a
PWM duty (with edges for listeners that want them), quadrature edges, UART frames, SPI words, I2C bytes.  A board
decides which part drives a wire and which listens.  Each kind of event on a wire is a `Signal`:
`wire.changed.connect(listener)`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from math import inf
from typing import Any, Final, Protocol

from emulator.clock import NEVER, SYSCLK_HZ
from emulator.signal import Signal


class Edges(Protocol):
    """The `Signal` of a level: its listeners take both levels and high impedance."""

    def connect(self, listener: Callable[[int | None], object]) -> Callable[[], None]:
        """Call `listener(level)` at every edge from now on; what is returned ends that."""


class Level(Protocol):
    """A logic level inside of the chip, like that of a wire: it can be read at any time, and reports its changes."""

    @property
    def level(self) -> int:
        """The level now."""

    @property
    def changed(self) -> Signal[int]:
        """(level): every change of it."""


class LevelDriver(Protocol):
    """A computed level that can drive a wire.  It is read on demand, and makes edges only while somebody listens."""

    @property
    def level(self) -> int | None:
        """The level now; None: high impedance."""

    def stays_until(self) -> int:
        """The first cycle at which the level may be another one without an event; NEVER: there is none."""

    @property
    def changed(self) -> Edges:
        """Every edge."""


class Wire:
    """A logic level with any number of tri-state drivers and a pull.

    `level` is 0 or 1.  Drivers that disagree give 0 (the stronger pull-down of a push-pull stage) and are
    visible as `contention`.  With nobody driving, `pull` decides.

    A driver may be a `LevelDriver` (`follow`).  Its level is read on demand.  It makes edges only while `changed` has a
    listener, or between `attend` and `leave`.
    """

    __slots__ = (
        "_attention", "_drivers", "_level", "_sources", "changed", "computed", "contention", "held", "name", "noticed",
        "pull",
    )  # fmt: skip

    def __init__(self, name: str, pull: int = 0) -> None:
        self.name = name
        self.pull = pull
        self.contention = False
        #: It keeps its level, whoever drives it: what turns or triggers it has stopped.
        self.held = False
        self._level = pull
        self._drivers: dict[str, int] = {}
        #: Drivers with a computed level, each with the function that stops listening to its edges, if they are wanted.
        self._sources: dict[str, tuple[LevelDriver, Callable[[], None] | None]] = {}
        self._attention = 0
        #: (level): every change of the level.
        self.changed: Signal[int] = Signal(self._wanted)
        #: (level): the changes that are noticed anyway.  Computed levels make no edges for its listeners.
        self.noticed: Signal[int] = Signal()
        #: (on): True when a first source begins to drive the wire, False when the last ends.
        self.computed: Signal[bool] = Signal()

    @property
    def level(self) -> int:
        """0 or 1, now."""
        if self._sources and not self._attention:
            self._drive_all()
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

    def follow(self, driver: str, source: LevelDriver | None) -> None:
        """Let `driver` put the level of `source` on the wire at every instant; None ends it.

        Raises ValueError for a wire that follows this one: neither would have a level of its own.
        """
        if isinstance(source, Wire) and source.depends_on(self):
            whom = f"{source.name} follows {self.name}" if source is not self else "that is itself"
            raise ValueError(f"{self.name} cannot follow {source.name}: {whom}")
        was_computed = bool(self._sources)
        _, stop = old = self._sources.pop(driver, (None, None))
        if stop is not None:
            stop()
        if source is None:
            if old[0] is not None:
                self.drive(driver, None)
        else:
            self._sources[driver] = source, self._listen(driver, source) if self._attention else None
            self.drive(driver, source.level)
        computed = bool(self._sources)
        if computed != was_computed:
            self.computed.emit(computed)

    def depends_on(self, other: Wire) -> bool:
        """Whether this wire follows the level of `other`, directly or through other wires."""
        return other is self or any(
            isinstance(source, Wire) and source.depends_on(other) for source, _ in self._sources.values()
        )

    def set_pull(self, pull: int) -> None:
        """Change the level of the undriven wire."""
        self.pull = pull
        self._resolve()

    def attend(self) -> None:
        """Make computed levels produce every edge from now on, for code that does not listen to `changed`."""
        self._attention += 1
        if self._attention == 1 and self._sources:
            for driver, (source, _) in list(self._sources.items()):
                self._sources[driver] = source, self._listen(driver, source)
            self._drive_all()

    def leave(self) -> None:
        """End an `attend`."""
        self._attention -= 1
        if not self._attention:
            for driver, (source, stop) in list(self._sources.items()):
                self._sources[driver] = source, None
                if stop is not None:
                    stop()

    def driven(self) -> bool:
        """Whether any driver is active."""
        return bool(self._drivers)

    def drivers(self) -> set[str]:
        """The names of the drivers that drive the wire now."""
        return set(self._drivers)

    def _wanted(self, wanted: bool) -> None:
        if wanted:
            self.attend()
        else:
            self.leave()

    def _listen(self, driver: str, source: LevelDriver) -> Callable[[], None]:
        return source.changed.connect(partial(self.drive, driver))

    def _drive_all(self) -> None:
        for driver, (source, _) in self._sources.items():
            self.drive(driver, source.level)

    def _resolve(self) -> None:
        drivers = self._drivers
        if len(drivers) == 1:
            # The usual wire has one driver, so there is no contention.
            (level,) = drivers.values()
            self.contention = False
        else:
            levels = set(drivers.values())
            self.contention = len(levels) > 1
            level = min(levels) if levels else self.pull
        if level != self._level and not self.held:
            self._level = level
            for listener in self.noticed.listeners:
                listener(level)
            for listener in self.changed.listeners:
                listener(level)


class AnalogSource:
    """What drives an `AnalogWire`.  A part may be one itself, or give a function of the time."""

    __slots__ = ()

    def volts(self, cycles: int) -> float:
        """The voltage at that time."""
        raise NotImplementedError


class _FunctionOfTime(AnalogSource):
    __slots__ = ("_volts",)

    def __init__(self, volts: Callable[[int], float]) -> None:
        self._volts = volts

    def volts(self, cycles: int) -> float:
        return self._volts(cycles)


class _Sampled(AnalogSource):
    """A source whose samples have listeners."""

    __slots__ = ("_sampled", "_source")

    def __init__(self, source: AnalogSource, sampled: Signal[int, float]) -> None:
        self._source = source
        self._sampled = sampled

    def volts(self, cycles: int) -> float:
        volts = self._source.volts(cycles)
        for listener in self._sampled.listeners:
            listener(cycles, volts)
        return volts


class AnalogWire:
    """A voltage.  The source that drives the wire, `source.volts(cycles)`, is asked at every sample.

    Outside of the chip one source can be on the wire.  While the chip itself drives it, that one does not count.
    A `steady` source gives one voltage until another source replaces it, which `stepped` reports.  Any other source may
    change from one cycle to the next without a report.
    """

    __slots__ = (
        "_chip", "_chip_steady", "_has_listeners", "_outside", "_outside_steady", "_who", "name", "sampled", "source",
        "stepped",
    )  # fmt: skip

    def __init__(self, name: str) -> None:
        self.name = name
        self._who = ""
        self._outside: AnalogSource = _NO_VOLTS
        self._outside_steady = True
        self._chip: AnalogSource | None = None
        self._chip_steady = False
        self._has_listeners = False
        self.source: AnalogSource = self._outside
        #: (cycles, volts): every sample.  It costs nothing without a listener.
        self.sampled: Signal[int, float] = Signal(self._wanted)
        #: Something else drives the wire from now on.
        self.stepped: Signal[[]] = Signal()

    def follow(
        self, driver: str, source: AnalogSource | Callable[[int], float] | None, *, steady: bool = False
    ) -> None:
        """Let `driver`, outside of the chip, put `source`, or `source(cycles) -> volts`, on the wire; None ends it.

        Raises ValueError while another driver does: two sources on one wire are a short circuit.
        """
        if self._who not in ("", driver):
            raise ValueError(f"{self.name} has two sources: {self._who} and {driver}")
        self._who, self._outside_steady = driver, steady or source is None
        if source is None:
            self._who, self._outside = "", _NO_VOLTS
        else:
            self._outside = _source(source)
        self._choose()
        self.stepped.emit()

    def replace(
        self, driver: str, source: Callable[[int], float], *, steady: bool = False
    ) -> Callable[[], None]:
        """Let `driver` replace the source outside of the chip.  Returns a function that puts the old source back."""
        before, was, was_steady = self._who, self._outside, self._outside_steady
        self._who = ""
        self.follow(driver, source, steady=steady)
        return partial(self._put_back, before, was, was_steady)

    def _put_back(self, who: str, source: AnalogSource, steady: bool) -> None:
        self._who = ""
        self.follow(who, source, steady=steady)

    def unplug(self) -> None:
        """Remove the source outside of the chip, so that another one can be put on the wire."""
        self.follow(self._who, None)

    def drive(self, source: Callable[[int], float] | None, *, steady: bool = False) -> None:
        """Let the chip drive the wire with `source`; None releases it."""
        self._chip, self._chip_steady = None if source is None else _source(source), steady
        self._choose()
        self.stepped.emit()

    @property
    def driver(self) -> str:
        """What drives it from outside of the chip; empty: nothing."""
        return self._who

    @property
    def driven(self) -> bool:
        """Whether anything drives it, inside of the chip or outside."""
        return self._chip is not None or bool(self._who)

    @property
    def steady(self) -> bool:
        """Whether the voltage cannot change without `stepped`."""
        return self._outside_steady if self._chip is None else self._chip_steady

    def volts(self, cycles: int) -> float:
        """The voltage, for a part that sees it all the time.  It does not count as a sample: no listener is called."""
        return (self._chip or self._outside).volts(cycles)

    def _wanted(self, wanted: bool) -> None:
        self._has_listeners = wanted
        self._choose()

    def _choose(self) -> None:
        self.source = self._chip or self._outside
        if self._has_listeners:
            self.source = _Sampled(self.source, self.sampled)


def _source(source: AnalogSource | Callable[[int], float]) -> AnalogSource:
    return source if isinstance(source, AnalogSource) else _FunctionOfTime(source)


_NO_VOLTS: Final[AnalogSource] = _FunctionOfTime(lambda _cycles: 0.0)


class DutyWire:
    """A PWM output seen by something slower than its period: duty 0..1 and period in cycles.

    A steady level is duty 0 or 1 with period 0.  `missing` says why no pin carries the output, while none does.
    """

    __slots__ = ("duty", "duty_changed", "duty_changing", "missing", "name", "period_cycles")

    def __init__(self, name: str) -> None:
        self.name = name
        self.duty = 0.0
        self.period_cycles = 0
        self.missing = ""
        #: (): just *before* the duty changes, so that a plant can be integrated up to now.
        self.duty_changing: Signal[[]] = Signal()
        #: (): a new duty is on the wire.
        self.duty_changed: Signal[[]] = Signal()

    def set(self, duty: float, period_cycles: int) -> None:
        """Put a new duty on the wire."""
        if duty != self.duty or period_cycles != self.period_cycles:
            for listener in self.duty_changing.listeners:
                listener()
            self.duty = duty
            self.period_cycles = period_cycles
            for listener in self.duty_changed.listeners:
                listener()


class PwmSource(Protocol):
    """A source that drives a `PwmWire`."""

    def level(self) -> int | None:
        """The level of the output now; None: high impedance."""

    def stays_until(self) -> int:
        """The cycle of the next edge."""

    def watch(self) -> None:
        """`watched` of the wire has changed.  While it is true, the source must report edges by `report_level`."""


class PwmWire(DutyWire):
    """An output of an ePWM: its duty for parts that are slower than its period, its level and edges for others.

    The level is read from its `PwmSource`.  The source is called whenever `watched` changes: while a listener wants
    edges, the source reports them by `report_level`.  `released`: the output is in high impedance, its duty
    has no meaning.
    """

    __slots__ = ("_reported", "_source", "changed", "released", "watched")

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.released = False
        self.watched = False
        self._source: PwmSource | None = None
        self._reported: int | None = 0
        #: (level): every edge; None is high impedance.
        self.changed: Signal[int | None] = Signal(self._wanted)

    def follow(self, source: PwmSource) -> None:
        """Let `source` drive the output.  Raises ValueError if another source does."""
        if self._source is not None:
            raise ValueError(f"{self.name} has two sources: {self._source} and {source}")
        self._source = source

    @property
    def level(self) -> int | None:
        """The level now; None: high impedance."""
        return 0 if self._source is None else self._source.level()

    def stays_until(self) -> int:
        """The first cycle at which the level may be another one without an event; NEVER: there is none."""
        return NEVER if self.watched or self._source is None else self._source.stays_until()

    def _wanted(self, wanted: bool) -> None:
        if wanted:
            self._reported = self.level
        self.watched = wanted
        if self._source is not None:
            self._source.watch()

    def report_level(self, level: int | None) -> None:
        """The output has this level now.  Report it to listeners if it is a change."""
        if level != self._reported:
            self._reported = level
            for listener in self.changed.listeners:
                listener(level)

    def put(self, duty: float, period_cycles: int, released: bool) -> None:
        """`set`, and go to high impedance or leave it."""
        if released == self.released:
            self.set(duty, period_cycles)
            return
        self.duty_changing.emit()
        self.released, self.duty, self.period_cycles = released, duty, period_cycles
        self.duty_changed.emit()


class QuadratureWire:
    """The A/B pair of an incremental encoder, in whole edges (4 a line).

    The source calls `move(edges, start, end)`: `edges` equally spaced edges between two times; positive means A
    leads B.  A reader calls `sync` first, so that a plant that is integrated on demand (a listener of `looked_at`) has
    moved up to now.  `missing_a` and `missing_b` say why no pin carries the line, while none does.
    """

    __slots__ = ("clashed", "looked_at", "missing_a", "missing_b", "moved", "name", "position")

    def __init__(self, name: str) -> None:
        self.name = name
        self.position = 0
        self.missing_a = self.missing_b = ""
        #: (edges, start_cycles, end_cycles): every movement.
        self.moved: Signal[int, int, int] = Signal()
        #: (cycles): both lines changed at once, so the direction is not known.
        self.clashed: Signal[int] = Signal()
        #: (): a reader is about to read the position of the shaft.
        self.looked_at: Signal[[]] = Signal()

    def sync(self) -> None:
        """Have the plant that turns the shaft move it up to now."""
        for listener in self.looked_at.listeners:
            listener()

    def clash(self, cycles: int) -> None:
        """A and B changed in the same cycle."""
        self.position += 2
        self.clashed.emit(cycles)

    def move(self, edges: int, start: int, end: int) -> None:
        """The shaft turned by `edges` between the virtual times `start` and `end`."""
        if edges:
            self.position += edges
            for listener in self.moved.listeners:
                listener(edges, start, end)


@dataclass(slots=True, init=False)
class SerialFrame:
    """One asynchronous character on a line.

    `start` and `end` are cycles of the start bit's edge and of the end of the stop bit; `bit_cycles` the
    length of a bit as sent, which a receiver compares with its own.  `parity` is None, "even" or "odd".
    `drift`: how many times longer its bits are than its sender's registers set them (an oscillator that runs away).
    `rate_set_by`: the statement that set the rate of its sender, for reports; None: none did.
    """

    data: Final[int]
    start: Final[int]
    end: Final[int]
    bit_cycles: Final[float]
    data_bits: Final[int]
    parity: Final[str | None]
    stop_bits: Final[int]
    framing_error: Final[bool]
    drift: Final[float]
    rate_set_by: Final[Any]

    def __init__(
        self, data: int, start: int, end: int, bit_cycles: float, data_bits: int = 8, parity: str | None = None,
        stop_bits: int = 1, framing_error: bool = False, drift: float = 1.0, rate_set_by: Any = None,
    ) -> None:  # fmt: skip
        self.data = data
        self.start = start
        self.end = end
        self.bit_cycles = bit_cycles
        self.data_bits = data_bits
        self.parity = parity
        self.stop_bits = stop_bits
        self.framing_error = framing_error
        self.drift = drift
        self.rate_set_by = rate_set_by

    def rates_differ(self, bit_cycles: float) -> str:
        """Both speeds in words, if a receiver of `bit_cycles` a bit cannot follow the sender; else empty.

        The stop bit (the tenth) is sampled 9.5 bits after the edge that begins the frame: half a bit off there is too
        much.  The drift of an oscillator does not count here, because the rates that were set are not at fault.
        """
        set_cycles = self.bit_cycles / self.drift
        stop_at = 1.5 + self.data_bits + (self.parity is not None)
        if abs(set_cycles / bit_cycles - 1) < 0.5 / stop_at:
            return ""
        sent, heard = (round(SYSCLK_HZ / cycles) for cycles in (set_cycles, bit_cycles))
        return f"a character was sent with {sent} baud, but this end receives with {heard}"


class SerialLine:
    """One direction of an asynchronous serial link.

    `missing` says why no pin carries the line, while none does.
    """

    __slots__ = ("_disturbers", "break_changed", "broken", "missed", "missing", "name", "sent")

    def __init__(self, name: str) -> None:
        self.name = name
        self.broken = False
        self.missing = ""
        #: (frame): at the end of each frame's stop bit.
        self.sent: Signal[SerialFrame] = Signal()
        #: (low): the line goes permanently low, or is released.
        self.break_changed: Signal[bool] = Signal()
        #: (pin): a frame came to a pin of this line while none carried it.
        self.missed: Signal[int] = Signal()
        #: The disturbances that each frame passes through, in this order; usually none.
        self._disturbers: tuple[Callable[[SerialFrame], Iterable[SerialFrame]], ...] = ()

    def disturb(self, by: Callable[[SerialFrame], Iterable[SerialFrame]]) -> Callable[[], None]:
        """Replace each frame that is sent by the frames that `by` returns for it.  Returns a function that ends this.

        `by` must not return a frame that ends later.  It calls `deliver` itself when that frame ends.
        """
        self._disturbers = (*self._disturbers, by)
        return partial(self._undisturb, by)

    def _undisturb(self, by: Callable[[SerialFrame], Iterable[SerialFrame]]) -> None:
        self._disturbers = tuple(each for each in self._disturbers if each is not by)

    def miss(self, pin: int) -> None:
        """Report that a frame came to GPIO`pin`, which is not set to this line."""
        self.missed.emit(pin)

    def send(self, frame: SerialFrame) -> None:
        """Called by the transmitter when the stop bit has ended."""
        if self._disturbers:
            frames: Iterable[SerialFrame] = (frame,)
            for disturb in self._disturbers:
                frames = [after for before in frames for after in disturb(before)]
            for each in frames:
                self.deliver(each)
            return
        for listener in self.sent.listeners:
            listener(frame)

    def deliver(self, frame: SerialFrame) -> None:
        """Deliver a frame to the other end, past all disturbances."""
        for listener in self.sent.listeners:
            listener(frame)

    def hold_low(self, low: bool) -> None:
        """Pull the line low (unpowered or resetting peer), or release it."""
        if low != self.broken:
            self.broken = low
            self.break_changed.emit(low)


#: Clock schemes of the SPI: 2 cpol + cpha.
SPI_MODES: Final = frozenset(range(4))


class SpiSlave(Protocol):
    """An SPI device as a bus sees it.

    A device with a maximum clock has an attribute `greatest_clock_hz`; one that does not take every clock scheme has
    `clock_modes`, those that it takes: mode = 2 cpol + cpha.
    """

    def select(self, level: int) -> None:
        """Chip select changed: 0 selects (active low), 1 ends the transaction."""

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int | None:
        """Shift `length` bits in and out, most significant first; None leaves SDO in high impedance."""


class SpiBus:
    """SIMO, SOMI and CLK with the slaves on them; chip selects are `Wire`s.

    `connected` is False while the pin of CLK has another function (`missing` says which).  Then words reach no slave,
    and no slave answers.  `simo` and `somi` likewise for these lines (`no_simo`, `no_somi`).
    """

    __slots__ = (
        "_slaves", "_unsent", "addressed", "connected", "deselected", "exchanged", "greatest_clock_hz", "idle_in",
        "lost", "missing", "name", "no_simo", "no_somi", "refused", "simo", "somi",
    )  # fmt: skip

    def __init__(self, name: str, idle_in: int = 0) -> None:
        self.name = name
        self.idle_in = idle_in
        self.connected = True
        self.missing = ""
        self.simo = True
        self.no_simo = ""
        self.somi = True
        self.no_somi = ""
        #: What the latest word has lost because a line has no pin.
        self.lost = ""
        #: The latest word that had no SIMO; -1: none.
        self._unsent = -1
        #: Whether a slave was selected at the end of the latest word (or none could be).
        self.addressed = True
        self._slaves: list[tuple[Wire, SpiSlave]] = []
        #: The maximum clock of the slowest slave, in Hz.
        self.greatest_clock_hz = inf
        #: A bit for each mode that one of the slaves does not take.
        self.refused = 0
        #: (chip_select): a chip select has risen.
        self.deselected: Signal[Wire] = Signal()
        #: (simo, somi): at the end of each word that the pins carried, its bits on both lines.
        self.exchanged: Signal[int, int] = Signal()

    def attach(self, chip_select: Wire, slave: SpiSlave) -> None:
        """Connect `slave` to the bus; a low level of `chip_select` selects it.  Raises ValueError for `clock_modes`."""
        modes = frozenset(getattr(slave, "clock_modes", SPI_MODES))
        if not modes or not modes <= SPI_MODES:
            raise ValueError(f"{self.name}: clock_modes of {type(slave).__name__}: expected some of 0, 1, 2 and 3")
        for mode in SPI_MODES - modes:
            self.refused |= 1 << mode
        self._slaves.append((chip_select, slave))
        self.greatest_clock_hz = min(self.greatest_clock_hz, getattr(slave, "greatest_clock_hz", inf))
        chip_select.changed.connect(slave.select)
        chip_select.changed.connect(partial(self._selected, chip_select))

    def replace(self, slave: SpiSlave, by: SpiSlave) -> None:
        """Send words for `slave` to `by` from now on; the chip select stays the same.  Raises ValueError."""
        if all(known is not slave for _, known in self._slaves):
            raise ValueError(f"{self.name}: that slave is not on this bus")
        self._slaves = [(select, by if known is slave else known) for select, known in self._slaves]

    def too_fast(self, clock_hz: float) -> Iterator[SpiSlave]:
        """The selected slaves whose maximum clock is below `clock_hz`."""
        for chip_select, slave in self._slaves:
            if chip_select.level == 0 and clock_hz > getattr(slave, "greatest_clock_hz", inf):
                yield slave

    def refusing(self, mode: int) -> Iterator[SpiSlave]:
        """The selected slaves that do not take a mode."""
        for chip_select, slave in self._slaves:
            if chip_select.level == 0 and mode not in getattr(slave, "clock_modes", SPI_MODES):
                yield slave

    @property
    def slaves(self) -> list[SpiSlave]:
        """The slaves that get the words."""
        return [slave for _, slave in self._slaves]

    def _selected(self, chip_select: Wire, level: int) -> None:
        if level:
            self.deselected.emit(chip_select)

    @property
    def selects(self) -> list[Wire]:
        """The chip selects of the slaves, each once."""
        return list({id(select): select for select, _ in self._slaves}.values())

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int:
        """Transfer one word.  If no slave drives SOMI, every bit reads as `idle_in`.

        CHOICE: a slave reads the floating SIMO as zeros.
        """
        idle = answer = (1 << length) - 1 if self.idle_in else 0
        self.addressed = not self._slaves
        self.lost = ""
        if not self.simo:
            # A driver that only wants an answer repeats one word.
            if self.no_simo and self._unsent not in (-1, out_bits):
                self.lost = f"{self.no_simo}: the word does not reach the bus"
            self._unsent, out_bits = out_bits, 0
        if self.connected:
            for chip_select, slave in self._slaves:
                if chip_select.level == 0:
                    self.addressed = True
                    bits = slave.exchange(out_bits, length, cpol, cpha)
                    if bits is not None:
                        answer = bits
            for listener in self.exchanged.listeners:
                listener(out_bits, answer)
        if not self.somi and answer != idle:
            if self.no_somi:
                self.lost = f"{self.no_somi}: the answer does not reach the module"
            answer = idle
        return answer


class I2cTarget(Protocol):
    """An I2C device as a bus sees it.  Every device of a bus sees all STARTs and STOPs."""

    def start(self) -> None:
        """A START, or a repeated one.  A device that was addressed is no longer addressed."""

    def addressed(self, reading: bool) -> bool:
        """The device's address, with R/W = `reading`.  Returns whether it acknowledges."""

    def write(self, byte: int) -> bool:
        """A byte from the controller.  Returns whether the device acknowledges."""

    def read(self) -> int:
        """The byte that it puts on SDA."""

    def stop(self) -> None:
        """A STOP."""


#: 7-bit addresses that the bus specification leaves to devices (the others mean something else: general call, 10 bits).
FIRST_I2C_ADDRESS: Final = 0x08
LAST_I2C_ADDRESS: Final = 0x77


class I2cBus:
    """SDA and SCL, both open drain with their pull-ups, and the targets on them by their 7-bit addresses.

    `connected` is False while the pins have another function (`missing` says which).  Then no target sees anything, and
    none acknowledges.  `taken`: a second controller, which is not one of the modelled ones, has the bus.
    """

    __slots__ = ("_addressed", "_targets", "connected", "missing", "name", "taken", "taken_changed")

    def __init__(self, name: str) -> None:
        self.name = name
        self.connected = True
        self.missing = ""
        self.taken = False
        self._targets: list[tuple[int, I2cTarget]] = []
        self._addressed: list[I2cTarget] = []
        #: (taken): the START and the STOP of a second controller.
        self.taken_changed: Signal[bool] = Signal()

    def attach(self, address: int, target: I2cTarget) -> None:
        """Connect `target` to the bus with its 7-bit `address`.  Raises ValueError for one that no device can have."""
        if not FIRST_I2C_ADDRESS <= address <= LAST_I2C_ADDRESS:
            raise ValueError(f"I2C address {address:#04x}: expected {FIRST_I2C_ADDRESS:#04x}..{LAST_I2C_ADDRESS:#04x}")
        self._targets.append((address, target))

    def take(self, taken: bool) -> None:
        """A second controller makes a START, or its STOP."""
        if taken != self.taken:
            self.taken = taken
            self.taken_changed.emit(taken)

    def start(self) -> None:
        """A START or a repeated START."""
        self._addressed.clear()
        if self.connected:
            for _, target in self._targets:
                target.start()

    def address(self, address: int, reading: bool) -> bool:
        """The address byte after a START.  Returns whether a target acknowledges."""
        if self.connected:
            self._addressed += [target for own, target in self._targets if own == address and target.addressed(reading)]
        return bool(self._addressed)

    def write(self, byte: int) -> bool:
        """A byte to the addressed targets.  Returns whether one of them acknowledges."""
        acknowledged = False
        for target in self._addressed:
            acknowledged |= target.write(byte)
        return acknowledged

    def read(self) -> int:
        """The byte on SDA.  Each addressed target can pull bits low; with no target all stay high."""
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
