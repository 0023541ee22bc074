"""Objects that ought to remember, and that nothing sets: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import CWorkshop

PROGRAM = """typedef unsigned Uint16;
struct message {{ Uint16 number; }} box;
Uint16 read(void);
Uint16 presses = 0, lost = 0, at = 0, changes = 0;
{objects}
static void Step(Uint16 now) {{ {step} }}
int main(void)
{{
    {locals}
    for (;;) {{ Step(read()); {turn} }}
}}
"""


def told(objects: str = "", step: str = "", local: str = "", turn: str = "") -> list[str]:
    """The objects that nothing sets, in a program of these parts."""
    text = PROGRAM.format(objects=objects, step=step, locals=local, turn=turn)
    shop = CWorkshop(text, static=True, externs={"read": lambda: 1})
    return [f.object.rsplit(".", 1)[-1] for f in shop.findings if f.rule == "never-updated"]


@pytest.mark.parametrize(("parts", "name"), [
    ({"objects": "static Uint16 last = 1;", "step": "if (now == 0 && last == 1) presses++;"}, "last"),
    ({"objects": "static Uint16 lastState;", "step": "if (now != lastState) changes++;"}, "lastState"),
    ({"objects": "Uint16 previous = 0;", "step": "if (now && !previous) presses++;"}, "previous"),
    ({"objects": "int old = 0;", "step": "changes = now - old;"}, "old"),
    ({"step": "static Uint16 letzter = 0; if (now != letzter) changes++;"}, "letzter"),
    ({"local": "Uint16 esperado = 0;", "turn": "if (box.number != esperado) lost++;"}, "esperado"),
    ({"objects": "Uint16 stateSince = 0;", "step": "if (now - stateSince > 100) changes++;"}, "stateSince"),
    ({"objects": "Uint16 expectedNr = 0;", "step": "if (now != expectedNr) lost++;"}, "expectedNr"),
    ({"local": "Uint16 last = 0;", "turn": "if (read() != last) changes++;"}, "last"),
])  # fmt: skip
def test_what_nothing_sets_remembers_nothing(parts: dict[str, str], name: str) -> None:
    """It is told where it is compared."""
    assert told(**parts) == [name]


@pytest.mark.parametrize("parts", [
    {"objects": "static Uint16 last = 1;", "step": "if (now == 0 && last == 1) presses++; last = now;"},
    {"objects": "static Uint16 last = 1;", "step": "if (now == 0 && last == 1) presses++;", "turn": "last = read();"},
    # The end of a row.
    {"objects": "static Uint16 lastChannel = 7;", "step": "if (now == lastChannel) at = 0;"},
    {"objects": "static Uint16 lastChannel = 1;", "turn": "if (at == lastChannel) at = 0; else at++;"},
    {"objects": "static Uint16 lastChannel = 1;", "turn": "at = (at + 1) % 8; if (at == lastChannel) presses++;"},
    {"objects": "static Uint16 expectedVersion = 1;", "step": "if (now != expectedVersion) lost++;"},
    {"objects": "static Uint16 expected = 0xD3;", "step": "if (now != expected) lost++;"},
    {"objects": "static const Uint16 old = 1;", "step": "if (now != old) changes++;"},
    {"objects": "volatile Uint16 expected = 1;", "step": "if (now != expected) changes++;"},
    {"objects": "Uint16 old; Uint16 *where = &old;", "step": "if (now != old) changes++;"},
    {"objects": "static Uint16 limit = 1;", "step": "if (now != limit) changes++;"},
    {"local": "Uint16 old = 0;", "turn": "if (read() != old) changes++; old = read();"},
    {"turn": "Uint16 old = read(); if (read() != old) changes++;"},
    {"turn": "Uint16 last = 0; for (at = 0; at < 4; at++) { if (read() != last) changes++; last = read(); }"},
])  # fmt: skip
def test_right_programs(parts: dict[str, str]) -> None:
    """It is set, or it need not be."""
    assert told(**parts) == []


REST = """#define REST_PERIODS 100U
#define FAULT_TIME 7
#define GRIPPER 2
typedef unsigned Uint16;
enum {{ IDLE, WAIT, HOLD }};
Uint16 read(void);
Uint16 runs = 0, mode = 0;
{objects}
static void Helper(void) {{ {helper} }}
static void Servo(void)
{{
    {locals}
    for (;;) {{ {turn} }}
}}
int main(void) {{ {start} Helper(); Servo(); return 0; }}
"""
BEGIN = "if (read() > 50) { mode = 1; rest = REST_PERIODS; } "
OVER = "if (rest == 0) { mode = 0; runs++; } "
OWN = "Uint16 rest = 0;"


def told_of_rests(tmp_path: Path, parts: dict[str, str]) -> list[str]:
    """The times that nothing counts, in a program of these parts."""
    file = tmp_path / "rest.c"
    file.write_text(REST.format(**{"objects": "", "helper": "", "locals": "", "turn": "", "start": ""} | parts))
    found = Build([str(file)]).compiled.findings
    return [f.object.rsplit(".", 1)[-1] for f in found if f.rule == "never-updated"]


@pytest.mark.parametrize(("parts", "name"), [
    ({"locals": OWN, "turn": BEGIN + OVER}, "rest"),
    ({"objects": f"static {OWN}", "turn": BEGIN + OVER}, "rest"),
    ({"objects": OWN, "turn": BEGIN, "helper": OVER}, "rest"),
    ({"locals": f"static {OWN}", "turn": BEGIN + "if (!rest) runs++;"}, "rest"),
    ({"locals": OWN, "turn": BEGIN + "if (rest > 0) mode = 1; else mode = 0;"}, "rest"),
    ({"locals": OWN, "turn": BEGIN + "if (mode == 1 && rest == 0) mode = 0;"}, "rest"),
    ({"locals": "Uint16 closed = 0;", "turn": "if (read()) closed = REST_PERIODS; if (closed == 0) runs++;"}, "closed"),
    ({"objects": "int espera = 0;", "turn": "if (read()) espera = 20; if (espera) mode = 1; else runs++;"}, "espera"),
    ({"objects": "int holdTicks;", "turn": "if (read()) holdTicks = 20; if (holdTicks == 0) runs++;"}, "holdTicks"),
])  # fmt: skip
def test_a_time_that_nothing_counts_is_never_over(tmp_path: Path, parts: dict[str, str], name: str) -> None:
    """It is told where the test asks whether it is over."""
    assert told_of_rests(tmp_path, parts) == [name]


@pytest.mark.parametrize("parts", [
    {"locals": OWN, "turn": BEGIN + "if (rest == 0) mode = 0; else rest--;"},
    {"locals": OWN, "turn": BEGIN + "if (rest && --rest == 0) mode = 0;"},
    {"objects": f"static {OWN}", "turn": BEGIN + OVER, "helper": "if (rest > 0) rest -= 1;"},
    {"objects": f"volatile {OWN}", "turn": BEGIN + OVER},
    {"objects": f"{OWN} Uint16 *where = &rest;", "turn": BEGIN + OVER},
    # It is begun and ended: a flag.  It is a limit, or shown.
    {"objects": OWN, "turn": BEGIN + OVER, "helper": "rest = 0;"},
    {"locals": OWN, "turn": BEGIN + "if (read() > rest) runs++; " + OVER},
    {"locals": OWN, "turn": BEGIN + "runs = rest; " + OVER},
    {"objects": OWN, "turn": OVER, "start": "rest = REST_PERIODS;"},
    {"objects": OWN, "turn": OVER, "helper": "rest = REST_PERIODS;"},
    {"objects": "Uint16 rest = 5;", "turn": BEGIN + OVER},
    # A choice of each turn, or of each call.
    {"turn": OWN + BEGIN + OVER},
    {"helper": OWN + BEGIN + OVER},
    # Codes that are latched, flags, modes.
    {"locals": "Uint16 error = 0;", "turn": "if (read()) error = 3; if (error == 0) runs++;"},
    {"locals": "Uint16 error = 0;", "turn": "if (read()) error = FAULT_TIME; if (error == 0) runs++;"},
    {"locals": "Uint16 stopped = 0;", "turn": "if (read()) stopped = FAULT_TIME; if (stopped == 0) runs++;"},
    {"locals": "Uint16 tool = 0;", "turn": "if (read()) tool = GRIPPER; if (tool == 0) runs++;"},
    {"locals": "Uint16 hold = 0;", "turn": "if (read()) hold = 1; if (hold == 0) runs++;"},
    {"locals": "Uint16 wait = 0;", "turn": "if (read()) wait = HOLD; if (wait == IDLE) runs++;"},
    {"objects": "Uint16 rest = 0; // latched until the next start", "turn": BEGIN + OVER},
])  # fmt: skip
def test_times_that_are_counted_and_what_is_no_time(tmp_path: Path, parts: dict[str, str]) -> None:
    assert told_of_rests(tmp_path, parts) == []
