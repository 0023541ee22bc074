"""Indices, flags and sums that `main` and an interrupt routine both write, and right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include "F28x_Project.h"
#define SIZE 16
volatile Uint16 in, out, ring[SIZE], Ready, Taken;
static void Put(Uint16 c)
{{
    ring[in] = c;
    in = (in + 1) % SIZE;
    {full}
}}
interrupt void Receives(void)
{{
    Put(SciaRegs.SCIRXBUF.all);
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}}
static Uint16 Take(void)
{{
    Uint16 c = ring[out], next = (out + 1) & (SIZE - 1);
    {step}
    return c;
}}
int main(void)
{{
    PieVectTable.SCIA_RX_INT = &Receives;
    EINT;
    for (;;)
    {{
        if (in != out) Taken = Take();
        {more}
    }}
}}
"""
FULL = "if (in == out) out = (out + 1) % SIZE;"
STEP = "out = (out + 1) % SIZE;"


def told(folder: Path, full: str, step: str, more: str = "") -> list[str]:
    """The lines at which `race` is told."""
    file = folder / "a.c"
    text = PROGRAM.format(full=full, step=step, more=more)
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "race"]


@pytest.mark.parametrize(
    ("full", "step"),
    [
        (FULL, STEP),
        (FULL, "out = next;"),
        (FULL, "out = (out + 1) & (SIZE - 1);"),
        ("if (in == out) out = 0;", STEP),
    ],
)
def test_an_index_that_both_sides_write_is_told(tmp_path: Path, full: str, step: str) -> None:
    assert told(tmp_path, full, step) == [step]


@pytest.mark.parametrize(
    ("full", "step", "more"),
    [
        ("", STEP, ""),
        (FULL, "DINT; out = (out + 1) % SIZE; EINT;", ""),
        (FULL, "PieCtrlRegs.PIEIER9.bit.INTx1 = 0; out = next; PieCtrlRegs.PIEIER9.bit.INTx1 = 1;", ""),
        (FULL, "out++;", ""),
        (FULL, "out = 0;", ""),
        # The routine waits for a flag of main.
        ("if (Ready) { out = 0; Ready = 0; }", STEP, "if (in == 9) Ready = 1;"),
    ],
)
def test_an_index_with_one_writer_or_a_mask_is_silent(tmp_path: Path, full: str, step: str, more: str) -> None:
    assert not told(tmp_path, full, step, more)


FLAGS = """#include "F28x_Project.h"
#define HIGH 1U
#define LOW 2U
#define LEAK 4U
typedef struct {{ Uint16 alarms, other; }} State;
volatile Uint32 Ms;
Uint16 Alarms, Over, Alive, Volts;
State Now;
static void Judge(Uint16 code)
{{
    if (code > 3000 && ++Over > 20) {{ {isr} }}
}}
interrupt void Sample(void)
{{
    Ms++;
    Judge(AdcaResultRegs.ADCRESULT0);
    Alive = 1;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}}
static Uint32 Time(void)
{{
    Uint32 now;
    {off} now = Ms; {on}
    return now;
}}
static void Watch(void)
{{
    Uint16 a;
    {main}
}}
int main(void)
{{
    PieVectTable.ADCA1_INT = &Sample;
    EINT;
    for (;;)
    {{
        while (!Alive) ;
        Alive = 0;
        Volts = AdcaResultRegs.ADCRESULT1;
        if (Time() > 100) Watch();
    }}
}}
"""
SETS = "Alarms |= HIGH;"
COMPUTES = "Alarms = (Alarms & ~LOW) | (Volts < 9 ? LOW : 0);"


def told_of_flags(folder: Path, isr: str, main: str, *, masks: bool = True) -> list[str]:
    """The lines at which `race` is told."""
    text = FLAGS.format(isr=isr, main=main, off="DINT;" * masks, on="EINT;" * masks)
    (folder / "a.c").write_text(text, encoding="utf-8")
    found = Build([str(folder / "a.c")]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "race"]


@pytest.mark.parametrize(("isr", "main"), [
    (SETS, COMPUTES),
    (SETS, "if (Volts < 9) Alarms = ~(~Alarms & ~LOW) & ~LEAK;"),
    ("Alarms &= ~HIGH;", "a = Alarms; a |= LOW; Alarms = a & 0xFF;"),
    (SETS, "a = Alarms; if (Volts < 9) a |= LOW; Alarms = a;"),
    ("Now.alarms |= HIGH;", "Now.alarms = (Now.alarms & ~LOW) | (Volts & LOW);"),
    (SETS, "DINT; a = Alarms; EINT; a &= ~LOW; Alarms = a;"),
    (SETS, "a = Alarms; Alarms = 0; Volts = a;"),
])  # fmt: skip
def test_flags_that_both_sides_change_are_told(tmp_path: Path, isr: str, main: str) -> None:
    assert told_of_flags(tmp_path, isr, main) == [main]


@pytest.mark.parametrize(("isr", "main", "masks"), [
    (SETS, "if (Volts < 9) Alarms |= LOW; else Alarms &= ~LOW;", True),
    (SETS, "DINT; " + COMPUTES + " EINT;", True),
    (SETS, "Alarms = 0;", True),
    (SETS, "a = Alarms; Over = a & HIGH;", True),
    # The routine writes it whole; only when main wants that; main may always be done in time: it masks nothing of it.
    ("Alarms = HIGH;", COMPUTES, True),
    ("if (Volts < 9) Alarms |= HIGH;", COMPUTES, True),
    (SETS, COMPUTES, False),
    (SETS, "DINT; Volts = 3; EINT; " + COMPUTES, False),
    (SETS, "DINT; a = Alarms; Alarms = 0; EINT; Volts = a;", True),
    (SETS, "if (Alarms & HIGH) Alarms = 0;", True),
    ("Alarms = HIGH;", "a = Alarms; Alarms = 0; Volts = a;", True),
    ("Alarms++;", "a = Alarms; Alarms = 0; Volts = a;", True),
    ("Now.other |= HIGH;", "Now.alarms = (Now.alarms & ~LOW) | (Volts & LOW);", True),
])  # fmt: skip
def test_flags_that_one_side_changes_at_a_time_are_silent(tmp_path: Path, isr: str, main: str, masks: bool) -> None:
    assert not told_of_flags(tmp_path, isr, main, masks=masks)


SUMS = """#include "F28x_Project.h"
volatile Uint32 Ms;
volatile float heading, speed, other;
volatile Uint16 Tick, Off;
static float wrap(float angle) {{ return angle > 180.0f ? angle - 360.0f : angle; }}
interrupt void Tock(void)
{{
    Ms++;
    Tick = 1;
    {isr}
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}}
static void Order(Uint16 c)
{{
    float a = c;
    {main}
}}
int main(void)
{{
    Uint32 last = 0;
    PieVectTable.TIMER0_INT = &Tock;
    EINT;
    for (;;)
    {{
        {wait}
        if (SciaRegs.SCIFFRX.bit.RXFFST) Order(SciaRegs.SCIRXBUF.all);
        {time}
    }}
}}
"""
STEPS = "if (SpiaRegs.SPIRXBUF) heading = wrap(heading + speed * 0.001f);"
ADDS = "heading = wrap(heading + a);"
TIME = "if (Ms - last >= 20) last = Ms;"


def told_of_sums(folder: Path, isr: str, main: str, wait: str = "", time: str = TIME) -> list[str]:
    """The lines at which `race` is told."""
    text = SUMS.format(isr=isr, main=main, wait=wait, time=time)
    (folder / "a.c").write_text(text, encoding="utf-8")
    found = Build([str(folder / "a.c")]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "race"]


@pytest.mark.parametrize(("isr", "main"), [
    (STEPS, ADDS),
    (STEPS, "heading += a;"),
    ("heading -= 0.5f;", "heading = a + heading;"),
    (STEPS, "if (a > 3) heading -= a; EINT;"),
])  # fmt: skip
def test_sums_that_both_sides_add_to_are_told(tmp_path: Path, isr: str, main: str) -> None:
    assert told_of_sums(tmp_path, isr, main) == [main]


@pytest.mark.parametrize(("isr", "main", "wait", "time"), [
    (STEPS, "DINT; " + ADDS + " EINT;", "", TIME),
    (STEPS, "__disable_interrupts(); " + ADDS + " __enable_interrupts();", "", TIME),
    (STEPS, "PieCtrlRegs.PIEIER1.bit.INTx7 = 0; " + ADDS + " PieCtrlRegs.PIEIER1.bit.INTx7 = 1;", "", TIME),
    (STEPS, "CpuTimer0Regs.TCR.bit.TIE = 0; " + ADDS + " CpuTimer0Regs.TCR.bit.TIE = 1;", "", TIME),
    (STEPS, 'asm(" setc INTM"); ' + ADDS + ' asm(" clrc INTM");', "", TIME),
    (STEPS, "IER &= ~1; " + ADDS + " IER |= 1;", "", TIME),
    # One side only adds: the other one writes it whole.
    (STEPS, "heading = a;", "", TIME),
    ("heading = speed;", ADDS, "", TIME),
    ("other += speed;", ADDS, "", TIME),
    ("heading += (speed - heading) * 0.1f;", ADDS, "", TIME),
    # The routine stands by when main says so; main is behind the routine; the routine may not come by itself.
    ("if (!Off) heading += speed;", "Off = 1; " + ADDS + " Off = 0;", "", TIME),
    (STEPS, ADDS, "while (!Tick) {} Tick = 0;", TIME),
    (STEPS, ADDS, "if (!Tick) continue; Tick = 0;", TIME),
    (STEPS, "if (Tick) { Tick = 0; heading += a; }", "", TIME),
    (STEPS, ADDS, "", "while (!Tick) {} Tick = 0;"),
    (STEPS, ADDS, "", ""),
])  # fmt: skip
def test_sums_that_one_side_changes_at_a_time_are_silent(
    tmp_path: Path, isr: str, main: str, wait: str, time: str
) -> None:  # fmt: skip
    assert not told_of_sums(tmp_path, isr, main, wait, time)
