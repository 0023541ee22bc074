"""What the ADC makes of the volts at a pin, and the conversions that are worth nothing."""

from __future__ import annotations

from random import Random

import pytest

from emulator.clock import CYCLES_PER_US
from tests.emulator.peripherals.adc_bench import LAT, SYNC, Bench


@pytest.mark.parametrize(
    ("volts", "code"), [(0.0, 0), (-0.2, 0), (3.0 / 4096, 1), (2.9999, 4095), (3.0, 4095), (3.3, 4095)]
)
def test_code_is_the_floor_of_the_ratio_clamped(volts: float, code: int) -> None:
    bench = Bench()
    bench.volts[0] = volts
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(LAT)
    assert bench.result(0) == code


def test_16_bits_differential_measures_between_the_pins_of_a_pair() -> None:
    bench = Bench()
    bench.regs.ADCCTL2.all = 0x00C6
    bench.soc(0).bit.ACQPS = 63
    bench.soc(0).bit.CHSEL = 2
    bench.volts[2], bench.volts[3] = 2.0, 1.25
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(SYNC + 64 + 120)
    assert bench.result(0) == 40960  # 65536 * (0.75 + 3) / 6
    assert len(bench.findings) == 0


def test_noise_is_seeded_and_centred() -> None:
    def codes(seed: int) -> list[int]:
        bench = Bench(noise_lsb=2.0, random=Random(seed))
        bench.volts[0] = 1.5
        taken = []
        for _ in range(200):
            bench.regs.ADCSOCFRC1.all = 1
            bench.clock.charge(LAT)
            taken.append(bench.result(0))
        return taken

    assert codes(1) == codes(1)
    assert codes(1) != codes(2)
    # Mean 2048 - 0.5 (floor), sigma 2/sqrt(200) = 0.14: five sigma.
    assert abs(sum(codes(1)) / 200 - 2047.5) < 0.7


def test_forced_codes_come_in_order_and_may_exceed_12_bits() -> None:
    bench = Bench()
    bench.volts[0] = 1.0
    bench.adc.force_codes([5, 40000])
    for expected in (5, 40000):
        bench.regs.ADCSOCFRC1.all = 1
        bench.clock.charge(LAT)
        assert bench.result(0) == expected
    bench.regs.ADCSOCFRC1.all = 1
    with pytest.raises(ValueError, match="no forced code is left for the conversion of SOC0"):
        bench.clock.charge(LAT)


@pytest.mark.parametrize("wait_us", [0, 499])
def test_a_conversion_before_500_us_of_power_is_garbage_and_a_finding(wait_us: int) -> None:
    bench = Bench(powered=False)
    bench.volts[0] = 1.5
    if wait_us:
        bench.regs.ADCCTL1.bit.ADCPWDNZ = 1
        bench.clock.charge(wait_us * CYCLES_PER_US)
    bench.regs.ADCSOCFRC1.all = 1
    bench.clock.charge(LAT)
    assert [f.rule for f in bench.findings] == ["adc-not-powered"]
    assert bench.result(0) == Random(0).randrange(4096)


def test_limits_that_no_chip_reports_are_findings() -> None:
    bench = Bench()
    bench.soc(0).bit.ACQPS = 13
    bench.regs.ADCCTL2.all = 0x0085
    bench.regs.ADCSOCFRC1.all = 1
    assert [f.rule for f in bench.findings] == ["adc-window", "adc-clock", "adc-mode"]
