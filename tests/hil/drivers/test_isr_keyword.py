"""Routines of the vector table are declared `interrupt`, functions of a Hwi are not."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files
from tests.emulator.drivers import with_ticks

BARE = """#include "F28x_Project.h"
volatile Uint16 Count;
BEFORE void Tick(void)
{
    Count++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
    END
}
void main(void)
{
""" + with_ticks(100) + """    for (;;) { }
}
"""

KERNEL = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
BEFORE void Tick(UArg arg)
{
}
int main(void)
{
    Hwi_create(38, (Hwi_FuncPtr)Tick, NULL, NULL);
    BIOS_start();
    return 0;
}
"""


def told(text: str, folder: Path) -> list[tuple[str, int]]:
    """Object and line of the findings of this rule."""
    file = folder / "drv.c"
    file.write_text(text, encoding="utf-8")
    findings = check_files(DriverFiles([file], seconds=0.005)).findings
    assert all(finding.place is not None for finding in findings)
    return [(f.object, f.place.line) for f in findings if f.rule == "isr-keyword" and f.place is not None]


@pytest.mark.parametrize("before", ["", "static"])
def test_a_routine_without_the_word_is_told_when_it_returns(before: str, tmp_path: Path) -> None:
    assert told(BARE.replace("BEFORE", before).replace("END", ""), tmp_path) == [("Tick", 3)]


@pytest.mark.parametrize("before", [
    "interrupt", "__interrupt", "static __interrupt", "__attribute__((interrupt))", "__interrupt void Tick(void);",
    "#pragma INTERRUPT(Tick)\n", '#pragma INTERRUPT ( Tick, "HPI" )\n',
    '#pragma CODE_SECTION(Tick, "ramfuncs")\ninterrupt',
])  # fmt: skip
def test_a_routine_that_is_declared_so_in_any_way_is_right(before: str, tmp_path: Path) -> None:
    assert told(BARE.replace("BEFORE", before).replace("END", ""), tmp_path) == []


def test_a_routine_that_never_returns_needs_no_word(tmp_path: Path) -> None:
    assert told(BARE.replace("BEFORE", "").replace("END", "for (;;) { }"), tmp_path) == []


@pytest.mark.parametrize(("before", "found"), [("interrupt", [("Tick", 4)]), ("", []), ("static", [])])
def test_the_function_of_a_hwi_is_told_with_the_word(
    before: str, found: list[tuple[str, int]], tmp_path: Path
) -> None:
    assert told(KERNEL.replace("BEFORE", before), tmp_path) == found
