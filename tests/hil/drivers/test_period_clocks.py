"""Periods that are reckoned with a clock that their counter does not count: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
#define SYSCLK_HZ       200000000UL
#define SYSCLK_MHZ      200UL
#define TBCLK_HZ        100000000UL
#define TIMER_HZ        1000000UL
#define CPUTIMER1_BASE  0x0C08UL
#define EPWM1_BASE      0x4000UL
// As those of TI's driverlib, which reach the registers by address.
static void CPUTimer_setPeriod(Uint32 base, Uint32 count) {{ *(volatile Uint32 *)(base + 2) = count; }}
static void EPWM_setTimeBasePeriod(Uint32 base, Uint16 count) {{ *(volatile Uint16 *)(base + 0x63) = count; }}
volatile int32 speed = 100;
volatile Uint32 rate_Hz = 5000, pause_us = 700, pause_ms = 2;
static void setSpeed(Uint32 v) {{ {set} }}
void main(void)
{{
    InitSysCtrl();
    InitCpuTimers();
    CpuTimer1Regs.TCR.bit.TSS = 1;
    CpuTimer1Regs.TPR.all = {prescale};
    EPwm1Regs.TBCTL.bit.CTRMODE = {mode};
    EPwm1Regs.TBCTL.bit.CLKDIV = 0;
    EPwm1Regs.TBCTL.bit.HSPCLKDIV = {divider};
    for (;;) {{
        setSpeed({passed});
        {start}
        DELAY_US(100);
        CpuTimer1Regs.TCR.bit.TSS = 1;
    }}
}}
"""
PRD = "CpuTimer1Regs.PRD.all = "
TBPRD = "EPwm1Regs.TBPRD = "


def told(
    folder: Path, set_: str, *, prescale: int = 1, mode: int = 0, divider: int = 1, passed: str = "speed",
    start: str = "CpuTimer1Regs.TCR.bit.TSS = 0;",
) -> list[str]:  # fmt: skip
    """The messages of the rule."""
    file = folder / "steps.c"
    text = PROGRAM.format(set=set_, prescale=prescale, mode=mode, divider=divider, passed=passed, start=start)
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    return [f.message for f in found if f.rule == "count-by-name"]


@pytest.mark.parametrize(("set_", "prescale", "message"), [
    (f"{PRD}SYSCLK_HZ / (Uint32)v - 1;", 1,
     "PRD is reckoned with SYSCLK_HZ, 200 million counts a second, and CpuTimer1 counts 100 million times"),
    ("Uint32 counts = SYSCLK_HZ / v; CpuTimer1Regs.PRD.all = counts - 1;", 199,
     "PRD is reckoned with SYSCLK_HZ, 200 million counts a second, and CpuTimer1 counts 1 million times"),
    (f"{PRD}TIMER_HZ / v - 1;", 0,
     "PRD is reckoned with TIMER_HZ, 1 million counts a second, and CpuTimer1 counts 200 million times"),
    # A rate by its name has no scale of its own.
    (f"{PRD}SYSCLK_HZ / rate_Hz;", 9,
     "PRD is reckoned with SYSCLK_HZ, 200 million counts a second, and CpuTimer1 counts 20 million times"),
    (f"{PRD}pause_us * SYSCLK_MHZ - 1;", 1,
     "PRD is reckoned with SYSCLK_MHZ, 200 million counts a second, and CpuTimer1 counts 100 million times"),
    ("CPUTimer_setPeriod(CPUTIMER1_BASE, SYSCLK_HZ / v);", 1,
     "PRD is reckoned with SYSCLK_HZ, 200 million counts a second, and CpuTimer1 counts 100 million times"),
    (f"{TBPRD}TBCLK_HZ / rate_Hz - 1;", 0,
     "TBPRD is reckoned with TBCLK_HZ, 100 million counts a second, and EPwm1 counts 50 million times"),
    ("EPWM_setTimeBasePeriod(EPWM1_BASE, (Uint16)(TBCLK_HZ / rate_Hz - 1));", 0,
     "TBPRD is reckoned with TBCLK_HZ, 100 million counts a second, and EPwm1 counts 50 million times"),
])  # fmt: skip
def test_a_period_of_another_clock_is_told(tmp_path: Path, set_: str, prescale: int, message: str) -> None:
    assert told(tmp_path, set_, prescale=prescale) == [message]


@pytest.mark.parametrize(("set_", "given"), [
    # The clock that the counter counts.
    (f"{PRD}SYSCLK_HZ / (Uint32)v - 1;", {"prescale": 0}), (f"{PRD}TIMER_HZ / v - 1;", {"prescale": 199}),
    (f"{TBPRD}TBCLK_HZ / rate_Hz - 1;", {"divider": 0}), (f"{PRD}pause_us * SYSCLK_MHZ - 1;", {"prescale": 0}),
    # A number that makes up for the prescaler, beside the clock or where the object comes from.
    (f"{PRD}SYSCLK_HZ / 2 / v - 1;", {}), (f"{PRD}SYSCLK_HZ / (2 * v) - 1;", {}),
    (f"{PRD}SYSCLK_HZ / v - 1;", {"passed": "2 * speed"}),
    # Tenths of steps a second; times in ms; up and down; a timer that nothing starts; two clocks.
    (f"{PRD}SYSCLK_HZ / v - 1;", {"prescale": 9}), (f"{PRD}SYSCLK_HZ / v - 1;", {"prescale": 255}),
    (f"{PRD}pause_ms * SYSCLK_MHZ;", {"prescale": 1}),
    (f"{TBPRD}TBCLK_HZ / rate_Hz;", {"mode": 2}),
    (f"{PRD}SYSCLK_HZ / v - 1;", {"start": ""}),
    (f"if (v > 500) {{ CpuTimer1Regs.TPR.all = 0; {PRD}SYSCLK_HZ / v - 1; }} "
     f"else {{ CpuTimer1Regs.TPR.all = 199; {PRD}TIMER_HZ / v - 1; }}", {}),
])  # fmt: skip
def test_a_period_of_the_right_clock_is_not_told(tmp_path: Path, set_: str, given: dict[str, object]) -> None:
    assert told(tmp_path, set_, **given) == []  # type: ignore[arg-type]
