"""Buffers that are filled anew while an interrupt routine may still send them, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include "F28x_Project.h"
#include <stdio.h>
#include <string.h>
char Text[40]; volatile Uint16 Next, Length, Order, Busy;
interrupt void Sends(void)
{{
    while (Next < Length && SciaRegs.SCIFFTX.bit.TXFFST < 16) SciaRegs.SCITXBUF.all = Text[Next++];
    if (Next >= Length) {{ Busy = 0; SciaRegs.SCIFFTX.bit.TXFFIENA = 0; }}
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}}
static int Free(void) {{ return Next >= Length; }}
static void Report(void)
{{
    if (Next < Length) return;
    sprintf(Text, "T=%d", (int)Order);
    Length = strlen(Text); Next = 0; SciaRegs.SCIFFTX.bit.TXFFIENA = 1;
}}
static void Obey(const char *line)
{{
    if (line[0] == 'S') {{
        {answer}
    }}
}}
void main(void)
{{
    for (;;)
    {{
        {turn}
    }}
}}
"""
GIVEN = {"turn": 'Report(); Obey("S");'}
FILL = 'sprintf(Text, "OK"); Length = strlen(Text); Next = 0; SciaRegs.SCIFFTX.bit.TXFFIENA = 1;'


def told(folder: Path, answer: str, **given: str) -> list[str]:
    """The lines at which `race` is told before the program runs."""
    file = folder / "a.c"
    text = PROGRAM.format(**{**GIVEN, "answer": answer, **given})
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "race"]


@pytest.mark.parametrize("answer", [FILL, FILL.replace('sprintf(Text, "OK")', 'strcpy(Text, "OK")')])
def test_a_buffer_that_is_filled_unasked_is_told(tmp_path: Path, answer: str) -> None:
    assert told(tmp_path, answer) == [answer]


@pytest.mark.parametrize(
    ("answer", "given"),
    [
        (f"if (Next >= Length) {{ {FILL} }}", {}),
        (f"if (Free()) {{ {FILL} }}", {}),
        (f"while (Next < Length) ; {FILL}", {}),
        (f"if (Busy) return; Busy = 1; {FILL}", {}),
        (f"if (SciaRegs.SCIFFTX.bit.TXFFIENA) return; {FILL}", {}),
        (FILL, {"turn": 'Report(); if (Free()) Obey("S");'}),
        (FILL, {"turn": 'Obey("S");'}),  # nobody asks: the lines may be far apart
        (f"DINT; {FILL} EINT;", {}),
        ('strcpy(Text, "OK"); Length = strlen(Text);', {}),  # not begun
    ],
)
def test_a_buffer_that_is_free_or_taken_away_is_silent(tmp_path: Path, answer: str, given: dict[str, str]) -> None:
    assert told(tmp_path, answer, **given) == []
