"""What is not connected in a program that reaches its registers through pointers, structures and tables."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files
from tests.emulator.drivers import START_UP

#: `@` and a word is a link of a chain: see `LINKS`.
PROGRAM = """#include "F28x_Project.h"
struct channel { volatile struct EPWM_REGS *r; float share; };
struct lamp { Uint16 pin; Uint16 phase; };
static struct channel Channels[2] = {{&EPwm1Regs, 0.3f}, {&EPwm2Regs, 0.6f}};
static const struct lamp Lamps[2] = {{12, 1}, {13, 3}};
static volatile Uint16 *const Loads = &EPwm2Regs.CMPCTL.all;
static volatile Uint16 Order = 0, Round = 0, Beats = 0, Value = 0;
static __interrupt void beat(void)
{
    Beats++;
    EPwm1Regs.ETCLR.all = 1;
    PieCtrlRegs.PIEACK.all = 1 << 2;
}
static void enable(volatile Uint16 *line, Uint16 number) { *line |= 1u << (number - 1); }
static void set(struct channel *c, float share) { c->r->@COMPARE = (Uint32)(share * 1000.0f) << 16; }
static void light(const struct lamp *l)
{
    Uint32 mask = 1ul << l->pin;
    if (Round & l->phase)
        GpioDataRegs.GPASET.all = mask;
    else
        GpioDataRegs.GPACLEAR.all = mask;
}
static Uint16 measure(void)
{
    Uint16 tries = 2000;
    AdcbRegs.ADCSOCFRC1.all = 1u << 4;
    while (--tries)
        if (AdcbRegs.ADCINTFLG.all & 2u) {
            AdcbRegs.ADCINTFLGCLR.all = 2u;
            break;
        }
    return AdcbResultRegs.ADCRESULT4;
}
void main(void)
{
    int i;
""" + START_UP + """    EALLOW;
    PieVectTable.EPWM1_INT = &beat;
    CpuSysRegs.PCLKCR2.all |= 3;
    CpuSysRegs.PCLKCR13.bit.ADC_B = 1;
    AdcbRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcbRegs.ADCCTL1.all = 0x84;
    DELAY_US(1000);
    AdcbRegs.ADCSOC4CTL.all = 2ul << 15 | 19;
    AdcbRegs.ADCINTSEL1N2.all = (0x20u | @SOC) << 8;
    GpioCtrlRegs.GPADIR.all |= 1ul << 12 | 1ul << 13;
    EDIS;
    InitEPwm1Gpio();
    InitEPwm2Gpio();
    for (i = 0; i < 2; i++) {
        Channels[i].r->TBPRD = 1000;
        Channels[i].r->CMPA.bit.CMPA = 500;
        Channels[i].r->AQCTLA.all = 0x0012;
        Channels[i].r->TBCTL.all = 0;
    }
    *Loads = @MODE;
    EPwm1Regs.ETSEL.all = 0x0009;
    EPwm1Regs.ETPS.all = 1;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    IER |= M_INT3;
    EINT;
    for (;;) {
        if (Order)
            enable(&PieCtrlRegs.PIEIER3.all, 1);
        for (i = 0; i < 2; i++) {
            set(&Channels[i], Channels[i].share * (0.8f + 0.1f * (Round & 1)));
            light(&Lamps[i]);
        }
        Round++;
        Value = measure();
        DELAY_US(100);
    }
}
"""
#: Word of the program -> what is right, what is wrong, and objects of the findings.
LINKS = {
    "@COMPARE": ("CMPA.all", "CMPB.all", {"EPwm1Regs.AQCTLB", "EPwm2Regs.AQCTLB"}),
    "@SOC": ("4", "5", {"AdcbRegs.ADCINTFLG.ADCINT2"}),
    "@MODE": ("0x0000", "0x0003", {"EPwm2Regs.CMPCTL.LOADAMODE"}),
}


@pytest.mark.parametrize("wrong", [False, True])
def test_links_that_are_missing_are_told_through_pointers_too(tmp_path: Path, wrong: bool) -> None:
    """And a line that an order would enable through a pointer is not."""
    text = PROGRAM
    for word, ways in LINKS.items():
        text = text.replace(word, ways[wrong])
    file = tmp_path / "by_pointers.c"
    file.write_text(text)
    found = [f for f in check_files(DriverFiles([file], seconds=0.01)).findings if f.rule == "not-connected"]
    assert {f.object for f in found} == (set().union(*(objects for *_, objects in LINKS.values())) if wrong else set())


#: As driverlib's function, which asks for the compare by `||`.
LOAD_MODE = """#include <stdint.h>
#define HWREGH(x) (*((volatile uint16_t *)(uintptr_t)(x)))
typedef enum { COMPARE_A = 0, COMPARE_B = 5, COMPARE_C = 2, COMPARE_D = 7 } Compare;
static inline void loadMode(uint32_t base, Compare compare, uint16_t mode)
{
    uint16_t sync, load, shadow;
    uint32_t at;
    if ((compare == COMPARE_A) || (compare == COMPARE_C)) {
        sync = 10U;
        load = 0U;
        shadow = 4U;
    } else {
        sync = 12U;
        load = 2U;
        shadow = 6U;
    }
    if (!(compare == COMPARE_A || compare == COMPARE_B) && compare != 0)
        at = base + 0x09U;
    else
        at = base + 0x08U;
    HWREGH(at) = ((HWREGH(at) & ~((0x3U << sync) | (0x3U << load) | (0x1U << shadow)))
                  | (((mode >> 2U) << sync) | ((mode & 0x3U) << load)));
}
"""


@pytest.mark.parametrize(("call", "frozen"), [
    ("loadMode(0x4100U, COMPARE_A, 3U)", True),
    ("loadMode(0x4100U, COMPARE_A, 0U)", False),
    ("loadMode(0x4100U, COMPARE_A, 2U)", False),
    ("loadMode(0x4100U, COMPARE_A, 6U)", False),   # loads at a synchronisation, too
    ("loadMode(0x4100U, COMPARE_B, 3U)", False),   # no statement writes CMPB
    ("loadMode(0x4100U, COMPARE_C, 3U)", False),
    ("loadMode(0x4100U, COMPARE_A, 3U); if (Order) loadMode(0x4100U, COMPARE_A, 0U)", False),
])  # fmt: skip
def test_a_frozen_compare_is_told_through_driverlib(tmp_path: Path, call: str, *, frozen: bool) -> None:
    text = PROGRAM
    for word, ways in LINKS.items():
        text = text.replace(word, ways[False])
    text = text.replace("*Loads = 0x0000;", f"{call};")
    text = text.replace('_Project.h"\n', '_Project.h"\n#include "load_mode.h"\n')
    text = text.replace("static volatile Uint16 *const Loads = &EPwm2Regs.CMPCTL.all;\n", "")
    (tmp_path / "load_mode.h").write_text(LOAD_MODE, encoding="utf-8")
    file = tmp_path / "by_pointers.c"
    file.write_text(text)
    found = [f.object for f in check_files(DriverFiles([file], seconds=0.01)).findings if f.rule == "not-connected"]
    assert found == (["EPwm2Regs.CMPCTL.LOADAMODE"] if frozen else [])
