"""Objects that ought to remember, and that nothing sets: wrong programs, and their right twins."""

from __future__ import annotations

import pytest

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
