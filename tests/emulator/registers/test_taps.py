"""Taps are told of every access of the CPU, whole and once, before it happens, whatever the register does meanwhile."""

from __future__ import annotations

from typing import Any

from emulator.registers.cell import Cell
from emulator.registers.core import ALL
from emulator.registers.fields import HIGH
from emulator.system import System

Access = tuple[str, int, int, int]


class Log(list[Access]):
    """Accesses as they are told: kind, word, mask, and what is stored at that moment."""

    def told(self, register: Cell, access: str, word: int, mask: int) -> None:
        self.append((access, word, mask, register.value))


def tapped(board: System, block: str, name: str, *, reads: bool = False) -> tuple[Cell, Log]:
    register, log = board.register(block, name), Log()
    register.tap(log.told, reads=reads)
    return register, log


def test_a_write_is_told_before_it_is_stored() -> None:
    register, log = tapped(System(), "CpuTimer0Regs", "PRD")
    register.value = 7
    register.write(9, ALL)
    assert log == [("write", 9, ALL, 7)]
    assert register.value == 9


def test_a_field_assignment_is_one_write_of_the_whole_word_that_names_the_field() -> None:
    board = System()
    board.cpu.eallow = True
    board.register("CpuSysRegs", "PCLKCR2").bit.EPWM2 = 1
    _, log = tapped(board, "EPwm2Regs", "CMPA", reads=True)
    register = board.register("EPwm2Regs", "CMPA")
    register.value = 0x00010200
    register.bit.CMPA = 5000
    # CMPA stands in the high half, CMPAHR in the low one is written back.
    assert log == [("write", 5000 << 16 | 0x0200, HIGH, 0x00010200)]
    assert register.value >> 16 == 5000


def test_a_field_that_reads_0_is_told_as_it_is_written() -> None:
    board = System()
    _, log = tapped(board, "GpioDataRegs", "GPACLEAR")
    board.register("GpioDataRegs", "GPACLEAR").bit.GPIO5 = 1
    assert [word for _, word, _, _ in log] == [1 << 5]


def test_where_reading_does_something_a_field_assignment_is_a_read_and_a_write() -> None:
    board = System()
    _, log = tapped(board, "GpioDataRegs", "GPADAT", reads=True)
    # No pull-up, nobody drives: pins read their level, so the word that is written back is known by reading only.
    word = board.register("GpioDataRegs", "GPADAT").read()
    log.clear()
    board.register("GpioDataRegs", "GPADAT").bit.GPIO5 = 1
    assert [(access, told) for access, told, _, _ in log] == [("read", 0), ("write", word | 1 << 5)]


def test_two_taps_of_a_register_are_both_told_and_each_goes_alone() -> None:
    register, first = tapped(System(), "CpuTimer0Regs", "PRD")
    second = Log()
    register.tap(second.told, reads=True)
    register.write(1, ALL)
    register.untap(first.told)
    register.write(2, ALL)
    register.read()
    register.untap(second.told)
    register.write(3, ALL)
    assert [word for _, word, _, _ in first] == [1]
    assert [access for access, *_ in second] == ["write", "write", "read"]


def test_a_register_that_clears_another_does_so_with_a_tap_too() -> None:
    board = System()
    board.cpu.eallow = True
    board.register("CpuSysRegs", "PCLKCR13").bit.ADC_A = 1
    flags = board.register("AdcaRegs", "ADCINTFLG")
    flags.value = 0b1011
    register, log = tapped(board, "AdcaRegs", "ADCINTFLGCLR")
    register.bit.ADCINT1 = 1
    register.write(0b1000, ALL)
    assert [word for _, word, _, _ in log] == [1, 0b1000]
    assert flags.value == 0b0010


def test_a_tap_outlives_the_clock_gate_and_hides_no_finding() -> None:
    board = System()
    register, log = tapped(board, "SpiaRegs", "SPIBRR")
    board.cpu.eallow = True
    for on in (1, 0, 1):
        board.register("CpuSysRegs", "PCLKCR8").bit.SPI_A = on
        register.write(0x10 + on, ALL)
    assert [word for _, word, _, _ in log] == [0x11, 0x10, 0x11]
    assert len(board.findings.of("clock-gated")) == 1


def test_a_register_that_was_tapped_is_bound_as_before() -> None:
    register = System().register("GpioDataRegs", "GPASET")
    before = register.read, register.write
    log = Log()
    register.tap(log.told, reads=True)
    assert (register.read, register.write) != before
    register.untap(log.told)
    assert (register.read, register.write) == before


def test_a_vector_that_is_followed_holds_its_routine() -> None:
    board = System()
    board.cpu.eallow = True

    def routine() -> None: ...

    register, log = tapped(board, "PieVectTable", "TIMER0_INT", reads=True)
    written: Any = routine
    register.write(written, ALL)  # what C does: PieVectTable.TIMER0_INT = &routine
    held: Any = register.read()
    assert held is routine
    assert [access for access, *_ in log] == ["write", "read"]
    other = board.register("PieVectTable", "TIMER1_INT")
    assert not other.read()
