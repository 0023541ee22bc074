"""Times of an eCAP that are taken for the width of a pulse and are none, and programs that are right."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
#define ECAP1_BASE 0x5000UL
volatile Uint32 echoTicks, ticks, period, start, stop, last, pulse_length, pulse_us;
volatile Uint16 low;
// As those of TI's driverlib, which reach the registers by address.
static Uint32 ECAP_getEventTimeStamp(Uint32 base, Uint16 event) {{ return *(volatile Uint32 *)(base + 4 + 2 * event); }}
static void ECAP_setEventPolarity(Uint32 base, Uint16 event, Uint16 polarity)
{{
    volatile Uint16 *control = (volatile Uint16 *)(base + 0x14);
    *control = (*control & ~(1u << (2 * event))) | (polarity << (2 * event));
}}
static void onEcho(Uint32 stamp) {{ ticks = stamp - last; last = stamp; }}
static void show(Uint32 ancho) {{ ticks = ancho / 200; }}
void main(void)
{{
    InitSysCtrl();
    DINT;
    EALLOW;
    CpuSysRegs.PCLKCR3.bit.ECAP1 = 1;
    EDIS;
    ECap1Regs.ECCTL1.all = 0;
    {first}
    {second}
    ECap1Regs.ECCTL1.bit.CTRRST1 = {reset};
    ECap1Regs.ECCTL1.bit.CAPLDEN = 1;
    ECap1Regs.ECCTL2.bit.STOP_WRAP = 1;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 1;
    {then}
    for (;;) {{
        if (ECap1Regs.ECFLG.bit.CEVT2) {{
            ECap1Regs.ECCLR.bit.CEVT2 = 1;
            {use}
        }}
        DELAY_US(100);
    }}
}}
"""
FIRST = "ECap1Regs.ECCTL1.bit.CAP1POL = 0;"
SECOND = "ECap1Regs.ECCTL1.bit.CAP2POL = 0;"
FALLING = "ECap1Regs.ECCTL1.bit.CAP2POL = 1;"
CAP2 = "echoTicks = ECap1Regs.CAP2;"


def told(
    folder: Path, use: str, *, first: str = FIRST, second: str = SECOND, reset: int = 1, then: str = ""
) -> list[tuple[str, str]]:
    """Statement and message of each `capture-edge`."""
    file = folder / "sonar.c"
    text = PROGRAM.format(use=use, first=first, second=second, reset=reset, then=then)
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    lines = text.splitlines()
    return [
        (lines[f.place.line - 1].strip(), f.message) for f in found if f.rule == "capture-edge" and f.place is not None
    ]  # fmt: skip


def same(name: str, edge: str = "rising") -> str:
    """The message about two events that are the same edge."""
    return (
        f"CAP1 and CAP2 of ECap1 capture the same edge: {name} is a width by its name, and gets the time from one "
        f"{edge} edge to the next, a period"
    )


@pytest.mark.parametrize(("use", "given", "statement", "message"), [
    (CAP2, {}, SECOND, same("echoTicks")),
    ("echoTicks = ECap1Regs.CAP2 - ECap1Regs.CAP1;", {"reset": 0}, SECOND, same("echoTicks")),
    ("pulse_length = ECap1Regs.CAP2;", {"first": FIRST.replace("0", "1"), "second": FALLING}, FALLING,
     same("pulse_length", "falling")),
    # By copies, to a parameter, with what the registers have after reset, by driverlib.
    ("start = ECap1Regs.CAP1; stop = ECap1Regs.CAP2; show(stop - start);", {"reset": 0}, SECOND, same("ancho")),
    (CAP2, {"first": "", "second": ""}, CAP2, same("echoTicks")),
    ("echoTicks = ECAP_getEventTimeStamp(ECAP1_BASE, 1);",
     {"second": "ECAP_setEventPolarity(ECAP1_BASE, 1, 0);"}, "ECAP_setEventPolarity(ECAP1_BASE, 1, 0);",
     same("echoTicks")),
    # By a comment, whatever the names are.
    ("ticks = ECap1Regs.CAP2;", {"second": f"{SECOND}  // bajada"}, f"{SECOND}  // bajada",
     "CAP2POL is 0, a rising edge, and the comment 'bajada' says a falling one: the program takes the time from one "
     "rising edge to the next, a period"),
    ("ticks = ECap1Regs.CAP2;", {"first": f"{FIRST.replace('0', '1')}  // steigende Flanke", "second": FALLING},
     f"{FIRST.replace('0', '1')}  // steigende Flanke",
     "CAP1POL is 1, a falling edge, and the comment 'steigende Flanke' says a rising one: the program takes the time "
     "from one falling edge to the next, a period"),
])  # fmt: skip
def test_a_period_for_a_width_is_told(
    tmp_path: Path, use: str, given: dict[str, object], statement: str, message: str
) -> None:
    assert told(tmp_path, use, **given) == [(statement, message)]  # type: ignore[arg-type]


@pytest.mark.parametrize(("use", "name"), [
    (CAP2, "echoTicks"), ("show(ECap1Regs.CAP2);", "ancho"), ("stop = ECap1Regs.CAP2; echoTicks = stop;", "echoTicks"),
])  # fmt: skip
def test_a_stamp_for_a_width_is_told(tmp_path: Path, use: str, name: str) -> None:
    assert told(tmp_path, use, second=FALLING, reset=0) == [(
        use,
        f"{name} is a width by its name, and gets CAP2 of ECap1, the count since the counter began: no event resets it "
        "(CTRRST1), and nothing is subtracted",
    )]  # fmt: skip


@pytest.mark.parametrize(("use", "given"), [
    # A width.
    (CAP2, {"second": f"{FALLING}  // falling"}),
    ("echoTicks = ECap1Regs.CAP2 - ECap1Regs.CAP1;", {"second": FALLING, "reset": 0}),
    # A period, by its name, or without a name; a comment that says both, or what is not so.
    ("period = ECap1Regs.CAP2;", {}), ("ticks = ECap1Regs.CAP2; pulse_us = ECap1Regs.CAP2 / 200;", {}),
    ("ticks = ECap1Regs.CAP2;", {"second": f"{SECOND}  // rising, not falling"}),
    # The third event; edges that change; a prescaler; another counter than the eCAP's own.
    (f"{CAP2} period = ECap1Regs.CAP3;", {}),
    (f"{CAP2} ECap1Regs.ECCTL1.bit.CAP2POL ^= 1;", {"second": ""}),
    (f"{FALLING} DELAY_US(10); {SECOND} {CAP2}", {}),
    ("ECAP_setEventPolarity(ECAP1_BASE, 1, low); echoTicks = ECap1Regs.CAP2;", {}),
    (CAP2, {"then": "ECap1Regs.ECCTL1.bit.PRESCALE = 1;"}), (CAP2, {"then": "ECap1Regs.ECCTL2.bit.CAP_APWM = 1;"}),
    # Stamps that the program subtracts, also in a function; a counter that it sets.
    ("echoTicks = ECap1Regs.CAP2; ticks = echoTicks - last; last = echoTicks;", {"second": FALLING, "reset": 0}),
    ("onEcho(ECap1Regs.CAP2);", {"second": FALLING, "reset": 0}),
    ("echoTicks = ECap1Regs.CAP2; start = ECap1Regs.CAP1;", {"second": FALLING, "reset": 0}),
    (f"{CAP2} ECap1Regs.TSCTR = 0;", {"second": FALLING, "reset": 0}),
])  # fmt: skip
def test_what_can_be_meant_is_not_told(tmp_path: Path, use: str, given: dict[str, object]) -> None:
    assert told(tmp_path, use, **given) == []  # type: ignore[arg-type]
