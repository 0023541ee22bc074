"""L3G4200D in register and SPI language.  Expected values come from the data sheet's tables."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import SYSCLK_HZ
from emulator.devices import l3g4200d_registers as r
from tests.emulator.devices.gyro_bench import DEG, MS, counter, make, read, transfer, write, xyz


def test_every_register_has_the_reset_value_of_the_map() -> None:
    _, gyro, _ = make()
    for register in r.REGISTERS:
        assert read(gyro, register.address) == register.reset, register.name


def test_who_am_i_is_read_by_the_bytes_of_the_sheet() -> None:
    _, gyro, _ = make()
    assert transfer(gyro, 0x8F, 0x00) == [None, 0xD3]  # SDO is released during the address byte
    assert transfer(gyro, 0x8F00, length=16) == [0x00D3]


@given(word_lengths=st.lists(st.integers(1, 16), min_size=1, max_size=30))
def test_framing_does_not_depend_on_how_bits_are_cut_into_words(word_lengths: list[int]) -> None:
    _, gyro, _ = make()
    stream = 0x8F << 40  # 48 bits: read WHO_AM_I, MS = 0, so every further byte repeats it
    gyro.select(0)
    position, answer = 0, 0
    for length in [*word_lengths, *[8] * 6]:
        length = min(length, 48 - position)
        if not length:
            break
        bits = gyro.exchange(stream >> (48 - position - length) & ((1 << length) - 1), length, 0, 0)
        answer = answer << length | (bits or 0)
        position += length
    assert answer == 0xD3D3D3D3D3


@given(address=st.integers(0, 0x3F), value=st.integers(0, 0xFF))
def test_a_write_is_stored_only_where_the_map_says_rw(address: int, value: int) -> None:
    _, gyro, reports = make()
    known = {d.address: d for d in r.REGISTERS}
    before = gyro.registers[address]
    write(gyro, address, value)
    if address in known and known[address].access is r.Rw.RW:
        assert gyro.registers[address] == value & known[address].writable
        assert not [x for x in reports if "was written" in x[1] and "CTRL_REG2" not in x[1]]
    else:
        assert gyro.registers[address] == before
        assert [rule for rule, _ in reports] == ["device-register"]


def test_a_write_burst_with_ms_goes_to_successive_registers() -> None:
    _, gyro, _ = make()
    transfer(gyro, 0x72, 0x01, 0x02, 0x03)  # 0x40 | 0x32
    assert gyro.registers[0x32:0x35] == [1, 2, 3]


def test_a_cut_byte_and_a_wrong_mode_are_reported() -> None:
    _, gyro, reports = make()
    gyro.select(0)
    gyro.exchange(0x8, 4, 1, 1)
    gyro.select(1)
    gyro.select(0)
    gyro.exchange(0x20, 8, 0, 1)
    gyro.select(1)
    assert [rule for rule, _ in reports] == ["spi-transaction-cut", "spi-mode"]


def test_power_on_is_power_down_and_outputs_stay_zero() -> None:
    clock, gyro, _ = make(lambda _c: (1.0, 1.0, 1.0))
    clock.advance_to(SYSCLK_HZ)
    assert xyz(gyro) == (0, 0, 0)
    assert read(gyro, r.STATUS_REG) == 0


@pytest.mark.parametrize(("dr", "period_ms"), [(0, 10), (1, 5), (2, 2.5), (3, 1.25)])
def test_the_output_data_rate_follows_dr(dr: int, period_ms: float) -> None:
    clock, gyro, _ = make(lambda _c: (0.0, 0.0, 1.0))
    write(gyro, r.CTRL_REG1, dr << 6 | 0x0F)
    period = int(period_ms * MS)
    clock.advance_to(period - 1)
    assert read(gyro, r.STATUS_REG) == 0
    clock.advance_to(period)
    assert read(gyro, r.STATUS_REG) == 0x0F
    clock.advance_to(2 * period)
    assert read(gyro, r.STATUS_REG) == 0xFF  # the second sample overwrote an unread one


def test_an_oscillator_that_is_off_has_longer_periods_from_the_latest_sample_on() -> None:
    clock, gyro, _ = make(lambda _c: (0.0, 0.0, 1.0))
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(25 * MS)
    gyro.set_second(1.1 * SYSCLK_HZ)
    # Two samples until then; from the second, at 20 ms, on one each 11 ms.
    for at, count in ((31 * MS - 1, 2), (31 * MS, 3), (42 * MS - 1, 3), (42 * MS, 4), (20 * MS + 110 * MS, 12)):
        clock.advance_to(at)
        xyz(gyro)
        assert gyro.last_sample_index == count
    # So do those of a rate that is chosen later: 5.5 ms instead of 5.
    write(gyro, r.CTRL_REG1, 0x4F)
    assert gyro.period_cycles == 5_500_000 * SYSCLK_HZ // 10**9


@given(dps=st.floats(-3000, 3000), fs=st.integers(0, 3))
def test_a_digit_is_8_75_17_5_or_70_mdps_and_saturates_at_16_bits(dps: float, fs: int) -> None:
    clock, gyro, _ = make(lambda _c: (0.0, 0.0, dps * DEG))
    write(gyro, r.CTRL_REG4, fs << 4)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(10 * MS)
    exact = dps / (0.00875, 0.0175, 0.07, 0.07)[fs]
    assert abs(xyz(gyro)[2] - max(-32768.0, min(32767.0, exact))) <= 0.5 + 1e-6


def test_ms_zero_reads_the_same_register_six_times() -> None:
    clock, gyro, _ = make(lambda _c: (10 * DEG, 20 * DEG, 30 * DEG))
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(10 * MS)
    low = round(10 / 0.00875) & 0xFF
    assert transfer(gyro, 0xA8, *[0] * 6)[1:] == [low] * 6


def test_without_bdu_the_two_bytes_may_be_of_two_samples() -> None:
    # 255 digits, then 256: L = 0xFF of the first and H = 0x01 of the second make 511.
    clock, gyro, _ = make(lambda c: ((255 if c < 20 * MS else 256) * 0.00875 * DEG, 0.0, 0.0))
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(10 * MS)
    low = read(gyro, r.OUT_X_L)
    clock.advance_to(20 * MS)
    assert read(gyro, r.OUT_X_L + 1) << 8 | low == 511


def test_with_bdu_an_axis_is_held_until_both_bytes_were_read() -> None:
    clock, gyro, _ = make(lambda c: ((255 if c < 20 * MS else 256) * 0.00875 * DEG, 0.0, 0.0))
    write(gyro, r.CTRL_REG4, 0x80)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(10 * MS)
    low = read(gyro, r.OUT_X_L)
    clock.advance_to(20 * MS)
    assert read(gyro, r.OUT_X_L + 1) << 8 | low == 255
    assert read(gyro, r.OUT_X_L + 1) << 8 | read(gyro, r.OUT_X_L) == 256


def test_ble_swaps_the_bytes() -> None:
    clock, gyro, _ = make(lambda _c: (0x1234 * 0.00875 * DEG, 0.0, 0.0))
    write(gyro, r.CTRL_REG4, 0x40)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(10 * MS)
    assert [read(gyro, r.OUT_X_L), read(gyro, r.OUT_X_L + 1)] == [0x12, 0x34]


def test_flags_clear_with_the_high_byte_of_their_axis() -> None:
    clock, gyro, _ = make(lambda _c: (1.0, 1.0, 1.0))
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(10 * MS)
    read(gyro, r.OUT_X_L)
    assert read(gyro, r.STATUS_REG) == 0x0F
    read(gyro, r.OUT_X_L + 1)
    assert read(gyro, r.STATUS_REG) == 0x0E
    xyz(gyro)
    assert read(gyro, r.STATUS_REG) == 0


def test_a_disabled_axis_keeps_its_value_and_shows_no_flag() -> None:
    clock, gyro, _ = make(lambda _c: (1.0, 1.0, 1.0))
    write(gyro, r.CTRL_REG1, 0x0C)  # z only
    clock.advance_to(10 * MS)
    assert read(gyro, r.STATUS_REG) == 0x0C
    assert xyz(gyro) == (0, 0, round(1.0 / DEG / 0.00875))


def test_power_down_freezes_the_outputs() -> None:
    clock, gyro, _ = make(counter(10 * MS))
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(35 * MS)
    write(gyro, r.CTRL_REG1, 0x07)
    clock.advance_to(95 * MS)
    assert xyz(gyro) == (3, 6, -3)


def test_a_sample_read_twice_is_counted_and_named() -> None:
    clock, gyro, _ = make(counter(10 * MS))
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(25 * MS)
    xyz(gyro)
    assert (gyro.last_sample_index, gyro.last_sample_cycles, gyro.samples_read_twice) == (2, 20 * MS, 0)
    xyz(gyro)
    assert gyro.samples_read_twice == 3  # three axes
