"""An index that only grows, in a routine that comes again and again; right twins beside it."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include "F28x_Project.h"
#define SIZE 8
volatile Uint16 head, tail, left = SIZE, ring[SIZE], taken; Uint16 next; int16 place;
void Off(void) {{ PieCtrlRegs.PIEIER1.bit.INTx7 = 0; }}
interrupt void Comes(void)
{{
    Uint16 c = SciaRegs.SCIRXBUF.all;
    {routine}
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}}
int main(void)
{{
    Uint16 i;
    PieVectTable.{vector} = &Comes;
    {start}
    EINT;
    for (;;)
    {{
        {loop}
    }}
}}
"""
TAKE = "while (tail != head) { taken = ring[tail]; tail = (tail + 1) & (SIZE - 1); }"


def told(folder: Path, routine: str, loop: str = "", start: str = "", vector: str = "TIMER0_INT") -> list[str]:
    """The lines at which `table-short` is told."""
    file = folder / "a.c"
    text = PROGRAM.format(routine=routine, loop=loop, start=start, vector=vector)
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "table-short"]


@pytest.mark.parametrize("step", ["head++;", "head += 1;", "head = head + 1;", "head += 2;"])
def test_an_index_that_a_routine_only_counts_up(tmp_path: Path, step: str) -> None:
    routine = f"ring[head] = c;\n{step}"
    assert told(tmp_path, routine) == ["ring[head] = c;"]
    assert told(tmp_path, routine, start="head = 3;") == ["ring[head] = c;"]


@pytest.mark.parametrize(("routine", "line"), [
    ("ring[head++] = c;", "ring[head++] = c;"),
    ("ring[place] = c;\nplace++;", "ring[place] = c;"),
    ("Uint16 n = head + 1;\nif (n != tail) {\nring[head] = c;\nhead = n; } else taken++;", "ring[head] = c;"),
    ("if (SciaRegs.SCIRXST.bit.RXERROR == 0) {\nring[head] = c;\nhead++; }", "ring[head] = c;"),
    ("if (c == 13) taken++; else {\nring[head] = c;\nhead++; }", "ring[head] = c;"),
])  # fmt: skip
def test_forms_of_the_step_and_of_tests_that_limit_nothing(tmp_path: Path, routine: str, line: str) -> None:
    assert told(tmp_path, routine, TAKE if "tail" in routine else "", vector="SCIA_RX_INT") == [line]


def test_the_last_loop_of_main_comes_again_too(tmp_path: Path) -> None:
    assert told(tmp_path, "taken++;", "ring[head] = AdcaResultRegs.ADCRESULT0;\nhead++;") == [
        "ring[head] = AdcaResultRegs.ADCRESULT0;"
    ]


GROWS = "ring[head] = c; head++;"


@pytest.mark.parametrize(("routine", "loop", "start", "vector"), [
    # Compared and set back, here or in main; masked here or where it is used.
    ("ring[head] = c; head++; if (head >= SIZE) head = 0;", "", "", "TIMER0_INT"),
    ("ring[head] = c; if (++head == SIZE) head = 0;", "", "", "TIMER0_INT"),
    (GROWS, "if (head == SIZE) { head = 0; }", "", "TIMER0_INT"),
    (GROWS, "DELAY_US(10); head = 0;", "", "TIMER0_INT"),
    ("ring[head & (SIZE - 1)] = c; head++;", "", "", "TIMER0_INT"),
    ("ring[head] = c; head = (head + 1) % SIZE;", "", "", "TIMER0_INT"),
    ("ring[head] = c; head++; head &= SIZE - 1;", "", "", "TIMER0_INT"),
    ("if (head < SIZE) { ring[head] = c; head++; }", "", "", "TIMER0_INT"),
    ("if (head >= SIZE) return; ring[head] = c; head++;", "", "", "TIMER0_INT"),
    ("Uint16 n = head; if (n < SIZE) { ring[n] = c; head = n + 1; }", "", "", "TIMER0_INT"),
    # Start-up that runs once, with a bounded loop.
    ("taken++;", "", "for (i = 0; i < SIZE; i++) { ring[head] = i; head++; }", "TIMER0_INT"),
    # Another object limits it: a count, a flag, the other end of the ring.
    ("if (left == 0) return; left--; ring[head] = c; head++;", "", "", "TIMER0_INT"),
    ("if (taken) { ring[head] = c; head++; }", "", "", "TIMER0_INT"),
    ("Uint16 full = left == 0; if (!full) { ring[head] = c; head++; left--; }", "", "", "TIMER0_INT"),
    ("if (head != tail) { ring[head] = c; head++; }", "tail = next;", "", "TIMER0_INT"),
    (GROWS, "if (head == tail) { Off(); }", "", "TIMER0_INT"),
    # Something else reads it, or may set it.
    (GROWS, "next = head;", "", "TIMER0_INT"),
    (GROWS, "volatile Uint16 *p = &head; *p = 0;", "", "TIMER0_INT"),
    # The interrupt ends, or comes only for what the program asks.
    (GROWS + " Off();", "", "", "TIMER0_INT"),
    (GROWS, "if (taken) PieCtrlRegs.PIEIER1.bit.INTx7 = 0;", "", "TIMER0_INT"),
    (GROWS, "", "", "I2CA_INT"),
    (GROWS, "", "", "ADCA1_INT"),
])  # fmt: skip
def test_an_index_that_something_may_limit_is_not_told(
    tmp_path: Path, routine: str, loop: str, start: str, vector: str
) -> None:
    assert told(tmp_path, routine, loop, start, vector) == []
