"""Programs as other people write them for this family: the CLA, the second CPU, parts that the robot has not."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from hil.board import load
from hil.drivers.check import DriverFiles, check_files
from hil.reports.model import Policy, Severity

HEAD = '#include "F28x_Project.h"\n'
START = "InitSysCtrl(); DINT; InitPieCtrl(); IER = 0; IFR = 0; InitPieVectTable();"


def checked(folder: Path, text: str, *, seconds: float = 0.01, named: bool = False) -> list[Finding]:
    """The findings about a program, with the parts of the robot around it."""
    file = folder / "drv.c"
    file.write_text(text, encoding="utf-8")
    wanted = DriverFiles([file], calls=1, seconds=seconds, board=load("robot"), board_named=named)
    return check_files(wanted).findings


def counted(findings: list[Finding]) -> list[tuple[str, str]]:
    """Rule and message of each error and warning."""
    policy = Policy()
    return [(f.rule, f.message) for f in findings if policy.severity_of(f) is not Severity.NOTE]


CLA = f"""{HEAD}#include "F2837xS_Cla_typedefs.h"
#include "F2837xS_Cla_defines.h"
#pragma DATA_SECTION(Wanted, "CpuToCla1MsgRAM")
float Wanted;
#pragma DATA_SECTION(Given, "Cla1ToCpuMsgRAM")
float Given;
float Kept = 0.0f;
volatile unsigned Turns = 0;
__interrupt void Cla1Task1();
__interrupt void Cla1Task8();
void main(void)
{{
    {START}
    EALLOW;
    MemCfgRegs.MSGxINIT.bit.INIT_CLA1TOCPU = 1;
    while (MemCfgRegs.MSGxINITDONE.bit.INITDONE_CLA1TOCPU != 1) {{ }}
    Cla1Regs.MVECT1 = (uint16_t)(&Cla1Task1);
    Cla1Regs.MVECT8 = (uint16_t)(&Cla1Task8);
    Cla1Regs.MIER.all = 0x00FF;
    DmaClaSrcSelRegs.CLA1TASKSRCSEL1.bit.TASK1 = CLA_TRIG_ADCAINT1;
    EDIS;
    for (;;) {{
        Wanted = 2.0f;
        Cla1ForceTask1andWait();
        Cla1ForceTask8();
        asm("  IACK  #0x0001");
        asm(" RPT#3||NOP");
        Kept = Given;
        Turns++;
        DELAY_US(1000);
    }}
}}
"""


def test_a_program_with_a_CLA_runs_without_its_tasks(tmp_path: Path) -> None:
    findings = checked(tmp_path, CLA)
    assert counted(findings) == []
    said = [finding.object for finding in findings if finding.rule == "unmodelled"]
    assert {"Cla1Regs.MVECT1", "Cla1Regs.MIFRC", "MemCfgRegs.MSGxINITDONE.INITDONE_CLA1TOCPU in a wait"} <= set(said)


def test_only_memory_that_another_processor_writes_has_a_value(tmp_path: Path) -> None:
    own = CLA.replace('"Cla1ToCpuMsgRAM"', '"ramls0"')
    assert [rule for rule, _ in counted(checked(tmp_path, own))] == ["uninitialised"]


def test_a_program_for_the_first_of_two_CPUs_runs(tmp_path: Path) -> None:
    text = f"""{HEAD}#include <string.h>
extern unsigned int secureRamFuncs_loadstart, secureRamFuncs_runstart, secureRamFuncs_loadsize;
extern Uint32 CpuFuncsLoadStart, CpuFuncsLoadEnd, CpuFuncsRunStart;
volatile unsigned Turns = 0;
void Move(Uint32 *from, Uint32 *end, Uint32 *to)
{{
    while (from < end)
        *to++ = *from++;
}}
void main(void)
{{
    memcpy(&secureRamFuncs_runstart, &secureRamFuncs_loadstart, (Uint32)&secureRamFuncs_loadsize);
    Move(&CpuFuncsLoadStart, &CpuFuncsLoadEnd, &CpuFuncsRunStart);
    {START}
    EALLOW;
    DevCfgRegs.CPUSEL5.bit.SCI_B = 1;
    DevCfgRegs.CPUSEL0.all = 0;
    CpuSysRegs.PCLKCR0.bit.GTBCLKSYNC = 1;
    EDIS;
    IpcRegs.IPCSET.bit.IPC17 = 1;
    while (IpcRegs.IPCSTS.bit.IPC17 == 0);
    for (;;) {{
        Turns++;
        DELAY_US(1000);
    }}
}}
"""
    findings = checked(tmp_path, text)
    assert counted(findings) == []
    objects = [finding.object for finding in findings if finding.rule == "unmodelled"]
    assert "DevCfgRegs.CPUSEL5.SCI_B" in objects
    assert "IpcRegs.IPCSTS.IPC17 in a wait" in objects


def encoder(comment: str) -> str:
    """SPI-A in mode 1, with GPIO61 as the select: that of the gyro on the robot."""
    return f"""{HEAD}// {comment}
volatile Uint16 Position = 0;
void main(void)
{{
    {START}
    GPIO_SetupPinMux(58, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(59, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(60, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(61, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(61, GPIO_OUTPUT, GPIO_PUSHPULL);
    GPIO_WritePin(61, 1);
    SpiaRegs.SPICCR.bit.SPISWRESET = 0;
    SpiaRegs.SPICCR.all = 0x0007;
    SpiaRegs.SPICTL.all = 0x0006;
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = 49;
    SpiaRegs.SPICTL.bit.CLK_PHASE = 0;
    SpiaRegs.SPICCR.bit.CLKPOLARITY = 0;
    SpiaRegs.SPICCR.bit.SPISWRESET = 1;
    for (;;) {{
        GPIO_WritePin(61, 0);
        SpiaRegs.SPITXBUF = 0x8F00;
        while (SpiaRegs.SPISTS.bit.INT_FLAG == 0) {{ }}
        Position = SpiaRegs.SPIRXBUF;
        GPIO_WritePin(61, 1);
        DELAY_US(1000);
    }}
}}
"""


@pytest.mark.parametrize(("comment", "named", "told"), [
    ("the encoder of the axis", False, False), ("the gyro", False, True), ("the encoder of the axis", True, True),
])  # fmt: skip
def test_what_a_program_selects_is_the_gyro_of_the_robot_only_if_it_says_so(
    tmp_path: Path, comment: str, named: bool, told: bool
) -> None:  # fmt: skip
    findings = checked(tmp_path, encoder(comment), named=named)
    assert "spi-mode" in {finding.rule for finding in findings}
    assert ("spi-mode" in {rule for rule, _ in counted(findings)}) is told


def test_a_slave_waits_for_its_master(tmp_path: Path) -> None:
    text = f"""{HEAD}Uint16 Received[4] = {{0}};
void main(void)
{{
    Uint16 i = 0;
    {START}
    SpibRegs.SPICCR.bit.SPISWRESET = 0;
    SpibRegs.SPICCR.bit.SPICHAR = 15;
    SpibRegs.SPICTL.bit.MASTER_SLAVE = 0;
    SpibRegs.SPICTL.bit.TALK = 1;
    SpibRegs.SPICCR.bit.SPISWRESET = 1;
    for (;;) {{
        while (SpibRegs.SPISTS.bit.INT_FLAG == 0) {{ }}
        Received[i] = SpibRegs.SPIRXBUF;
        i = (i + 1) & 3;
    }}
}}
"""
    assert counted(checked(tmp_path, text)) == []
    asleep = text.replace("    SpibRegs.SPICCR.bit.SPISWRESET = 1;\n", "")
    assert "endless-poll" in [rule for rule, _ in counted(checked(tmp_path, asleep))]


def test_something_drives_the_pin_of_a_trip_zone(tmp_path: Path) -> None:
    text = f"""{HEAD}volatile Uint16 Trips = 0;
__interrupt void tripped(void)
{{
    Trips++;
    EALLOW;
    EPwm2Regs.TZCLR.bit.CBC = 1;
    EPwm2Regs.TZCLR.bit.INT = 1;
    EDIS;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP2;
}}
void main(void)
{{
    {START}
    EALLOW;
    PieVectTable.EPWM2_TZ_INT = &tripped;
    InputXbarRegs.INPUT1SELECT = 12;
    EPwm2Regs.TZSEL.bit.CBC1 = 1;
    EPwm2Regs.TZEINT.bit.CBC = 1;
    EDIS;
    EPwm2Regs.TBPRD = 6000;
    EPwm2Regs.TBCTL.bit.CTRMODE = TB_COUNT_UPDOWN;
    IER |= M_INT2;
    PieCtrlRegs.PIEIER2.bit.INTx2 = 1;
    EINT;
    for (;;) {{ }}
}}
"""
    for named in (False, True):
        findings = checked(tmp_path, text, seconds=0.05, named=named)
        assert "interrupt-storm" in {finding.rule for finding in findings}
        assert ("interrupt-storm" in {rule for rule, _ in counted(findings)}) is named


def crystal(divider: int) -> str:
    """A crystal times 20, divided by 1 or 2: 200 MHz with 10 MHz, or with 20 MHz."""
    return f"""{HEAD}volatile Uint32 Ticks = 0;
interrupt void tick(void)
{{
    Ticks++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}}
void main(void)
{{
    EALLOW;
    WdRegs.WDCR.all = 0x68;
    ClkCfgRegs.CLKSRCCTL1.bit.OSCCLKSRCSEL = 1;
    ClkCfgRegs.SYSPLLCTL1.bit.PLLCLKEN = 0;
    ClkCfgRegs.SYSCLKDIVSEL.all = 0;
    ClkCfgRegs.SYSPLLMULT.all = 20;
    while (ClkCfgRegs.SYSPLLSTS.bit.LOCKS != 1);
    ClkCfgRegs.SYSPLLCTL1.bit.PLLCLKEN = 1;
    ClkCfgRegs.SYSCLKDIVSEL.all = {divider // 2};
    CpuTimer0Regs.PRD.all = 4999; // 20 kHz
    CpuTimer0Regs.TCR.bit.TIE = 1;
    CpuTimer0Regs.TCR.bit.TRB = 1;
    PieCtrlRegs.PIECTRL.bit.ENPIE = 1;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieVectTable.TIMER0_INT = &tick;
    EDIS;
    IER |= M_INT1;
    EINT;
    for (;;) {{ }}
}}
"""


@pytest.mark.parametrize(("divider", "told"), [(2, []), (1, ["stated-rate"])])
def test_a_crystal_can_be_half_as_fast_as_it_would_have_to_be(tmp_path: Path, divider: int, told: list[str]) -> None:
    # 10 MHz * 20 / 2 is 100 MHz, and 5000 cycles of it are 20 kHz; 20 MHz * 20 / 1 would be too fast for the chip.
    assert [rule for rule, _ in counted(checked(tmp_path, crystal(divider)))] == told


def test_a_step_down_that_wraps_ends_a_loop_with_an_upper_limit(tmp_path: Path) -> None:
    text = """unsigned long Total = 0;
void main(void)
{
    static const int v[5] = {1, 2, 3, 4, 5};
    unsigned i;
    for (i = 4; i < 5; i--)
        Total += v[i];
    for (;;) { }
}
"""
    assert counted(checked(tmp_path, text)) == []


def timers(then: str) -> str:
    """A program that switches the clocks of timers 1 and 2 off, and initialises the timers."""
    return f"""{HEAD}volatile unsigned Turns = 0;
void main(void)
{{
    {START}
    DisablePeripheralClocks();
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.CPUTIMER0 = 1;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    {then}
    for (;;) {{
        Turns++;
        DELAY_US(1000);
    }}
}}
"""


@pytest.mark.parametrize(("then", "told"), [("", False), ("ConfigCpuTimer(&CpuTimer1, 200, 1000);", True)])
def test_timers_that_nobody_uses_need_no_clock(tmp_path: Path, then: str, told: bool) -> None:
    rules = {rule for rule, _ in counted(checked(tmp_path, timers(then)))}
    assert rules == ({"clock-gated"} if told else set())
