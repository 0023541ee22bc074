"""Drivers of a few lines: what is found in them, and at which line (`#!` marks it).  In C on a chip without a board."""

from __future__ import annotations

from random import Random
from typing import Any

from emulator.c28x.findings import Finding
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.rts_functions import library
from emulator.c28x.runtime import Runtime
from emulator.chip import Chip
from emulator.clock import CYCLES_PER_MS
from emulator.device_functions import DeviceFunctions
from hil.robot.board import RobotBoard
from tests.emulator.c28x.linking import link

HEADER = '''"""drv.c: a specimen."""
from emulator.c28x.language import *
from emulator.device_h import *
'''


#: How a program of this chip begins.
START_UP = """    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
"""


def with_ticks(period_us: int) -> str:
    """How `main` begins if the routine `Tick` runs each `period_us`, by CPU timer 0."""
    return START_UP + f"""    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, {period_us});
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    StartCpuTimer0();
"""


class Driver:
    """A linked piece of source on a board whose parts are ideal; its functions are attributes."""

    def __init__(self, source: str) -> None:
        self.board = board = RobotBoard()
        self.findings = board.findings
        self.lines = (HEADER + source).splitlines()
        runtime = Runtime(board.clock, board.cpu, board.findings, board.memory)
        program = Program()
        program.add("drv", "drv.py", HEADER + source)
        externs = library(runtime)
        externs |= board.externs()
        self.linked = link(
            program, runtime, CompileOptions(watch=False), registers=board.register, externs=externs, replaced={}
        )

    def __getattr__(self, name: str) -> Any:
        return self.linked.functions[f"drv.{name}"]

    def wait_ms(self, milliseconds: float) -> None:
        """Let time pass with the firmware idle."""
        self.board.clock.advance_to(self.board.clock.now + round(milliseconds * CYCLES_PER_MS))

    def rules(self) -> list[str]:
        """Rules found so far, each once, in alphabetical order."""
        return sorted({finding.rule for finding in self.findings})

    def only(self, rule: str) -> Finding:
        """The one finding there is: it is of `rule`, and stands at the marked line if one is marked."""
        findings = list(self.findings)
        assert [finding.rule for finding in findings] == [rule], [f"{f.rule}: {f.message}" for f in findings]
        marked = [number for number, line in enumerate(self.lines, 1) if line.endswith("#!")]
        if marked:
            place = findings[0].place
            assert place is not None
            assert place.line in marked, f"{place} is not the marked line"
        return findings[0]


C_HEADER = """#include "F28x_Project.h"

static void start(void)
{
""" + START_UP + """}
"""


class CChip:
    """A C file, linked to a chip without a board."""

    def __init__(self, text: str) -> None:
        self.chip = chip = Chip(rng=Random(0))
        runtime = Runtime(chip.clock, chip.cpu, chip.findings, chip.memory, register_at=chip.register_at)
        externs: dict[str, Any] = library(runtime)
        program = Program()
        program.add("drv", "drv.c", C_HEADER + text)
        self.linked = link(
            program, runtime, CompileOptions(), registers=chip.register, externs=externs | DeviceFunctions(chip).externs
        )

    def call(self, name: str, *arguments: Any) -> Any:
        return self.linked.functions[f"drv.{name}"](*arguments)

    def data(self, name: str) -> list[Any]:
        return self.linked.objects[f"drv.{name}"].data

    def wait_ms(self, milliseconds: float) -> None:
        clock = self.chip.clock
        clock.advance_to(clock.now + round(milliseconds * CYCLES_PER_MS))

    def found(self) -> list[tuple[str, str]]:
        return [(finding.rule, finding.object) for finding in self.chip.findings]
