"""PIE flow: pulse, PIEIFR, PIEIER, PIEACK, CPU IFR, vector fetch."""

from __future__ import annotations

from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.findings import Findings
from emulator.c28x.sites import Place
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.pie import LONG_CYCLES, Pie, vector_id
from emulator.registers.pie import PieCtrlRegs


class Bench:
    """A PIE in front of a CPU that takes interrupts; handlers note their vector and do not acknowledge."""

    def __init__(self) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.regs = PieCtrlRegs("PieCtrlRegs", 0x0CE0, self.cpu)
        self.pie = Pie(self.clock, self.cpu, self.regs)
        self.taken: list[int] = []
        for vector in [*range(0x20, 0xE0), 13, 14]:
            self.pie.set_vector(vector, lambda vector=vector: self.taken.append(vector))
        self.regs.PIECTRL.bit.ENPIE = 1
        self.cpu.write_ier(0xFFFF)
        self.cpu.enable_interrupts()

    def enable(self, group: int, mask: int = 0xFFFF) -> None:
        self.regs.registers[f"PIEIER{group}"].write(mask)

    def run(self) -> list[int]:
        """Let the CPU look; what was taken since the last call."""
        self.clock.charge(1)
        taken, self.taken = self.taken, []
        return taken


@pytest.mark.parametrize(
    ("group", "n", "vector"),
    # HDR hw_ints.h: ADCA1, CPU timer 0, ePWM2, SCIA RX, SCIC RX, ADCA2; 1.9 opens the second half of the table.
    [(1, 1, 0x20), (1, 7, 0x26), (3, 2, 0x31), (9, 1, 0x60), (8, 5, 0x5C), (10, 2, 0x69), (1, 9, 0x80), (12, 16, 0xDF)],
)
def test_vector_ids_are_those_of_the_header(group: int, n: int, vector: int) -> None:
    assert vector_id(group, n) == vector
    bench = Bench()
    bench.enable(group)
    bench.pie.line(group, n)()
    assert bench.run() == [vector]
    # PIEVECT is the address 0x0D00 + 2*id, whose bit 0 is ENPIE's place.
    assert bench.regs.PIECTRL.all == 0x0D00 + 2 * vector | 1


def test_a_pulse_latches_even_when_it_is_not_enabled() -> None:
    bench = Bench()
    bench.pie.line(6, 1)()
    assert bench.run() == []
    assert bench.regs.PIEIFR6.bit.INTx1 == 1
    bench.regs.PIEIER6.bit.INTx1 = 1
    assert bench.run() == [0x48]
    assert bench.regs.PIEIFR6.all == 0


def test_a_group_waits_for_its_acknowledge_and_others_do_not() -> None:
    bench = Bench()
    bench.enable(9)
    bench.enable(6)
    bench.pie.line(9, 1)()
    assert bench.run() == [0x60]
    assert bench.regs.PIEACK.all == 1 << 8
    bench.pie.line(9, 2)()
    bench.pie.line(6, 1)()
    assert bench.run() == [0x48]
    assert bench.regs.PIEIFR9.all == 0b10, "latched, held back"
    bench.regs.PIEACK.all = 1 << 8
    assert bench.run() == [0x61]


def test_acknowledging_by_read_modify_write_acknowledges_every_group() -> None:
    bench = Bench()
    for group in (1, 9):
        bench.enable(group)
        bench.pie.line(group, 1)()
    bench.run()
    assert bench.regs.PIEACK.all == 1 | 1 << 8
    bench.regs.PIEACK.bit.ACK1 = 1
    assert bench.regs.PIEACK.all == 0


def test_the_lowest_line_of_a_group_and_the_lowest_group_go_first() -> None:
    bench = Bench()
    bench.cpu.disable_interrupts()
    for group, n in ((3, 2), (1, 7), (1, 4)):
        bench.enable(group)
        bench.pie.line(group, n)()
    bench.cpu.enable_interrupts()
    assert bench.run() == [vector_id(1, 4), vector_id(3, 2)]


def test_nothing_comes_through_a_disabled_PIE_until_it_is_enabled() -> None:
    bench = Bench()
    bench.regs.PIECTRL.bit.ENPIE = 0
    bench.enable(1)
    bench.pie.line(1, 1)()
    assert bench.run() == []
    assert (bench.regs.PIEACK.all, bench.cpu.ifr) == (0, 0)
    bench.regs.PIECTRL.bit.ENPIE = 1
    assert bench.run() == [0x20]


def test_a_request_that_vanished_before_its_fetch_takes_the_first_vector() -> None:
    bench = Bench()
    bench.enable(5)
    bench.cpu.disable_interrupts()
    bench.pie.line(5, 3)()
    bench.regs.PIEIFR5.all = 0
    bench.cpu.enable_interrupts()
    assert bench.run() == [vector_id(5, 1)]


def test_writing_a_flag_raises_its_interrupt() -> None:
    bench = Bench()
    bench.enable(2)
    bench.regs.PIEIFR2.bit.INTx4 = 1
    assert bench.run() == [vector_id(2, 4)]


@pytest.mark.parametrize("line", [13, 14])
def test_the_timer_lines_bypass_the_groups(line: int) -> None:
    bench = Bench()
    bench.regs.PIECTRL.bit.ENPIE = 0
    bench.cpu.raise_line(line)
    assert bench.run() == [line]


@pytest.mark.parametrize(("line", "address"), [(13, 0x0D1A), (14, 0x0D1C)])
def test_PIEVECT_names_the_entry_of_a_timer_line_too(line: int, address: int) -> None:
    # HDR F2837xS_pievect.h: TIMER1_INT and TIMER2_INT are entries 13 and 14 of 32 bits from 0x0D00 on: 0x0D00 + 2 * 13
    # and 0x0D00 + 2 * 14.  Bit 0 is ENPIE's place.
    bench = Bench()
    bench.enable(1)
    bench.pie.line(1, 7)()
    assert bench.run() == [0x26]
    bench.cpu.raise_line(line)
    assert bench.run() == [line]
    assert bench.regs.PIECTRL.all == address | 1


@pytest.mark.parametrize("line", [13, 14])
def test_PIEVECT_stays_where_the_table_is_not_asked(line: int) -> None:
    bench = Bench()
    bench.regs.PIECTRL.bit.ENPIE = 0
    bench.cpu.raise_line(line)
    bench.run()
    assert bench.regs.PIECTRL.all == 0


def test_an_interrupt_without_handler_is_a_finding() -> None:
    bench = Bench()
    bench.enable(1)
    bench.pie.set_vector(0x20, None)
    bench.pie.line(1, 1)()
    assert bench.run() == []
    assert [f.rule for f in bench.findings] == ["interrupt-without-handler"]
    assert "nothing was written" in next(iter(bench.findings)).message


def test_a_reserved_interrupt_is_said_to_be_one() -> None:
    bench = Bench()
    bench.enable(4, 1 << 6)
    bench.pie.set_vector(vector_id(4, 7), None)
    bench.regs.PIEIFR4.all = 1 << 6
    assert bench.run() == []
    assert "interrupt 4.7 (vector id 0x3e) was taken but has no handler: the line is reserved" in (
        next(iter(bench.findings)).message
    )


@given(st.lists(st.tuples(st.integers(1, 12), st.integers(1, 16)), max_size=30))
def test_every_enabled_pulse_is_taken_once_when_handlers_acknowledge(pulses: list[tuple[int, int]]) -> None:
    bench = Bench()
    for group in range(1, 13):
        bench.enable(group)
    bench.cpu.disable_interrupts()
    for group, n in pulses:
        bench.pie.line(group, n)()
    bench.cpu.enable_interrupts()
    taken: list[int] = []
    while new := bench.run():
        taken += new
        bench.regs.PIEACK.all = 0x0FFF
    assert sorted(taken) == sorted({vector_id(*pulse) for pulse in pulses})


def test_lines_and_vectors_outside_the_table_are_refused() -> None:
    bench = Bench()
    with pytest.raises(ValueError, match="expected group 1"):
        bench.pie.line(13, 1)
    with pytest.raises(ValueError, match="PIE vector 0xc"):
        bench.pie.set_vector(0x0C, None)


@pytest.mark.parametrize("acknowledges", [True, False])
def test_an_interrupt_that_no_acknowledge_lets_through_is_reported(acknowledges: bool) -> None:
    bench = Bench()
    bench.regs.PIEIER3.all = 1
    line = bench.pie.line(3, 1)
    for _ in range(3):
        line()
        bench.clock.charge(10)
        if acknowledges:
            bench.regs.PIEACK.all = 1 << 2
    # The first is taken, the second waits for its acknowledge, the third comes while it waits.
    reported = bench.findings.of("flag-not-cleared")
    assert [finding.object for finding in reported] == ([] if acknowledges else ["PieCtrlRegs.PIEACK.ACK3"])
    assert len(bench.taken) == (3 if acknowledges else 1)


#: Where a routine of the firmware stands.
ROUTINE = Place("drv.c", 7, "Tick", "drv.c", 18)


def routine(acknowledges: bool = False) -> Bench:
    """Interrupt 3.1 has a routine of the firmware."""
    bench = Bench()
    bench.enable(3, 1)
    end = (lambda: setattr(bench.regs.PIEACK, "all", 1 << 2)) if acknowledges else (lambda: None)
    bench.pie.set_vector(vector_id(3, 1), end, ROUTINE)
    return bench


def test_an_interrupt_that_waits_for_its_acknowledge_for_long_is_told_at_the_routine() -> None:
    # Many sources give no further pulse while their flag stands: one that waits is all that there is to see.
    bench = routine()
    line = bench.pie.line(3, 1)
    line()
    bench.clock.charge(100)
    line()
    bench.clock.charge(LONG_CYCLES - 1)
    assert not bench.findings.of("flag-not-cleared")
    bench.clock.charge(1)
    (told,) = bench.findings.of("flag-not-cleared")
    assert (told.place, told.task, told.object) == (ROUTINE, "Isr:Tick", "PieCtrlRegs.PIEACK.ACK3")


def test_an_acknowledge_that_comes_later_is_one() -> None:
    # The main loop acknowledges, 1 cycle before the interrupt has waited for too long.
    bench = routine()
    line = bench.pie.line(3, 1)
    line()
    bench.clock.charge(100)
    line()
    bench.clock.charge(LONG_CYCLES - 1)
    bench.regs.PIEACK.all = 1 << 2
    bench.clock.charge(2 * LONG_CYCLES)
    assert not bench.findings.of("flag-not-cleared")


def test_what_nobody_handles_is_not_told_to_acknowledge() -> None:
    bench = routine()
    bench.pie.set_vector(vector_id(3, 1), None)
    line = bench.pie.line(3, 1)
    for _ in range(3):
        line()
        bench.clock.charge(LONG_CYCLES)
    assert [finding.rule for finding in bench.findings] == ["interrupt-without-handler"]
    assert "interrupt 3.1 (vector id 0x30)" in next(iter(bench.findings)).message


def test_a_flag_that_the_routine_has_left_for_long_is_told_there() -> None:
    bench = routine(acknowledges=True)
    line = bench.pie.line(3, 1)
    ask = partial(bench.pie.flag_left, 3, 1, "EPwm1Regs.ETFLG.INT")
    ask()  # no interrupt yet
    line()
    bench.clock.charge(100)
    ask()  # not for long
    bench.clock.charge(LONG_CYCLES)
    line()
    ask()  # the routine is about to run again
    assert not bench.findings.of("flag-not-cleared")
    bench.clock.charge(100)
    bench.clock.charge(LONG_CYCLES)
    ask()
    assert [(f.place, f.object) for f in bench.findings] == [(ROUTINE, "EPwm1Regs.ETFLG.INT")]


@pytest.mark.parametrize("runs_again", [False, True])
def test_a_flag_at_the_end_of_the_run_is_told_unless_the_routine_has_run_since(runs_again: bool) -> None:
    bench = routine(acknowledges=True)
    line = bench.pie.line(3, 1)
    line()
    bench.clock.charge(100)
    bench.pie.flag_left(3, 1, "EPwm1Regs.ETFLG.INT")
    if runs_again:
        line()
    bench.clock.charge(LONG_CYCLES)
    bench.pie.finish()
    assert [f.place for f in bench.findings.of("flag-not-cleared")] == ([] if runs_again else [ROUTINE])
