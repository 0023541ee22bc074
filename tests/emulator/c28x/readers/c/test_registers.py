"""Registers in C: by name, by field, by address, and through a pointer to their block."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.c28x.link import Linked
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.readers.c import headers
from emulator.c28x.rts_functions import library
from emulator.c28x.runtime import EndlessPoll
from emulator.c28x.symbols import SourceError
from emulator.image import runtime_of
from emulator.system import System
from tests.emulator.c28x.linking import link

HEAD = """#include "F28x_Project.h"
volatile struct EPWM_REGS *pwm = &EPwm1Regs;
volatile struct EPWM_REGS *const table[2] = { &EPwm1Regs, &EPwm2Regs };
void setup(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR2.bit.EPWM2 = 1;
    EDIS;
}
"""


class Robot:
    """A C file on a board."""

    def __init__(self, text: str) -> None:
        self.board = board = System()
        runtime = runtime_of(board)
        externs: dict[str, Any] = library(runtime)
        program = Program()
        program.add("drv", "drv.c", text)
        self.linked: Linked = link(
            program, runtime, CompileOptions(), registers=board.register, externs=externs | dict(board.externs())
        )
        self.linked.functions["drv.setup"]()

    def call(self, name: str) -> Any:
        """What a function gives."""
        return self.linked.functions[f"drv.{name}"]()

    def rules(self) -> list[str]:
        """What was found."""
        return [finding.rule for finding in self.board.findings]


@pytest.mark.parametrize(
    ("body", "value"),
    [
        ("pwm->TBPRD = 1000; return EPwm1Regs.TBPRD;", 1000),
        ("table[1]->TBPRD = 77; return EPwm2Regs.TBPRD;", 77),
        ("pwm->TBCTL.bit.CTRMODE = 2; return EPwm1Regs.TBCTL.bit.CTRMODE;", 2),
        ("EPwm1Regs.TBCTL.bit.CTRMODE = 1; return (*pwm).TBCTL.bit.CTRMODE;", 1),
        # TBCTL resets to 0x0083: CLKDIV 0, HSPCLKDIV 1, CTRMODE 3
        ("return pwm->TBCTL.all;", 0x83),
        ("volatile unsigned int *p = &EPwm1Regs.TBPRD; *p = 5; return EPwm1Regs.TBPRD;", 5),
        ("volatile unsigned int *p = &pwm->TBPRD; *p = 6; return EPwm1Regs.TBPRD;", 6),
        # TBPRD of ePWM1 stands at 0x4000 + 0x63
        ("*(volatile unsigned int *)0x4063UL |= 0x10; return EPwm1Regs.TBPRD;", 0x10),
        ("return pwm == &EPwm1Regs;", 1),
        # a register with fields is a union: by its address it is reached in the same way
        ("volatile union TBCTL_REG *p = &EPwm1Regs.TBCTL; p->bit.CTRMODE = 1; return EPwm1Regs.TBCTL.all;", 0x81),
        ("volatile struct TBCTL_BITS *p = &pwm->TBCTL.bit; p->CTRMODE = 1; return EPwm1Regs.TBCTL.all;", 0x81),
        ("(&pwm->TBCTL)->all = 5; return (*&EPwm1Regs.TBCTL).bit.CTRMODE;", 1),
        # CMPA stands at 0x6A, CMPB one register of 32 bits behind it
        ("(&EPwm1Regs.CMPA)[1].bit.CMPA = 9; return (&table[0]->CMPA + 1)->bit.CMPA + EPwm1Regs.CMPB.bit.CMPB;", 18),
        ("IER |= 1; return IER;", 1),
        ("unsigned int before = __disable_interrupts(); __restore_interrupts(before); return before;", 1),
    ],
)
def test_a_register_is_one_register_however_it_is_reached(body: str, value: int) -> None:
    robot = Robot(f"{HEAD}unsigned int f(void)\n{{\n    {body}\n}}\n")
    assert robot.call("f") == value
    assert robot.rules() == []


@pytest.mark.parametrize(
    ("body", "column", "message"),
    [
        ("return EPwm1Regs.NOSUCH;", 12, "EPwm1Regs has no register NOSUCH"),
        ("return EPwm1Regs.TBCTL.bit.NOSUCH;", 12, "has no field NOSUCH"),
        ("return EPwm1Regs.TBCTL;", 12, "C writes EPwm1Regs.TBCTL.all or .bit.FIELD"),
        ("return &EPwm1Regs.TBCTL.bit.CTRMODE != 0;", 13, "a bit-field has no address"),
        ("return &Cla1Regs != 0;", 13, "Cla1Regs is a peripheral of this chip that is not modelled"),
        ("return &Cla1Regs.MCTL.all != 0;", 13, "only its registers by name are known"),
        ("return &Cla1Regs.MCTL != 0;", 13, "only its registers by name are known"),
        ("return Cla1Regs.MCTL.bit;", 12, "only its registers by name are known"),
        ("return sizeof(Cla1Regs);", 12, "the size of a Cla1Regs is not known here"),
        ("return (pwm + 1)->TBPRD;", 13, "has no next one"),
    ],
)
def test_what_is_no_register_is_refused_at_its_place(body: str, column: int, message: str) -> None:
    with pytest.raises(SourceError, match=message) as caught:
        Robot(f"{HEAD}unsigned int f(void)\n{{\n    {body}\n}}\n")
    assert (caught.value.line, caught.value.column) == (13, column)


# Blocks that are not modelled


def touched(robot: Robot) -> list[str]:
    """What was told of blocks that are not modelled, without the beginning that all of it has."""
    said = [finding.message for finding in robot.board.findings if finding.rule == "unmodelled"]
    begins = "MemCfgRegs is a peripheral of this chip that is not modelled: MemCfgRegs."
    assert all(message.startswith(begins) for message in said)
    return [message.removeprefix(begins) for message in said]


@pytest.mark.parametrize(
    ("body", "value", "said"),
    [
        ("return MemCfgRegs.LSxMSEL.all;", 0, ["LSxMSEL reads what was written to it"]),
        ("return MemCfgRegs.LSxMSEL;", 0, ["LSxMSEL reads what was written to it"]),
        ("return MemCfgRegs.LSxMSEL.bit.MSEL_LS0 + 1;", 1, ["LSxMSEL.MSEL_LS0 reads what was written to it"]),
        ("MemCfgRegs.LSxMSEL.all = 5; return 4;", 4, ["LSxMSEL only holds what is written to it"]),
        # read, modified and written on one line: what is told of the object first stands there
        ("MemCfgRegs.A.all |= 5; return 4;", 4, ["A reads what was written to it"]),
        ("MemCfgRegs.A.bit.F = 2; MemCfgRegs.B = 1; return 4;", 4,
         ["A.F only holds what is written to it", "B only holds what is written to it"]),
        ("MemCfgRegs.A.bit.F = 2; return MemCfgRegs.A.bit.F;", 2, ["A.F only holds what is written to it"]),
        ("MemCfgRegs.A.all = 0x12345; return MemCfgRegs.A.all >> 8;", 0x123, ["A only holds what is written to it"]),
        ("switch (MemCfgRegs.A.bit.F) { case 0: return 7; } return 8;", 7, ["A.F reads what was written to it"]),
    ],
)  # fmt: skip
def test_a_block_that_is_not_modelled_says_so_where_it_is_touched(body: str, value: int, said: list[str]) -> None:
    robot = Robot(f"{HEAD}unsigned long f(void)\n{{\n    {body}\n}}\n")
    assert touched(robot) == []
    assert robot.call("f") == value
    assert touched(robot) == said
    assert set(robot.rules()) == {"unmodelled"}


@pytest.mark.parametrize(
    ("test", "register"),
    [
        ("MemCfgRegs.INITDONE.bit.GS0 == 0", "INITDONE.GS0"), ("(MemCfgRegs.INITDONE.all & 1) != 1", "INITDONE"),
        ("!MemCfgRegs.INITDONE", "INITDONE"), ("MemCfgRegs.INITDONE.bit.GS0 != 1", "INITDONE.GS0"),
        ("MemCfgRegs.INITDONE.all != 0xFFFFFFFF", "INITDONE"),
    ],
)  # fmt: skip
def test_a_wait_for_a_block_that_is_not_modelled_ends(test: str, register: str) -> None:
    robot = Robot(f"{HEAD}unsigned int f(void)\n{{\n    while ({test});\n    return 9;\n}}\n")
    assert robot.call("f") == 9
    assert touched(robot) == [
        f"{register} reads what was written to it", f"{register} is polled: the emulator changes it to end the wait"
    ]  # fmt: skip
    assert set(robot.rules()) == {"unmodelled"}


def test_a_wait_for_what_a_program_wrote_itself_ends_too() -> None:
    robot = Robot(
        f"{HEAD}int f(void)\n{{\n    MemCfgRegs.A.bit.GO = 1;\n    while (MemCfgRegs.A.bit.GO);\n"
        "    MemCfgRegs.A.bit.GO = 1;\n    while (MemCfgRegs.A.bit.GO);\n    return 9;\n}\n"
    )
    assert robot.call("f") == 9
    assert set(robot.rules()) == {"unmodelled"}


def test_a_wait_for_a_value_that_nobody_would_guess_is_endless() -> None:
    robot = Robot(f"{HEAD}int f(void)\n{{\n    while (MemCfgRegs.A.all != 5);\n    return 9;\n}}\n")
    with pytest.raises(EndlessPoll):
        robot.call("f")
    assert set(robot.rules()) == {"unmodelled", "endless-poll"}


def test_what_uses_a_block_that_is_not_modelled_and_is_never_called_says_nothing() -> None:
    unlock = "void unlock(void)\n{\n    DcsmZ1Regs.Z1_CSMKEY0 = 0;\n}\n"
    robot = Robot(f"{HEAD}{unlock}int f(void)\n{{\n    return 3;\n}}\n")
    assert robot.call("f") == 3
    assert robot.rules() == []


def test_a_file_of_the_project_may_define_all_blocks_of_the_chip() -> None:
    # TI's F2837xS_GlobalVariableDefs.c does, and lies in the folder of most projects.
    tags = {name: block.struct for name, block in headers.instances().items()}
    tags |= {name: f"{name.upper()}_REGS" for name in headers.unmodelled()}
    defined = "".join(
        f'#pragma DATA_SECTION({name},"{name}File");\nvolatile struct {tag} {name};\n' for name, tag in tags.items()
    )
    assert len(tags) > 100
    uses = "int f(void)\n{\n    pwm->TBPRD = 7;\n    Cla1Regs.MIER.all = 1;\n    return EPwm1Regs.TBPRD;\n}\n"
    robot = Robot(f"{HEAD}{defined}{uses}")
    assert robot.call("f") == 7
    assert robot.rules() == ["unmodelled"], "no pragma is ignored: the blocks have their addresses"
