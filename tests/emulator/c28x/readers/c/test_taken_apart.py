"""Counts and pairs of an interrupt routine that a driver, or `main`, does not use under one mask; and right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

DRIVER = """#include "F28x_Project.h"
static volatile Uint32 sum = 0, seconds = 0;
static volatile Uint16 count = 0, ms = 0, ready = 0, hold = 0;
static volatile int32 way = 0, place = 0;
interrupt void Ticks(void)
{
    if (++ms >= 1000) { ms = 0; seconds++; }
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}
interrupt void Samples(void)
{
    place += EQep1Regs.QPOSLAT;
    way += EQep1Regs.QPOSLAT;
    if (count < 60000) { sum += AdcaResultRegs.ADCRESULT0; count++; }
    /* MORE */
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}
int32 Place(void) { int32 p; DINT; p = place; EINT; return p; }
"""
#: The same, as a whole program whose loop calls the function.
LOOP = "volatile Uint32 Seen;\nint main(void)\n{\n    for (;;) Seen = Get() + Place();\n}\n"


def told(folder: Path, function: str, more: str = "", loop: str = "", rule: str = "race") -> list[str]:
    """The lines of the function at which a rule is told."""
    file = folder / "a.c"
    text = DRIVER.replace("/* MORE */", more) + function + "\n" + loop
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == rule]


@pytest.mark.parametrize("loop", ["", LOOP])
@pytest.mark.parametrize(
    ("body", "line"),
    [
        ("int32 w;\nw = way;\nway = 0;\nreturn w;", "way = 0;"),
        ("int32 w = way;\nway = 0L;\nreturn w;", "way = 0L;"),
        ("Uint16 n;\nDINT;\nn = count;\nEINT;\ncount = 0;\nreturn n;", "count = 0;"),
        ("Uint16 n;\nn = count;\nDINT;\ncount = 0;\nEINT;\nreturn n;", "n = count;"),
        ("Uint16 n, s = __disable_interrupts();\nn = count;\n__restore_interrupts(s);\ncount = 0;\nreturn n;",
         "count = 0;"),
        ("return seconds * 1000 + ms;", "return seconds * 1000 + ms;"),
        ("return 1000UL * seconds + ms;", "return 1000UL * seconds + ms;"),
        ("Uint32 s = seconds;\nUint16 m = ms;\nreturn s * 1000 + m;", "Uint32 s = seconds;"),
        ("Uint32 s;\nDINT;\ns = seconds;\nEINT;\nreturn s * 1000 + ms;", "return s * 1000 + ms;"),
    ],
)  # fmt: skip
def test_wrong(tmp_path: Path, body: str, line: str, loop: str) -> None:
    function = "Uint32 Get(void)\n{\n" + body + "\n}"
    assert told(tmp_path, function, loop=loop) == [line]


@pytest.mark.parametrize("loop", ["", LOOP])
@pytest.mark.parametrize(
    "body",
    [
        "int32 w; DINT; w = way; way = 0; EINT; return w;",
        "int32 w; Uint16 s = __disable_interrupts(); w = way; way = 0; __restore_interrupts(s); return w;",
        "int32 w; IER &= ~M_INT1; w = way; way = 0; IER |= M_INT1; return w;",
        "Uint32 w = 0; DINT; if (count == 0) { EINT; return 0; } w = sum / count; sum = 0; count = 0; EINT; return w;",
        "int32 w = way; way -= w; return w;",
        "Uint32 s; Uint16 m; do { s = seconds; m = ms; } while (s != seconds); return s * 1000 + m;",
        "Uint32 t; DINT; t = seconds * 1000 + ms; EINT; return t;",
        "return seconds;",
        "Uint32 s; Uint16 m; DINT; s = seconds; m = ms; EINT; return s * 1000 + m;",
    ],
)
def test_right(tmp_path: Path, body: str, loop: str) -> None:
    assert told(tmp_path, "Uint32 Get(void) { " + body + " }", loop=loop) == []


@pytest.mark.parametrize(
    "function",
    [
        "static void Off(void) { DINT; }\nstatic void On(void) { EINT; }\n"
        "int32 Get(void) { int32 w; Off(); w = way; way = 0; On(); return w; }",
        "/* Only with the interrupts off. */\nint32 Get(void) { int32 w = way; way = 0; return w; }",
        "/* For the routines\n * of the application, in its ISR. */\nint32 Get(void)\n"
        "{ int32 w = way; way = 0; return w; }",
        "int32 Get_Isr(void) { int32 w = way; way = 0; return w; }",
        "int32 Way_Init(void) { int32 w = way; way = 0; return w; }",
        "static int32 Get(void) { int32 w = way; way = 0; return w; }\n"
        "int32 All(void) { int32 w; DINT; w = Get(); EINT; return w; }",
    ],
)
def test_a_driver_whose_caller_masks_is_silent(tmp_path: Path, function: str) -> None:
    assert told(tmp_path, function) == []


@pytest.mark.parametrize(
    ("function", "more"),
    [
        # The routine counts only while the loop lets it.
        ("int32 Get(void) { int32 w; hold = 1; w = ms; ready = 0; hold = 0; return w; }", "if (!hold) ready++;"),
        # The loop goes in step with the routine.
        ("int32 Get(void) { int32 w; if (!ready) return 0; ready = 0; w = way; way = 0; return w; }", "ready = 1;"),
    ],
)
def test_a_routine_that_may_not_come_is_silent(tmp_path: Path, function: str, more: str) -> None:
    assert told(tmp_path, function, more) == []


def test_no_function_masks_anything(tmp_path: Path) -> None:
    file = tmp_path / "a.c"
    text = DRIVER.replace("DINT; p = place; EINT;", "p = place;")
    file.write_text(text + "int32 Get(void) { int32 w = way; way = 0; return w; }\n", encoding="utf-8")
    assert not [f for f in Build([str(file)]).compiled.findings if f.rule == "race"]


RING = """#include "F28x_Project.h"
static volatile char ring[64];
static volatile Uint16 in = 0, out = 0;
interrupt void Sends(void)
{
    while (SciaRegs.SCIFFTX.bit.TXFFST < 16 && out != in) {
        SciaRegs.SCITXBUF.all = ring[out];
        out = (out + 1) & 63;
    }
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
void Put(char c)
{
    /* HERE */
}
"""


@pytest.mark.parametrize(
    ("body", "wrong"),
    [
        ("ring[in] = c; in = (in + 1) & 63;", False),
        ("in = (in + 1) & 63; ring[(in - 1) & 63] = c;", True),
        ("DINT; in = (in + 1) & 63; ring[(in - 1) & 63] = c; EINT;", False),
        ("SciaRegs.SCIFFTX.bit.TXFFIENA = 0; in = (in + 1) & 63; ring[(in - 1) & 63] = c; "
         "SciaRegs.SCIFFTX.bit.TXFFIENA = 1;", False),
        ("if (in == out) { in = (in + 1) & 63; ring[(in - 1) & 63] = c; }", False),
    ],
)  # fmt: skip
def test_elements_of_a_driver(tmp_path: Path, body: str, wrong: bool) -> None:
    file = tmp_path / "a.c"
    file.write_text(RING.replace("/* HERE */", body), encoding="utf-8")
    found = [f.rule for f in Build([str(file)]).compiled.findings if f.rule == "published-early"]
    assert found == ["published-early"] * wrong
