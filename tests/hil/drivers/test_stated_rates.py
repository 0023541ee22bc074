"""Rates that stand beside a setting and that the hardware does not have: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
#define TBCLK_HZ    {clock}
#define CARRIER_HZ  20000UL
#define SAMPLE_US   100
#define BLINK_HZ    5UL
{define}
void main(void)
{{
    InitSysCtrl();
    DINT;
    InitCpuTimers();
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    EPwm1Regs.TBCTL.bit.CLKDIV = 0;
    EPwm1Regs.TBCTL.bit.HSPCLKDIV = 0;
    {set}
    EPwm1Regs.TBCTL.bit.CTRMODE = {mode};
    {then}
    for (;;) {{ }}
}}
"""
START = "CpuTimer0Regs.TCR.bit.TSS = 0;"


def told(
    folder: Path, set_: str, *, define: str = "", then: str = START, mode: str = "TB_COUNT_UP",
    clock: str = "200000000UL",
) -> list[tuple[str, str]]:  # fmt: skip
    """Statement and message of each `stated-rate`."""
    file = folder / "carrier.c"
    text = PROGRAM.format(set=set_, define=define, then=then, mode=mode, clock=clock)
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    lines = text.splitlines()
    return [
        (lines[f.place.line - 1].strip(), f.message) for f in found if f.rule == "stated-rate" and f.place is not None
    ]  # fmt: skip


@pytest.mark.parametrize(("set_", "given", "message"), [
    ("EPwm1Regs.TBPRD = 9999;   // 200 MHz / 10000 = 20 kHz", {},
     "the comment '200 MHz / 10000 = 20 kHz' states 20 kHz, and EPwm1 counts its period 10 kHz"),
    ("EPwm1Regs.TBPRD = CARRIER;", {"define": "#define CARRIER 4999  /* 20 kHz */", "mode": "TB_COUNT_UPDOWN"},
     "the comment '20 kHz' states 20 kHz, and EPwm1 counts its period 10 kHz"),
    ("EPwm1Regs.TBPRD = TBCLK_HZ / CARRIER_HZ - 1;", {},
     "CARRIER_HZ states 20 kHz, and EPwm1 counts its period 10 kHz"),
    ("EPwm1Regs.TBPRD = 200 * SAMPLE_US - 1;", {}, "SAMPLE_US states 10 kHz, and EPwm1 counts its period 5 kHz"),
    ("ConfigCpuTimer(&CpuTimer0, 200, 1000);  // 0.1 ms", {},
     "the comment '0.1 ms' states 10 kHz, and CpuTimer0 counts its period 1 kHz"),
    ("CpuTimer0Regs.PRD.all = 19999; CpuTimer0Regs.TCR.bit.TRB = 1;  // 1 ms", {},
     "the comment '1 ms' states 1 kHz, and CpuTimer0 counts its period 10 kHz"),
    ("SciaRegs.SCIHBAUD.all = 0; SciaRegs.SCILBAUD.all = 40;  // 115,200 bits/s of 100 MHz", {},
     "the comment '115,200 bits/s of 100 MHz' states 115200 baud, and SciaRegs sends and receives 152439"),
    ("DELAY_US(SETTLE);", {"define": "#define SETTLE 500  /* 5 ms */"},
     "the comment '5 ms' states another time than DELAY_US gets: 0.0005 s"),
])  # fmt: skip
def test_a_rate_that_the_hardware_does_not_have_is_told(
    tmp_path: Path, set_: str, given: dict[str, str], message: str
) -> None:
    assert told(tmp_path, set_, **given) == [(set_, message)]


@pytest.mark.parametrize(("set_", "given"), [
    ("EPwm1Regs.TBPRD = 4999;   // 100 MHz / 5000 = 20 kHz", {}),
    ("EPwm1Regs.TBPRD = TBCLK_HZ / CARRIER_HZ - 1;", {"clock": "100000000UL"}),
    ("EPwm1Regs.TBPRD = TBCLK_HZ / CARRIER_HZ / 2;", {"clock": "100000000UL", "mode": "TB_COUNT_UPDOWN"}),
    ("ConfigCpuTimer(&CpuTimer0, 200, 10 * SAMPLE_US);  // 1 ms", {}),
    # One trigger for three periods, two for one, a pin that toggles.
    ("EPwm1Regs.TBPRD = 4999; EPwm1Regs.ETPS.bit.SOCAPRD = 2;  // 10 kHz", {}),
    ("EPwm1Regs.TBPRD = 4999; EPwm1Regs.ETSEL.bit.SOCASEL = 3;  // 20 kHz", {"mode": "TB_COUNT_UPDOWN"}),
    ("EPwm1Regs.TBPRD = 4999; EPwm1Regs.AQCTLA.bit.ZRO = AQ_TOGGLE;  // 10 kHz", {}),
    # A factor of its own; the clock alone; a part of the period; another amount; none of the usual slips.
    ("CpuTimer0Regs.PRD.all = TBCLK_HZ / (2 * BLINK_HZ); CpuTimer0Regs.TCR.bit.TRB = 1;", {}),
    ("EPwm1Regs.TBPRD = 9999;   // of 100 MHz", {}),
    ("EPwm1Regs.TBPRD = 9999;   // 5 us at most for the pulse", {}),
    ("EPwm1Regs.TBPRD = 9999;   // 15 kHz", {}),
    ("CpuTimer0Regs.PRD.all = 499999; CpuTimer0Regs.TCR.bit.TRB = 1;  // 2,5 ms", {}),
    # A usual rate may be meant, and so may one of two; it was another one; the time of all turns, or of two waits.
    ("SciaRegs.SCIHBAUD.all = 0; SciaRegs.SCILBAUD.all = 107;  // 115200", {}),
    ("SciaRegs.SCIHBAUD.all = 0; SciaRegs.SCILBAUD.all = 40;  // 9600 baud, 115200 baud", {}),
    ("SciaRegs.SCIHBAUD.all = 0; SciaRegs.SCILBAUD.all = 40;  // was 9600 baud", {}),
    ("SciaRegs.SCIHBAUD.all = 0; SciaRegs.SCILBAUD.all = 53;  // 115200 baud", {}),
    ("{ int i; for (i = 0; i < 10; i++) DELAY_US(10);  // 100 us\n    }", {}),
    ("DELAY_US(500);  // 1 kHz", {}),
    # It stands; another statement sets it, too.
    ("CpuTimer0Regs.PRD.all = 19999; CpuTimer0Regs.TCR.bit.TRB = 1;  // 1 ms", {"then": ""}),
    ("EPwm1Regs.TBPRD = 9999;   // 20 kHz", {"then": "EPwm1Regs.TBPRD = 4999;"}),
])  # fmt: skip
def test_a_rate_that_the_hardware_has_is_not_told(tmp_path: Path, set_: str, given: dict[str, str]) -> None:
    assert told(tmp_path, set_, **given) == []


#: Two SCIs, with names for the rates.
SERIAL = """#include "F28x_Project.h"
#define LSPCLK_HZ   {clock}
#define BAUD        {baud}
#define GPS_BAUD    9600UL
static const Uint32 link_baud = 38400UL;
volatile Uint16 Order;
void main(void)
{{
    Uint16 brr = LSPCLK_HZ / (BAUD * {times}UL) - 1;
    InitSysCtrl();
    DINT;
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    CpuSysRegs.PCLKCR7.bit.SCI_B = 1;
    {clocks}
    EDIS;
    ScibRegs.SCIHBAUD.all = (LSPCLK_HZ / (GPS_BAUD * 8) - 1) >> 8;
    ScibRegs.SCILBAUD.all = (LSPCLK_HZ / (GPS_BAUD * 8) - 1) & 0xFF;
    {high}
    {low}
    for (;;) {{ {then} }}
}}
"""
HIGH = "SciaRegs.SCIHBAUD.all = ((LSPCLK_HZ / (BAUD * 8)) - 1) >> 8;"
LOW = "SciaRegs.SCILBAUD.all = ((LSPCLK_HZ / (BAUD * 8)) - 1) & 0xFF;"


def serial(
    folder: Path, high: str = HIGH, low: str = LOW, *, clock: str = "50000000UL", clocks: str = "", then: str = "",
    baud: str = "115200UL", times: int = 8,
) -> list[tuple[str, str]]:  # fmt: skip
    """Statement and message of each `stated-rate` about the two SCIs."""
    file = folder / "serial.c"
    text = SERIAL.format(high=high, low=low, clock=clock, clocks=clocks, then=then, baud=baud, times=times)
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    lines = text.splitlines()
    return [
        (lines[f.place.line - 1].strip(), f.message) for f in found if f.rule == "stated-rate" and f.place is not None
    ]  # fmt: skip


@pytest.mark.parametrize(("high", "low", "given", "at", "real"), [
    (HIGH, LOW.replace("* 8", "* 16"), {}, "low", "231481: the divider is 26, for BAUD it is 53"),
    (HIGH.replace("* 8", "* 16"), LOW.replace("* 8", "* 16"), {}, "low", "231481: the divider is 26"),
    (HIGH.replace("8)", "16)", 1), LOW, {"baud": "9600UL"}, "high", "15823: the divider is 394, for BAUD it is 650"),
    ("SciaRegs.SCIHBAUD.all = 0;", LOW.replace("* 8", "* 16"), {}, "low", "231481: the divider is 26"),
    # A clock that the chip does not have.
    (HIGH, LOW, {"clock": "100000000UL"}, "low", "57870: the divider is 107, for BAUD it is 53"),
    # A local of both halves: declared with its value, and before it.
    ("Uint16 set; set = LSPCLK_HZ / (BAUD * 16UL) - 1; SciaRegs.SCIHBAUD.all = set >> 8;",
     "SciaRegs.SCILBAUD.all = set & 0xFF;", {}, "low", "231481: the divider is 26"),
    ("SciaRegs.SCIHBAUD.all = brr >> 8;", "SciaRegs.SCILBAUD.all = brr & 0xFF;", {"times": 16}, "low", "231481: the"),
])  # fmt: skip
def test_a_divider_whose_name_states_another_bit_rate_is_told(
    tmp_path: Path, high: str, low: str, given: dict[str, Any], at: str, real: str
) -> None:
    found = serial(tmp_path, high, low, **given)
    found = [each for each in found if "SciaRegs" in each[0]]
    ((statement, message),) = found
    assert statement == (high if at == "high" else low)
    assert message.startswith(f"BAUD states {given.get('baud', '115200UL').rstrip('UL')} baud, and SciaRegs sends and")
    assert real in message


def test_a_const_object_states_a_bit_rate(tmp_path: Path) -> None:
    low = LOW.replace("BAUD * 8", "link_baud * 16")
    assert [each[0] for each in serial(tmp_path, "SciaRegs.SCIHBAUD.all = 0;", low)] == [low]
    low = low.replace("16", "8")
    assert not serial(tmp_path, "SciaRegs.SCIHBAUD.all = 0;", low)


@pytest.mark.parametrize(("high", "low", "given"), [
    (HIGH, LOW, {}),
    ("SciaRegs.SCIHBAUD.all = brr >> 8;", "SciaRegs.SCILBAUD.all = brr & 0xFF;", {}),
    # The clock that is set.
    (HIGH, LOW, {"clock": "100000000UL", "clocks": "ClkCfgRegs.LOSPCP.bit.LSPCLKDIV = 1;"}),
    # A local that changes; one that is made of itself.
    ("brr = 53; SciaRegs.SCIHBAUD.all = brr >> 8;", "SciaRegs.SCILBAUD.all = brr & 0xFF;", {"times": 16}),
    ("Uint16 own; own = own + BAUD / 2170; SciaRegs.SCIHBAUD.all = 0;", "SciaRegs.SCILBAUD.all = own;", {}),
    # Another rate at run time, by name and by a pointer; a rate that the SCI measures.
    (HIGH, LOW.replace("* 8", "* 16"), {"then": "if (Order) SciaRegs.SCILBAUD.all = 53;"}),
    (HIGH, LOW.replace("* 8", "* 16"), {"then": "volatile struct SCI_REGS *p = &SciaRegs; p->SCILBAUD.all = 53;"}),
    (HIGH, LOW.replace("* 8", "* 16"), {"clocks": "SciaRegs.SCIFFCT.bit.CDC = 1;"}),
    # No divider is nearer; the name is that of a divider.
    (HIGH, LOW, {"baud": "2500000UL"}),
    ("SciaRegs.SCIHBAUD.all = 0;", "SciaRegs.SCILBAUD.all = 53000UL / BAUD;", {"baud": "1000"}),
])  # fmt: skip
def test_a_divider_whose_name_states_its_bit_rate_is_not_told(
    tmp_path: Path, high: str, low: str, given: dict[str, Any]
) -> None:
    found = [each for each in serial(tmp_path, high, low, **given) if "SciaRegs" in each[0]]
    assert not found


#: TBCLK has 50 MHz.
HALVED = "EPwm1Regs.TBCTL.bit.HSPCLKDIV = TB_DIV2; EPwm1Regs.TBPRD = PERIOD - 1;"


@pytest.mark.parametrize(("define", "rate", "real"), [
    ("// Servo: 100 MHz, 50000 counts are 0.5 ms (2 kHz)\n#define PERIOD 50000U", "2 kHz", "1 kHz"),
    ("#define PERIOD 50000U  // 50000 counts are 0.5 ms", "2 kHz", "1 kHz"),
    ("// 50000 cuentas son 500 us\n#define PERIOD 50000U", "2 kHz", "1 kHz"),
    ("#define PERIOD 50000U  // 0.5 ms per period (= 2 kHz)", "2 kHz", "1 kHz"),
    ("#define PERIOD 25000U  /* 25000 Takte dauern 5 ms (200 Hz) */", "200 Hz", "2 kHz"),
])  # fmt: skip
def test_counts_that_last_another_time_are_told(tmp_path: Path, define: str, rate: str, real: str) -> None:
    comment = define.partition("#")[0].strip() or define.partition("U")[2].strip()
    assert told(tmp_path, HALVED, define=define) == [(
        HALVED, f"the comment {comment.strip('/* ')!r} states {rate}, and EPwm1 counts its period {real}",
    )]  # fmt: skip


@pytest.mark.parametrize(("define", "given"), [
    # Both agree with the hardware: the period, and half of it, up and down.
    ("// 50 MHz: 50000 counts are 1 ms (1 kHz)\n#define PERIOD 50000U", {}),
    ("#define PERIOD 50000U  // 1 ms per period", {}),
    ("#define PERIOD 50001U  // 50001 counts are 1 ms; 2 ms per period", {"mode": "TB_COUNT_UPDOWN"}),
    # A part of the period; a rate that is not that of the time; code between them.
    ("// 2500 counts are 0.1 ms\n#define PERIOD 50000U", {}),
    ("// 50000 counts are 0.5 ms (1 kHz)\n#define PERIOD 50000U", {}),
    ("// 50000 counts are 0.5 ms\n#define OTHER 50000U\n#define PERIOD 50000U", {}),
    # The comment is right for another counter with the same number, or for a number of which this is a part.
    ("// 50000 counts are 250 us\n#define PERIOD 50000U", {"then": f"CpuTimer0Regs.PRD.all = PERIOD - 1; {START}"}),
    ("// 100000 counts are 1 ms\n#define WHOLE 100000UL\n#define PERIOD (WHOLE / 2)", {}),
])  # fmt: skip
def test_counts_that_last_the_stated_time_are_not_told(tmp_path: Path, define: str, given: dict[str, str]) -> None:
    assert told(tmp_path, HALVED, define=define, **given) == []
