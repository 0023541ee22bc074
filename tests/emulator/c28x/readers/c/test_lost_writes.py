"""Indices that `main` and an interrupt routine both write, and right twins."""

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
