"""LIS3DH in the language of its data sheet."""

from __future__ import annotations

from random import Random
from statistics import fmean, pstdev

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US, Clock
from emulator.devices.lis3dh import Lis3dh

G = 9.80665
#: The sheet's table of operating modes: LPen, HR, bits; and of sensitivities in mg a digit at 2, 4, 8 and 16 g.
MODES = [(0, 1, 12, (1, 2, 4, 12)), (0, 0, 10, (4, 8, 16, 48)), (1, 0, 8, (16, 32, 64, 192))]
#: CTRL_REG1.ODR and hertz, in each mode.
RATES = [(1, 1.0), (2, 10.0), (3, 25.0), (4, 50.0), (5, 100.0), (6, 200.0), (7, 400.0)]


class Bench:
    def __init__(self, *, ideal: bool = True, seed: int = 0) -> None:
        self.clock = Clock()
        self.reports: list[tuple[str, str]] = []
        self.felt = (0.0, 0.0, G)
        self.part = Lis3dh(
            self.clock, rng=Random(seed), ideal=ideal, motion_source=lambda _cycles: self.felt,
            report=lambda *a, **_: self.reports.append(a),
        )  # fmt: skip

    def transfer(self, *words: int) -> list[int | None]:
        """A transaction in mode 3."""
        self.part.select(0)
        answers = [self.part.exchange(word, 8, 1, 1) for word in words]
        self.part.select(1)
        return answers

    def write(self, address: int, byte: int) -> None:
        self.transfer(address, byte)

    def read(self, address: int, count: int = 1) -> list[int]:
        answers = self.transfer(0x80 | (0x40 if count > 1 else 0) | address, *[0] * count)
        assert answers[0] is None  # SDO is released while the address goes over
        return [answer for answer in answers[1:] if answer is not None]

    def run(self, ms: float) -> None:
        self.clock.advance_to(self.clock.now + round(ms * CYCLES_PER_MS))

    def words(self) -> list[int]:
        data = self.read(0x28, 6)
        return [signed(data[2 * axis] | data[2 * axis + 1] << 8) for axis in range(3)]


def signed(word: int) -> int:
    return word - 0x10000 if word & 0x8000 else word


def test_a_burst_without_ms_is_told() -> None:
    bench = Bench()
    bench.write(0x20, 0x57)
    bench.transfer(0x20, 0x57, 0x00)
    assert [rule for rule, _ in bench.reports] == ["burst-repeats"]
    bench.write(0x20, 0x57)
    for _ in range(2):
        bench.transfer(0x80 | 0x28, *[0] * 6)
    assert [rule for rule, _ in bench.reports] == ["burst-repeats"] * 2
    words = Bench()
    words.write(0x20, 0x57)
    for _ in range(2):
        words.part.select(0)
        for _ in range(2):  # the same in words of 16 bits
            words.part.exchange((0x80 | 0x28) << 8, 16, 1, 1)
        words.part.select(1)
    assert [rule for rule, _ in words.reports] == ["burst-repeats"]


def test_registers_after_power_up() -> None:
    bench = Bench()
    assert bench.read(0x0F) == [0x33]
    assert bench.read(0x1E) == [0x10]
    assert bench.read(0x20, 8) == [0x07, 0, 0, 0, 0, 0, 0, 0]
    bench.run(100)
    assert bench.words() == [0, 0, 0], "in power-down nothing is measured"
    assert bench.part.samples == 0


@given(
    mode=st.sampled_from(MODES), scale=st.integers(0, 3), rate=st.sampled_from(RATES),
    felt=st.tuples(*[st.floats(-300.0, 300.0)] * 3), enabled=st.integers(1, 7),
)  # fmt: skip
def test_words_are_those_of_the_sheet(
    mode: tuple[int, int, int, tuple[int, ...]], scale: int, rate: tuple[int, float],
    felt: tuple[float, float, float], enabled: int,
) -> None:  # fmt: skip
    low_power, high, bits, mg = mode
    bench = Bench()
    bench.felt = felt
    bench.write(0x23, 0x80 | scale << 4 | high << 3)
    bench.write(0x20, rate[0] << 4 | low_power << 3 | enabled)
    # Settled after 7 periods in high resolution, after one elsewhere.
    periods = 7 if high else 1
    bench.run(periods * 1000.0 / rate[1] - 0.01)
    assert bench.read(0x27) == [0]
    bench.run(0.02)
    assert bench.read(0x27) == [0x08 | enabled]
    for axis, word in enumerate(bench.words()):
        if not enabled >> axis & 1:
            assert word == 0
            continue
        assert word & ((1 << (16 - bits)) - 1) == 0, "left-justified"
        digits, limit = word >> (16 - bits), 1 << (bits - 1)
        wanted = felt[axis] / G * 1000.0 / mg[scale]
        assert abs(digits - min(max(wanted, -limit), limit - 1)) <= 0.5 + 1e-9
    assert bench.read(0x27) == [0]
    assert not bench.reports


@given(ms=st.lists(st.floats(0.1, 30.0), max_size=12), rate=st.sampled_from(RATES))
def test_samples_come_at_the_data_rate(ms: list[float], rate: tuple[int, float]) -> None:
    bench = Bench()
    bench.write(0x20, rate[0] << 4 | 7)
    for step in ms:
        bench.run(step)
    elapsed = bench.clock.now
    period = 200_000_000 / rate[1]
    assert bench.part.samples == pytest.approx(elapsed / period, abs=1.0)
    bench.write(0x20, 0x07)
    taken = bench.part.samples
    bench.run(1000)
    assert bench.part.samples == taken


@pytest.mark.parametrize(("ctrl1", "hertz"), [(0x8F, 1620.0), (0x9F, 5376.0), (0x97, 1344.0)])
def test_the_fast_rates(ctrl1: int, hertz: float) -> None:
    bench = Bench()
    bench.write(0x20, ctrl1)
    bench.run(100)
    assert bench.part.samples == pytest.approx(hertz / 10, abs=1)


def test_bdu_keeps_a_word_together() -> None:
    bench = Bench()
    for bdu, torn in ((0, True), (0x80, False)):
        bench.write(0x23, 0x08 | bdu)
        bench.write(0x20, 0x57)
        bench.felt = (0.255 * G, 0.0, G)  # 255 digits: 0x0FF0
        bench.run(71)
        low = bench.read(0x28)[0]
        bench.felt = (0.256 * G, 0.0, G)  # 256 digits: 0x1000
        bench.run(10)
        word = bench.read(0x29)[0] << 8 | low
        assert word == (0x10F0 if torn else 0x0FF0)
        assert bench.words()[0] == 0x1000, "what was held back comes now"


def test_overrun_and_big_endian() -> None:
    bench = Bench()
    bench.write(0x23, 0x48)
    bench.write(0x20, 0x57)
    bench.run(85)
    assert bench.read(0x27) == [0xFF]
    assert bench.read(0x2C, 2) == [0x3E, 0x80]  # 1000 digits << 4
    assert bench.read(0x27) == [0x33]  # z has gone, and with it the whole set


def test_a_specimen_has_noise_and_an_offset_within_the_sheet() -> None:
    for seed in range(5):
        bench = Bench(ideal=False, seed=seed)
        bench.write(0x23, 0x08)
        bench.write(0x20, 0x77)
        values = []
        bench.run(20)
        for _ in range(400):
            bench.run(2.55)
            values.append(bench.words()[2] / 16.0)
        # Zero-g level 40 mg; 220 ug a root of Hz over 400 Hz / 9: 1.47 mg, and what rounding adds.
        assert abs(fmean(values) - 1000.0) <= 40.5
        assert 1.2 < pstdev(values) < 1.9


def test_what_is_not_modelled_or_wrong_is_told() -> None:
    bench = Bench()
    for address, byte in ((0x24, 0x40), (0x22, 0x10), (0x30, 0x2A), (0x21, 0x08), (0x23, 0x01), (0x1F, 0x80)):
        bench.write(address, byte)
        assert bench.reports.pop()[0] == "unmodelled"
        assert bench.read(address) == [byte]
    bench.write(0x0F, 1)
    bench.write(0x10, 1)
    bench.write(0x20, 0x87)
    bench.write(0x1E, 0x90)  # the pull-up of SDO, which is right
    assert [rule for rule, _ in bench.reports] == ["device-register"] * 3
    bench.write(0x1E, 0x80)
    assert bench.reports.pop() == ("device-register", "LIS3DH: CTRL_REG0 = 0x80: bits 6 to 0 must be 0010000")
    assert bench.read(0x0F) == [0x33]
    bench.part.select(0)
    bench.part.exchange(0x8, 4, 1, 1)
    bench.part.select(1)
    assert bench.reports[-1] == ("spi-transaction-cut", "LIS3DH: chip select rose after 4 bits of a byte")


#: CTRL_REG1 as it comes, without the fastest rates: 20 us of each step would be a second of samples.
@given(
    st.lists(
        st.one_of(
            st.tuples(st.integers(0, 0xFF), st.integers(0, 0xFFFF), st.integers(1, 16)),
            st.tuples(st.just(-1), st.integers(0, 5000), st.just(0)),
        ),
        max_size=60,
    )
)
def test_no_words_upset_it(steps: list[tuple[int, int, int]]) -> None:
    """Words of any length, anywhere: it goes on, its identity stays, and nothing but 64 bytes is kept."""
    bench = Bench()
    for first, word, length in steps:
        if first < 0:
            bench.clock.advance_to(bench.clock.now + word * CYCLES_PER_US)
            continue
        bench.part.select(0)
        bench.part.exchange(first, 8, 1, 1)
        bench.part.exchange(word, length, word >> 3 & 1, word >> 5 & 1)
        bench.part.select(1)
    assert bench.read(0x0F) == [0x33]
    assert all(0 <= byte <= 0xFF for byte in bench.part.registers)
    assert len(bench.part.registers) == 64


def test_an_output_that_nothing_fills_is_told() -> None:
    bench = Bench()
    bench.words()
    assert {rule for rule, _ in bench.reports} == {"not-configured"}
    assert all("CTRL_REG1.ODR = 0: the device is in power-down" in message for _, message in bench.reports)
    bench.reports.clear()
    bench.write(0x20, 0x53)  # 100 Hz, x and y
    bench.run(100)
    bench.read(0x2C, 2)
    assert bench.reports == [
        ("not-configured", "LIS3DH.OUT_Z was read while CTRL_REG1.Zen = 0: the axis is disabled, and the value is old")
    ]


def test_a_burst_over_an_axis_that_is_off_is_told_nothing() -> None:
    bench = Bench()
    bench.write(0x20, 0x54)  # 100 Hz, z alone
    bench.run(100)
    bench.words()
    bench.write(0x20, 0x57)
    bench.run(100)
    bench.words()
    assert bench.reports == []
