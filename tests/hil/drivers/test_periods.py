"""Constants that state another period than a routine has in the run: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
#define {define}
#define GAIN 3.0f
volatile float Speed = 0, Sum = 0, Last = 0, Way = 0;
volatile Uint16 Runs = 0, Slow = 0;
static void Meter(float way)
{{
    {use}
    Last = way;
}}
interrupt void Control(void)
{{
    Runs++;
    {call}
}}
interrupt void Other(void) {{ Slow++; }}
void main(void)
{{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0;
    IFR = 0;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER1_INT = &Control;
    PieVectTable.TIMER2_INT = &Other;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer1, 200, 100);
    IER |= M_INT13;
    EINT;
    StartCpuTimer1();
    for (;;) {{ {turn} }}
}}
"""
USE = "Speed = (way - Last) / CONTROL_S;"


def told(
    folder: Path, *, define: str = "CONTROL_S 0.001f", use: str = USE, call: str = "Meter(Way);", turn: str = "",
) -> list[str]:  # fmt: skip
    """The statements at which `period-by-name` is told; the routine runs every 0.1 ms."""
    file = folder / "a.c"
    text = PROGRAM.format(define=define, use=use, call=call, turn=turn)
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.005)).findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "period-by-name" and f.place]


@pytest.mark.parametrize("given", [
    {},
    {"define": "LOOP_US 1000L", "use": "Sum += way * LOOP_US;"},
    {"define": "SAMPLE_HZ 100000.0f", "use": "Speed = (way - Last) * SAMPLE_HZ;"},
    {"use": "Speed = (way - Last) * (GAIN / CONTROL_S);"},
    {"call": "if (Runs & 1) Meter(Way); else { Slow++; Meter(-Way); }"},
    {"define": "OFF 0\nstatic const struct { float ki, dt_s; } Pi = { 2.0f, 0.001f };", "use": "Sum += way * Pi.dt_s;"},
])  # fmt: skip
def test_a_period_that_is_wrong_by_a_power_of_ten_is_told(tmp_path: Path, given: dict[str, str]) -> None:
    assert told(tmp_path, **given) == [given.get("use", USE)]


TIMER = """#include "F28x_Project.h"
#define SAMPLE_HZ 5000U
#define TICK_MS 1.0f
#define FRAMES_HZ 5000U
volatile Uint16 Runs = 0;
interrupt void Sample(void) {{ Runs++; }}
static void Set(volatile struct CPUTIMER_REGS *timer, Uint32 cycles) {{ timer->PRD.all = cycles; }}
static void Begin(Uint32 hz, Uint16 divider)
{{
    Uint32 cycles = 200000000UL / hz;
    Set(&CpuTimer1Regs, {value});
    CpuTimer1Regs.TPR.bit.TDDR = divider;
    CpuTimer1Regs.TCR.all = 0x4020;
}}
static void Each(float ms) {{ ConfigCpuTimer(&CpuTimer1, 200, {us}); CpuTimer1Regs.TCR.bit.TSS = 0; }}
void main(void)
{{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0;
    IFR = 0;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER1_INT = &Sample;
    EDIS;
    InitCpuTimers();
    {call}
    IER |= M_INT13;
    EINT;
    for (;;) {{ }}
}}
"""


@pytest.mark.parametrize(("call", "value", "us", "told_it"), [
    ("Begin(SAMPLE_HZ, 1);", "cycles - 1", "", True),
    ("Begin(SAMPLE_HZ, 0);", "2 * cycles - 1", "", True),
    ("Each(TICK_MS);", "cycles", "ms * 1500.0f", True),
    ("Begin(SAMPLE_HZ, 0);", "cycles - 1", "", False),
    ("Each(TICK_MS);", "cycles", "ms * 1000.0f", False),
    ("Begin(SAMPLE_HZ, 0);", "cycles / 4 - 1", "", False),  # a faster one can be divided
    ("Begin(2 * SAMPLE_HZ, 7);", "cycles - 1", "", False),
    ("Begin(FRAMES_HZ, 1);", "cycles - 1", "", False),  # not said to be its rate
    ("Begin(SAMPLE_HZ, 0);", "cycles * (Runs + 2)", "", False),  # it depends on more
])  # fmt: skip
def test_a_timer_that_is_slower_than_the_constant_it_is_set_by_is_told(
    tmp_path: Path, call: str, value: str, us: str, told_it: bool
) -> None:  # fmt: skip
    file = tmp_path / "a.c"
    text = TIMER.format(call=call, value=value, us=us or "1000.0f")
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.005)).findings
    lines = [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "period-by-name" and f.place]
    assert lines == [call] * told_it


@pytest.mark.parametrize("given", [
    {"define": "CONTROL_S 0.0001f"},
    {"define": "LOOP_US 100L", "use": "Sum += way * LOOP_US;"},
    # No power of ten; another time; a comparison; no period by its name.
    {"define": "CONTROL_S 0.0002f"},
    {"define": "LOOP_HZ 10000.0f", "use": "Sum += way / (LOOP_HZ / 10.0f);"},
    {"define": "OFF 0\nstatic const float ABTAST_S = 0.0001f;", "use": "Sum += way * ABTAST_S;"},
    {"define": "CONTROL_TAU_S 0.001f", "use": "Sum += (way - Sum) / CONTROL_TAU_S;"},
    {"define": "CONTROL_S 0.001f", "use": "if (way > CONTROL_S) Sum = way;"},
    {"define": "REST_S 0.001f", "use": "Speed = way / REST_S;"},
    # In some of the runs, or by others too.
    {"call": "if (Runs % 10 == 0) Meter(Way);"},
    {"call": "if (Runs % 10) return; Meter(Way);"},
    {"turn": "Meter(Way);"},
])  # fmt: skip
def test_another_time_or_another_rhythm_is_silent(tmp_path: Path, given: dict[str, str]) -> None:
    assert told(tmp_path, **given) == []


@pytest.mark.parametrize(("count", "declared"), [
    ("tickMs++;", "volatile Uint32 tickMs = 0;"), ("Time_us += 10;", "volatile Uint32 Time_us = 0;"),
    ("ms = ms + 1;", "volatile Uint16 ms = 0; // since the start"), ("waitMs--;", "volatile Uint32 waitMs = 60000;"),
    ("if (Runs % 12 < 9) still.for_ms++; else still.for_ms = 0;", "struct { Uint16 n, for_ms; } still = { 0, 0 };"),
    ("if (Runs & 1) ms += TICK_MS;", "#define TICK_MS 1\nvolatile Uint16 ms = 0;"),  # 0.2 ms: no power of ten
])  # fmt: skip
def test_a_count_of_time_that_does_not_go_with_the_time_is_told(tmp_path: Path, count: str, declared: str) -> None:
    assert told(tmp_path, define=f"COUNT\n{declared}", use="", call=count) == [count]


@pytest.mark.parametrize(("count", "declared"), [
    ("Time_us += 100;", "volatile Uint32 Time_us = 0;"),
    # Other units, by name or comment; a time that is not counted; only in some runs; counted somewhere else, too.
    ("tenths_ms++;", "volatile Uint32 tenths_ms = 0;"), ("tickMs++;", "volatile Uint32 tickMs = 0; // tenths of a ms"),
    ("ticks100us++;", "volatile Uint32 ticks100us = 0;"), ("ticks++;", "volatile Uint32 ticks = 0;"),
    ("if (Runs % 10 == 0) tickMs++;", "volatile Uint32 tickMs = 0;"),
    ("tickMs++; if (Slow) tickMs += 2;", "volatile Uint32 tickMs = 0;"),
    ("if (waitMs) waitMs--; else waitMs = 9; Slow = waitMs < 5;", "volatile Uint32 waitMs = 9;"),  # a setting
    ("slow_us += 10; EPwm1Regs.CMPA.bit.CMPA = slow_us * 50;", "volatile Uint16 slow_us = 0;"),
    ("given_ms += STROKE_MS; if (given_ms > 500) given_ms = 0;", "#define STROKE_MS 20\nvolatile Uint16 given_ms = 0;"),
])  # fmt: skip
def test_a_count_that_goes_with_the_time_or_counts_other_things_is_silent(
    tmp_path: Path, count: str, declared: str
) -> None:
    assert told(tmp_path, define=f"COUNT\n{declared}", use="", call=count) == []
