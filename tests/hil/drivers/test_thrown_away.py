"""Words of an SPI that are lost in a program that throws away what it reads."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files
from tests.emulator.drivers import START_UP

PROGRAM = """#include "F28x_Project.h"
static volatile Uint16 Last, Dummy;
static Uint16 take(volatile struct SPI_REGS *spi) { return spi->SPIRXBUF; }
static void send(volatile struct SPI_REGS *spi, Uint16 first, Uint16 n)
{
    while (n-- > 0) {
        while (spi->SPISTS.bit.BUFFULL_FLAG == 1)
            ;
        spi->SPITXBUF = first++;
    }
}
void main(void)
{
""" + START_UP + """    EALLOW;
    CpuSysRegs.PCLKCR8.bit.SPI_B = 1;
    EDIS;
    SpibRegs.SPICCR.all = 0x000F;
    SpibRegs.SPICTL.all = 0x0006;
    SpibRegs.SPIBRR.all = 49;
    SpibRegs.SPICCR.all = 0x008F;
    Last = 1;
    for (;;) {
        send(&SpibRegs, Last, 4);
        DELAY_US(100);
        READ
        DELAY_US(100);
    }
}
"""


@pytest.mark.parametrize(
    ("reads", "how"),
    [
        ("Dummy = take(&SpibRegs);", "generated"),
        ("(void)take(&SpibRegs);", "generated"),
        ("Last = take(&SpibRegs);", "dynamic"),
    ],
)  # fmt: skip
def test_a_lost_word_that_nobody_would_have_used_is_a_note(tmp_path: Path, reads: str, how: str) -> None:
    file = tmp_path / "panel.c"
    file.write_text(PROGRAM.replace("READ", reads))
    lost = [f for f in check_files(DriverFiles([file], seconds=0.01)).findings if f.rule == "data-lost"]
    assert {f.how for f in lost} == {how}
