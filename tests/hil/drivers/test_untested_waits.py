"""Waits with a time-out for what an interrupt brings: what follows must not go on as if it had come."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Task.h>
#include "F28x_Project.h"

typedef struct { Uint16 value, number; UInt32 tick; } Sample;
static struct { Semaphore_Handle came; } Link;
static volatile Sample Latest = { 0, 0, 0 };
static int32 Charge = 0;
static Uint16 Lost = 0, Turns = 0;

static void On_Period(UArg unused)
{
    Latest.value = EPwm1Regs.TBCTR;
    Latest.number++;
    Latest.tick = Clock_getTicks();
    EPwm1Regs.ETCLR.bit.INT = 1;
    Semaphore_post(Link.came);
}

static Bool Take(Uint16 *value)
{
    Semaphore_reset(Link.came, 0);
    EPwm1Regs.ETSEL.bit.INTEN = 1;
    TAKE
    *value = EPwm1Regs.TBPRD;
    return TRUE;
}

static void Work(UArg a, UArg b)
{
    Uint16 value = 0, last = 0;

    for (;;) {
        BODY
    }
}

Int main(void)
{
    InitSysCtrl();
    Link.came = Semaphore_create(0, NULL, NULL);
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    EDIS;
    EPwm1Regs.TBPRD = 10000;
    EPwm1Regs.TBCTL.bit.CTRMODE = 0;
    EPwm1Regs.ETSEL.bit.INTSEL = 1;
    EPwm1Regs.ETPS.bit.INTPRD = 1;
    EPwm1Regs.ETSEL.bit.INTEN = 1;
    Hwi_create(48, On_Period, NULL, NULL);
    Task_create(Work, NULL, NULL);
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    BIOS_start();
    return 0;
}
"""
PEND = "Semaphore_pend(Link.came, 50);"
CHECKED = f"if (!{PEND[:-1]}) return FALSE;"
TAKES = "if (Take(&value)) Charge += value; else Lost++;"


@pytest.mark.parametrize(("take", "body", "used"), [
    (CHECKED, f"{PEND} value = Latest.value; Charge += value;", "uses Latest again"),
    (CHECKED, f"{PEND} value = Latest.value; if (value > 9000) Lost++; Charge += value;", "uses Latest again"),
    (PEND, TAKES, "goes on without it"),
    # The result, a count, an age or a flag is asked for; a wait for ever; the result of which no use is meant.
    (CHECKED, TAKES, ""),
    (CHECKED, f"if ({PEND[:-1]}) Charge += Latest.value; else Lost++;", ""),
    (CHECKED, f"{PEND} value = Latest.number; if (value == last) continue; last = value; Charge += Latest.value;", ""),
    (CHECKED, f"{PEND} if (Clock_getTicks() - Latest.tick > 20) Lost++; else Charge += Latest.value;", ""),
    (CHECKED, "Semaphore_pend(Link.came, BIOS_WAIT_FOREVER); Charge += Latest.value;", ""),
    (CHECKED, f"(void){PEND} Charge += Latest.value;", ""),
    # The pace of a loop: what follows needs no interrupt, or waits for something else first.
    (CHECKED, f"{PEND} Turns++;", ""),
    (CHECKED, f"{PEND} Task_sleep(3); Charge += Latest.value;", ""),
])  # fmt: skip
def test_a_wait_whose_result_nothing_tests(tmp_path: Path, take: str, body: str, used: str) -> None:
    file = tmp_path / "link.c"
    text = PROGRAM.replace("TAKE", take).replace("BODY", body)
    file.write_text(text, encoding="utf-8")
    found = [f for f in check_files(DriverFiles([file], seconds=0.02, calls=1)).findings if f.rule == "wait-untested"]
    assert [used in f.message for f in found] == ([True] if used else [])
    for finding in found:
        assert finding.object == "Link.came"
        assert finding.place is not None
        assert PEND in text.splitlines()[finding.place.line - 1]


#: A sender that is never silent, and a task that uses what it sends.
MESSAGES = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Mailbox.h>
#include <ti/sysbios/knl/Task.h>
typedef struct { UInt value, number; } Sample;
static Mailbox_Handle box;
static UInt32 sum = 0;
static UInt last = 0;
static Void Send(UArg a, UArg b)
{
    Sample sample = { 3, 0 };
    for (;;) { sample.number++; Mailbox_post(box, &sample, BIOS_NO_WAIT); Task_sleep(1); }
}
static Void Take(UArg a, UArg b)
{
    DECLARED
    for (;;) { BODY }
}
Int main(void)
{
    box = Mailbox_create(sizeof(Sample), 4, NULL, NULL);
    Task_create(Send, NULL, NULL);
    Task_create(Take, NULL, NULL);
    BIOS_start();
    return 0;
}
"""
GETS = "Mailbox_pend(box, &m, 50);"


@pytest.mark.parametrize(("declared", "body", "rule"), [
    ("Sample m;", f"{GETS} sum += m.value;", "timeout-ignored"),  # garbage after the first time-out
    ("Sample m;", f"{GETS} if (m.number != last) sum += m.value; last = m.number;", "timeout-ignored"),
    ("Sample m = { 0, 0 };", f"{GETS} sum += m.value;", "wait-untested"),
    ("static Sample m = { 0, 0 };", f"{GETS} sum += m.value;", "wait-untested"),
    ("Sample m; Mailbox_pend(box, &m, BIOS_WAIT_FOREVER);", f"{GETS} sum += m.value;", "wait-untested"),
    # The result is asked for; the message tells it; no use of the result is meant; nothing uses the message.
    ("Sample m;", f"if ({GETS[:-1]}) sum += m.value;", ""),
    ("Sample m = { 0, 0 };", f"{GETS} if (m.number != last) sum += m.value; last = m.number;", ""),
    ("Sample m;", f"m.value = 0; {GETS} sum += m.value;", ""),
    ("Sample m;", f"(void){GETS} sum += m.value;", ""),
    ("Sample m;", f"{GETS} sum++;", ""),
    ("Sample m;", "Mailbox_pend(box, &m, BIOS_WAIT_FOREVER); sum += m.value;", ""),
])  # fmt: skip
def test_a_message_that_nothing_tests(tmp_path: Path, declared: str, body: str, rule: str) -> None:
    file = tmp_path / "box.c"
    file.write_text(MESSAGES.replace("DECLARED", declared).replace("BODY", body), encoding="utf-8")
    found = check_files(DriverFiles([file], seconds=0.02, calls=1)).findings
    assert [f.rule for f in found if f.rule in ("timeout-ignored", "wait-untested")] == ([rule] if rule else [])
