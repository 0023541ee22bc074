"""The identity of the gyro that is compared with another one, and programs that are right."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """/* {about} */
#include "F28x_Project.h"
#define WHO_AM_I    0x0F
#define I_AM        {identity}
static Uint16 Found = 0, Asked = 0;
static Uint16 Exchange(Uint16 octet)
{{
    SpiaRegs.SPITXBUF = octet << 8;
    while (SpiaRegs.SPISTS.bit.INT_FLAG == 0)
        ;
    return SpiaRegs.SPIRXBUF & 0xFF;
}}
static Uint16 Access(Uint16 address, Uint16 octet)
{{
    GpioDataRegs.GPBCLEAR.bit.GPIO61 = 1;
    Exchange(address);
    octet = Exchange(octet);
    GpioDataRegs.GPBSET.bit.GPIO61 = 1;
    DELAY_US(1);
    return octet;
}}
void main(void)
{{
    Uint16 who = 0;
    InitSysCtrl();
    EALLOW;
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1;
    EDIS;
    GPIO_SetupPinMux(58, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(59, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinMux(60, GPIO_MUX_CPU1, 15);
    GPIO_SetupPinOptions(58, GPIO_INPUT, GPIO_ASYNC);
    GPIO_SetupPinOptions(59, GPIO_INPUT, GPIO_ASYNC);
    GPIO_SetupPinOptions(60, GPIO_INPUT, GPIO_ASYNC);
    GpioDataRegs.GPBSET.bit.GPIO61 = 1;
    GPIO_SetupPinMux(61, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(61, GPIO_OUTPUT, GPIO_PUSHPULL);
    SpiaRegs.SPICCR.bit.SPISWRESET = 0;
    SpiaRegs.SPICCR.bit.SPICHAR = 7;
    SpiaRegs.SPICCR.bit.CLKPOLARITY = 1;
    SpiaRegs.SPICTL.bit.CLK_PHASE = 0;
    SpiaRegs.SPICTL.bit.MASTER_SLAVE = 1;
    SpiaRegs.SPICTL.bit.TALK = 1;
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = 9;
    SpiaRegs.SPICCR.bit.SPISWRESET = 1;
    for (;;) {{
        {turn}
        if (Found)
            Access(0x20, 0x0F);
        Asked += who != 0;
        DELAY_US(500);
    }}
}}
"""
DIRECT = "if (!Found && Access(WHO_AM_I | 0x80, 0) == I_AM) Found = 1;"
KEPT = "if (!Found) who = Access(WHO_AM_I | 0x80, 0);\nif (who == I_AM) Found = 1;"


def told(
    folder: Path, turn: str, *, about: str = "rate of turn of an L3G4200D", identity: str = "0xD4", named: bool = False
) -> list[tuple[str, str]]:
    """Statement and message of each `wrong-identity`."""
    file = folder / "gyro.c"
    text = PROGRAM.format(turn=turn, about=about, identity=identity)
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, seconds=0.01, board=load("robot"), board_named=named)).findings
    lines = text.splitlines()
    return [(lines[f.place.line - 1].strip(), f.message) for f in found if f.rule == "wrong-identity" and f.place]


@pytest.mark.parametrize(("turn", "line", "text"), [
    (DIRECT, DIRECT, "Access(...)"), (KEPT, "if (who == I_AM) Found = 1;", "who"),
])  # fmt: skip
def test_the_identity_of_another_part_is_told(tmp_path: Path, turn: str, line: str, text: str) -> None:
    ((where, message),) = told(tmp_path, turn)
    assert where == line
    assert message.startswith(f"{text} is 0xd3 of the L3G4200D, and is compared with 0xd4: the part was asked ")
    assert message.endswith(" times who it is, and never set up")


def test_a_named_board_says_which_part_it_is(tmp_path: Path) -> None:
    assert told(tmp_path, DIRECT, about="a sensor") == []
    assert len(told(tmp_path, DIRECT, about="a sensor", named=True)) == 1


@pytest.mark.parametrize(("turn", "given"), [
    (DIRECT, {"identity": "0xD3"}), (KEPT, {"identity": "0xD3"}),
    # A program for another part on the same pins; one that knows both.
    (DIRECT, {"about": "rate of turn of an L3GD20"}), (KEPT + "\nif (who == 0xD3) Asked++;", {}),
    # It does not wait for the answer; it asks whether anything is there; it only shows the answer.
    (f"{DIRECT} Found = 1;", {}), (KEPT, {"identity": "0xFF"}), ("Found = 0; who = Access(WHO_AM_I | 0x80, 0);", {}),
    ("if (Asked < 2) { " + DIRECT + " who = 1; }", {}),
])  # fmt: skip
def test_a_program_that_is_right_or_for_another_part_is_silent(
    tmp_path: Path, turn: str, given: dict[str, str]
) -> None:
    assert told(tmp_path, turn, **given) == []
