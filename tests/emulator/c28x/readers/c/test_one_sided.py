"""Objects and states that only one half of a program knows: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """typedef unsigned int Uint16;
typedef enum {{ DRY, WET, FLOODED }} SOIL;
static volatile SOIL soil = DRY;
{storage} Uint16 leaks{start};
static Uint16 dry = 0;
Uint16 Seen = 0, Raw = 0, Valve = 0;
static void Enter(SOIL next) {{ soil = next; }}
static void Step(void)
{{
    {count}
    if (leaks != Seen) {{ Seen = leaks; Valve = 0; }}
    switch (soil) {{
    case DRY:
        Valve = 1;
        {wet}
        break;
    case WET:
        Valve = 0;
        if (Raw > 9) Enter(DRY);
        break;
    case FLOODED:
        Valve = 2;
        break;
    default:
        break;
    }}
}}
int main(void)
{{
    for (;;) {{ Step(); {turn} }}
}}
"""
COUNT = "dry = Raw > 9 ? dry + 1 : 0; if (dry > 3) Valve = 3;"
WET = "if (Raw < 5) Enter(WET); else if (Raw > 90) Enter(FLOODED);"
TURN = "if (Raw == 7) leaks++;"


def told(
    folder: Path, *, storage: str = "static", start: str = " = 0", count: str = COUNT, wet: str = WET, turn: str = TURN,
    name: str = "leaks",
) -> list[str]:  # fmt: skip
    """The lines at which `one-sided` is told."""
    file = folder / "a.c"
    text = PROGRAM.format(storage=storage, start=start, count=count, wet=wet, turn=turn).replace("leaks", name)
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "one-sided"]


def test_a_program_with_both_halves_is_silent(tmp_path: Path) -> None:
    assert told(tmp_path) == []


def test_an_object_that_is_tested_and_that_nobody_writes_is_told(tmp_path: Path) -> None:
    assert told(tmp_path, turn="") == ["if (leaks != Seen) { Seen = leaks; Valve = 0; }"]
    assert told(tmp_path, turn="", start="") == ["if (leaks != Seen) { Seen = leaks; Valve = 0; }"]


@pytest.mark.parametrize("given", [
    {"turn": "", "storage": "volatile"},
    {"turn": "", "start": " = 3"},
    {"turn": "", "storage": "static const"},
    {"turn": "", "name": "debugStep"},
    {"turn": "{ Uint16 *p = &leaks; *p = Raw; }"},
])  # fmt: skip
def test_an_object_that_somebody_else_may_write_is_silent(tmp_path: Path, given: dict[str, str]) -> None:
    assert told(tmp_path, **given) == []


@pytest.mark.parametrize("count", [
    "dry = Raw > 9 ? dry + 1 : 0;", "if (Raw > 9) dry++; else dry = 0;", "if (Raw > 9) dry += 2; if (Raw < 9) dry = 0;",
])  # fmt: skip
def test_a_count_that_nobody_reads_is_told(tmp_path: Path, count: str) -> None:
    assert told(tmp_path, count=count) == [count]


@pytest.mark.parametrize("count", [
    # A number of events; a start value again; a sum that something reads; a count whose own limit is a test.
    "dry++;", "dry = 0;", "if (Raw > 9) dry++; else dry = 0; Valve = dry;", "if (dry < 9) dry++; if (Raw > 9) dry = 0;",
])  # fmt: skip
def test_a_count_that_is_read_or_only_shown_is_silent(tmp_path: Path, count: str) -> None:
    assert told(tmp_path, count=count) == []


def test_a_state_that_nothing_enters_is_told(tmp_path: Path) -> None:
    wet = "if (Raw < 5) Enter(WET); else if (Raw > 90) Enter(DRY);"
    assert told(tmp_path, wet=wet) == ["Valve = 2;"]


@pytest.mark.parametrize("turn", [
    "if (Raw == 3) soil = (SOIL)Raw;", "if (Raw == 3) soil = Raw > 2 ? FLOODED : DRY;",
    "{ void (*go)(SOIL) = Enter; go(Raw); }",
])  # fmt: skip
def test_a_state_that_something_may_enter_is_silent(tmp_path: Path, turn: str) -> None:
    wet = "if (Raw < 5) Enter(WET); else if (Raw > 90) Enter(3);"
    assert told(tmp_path, wet=wet, turn=f"{TURN} {turn}") == []
