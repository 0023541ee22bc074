"""`ConfigCpuTimer` with another chip's clock is told at the call (HDR F2837xS_CpuTimers.c: Freq is SYSCLK in MHz)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files


@pytest.fixture
def told(tmp_path: Path) -> Callable[..., list[int]]:
    """A function that gives the lines of a `main` of which the rule speaks; the first one is 1."""

    def check(*lines: str) -> list[int]:
        file = tmp_path / "drv.c"
        text = ['#include "F28x_Project.h"', "#define OLD_MHZ 90", "void main(void)", "{", *lines, "}"]
        file.write_text("\n".join(text) + "\n", encoding="utf-8")
        found = check_files(DriverFiles([file], seconds=0.001, board=load("bare"))).findings
        places = [finding.place for finding in found if finding.rule == "timer-clock"]
        return [place.line - 4 for place in places if place]

    return check


@pytest.mark.parametrize("mhz", ["100", "150.0f", "OLD_MHZ"])
def test_another_clock_is_told(told: Callable[..., list[int]], mhz: str) -> None:
    assert told("InitSysCtrl();", "InitCpuTimers();", f"ConfigCpuTimer(&CpuTimer1, {mhz}, 1000);") == [3]


def test_the_clock_itself_and_a_period_in_cycles_are_not_told(told: Callable[..., list[int]]) -> None:
    calls = ("ConfigCpuTimer(&CpuTimer0, 200, 1000);", "ConfigCpuTimer(&CpuTimer1, 1, 200000);")
    assert told("InitSysCtrl();", *calls) == []


@pytest.mark.parametrize(
    "clock",
    [
        "InitCpuTimers();",
        "InitSysCtrl(); InitSysPll(XTAL_OSC, IMULT_20, FMULT_0, PLLCLK_BY_2);",
        "InitSysCtrl(); EALLOW; ClkCfgRegs.SYSCLKDIVSEL.bit.PLLSYSCLKDIV = 2; EDIS;",
    ],
)
def test_a_clock_that_the_program_sets_itself_or_leaves_is_not_told(
    told: Callable[..., list[int]], clock: str
) -> None:
    assert told(clock, "ConfigCpuTimer(&CpuTimer0, 100, 1000);") == []


def test_timer_2_may_have_another_clock(told: Callable[..., list[int]]) -> None:
    clock = "InitSysCtrl(); EALLOW; CpuSysRegs.TMR2CLKCTL.bit.TMR2CLKSRCSEL = 1; EDIS;"
    calls = ("ConfigCpuTimer(&CpuTimer2, 10, 1000);", "ConfigCpuTimer(&CpuTimer0, 10, 1000);")
    assert told(clock, *calls) == [3]
