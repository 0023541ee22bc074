"""Numbers that a program sends as text, made character by character."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
static int16 flow = 0;
static void Put(char c)
{{
    while (!SciaRegs.SCICTL2.bit.TXRDY)
        ;
    SciaRegs.SCITXBUF.all = c;
}}
static void Number(int16 v)
{{
    if (v < 0) {{
        Put('-');
        v = -v;
    }}
    if (v >= 10)
        Number(v / 10);
    Put('0' + v % 10);
}}
void main(void)
{{
    InitSysCtrl();
    GPIO_SetupPinMux(84, GPIO_MUX_CPU1, 5);
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCICTL1.all = 0x0022;
    for (flow = -23; flow < 30; flow += 7) {{
        {send}
        Put(' ');
    }}
}}
"""


@pytest.mark.parametrize(
    ("send", "told"),
    [
        ("Number(flow / 10); Put('.'); Number(flow % 10);", True),
        ("Number(flow / 10); Put('.'); Number(flow < 0 ? -(flow % 10) : flow % 10);", False),
        ("Put('0'); Put('.'); Put('-'); Put('3');", False),  # a fixed text
        ("Put('1'); Put('.'); Number(flow);", False),  # two numbers
    ],
)
def test_a_number_that_is_sent_with_a_sign_behind_its_point(tmp_path: Path, send: str, *, told: bool) -> None:
    (tmp_path / "gas.c").write_text(PROGRAM.format(send=send))
    findings = check_files(DriverFiles([tmp_path / "gas.c"], seconds=0.05)).findings
    assert [f.place is not None and f.place.line for f in findings if f.rule == "fraction-text"] == [7] * told
