"""The CAN from C: by fields, by the addresses that driverlib uses, with interrupts, from one controller to the other.

What TI's examples can_loopback, can_loopback_interrupts and can_external_transmit promise, in words of our own.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.can_bus import CanFrame, CanPart
from emulator.image import Firmware, link
from hil.board import Board

#: Offsets as in TI's hw_can.h; what HWREG_BP and HWREGB stand for in TI's hw_types.h.
BY_ADDRESS = r"""
#include "F28x_Project.h"
#define HWREGH(x) (*((volatile uint16_t *)(x)))
#define HWREGB(x) __byte((int *)(x), 0)
#define HWREG_BP(x) __byte_peripheral_32((uint32_t *)(x))
#define CANA 0x00048000UL
#define CANB 0x0004A000UL
#define CTL 0x00UL
#define ES 0x04UL
#define BTR 0x0CUL
#define INTERRUPT 0x10UL
#define TEST 0x14UL
#define RAM_INIT 0x40UL
#define GLB_INT_EN 0x50UL
#define GLB_INT_CLR 0x58UL
#define IF1CMD 0x100UL
#define IF1MSK 0x104UL
#define IF1ARB 0x108UL
#define IF1MCTL 0x10CUL
#define IF1DATA 0x110UL
#define IF2CMD 0x120UL
#define IF2MCTL 0x12CUL
#define IF2DATA 0x130UL

void can_clocks(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR10.bit.CAN_A = 1;
    CpuSysRegs.PCLKCR10.bit.CAN_B = 1;
    EDIS;
    GPIO_SetupPinMux(30, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinMux(31, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinMux(12, GPIO_MUX_CPU1, 2);
    GPIO_SetupPinMux(17, GPIO_MUX_CPU1, 2);
}

/* 500 kbit/s: 20 quanta of 20 cycles. */
void can_init(uint32_t base)
{
    HWREGH(base + CTL) |= 0x1401;
    HWREGH(base + RAM_INIT) = 0x1A;
    while ((HWREGH(base + RAM_INIT) & 0x3F) != 0x25) { }
    HWREGH(base + CTL) |= 0x8000;
    DELAY_US(1);
    HWREGH(base + CTL) |= 0x0040;
    HWREG_BP(base + BTR) = 0x5C13UL;
}

void can_start(uint32_t base)
{
    HWREGH(base + CTL) &= ~0x0041U;
}

void idle(uint32_t command)
{
    while (HWREGH(command) & 0x8000U) { }
}

void setup(uint32_t base, uint32_t number, uint32_t arb, uint32_t control)
{
    idle(base + IF1CMD);
    HWREG_BP(base + IF1MSK) = 0;
    HWREG_BP(base + IF1ARB) = arb | 0x80000000UL;
    HWREG_BP(base + IF1MCTL) = control | 0x80;
    HWREG_BP(base + IF1CMD) = 0x00F00000UL | number;
}

void send(uint32_t base, uint32_t number, const uint16_t *data, uint16_t count)
{
    uint16_t n;
    idle(base + IF1CMD);
    for (n = 0; n < count; n++) {
        HWREGB(base + IF1DATA + n) = data[n];
    }
    HWREG_BP(base + IF1CMD) = 0x00870000UL | number;
}

int receive(uint32_t base, uint32_t number, uint16_t *data)
{
    uint16_t n, control;
    HWREG_BP(base + IF2CMD) = 0x00370000UL | number;
    idle(base + IF2CMD);
    control = HWREGH(base + IF2MCTL);
    if (!(control & 0x8000U)) {
        return 0;
    }
    for (n = 0; n < (control & 0xF); n++) {
        data[n] = HWREGB(base + IF2DATA + n);
    }
    return 1;
}
"""

LOOPBACK = BY_ADDRESS + r"""
uint16_t tx[5] = { 1, 2, 3, 4, 5 };
uint16_t rx[8];
uint16_t good = 0, bad = 0;

void run(uint16_t times)
{
    uint16_t n, k;
    can_clocks();
    can_init(CANA);
    HWREGH(CANA + CTL) |= 0x80;
    HWREGH(CANA + TEST) |= 0x100;
    setup(CANA, 1, 0x20000000UL | (0x111UL << 18), 5);
    setup(CANA, 2, 0x111UL << 18, 0);
    can_start(CANA);
    for (n = 0; n < times; n++) {
        send(CANA, 1, tx, 5);
        DELAY_US(1000);
        if (!receive(CANA, 2, rx)) {
            bad++;
        }
        for (k = 0; k < 5; k++) {
            if (rx[k] != tx[k]) {
                bad++;
            }
            tx[k] = (tx[k] + 1) & 0xFF;
        }
        good++;
    }
}
"""

INTERRUPTS = BY_ADDRESS + r"""
uint16_t tx[4] = { 0x12, 0x34, 0x56, 0x78 };
uint16_t rx[8];
uint32_t sent = 0, received = 0, errors = 0, statuses = 0;

__interrupt void on_can(void)
{
    uint32_t cause = HWREG_BP(CANA + INTERRUPT);
    if (cause == 0x8000UL) {
        uint16_t status = HWREGH(CANA + ES);
        statuses++;
        if ((status & 0xE0) || ((status & 7) != 7 && (status & 7) != 0)) {
            errors++;
        }
    } else if (cause == 1) {
        idle(CANA + IF1CMD);
        HWREG_BP(CANA + IF1CMD) = 0x00080001UL;
        idle(CANA + IF1CMD);
        sent++;
    } else if (cause == 2) {
        receive(CANA, 2, rx);
        HWREG_BP(CANA + IF2CMD) = 0x00080002UL;
        idle(CANA + IF2CMD);
        received++;
    } else {
        errors++;
    }
    HWREGH(CANA + GLB_INT_CLR) |= 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}

void run(uint16_t times)
{
    uint16_t n;
    can_clocks();
    InitPieCtrl();
    InitPieVectTable();
    can_init(CANA);
    HWREG_BP(CANA + CTL) |= 0x0EUL;
    EALLOW;
    PieVectTable.CANA0_INT = &on_can;
    EDIS;
    PieCtrlRegs.PIEIER9.bit.INTx5 = 1;
    IER |= M_INT9;
    EINT;
    HWREGH(CANA + GLB_INT_EN) |= 1;
    HWREGH(CANA + CTL) |= 0x80;
    HWREGH(CANA + TEST) |= 0x100;
    setup(CANA, 1, 0x20000000UL | (1UL << 18), 0x0800 | 4);
    setup(CANA, 2, 1UL << 18, 0x0400);
    can_start(CANA);
    for (n = 0; n < times; n++) {
        if (sent != received) {
            errors++;
        }
        send(CANA, 1, tx, 4);
        DELAY_US(1000);
    }
}
"""

EXTERNAL = BY_ADDRESS + r"""
uint16_t tx[4] = { 0x12, 0x34, 0x56, 0x78 };
uint16_t rx[8];
uint32_t received = 0;

void run(uint16_t times)
{
    uint16_t n;
    can_clocks();
    can_init(CANA);
    can_init(CANB);
    setup(CANA, 1, 0x60000000UL | 0x15555555UL, 4);
    setup(CANB, 1, 0x40000000UL | 0x15555555UL, 0);
    can_start(CANA);
    can_start(CANB);
    for (n = 0; n < times; n++) {
        send(CANA, 1, tx, 4);
        while (!(HWREG_BP(CANB + ES) & 0x10)) { }
        if (receive(CANB, 1, rx) && rx[0] == tx[0] && rx[3] == tx[3]) {
            received++;
        }
        tx[0] = (tx[0] + 1) & 0xFF;
    }
}
"""

FIELDS = r"""
#include "F28x_Project.h"
uint16_t got = 0, first = 0, busy = 0;

void run(uint16_t times)
{
    union CAN_IF1CMD_REG command;
    uint16_t n;
    volatile struct CAN_REGS *can = &CanaRegs;
    EALLOW;
    CpuSysRegs.PCLKCR10.bit.CAN_A = 1;
    EDIS;
    GPIO_SetupPinMux(30, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinMux(31, GPIO_MUX_CPU1, 1);
    CanaRegs.CAN_CTL.bit.CCE = 1;
    CanaRegs.CAN_BTR.all = 0x5C13;
    CanaRegs.CAN_CTL.all = 0;
    CanaRegs.CAN_CTL.bit.Test = 1;
    can->CAN_TEST.bit.EXL = 1;
    for (n = 1; n <= 2; n++) {
        CanaRegs.CAN_IF1MSK.all = 0;
        CanaRegs.CAN_IF1MCTL.all = 0;
        CanaRegs.CAN_IF1ARB.all = 0;
        CanaRegs.CAN_IF1ARB.bit.Dir = n == 1;
        CanaRegs.CAN_IF1ARB.bit.ID = 0x111UL << 18;
        CanaRegs.CAN_IF1ARB.bit.MsgVal = 1;
        CanaRegs.CAN_IF1MCTL.bit.DLC = 4;
        CanaRegs.CAN_IF1MCTL.bit.EoB = 1;
        command.all = 0;
        command.bit.Control = 1;
        command.bit.Arb = 1;
        command.bit.Mask = 1;
        command.bit.DIR = 1;
        command.bit.MSG_NUM = n;
        can->CAN_IF1CMD.all = command.all;
        while (CanaRegs.CAN_IF1CMD.bit.Busy) {
            busy++;
        }
    }
    for (n = 0; n < times; n++) {
        CanaRegs.CAN_IF1DATA.bit.Data_0 = n;
        CanaRegs.CAN_IF1DATA.bit.Data_3 = 0xA5;
        command.all = 0;
        command.bit.DIR = 1;
        command.bit.DATA_A = 1;
        command.bit.TXRQST = 1;
        command.bit.MSG_NUM = 1;
        CanaRegs.CAN_IF1CMD.all = command.all;
        while (CanaRegs.CAN_ES.bit.RxOk == 0) { }
        CanaRegs.CAN_IF2CMD.all = 0x00370002UL;
        while (CanaRegs.CAN_IF2CMD.bit.Busy) { }
        if (CanaRegs.CAN_IF2MCTL.bit.NewDat && CanaRegs.CAN_IF2DATA.bit.Data_3 == 0xA5) {
            got++;
            first = CanaRegs.CAN_IF2DATA.bit.Data_0;
        }
    }
}
"""


def program(folder: Path, text: str, board: Board | None = None) -> tuple[Board, Firmware]:
    board = board or Board()
    (folder / "can_test.c").write_text(text)
    return board, link(board, [str(folder / "can_test.c")])


def test_a_loopback_by_address_gets_every_message_back(tmp_path: Path) -> None:
    board, firmware = program(tmp_path, LOOPBACK)
    firmware.can_test.run(20)
    assert (firmware.can_test.good, firmware.can_test.bad) == (20, 0)
    # The last message: 1 + 19, and five bytes of it, so that both data registers take part.
    assert list(firmware.can_test.rx)[:5] == [20, 21, 22, 23, 24]
    assert [finding.message for finding in board.findings] == []


def test_a_loopback_with_interrupts_counts_as_many_received_as_sent(tmp_path: Path) -> None:
    board, firmware = program(tmp_path, INTERRUPTS)
    firmware.can_test.run(10)
    assert (firmware.can_test.sent, firmware.can_test.received, firmware.can_test.errors) == (10, 10, 0)
    # A status interrupt for each RxOk and each TxOk.
    assert firmware.can_test.statuses == 20
    assert list(firmware.can_test.rx)[:4] == [0x12, 0x34, 0x56, 0x78]
    assert [finding.message for finding in board.findings] == []


def test_CAN_A_sends_to_CAN_B(tmp_path: Path) -> None:
    board = Board()
    board.join_can()
    frames: list[CanFrame] = []
    board.can_bus["A"].arrived.connect(frames.append)
    _, firmware = program(tmp_path, EXTERNAL, board)
    firmware.can_test.run(5)
    assert firmware.can_test.received == 5
    board.clock.advance_to(board.clock.now + 100_000)
    assert frames == [CanFrame(0x15555555, bytes([0x12 + n, 0x34, 0x56, 0x78]), extended=True) for n in range(5)]
    assert [finding.message for finding in board.findings] == []


def test_a_loopback_by_fields_and_through_a_pointer(tmp_path: Path) -> None:
    board, firmware = program(tmp_path, FIELDS)
    firmware.can_test.run(3)
    assert (firmware.can_test.got, firmware.can_test.first) == (3, 2)
    assert firmware.can_test.busy < 10
    assert [finding.message for finding in board.findings] == []


@pytest.mark.parametrize(
    ("body", "value"),
    [
        # CAN_BTR is 0x2301 after reset; its upper half is at its address + 2, its bytes at + 0 to + 3.
        ("return HWREGH(CANA + BTR);", 0x2301),
        ("return HWREGH(CANA + BTR + 2);", 0),
        ("return HWREGB(CANA + BTR + 1);", 0x23),
        ("return HWREG_BP(CANA + IF1MSK) >> 16;", 0xFFFF),
        ("HWREGB(CANA + IF1DATA + 3) = 0x7E; return HWREG_BP(CANA + IF1DATA) >> 16;", 0x7E00),
        ("HWREGH(CANA + IF1DATA + 2) = 0x1234; return HWREGB(CANA + IF1DATA + 2);", 0x34),
        ("HWREG_BP(CANA + IF1ARB) = 0x40001234UL; return CanaRegs.CAN_IF1ARB.bit.Xtd;", 1),
        ("HWREGH(CANA + IF1CMD + 2) = 0xA0; return CanaRegs.CAN_IF1CMD.bit.Busy;", 0),
        ("CanaRegs.CAN_IF1CMD.bit.DIR = 1; return CanaRegs.CAN_IF1CMD.bit.DIR;", 1),
        ("return CanbRegs.CAN_CTL.all == HWREG_BP(CANB + CTL);", 1),
        ("return &CanaRegs.CAN_IF1CMD.all == (volatile uint32_t *)(CANA + IF1CMD);", 1),
    ],
)
def test_a_register_is_one_register_by_word_by_half_and_by_byte(tmp_path: Path, body: str, value: int) -> None:
    text = f"{BY_ADDRESS}uint16_t f(void)\n{{\n    can_clocks();\n    {body}\n}}\n"
    board, firmware = program(tmp_path, text)
    assert firmware.can_test.f() == value
    assert [finding.message for finding in board.findings] == []


def test_a_part_of_a_board_answers_a_driver(tmp_path: Path) -> None:
    class Echo(CanPart):
        """Sends each frame back under the next identifier."""

        def received(self, frame: CanFrame) -> None:
            super().received(frame)
            self.send(CanFrame(frame.identifier + 1, frame.data))

    class Wired(Board):
        def solder(self) -> None:
            self.echo = self.on_can("echo", Echo(500_000), bus="A")

    board = Wired()
    assert board.part("echo").pins == {"bus": "CAN-A"}
    text = BY_ADDRESS + r"""
uint16_t rx[8];
int run(void)
{
    uint16_t tx[2] = { 0xCA, 0xFE };
    can_clocks();
    can_init(CANA);
    setup(CANA, 1, 0x20000000UL | (0x10UL << 18), 2);
    setup(CANA, 2, 0x11UL << 18, 0);
    can_start(CANA);
    send(CANA, 1, tx, 2);
    DELAY_US(1000);
    return receive(CANA, 2, rx);
}
"""
    _, firmware = program(tmp_path, text, board)
    assert firmware.can_test.run() == 1
    assert list(firmware.can_test.rx)[:2] == [0xCA, 0xFE]
    assert board.echo.frames == [CanFrame(0x10, b"\xca\xfe")]
    assert [finding.message for finding in board.findings] == []
    with pytest.raises(ValueError, match="CAN-C"):
        board.on_can("other", CanPart(), bus="C")


def test_a_wrong_bit_rate_shows_as_errors_of_the_driver(tmp_path: Path) -> None:
    board = Board()
    board.on_can("other", CanPart(250_000), bus="A")
    text = BY_ADDRESS + r"""
uint16_t run(void)
{
    uint16_t tx[1] = { 1 };
    can_clocks();
    can_init(CANA);
    setup(CANA, 1, 0x20000000UL | (0x10UL << 18), 1);
    can_start(CANA);
    send(CANA, 1, tx, 1);
    DELAY_US(10000);
    return HWREGH(CANA + ES) & 0x80;
}
"""
    _, firmware = program(tmp_path, text, board)
    # Every attempt is destroyed, until the controller is bus-off.
    assert firmware.can_test.run() == 0x80


def test_InitCAN_leaves_no_object_valid_and_the_controller_stopped(tmp_path: Path) -> None:
    text = BY_ADDRESS + r"""
void before(void)
{
    uint16_t n;
    can_clocks();
    can_init(CANA);
    for (n = 1; n <= 32; n++) {
        setup(CANA, n, 0x10UL << 18, 0);
    }
    idle(CANA + IF1CMD);
    can_start(CANA);
}
uint32_t after(void)
{
    InitCAN();
    idle(CANA + IF1CMD);
    idle(CANA + IF2CMD);
    return CanaRegs.CAN_MVAL_21;
}
"""
    board, firmware = program(tmp_path, text)
    firmware.can_test.before()
    assert board.register("CanaRegs", "CAN_MVAL_21").read() == 0xFFFF_FFFF
    assert firmware.can_test.after() == 0
    assert board.register("CanaRegs", "CAN_CTL").read() == 0x1401
    assert [finding.message for finding in board.findings] == []


def test_a_routine_that_leaves_the_global_flag_is_named(tmp_path: Path) -> None:
    text = INTERRUPTS.replace("    HWREGH(CANA + GLB_INT_CLR) |= 1;\n", "")
    text = text.replace("DELAY_US(1000);", "DELAY_US(60000);")
    board, firmware = program(tmp_path, text)
    firmware.can_test.run(4)
    assert firmware.can_test.sent + firmware.can_test.received + firmware.can_test.statuses == 1
    found = board.findings.of("flag-not-cleared")
    assert [finding.object for finding in found] == ["CanaRegs.CAN_GLB_INT_FLG.INT0_FLG"]


#: An object for frames of 0x55 and one that sends 0x66, each set up whole; `send` sends eight bytes.
PARTS = r"""
#include "F28x_Project.h"
void idle(void) { while (CanaRegs.CAN_IF1CMD.bit.Busy || CanaRegs.CAN_IF2CMD.bit.Busy) { } }
void setup(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR10.bit.CAN_A = 1;
    EDIS;
    CanaRegs.CAN_IF1MSK.all = 0x1FFC0000uL;
    CanaRegs.CAN_IF1ARB.all = 0x80000000uL | (0x55uL << 18);
    CanaRegs.CAN_IF1MCTL.all = 0x1088uL;
    CanaRegs.CAN_IF1CMD.all = 0x00F00001uL;  /* receives */
    idle();
    CanaRegs.CAN_IF2ARB.all = 0xA0000000uL | (0x66uL << 18);
    CanaRegs.CAN_IF2MCTL.all = 0x0088uL;
    CanaRegs.CAN_IF2CMD.all = 0x00B00002uL;  /* sends */
    idle();
}
void send(uint32_t low, uint32_t high)
{
    CanaRegs.CAN_IF2DATA.all = low;
    CanaRegs.CAN_IF2DATB.all = high;
    CanaRegs.CAN_IF2CMD.all = 0x00870002uL;  /* the message */
    idle();
}
uint32_t run(void)
{
    setup();
    send(1, 2);
    send(3, 4);
    return CanaRegs.CAN_MVAL_21;
}
"""
#: What is between two statements about an interface.
THEN = "\n    CanaRegs.CAN_IF"
LOW = "IF2DATA.all = low;"


@pytest.mark.parametrize(("was", "now", "lost", "at"), [
    ("", "", "", ""),
    ("0x00F00001uL", "0x00D00001uL", "CanaRegs.CAN_IF1ARB", "/* receives */"),
    ("0x00F00001uL", "0x00B00001uL", "CanaRegs.CAN_IF1MSK", "/* receives */"),
    ("0x00F00001uL", "0x00E00001uL", "CanaRegs.CAN_IF1MCTL", "/* receives */"),
    ("0x00B00002uL", "0x00900002uL", "CanaRegs.CAN_IF2ARB", "/* sends */"),
    ("0x00870002uL", "0x00850002uL", "CanaRegs.CAN_IF2DATA", "/* the message */"),
    ("0x00870002uL", "0x00860002uL", "CanaRegs.CAN_IF2DATB", "/* the message */"),
    # Of four bytes none is in DATB.
    (f"0x0088uL;{THEN}2CMD.all = 0x00B00002uL", f"0x0084uL;{THEN}2CMD.all = 0x00B00002uL", "", ""),
    # Without UMask the mask has no effect.
    (f"0x1088uL;{THEN}1CMD.all = 0x00F00001uL", f"0x0088uL;{THEN}1CMD.all = 0x00B00001uL", "", ""),
    # The same is written again, and need not be moved again.
    (LOW, f"{LOW}{THEN}2MCTL.all = 0x0188uL;{THEN}2ARB.all = 0xA0000000uL | (0x66uL << 18);", "", ""),
    # Another length is not the same.
    (LOW, f"{LOW}{THEN}2MCTL.all = 0x0084uL;", "CanaRegs.CAN_IF2MCTL", "/* the message */"),
    # The object is made invalid first; its other parts follow with a command of their own.
    ("    CanaRegs.CAN_IF1MSK.all = 0x1FFC0000uL;", "    CanaRegs.CAN_IF1ARB.all = 0;\n    CanaRegs.CAN_IF1CMD.all = "
     "0x00A00001uL;\n    idle();\n    CanaRegs.CAN_IF1MSK.all = 0x1FFC0000uL;", "", ""),
    # A command that fetches moves nothing to the object, and the next one does.
    ("    CanaRegs.CAN_IF2CMD.all = 0x00870002uL", "    CanaRegs.CAN_IF2CMD.all = 0x00100002uL;\n    idle();\n"
     "    CanaRegs.CAN_IF2CMD.all = 0x00870002uL", "", ""),
])  # fmt: skip
def test_what_a_command_leaves_behind_in_the_interface_is_lost(
    tmp_path: Path, was: str, now: str, lost: str, at: str
) -> None:
    assert not was or PARTS.count(was) == 1
    text = PARTS.replace(was, now) if was else PARTS
    board, firmware = program(tmp_path, text)
    valid = firmware.can_test.run()
    found = board.findings.of("can-part-lost")
    assert [finding.object for finding in found] == [lost] * bool(lost)
    assert all(f.place is not None and at in text.splitlines()[f.place.line - 1] for f in found)
    assert valid == (0b11 if not lost.endswith("ARB") else 0b01 if "2" in lost else 0b10)
    # What the findings say is so: the bytes of the second message are in the object, or those of the first are not.
    low, high = board.can["A"].ram[2].data
    assert low == (0 if lost.endswith("DATA") else low)
    assert high == (0 if lost.endswith("DATB") else high)
