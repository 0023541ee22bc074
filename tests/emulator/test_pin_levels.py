"""Levels of pins as edges of an encoder: the decoder of an eQEP against the table of its manual."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.chip import Chip
from emulator.registers.core import ALL

#: (A, B) before and after -> counts (TRM, quadrature decoder state machine): A leads B going forward.
FORWARD = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]
TABLE = {(FORWARD[i], FORWARD[i + 1]): 1 for i in range(4)} | {(FORWARD[i + 1], FORWARD[i]): -1 for i in range(4)}
PHE = 1 << 2


def write(chip: Chip, path: str, word: int) -> None:
    chip.cpu.eallow = True
    chip.register(*path.split(".")).write(word, ALL)


def read(chip: Chip, path: str) -> int:
    return chip.register(*path.split(".")).read()


def decoder(a: int = 0, b: int = 0, qdecctl: int = 0) -> Chip:
    """EQEP1 on GPIO20 (A) and GPIO21 (B), which have these levels from the beginning."""
    chip = Chip(rng=Random(0))
    chip.pins[20].drive("encoder", a)
    chip.pins[21].drive("encoder", b)
    write(chip, "GpioCtrlRegs.GPAMUX2", 1 << 8 | 1 << 10)
    write(chip, "CpuSysRegs.PCLKCR4", 1)
    write(chip, "EQep1Regs.QPOSMAX", 0xFFFFFFFF)
    write(chip, "EQep1Regs.QDECCTL", qdecctl)
    write(chip, "EQep1Regs.QEPCTL", 1 << 3)
    return chip


levels = st.tuples(st.integers(0, 1), st.integers(0, 1))


@given(start=levels, path=st.lists(st.tuples(st.integers(1, 500), levels), max_size=30))
def test_every_way_through_the_state_machine(start: tuple[int, int], path: list[tuple[int, tuple[int, int]]]) -> None:
    chip = decoder(*start)
    before, count, errors = start, 0, 0
    for wait, now in path:
        chip.clock.advance_to(chip.clock.now + wait)
        for pin, level in zip((20, 21), now, strict=True):
            chip.pins[pin].drive("encoder", level)
        chip.clock.charge(1)
        count += TABLE.get((before, now), 0)
        errors |= PHE * (before[0] != now[0] and before[1] != now[1])
        before = now
    assert read(chip, "EQep1Regs.QPOSCNT") == count & 0xFFFFFFFF
    assert read(chip, "EQep1Regs.QFLG") & PHE == errors


@given(start=levels, path=st.lists(levels, max_size=30), xcr=st.booleans(), source=st.integers(1, 3))
def test_direction_count_and_up_and_down_count_by_single_edges(
    start: tuple[int, int], path: list[tuple[int, int]], xcr: bool, source: int
) -> None:
    """QSRC 1 to 3: the clock is A, its rising edges with XCR; the direction is B, up, down."""
    chip = decoder(*start, qdecctl=source << 14 | xcr << 11)
    a, b = start
    count = 0
    for new_a, new_b in path:
        # One line at a time, B first: which of two edges in one cycle comes first is nobody's knowledge.
        for pin, level in ((21, new_b), (20, new_a)):
            chip.pins[pin].drive("encoder", level)
            chip.clock.charge(1)
        b = new_b
        if new_a != a and (new_a or not xcr):
            count += 1 if source == 2 or (source == 1 and b) else -1
        a = new_a
    assert read(chip, "EQep1Regs.QPOSCNT") == count & 0xFFFFFFFF


def test_a_pin_of_another_function_moves_nothing_and_a_missing_line_is_low() -> None:
    chip = decoder()
    write(chip, "GpioCtrlRegs.GPAMUX2", 1 << 8)  # B is GPIO again
    for level in (1, 0, 1):
        chip.pins[20].drive("encoder", level)
        chip.clock.charge(10)
    assert read(chip, "EQep1Regs.QPOSCNT") == 1
    write(chip, "GpioCtrlRegs.GPAMUX2", 0)
    chip.pins[20].drive("encoder", 0)
    chip.clock.charge(10)
    assert read(chip, "EQep1Regs.QPOSCNT") == 1


def test_inversion_and_qualification_lie_before_the_decoder() -> None:
    # QSEL 2 of GPIO20 with QUALPRD2 = 50: six samples 100 cycles apart; a short pulse is not seen.
    chip = decoder()
    write(chip, "GpioCtrlRegs.GPACTRL", 50 << 16)
    write(chip, "GpioCtrlRegs.GPAQSEL2", 2 << 8)
    for length, count in ((400, 0), (900, 1)):
        chip.pins[20].drive("encoder", 1)
        chip.clock.advance_to(chip.clock.now + length)
        assert read(chip, "EQep1Regs.QPOSCNT") == count
        chip.pins[20].drive("encoder", 0)
        chip.clock.advance_to(chip.clock.now + 2_000)
    write(chip, "GpioCtrlRegs.GPAINV", 1 << 21)  # B is high now: (0, 0) -> (0, 1) is one back
    chip.clock.charge(1)
    assert read(chip, "EQep1Regs.QPOSCNT") == 0xFFFFFFFF


def test_an_encoder_of_the_board_and_levels_do_not_disturb_each_other() -> None:
    chip = decoder()
    shaft = chip.encoder_pins[20, 21]
    shaft.move(6, 0, 0)
    assert read(chip, "EQep1Regs.QPOSCNT") == 6
    chip.pins[20].drive("encoder", 1)
    chip.clock.charge(1)
    assert read(chip, "EQep1Regs.QPOSCNT") == 7
    shaft.move(-7, 0, 0)
    assert read(chip, "EQep1Regs.QPOSCNT") == 0


@pytest.mark.parametrize(("index", "strobe"), [(23, 22), (53, 52)])
def test_index_and_strobe_come_by_their_pins(index: int, strobe: int) -> None:
    # IEL = 1 latches QPOSILAT at the rising index, SEL = 0 QPOSSLAT at the rising strobe; PCRM = 1 resets at QPOSMAX.
    chip = decoder()
    bank, mux = ("GPAMUX2", 1 << 2 * (index - 16) | 1 << 2 * (strobe - 16)) if index < 32 else (
        "GPBMUX2", 1 << 2 * (index - 48) | 1 << 2 * (strobe - 48)
    )  # fmt: skip
    write(chip, f"GpioCtrlRegs.{bank}", mux | read(chip, f"GpioCtrlRegs.{bank}"))
    write(chip, "EQep1Regs.QEPCTL", 1 << 12 | 1 << 4 | 1 << 3)
    chip.encoder_pins[20, 21].move(5, 0, 0)
    for pin, latch in ((index, "QPOSILAT"), (strobe, "QPOSSLAT")):
        chip.pins[pin].drive("encoder", 1)
        assert read(chip, f"EQep1Regs.{latch}") == 5
    chip.encoder_pins[20, 21].move(1, 0, 0)
    for pin, latch in ((index, "QPOSILAT"), (strobe, "QPOSSLAT")):
        chip.pins[pin].drive("encoder", 0)
        assert read(chip, f"EQep1Regs.{latch}") == 5
    write(chip, f"GpioCtrlRegs.{bank}", 0)
    chip.pins[index].drive("encoder", 1)
    assert read(chip, "EQep1Regs.QPOSILAT") == 5


@pytest.mark.parametrize("word", [0, 1])
def test_the_error_of_an_eqep_ends_with_its_flag_or_the_module(word: int) -> None:
    chip = decoder()
    write(chip, "CpuSysRegs.PCLKCR2", 1)
    write(chip, "EPwm1Regs.TZSEL", 1 << 3)  # CBC4
    chip.eqep[1].phase_error()
    assert read(chip, "EPwm1Regs.TZCBCFLG") == 1 << 3
    if word:
        write(chip, "EQep1Regs.QCLR", PHE)
    else:
        write(chip, "EQep1Regs.QEPCTL", 0)
    write(chip, "EPwm1Regs.TZCBCCLR", 1 << 3)
    assert read(chip, "EPwm1Regs.TZCBCFLG") == 0
