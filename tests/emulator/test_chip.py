"""The chip as a whole: addresses, clock gates, pins behind the multiplexer, interrupt lines (DS, HDR, TRM)."""

from __future__ import annotations

from random import Random

import pytest

from emulator.blocks import BLOCKS
from emulator.chip import Chip
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
    for name, block in BLOCKS.items():
        for register, place in block.kind.layout.items():
            for word in range(place.register.bits // 16):
                address = block.base + place.offset + word
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


def mux(chip: Chip, pin: int, function: int) -> None:
    """Give a pin a function: MUX and GMUX hold two bits a pin, 16 pins a register (TRM GPIO)."""
    port, half = "ABCDEF"[pin // 32], 1 + pin % 32 // 16
    for register, bits in ((f"GP{port}GMUX{half}", function >> 2), (f"GP{port}MUX{half}", function & 3)):
        before = chip.register("GpioCtrlRegs", register).value & ~(3 << pin % 16 * 2)
        write(chip, "GpioCtrlRegs", register, before | bits << pin % 16 * 2)


#: Module, its interrupt line of IER, the bit of its first interrupt in PIEIER, its vector (HDR hw_ints.h, pievect.h).
ADCS = (("a", 1, 0, 0x20), ("b", 1, 1, 0x21), ("c", 1, 2, 0x22), ("d", 1, 5, 0x25))


@pytest.mark.parametrize(("letter", "line", "bit", "vector"), ADCS)
def test_each_adc_converts_its_own_pin_and_has_its_own_interrupt(
    chip: Chip, letter: str, line: int, bit: int, vector: int
) -> None:
    taken: list[int] = []
    chip.pie.set_vector(vector, lambda: taken.append(chip.clock.now))
    write(chip, "PieCtrlRegs", "PIECTRL", 1)
    write(chip, "PieCtrlRegs", f"PIEIER{line}", 1 << bit)
    write(chip, "CpuSysRegs", "PCLKCR13", 1 << "abcd".index(letter))
    block = f"Adc{letter}Regs"
    # Channel 3 by software, window of 20 cycles; EOC0 drives ADCINT1.
    for register, word in (("ADCCTL2", 6), ("ADCCTL1", 0x84), ("ADCSOC0CTL", 3 << 15 | 19), ("ADCINTSEL1N2", 0x20)):
        write(chip, block, register, word)
    chip.analog[letter.upper()][3].follow("test", lambda _cycles: 0.75)
    chip.enable_line(line)
    chip.cpu.enable_interrupts()
    chip.clock.advance_to(chip.clock.now + 200_000)
    write(chip, block, "ADCSOCFRC1", 1)
    chip.clock.advance_to(chip.clock.now + 1_000)
    # 0.75 V of 3 V is a quarter of 4096.
    assert chip.register(f"Adc{letter}ResultRegs", "ADCRESULT0").read() == 1024
    assert len(taken) == 1


def test_the_adcs_share_inputs_14_and_15_and_no_others(chip: Chip) -> None:
    # DS, analog subsystem: ADCIN14 and ADCIN15 go to all four modules.
    for n in range(16):
        assert len({id(inputs[n]) for inputs in chip.analog.values()}) == (1 if n in (14, 15) else 4)


def test_one_trigger_starts_all_adcs_that_wait_for_it(chip: Chip) -> None:
    write(chip, "CpuSysRegs", "PCLKCR13", 0b1111)
    for letter in "abd":
        # TRIGSEL 5, ePWM1 SOCA, and 1, CPU timer 0 (TRM ADC, ADCSOCxCTL).
        for register, word in (("ADCCTL1", 0x80), ("ADCSOC2CTL", (1 if letter == "d" else 5) << 20 | 19)):
            write(chip, f"Adc{letter}Regs", register, word)
    write(chip, "CpuSysRegs", "PCLKCR2", 1)
    write(chip, "CpuSysRegs", "PCLKCR0", 1 << 18)
    chip.clock.advance_to(200_000)
    # An SOCA at the first zero: 1000 TBCLK of two cycles, and one behind which TBPRD is loaded.
    for register, word in (("TBPRD", 999), ("ETPS", 1 << 8), ("ETSEL", 1 << 11 | 1 << 8), ("TBCTL", 0)):
        write(chip, "EPwm1Regs", register, word)
    chip.clock.advance_to(chip.clock.now + 2_000)
    assert {letter: adc.conversions for letter, adc in chip.adc.items()} == {"A": 0, "B": 0, "C": 0, "D": 0}
    chip.clock.advance_to(chip.clock.now + 200)
    assert {letter: adc.conversions for letter, adc in chip.adc.items()} == {"A": 1, "B": 1, "C": 0, "D": 0}


def test_a_rising_edge_of_input5_is_the_external_trigger_of_all_adcs(chip: Chip) -> None:
    write(chip, "CpuSysRegs", "PCLKCR13", 0b11)
    for letter in "ab":
        # TRIGSEL 4 is ADCEXTSOC (TRM ADC, ADCSOCxCTL).
        for register, word in (("ADCCTL2", 6), ("ADCCTL1", 0x80), ("ADCSOC0CTL", 4 << 20 | 19)):
            write(chip, f"Adc{letter}Regs", register, word)
    chip.clock.advance_to(200_000)
    write(chip, "InputXbarRegs", "INPUT5SELECT", 7)
    for level in (1, 0, 1, 0):
        chip.pins[7].drive("test", level)
        chip.clock.advance_to(chip.clock.now + 1_000)
    assert [chip.adc[letter].conversions for letter in "AB"] == [2, 2]
    assert not list(chip.findings)


#: Module, SIMO, SOMI, CLK with their functions, group and receive interrupt (HDR pin_map.h, pievect.h).
SPIS = (
    ("a", ((16, 1), (17, 1), (18, 1)), 6, 1), ("a", ((54, 1), (55, 1), (56, 1)), 6, 1),
    ("b", ((63, 15), (64, 15), (65, 15)), 6, 3), ("b", ((24, 6), (25, 6), (22, 6)), 6, 3),
    ("c", ((69, 15), (70, 15), (71, 15)), 6, 9), ("c", ((122, 6), (123, 6), (124, 6)), 6, 9),
)  # fmt: skip


class Echo:
    """Answers each word with its complement."""

    def select(self, level: int) -> None: ...

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int | None:
        return ~out_bits & (1 << length) - 1


@pytest.mark.parametrize(("letter", "pins", "group", "number"), SPIS)
def test_each_spi_reaches_its_bus_through_its_pins_and_has_its_own_interrupt(
    chip: Chip, letter: str, pins: tuple[tuple[int, int], ...], group: int, number: int
) -> None:
    chip.spi_bus[letter.upper()].attach(chip.pins[61], Echo())
    chip.pins[61].drive("test", 0)
    write(chip, "CpuSysRegs", "PCLKCR8", 1 << "abc".index(letter))
    for pin, function in pins:
        mux(chip, pin, function)
    block = f"Spi{letter}Regs"
    # Master, talk, interrupt; 8 bits, out of reset.
    for register, word in (("SPICTL", 7), ("SPIBRR", 49), ("SPICCR", 0x87), ("SPITXBUF", 0x3C00)):
        write(chip, block, register, word)
    chip.clock.advance_to(chip.clock.now + 10_000)
    assert chip.register(block, "SPIRXBUF").read() & 0xFF == 0xC3
    assert chip.register("PieCtrlRegs", f"PIEIFR{group}").read() == 1 << number - 1
    assert not list(chip.findings)


@pytest.mark.parametrize(
    ("letter", "pins", "select"),
    [("a", ((16, 1), (17, 1), (18, 1)), (19, 1)), ("b", ((63, 15), (64, 15), (65, 15)), (66, 15))],
)
def test_a_module_selects_its_device_by_spiste(
    chip: Chip, letter: str, pins: tuple[tuple[int, int], ...], select: tuple[int, int]
) -> None:
    pin = chip.pins[select[0]]
    levels: list[int] = []
    for place in (*pins, select):
        mux(chip, *place)
    assert pin.level == 1
    chip.spi_bus[letter.upper()].attach(pin, Echo())
    pin.changed.connect(levels.append)
    write(chip, "CpuSysRegs", "PCLKCR8", 1 << "abc".index(letter))
    block = f"Spi{letter}Regs"
    for register, word in (("SPICTL", 6), ("SPIBRR", 49), ("SPICCR", 0x87), ("SPITXBUF", 0x3C00)):
        write(chip, block, register, word)
    assert pin.level == 0
    # The next word waits in the buffer: both go in one piece.
    write(chip, block, "SPITXBUF", 0x5500)
    chip.clock.advance_to(chip.clock.now + 100_000)
    assert levels == [0, 1]
    assert chip.register(block, "SPIRXBUF").read() & 0xFF == 0xAA
    assert [f.rule for f in chip.findings] == ["data-lost"]  # nobody read the first answer
    # Given back to GPIO, the pin is nobody's.
    mux(chip, select[0], 0)
    assert not pin.driven()


@pytest.mark.parametrize(("tx", "rx"), [((47, 6), (46, 6)), ((104, 6), (105, 6))])
def test_sci_d_sends_and_receives_and_has_its_own_interrupts(
    chip: Chip, tx: tuple[int, int], rx: tuple[int, int]
) -> None:
    mux(chip, *tx)
    mux(chip, *rx)
    sent: list[SerialFrame] = []
    chip.serial_pins[tx[0]].sent.connect(sent.append)
    write(chip, "CpuSysRegs", "PCLKCR7", 1 << 3)
    # 8 bits; 50 MHz / (8 * 651) is 9,600 baud; receiver, transmitter and their interrupts on.
    for register, word in (("SCICCR", 7), ("SCIHBAUD", 2), ("SCILBAUD", 0x8A), ("SCICTL1", 0x23), ("SCICTL2", 3)):
        write(chip, "ScidRegs", register, word)
    write(chip, "ScidRegs", "SCITXBUF", 0x41)
    chip.serial_pins[rx[0]].send(SerialFrame(0x5A, 0, 208_320, 20_832.0))
    chip.clock.advance_to(chip.clock.now + 1_000_000)
    assert [frame.data for frame in sent] == [0x41]
    assert chip.register("ScidRegs", "SCIRXBUF").read() & 0xFF == 0x5A
    # INT8.7 and INT8.8 (HDR pievect.h).
    assert chip.register("PieCtrlRegs", "PIEIFR8").read() == 0b1100_0000


@pytest.mark.parametrize(
    ("module", "pin", "function"), [(9, 16, 5), (12, 23, 5), (1, 145, 1), (10, 164, 1)]
)  # fmt: skip
def test_an_epwm_reaches_every_pin_of_the_pin_map(chip: Chip, module: int, pin: int, function: int) -> None:
    write(chip, "CpuSysRegs", "PCLKCR2", 1 << module - 1)
    write(chip, "CpuSysRegs", "PCLKCR0", 1 << 18)
    output = "B" if module in (12, 10) else "A"
    compare, actions = {"A": ("CMPA", 0x12), "B": ("CMPB", 0x102)}[output]
    for register, word in (
        ("TBCTL", 3), ("TBPRD", 4999), (compare, 1250 << 16), (f"AQCTL{output}", actions), ("TBCTL", 0),
    ):  # fmt: skip
        write(chip, f"EPwm{module}Regs", register, word)
    mux(chip, pin, function)
    chip.clock.advance_to(100_000)
    assert chip.pwm_outputs[f"GPIO{pin}"].duty == 0.25


@pytest.mark.parametrize("pair", [(10, 11), (20, 21), (50, 51), (96, 97)])
def test_an_eqep_asks_the_encoder_on_its_pins_to_move_up_to_now(chip: Chip, pair: tuple[int, int]) -> None:
    # EQEP1A and B: function 5 of GPIO10, 11 and 96, 97; 1 of GPIO20, 21 and 50, 51 (HDR pin_map.h).
    for pin in pair:
        mux(chip, pin, 5 if pair[0] in (10, 96) else 1)
    write(chip, "CpuSysRegs", "PCLKCR4", 1)
    write(chip, "EQep1Regs", "QPOSMAX", 0xFFFFFFFF)
    write(chip, "EQep1Regs", "QEPCTL", 1 << 3)
    shaft = chip.encoder_pins[pair]
    shaft.looked_at.connect(lambda: shaft.move(3, chip.clock.now, chip.clock.now))
    assert chip.register("EQep1Regs", "QPOSCNT").read() == 3


def test_an_eqep_with_both_phases_on_pins_of_different_pairs_is_configured(chip: Chip) -> None:
    mux(chip, 10, 5)
    mux(chip, 21, 1)
    assert (chip.eqep[1].quadrature.missing_a, chip.eqep[1].quadrature.missing_b) == ("", "")


@pytest.mark.parametrize(("wrong", "right"), [(0, 1), (5, 1)])
def test_an_eqep_without_a_phase_names_the_pin_beside_the_other_phase(chip: Chip, wrong: int, right: int) -> None:
    """GPIO20 carries A, so GPIO21 is meant for B (function 1; 5 is EPWM11B), not GPIO11, which may be an output."""
    mux(chip, 20, 1)
    mux(chip, 21, wrong)
    quadrature = chip.eqep[1].quadrature
    assert quadrature.missing_b == f"GPIO21 has function {wrong}, where EQEP1B is function {right}"
    mux(chip, 21, right)
    mux(chip, 20, 0)
    assert quadrature.missing_a == f"GPIO20 has function 0, where EQEP1A is function {right}"


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


@pytest.mark.parametrize("wired", [None, {"A": (58, 59, 60)}])
def test_spi_words_go_to_whatever_pins_are_muxed_to_them_and_to_the_bus_on_its_own(
    wired: dict[str, tuple[int, int, int]] | None,
) -> None:
    chip = Chip(rng=Random(0), spi_pins=wired)
    bus = chip.spi_bus["A"]
    assert bus.missing == "GPIO60 has function 0, where CLK of SPI-A is function 15"
    assert bus.no_simo == "GPIO58 has function 0, where SIMO of SPI-A is function 15"
    # GPAMUX2 holds two bits for each of GPIO16 to 31: 1 for GPIO16 and 18 is 0b010001 (HDR pin_map).
    write(chip, "GpioCtrlRegs", "GPAMUX2", 0x11)
    assert (bus.missing, bus.connected, bus.simo) == ("", wired is None, wired is None)
    # The pin between them, not GPIO59: the other lines are there (DS, signal multiplexing: GPIO16 to 19).
    assert bus.no_somi == "GPIO17 has function 0, where SOMI of SPI-A is function 1"
    write(chip, "GpioCtrlRegs", "GPAMUX2", 0x15)
    assert (bus.no_somi, bus.somi) == ("", wired is None)
    # GPBGMUX2 and GPBMUX2, likewise of GPIO48 to 63: 15 is 3 in each, for GPIO58, 59, 60 from bit 20 on.
    for register in ("GPBGMUX2", "GPBMUX2"):
        write(chip, "GpioCtrlRegs", register, 0x3F << 20)
    assert (bus.missing, bus.connected) == ("", True)


def test_sci_a_has_gpio29_and_gpio28_too(chip: Chip) -> None:
    # GPIO29 and 28 with function 1 (HDR pin_map): bits 26 and 24 of GPAMUX2.
    write(chip, "GpioCtrlRegs", "GPAMUX2", 1 << 26 | 1 << 24)
    sent: list[SerialFrame] = []
    chip.serial_pins[29].sent.connect(sent.append)
    write(chip, "CpuSysRegs", "PCLKCR7", 1)
    # 8 bits, TXENA and SWRESET, then the baud rate, then a character.
    for register, word in (("SCICCR", 7), ("SCILBAUD", 40), ("SCICTL1", 0x22), ("SCITXBUF", 0x41)):
        write(chip, "SciaRegs", register, word)
    chip.clock.advance_to(chip.clock.now + 1_000_000)
    assert [frame.data for frame in sent] == [0x41]
    assert not list(chip.findings)


class Scale:
    """A target at 0x20 that acknowledges and reads its own number."""

    def __init__(self, number: int) -> None:
        self.number = number
        self.seen: list[int] = []

    def start(self) -> None:
        pass

    def addressed(self, reading: bool) -> bool:
        return True

    def write(self, byte: int) -> bool:
        self.seen.append(byte)
        return True

    def read(self) -> int:
        return self.number

    def stop(self) -> None:
        pass


#: Module, pins (SDA, SCL), their function, numbers of the basic and of the FIFO interrupt in group 8 (HDR pin_map,
#: pievect).
I2C = [
    ("A", (32, 33), 1, (1, 2)), ("A", (0, 1), 6, (1, 2)), ("A", (91, 92), 6, (1, 2)), ("A", (104, 105), 1, (1, 2)),
    ("A", (42, 43), 6, (1, 2)), ("B", (2, 3), 6, (3, 4)), ("B", (34, 35), 6, (3, 4)), ("B", (40, 41), 6, (3, 4)),
    ("B", (66, 69), 6, (3, 4)),
]  # fmt: skip


def start_i2c(chip: Chip, letter: str) -> str:
    """Clock on, 10 MHz, 400 kHz, one byte of FIFO mode for 0x20; the block's name."""
    block = f"I2c{letter.lower()}Regs"
    write(chip, "CpuSysRegs", "PCLKCR9", 0b11)
    for register, word in (
        ("I2CPSC", 19), ("I2CCLKL", 10), ("I2CCLKH", 5), ("I2CSAR", 0x20), ("I2CCNT", 1), ("I2CIER", 0x20),
        ("I2CMDR", 0x20), ("I2CFFTX", 0x6000),
    ):  # fmt: skip
        write(chip, block, register, word)
    return block


@pytest.mark.parametrize(("letter", "pins", "function", "lines"), I2C)
def test_an_i2c_reaches_its_bus_through_its_pins_and_interrupts_through_group_8(
    chip: Chip, letter: str, pins: tuple[int, int], function: int, lines: tuple[int, int]
) -> None:
    target = Scale(7)
    chip.i2c_bus[letter].attach(0x20, target)
    block = start_i2c(chip, letter)
    mux(chip, pins[0], function)
    assert not chip.i2c_bus[letter].connected
    mux(chip, pins[1], function)
    write(chip, block, "I2CDXR", 0x5A)
    # STT, STP, MST, TRX, IRS
    write(chip, block, "I2CMDR", 0x2E20)
    chip.clock.advance_to(chip.clock.now + 100_000)
    assert target.seen == [0x5A]
    ifr = chip.register("PieCtrlRegs", "PIEIFR8")
    # SCD is enabled; the level interrupts of the FIFO are not.
    assert ifr.value == 1 << lines[0] - 1
    # TXFFIENA with TXFFIL = 0, and the FIFO is empty.
    write(chip, block, "I2CFFTX", 0x6000 | 1 << 5)
    assert ifr.value == 1 << lines[0] - 1 | 1 << lines[1] - 1
    assert not list(chip.findings)


def test_a_board_can_have_its_i2c_on_certain_pins() -> None:
    chip = Chip(rng=Random(0), i2c_pins={"A": (91, 92)})
    bus = chip.i2c_bus["A"]
    assert bus.missing == "GPIO0 has function 0, where I2C-A is function 6"
    # Its resistors pull both lines up.
    assert (chip.pins[91].level, chip.pins[92].level, chip.pins[32].level) == (1, 1, 0)
    for pin in (32, 33):
        mux(chip, pin, 1)
    assert (bus.missing, bus.connected) == ("", False)
    for pin in (91, 92):
        mux(chip, pin, 6)
    assert (bus.missing, bus.connected) == ("", True)


@pytest.mark.parametrize("letter", ["A", "B"])
def test_clock_and_soft_reset_of_an_i2c(chip: Chip, letter: str) -> None:
    write(chip, f"I2c{letter.lower()}Regs", "I2CPSC", 19)
    assert [f.rule for f in chip.findings] == ["clock-gated"]
    block = start_i2c(chip, letter)
    # SOFTPRES9: I2C-A is bit 0, I2C-B bit 1.
    write(chip, "DevCfgRegs", "SOFTPRES9", 1 << "AB".index(letter))
    assert all(register.value == register.reset_value for register in chip.blocks[block])


def test_both_i2c_stand_where_the_memory_map_has_them(chip: Chip) -> None:
    # 0x7300 and 0x7340; I2CMDR is word 9, I2CFFRX word 0x21 (HDR).
    assert chip.register("I2caRegs", "I2CMDR").address == 0x7309
    assert chip.register("I2cbRegs", "I2CFFRX").address == 0x7361
