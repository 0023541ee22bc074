"""`while (1) ;` idles for ever, as the `main` of most programs without a kernel ends; only a poll is waited for.

Times are those of CPU timer 0 at 200 MHz: 200 MHz * 1000 us is an interrupt every millisecond.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from emulator.c28x.runtime import EndlessPoll, Idling
from hil.image import Build, Image
from hil.testing.guard import guard
from hil.testing.tasks import Tasks
from hil.testing.timeline import Timeline

HEAD_C = """\
#include "F28x_Project.h"
volatile Uint16 Ticks = 0, Flag = 0;
Uint32 Turns = 0;
__interrupt void Tick(void) { Ticks++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
void main(void)
{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
"""
TIMER_C = """\
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    CpuTimer0Regs.TCR.all = 0x4000;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
"""
HEAD_PY = '''"""drv.c"""
from emulator.c28x.language import *
from emulator.device_h import *

Ticks: volatile[uint16] = 0
Flag: volatile[uint16] = 0
Turns: uint32 = 0


# drv.c: Tick
def Tick() -> void:
    Ticks += 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: main
def main() -> void:
    global Turns
    InitSysCtrl()
    DINT()
    InitPieCtrl()
    IER = 0x0000
    IFR = 0x0000
    InitPieVectTable()
'''
TIMER_PY = """\
    EALLOW()
    PieVectTable.TIMER0_INT = Tick
    EDIS()
    InitCpuTimers()
    ConfigCpuTimer(CpuTimer0, 200.0, 1000.0)
    CpuTimer0Regs.TCR.all = 0x4000
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1
    IER |= M_INT1
"""
LOOPS = {
    "for": (".c", "for (;;) ;"),
    "while": (".c", "while (1) { }"),
    "do": (".c", "do ; while (1);"),
    "nop": (".c", 'while (1) asm(" NOP");'),
    "nops": (".c", 'for (;;) { asm(" NOP"); asm(" NOP"); }'),
    "counting": (".c", "for (;;) { Turns++; }"),
    "continue": (".c", "for (;;) { continue; }"),
    "asleep": (".c", 'for (;;) { asm(" IDLE"); }'),
    "pass": (".py", "while 1:\n        pass"),
    "counting in Python": (".py", "while 1:\n        Turns += 1"),
}
#: What stands before the loop: whether the timer runs, and whether interrupts are on.
BEFORE = {"off": (False, False), "on": (False, True), "events only": (True, False), "interrupts": (True, True)}

Link = Callable[..., Image]


@pytest.fixture
def link(tmp_path: Path) -> Link:
    """An image of `main` that ends in a loop, by the ending of its file."""

    def link(suffix: str, loop: str, *, timer: bool = False, enabled: bool = False) -> Image:
        if suffix == ".c":
            pytest.importorskip("pycparser")
        in_c = suffix == ".c"
        text = (HEAD_C if in_c else HEAD_PY) + (TIMER_C if in_c else TIMER_PY) * timer
        text += ("    EINT;\n" if in_c else "    EINT()\n") * enabled + f"    {loop}\n" + ("}\n" if in_c else "")
        file = tmp_path / f"drv{suffix}"
        file.write_text(text, encoding="utf-8")
        return Build([str(file)]).image()

    return link


def started(image: Image) -> Timeline:
    """Its `main` begun under the fixture `kernel`'s driver."""
    timeline = Timeline(image.board)
    Tasks(image.board, timeline).start(image.linked.functions["drv.main"])
    return timeline


def rules(image: Image) -> list[str]:
    return [finding.rule for finding in image.findings if finding.how == "dynamic"]


@pytest.mark.parametrize("before", BEFORE)
@pytest.mark.parametrize("loop", LOOPS)
def test_a_loop_without_an_end_idles_through_every_advance(link: Link, loop: str, before: str) -> None:
    timer, enabled = BEFORE[before]
    image = link(*LOOPS[loop], timer=timer, enabled=enabled)
    timeline = started(image)
    for step_s in (0.0025, 0.002, 0.002, 0.0):
        timeline.advance(step_s)
    assert rules(image) == []
    # 6.5 ms less 1.6 ms of the start-up, which waits for the PLL: four whole periods.
    assert image.linked.objects["drv.Ticks"].data[0] == (4 if timer and enabled else 0)
    image.close()


def test_a_main_that_counts_for_longer_than_a_computation_may_last_is_its_idle_loop(link: Link) -> None:
    image = link(*LOOPS["counting"])
    timeline = started(image)
    image.allow_loops(200_000)  # 1 ms, to be quick: the limit is 0.2 s
    timeline.advance(0.002)
    assert rules(image) == []
    image.close()


def test_a_poll_ends_in_the_advance_in_which_its_flag_is_set(link: Link) -> None:
    image = link(".c", "while (Flag == 0) ; for (;;) Turns = 1;")
    timeline = started(image)
    for _ in range(3):
        timeline.advance(0.001)
    assert image.linked.objects["drv.Turns"].data[0] == 0
    image.linked.objects["drv.Flag"].data[0] = 1
    timeline.advance(0.001)
    assert image.linked.objects["drv.Turns"].data[0] == 1
    assert rules(image) == []
    image.close()


def test_a_poll_of_what_nothing_can_change_is_a_finding(link: Link) -> None:
    image = link(".c", "while (Flag == 0) ;")
    with pytest.raises(EndlessPoll, match=r"drv\.Flag is polled, but no event is left"):
        image.call("drv.main", ())
    assert rules(image) == ["endless-poll"]


@pytest.mark.parametrize("before", BEFORE)
@pytest.mark.parametrize("loop", ["for", "nop", "pass"])
def test_a_call_of_a_function_that_idles_ends_without_a_finding(link: Link, loop: str, before: str) -> None:
    timer, enabled = BEFORE[before]
    image = link(*LOOPS[loop], timer=timer, enabled=enabled)
    guard(image.board, image.linked, 0.01)
    with pytest.raises(Idling, match=r"drv\.main idles for ever .*kernel\.start"):
        image.call("drv.main", ())
    assert rules(image) == []


def test_an_interrupt_routine_that_idles_is_a_finding(link: Link, tmp_path: Path) -> None:
    pytest.importorskip("pycparser")
    file = tmp_path / "drv.c"
    text = HEAD_C.replace("Ticks++;", "Ticks++; for (;;) ;") + TIMER_C + "    EINT;\n    for (;;) ;\n}\n"
    file.write_text(text, encoding="utf-8")
    image = Build([str(file)]).image()
    guard(image.board, image.linked, 0.01)
    with pytest.raises(EndlessPoll, match="without returning"):
        image.call("drv.main", ())
    assert rules(image) == ["endless-poll"]
    assert image.findings[-1].place is not None
    assert image.findings[-1].place.function == "Tick"
