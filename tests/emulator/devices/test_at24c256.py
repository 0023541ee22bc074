"""AT24C256 in the language of its data sheet."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import CYCLES_PER_MS, Clock
from emulator.devices.at24c256 import At24c256
from emulator.signals import I2cBus

TWR = 5 * CYCLES_PER_MS


class Bench:
    def __init__(self, pins: int = 0) -> None:
        self.clock = Clock()
        self.reports: list[tuple[str, str]] = []
        self.eeprom = At24c256(self.clock, pins, report=lambda *a, **_: self.reports.append(a))
        self.bus = I2cBus("I2C-A")
        self.bus.attach(self.eeprom.address, self.eeprom)

    def answers(self) -> bool:
        """A START with the device's address, and a STOP."""
        self.bus.start()
        answered = self.bus.address(self.eeprom.address, False)
        self.bus.stop()
        return answered

    def begin(self, place: int, *data: int) -> None:
        """S, address, data, without an end."""
        self.bus.start()
        assert self.bus.address(self.eeprom.address, False)
        for byte in (place >> 8, place & 0xFF, *data):
            assert self.bus.write(byte)

    def write(self, place: int, *data: int, wait: bool = True) -> None:
        self.begin(place, *data)
        self.bus.stop()
        if wait:
            self.clock.advance_to(self.clock.now + TWR)

    def read(self, place: int | None, count: int) -> list[int]:
        """A random read; without a place one of the current address."""
        if place is not None:
            self.begin(place)
        self.bus.start()
        assert self.bus.address(self.eeprom.address, True)
        data = [self.bus.read() for _ in range(count)]
        self.bus.stop()
        return data


@given(writes=st.lists(st.tuples(st.integers(0, 0x7FFF), st.binary(min_size=1, max_size=80)), max_size=8))
def test_writes_and_reads_are_those_of_pages_that_roll_over(writes: list[tuple[int, bytes]]) -> None:
    bench = Bench()
    model = bytearray([0xFF]) * 32768
    for place, data in writes:
        bench.write(place, *data)
        for n, byte in enumerate(data):
            # The lower six bits count, the others stay.
            model[place & ~63 | (place + n) & 63] = byte
    assert bench.eeprom.memory == model
    for place, data in writes:
        assert bench.read(place, len(data)) == [model[(place + n) % 32768] for n in range(len(data))]


def test_a_write_cycle_is_not_acknowledged_until_it_is_over() -> None:
    bench = Bench()
    bench.write(0x30, 0x12, 0x34, wait=False)
    assert bench.eeprom.busy
    assert not bench.answers()
    bench.clock.advance_to(TWR - 1)
    assert not bench.answers()
    assert bench.eeprom.memory[0x30] == 0xFF
    bench.clock.advance_to(TWR)
    assert bench.eeprom.memory[0x30:0x32] == b"\x12\x34"
    assert bench.read(0x30, 2) == [0x12, 0x34]


def test_polling_does_not_disturb_the_write_cycle() -> None:
    bench = Bench()
    bench.write(0, 1, wait=False)
    polls = 0
    while not bench.answers():
        polls += 1
        bench.clock.advance_to(bench.clock.now + CYCLES_PER_MS // 10)
    assert polls == 50
    assert bench.eeprom.memory[0] == 1


def test_the_current_address_is_the_last_one_and_one() -> None:
    bench = Bench()
    bench.write(0x100, 10, 11, 12)
    bench.write(0x103, 13)
    bench.read(0x100, 1)
    assert bench.read(None, 2) == [11, 12]
    assert bench.read(None, 1) == [13]


def test_a_sequential_read_rolls_over_at_the_end_of_the_memory() -> None:
    bench = Bench()
    bench.write(0x7FFF, 0xAA)
    bench.write(0x0000, 0x55)
    assert bench.read(0x7FFF, 2) == [0xAA, 0x55]


def test_the_uppermost_bit_of_the_address_does_not_count() -> None:
    bench = Bench()
    bench.write(0x8123, 0x77)
    assert bench.eeprom.memory[0x123] == 0x77


def test_a_message_without_its_stop_writes_nothing() -> None:
    bench = Bench()
    bench.begin(0, 1, 2)
    assert bench.read(0, 2) == [0xFF, 0xFF]
    assert not bench.eeprom.busy


def test_an_address_without_data_begins_no_write_cycle() -> None:
    bench = Bench()
    bench.write(0x40, wait=False)
    assert bench.answers()


def test_write_protection_keeps_the_memory() -> None:
    bench = Bench()
    bench.eeprom.write_protect = 1
    bench.write(0, 1, wait=False)
    assert bench.answers()
    assert bench.eeprom.memory[0] == 0xFF
    bench.eeprom.write_protect = 0
    bench.write(0, 1)
    assert bench.eeprom.memory[0] == 1


@given(place=st.integers(0, 0x7FFF), count=st.integers(1, 80))
def test_a_write_over_the_end_of_a_page_is_told_and_no_other(place: int, count: int) -> None:
    bench = Bench()
    bench.write(place, *range(count))
    over = place // 64 != (place + count - 1) // 64
    assert [rule for rule, _ in bench.reports] == ["eeprom-page"] * over


def test_what_is_told_of_a_page_says_where_the_bytes_went() -> None:
    bench = Bench()
    bench.write(0x7E, 1, 2, 3)
    assert bench.reports[0][1] == (
        "AT24C256: 3 bytes were written from 0x007e on, over the end of the page: the last 1 went to 0x0040 and behind"
    )
    assert bench.eeprom.memory[0x40] == 3


@pytest.mark.parametrize("pins", range(8))
def test_the_address_pins_are_the_lower_bits_of_the_address(pins: int) -> None:
    assert Bench(pins).eeprom.address == 0x50 + pins
    assert Bench(pins).answers()


def test_there_are_three_address_pins() -> None:
    with pytest.raises(ValueError, match="address pins 8"):
        At24c256(Clock(), 8)


@pytest.mark.parametrize(("pause_ms", "again_ms", "records", "told"), [
    (1, 60, 5, 3),  # each record is read back in its write cycle, and nobody asks again
    (1, 60, 2, 0),  # an accident
    (1, 3, 5, 0),  # polled for its end
    (1, 12, 5, 0),  # asked again soon
    (6, 60, 5, 0),  # after the end of the cycle
])  # fmt: skip
def test_a_device_that_is_addressed_in_its_write_cycle_each_time_is_told(
    pause_ms: int, again_ms: int, records: int, told: int
) -> None:
    bench = Bench()
    for record in range(records):
        bench.write(64 * record, record, wait=False)
        bench.clock.advance_to(bench.clock.now + pause_ms * CYCLES_PER_MS)
        bench.answers()
        bench.clock.advance_to(bench.clock.now + again_ms * CYCLES_PER_MS)
        while not bench.answers():
            bench.clock.advance_to(bench.clock.now + CYCLES_PER_MS)
    assert [rule for rule, _ in bench.reports] == ["eeprom-busy"] * told
