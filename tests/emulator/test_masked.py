"""Interrupts that a way through a function leaves off are told at the way out; right functions are not."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

BARE = """#include "F28x_Project.h"
volatile Uint16 Late = 0, Seen = 0;
static void Unmask(void) {{ EINT; }}
static void Mask(void) {{ DINT; }}
Uint16 {name}(Uint16 n)
{{
    Uint16 i;
{body}
    return 0;
}}
void main(void)
{{
    for (;;)
        {name}(2);
}}
"""
BIOS = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/hal/Hwi.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/knl/Swi.h>
volatile Int Seen = 0;
Void work(UArg a, UArg b)
{
    UInt key;
%s
}
Int main(Void)
{
    if (Seen == 7)  /* the source is enough */
        Task_create(work, NULL, NULL);
    BIOS_start();
    return 0;
}
"""


def told(folder: Path, text: str) -> list[str]:
    """The statements of which the rule speaks."""
    file = folder / "drv.c"
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, seconds=0.001, board=load("bare"))).findings
    places = [finding.place for finding in found if finding.rule == "interrupts-left-off"]
    return [text.splitlines()[place.line - 1].strip() for place in places if place]


@pytest.mark.parametrize(("body", "at"), [
    ("DINT; Seen++;\n if (Late)\n return 1;\n Late = 0; EINT;", "return 1;"),
    ("for (i = 0; i < n; i++) { DINT; Seen++;\n if (Late)\n continue;\n Late = 0; EINT; }", "continue;"),
    ("DINT; switch (n) { case 0: Late = 0;\n return 2;\n default: Late = 1; } EINT;", "return 2;"),
    # By the intrinsics, with a key, by functions of the program.
    ("i = __disable_interrupts(); Seen++;\n if (Late)\n return 1;\n Late = 0; __restore_interrupts(i);", "return 1;"),
    ("Mask(); do { if (Late) break;\n return 1;\n } while (0); Unmask();", "return 1;"),
])  # fmt: skip
def test_a_way_that_leaves_interrupts_off_is_told(tmp_path: Path, body: str, at: str) -> None:
    assert told(tmp_path, BARE.format(name="Work", body=body)) == [at]


@pytest.mark.parametrize(("name", "body"), [
    ("Work", "DINT; Seen++; if (Late) { EINT; return 1; } Late = 0; EINT;"),
    ("Work", "for (i = 0; i < n; i++) { EINT; Seen++; DINT; Seen--; if (Late) continue; EINT; }"),
    # It is meant: right before the way out, or by a function that does not switch on.
    ("Work", "if (Late) { DINT; return 1; } DINT; Seen++; EINT;"),
    ("Work", "DINT; Seen++; if (Late) return 1; Late = 0;"),
    ("Work", "DINT; Seen++; if (Late) { Unmask(); return 1; } Late = 0; EINT;"),
    ("Work", "if (n) DINT; Seen++; if (Late) return 1; if (n) EINT;"),
    # The DINT before the loop is in force in all of its turns.
    ("Work", "DINT; for (i = 0; i < n; i++) { if (Late) continue; Seen++; } EINT;"),
    ("Work", "while (n) { DINT; Seen++; if (Late) break; n--; EINT; } EINT;"),
    # A turn of the loop switches on, or a function in a condition does.
    ("Work", "DINT; for (;;) { if (!Late) { Late = 1; EINT; break; } EINT; Seen++; DINT; } return n;"),
    ("Work", "DINT; do { Seen++; n++; EINT; } while (n < 3); return n;"),
    ("Work", "DINT; Seen++; if (n > 3 && (Unmask(), Late)) return 1; EINT;"),
    ("Work", "i = __disable_interrupts(); Seen++; if (Late) return i; Late = 0; __restore_interrupts(i);"),
    ("Take_It", "Mask(); Seen++; if (!Late) { Unmask(); return 0; } return 1;"),
    ("Sensor_Init", "DINT; Seen++; if (Late) return 1; Late = 0; EINT;"),
])  # fmt: skip
def test_ways_that_switch_on_again_are_not_told(tmp_path: Path, name: str, body: str) -> None:
    assert told(tmp_path, BARE.format(name=name, body=body)) == []


@pytest.mark.parametrize(("body", "found"), [
    ("key = Hwi_disable(); Seen++;", True),
    ("key = Hwi_disable(); Seen++; Hwi_restore(key);", False),
    ("key = Swi_disable(); Seen++;", True),
    ("key = Task_disable(); Seen++; Hwi_restore(key);", False),
    ("key = Hwi_disable(); Seen++; Hwi_enable();", False),
    ("key = Hwi_disable(); for (;;) Seen++;", False),
    ("Hwi_disable(); Seen++;", False),
    ("key = Task_disable(); if (Seen > 3) { Seen++; return; } Task_restore(key);", True),
    ("key = Task_disable(); if (Seen > 3) { Task_restore(key); return; } Task_restore(key);", False),
])  # fmt: skip
def test_a_key_that_nothing_uses_is_told(tmp_path: Path, body: str, found: bool) -> None:
    assert told(tmp_path, BIOS % f"    {body}") == [body] * found
