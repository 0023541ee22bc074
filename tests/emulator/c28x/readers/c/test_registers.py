"""Registers in C: by name, by field, by address, and through a pointer to their block."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.c28x.compile import Options
from emulator.c28x.link import Linked, link
from emulator.c28x.program import Program
from emulator.c28x.rts_functions import Rts
from emulator.c28x.runtime import Runtime
from emulator.c28x.symbols import SourceError
from emulator.system import System

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
        runtime = Runtime(board.clock, board.cpu, board.findings, board.memory)
        board.memory.fill_word = runtime.fill_word
        runtime.register_at = board.register_at
        rts = Rts(runtime)
        externs: dict[str, Any] = {name: getattr(rts, name) for name in dir(rts) if not name.startswith("_")}
        program = Program()
        program.add("drv", "drv.c", text)
        self.linked: Linked = link(
            program, runtime, Options(), registers=board.register, externs=externs | dict(board.externs(runtime))
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
        ("return Cla1Regs.MCTL.all;", 12, "Cla1Regs is a peripheral of this chip that is not modelled"),
        ("return (pwm + 1)->TBPRD;", 13, "has no next one"),
    ],
)
def test_what_is_no_register_is_refused_at_its_place(body: str, column: int, message: str) -> None:
    with pytest.raises(SourceError, match=message) as caught:
        Robot(f"{HEAD}unsigned int f(void)\n{{\n    {body}\n}}\n")
    assert (caught.value.line, caught.value.column) == (13, column)
