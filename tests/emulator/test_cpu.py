"""The interrupt sequence of the core and EALLOW's part in it (SPRU430; TRM EALLOW)."""

from __future__ import annotations

import pytest

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import INTERRUPT_ENTRY_CYCLES, INTERRUPT_EXIT_CYCLES, Cpu


@pytest.fixture
def cpu() -> Cpu:
    clock = Clock()
    return Cpu(clock, Findings(clock))


def test_an_interrupt_waits_for_intm_and_ier_and_clears_its_flag(cpu: Cpu) -> None:
    seen: list[int] = []
    cpu.connect(14, lambda: seen.append(cpu.clock.now))
    cpu.raise_line(14)
    cpu.clock.charge(1)
    assert seen == []
    cpu.write_ier(1 << 13)
    cpu.clock.charge(1)
    assert seen == []
    cpu.enable_interrupts()
    cpu.clock.charge(1)
    assert seen == [3 + INTERRUPT_ENTRY_CYCLES]
    assert cpu.ifr == 0
    assert cpu.clock.now == 3 + INTERRUPT_ENTRY_CYCLES + INTERRUPT_EXIT_CYCLES


def test_eallow_is_cleared_on_entry_and_restored_on_return(cpu: Cpu) -> None:
    inside: list[bool] = []
    cpu.connect(1, lambda: inside.append(cpu.eallow))
    cpu.write_ier(1)
    cpu.enable_interrupts()
    cpu.eallow = True
    cpu.raise_line(1)
    cpu.clock.charge(1)
    assert inside == [False]
    assert cpu.eallow


def test_the_statement_that_cleared_eallow_is_known_and_a_routine_has_its_own(cpu: Cpu) -> None:
    inside: list[int] = []

    def routine() -> None:
        inside.append(cpu.edis_at)
        cpu.edis(7)

    cpu.connect(1, routine)
    cpu.write_ier(1)
    cpu.enable_interrupts()
    cpu.position.at = 5
    cpu.edis()
    cpu.raise_line(1)
    cpu.clock.charge(1)
    assert inside == [0]
    assert cpu.edis_at == 5


def test_the_lowest_line_goes_first_and_handlers_do_not_nest_while_intm_is_set(cpu: Cpu) -> None:
    order: list[str] = []

    def first() -> None:
        order.append("1 in")
        if len(order) == 1:
            cpu.raise_line(1)
        cpu.clock.charge(5)
        order.append("1 out")

    cpu.connect(1, first)
    cpu.connect(9, lambda: order.append("9"))
    cpu.write_ier(1 | 1 << 8)
    cpu.raise_line(9)
    cpu.raise_line(1)
    cpu.enable_interrupts()
    cpu.clock.charge(1)
    assert order == ["1 in", "1 out", "1 in", "1 out", "9"]


def test_an_interrupt_that_nothing_handles_is_reported(cpu: Cpu) -> None:
    cpu.write_ier(2)
    cpu.enable_interrupts()
    cpu.raise_line(2)
    cpu.clock.charge(1)
    assert [f.rule for f in cpu.findings] == ["interrupt-without-handler"]
