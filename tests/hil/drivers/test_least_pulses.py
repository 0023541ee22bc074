"""Least duties whose pulses a dead band swallows, and programs that are right."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
#define DUTY_MIN    125u
#define DUTY_START  125u
#define LEAST_COUNT 20u
#define DUTY_MAX    2400u
#define DEAD_TIME   {dead}
static Uint16 Duty = {first};
void main(void)
{{
    InitSysCtrl();
    DINT;
    InitEPwm2Gpio();
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    EPwm2Regs.TBPRD = 2500;
    EPwm2Regs.CMPA.bit.CMPA = {set};
    EPwm2Regs.AQCTLA.bit.CAU = {up};
    EPwm2Regs.AQCTLA.bit.CAD = {down};
    EPwm2Regs.DBCTL.bit.IN_MODE = DBA_ALL;
    EPwm2Regs.DBCTL.bit.POLSEL = DB_ACTV_HIC;
    EPwm2Regs.DBRED.bit.DBRED = DEAD_TIME;
    EPwm2Regs.DBFED.bit.DBFED = DEAD_TIME;
    EPwm2Regs.DBCTL.bit.OUT_MODE = DB_FULL_ENABLE;
    EPwm2Regs.TBCTL.bit.HSPCLKDIV = TB_DIV1;
    EPwm2Regs.TBCTL.bit.CTRMODE = TB_COUNT_UPDOWN;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    {then}
    for (;;) {{
        EPwm2Regs.CMPA.bit.CMPA = Duty;
        DELAY_US(200);
        if (Duty < 2000u)
            Duty += 5u;
    }}
}}
"""
SET = "EPwm2Regs.CMPA.bit.CMPA = "


def told(folder: Path, **given: str) -> list[tuple[str, str]]:
    """Statement and message of each `pulse-swallowed`."""
    file = folder / "bridge.c"
    usual = {
        "dead": "600u", "set": "DUTY_MIN", "first": "DUTY_START", "up": "AQ_CLEAR", "down": "AQ_SET", "then": "",
    }  # fmt: skip
    text = PROGRAM.format(**(usual | given))
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    lines = text.splitlines()
    return [
        (lines[f.place.line - 1].strip(), f.message) for f in found if f.rule == "pulse-swallowed" and f.place
    ]  # fmt: skip


@pytest.mark.parametrize(("given", "statement", "output", "register"), [
    ({}, f"{SET}DUTY_MIN;", "EPWM2A", "DBRED"),
    ({"set": "0", "first": "0", "then": "Duty = DUTY_MIN;"}, "Duty = DUTY_MIN;", "EPWM2A", "DBRED"),
    ({"up": "AQ_SET", "down": "AQ_CLEAR"}, f"{SET}DUTY_MIN;", "EPWM2B", "DBFED"),
])  # fmt: skip
def test_a_least_duty_of_which_no_pulse_comes_out_is_told(
    tmp_path: Path, given: dict[str, str], statement: str, output: str, register: str
) -> None:
    assert told(tmp_path, **given) == [(
        statement,
        "DUTY_MIN is the least duty by its name, 125 counts in EPwm2Regs.CMPA: its pulses of 2.5 us are shorter than "
        f"the dead band, {register} of 6 us, and none came out of {output}",
    )]  # fmt: skip


@pytest.mark.parametrize("given", [
    {"dead": "50u"},                                     # a dead band shorter than the pulse
    {"dead": "249u"},
    {"set": "DUTY_START"}, {"set": "125u"},              # no least duty: a ramp begins there
    {"set": "LEAST_COUNT", "dead": "60u"},               # it only keeps the compare value away from 0
    {"set": "DUTY_MAX", "first": "DUTY_MAX"},            # the lower switch may stay off
    {"first": "1250u", "then": "EPwm2Regs.CMPA.bit.CMPA = 1250;"},    # it never stood for a period
])  # fmt: skip
def test_a_duty_that_may_be_meant_is_not_told(tmp_path: Path, given: dict[str, str]) -> None:
    assert told(tmp_path, **given) == []
