"""Counts of hardware counters that are taken for times that they are not: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
#define GAP_US          500UL
#define {define}
#define HALF            2
volatile Uint32 Long = 0, pulse_us = 0, other = 0;
volatile float seconds = 0, speed_rpm = 0, pulse_Hz = 0;
static Uint32 Last = 0, Kept = 0, Mixed = 0;
static Uint32 Elapsed(Uint32 begun) {{ return begun - CpuTimer1Regs.TIM.all; }}
static int Longer(Uint32 measured, Uint32 nominal) {{ return measured > nominal + nominal / 4; }}
void main(void)
{{
    InitSysCtrl();
    DINT;
    InitCpuTimers();
    CpuTimer1Regs.TPR.all = {prescale} & 0xFF;
    CpuTimer1Regs.TPRH.all = {prescale} >> 8;
    CpuTimer1Regs.TCR.bit.TRB = 1;
    {start}
    EALLOW;
    CpuSysRegs.PCLKCR3.bit.ECAP1 = 1;
    CpuSysRegs.PCLKCR4.bit.EQEP1 = 1;
    EQep1Regs.QCAPCTL.all = 0x8040;
    EDIS;
    for (;;)
    {{
        Uint32 now = ~CpuTimer1Regs.TIM.all;
        Uint32 width = now - Last;
        Uint32 cap = ECap1Regs.CAP2 - ECap1Regs.CAP1;
        Mixed = width;
        Mixed = GAP_US;
        {use}
        Last = now;
    }}
}}
"""
START = "CpuTimer1Regs.TCR.bit.TSS = 0;"


def told(
    folder: Path, use: str, *, prescale: int = 1999, define: str = "CYCLES_PER_US 200UL", start: str = START,
    rule: str = "count-by-name",
) -> list[str]:  # fmt: skip
    """The messages of the rule."""
    file = folder / "pulse.c"
    text = PROGRAM.format(use=use, prescale=prescale, define=define, start=start)
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    return [f.message for f in found if f.rule == rule]


@pytest.mark.parametrize(("use", "message"), [
    ("if (width > GAP_US) Long++;", "width is in counts of 10000 ns of CpuTimer1, GAP_US in us by its name"),
    ("if (Longer(width, GAP_US)) Long++;",
     "measured is in counts of 10000 ns of CpuTimer1, nominal + nominal / 4 in us by its value's name"),
    ("pulse_us = Elapsed(Kept); Kept = CpuTimer1Regs.TIM.all;",
     "Elapsed(...) is in counts of 10000 ns of CpuTimer1, pulse_us in us by its name"),
    ("pulse_us = cap;", "cap is in counts of 5 ns of ECap1, pulse_us in us by its name"),
    ("other = width / CYCLES_PER_US;",
     "CYCLES_PER_US says that CpuTimer1 counts 200 million times a second, and it counts 0.1 million times"),
    # A clock of 200 kHz.
    ("if (cap > 0) pulse_Hz = 200000.0f / cap;",
     "200000 / cap is 1 / cap (1/(counts of 5 ns of ECap1)) times 2e+05, pulse_Hz is in Hz by its name: from 1/(counts "
     "of 5 ns of ECap1) to Hz the factor is 2e+08"),
    ("other = EQep1Regs.QCPRD; pulse_us = other;", "other is in counts of 80 ns of EQep1, pulse_us in us by its name"),
])  # fmt: skip
def test_a_count_that_lasts_another_time_is_told(tmp_path: Path, use: str, message: str) -> None:
    assert told(tmp_path, use) == [message]


def test_turns_a_second_for_turns_a_minute_are_a_note(tmp_path: Path) -> None:
    assert told(tmp_path, "if (cap > 0) speed_rpm = 2.0e8f / cap;", rule="turns-by-name") == [
        "2e+08 / cap is 1 / cap (1/(counts of 5 ns of ECap1)) times 2e+08, a rate in Hz, and speed_rpm is in rpm: "
        "turns a minute are 60 times turns a second"
    ]


@pytest.mark.parametrize(("define", "use", "rate"), [
    ("CYCLES_PER_US 100UL", "other = cap / CYCLES_PER_US;", "100"),
    ("TICKS_PER_MS 150000UL", "other = cap * 10 / TICKS_PER_MS;", "150"),
    ("TIMER_HZ 100000000.0f", "seconds = cap / TIMER_HZ;", "100"),
    ("TAKTE_PRO_US 100UL", "other = cap / TAKTE_PRO_US;", "100"),
    ("CICLOS_POR_MS 150000UL", "other = cap * 10 / CICLOS_POR_MS;", "150"),
    ("SYSCLK_MHZ 100", "other = (cap >> 1) + cap / SYSCLK_MHZ;", "100"),
    ("CPU_HZ 90000000UL", "if (cap > 0) other = 60 * CPU_HZ / cap;", "90"),
])  # fmt: skip
def test_a_constant_that_states_another_clock_is_told(tmp_path: Path, define: str, use: str, rate: str) -> None:
    name = define.partition(" ")[0]
    assert told(tmp_path, use, define=define) == [
        f"{name} says that ECap1 counts {rate} million times a second, and it counts 200 million times"
    ]


@pytest.mark.parametrize(("use", "given"), [
    # The prescaler makes microseconds; the constant is that of SYSCLK.
    ("if (width > GAP_US || Longer(width, GAP_US)) Long++; pulse_us = width;", {"prescale": 199}),
    ("pulse_us = cap / CYCLES_PER_US; pulse_us = cap / 200; pulse_us = width * 10;", {}),
    ("seconds = cap / TIMER_HZ;", {"define": "TIMER_HZ 200000000.0f"}),
    # Half of a path, or a part of it; another factor; no time; other values too.
    ("pulse_us = cap / (HALF * CYCLES_PER_US); pulse_us = cap / 400;", {}),
    ("other = cap * CUBES_PER_US; other = cap / GAP_US;", {"define": "CUBES_PER_US 3"}),
    ("other = cap * WEG_PRO_US; other = cap / GAP_US;", {"define": "WEG_PRO_US 3"}),
    ("other = cap / TAKTE_PRO_US;", {"define": "TAKTE_PRO_US 200UL"}),
    ("if (Mixed > GAP_US) Long++;", {}),
    ("other = Long / CYCLES_PER_US;", {"define": "CYCLES_PER_US 100UL"}),
    # Turns a minute; rates; a wheel with four pulses, one with sixty teeth.
    ("if (cap > 0) { speed_rpm = 60.0f * 2.0e8f / cap; pulse_Hz = 2.0e8f / cap; }", {}),
    ("if (cap > 0) { speed_rpm = 15.0f * 2.0e8f / cap; speed_rpm = 2.0e8f / cap * 60.0f; }", {}),
    ("if (cap > 0) speed_rpm = 2.0e8f / cap;   // 60 teeth", {}),
    ("if (cap > 0) speed_rpm = 60.0f * TIMER_HZ / (TEETH * cap);",
     {"define": "TEETH 60\n#define TIMER_HZ 200000000.0f"}),
    # It stands, or captures each second edge.
    ("if (width > GAP_US) Long++;", {"start": "CpuTimer1Regs.TCR.bit.TSS = 1;"}),
    ("pulse_us = cap;", {"start": "ECap1Regs.ECCTL1.bit.PRESCALE = 1;"}),
])  # fmt: skip
def test_a_count_that_is_converted_is_not_told(tmp_path: Path, use: str, given: dict[str, object]) -> None:
    assert told(tmp_path, use, **given) == []  # type: ignore[arg-type]


SERVO = """#include "F28x_Project.h"
#define CENTRE_US       1500
#define TICKS_PER_100US 156
volatile Uint16 wanted_us = 1200, dead_ns = 300;
static void Servo(Uint16 us) {{ {set} }}
void main(void)
{{
    InitSysCtrl();
    GPIO_SetupPinMux(0, GPIO_MUX_CPU1, 1);
    EPwm1Regs.TBPRD = 31249;
    EPwm1Regs.TBCTL.bit.CLKDIV = {divider};
    EPwm1Regs.TBCTL.bit.HSPCLKDIV = 0;
    EPwm1Regs.AQCTLA.bit.ZRO = 2;
    EPwm1Regs.AQCTLA.bit.CAU = 1;
    EPwm1Regs.TBCTL.bit.CTRMODE = {mode};
    for (;;) {{ Servo(wanted_us); {use} DELAY_US(1000); }}
}}
"""
PLAIN = "EPwm1Regs.CMPA.bit.CMPA = us;"


def told_of_a_servo(folder: Path, *, set: str = PLAIN, use: str = "", divider: int = 6, mode: int = 0) -> list[str]:
    """The messages of the rule, of an ePWM whose counts last 10 ns times two to the `divider`."""
    file = folder / "servo.c"
    file.write_text(SERVO.format(set=set, use=use, divider=divider, mode=mode), encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    return [f.message for f in found if f.rule == "count-by-name"]


@pytest.mark.parametrize(("given", "message"), [
    ({}, "us is in us by its name, CMPA of EPwm1 in counts of 640 ns"),
    ({"set": "EPwm1Regs.CMPB.bit.CMPB = (Uint16)us;"}, "us is in us by its name, CMPB of EPwm1 in counts of 640 ns"),
    ({"set": "", "use": "EPwm1Regs.CMPA.bit.CMPA = CENTRE_US;"},
     "CENTRE_US is in us by its name, CMPA of EPwm1 in counts of 640 ns"),
    ({"set": "", "use": "EPwm1Regs.DBRED.bit.DBRED = dead_ns;", "divider": 0, "mode": 2},
     "dead_ns is in ns by its name, DBRED of EPwm1 in counts of 10 ns"),
    ({"set": "", "use": "CpuTimer1Regs.PRD.all = wanted_us;"},
     "wanted_us is in us by its name, PRD of CpuTimer1 in counts of 5 ns"),
    # A timer that pauses at the end, as between two moves of a motor.
    ({"set": "CpuTimer1Regs.TCR.bit.TSS = 1; CpuTimer1Regs.PRD.all = us - 1;",
      "use": "CpuTimer1Regs.TCR.all = 0x4000; StopCpuTimer1();"},
     "us - 1 is in us by its name, PRD of CpuTimer1 in counts of 5 ns"),
])  # fmt: skip
def test_a_time_that_goes_to_a_register_as_it_is_is_told(tmp_path: Path, given: dict[str, Any], message: str) -> None:
    start = "InitCpuTimers(); StartCpuTimer1(); " if "CpuTimer1" in message else ""
    given = given | {"use": start + given.get("use", "")}
    assert told_of_a_servo(tmp_path, **given) == [message]


@pytest.mark.parametrize("given", [
    # Converted: by a fraction, by a shift, by a constant with a name.
    {"set": "EPwm1Regs.CMPA.bit.CMPA = (Uint32)us * 25 / 16;"},
    {"set": "EPwm1Regs.CMPA.bit.CMPA = us >> 1;", "divider": 7},
    {"set": "EPwm1Regs.CMPA.bit.CMPA = (Uint32)us * TICKS_PER_100US / 100;"},
    # Up and down, a pulse is twice as long; a counter that stands makes none.
    {"mode": 2}, {"mode": 3},
    {"set": "CpuTimer1Regs.TCR.bit.TSS = 1; CpuTimer1Regs.PRD.all = us;"},
    {"set": "CpuTimer1Regs.TCR.all = 0x4010; CpuTimer1Regs.PRD.all = us;", "use": "StartCpuTimer0();"},
    # A timer that pauses, and of which a count is a microsecond.
    {"set": "CpuTimer1Regs.TPR.all = 199; CpuTimer1Regs.PRD.all = us - 1;",
     "use": "StartCpuTimer1(); StopCpuTimer1();"},
    # The bits of the high resolution are no count; nor is another field.
    {"set": "EPwm1Regs.CMPA.all = (Uint32)us << 16;"}, {"set": "EPwm1Regs.CMPA.bit.CMPAHR = us;"},
    {"set": "EPwm1Regs.ETPS.bit.INTPRD = us;"},
])  # fmt: skip
def test_a_time_that_is_converted_for_a_register_is_not_told(tmp_path: Path, given: dict[str, Any]) -> None:
    assert told_of_a_servo(tmp_path, **given) == []
