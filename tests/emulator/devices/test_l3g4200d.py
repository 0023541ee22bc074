"""L3G4200D in register and SPI language.  Expected values come from the data sheet's tables."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, Clock
from emulator.devices import l3g4200d_registers as r
from emulator.devices.l3g4200d import L3G4200D
from emulator.devices.l3g4200d_signal import GyroUnit

MS = CYCLES_PER_MS
DEG = math.pi / 180.0
Source = Callable[[int], tuple[float, float, float]]


def make(source: Source | None = None, **kwargs: object) -> tuple[Clock, L3G4200D, list[tuple[str, str]]]:
    clock = Clock()
    reports: list[tuple[str, str]] = []
    gyro = L3G4200D(
        clock,
        rng=random.Random(1),
        rate_source=source,
        report=lambda *a, **_: reports.append(a),
        **kwargs,  # type: ignore[arg-type]
    )
    return clock, gyro, reports


def transfer(gyro: L3G4200D, *data: int, length: int = 8) -> list[int | None]:
    """One transaction in mode 3."""
    gyro.select(0)
    answer = [gyro.exchange(word, length, 1, 1) for word in data]
    gyro.select(1)
    return answer


def write(gyro: L3G4200D, address: int, value: int) -> None:
    transfer(gyro, address, value)


def read(gyro: L3G4200D, address: int) -> int:
    value = transfer(gyro, 0x80 | address, 0)[1]
    assert value is not None
    return value


def xyz(gyro: L3G4200D) -> tuple[int, ...]:
    """Burst E8 + six bytes, low byte first."""
    b = transfer(gyro, 0xE8, *[0] * 6)[1:]
    words = [(b[i + 1] or 0) << 8 | (b[i] or 0) for i in (0, 2, 4)]
    return tuple(w - 65536 if w & 0x8000 else w for w in words)


def counter(clock_period: int) -> Source:
    """A rate whose digits at 250 dps are the number of the sample (x), its double (y), its negative (z)."""

    def source(cycles: int) -> tuple[float, float, float]:
        n = cycles // clock_period
        return (n * 0.00875 * DEG, 2 * n * 0.00875 * DEG, -n * 0.00875 * DEG)

    return source


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


def test_bypass_with_fifo_en_gives_the_newest_sample_and_an_empty_fifo() -> None:
    clock, gyro, _ = make(counter(10 * MS))
    write(gyro, r.CTRL_REG5, 0x40)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(75 * MS)
    assert xyz(gyro) == (7, 14, -7)
    assert read(gyro, r.FIFO_SRC_REG) == 0x20


def test_bypass_computes_only_the_sample_that_is_read() -> None:
    asked: list[int] = []
    clock, gyro, _ = make(lambda c: (asked.append(c), (0.0, 0.0, 0.0))[1])  # type: ignore[func-returns-value]
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(SYSCLK_HZ)
    xyz(gyro)
    assert asked == [SYSCLK_HZ]
    assert clock.events_run == 0


def test_fifo_mode_keeps_the_first_32_sets_and_stops() -> None:
    clock, gyro, _ = make(counter(10 * MS))
    write(gyro, r.CTRL_REG5, 0x40)
    write(gyro, r.FIFO_CTRL_REG, 0x20 | 10)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(90 * MS)
    assert read(gyro, r.FIFO_SRC_REG) == 9
    clock.advance_to(100 * MS)
    assert read(gyro, r.FIFO_SRC_REG) == 0x80 | 10
    clock.advance_to(1000 * MS)
    assert read(gyro, r.FIFO_SRC_REG) == 0xC0 | 31
    burst = transfer(gyro, 0xE8, *[0] * 12)[1:]  # after OUT_Z_H comes OUT_X_L again
    assert (burst[0], burst[6]) == (1, 2)
    write(gyro, r.FIFO_CTRL_REG, 0)
    assert read(gyro, r.FIFO_SRC_REG) == 0x20


def test_stream_mode_drops_the_oldest() -> None:
    clock, gyro, _ = make(counter(10 * MS))
    write(gyro, r.CTRL_REG5, 0x40)
    write(gyro, r.FIFO_CTRL_REG, 0x40)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(1000 * MS)
    assert xyz(gyro)[0] == 69  # sets 69..100 are the last 32
    assert read(gyro, r.FIFO_SRC_REG) & 0x1F == 31


def step(at: int, low: float, high: float) -> Source:
    return lambda c: (low * DEG if c < at else high * DEG, 0.0, 0.0)


def test_trigger_modes_change_on_the_int1_event() -> None:
    for mode, level in ((3, 32), (4, 32)):
        clock, gyro, _ = make(step(500 * MS, 1.0, 100.0))
        write(gyro, r.CTRL_REG5, 0x40)
        write(gyro, r.FIFO_CTRL_REG, mode << 5)
        write(gyro, r.INT1_THS_XH, 0x10)  # 4096 digits = 35.84 dps
        write(gyro, r.INT1_CFG, 0x02)
        write(gyro, r.CTRL_REG1, 0x0F)
        clock.advance_to(490 * MS)
        assert read(gyro, r.FIFO_SRC_REG) & 0x20 == (0x20 if mode == 4 else 0)
        clock.advance_to(2000 * MS)
        gyro.read_register(r.FIFO_SRC_REG)
        assert gyro.fifo.level == level
        # Stream-to-FIFO froze the 32 sets up to the event at sample 50; bypass-to-stream runs on to sample 200.
        oldest = gyro.fifo.oldest()
        assert oldest is not None
        assert oldest.number == (19 if mode == 3 else 169)


def test_int1_rises_with_the_sample_that_crosses_the_threshold_and_latches() -> None:
    clock, gyro, _ = make(lambda c: ((100.0 if 500 * MS <= c < 600 * MS else 1.0) * DEG, 0.0, 0.0))
    edges: list[tuple[int, int]] = []
    gyro.int1.on_change(lambda level: edges.append((clock.now, level)))
    write(gyro, r.INT1_THS_XH, 0x10)
    write(gyro, r.INT1_CFG, 0x42)  # LIR, XHIE
    write(gyro, r.CTRL_REG3, 0x80)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(800 * MS)
    assert edges == [(500 * MS, 1)]
    assert read(gyro, r.INT1_SRC) == 0x42  # IA, XH
    assert edges[-1] == (800 * MS, 0)
    assert read(gyro, r.INT1_SRC) == 0


def test_duration_delays_int1_and_wait_holds_it() -> None:
    clock, gyro, _ = make(lambda c: ((100.0 if 500 * MS <= c < 600 * MS else 1.0) * DEG, 0.0, 0.0))
    edges: list[tuple[int, int]] = []
    gyro.int1.on_change(lambda level: edges.append((clock.now, level)))
    write(gyro, r.INT1_THS_XH, 0x10)
    write(gyro, r.INT1_CFG, 0x02)
    write(gyro, r.INT1_DURATION, 0x80 | 3)
    write(gyro, r.CTRL_REG3, 0x80)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(800 * MS)
    # Present from 500 ms: three periods later.  Absent from the sample at 600 ms: the third absent one is at 620 ms.
    assert edges == [(530 * MS, 1), (620 * MS, 0)]


def test_int1_active_low_and_open_drain() -> None:
    _, gyro, _ = make()
    gyro.int1.set_pull(1)
    write(gyro, r.CTRL_REG3, 0x30)  # H_Lactive, PP_OD: inactive is high, and open drain releases it
    assert gyro.int1.level == 1
    assert not gyro.int1.driven()


def test_drdy_follows_zyxda() -> None:
    clock, gyro, _ = make(counter(10 * MS))
    edges: list[tuple[int, int]] = []
    gyro.drdy.on_change(lambda level: edges.append((clock.now, level)))
    write(gyro, r.CTRL_REG3, 0x08)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(12 * MS)
    xyz(gyro)
    clock.advance_to(21 * MS)
    assert edges == [(10 * MS, 1), (12 * MS, 0), (20 * MS, 1)]


@pytest.mark.parametrize(("bits", "dps"), [(0b01, 130.0), (0b11, -130.0), (0b10, 0.0)])
def test_self_test_adds_its_typical_change(bits: int, dps: float) -> None:
    clock, gyro, _ = make()
    write(gyro, r.CTRL_REG4, bits << 1)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(10 * MS)
    assert xyz(gyro)[2] == round(dps / 0.00875)


def test_temperature_counts_down_one_a_degree_once_a_second() -> None:
    clock, gyro, _ = make(temperature_c=25.0)
    write(gyro, r.CTRL_REG1, 0x0F)
    assert read(gyro, r.OUT_TEMP) == 0
    gyro.set_temperature(28.0)
    clock.advance_to(SYSCLK_HZ - 1)
    assert read(gyro, r.OUT_TEMP) == 0
    clock.advance_to(SYSCLK_HZ)
    assert read(gyro, r.OUT_TEMP) == 0x100 - 3


def amplitude(ctrl5: int, ctrl1: int, ctrl2: int, hz: float) -> float:
    """Peak of the output for a sine of 100 dps after 3 s, relative to the input."""
    clock, gyro, _ = make(lambda c: (100.0 * DEG * math.sin(2 * math.pi * hz * c / SYSCLK_HZ), 0.0, 0.0))
    write(gyro, r.CTRL_REG2, ctrl2)
    write(gyro, r.CTRL_REG5, ctrl5)
    write(gyro, r.CTRL_REG1, ctrl1)
    peak = 0
    for n in range(1, 3200):
        clock.advance_to(n * 250_000)
        peak = max(peak, abs(xyz(gyro)[0])) if n > 2400 else peak
    return peak * 0.00875 / 100.0


def test_bw_does_nothing_unless_out_sel_takes_the_second_low_pass() -> None:
    # 800 Hz, BW 00: LPF2 cuts off at 30 Hz, where a second-order Butterworth passes 0.7071.
    assert amplitude(0x00, 0xCF, 0, 30.0) == pytest.approx(1.0, abs=0.01)
    assert amplitude(0x02, 0xCF, 0, 30.0) == pytest.approx(math.sqrt(0.5), abs=0.01)


def test_the_high_pass_is_in_the_path_with_out_sel_01() -> None:
    # 800 Hz, HPCF 3: 8 -> (56, 30, 15, 8): 8 Hz passes 0.7071.
    assert amplitude(0x01, 0xCF, 0x03, 8.0) == pytest.approx(math.sqrt(0.5), abs=0.01)
    assert amplitude(0x12, 0xFF, 0x03, 8.0) == pytest.approx(math.sqrt(0.5), abs=0.02)  # HPen, LPF2 at 110 Hz


def test_reading_reference_restarts_the_high_pass() -> None:
    clock, gyro, _ = make(lambda _c: (50.0 * DEG, 0.0, 0.0))
    write(gyro, r.CTRL_REG2, 0x09)  # 0.01 Hz at 100 Hz: a minute until a step is forgotten
    write(gyro, r.CTRL_REG5, 0x01)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(10 * MS)
    assert xyz(gyro)[0] > 5000  # the step of 5714 digits passes
    read(gyro, r.REFERENCE)
    clock.advance_to(20 * MS)
    assert xyz(gyro)[0] == 0


def test_a_realistic_specimen_is_biased_noisy_and_settles() -> None:
    unit = GyroUnit(
        zero_rate=(1.0, 0.0, 0.0),
        turn_on_error_dps=(100.0, 0.0, 0.0),
        turn_on_s=0.25,
        noise_density_dps=0.03,
        lpf1=True,
    )
    clock, gyro, _ = make(unit=unit)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(20 * MS)
    assert xyz(gyro)[0] * 0.00875 > 50.0
    values = []
    for n in range(100, 1100):
        clock.advance_to(n * 10 * MS)
        values.append(xyz(gyro)[0] * 0.00875)
    mean = sum(values) / len(values)
    assert mean == pytest.approx(10.0, abs=0.05)  # typical zero-rate level at 250 dps
    # White noise of 0.03 dps/sqrt(Hz) over 50 Hz, through a pole of gain a = 1 - exp(-2 pi 32 / 100) = 0.866:
    # sigma = 0.2121 * sqrt(a / (2 - a)) = 0.185 dps.
    sigma = math.sqrt(sum((v - mean) ** 2 for v in values) / len(values))
    assert sigma == pytest.approx(0.185, rel=0.1)


def test_one_seed_is_one_specimen() -> None:
    def run(seed: int) -> list[tuple[int, ...]]:
        clock = Clock()
        gyro = L3G4200D(clock, rng=random.Random(seed), ideal=False)
        write(gyro, r.CTRL_REG1, 0x0F)
        out = []
        for n in range(1, 20):
            clock.advance_to(n * 20 * MS)
            out.append(xyz(gyro))
        return out

    assert run(3) == run(3) != run(4)
