"""Wires: drivers and pulls, duties, edges, SPI selection."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import NEVER
from emulator.signals import DutyWire, PwmWire, QuadratureWire, SpiBus, Wire


def test_an_undriven_wire_follows_its_pull_and_a_driver_overrides_it() -> None:
    wire = Wire("GPIO69", pull=1)
    levels: list[int] = []
    wire.on_change(levels.append)
    wire.drive("cpu", 0)
    wire.drive("cpu", None)
    wire.set_pull(0)
    assert levels == [0, 1, 0]


@given(st.dictionaries(st.sampled_from("abc"), st.integers(0, 1), min_size=2))
def test_drivers_that_disagree_are_contention_and_read_low(drivers: dict[str, int]) -> None:
    wire = Wire("w", pull=1)
    for name, level in drivers.items():
        wire.drive(name, level)
    assert wire.contention == (len(set(drivers.values())) == 2)
    assert wire.level == min(drivers.values())


def test_a_duty_tells_the_plant_before_and_the_pin_after_the_change() -> None:
    wire = DutyWire("EPWM2A")
    seen: list[tuple[str, float]] = []
    wire.before_change(lambda: seen.append(("before", wire.duty)))
    wire.after_change(lambda: seen.append(("after", wire.duty)))
    wire.set(0.25, 10_000)
    wire.set(0.25, 10_000)
    assert seen == [("before", 0.0), ("after", 0.25)]


def test_quadrature_sums_edges_and_passes_the_batch() -> None:
    wire = QuadratureWire("left")
    batches: list[tuple[int, int, int]] = []
    wire.on_edges(lambda *batch: batches.append(batch))
    wire.move(3, 0, 100)
    wire.move(0, 100, 200)
    wire.move(-1, 200, 300)
    assert wire.position == 2
    assert batches == [(3, 0, 100), (-1, 200, 300)]


def test_only_the_selected_slave_answers_on_the_bus() -> None:
    class Slave:
        def select(self, level: int) -> None: ...

        def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int | None:
            return out_bits ^ 0xFF

    bus, chip_select = SpiBus("A", idle_in=1), Wire("CS", pull=1)
    bus.attach(chip_select, Slave())
    words: list[tuple[int, int]] = []
    bus.on_word(lambda simo, somi: words.append((simo, somi)))
    assert bus.exchange(0x0F, 8, 1, 0) == 0xFF
    chip_select.drive("cpu", 0)
    assert bus.exchange(0x0F, 8, 1, 0) == 0xF0
    bus.connected = False
    assert bus.exchange(0x0F, 8, 1, 0) == 0xFF
    assert words == [(0x0F, 0xFF), (0x0F, 0xF0)]


class Output:
    """An output whose level a test sets; what it is asked and told is counted."""

    def __init__(self, name: str = "EPWM1A") -> None:
        self.now: int | None = 0
        self.asked = 0
        self.switched: list[bool] = []
        self.wire = PwmWire(name)
        self.wire.ask = self._asked
        self.wire.until = lambda: 500
        self.wire.watch = lambda: self.switched.append(self.wire.watched)

    def _asked(self) -> int | None:
        self.asked += 1
        return self.now

    def become(self, level: int | None) -> None:
        self.now = level
        if self.wire.watched:
            self.wire.tell(level)


def test_a_computed_level_is_asked_when_somebody_looks() -> None:
    wire, output = Wire("GPIO0", pull=1), Output()
    heard: list[int] = []
    wire.overhear(heard.append)
    wire.follow("EPWM1A", output.wire)
    assert (wire.level, wire.driven(), heard) == (0, True, [0])
    output.become(1)
    output.become(0)
    output.become(1)
    assert (heard, output.switched) == ([0], [])
    assert (wire.level, heard, wire.stays_until()) == (1, [0, 1], 500)
    output.become(None)
    assert (wire.level, wire.driven()) == (1, False)  # its pull
    wire.follow("EPWM1A", None)
    asked = output.asked
    assert (wire.level, output.asked, wire.stays_until()) == (1, asked, NEVER)


def test_edges_come_while_somebody_listens_through_any_number_of_wires() -> None:
    output, pin, far = Output(), Wire("GPIO0"), Wire("GPIO20")
    pin.follow("EPWM1A", output.wire)
    far.follow("jumper", pin)
    heard: list[int] = []
    far.on_change(heard.append)
    assert output.switched == [True]
    for level in (1, 1, 0, None, 1):
        output.become(level)
    assert (heard, far.level, pin.level) == ([1, 0, 1], 1, 1)
    asked = output.asked
    assert (far.level, output.asked) == (1, asked)  # it hears the edges: no need to ask
    pin.attend()
    far.forget(heard.append)
    assert output.switched == [True]
    pin.leave()
    assert output.switched == [True, False]
    output.become(0)
    assert (heard, far.level) == ([1, 0, 1], 0)


def test_a_listener_hears_only_what_changes_after_it_came() -> None:
    output, wire = Output(), Wire("GPIO0")
    wire.follow("EPWM1A", output.wire)
    output.become(1)
    heard: list[int] = []
    wire.on_change(heard.append)
    assert (wire.level, heard) == (1, [])


def test_who_overhears_is_told_when_a_level_begins_and_ends_to_be_computed() -> None:
    wire = Wire("GPIO0")
    told: list[bool] = []
    wire.overhear(lambda _level: None, told.append)
    wire.follow("EPWM1A", Output().wire)
    wire.follow("jumper", Output("other").wire)
    wire.follow("EPWM1A", None)
    wire.follow("EPWM1A", None)
    wire.follow("jumper", None)
    assert told == [True, False]


def test_a_computed_driver_and_another_one_are_contention() -> None:
    wire, output = Wire("GPIO0"), Output()
    wire.follow("EPWM1A", output.wire)
    wire.drive("test", 0)
    output.become(1)
    assert (wire.level, wire.contention) == (0, True)


def test_a_released_output_is_told_as_a_change_of_duty() -> None:
    wire = PwmWire("EPWM1A")
    seen: list[tuple[bool, float, bool]] = []
    wire.before_change(lambda: seen.append((True, wire.duty, wire.released)))
    wire.after_change(lambda: seen.append((False, wire.duty, wire.released)))
    wire.put(0.0, 0, released=True)
    wire.put(0.0, 0, released=True)
    wire.put(0.5, 100, released=False)
    assert seen == [(True, 0.0, False), (False, 0.0, True), (True, 0.0, True), (False, 0.5, False)]


def test_a_clash_of_both_lines_is_two_edges_that_nobody_counts() -> None:
    wire = QuadratureWire("EQEP1")
    clashes: list[int] = []
    wire.on_edges(lambda *_: clashes.append(-1))
    wire.on_clash(clashes.append)
    wire.clash(70)
    assert (wire.position, clashes) == (2, [70])
