"""Ways through a function that do not leave a gate: taken in the run, and only in the source."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/gates/GateMutexPri.h>
GateMutexPri_Handle gate;
Int Shown = 0, Wanted = 0;
IArg Key;
Void Lock(Void) { Key = GateMutexPri_enter(gate); }
Void Unlock(Void) { GateMutexPri_leave(gate, Key); }
Void worker(UArg a, UArg b)
{
    IArg key;
    for (;;) {
        Task_sleep(10);
        BODY
    }
}
Int main(Void)
{
    Task_Params t;
    gate = GateMutexPri_create(NULL, NULL);
    Task_Params_init(&t);
    t.priority = 2;
    t.stackSize = 512;
    Task_create(worker, &t, NULL);
    BIOS_start();
    return 0;
}
"""
PARTNERS = (
    "Void Lock(Void) { Key = GateMutexPri_enter(gate); }\n", "Void Unlock(Void) { GateMutexPri_leave(gate, Key); }\n",
)  # fmt: skip


def told(tmp_path: Path, body: str, *, partners: bool = False) -> tuple[list[Finding], list[str]]:
    """The gates that are not left, and the lines of the program; without `partners` no function only leaves."""
    text = PROGRAM.replace("BODY", body.replace("\n", "\n        "))
    text = text.replace("ENTER", "key = GateMutexPri_enter(gate);").replace("LEAVE", "GateMutexPri_leave(gate, key);")
    for partner in () if partners else PARTNERS:
        text = text.replace(partner, "")
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, seconds=0.2)).findings
    return [finding for finding in found if finding.rule == "gate-not-left"], text.splitlines()


@pytest.mark.parametrize(("body", "at"), [
    # Taken in each turn: the enter is told, as a nested one.
    ("ENTER\nif (Wanted == Shown)\n    continue;\nLEAVE", "_enter"),
    # Never taken in this run.
    ("ENTER\nif (Wanted != Shown)\n    continue;\nLEAVE", "continue"),
    ("ENTER\nif (Wanted != Shown)\n    return;\nLEAVE", "return;"),
    (
        "ENTER\nswitch (Wanted) {\ncase 1:\n    Shown = 1;\n    continue;\ndefault:\n    break;\n}"
        "\nLEAVE",
        "continue",
    ),
])  # fmt: skip
def test_a_way_that_does_not_leave_a_gate_is_told(tmp_path: Path, body: str, at: str) -> None:
    (finding,), lines = told(tmp_path, body)
    assert finding.object == "gate"
    assert finding.place is not None
    assert at in lines[finding.place.line - 1]


@pytest.mark.parametrize("body", [
    "ENTER\nif (Wanted != Shown) {\n    LEAVE\n    continue;\n}\n"
    "LEAVE",
    # Nothing is held before the enter, and behind the leave.
    "if (Wanted != Shown)\n    continue;\nENTER\nLEAVE\n"
    "if (Wanted != Shown)\n    return;",
    # The loop inside goes on with the gate held.
    "ENTER\nwhile (Wanted < 3) {\n    Wanted++;\n    if (Wanted == 2)\n        continue;\n"
    "    Shown++;\n}\nLEAVE",
    # Behind the loop inside the gate is left.
    "ENTER\nfor (;;) {\n    if (Wanted == Shown)\n        break;\n    Shown = Wanted;\n}\n"
    "LEAVE",
    # Each turn of the loop leaves it.
    "ENTER\nfor (;;) {\n    if (Wanted == Shown) {\n        LEAVE\n        break;\n    }\n    LEAVE\n"
    "    Task_sleep(1);\n    ENTER\n}\nif (Shown == 0)\n    continue;\nENTER\nLEAVE",
    # On one way only.
    "if (Wanted != Shown)\n    ENTER\nif (Wanted != Shown)\n"
    "    LEAVE\nelse\n    continue;",
])  # fmt: skip
def test_a_way_that_is_right_is_told_nothing(tmp_path: Path, body: str) -> None:
    assert told(tmp_path, body)[0] == []


def test_a_gate_that_partners_enter_and_leave_is_told_nothing(tmp_path: Path) -> None:
    body = "ENTER\nif (Wanted != Shown)\n    continue;\nLEAVE"
    assert told(tmp_path, body, partners=True)[0] == []


#: The task gets a structure with the gate, or the address of another one.
BY_POINTER = PROGRAM.replace("Void worker(UArg a, UArg b)\n{", """typedef struct {
    GateMutexPri_Handle gate;
    Int n;
} Device;
Device One;
Int take(Device *d)
{
    IArg key;
    ENTER
    if (Wanted != Shown)
        return 1;
    LEAVE
    return 0;
}
Void worker(UArg a, UArg b)
{""").replace("gate = GateMutexPri_create(NULL, NULL);", "gate = One.gate = GateMutexPri_create(NULL, NULL);")


@pytest.mark.parametrize(("was", "now", "found"), [
    ("", "", 1),
    ("        return 1;\n", "    {\n LEAVE\n return 1;\n    }\n", 0),
    # The pointer is another one at the leave; or others leave what a pointer leads to.
    ("    if (Wanted", "    d = &One;\n    if (Wanted", 0),
    ("Void worker", "Void Out(Device *d, IArg key) { LEAVE }\nVoid worker", 0),
])  # fmt: skip
def test_a_gate_behind_a_pointer_is_one_gate_as_long_as_the_pointer_stays(
    tmp_path: Path, was: str, now: str, found: int
) -> None:
    text = BY_POINTER.replace(was, now, 1).replace("BODY", "take(&One);")
    text = text.replace("ENTER", "key = GateMutexPri_enter(d->gate);")
    text = text.replace("LEAVE", "GateMutexPri_leave(d->gate, key);")
    for partner in PARTNERS:
        text = text.replace(partner, "")
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    told = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, seconds=0.05)).findings
    lines = [text.splitlines()[f.place.line - 1] for f in told if f.rule == "gate-not-left" and f.place is not None]
    assert [line.strip() for line in lines] == ["return 1;"] * found
