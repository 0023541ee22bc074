"""The L3G4200D's signal: self-test, temperature, filters, a real specimen.  Values are the data sheet's."""

from __future__ import annotations

import math
import random

import pytest

from emulator.clock import SYSCLK_HZ, Clock
from emulator.devices import l3g4200d_registers as r
from emulator.devices.l3g4200d import L3G4200D
from emulator.devices.l3g4200d_signal import GyroUnit
from tests.emulator.devices.gyro_bench import DEG, MS, make, read, write, xyz


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
