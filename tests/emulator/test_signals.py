"""Wires: drivers and pulls, duties, edges, SPI selection."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import NEVER
from emulator.signals import AnalogWire, DutyWire, PwmWire, QuadratureWire, SpiBus, Wire


def test_an_undriven_wire_follows_its_pull_and_a_driver_overrides_it() -> None:
    wire = Wire("GPIO69", pull=1)
    levels: list[int] = []
    wire.changed.connect(levels.append)
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
    wire.duty_changing.connect(lambda: seen.append(("before", wire.duty)))
    wire.duty_changed.connect(lambda: seen.append(("after", wire.duty)))
    wire.set(0.25, 10_000)
    wire.set(0.25, 10_000)
    assert seen == [("before", 0.0), ("after", 0.25)]


def test_quadrature_sums_edges_and_passes_the_batch() -> None:
    wire = QuadratureWire("left")
    batches: list[tuple[int, int, int]] = []
    wire.moved.connect(lambda *batch: batches.append(batch))
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
    bus.exchanged.connect(lambda simo, somi: words.append((simo, somi)))
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
        self.wire.follow(self)

    def level(self) -> int | None:
        self.asked += 1
        return self.now

    def stays_until(self) -> int:
        return 500

    def watch(self) -> None:
        self.switched.append(self.wire.watched)

    def become(self, level: int | None) -> None:
        self.now = level
        if self.wire.watched:
            self.wire.report_level(level)


def test_a_computed_level_is_asked_when_somebody_looks() -> None:
    wire, output = Wire("GPIO0", pull=1), Output()
    heard: list[int] = []
    wire.noticed.connect(heard.append)
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
    stop = far.changed.connect(heard.append)
    assert output.switched == [True]
    for level in (1, 1, 0, None, 1):
        output.become(level)
    assert (heard, far.level, pin.level) == ([1, 0, 1], 1, 1)
    asked = output.asked
    assert (far.level, output.asked) == (1, asked)  # it hears the edges: no need to ask
    pin.attend()
    stop()
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
    wire.changed.connect(heard.append)
    assert (wire.level, heard) == (1, [])


def test_a_wire_tells_when_a_level_begins_and_ends_to_be_computed() -> None:
    wire = Wire("GPIO0")
    told: list[bool] = []
    wire.computed.connect(told.append)
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
    wire.duty_changing.connect(lambda: seen.append((True, wire.duty, wire.released)))
    wire.duty_changed.connect(lambda: seen.append((False, wire.duty, wire.released)))
    wire.put(0.0, 0, released=True)
    wire.put(0.0, 0, released=True)
    wire.put(0.5, 100, released=False)
    assert seen == [(True, 0.0, False), (False, 0.0, True), (True, 0.0, True), (False, 0.5, False)]


def test_a_clash_of_both_lines_is_two_edges_that_nobody_counts() -> None:
    wire = QuadratureWire("EQEP1")
    clashes: list[int] = []
    wire.moved.connect(lambda *_: clashes.append(-1))
    wire.clashed.connect(clashes.append)
    wire.clash(70)
    assert (wire.position, clashes) == (2, [70])


def test_wires_cannot_follow_each_other_through_any_number_of_wires() -> None:
    first, second, third = Wire("GPIO0"), Wire("GPIO1"), Wire("GPIO2")
    second.follow("jumper", first)
    third.follow("jumper", second)
    with pytest.raises(ValueError, match=r"GPIO0 cannot follow GPIO2: GPIO2 follows GPIO0$"):
        first.follow("jumper", third)
    with pytest.raises(ValueError, match=r"GPIO1 cannot follow GPIO1: that is itself$"):
        second.follow("loop", second)
    first.drive("test", 1)
    assert (third.level, first.drivers()) == (1, {"test"})
    third.follow("jumper", None)
    first.follow("jumper", third)
    assert first.contention


def test_two_sources_of_one_voltage_are_a_conflict_with_names() -> None:
    wire = AnalogWire("ADCINB3")
    wire.follow("infrared", lambda _cycles: 1.0)
    with pytest.raises(ValueError, match="ADCINB3 has two sources: infrared and sonar"):
        wire.follow("sonar", lambda _cycles: 2.0)
    wire.follow("infrared", lambda _cycles: 1.5)
    assert wire.source.volts(0) == 1.5
    wire.follow("infrared", None)
    wire.follow("sonar", lambda _cycles: 2.0)
    assert wire.source.volts(0) == 2.0
    wire.unplug()
    assert (wire.source.volts(0), wire.steady) == (0.0, True)
    wire.follow("infrared", lambda _cycles: 1.0)
    assert wire.source.volts(0) == 1.0


def test_a_sampled_voltage_is_told_whatever_source_comes_later() -> None:
    wire = AnalogWire("ADCINA1")
    heard: list[tuple[int, float]] = []
    stop = wire.sampled.connect(lambda cycles, volts: heard.append((cycles, volts)))
    wire.follow("part", lambda cycles: cycles / 10)
    wire.source.volts(5)
    wire.drive(lambda _cycles: 3.0)
    wire.source.volts(6)
    stop()
    wire.source.volts(7)
    wire.drive(None)
    assert (wire.source.volts(8), heard) == (0.8, [(5, 0.5), (6, 3.0)])


def test_an_output_has_one_source() -> None:
    output = Output()
    with pytest.raises(ValueError, match="EPWM1A has two sources"):
        output.wire.follow(Output())
