"""Output X-BAR, ePWM X-BAR and X-BAR flags (TRM, X-BAR): muxes, inversion, latches, locks, pins."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.chip import Chip
from emulator.peripherals.xbar_mux import choices
from emulator.pin_functions import PIN_FUNCTIONS
from emulator.registers.core import ALL
from emulator.signals import PwmWire
from tests.emulator.peripherals.test_dma_programs import CChip

#: Mux -> the comparator that it chooses with 0: high ones at the even numbers (TRM, mux configuration tables).
COMPARATORS = {mux: (mux // 2 + 1, "L" if mux % 2 else "H") for mux in range(16)}


@pytest.fixture
def chip() -> Chip:
    return new_chip()


def new_chip() -> Chip:
    return Chip(rng=Random(0))


def write(chip: Chip, block: str, register: str, word: int) -> None:
    chip.cpu.eallow = True
    chip.register(block, register).write(word, ALL)


def signal(chip: Chip, name: str, level: int) -> None:
    """Let CMPSSn.CTRIPx or CTRIPOUTx have a level."""
    cmpss = chip.cmpss[int(name[5])]
    half = cmpss.high if name.endswith("H") else cmpss.low
    (half.trip_out if "OUT" in name else half.trip).drive("CMPSS", level)


def route(chip: Chip, output: int) -> int:
    """Give OUTPUTXBAR`output` its first pin."""
    pin, function = next(iter(PIN_FUNCTIONS[f"OUTPUTXBAR{output}"].items()))
    chip.cpu.eallow = True
    port, bit = "ABCDEF"[pin // 32], pin % 32
    half, place = 1 + bit // 16, 2 * (bit % 16)
    for kind, value in ((f"GP{port}GMUX{half}", function >> 2), (f"GP{port}MUX{half}", function & 3)):
        register = chip.register("GpioCtrlRegs", kind)
        register.write(register.read() | value << place, ALL)
    return pin


# Output X-BAR


@pytest.mark.parametrize("output", range(1, 9))
def test_an_output_is_on_its_pin_while_the_pin_is_set_to_it(chip: Chip, output: int) -> None:
    write(chip, "OutputXbarRegs", f"OUTPUT{output}MUXENABLE", 1)
    signal(chip, "CMPSS1.CTRIPOUTH", 1)
    pin = next(iter(PIN_FUNCTIONS[f"OUTPUTXBAR{output}"]))
    assert chip.pins[pin].level == 0
    assert route(chip, output) == pin
    assert chip.pins[pin].level == 1
    assert chip.signal_of(pin) == f"OUTPUTXBAR{output}"
    signal(chip, "CMPSS1.CTRIPOUTH", 0)
    assert chip.pins[pin].level == 0


@pytest.mark.parametrize("mux", COMPARATORS)
def test_each_mux_chooses_its_comparator(chip: Chip, mux: int) -> None:
    n, half = COMPARATORS[mux]
    write(chip, "OutputXbarRegs", "OUTPUT1MUXENABLE", 1 << mux)
    write(chip, "EPwmXbarRegs", "TRIP5MUXENABLE", 1 << mux)
    signal(chip, f"CMPSS{n}.CTRIPOUT{half}", 1)
    assert (chip.output_xbar.level(1), chip.epwm_xbar.trips[5].level) == (1, 0)
    signal(chip, f"CMPSS{n}.CTRIP{half}", 1)
    assert (chip.output_xbar.level(1), chip.epwm_xbar.trips[5].level) == (1, 1)


def test_choice_1_of_an_even_mux_is_either_comparator(chip: Chip) -> None:
    write(chip, "OutputXbarRegs", "OUTPUT2MUX0TO15CFG", 1 << 2 * 4)
    write(chip, "OutputXbarRegs", "OUTPUT2MUXENABLE", 1 << 4)
    for name in ("CMPSS3.CTRIPOUTH", "CMPSS3.CTRIPOUTL"):
        signal(chip, name, 1)
        assert chip.output_xbar.level(2) == 1
        signal(chip, name, 0)
        assert chip.output_xbar.level(2) == 0


@pytest.mark.parametrize("n", range(1, 7))
def test_choice_1_of_an_odd_mux_is_an_input_of_the_input_xbar(chip: Chip, n: int) -> None:
    mux = 2 * n - 1
    write(chip, "InputXbarRegs", f"INPUT{n}SELECT", 40)
    write(chip, "OutputXbarRegs", "OUTPUT1MUX0TO15CFG", 1 << 2 * mux)
    write(chip, "OutputXbarRegs", "OUTPUT1MUXENABLE", 1 << mux)
    chip.pins[40].drive("test", 1)
    chip.clock.advance_to(100)
    assert chip.output_xbar.level(1) == 1
    write(chip, "OutputXbarRegs", "OUTPUT1MUXENABLE", 0)
    assert chip.output_xbar.level(1) == 0


@given(
    high=st.sets(st.sampled_from(sorted(COMPARATORS))), enable=st.integers(0, 0xFFFF), inverted=st.booleans(),
    first=st.booleans(),
)  # fmt: skip
def test_an_output_is_the_or_of_its_enabled_muxes(high: set[int], enable: int, inverted: bool, first: bool) -> None:
    chip = new_chip()
    steps = [lambda: write(chip, "EPwmXbarRegs", "TRIP8MUXENABLE", enable)]
    for mux in high:
        n, half = COMPARATORS[mux]
        steps.append(lambda n=n, half=half: signal(chip, f"CMPSS{n}.CTRIP{half}", 1))  # type: ignore[misc]
    for step in steps if first else reversed(steps):
        step()
    write(chip, "EPwmXbarRegs", "TRIPOUTINV", int(inverted) << 3)
    expected = any(enable >> mux & 1 for mux in high)
    assert chip.epwm_xbar.trips[8].level == (expected != inverted)
    assert all(wire.level == 0 for n, wire in chip.epwm_xbar.trips.items() if n != 8)


def test_the_latch_keeps_what_has_gone(chip: Chip) -> None:
    write(chip, "OutputXbarRegs", "OUTPUT3MUXENABLE", 1)
    signal(chip, "CMPSS1.CTRIPOUTH", 1)
    signal(chip, "CMPSS1.CTRIPOUTH", 0)
    assert chip.register("OutputXbarRegs", "OUTPUTLATCH").read() == 0b100
    assert chip.output_xbar.level(3) == 0
    write(chip, "OutputXbarRegs", "OUTPUTLATCHENABLE", 0b100)
    assert chip.output_xbar.level(3) == 1
    write(chip, "OutputXbarRegs", "OUTPUTLATCHCLR", 0b100)
    assert (chip.output_xbar.level(3), chip.register("OutputXbarRegs", "OUTPUTLATCH").read()) == (0, 0)
    write(chip, "OutputXbarRegs", "OUTPUTLATCHFRC", 0b100)
    assert chip.output_xbar.level(3) == 1
    write(chip, "OutputXbarRegs", "OUTPUTINV", 0b100)
    assert chip.output_xbar.level(3) == 0


def test_a_latch_whose_signal_stands_is_set_again(chip: Chip) -> None:
    write(chip, "OutputXbarRegs", "OUTPUT3MUXENABLE", 1)
    signal(chip, "CMPSS1.CTRIPOUTH", 1)
    write(chip, "OutputXbarRegs", "OUTPUTLATCHCLR", 0b100)
    assert chip.register("OutputXbarRegs", "OUTPUTLATCH").read() == 0b100


@pytest.mark.parametrize(
    ("block", "lock", "registers"),
    [("OutputXbarRegs", "OUTPUTLOCK", ("OUTPUT1MUX0TO15CFG", "OUTPUT8MUXENABLE", "OUTPUTINV", "OUTPUTLATCHENABLE")),
     ("EPwmXbarRegs", "TRIPLOCK", ("TRIP4MUX16TO31CFG", "TRIP12MUXENABLE", "TRIPOUTINV"))],
)  # fmt: skip
def test_the_lock_wants_its_key(chip: Chip, block: str, lock: str, registers: tuple[str, ...]) -> None:
    write(chip, block, lock, 1)
    for name in registers:
        write(chip, block, name, 1)
        assert chip.register(block, name).read() == 1
    assert not [f for f in chip.findings if f.rule == "locked"]
    write(chip, block, lock, 0x5A5A0001)
    for name in registers:
        write(chip, block, name, 0)
        assert chip.register(block, name).read() == 1
    assert [f.object for f in chip.findings if f.rule == "locked"] == [f"{block}.{name}" for name in registers]
    # The key is not stored.
    assert chip.register(block, lock).read() == 1


@pytest.mark.parametrize(
    ("mux", "choice", "what"), [(0, 2, "ADCAEVT1"), (1, 2, "CLB1.OUT4"), (13, 1, "ADCSOCAO"),
                                (14, 3, "EXTSYNCOUT"), (12, 3, "no such signal"), (16, 0, "SD1FLT1.COMPH")]
)  # fmt: skip
def test_a_signal_that_is_not_modelled_is_told_once_its_mux_is_enabled(
    chip: Chip, mux: int, choice: int, what: str
) -> None:
    half, place = ("0TO15", mux) if mux < 16 else ("16TO31", mux - 16)
    write(chip, "EPwmXbarRegs", f"TRIP4MUX{half}CFG", choice << 2 * place)
    assert not list(chip.findings)
    write(chip, "EPwmXbarRegs", "TRIP4MUXENABLE", 1 << mux)
    write(chip, "EPwmXbarRegs", "TRIP4MUXENABLE", 1 << mux)
    [finding] = chip.findings
    assert (finding.rule, finding.object) == ("unmodelled", f"EPwmXbarRegs.TRIP4MUX{half}CFG.MUX{mux}")
    assert what in finding.message


def test_the_table_has_what_the_manual_has() -> None:
    # TRM, Output X-BAR mux configuration table, some rows of each kind.
    table = choices("CTRIPOUT")
    assert len(table) == 32
    assert table[6] == (("CMPSS4.CTRIPOUTH",), ("CMPSS4.CTRIPOUTH", "CMPSS4.CTRIPOUTL"), ("ADCAEVT4",), ("ECAP4.OUT",))
    assert table[9] == (("CMPSS5.CTRIPOUTL",), ("INPUT5",), ("CLB3.OUT4",), ("ADCDEVT1",))
    assert table[15] == (("CMPSS8.CTRIPOUTL",), ("ADCSOCBO",), ("CLB4.OUT5",), ("ADCDEVT4",))
    assert table[24] == (("SD2FLT1.COMPH",), ("SD2FLT1.COMPH", "SD2FLT1.COMPL"), ("",), ("",))
    assert table[31] == (("SD2FLT4.COMPL",), ("",), ("",), ("",))


# Flags


@pytest.mark.parametrize(
    ("name", "bit"), [("CMPSS1.CTRIPL", 0), ("CMPSS1.CTRIPH", 1), ("CMPSS8.CTRIPH", 15), ("CMPSS1.CTRIPOUTL", 16),
                      ("CMPSS4.CTRIPOUTH", 23)]
)  # fmt: skip
def test_a_flag_remembers_its_signal(chip: Chip, name: str, bit: int) -> None:
    flags = chip.register("XbarRegs", "XBARFLG1")
    signal(chip, name, 1)
    assert flags.read() == 1 << bit
    write(chip, "XbarRegs", "XBARCLR1", 1 << bit)
    assert flags.read() == 1 << bit, "its signal still sets it"
    signal(chip, name, 0)
    assert flags.read() == 1 << bit
    write(chip, "XbarRegs", "XBARCLR1", 1 << bit)
    assert flags.read() == 0


@pytest.mark.parametrize("asked_by", ["mux", "flag"])
def test_flags_of_inputs_are_those_that_somebody_asks_for(chip: Chip, asked_by: str) -> None:
    write(chip, "InputXbarRegs", "INPUT6SELECT", 40)
    if asked_by == "mux":
        write(chip, "EPwmXbarRegs", "TRIP4MUX0TO15CFG", 1 << 2 * 11)
        write(chip, "EPwmXbarRegs", "TRIP4MUXENABLE", 1 << 11)
    else:
        assert chip.register("XbarRegs", "XBARFLG2").read() == 0
    chip.pins[40].drive("test", 1)
    chip.clock.advance_to(100)
    chip.pins[40].drive("test", 0)
    chip.clock.advance_to(200)
    assert chip.register("XbarRegs", "XBARFLG2").read() == 1 << 5
    # HDR calls the clear of INPUT6 INPUT7.
    write(chip, "XbarRegs", "XBARCLR2", 1 << 5)
    assert chip.register("XbarRegs", "XBARFLG2").read() == 0


class Toggling:
    """A `PwmSource` that is low until cycle 5."""

    def level(self) -> int:
        return 0

    def stays_until(self) -> int:
        return 5

    def watch(self) -> None:
        """Nobody asks for its edges here."""


def test_out_of_reset_no_pin_is_followed(chip: Chip) -> None:
    # GPIO0 is all inputs then: as EPWM1A its edges would cost.
    output = PwmWire("output")
    output.follow(Toggling())
    chip.pins[0].follow("output", output)
    assert chip.pins[0].stays_until() == 5, "nobody wants its edges"


# In C


def test_a_filtered_comparator_shows_itself_on_a_pin() -> None:
    """What TI's example of the digital filter promises: the output follows after a static window, on OUTPUTXBAR3."""
    program = CChip(
        """
void setup(void)
{
    start();
    EALLOW;
    Cmpss1Regs.COMPCTL.bit.COMPDACE = 1;
    Cmpss1Regs.COMPCTL.bit.COMPHSOURCE = 0;
    Cmpss1Regs.COMPDACCTL.bit.SELREF = 0;
    Cmpss1Regs.DACHVALS.bit.DACVAL = 2048;
    Cmpss1Regs.CTRIPHFILCLKCTL.bit.CLKPRESCALE = 0x3FF;
    Cmpss1Regs.CTRIPHFILCTL.bit.SAMPWIN = 0x1F;
    Cmpss1Regs.CTRIPHFILCTL.bit.THRESH = 0x1F;
    Cmpss1Regs.CTRIPHFILCTL.bit.FILINIT = 1;
    Cmpss1Regs.COMPCTL.bit.CTRIPHSEL = 2;
    Cmpss1Regs.COMPCTL.bit.CTRIPOUTHSEL = 2;
    OutputXbarRegs.OUTPUT3MUX0TO15CFG.all &= ~((Uint32)1);
    OutputXbarRegs.OUTPUT3MUXENABLE.all |= (Uint32)1;
    EDIS;
    GPIO_SetupPinMux(14, GPIO_MUX_CPU1, 6);
}
"""
    )
    program.call("setup")
    chip, pin = program.chip, program.chip.pins[14]
    edges: list[tuple[int, int]] = []
    pin.changed.connect(lambda level: edges.append((chip.clock.now, level)))
    analog = chip.analog["A"][2]
    # Pulses of 31 samples do not pass; 32 * 1024 cycles do, and are late by the window.
    begin = chip.clock.now
    analog.follow("test", lambda cycles: 3.0 if cycles - begin < 31_000 else 0.0)
    chip.clock.advance_to(begin + 100_000)
    assert edges == []
    rise = chip.clock.now
    analog.follow("test", lambda cycles: 3.0 if cycles - rise < 60_000 else 0.0)
    chip.clock.advance_to(rise + 200_000)
    assert [level for _, level in edges] == [1, 0]
    # 31 to 32 samples later, and for the end of the pulse one look (1 us) more.
    assert 31 * 1024 < edges[0][0] - rise <= 32 * 1024
    assert 31 * 1024 < edges[1][0] - rise - 60_000 <= 32 * 1024 + 200
    assert program.found() == []


def test_an_asynchronous_comparator_shows_itself_at_once() -> None:
    program = CChip(
        """
void setup(void)
{
    start();
    EALLOW;
    Cmpss1Regs.COMPCTL.bit.COMPDACE = 1;
    Cmpss1Regs.DACHVALS.bit.DACVAL = 2048;
    OutputXbarRegs.OUTPUT3MUX0TO15CFG.bit.MUX0 = 0;
    OutputXbarRegs.OUTPUT3MUXENABLE.bit.MUX0 = 1;
    EDIS;
    GPIO_SetupPinMux(14, GPIO_MUX_CPU1, 6);
}
"""
    )
    program.call("setup")
    chip, levels = program.chip, []
    for volts in (1.6, 1.7, 1.6):
        chip.analog["A"][2].follow("test", lambda _cycles, volts=volts: volts, steady=True)  # type: ignore[misc]
        levels.append(chip.pins[14].level)
    # The threshold is 2048 of 4096 parts of 3.3 V.
    assert levels == [0, 1, 0]
    assert program.found() == []
