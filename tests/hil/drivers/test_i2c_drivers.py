"""Drivers in C against parts on the I2C: a gyro by polling, an EEPROM by interrupts, the loopback by the FIFOs'."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US
from emulator.device_reports import Reports
from emulator.devices.at24c256 import At24c256
from emulator.devices.l3g4200d import L3G4200D
from hil.board import load
from hil.cli import invoke
from hil.drivers.check import DriverFiles, check_files
from hil.image import Build, Image

pytest.importorskip("pycparser")

#: 200 MHz / 20 = 10 MHz; SCL 10 + 5 module clocks low, 5 + 5 high: a bit is 2.5 us, 400 kHz.
OPEN = """\
#include "F28x_Project.h"

void Open(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR9.bit.I2C_A = 1;
    EDIS;
    GPIO_SetupPinMux(32, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinMux(33, GPIO_MUX_CPU1, 1);
    I2caRegs.I2CMDR.all = 0;
    I2caRegs.I2CPSC.all = 19;
    I2caRegs.I2CCLKL = 10;
    I2caRegs.I2CCLKH = 5;
    I2caRegs.I2CMDR.bit.IRS = 1;
}
"""

#: A burst of registers: the sub-address, a repeated START, the bytes.
GYRO = """
Uint16 Data[6];

Uint16 Read(Uint16 address, Uint16 sub, Uint16 count)
{
    Uint16 i;

    I2caRegs.I2CSTR.all = I2C_CLR_ARDY_BIT | I2C_CLR_NACK_BIT;
    I2caRegs.I2CSAR.all = address;
    I2caRegs.I2CCNT = 1;
    I2caRegs.I2CDXR.all = sub;
    I2caRegs.I2CMDR.all = 0x2620;
    while (I2caRegs.I2CSTR.bit.ARDY == 0) ;
    if (I2caRegs.I2CSTR.bit.NACK) {
        I2caRegs.I2CMDR.bit.STP = 1;
        while (I2caRegs.I2CMDR.bit.STP) ;
        return I2C_NACK_ERROR;
    }
    I2caRegs.I2CCNT = count;
    I2caRegs.I2CMDR.all = 0x2C20;
    for (i = 0; i < count; i++) {
        while (I2caRegs.I2CSTR.bit.RRDY == 0) ;
        Data[i] = I2caRegs.I2CDRR.all;
    }
    while (I2caRegs.I2CMDR.bit.STP) ;
    return I2C_SUCCESS;
}

void Write(Uint16 address, Uint16 sub, Uint16 value)
{
    I2caRegs.I2CSAR.all = address;
    I2caRegs.I2CCNT = 2;
    I2caRegs.I2CDXR.all = sub;
    I2caRegs.I2CMDR.all = 0x2E20;
    while (I2caRegs.I2CSTR.bit.XRDY == 0) ;
    I2caRegs.I2CDXR.all = value;
    while (I2caRegs.I2CMDR.bit.STP) ;
}
"""

MAIN = """
Uint16 Who = 0;

void main(void)
{
    InitSysCtrl();
    Open();
    if (Read(0x68, 0x0F, 1) == I2C_SUCCESS) Who = Data[0];
    for (;;) ;
}
"""

#: An EEPROM: a message out of the FIFO, its end by interrupt, polling until the write cycle is over.
EEPROM = """
volatile Uint16 Ended = 0;
Uint16 Polls = 0;
Uint16 Data[8];

interrupt void I2cA(void)
{
    Uint16 source = I2caRegs.I2CISRC.all;

    if (source == I2C_ARDY_ISRC && I2caRegs.I2CSTR.bit.NACK) {
        I2caRegs.I2CSTR.all = I2C_CLR_NACK_BIT;
        I2caRegs.I2CMDR.bit.STP = 1;
        Polls++;
    } else {
        Ended = source;
    }
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP8;
}

void Start(void)
{
    Open();
    InitPieCtrl();
    InitPieVectTable();
    EALLOW;
    PieVectTable.I2CA_INT = &I2cA;
    EDIS;
    I2caRegs.I2CSAR.all = 0x50;
    I2caRegs.I2CFFTX.all = 0x6000;
    I2caRegs.I2CFFRX.all = 0x2040;
    I2caRegs.I2CIER.all = 0x24;
    PieCtrlRegs.PIEIER8.bit.INTx1 = 1;
    IER |= M_INT8;
    EINT;
}

static void Message(Uint16 mode, Uint16 count)
{
    while (I2caRegs.I2CMDR.bit.STP) ;
    Ended = 0;
    I2caRegs.I2CCNT = count;
    I2caRegs.I2CMDR.all = mode;
    while (Ended == 0) ;
}

void Store(Uint16 place, Uint16 first, Uint16 count)
{
    Uint16 i;

    I2caRegs.I2CDXR.all = place >> 8;
    I2caRegs.I2CDXR.all = place & 0xFF;
    for (i = 0; i < count; i++) I2caRegs.I2CDXR.all = first + i;
    Message(0x6E20, count + 2);
}

void Fetch(Uint16 place, Uint16 count)
{
    Uint16 i;

    do {
        I2caRegs.I2CFFTX.bit.TXFFRST = 0;
        I2caRegs.I2CFFTX.bit.TXFFRST = 1;
        I2caRegs.I2CDXR.all = place >> 8;
        I2caRegs.I2CDXR.all = place & 0xFF;
        Message(0x6620, 2);
    } while (Ended != I2C_ARDY_ISRC);
    Message(0x6C20, count);
    for (i = 0; i < count; i++) Data[i] = I2caRegs.I2CDRR.all;
}
"""

LOOPBACK = """
volatile Uint16 Rounds = 0;
Uint16 Wrong = 0, Next = 0;

interrupt void Fifo(void)
{
    if (I2caRegs.I2CFFRX.bit.RXFFINT) {
        if (I2caRegs.I2CDRR.all != (Next & 0xFF)) Wrong++;
        if (I2caRegs.I2CDRR.all != (Next + 1 & 0xFF)) Wrong++;
        Next++;
        Rounds++;
        I2caRegs.I2CFFRX.bit.RXFFINTCLR = 1;
        I2caRegs.I2CFFTX.bit.TXFFIENA = 1;
    } else if (I2caRegs.I2CFFTX.bit.TXFFINT) {
        I2caRegs.I2CDXR.all = Next & 0xFF;
        I2caRegs.I2CDXR.all = Next + 1 & 0xFF;
        I2caRegs.I2CMDR.bit.STT = 1;
        I2caRegs.I2CFFTX.bit.TXFFIENA = 0;
        I2caRegs.I2CFFTX.bit.TXFFINTCLR = 1;
    }
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP8;
}

void Start(void)
{
    Open();
    InitPieCtrl();
    InitPieVectTable();
    EALLOW;
    PieVectTable.I2CA_FIFO_INT = &Fifo;
    EDIS;
    I2caRegs.I2CSAR.all = 0x3C;
    I2caRegs.I2CCNT = 2;
    I2caRegs.I2CMDR.all = 0x0660;
    I2caRegs.I2CFFRX.all = 0x2042 | 1 << 5;
    PieCtrlRegs.PIEIER8.bit.INTx2 = 1;
    IER |= M_INT8;
    EINT;
    I2caRegs.I2CFFTX.all = 0x6060;
}
"""


def image_of(folder: Path, text: str) -> Image:
    file = folder / "drv.c"
    file.write_text(OPEN + text, encoding="utf-8")
    return Build([str(file)]).image()


def found(image: Image) -> list[str]:
    return [f"{finding.rule}: {finding.message}" for finding in image.findings]


def data(image: Image, name: str, count: int = 1) -> list[int]:
    return list(image.linked.objects[f"drv.{name}"].data[:count])


def test_who_am_i(tmp_path: Path) -> None:
    image = image_of(tmp_path, GYRO)
    board = image.board
    gyro = L3G4200D(board.clock, rng=random.Random(0), sdo=1)
    board.i2c_bus["A"].attach(gyro.i2c.address, gyro.i2c)
    image.call("drv.Open", ())
    began = board.clock.now
    assert image.call("drv.Read", (0x69, 0x0F, 1)) == 0
    assert data(image, "Data") == [0xD3]
    # START, address, sub-address, START, address, byte, STOP: 4 bytes of 9 bits and four bits more or less, at 2.5 us.
    assert 36 * 2.5 < (board.clock.now - began) / CYCLES_PER_US < 44 * 2.5
    # Nobody at the other address.
    assert image.call("drv.Read", (0x68, 0x0F, 1)) == 2
    assert image.call("drv.Read", (0x69, 0x0F, 1)) == 0
    assert found(image) == []


def test_a_burst_of_the_gyro_is_what_it_measures(tmp_path: Path) -> None:
    image = image_of(tmp_path, GYRO)
    board = image.board
    gyro = L3G4200D(board.clock, rng=random.Random(0))
    gyro.force_samples(lambda _cycles: (0x1234, -2, 0x0056))
    board.i2c_bus["A"].attach(gyro.i2c.address, gyro.i2c)
    image.call("drv.Open", ())
    image.call("drv.Write", (0x68, 0x20, 0x0F))
    board.clock.advance_to(board.clock.now + 300 * CYCLES_PER_MS)
    assert image.call("drv.Read", (0x68, 0x80 | 0x28, 6)) == 0
    assert data(image, "Data", 6) == [0x34, 0x12, 0xFE, 0xFF, 0x56, 0x00]
    assert found(image) == []


def test_what_the_gyro_says_stands_at_the_command_of_the_transfer(tmp_path: Path) -> None:
    image = image_of(tmp_path, GYRO)
    board = image.board
    reports = Reports(board.findings)
    gyro = L3G4200D(board.clock, rng=random.Random(0), report=reports, mark=reports.mark)
    board.i2c_bus["A"].attach(gyro.i2c.address, gyro.i2c)
    image.call("drv.Open", ())
    image.call("drv.Read", (0x68, 0x10, 1))  # reserved
    (finding,) = board.findings
    assert finding.rule == "device-register"
    assert finding.place is not None
    line = (OPEN + GYRO).splitlines()[finding.place.line - 1]
    assert line.strip() == "I2caRegs.I2CMDR.all = 0x2C20;"


def test_an_eeprom_by_interrupts_with_acknowledge_polling(tmp_path: Path) -> None:
    image = image_of(tmp_path, EEPROM)
    board = image.board
    eeprom = At24c256(board.clock)
    board.i2c_bus["A"].attach(eeprom.address, eeprom)
    image.call("drv.Start", ())
    image.call("drv.Store", (0x1230, 0x41, 6))
    written = board.clock.now
    image.call("drv.Fetch", (0x1230, 6))
    assert data(image, "Data", 6) == [0x41, 0x42, 0x43, 0x44, 0x45, 0x46]
    assert eeprom.memory[0x1230:0x1236] == b"ABCDEF"
    # 5 ms of write cycle in polls of an address and a STOP, 10 bits of 2.5 us and what the program takes.
    assert board.clock.now - written > 5 * CYCLES_PER_MS
    assert 100 < data(image, "Polls")[0] < 200
    assert found(image) == []


def test_the_loopback_goes_round_by_the_interrupts_of_the_fifos(tmp_path: Path) -> None:
    image = image_of(tmp_path, LOOPBACK)
    image.call("drv.Start", ())
    image.board.clock.advance_to(image.board.clock.now + 300 * CYCLES_PER_MS)
    # A round is an address and two bytes, 27 bits of 2.5 us, and a START: some 80 us.
    assert 3000 < data(image, "Rounds")[0] < 4500
    assert data(image, "Wrong") == [0]
    assert found(image) == []


def test_hil_check_of_a_program_with_nobody_on_the_bus(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)

    def counted() -> set[str]:
        return {f["rule"] for f in json.loads(capsys.readouterr().out)["findings"] if f["severity"] != "note"}

    Path("drv.c").write_text(OPEN + GYRO + MAIN, encoding="utf-8")
    assert invoke(["check", "--json", "--for", "0.05", "drv.c"]) == 0
    assert counted() == set()
    wrong = (OPEN + GYRO + MAIN).replace("I2caRegs.I2CPSC.all = 19;", "").replace("0x68,", "0xD0,")
    Path("drv.c").write_text(wrong, encoding="utf-8")
    assert invoke(["check", "--json", "--for", "0.05", "drv.c"]) == 1
    # Without a prescaler the module runs at 200 MHz; 0xD0 is the address with its R/W bit.
    assert counted() == {"i2c-clock", "reserved-field"}


@pytest.mark.parametrize(("prescaler", "told"), [("19", []), ("9", ["    I2caRegs.I2CPSC.all = 9;"])])
def test_a_module_clock_is_told_where_its_prescaler_is_set(prescaler: str, told: list[str], tmp_path: Path) -> None:
    text = OPEN.replace("I2CPSC.all = 19", f"I2CPSC.all = {prescaler}").replace("I2CCLKL = 10", "I2CCLKL = 40")
    text += "void main(void)\n{\n    InitSysCtrl();\n    Open();\n    I2caRegs.I2CSAR.all = 0x50;\n"
    text += "    I2caRegs.I2CCNT = 1;\n    I2caRegs.I2CMDR.all = 0x6E20;\n    for (;;) ;\n}\n"
    (tmp_path / "clock.c").write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([tmp_path / "clock.c"], calls=1, seconds=0.002)).findings
    at = {text.splitlines()[f.place.line - 1] for f in found if f.rule == "i2c-clock" and f.place}
    assert at == set(told)


@pytest.mark.parametrize(("divider", "told"), [("400", []), ("30000", ["    I2caRegs.I2CCLKH = 30000;"])])
def test_a_slow_bus_is_told_where_its_dividers_are_set(divider: str, told: list[str], tmp_path: Path) -> None:
    text = OPEN.replace("I2CCLKL = 10", f"I2CCLKL = {divider}").replace("I2CCLKH = 5", f"I2CCLKH = {divider}")
    text += "void main(void)\n{\n    InitSysCtrl();\n    Open();\n    I2caRegs.I2CSAR.all = 0x50;\n"
    text += "    I2caRegs.I2CCNT = 1;\n    I2caRegs.I2CMDR.all = 0x6E20;\n    for (;;) ;\n}\n"
    (tmp_path / "slow.c").write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([tmp_path / "slow.c"], calls=1, seconds=0.002)).findings
    assert [text.splitlines()[f.place.line - 1] for f in found if f.rule == "i2c-slow" and f.place] == told


BOARD = """from emulator.devices.l3g4200d import L3G4200D
from hil.board import Board

class Turns(Board):
    i2c_pins = {"A": (32, 33)}

    def solder(self):
        gyro = L3G4200D(self.clock, rng=self.rng("gyro"), report=self.reports, mark=self.reports.mark)
        self.on_i2c("gyro", gyro.i2c, bus="A", address=gyro.i2c.address)
"""
LOOP = """
void main(void)
{
    InitSysCtrl();
    InitGpio();
    Open();
    for (;;) {
        Read(0x68, 0x0F, 1);
        DELAY_US(2000);
    }
}
"""
REFUSED = GYRO[GYRO.index("    if (I2caRegs.I2CSTR.bit.NACK)") : GYRO.index("    I2caRegs.I2CCNT = count;")]


@pytest.mark.parametrize(("refusal", "silence", "told"), [(REFUSED, True, 0), ("", True, 1), ("", False, 0)])
def test_a_wait_for_a_part_that_falls_silent_is_told_where_nobody_looks_at_its_refusal(
    refusal: str, silence: bool, told: int, tmp_path: Path
) -> None:
    (tmp_path / "turns.py").write_text(BOARD, encoding="utf-8")
    text = OPEN + GYRO.replace(REFUSED, refusal) + LOOP
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    board = load(str(tmp_path / "turns.py"))
    wanted = DriverFiles([tmp_path / "drv.c"], seconds=0.05, calls=1, board=board, board_named=True, silence=silence)
    found = [f for f in check_files(wanted).findings if f.rule == "endless-poll" and f.how == "dynamic"]
    assert ["RRDY" in text.splitlines()[f.place.line - 1] for f in found if f.place] == [True] * told
    assert all("nothing on the I2C answers" in f.details[-1] for f in found)
