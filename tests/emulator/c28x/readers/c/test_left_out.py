"""A result of a function that no case of a switch takes, and its right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """typedef enum { ZONE_STOP, ZONE_SLOW, ZONE_FREE } Zone;
volatile int near, broken, duty;
static Zone zone(void)
{
    if (broken || near < 5) return ZONE_STOP;
    if (near < 10) return ZONE_SLOW;
    return ZONE_FREE;
}
static void drive(void)
{
    int wanted;
    for (;;)
    {
        wanted = 4500;
        switch (zone()) {
        case ZONE_SLOW: wanted = 2000; break;
        case ZONE_FREE: break;
        }
        duty = wanted;
    }
}
int main(void) { drive(); }
"""
LINE = 15
LOCAL = {"wanted = 4500;": "Zone now = zone(); wanted = 4500;", "switch (zone())": "switch (now)"}
#: Changes of the program behind which a case still is missing.
WRONG: list[dict[str, str]] = [
    {},
    LOCAL,
    {"case ZONE_FREE: break;": "case ZONE_FREE: wanted = 4500; break;"},
    {"return ZONE_FREE;": "return near > 20 ? ZONE_FREE : ZONE_SLOW;"},
    {"    if (broken || near < 5) return ZONE_STOP;\n    if (near < 10) return ZONE_SLOW;\n    return ZONE_FREE;":
     "    Zone z = ZONE_FREE; if (near < 10) z = ZONE_SLOW;\n    if (broken || near < 5) z = ZONE_STOP;\n"
     "    return z;"},
    {"int wanted;": "int wanted, k = 0;", "for (;;)": "for (k = 0; k < 100; k++)"},
]  # fmt: skip
#: The list is complete, or leaves a constant out on purpose.
RIGHT: list[dict[str, str]] = [
    {"case ZONE_FREE: break;": "case ZONE_FREE: break; case ZONE_STOP: wanted = 0; break;"},
    {"case ZONE_FREE: break;": "case ZONE_FREE: break; default: wanted = 0; break;"},
    {"case ZONE_FREE: break;": ""},
    {"case ZONE_FREE: break;": "case ZONE_FREE: wanted = 4000; break;"},
    # What stays is the safe value, or is set to it later.
    {"wanted = 4500;": "wanted = 0;"},
    {"duty = wanted;": "if (near < 5) wanted = 0; duty = wanted;"},
    {"duty = wanted;": "duty = zone() == ZONE_STOP ? 0 : wanted;"},
    {"duty = wanted;": "duty = broken ? 0 : wanted;"},
    {**LOCAL, "duty = wanted;": "if (now == ZONE_STOP) duty = 0; else duty = wanted;"},
    # The function does not return it, or not here.
    {"return ZONE_STOP;": "return ZONE_SLOW;"},
    {"wanted = 4500;": "if (broken || near < 5) continue; wanted = 4500;"},
    {"wanted = 4500;": "if (zone() == ZONE_STOP) continue; wanted = 4500;"},
    {"{ drive(); }": "{ if (near >= 5) drive(); }"},
    # Nothing needs to be done for it, as its name or a remark says.
    {"ZONE_STOP": "ZONE_NONE"},
    {"switch (zone()) {": "switch (zone()) {   /* others: as it is */"},
    {"case ZONE_FREE: break;": "case ZONE_FREE: break;   /* ZONE_STOP is the business of the brake */"},
    # More than one is left out, so the list is none of all.
    {"ZONE_FREE }": "ZONE_FREE, ZONE_BACK }", "return ZONE_SLOW;": "return near & 1 ? ZONE_SLOW : ZONE_BACK;"},
    # A case does more than to set the object.
    {"case ZONE_FREE: break;": "case ZONE_FREE: near = 0; break;"},
]


def told(folder: Path, changes: dict[str, str]) -> list[int]:
    """The lines at which a missing case is told."""
    text = PROGRAM
    for was, now in changes.items():
        assert was in text
        text = text.replace(was, now)
    (folder / "a.c").write_text(text, encoding="utf-8")
    found = Build([str(folder / "a.c")]).compiled.findings
    return [f.place.line for f in found if f.rule == "no-case" and f.place is not None]


@pytest.mark.parametrize("changes", WRONG)
def test_a_result_without_a_case_is_told(tmp_path: Path, changes: dict[str, str]) -> None:
    assert told(tmp_path, changes) == [LINE]


@pytest.mark.parametrize("changes", RIGHT)
def test_what_is_left_out_on_purpose_is_silent(tmp_path: Path, changes: dict[str, str]) -> None:
    assert told(tmp_path, changes) == []
