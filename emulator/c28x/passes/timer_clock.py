"""Static check of `ConfigCpuTimer`: is the timer told the clock that the program sets?

It needs to know SYSCLK.  `InitSysCtrl` makes 200 MHz.  A program that does not call it, or sets up the PLL itself, is
not checked.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

from emulator.c28x.passes.report import StaticReport
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Call, Const, Function, RegisterRef, Stmt
from emulator.c28x.tree_queries import bare, own_nodes, source_text, statements

#: What InitSysCtrl makes (HDR F2837xS_SysCtrl.c).
SYSCLK_MHZ: Final = 200
#: With 1 MHz the period is meant in cycles.
_IN_CYCLES: Final = 1
_SYSCLK_REGISTERS: Final = frozenset({"SYSPLLMULT", "SYSCLKDIVSEL", "SYSPLLCTL1", "CLKSRCCTL1"})
_CLOCK_OF_TIMER_2: Final = "TMR2CLKCTL"


def check_timer_clocks(reports: Mapping[Module, StaticReport]) -> None:
    """Report each call of `ConfigCpuTimer` with a constant frequency that is not SYSCLK's."""
    functions = [(function, report) for module, report in reports.items() for function in module.functions]
    called = {path.rpartition(".")[2] for function, _ in functions for path in function.calls}
    if "ConfigCpuTimer" not in called or "InitSysCtrl" not in called or "InitSysPll" in called:
        return
    registers = {p.register for function, _ in functions for _, p in _nodes(function) if isinstance(p, RegisterRef)}
    if registers & _SYSCLK_REGISTERS:
        return
    for function, report in functions:
        for s, p in _nodes(function):
            if isinstance(p, Call) and p.function.name == "ConfigCpuTimer" and len(p.arguments) == 3:
                timer, told, period = p.arguments
                mhz = bare(told)
                if not isinstance(mhz, Const) or mhz.value in (SYSCLK_MHZ, _IN_CYCLES):
                    continue
                if _CLOCK_OF_TIMER_2 in registers and "2" in source_text(timer):
                    continue
                message = (
                    f"ConfigCpuTimer is told a clock of {mhz.value:g} MHz, and SYSCLK has {SYSCLK_MHZ} MHz: the period "
                    f"is {mhz.value / SYSCLK_MHZ:g} * {source_text(bare(period))} us"
                )
                report.report(function, s.where, "timer-clock", message, value=mhz.value)


def _nodes(function: Function) -> Iterator[tuple[Stmt, object]]:
    """Every part of a function, with its statement."""
    for s in statements(function.body):
        for p in own_nodes(s):
            yield s, p
