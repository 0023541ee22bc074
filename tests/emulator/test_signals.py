"""Wires: drivers and pulls, duties, edges, SPI selection."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from emulator.signals import DutyWire, QuadratureWire, SpiBus, Wire


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
