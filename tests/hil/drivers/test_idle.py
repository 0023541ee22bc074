"""A program that sleeps in IDLE works once for each interrupt, as on the chip (SPRU430, IDLE)."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files
from hil.reports.model import rule_of

PROGRAM = r"""#include "F28x_Project.h"

static volatile Uint16 ticks = 0;
static Uint16 samples = 0, last = 0, mean = 0, before = 0;

__interrupt void tick(void)
{
    ticks++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void setUp(void)
{
    EALLOW;
    PieVectTable.TIMER0_INT = &tick;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    EDIS;
    DELAY_US(1000);
    EALLOW;
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 1;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 500);
    CpuTimer0Regs.TCR.bit.TIE = 1;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
}

void main(void)
{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    setUp();
    EINT;
    StartCpuTimer0();
    for (;;) {
        WAIT
        DELAY_US(2);
        last = AdcaResultRegs.ADCRESULT0;
        mean = (Uint16)(((Uint32)mean * 7 + last) >> 3);
        samples++;
    }
}
"""


def errors(tmp_path: Path, wait: str) -> set[str]:
    """The rules of the errors and warnings of the program that waits this way for its next tick."""
    (tmp_path / "level.c").write_text(PROGRAM.replace("WAIT", wait), encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "level.c"], seconds=0.01))
    return {finding.rule for finding in checked.findings if rule_of(finding.rule).severity.value != "note"}


@pytest.mark.parametrize(
    "wait",
    [
        'asm(" IDLE");', "IDLE();", 'DINT; asm(" IDLE"); EINT;',
        'before = ticks; while (ticks == before) asm(" idle ; until the tick");',
    ],
)  # fmt: skip
def test_a_program_that_sleeps_until_the_tick_is_right(tmp_path: Path, wait: str) -> None:
    assert errors(tmp_path, wait) == set()


def test_without_the_sleep_it_reads_what_is_not_converted(tmp_path: Path) -> None:
    assert errors(tmp_path, ";") == {"result-not-ready"}
