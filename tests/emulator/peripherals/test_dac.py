"""Buffered DAC (TRM, buffered DAC): codes, references, enable, locks, clock gate, and the pin that an ADC samples."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.chip import Chip
from emulator.registers.core import ALL

#: PCLKCR16 and SOFTPRES16: DAC-A is bit 16 (HDR).
DACS = (("a", "A", 0), ("b", "A", 1), ("c", "B", 1))


@pytest.fixture
def chip() -> Chip:
    return new_chip()


def new_chip() -> Chip:
    chip = Chip(rng=Random(0), vrefhi_v=2.5)
    write(chip, "CpuSysRegs", "PCLKCR16", 0b111 << 16)
    return chip


def write(chip: Chip, block: str, register: str, word: int) -> None:
    chip.cpu.eallow = True
    chip.register(block, register).write(word, ALL)


@pytest.mark.parametrize(("letter", "adc", "channel"), DACS)
def test_a_code_is_that_part_of_the_reference_on_its_pin_once_the_output_is_on(
    chip: Chip, letter: str, adc: str, channel: int
) -> None:
    pin, block = chip.analog[adc][channel], f"Dac{letter}Regs"
    pin.follow("test", lambda _cycles: 0.125)
    write(chip, block, "DACCTL", 1)
    write(chip, block, "DACVALS", 2048)
    assert pin.source.volts(0) == 0.125
    write(chip, block, "DACOUTEN", 1)
    # 2048 of 4096 parts of 2.5 V.
    assert pin.source.volts(0) == 1.25
    assert chip.register(block, "DACVALA").read() == 2048
    write(chip, block, "DACOUTEN", 0)
    assert pin.source.volts(0) == 0.125


@given(code=st.integers(0, 4095))
def test_the_adc_of_the_pin_reads_the_code_back(code: int) -> None:
    chip = new_chip()
    write(chip, "CpuSysRegs", "PCLKCR13", 1)
    for register, word in (("DACCTL", 1), ("DACOUTEN", 1), ("DACVALS", code)):
        write(chip, "DacaRegs", register, word)
    for register, word in (("ADCCTL2", 6), ("ADCCTL1", 0x80), ("ADCSOC0CTL", 19)):
        write(chip, "AdcaRegs", register, word)
    chip.clock.advance_to(200_000)
    write(chip, "AdcaRegs", "ADCSOCFRC1", 1)
    chip.clock.advance_to(chip.clock.now + 1_000)
    # Both have 12 bits and the same reference.
    assert chip.register("AdcaResultRegs", "ADCRESULT0").read() == code


def test_registers_are_locked_only_with_the_key(chip: Chip) -> None:
    write(chip, "DacaRegs", "DACLOCK", 0b010)
    write(chip, "DacaRegs", "DACVALS", 100)
    assert chip.register("DacaRegs", "DACVALA").read() == 100
    write(chip, "DacaRegs", "DACLOCK", 0xA << 12 | 0b010)
    write(chip, "DacaRegs", "DACVALS", 200)
    assert chip.register("DacaRegs", "DACVALA").read() == 100
    assert [(f.rule, f.object) for f in chip.findings] == [("locked", "DacaRegs.DACVALS")]


def test_a_software_reset_lets_the_pin_go(chip: Chip) -> None:
    for register, word in (("DACOUTEN", 1), ("DACVALS", 4095), ("DACLOCK", 0xA << 12 | 0b111)):
        write(chip, "DacbRegs", register, word)
    write(chip, "DevCfgRegs", "SOFTPRES16", 1 << 17)
    assert chip.analog["A"][1].source.volts(0) == 0.0
    write(chip, "DacbRegs", "DACVALS", 7)
    assert chip.register("DacbRegs", "DACVALA").read() == 7
    assert not list(chip.findings)


def test_without_its_clock_a_dac_is_deaf(chip: Chip) -> None:
    write(chip, "CpuSysRegs", "PCLKCR16", 0)
    write(chip, "DacaRegs", "DACVALS", 7)
    assert [f.rule for f in chip.findings] == ["clock-gated"]


def test_loads_by_an_epwm_are_told_to_be_missing(chip: Chip) -> None:
    write(chip, "DacaRegs", "DACCTL", 1 << 2)
    assert [f.rule for f in chip.findings] == ["unmodelled"]
