"""The chip as a whole: addresses, clock gates, pins behind the multiplexer, interrupt lines (DS, HDR, TRM)."""

from __future__ import annotations

from random import Random

import pytest

from emulator.board import Board
from emulator.chip import BLOCKS, Chip
from emulator.registers.core import ALL
from emulator.signals import SerialFrame


@pytest.fixture
def chip() -> Chip:
    return Chip(rng=Random(0))


def write(chip: Chip, block: str, register: str, word: int) -> None:
    chip.cpu.eallow = True
    chip.register(block, register).write(word, ALL)


def test_blocks_do_not_overlap() -> None:
    owner: dict[int, str] = {}
    for name, (kind, base) in BLOCKS.items():
        for register, place in kind.layout.items():
            for word in range(place.register.bits // 16):
                address = base + place.offset + word
                assert owner.setdefault(address, name) == name, f"{name}.{register}: {owner[address]} at {address:#x}"


def test_registers_answer_by_address_in_halves_low_word_first(chip: Chip) -> None:
    # CPU timer 0 PRD stands at 0x0C02 (base 0x0C00, offset 2), 32 bits.
    chip.memory.write_word(0x0C02, 0x1234)
    chip.memory.write_word(0x0C03, 0x5678)
    assert chip.register("CpuTimer0Regs", "PRD").value == 0x56781234
    assert chip.memory.read_word(0x0C03) == 0x5678
    assert chip.memory.load("uint32", 0x0C02) == 0x56781234


def test_a_register_that_does_not_exist_is_named(chip: Chip) -> None:
    with pytest.raises(ValueError, match=r"no register AdcaRegs\.ADCSOC99CTL"):
        chip.register("AdcaRegs", "ADCSOC99CTL")


def test_a_module_is_deaf_until_its_clock_gate_opens(chip: Chip) -> None:
    brr = chip.register("SpiaRegs", "SPIBRR")
    brr.write(49, ALL)
    assert [f.rule for f in chip.findings] == ["clock-gated"]
    write(chip, "CpuSysRegs", "PCLKCR8", 1)
    brr.write(49, ALL)
    assert brr.read() == 49


def test_a_pwm_reaches_its_pin_only_while_the_pin_is_muxed_to_it(chip: Chip) -> None:
    write(chip, "CpuSysRegs", "PCLKCR2", 1 << 1)
    write(chip, "CpuSysRegs", "PCLKCR0", 1 << 18)
    for register, word in (
        ("TBCTL", 3), ("TBPRD", 4999), ("CMPA", 1250 << 16), ("AQCTLA", 0x12), ("TBCTL", 0),
    ):  # fmt: skip
        write(chip, "EPwm2Regs", register, word)
    chip.clock.advance_to(100_000)
    pin = chip.pwm_outputs["GPIO2"]
    assert pin.duty == 0.0
    write(chip, "GpioCtrlRegs", "GPAMUX1", 1 << 4)
    # Up mode, set at zero, cleared at CMPA: 1250 of 5000; TBCLK is SYSCLK/2.
    assert (pin.duty, pin.period_cycles) == (0.25, 10_000)
    write(chip, "GpioCtrlRegs", "GPAMUX1", 0)
    assert pin.duty == 0.0


def test_epwmclk_divider_reaches_the_running_pwm(chip: Chip) -> None:
    test_a_pwm_reaches_its_pin_only_while_the_pin_is_muxed_to_it(chip)
    write(chip, "GpioCtrlRegs", "GPAMUX1", 1 << 4)
    write(chip, "ClkCfgRegs", "PERCLKDIVSEL", 0)
    chip.clock.advance_to(chip.clock.now + 100_000)
    assert chip.pwm_outputs["GPIO2"].period_cycles == 5_000


def test_a_character_reaches_the_sci_only_through_a_muxed_pin(chip: Chip) -> None:
    write(chip, "CpuSysRegs", "PCLKCR7", 1 << 2)
    for register, word in (("SCICCR", 7), ("SCIHBAUD", 2), ("SCILBAUD", 0x8A), ("SCICTL1", 0x23)):
        write(chip, "ScicRegs", register, word)
    frame = SerialFrame(0x41, 0, 208_320, 20_832.0)
    chip.serial_pins[90].send(frame)
    assert chip.register("ScicRegs", "SCIRXST").read() & 0x40 == 0
    # GPIO90 is SCIRXDC at mux 6: GMUX 1, MUX 2.
    write(chip, "GpioCtrlRegs", "GPCGMUX2", 1 << 20)
    write(chip, "GpioCtrlRegs", "GPCMUX2", 2 << 20)
    chip.serial_pins[90].send(frame)
    assert chip.register("ScicRegs", "SCIRXST").read() & 0x40
    assert chip.register("ScicRegs", "SCIRXBUF").read() & 0xFF == 0x41


def test_an_encoder_counts_only_on_muxed_pins(chip: Chip) -> None:
    write(chip, "CpuSysRegs", "PCLKCR4", 1)
    write(chip, "EQep1Regs", "QPOSMAX", 0xFFFFFFFF)
    write(chip, "EQep1Regs", "QEPCTL", 1 << 3)
    chip.encoder_pins[10, 11].move(5, 0, 0)
    write(chip, "GpioCtrlRegs", "GPAGMUX1", 5 // 4 << 20 | 5 // 4 << 22)
    write(chip, "GpioCtrlRegs", "GPAMUX1", 1 << 20 | 1 << 22)
    chip.encoder_pins[10, 11].move(7, 0, 0)
    assert chip.register("EQep1Regs", "QPOSCNT").read() == 7


def test_the_end_of_a_conversion_is_interrupt_1_1(chip: Chip) -> None:
    taken: list[int] = []
    chip.pie.set_vector(0x20, lambda: taken.append(chip.clock.now))
    write(chip, "PieCtrlRegs", "PIECTRL", 1)
    write(chip, "PieCtrlRegs", "PIEIER1", 1)
    write(chip, "CpuSysRegs", "PCLKCR13", 1)
    for register, word in (("ADCCTL2", 6), ("ADCCTL1", 0x84), ("ADCSOC0CTL", 19), ("ADCINTSEL1N2", 0x20)):
        write(chip, "AdcaRegs", register, word)
    chip.enable_line(1)
    chip.cpu.enable_interrupts()
    chip.clock.advance_to(chip.clock.now + 200_000)
    write(chip, "AdcaRegs", "ADCSOCFRC1", 1)
    chip.clock.advance_to(chip.clock.now + 1_000)
    assert len(taken) == 1


def test_boards_of_one_seed_are_alike() -> None:
    first, second = Board(seed=5, ideal=False), Board(seed=5, ideal=False)
    assert first.left_motor.params == second.left_motor.params
    assert Board(seed=6, ideal=False).left_motor.params != first.left_motor.params


def test_sonars_switched_on_with_the_cpu_are_not_ready_for_the_start_pulse_at_10_ms() -> None:
    for powered_up, expected in ((True, True), (False, False)):
        board = Board(sonars_powered_up=powered_up)
        board.clock.advance_to(2_000_000)
        start = board.pins[69]
        start.drive("cpu", 1)
        board.clock.advance_to(board.clock.now + 5_000)
        start.drive("cpu", 0)
        board.clock.advance_to(board.clock.now + 2_000)
        start.drive("cpu", None)
        board.clock.advance_to(200_000_000)
        assert (board.sonars.sensors["LEFT"].readings > 0) is expected


def test_spi_words_go_to_whatever_pins_are_muxed_to_them_and_to_the_bus_on_its_own(chip: Chip) -> None:
    bus = chip.spi_bus
    assert bus.missing == "GPIO58 has function 0, where SPI-A is function 15"
    # GPAMUX2 holds two bits for each of GPIO16 to 31: 1 for GPIO16, 17, 18 is 0b010101 (HDR pin_map).
    write(chip, "GpioCtrlRegs", "GPAMUX2", 0x15)
    assert (bus.missing, bus.connected) == ("", False)
    # GPBGMUX2 and GPBMUX2, likewise of GPIO48 to 63: 15 is 3 in each, for GPIO58, 59, 60 from bit 20 on.
    for register in ("GPBGMUX2", "GPBMUX2"):
        write(chip, "GpioCtrlRegs", register, 0x3F << 20)
    assert (bus.missing, bus.connected) == ("", True)


def test_sci_a_has_gpio29_and_gpio28_too(chip: Chip) -> None:
    # GPIO29 and 28 with function 1 (HDR pin_map): bits 26 and 24 of GPAMUX2.
    write(chip, "GpioCtrlRegs", "GPAMUX2", 1 << 26 | 1 << 24)
    sent: list[SerialFrame] = []
    chip.serial_pins[29].on_frame(sent.append)
    write(chip, "CpuSysRegs", "PCLKCR7", 1)
    # 8 bits, TXENA and SWRESET, then the baud rate, then a character.
    for register, word in (("SCICCR", 7), ("SCILBAUD", 40), ("SCICTL1", 0x22), ("SCITXBUF", 0x41)):
        write(chip, "SciaRegs", register, word)
    chip.clock.advance_to(chip.clock.now + 1_000_000)
    assert [frame.data for frame in sent] == [0x41]
    assert not list(chip.findings)
