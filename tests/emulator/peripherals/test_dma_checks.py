"""What a driver of the DMA overlooks: a right copy within RAM, and the same with one mistake."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

#: Channel 3 copies 96 words in bursts of 16, started by the program; the sum of the copy is taken when it has ended.
RIGHT = """#include "F28x_Project.h"
#pragma DATA_SECTION(Source, "ramgs0");
#pragma DATA_SECTION(Copy, "ramgs1");
Uint16 Source[96];
Uint16 Copy[96];
volatile Uint16 Ready;
Uint32 Sum;
Uint16 Rounds;
__interrupt void Moved(void)
{
    Ready = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP7;
}
void main(void)
{
    Uint16 k, n;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.DMA_CH3_INT = &Moved;
    EDIS;
    DMAInitialize();
    DMACH3AddrConfig(Copy, Source);
    DMACH3BurstConfig(15, 1, 1);
    DMACH3TransferConfig(5, 1, 1);
    DMACH3ModeConfig(0, PERINT_ENABLE, ONESHOT_ENABLE, CONT_DISABLE, SYNC_DISABLE, SYNC_SRC, OVRFLOW_DISABLE,
                     SIXTEEN_BIT, CHINT_END, CHINT_ENABLE);
    IER |= M_INT7;
    EINT;
    for (;;) {
        for (k = 0; k < 96; k++)
            Source[k] = Rounds + k;
        Ready = 0;
        StartDMACH3();
        EALLOW;
        DmaRegs.CH3.CONTROL.bit.PERINTFRC = 1;
        EDIS;
        for (n = 0; n < 100 && !Ready; n++)
            DELAY_US(1);
        Sum = 0;
        for (k = 0; k < 96; k++)
            Sum += Copy[k];
        Rounds++;
    }
}
"""

WAIT = "for (n = 0; n < 100 && !Ready; n++)\n            DELAY_US(1);"


def told(folder: Path, text: str) -> list[tuple[str, str]]:
    """The findings about the DMA: rule, and the statement."""
    (folder / "drv.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles([folder / "drv.c"], calls=1, board=load("bare"), seconds=0.002)
    lines = text.splitlines()
    return [
        (f.rule, lines[f.place.line - 1].strip() if f.place is not None else "")
        for f in check_files(wanted).findings if f.rule.startswith("dma-")
    ]  # fmt: skip


@pytest.mark.parametrize(("was", "now", "rule", "at"), [
    # One word more a burst, one burst more, an array that is shorter.
    ("DMACH3BurstConfig(15, 1, 1);", "DMACH3BurstConfig(16, 1, 1);", "dma-range", "DMACH3TransferConfig(5, 1, 1);"),
    ("DMACH3TransferConfig(5, 1, 1);", "DMACH3TransferConfig(6, 1, 1);", "dma-range", "DMACH3TransferConfig(6, 1, 1);"),
    ("Uint16 Copy[96];", "Uint16 Copy[80]; Uint16 Behind[16];", "dma-range", "DMACH3TransferConfig(5, 1, 1);"),
    # One word again and again: read, written, between the bursts; and double words with the step of single ones.
    ("DMACH3BurstConfig(15, 1, 1);", "DMACH3BurstConfig(15, 0, 1);", "dma-step", "DMACH3BurstConfig(15, 0, 1);"),
    ("DMACH3BurstConfig(15, 1, 1);", "DMACH3BurstConfig(15, 1, 0);", "dma-step", "DMACH3BurstConfig(15, 1, 0);"),
    ("DMACH3TransferConfig(5, 1, 1);", "DMACH3TransferConfig(5, 1, 0);", "dma-step", "DMACH3TransferConfig(5, 1, 0);"),
    ("SIXTEEN_BIT", "THIRTYTWO_BIT", "dma-step", "DMACH3BurstConfig(15, 1, 1);"),
    ("ONESHOT_ENABLE", "ONESHOT_DISABLE", "dma-unfinished", "DMACH3ModeConfig("),
    (WAIT, "n = 0;", "dma-race", "Sum += Copy[k];"),
    (WAIT, "n = 0; Source[95] = 7; DELAY_US(4);", "dma-race", "n = 0; Source[95] = 7; DELAY_US(4);"),
    ('#pragma DATA_SECTION(Source, "ramgs0");\n', "", "dma-section", "DMACH3AddrConfig(Copy, Source);"),
])  # fmt: skip
def test_a_mistake_is_told_where_it_stands(tmp_path: Path, was: str, now: str, rule: str, at: str) -> None:
    assert RIGHT.count(was) == 1
    found = told(tmp_path, RIGHT.replace(was, now))
    assert any(name == rule and statement.startswith(at) for name, statement in found), found


@pytest.mark.parametrize("changes", [
    {},
    # No section is given to any of them: which RAM they lie in nobody knows.
    {'#pragma DATA_SECTION(Source, "ramgs0");\n': "", '#pragma DATA_SECTION(Copy, "ramgs1");\n': ""},
    # Double words; every other word; one word that fills a block; backwards.
    {"SIXTEEN_BIT": "THIRTYTWO_BIT", "Config(15, 1, 1)": "Config(15, 2, 2)", "Config(5, 1, 1)": "Config(5, 2, 2)"},
    {"Config(15, 1, 1)": "Config(7, 2, 1)", "Config(5, 1, 1)": "Config(5, 2, 1)"},
    {"Config(15, 1, 1)": "Config(15, 0, 1)", "Config(5, 1, 1)": "Config(5, 0, 1)"},
    {"Config(Copy, Source)": "Config(&Copy[95], &Source[95])", "Config(15, 1, 1)": "Config(15, -1, -1)",
     "Config(5, 1, 1)": "Config(5, -1, -1)"},
    # A trigger for each burst, and the start once.
    {"ONESHOT_ENABLE": "ONESHOT_DISABLE", "        EALLOW;\n        DmaRegs": "        for (n = 0; n < 6; n++) {\n"
     "        DELAY_US(2);\n        EALLOW;\n        DmaRegs", "EDIS;\n        for": "EDIS;\n        }\n        for"},
    # The last word says that all have come.
    {WAIT: "Copy[95] = 0xFFFF;\n        while (((volatile Uint16 *)Copy)[95] == 0xFFFF)\n            ;",
     "        Ready = 0;": "        Copy[95] = 0xFFFF;", "Copy[95] = 0xFFFF;\n        while": "while"},
])  # fmt: skip
def test_a_right_transfer_is_told_nothing(tmp_path: Path, changes: dict[str, str]) -> None:
    text = RIGHT
    for was, now in changes.items():
        assert text.count(was) == 1, was
        text = text.replace(was, now)
    assert told(tmp_path, text) == []
