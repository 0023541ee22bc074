"""Watchdog.  One count is 512 periods of the 10 MHz INTOSC1, 10,240 SYSCLK cycles; 256 counts expire it."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.c28x.findings import Findings
from emulator.clock import NEVER, Clock
from emulator.cpu import Cpu
from emulator.peripherals.watchdog import Watchdog
from emulator.registers.watchdog import WdRegs

COUNT = 512 * 20
EXPIRY = 256 * COUNT


class Bench:
    def __init__(self, **options: Any) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.cpu.eallow = True
        self.regs = WdRegs("WdRegs", 0x7000, self.cpu)
        self.resets: list[int] = []
        self.wakes: list[int] = []
        self.watchdog = Watchdog(self.clock, self.cpu, self.regs, lambda: self.resets.append(self.clock.now),
                                 lambda: self.wakes.append(self.clock.now), **options)  # fmt: skip

    def service(self) -> None:
        self.regs.WDKEY.all = 0x55
        self.regs.WDKEY.all = 0xAA


def test_an_enabled_watchdog_resets_after_256_counts() -> None:
    bench = Bench()
    bench.clock.charge(EXPIRY - 1)
    assert (bench.resets, bench.regs.WDCNTR.all) == ([], 255)
    bench.clock.charge(1)
    assert bench.resets == [EXPIRY]
    assert [f.rule for f in bench.findings] == ["watchdog-reset"]


@pytest.mark.parametrize(("last", "told"), [(0x55, True), (0xAA, False)])
def test_a_service_that_was_begun_and_not_ended_is_told(last: int, told: bool) -> None:
    bench = Bench()
    bench.service()
    bench.regs.WDKEY.all = last
    bench.clock.charge(EXPIRY)
    (finding,) = bench.findings
    assert ("0x55 was written to WDKEY, and 0xAA did not follow" in finding.message) is told


def test_the_startup_word_switches_it_off() -> None:
    bench = Bench()
    bench.regs.WDCR.all = 0x0068
    assert bench.clock.next == NEVER
    bench.clock.charge(3 * EXPIRY)
    assert bench.resets == []
    assert bench.regs.WDCR.all == 0x40, "WDCHK reads 0"


def test_services_of_a_watchdog_that_is_off_are_counted() -> None:
    bench = Bench()
    bench.regs.WDCR.all = 0x0068
    bench.service()
    bench.regs.WDCR.all = 0x006F
    bench.service()
    assert (bench.watchdog.serviced_off, bench.watchdog.switched_on) == (1, {})
    bench.regs.WDCR.all = 0x0028
    assert (bench.watchdog.serviced_off, bench.watchdog.switched_on) == (0, {0: None})


def test_service_restarts_the_counter() -> None:
    bench = Bench()
    bench.clock.charge(100 * COUNT)
    bench.service()
    assert bench.regs.WDCNTR.all == 0
    bench.clock.charge(EXPIRY - 1)
    assert bench.resets == []
    bench.clock.charge(1)
    assert bench.resets == [100 * COUNT + EXPIRY]


@pytest.mark.parametrize("keys", [(0xAA,), (0x55,), (0x55, 0x12, 0xAA), (0xAA, 0x55)])
def test_only_0x55_then_0xAA_services(keys: tuple[int, ...]) -> None:
    bench = Bench()
    bench.clock.charge(10 * COUNT)
    for key in keys:
        bench.regs.WDKEY.all = key
    assert bench.regs.WDCNTR.all == 10


@pytest.mark.parametrize("word", [0x0000, 0x0040, 0x0060, 0x0070, 0x0078])
def test_a_write_to_WDCR_without_101b_resets_at_once(word: int) -> None:
    bench = Bench(enabled_at_reset=False)
    bench.clock.charge(77)
    bench.regs.WDCR.all = word
    assert bench.resets == [77]


def test_a_read_modify_write_of_WDCR_resets_because_WDCHK_reads_0() -> None:
    bench = Bench(enabled_at_reset=False)
    bench.regs.WDCR.bit.WDPS = 2
    assert bench.resets == [0]


def test_protection_keeps_WDCR_from_an_unprotected_write() -> None:
    bench = Bench()
    bench.cpu.eallow = False
    bench.regs.WDCR.all = 0
    assert bench.resets == []
    assert [f.rule for f in bench.findings] == ["eallow"]


@pytest.mark.parametrize(("wdps", "divider"), [(0, 1), (1, 1), (2, 2), (3, 4), (7, 64)])
def test_the_prescaler_stretches_the_count(wdps: int, divider: int) -> None:
    bench = Bench()
    bench.regs.WDCR.all = 0x28 | wdps
    bench.clock.charge(EXPIRY * divider - 1)
    assert bench.resets == []
    bench.clock.charge(1)
    assert bench.resets == [EXPIRY * divider]


def test_a_change_of_prescaler_keeps_the_count() -> None:
    bench = Bench()
    bench.clock.charge(10 * COUNT)
    bench.regs.WDCR.all = 0x2A
    assert bench.regs.WDCNTR.all == 10
    bench.clock.charge(4 * COUNT)
    assert bench.regs.WDCNTR.all == 12


def test_with_WDENINT_expiry_is_an_interrupt_and_WDINTS_goes_low_for_512_clocks() -> None:
    bench = Bench()
    bench.regs.SCSR.all = 0x2
    bench.clock.charge(EXPIRY)
    assert (bench.resets, bench.wakes, bench.regs.SCSR.bit.WDINTS) == ([], [EXPIRY], 0)
    bench.clock.charge(COUNT - 1)
    assert bench.regs.SCSR.bit.WDINTS == 0
    bench.clock.charge(1)
    assert bench.regs.SCSR.bit.WDINTS == 1
    bench.clock.charge(EXPIRY)
    assert bench.wakes == [EXPIRY, 2 * EXPIRY]


def test_clearing_WDOVERRIDE_freezes_WDDIS() -> None:
    bench = Bench()
    bench.regs.SCSR.bit.WDOVERRIDE = 1
    bench.regs.WDCR.all = 0x0068
    assert bench.regs.WDCR.bit.WDDIS == 0
    bench.clock.charge(EXPIRY)
    assert bench.resets == [EXPIRY]


def test_a_service_before_the_window_expires_it_except_the_first() -> None:
    bench = Bench()
    bench.regs.WDWCR.all = 50
    bench.service()
    assert (bench.resets, bench.regs.WDWCR.bit.FIRSTKEY) == ([], 1)
    bench.clock.charge(50 * COUNT)
    bench.service()
    assert bench.resets == []
    bench.clock.charge(49 * COUNT)
    bench.service()
    assert bench.resets == [99 * COUNT]
