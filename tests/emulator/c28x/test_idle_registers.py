"""Turns of a loop that only look at registers are skipped too: the same cycle, objects, registers and findings."""

from __future__ import annotations

from functools import cache, partial
from random import Random
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.c28x.compile import compile_program
from emulator.c28x.compiled_program import Compiled
from emulator.c28x.link import Linked
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.rts_functions import library
from emulator.c28x.runtime import Runtime
from emulator.chip import Chip
from emulator.device_functions import DeviceFunctions
from emulator.signals import SerialFrame

#: Each function ends when GPIO10 is high.  GPIO11 changes, and SCI-A gets characters.
SOURCE = """#include "F28x_Project.h"
Uint16 Seen, Turns, Rises, Bytes[64], Taken;
void start(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    CpuSysRegs.PCLKCR0.bit.CPUTIMER0 = 1;
    EDIS;
    GPIO_SetupPinMux(28, GPIO_MUX_CPU1, 1);
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCICTL1.all = 0x0023;
    CpuTimer0Regs.PRD.all = 29999;
    CpuTimer0Regs.TCR.all = 0x0020;
}
void levels(void)  /* the edges of a pin */
{
    Uint16 before = 0, now;
    for (;;) {
        if (GpioDataRegs.GPADAT.bit.GPIO10)
            break;
        now = GpioDataRegs.GPADAT.bit.GPIO11;
        if (now != before) {
            before = now;
            Rises += now;
        }
    }
}
void characters(void)  /* and the edges of a pin */
{
    while (!GpioDataRegs.GPADAT.bit.GPIO10) {
        if (SciaRegs.SCIRXST.bit.RXRDY) {
            Bytes[Taken & 63] = SciaRegs.SCIRXBUF.bit.SAR;
            Taken++;
        }
        if (SciaRegs.SCICTL2.bit.TXRDY && GpioDataRegs.GPADAT.bit.GPIO11)
            SciaRegs.SCITXBUF.all = Taken;
    }
}
void ticks(void)  /* of a timer, by its flag */
{
    while (!GpioDataRegs.GPADAT.bit.GPIO10) {
        if (CpuTimer0Regs.TCR.bit.TIF) {
            CpuTimer0Regs.TCR.bit.TIF = 1;
            Turns++;
        }
    }
}
void flags(void)  /* of one that stays set: each read from the second period on is told */
{
    while (!GpioDataRegs.GPADAT.bit.GPIO10) {
        if (CpuTimer0Regs.TCR.bit.TIF && GpioDataRegs.GPADAT.bit.GPIO11) {
            CpuTimer0Regs.TCR.bit.TIF = 1;
            Rises++;
        }
    }
}
void counted(void)  /* by a register that changes by itself */
{
    while (!GpioDataRegs.GPADAT.bit.GPIO10) {
        if (CpuTimer0Regs.TIM.all < 100)
            Seen++;
    }
}
void taken(void)  /* by reading */
{
    Uint16 c;
    while (!GpioDataRegs.GPADAT.bit.GPIO10) {
        c = SciaRegs.SCIRXBUF.all;
        if (c == 0x55)
            Seen++;
    }
}
void gated(void)  /* a module without clock */
{
    while (!GpioDataRegs.GPADAT.bit.GPIO10) {
        if (ScibRegs.SCIRXST.bit.RXRDY)
            Seen++;
    }
}
"""
SKIPPED = ("levels", "characters", "ticks")
EXECUTED = ("counted", "taken", "gated")
#: Cycles from one change to the next, and what it is: GPIO11, or a character.
GAPS = st.lists(st.tuples(st.integers(0, 30_000), st.sampled_from(["pin", "character"])), min_size=3, max_size=8)


@cache
def compiled() -> Compiled:
    """The program, for every chip."""
    program, chip = Program(), Chip(rng=Random(0))
    program.add("drv", "drv.c", SOURCE)
    return compile_program(
        program, CompileOptions(watch=True), lambda block, name: chip.register(block, name).looked_at
    )


def run(name: str, gaps: list[tuple[int, str]], *, skips: bool) -> tuple[Any, int]:
    """What a function leaves while the inputs change after each of `gaps`; the cycles that were executed."""
    chip = Chip(rng=Random(0))
    runtime = Runtime(chip.clock, chip.cpu, chip.findings, chip.memory, register_at=chip.register_at)
    externs: dict[str, Any] = library(runtime)
    linked = Linked(
        compiled(), runtime, registers=chip.register, externs=externs | DeviceFunctions(chip).externs, replaced={}
    )
    if skips:
        linked.skip_turns()
    linked.functions["drv.start"]()
    for pin in (10, 11):
        chip.pins[pin].drive("test", 0)
    at = chip.clock.now
    level = 0
    for number, (gap, what) in enumerate(gaps):
        at += gap
        if what == "pin":
            level = 1 - level
            chip.clock.schedule(at, partial(chip.pins[11].drive, "test", level))
        else:
            frame = SerialFrame(0x50 + number, at, at + 17_280, 1728.0)
            chip.clock.schedule(frame.end, partial(chip.serial_pins[28].send, frame))
    chip.clock.schedule(at + 20_000, lambda: chip.pins[10].drive("test", 1))
    began = chip.clock.now - chip.clock.waited
    linked.functions[f"drv.{name}"]()
    clock = chip.clock
    found = [(finding.rule, finding.count, finding.time_us) for finding in chip.findings]
    objects = {path: list(obj.data) for path, obj in linked.objects.items()}
    registers = {
        f"{block}.{register.name}": register.value
        for block in ("SciaRegs", "CpuTimer0Regs", "GpioDataRegs") for register in chip.blocks[block]
    }  # fmt: skip
    return (clock.now, found, objects, registers), clock.now - clock.waited - began


@pytest.mark.parametrize("name", [*SKIPPED, "flags", *EXECUTED])
@settings(max_examples=6)
@given(gaps=GAPS)
def test_a_run_that_skips_is_the_run_that_does_not(name: str, gaps: list[tuple[int, str]]) -> None:
    assert run(name, gaps, skips=True)[0] == run(name, gaps, skips=False)[0]


LONG = [(200_000, "pin"), (200_000, "character")] * 2


@pytest.mark.parametrize("name", SKIPPED)
def test_turns_that_only_look_are_not_executed(name: str) -> None:
    outcome, executed = run(name, LONG, skips=True)
    assert outcome[0] > 800_000
    assert executed < 80_000


@pytest.mark.parametrize("name", EXECUTED)
def test_turns_that_a_register_notices_or_that_see_it_change_are_executed(name: str) -> None:
    _, executed = run(name, LONG[:1], skips=True)
    assert executed > 200_000
