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


@pytest.mark.parametrize(("count", "times"), [
    ("if (Raw > 9) { dry = 0; Seen = 0; } else Seen++;", 1),
    ("if (Raw > 9) { dry = 0; Seen = 0; } else Seen += dry;", 0),
    ("if (Raw > 9) { dry = 1; Seen = 0; } else Seen++;", 0),  # a debugger may look whether it was so
    ("if (Raw > 9) dry = 0; else Seen++;", 0),
])  # fmt: skip
def test_an_object_that_is_only_set_back_beside_a_count_is_told(tmp_path: Path, count: str, times: int) -> None:
    assert told(tmp_path, count=count) == [count] * times


@pytest.mark.parametrize(("name", "lines"), [("_percent", [9]), ("percent", []), ("_percent_offset", [])])
def test_an_object_of_a_file_in_python_that_nobody_writes_is_told(
    tmp_path: Path, name: str, lines: list[int]
) -> None:
    file = tmp_path / "a.py"
    file.write_text(f'''"""a.c"""
from __future__ import annotations
from emulator.c28x.language import *
{name}: int16 = 0
Out: int16 = 0
def Drive(by: int16) -> void:
    Out = by
def main() -> void:
    Drive({name} + 1)
''', encoding="utf-8")
    assert [f.place.line for f in Build([str(file)]).compiled.findings if f.rule == "one-sided"] == lines


def used(folder: Path, use: str, *, name: str = "number", storage: str = "static", write: str = "") -> list[int]:
    """The lines at which a program that never tests an object is told `one-sided`."""
    lines = [
        "typedef unsigned int Uint16;", f"{storage} Uint16 number = 0;", "volatile Uint16 Sent, Raw;",
        "void Send(Uint16 a, Uint16 b) { Sent = a | b << 8; }", f"int main(void) {{ for (;;) {{ {write}", use, "} }",
    ]  # fmt: skip
    file = folder / "a.c"
    file.write_text("\n".join(lines).replace("number", name) + "\n", encoding="utf-8")
    return [f.place.line for f in Build([str(file)]).compiled.findings if f.rule == "one-sided"]


@pytest.mark.parametrize("use", [
    "Send(Raw, number & 15);", "Sent = Raw << 4 | number;", "{ Uint16 n = number; Sent = n; }",
])  # fmt: skip
def test_an_object_that_goes_out_and_that_nobody_writes_is_told(tmp_path: Path, use: str) -> None:
    assert used(tmp_path, use) == [6]


@pytest.mark.parametrize("given", [
    {"write": "number++;"}, {"storage": ""}, {"storage": "static volatile"}, {"storage": "static const"},
    {"name": "zeroOffset"}, {"name": "testWord"}, {"use": "(void) number; Sent = 1;"},
    {"use": "Sent = (Uint16)(unsigned long)&number;"},
])  # fmt: skip
def test_an_object_that_is_written_or_adjusted_by_hand_is_silent(tmp_path: Path, given: dict[str, str]) -> None:
    assert used(tmp_path, **{"use": "Send(Raw, number & 15);", **given}) == []


LINK = """typedef unsigned int Uint16;
typedef struct {{ Uint16 most, speed, {more}valid; }} LIMIT;
LIMIT Limit{start};
volatile Uint16 Word, Ms, Out, Age;
{helper}
interrupt void Came(void)
{{
    if (Word & 1)
    {{
        {set}
    }}
}}
int main(void)
{{
    for (;;)
    {{
        {back}
        {test}
    }}
}}
"""
ENDLESS: dict[str, str] = {
    "more": "", "start": "", "helper": "", "set": "Limit.most = Word >> 1; Limit.valid = 1;", "back": "",
    "test": "Out = Limit.valid ? Limit.most : 0;",
}  # fmt: skip


def link(folder: Path, **given: str) -> list[int]:
    """The lines at which a program with received limits is told `one-sided`."""
    file = folder / "a.c"
    file.write_text(LINK.format(**{**ENDLESS, **given}), encoding="utf-8")
    return [f.place.line for f in Build([str(file)]).compiled.findings if f.rule == "one-sided"]


@pytest.mark.parametrize("given", [
    {},
    {"test": "if (!Limit.valid) Out = 9; else Out = Limit.most;"},
    {"test": "{ LIMIT mine; mine = Limit; if (mine.valid) Out = mine.most; }"},
    {"set": "Limit.speed = Word & 7; Limit.most = Word >> 4; Limit.valid = 1;"},
])  # fmt: skip
def test_a_mark_of_data_that_nothing_takes_back_is_told(tmp_path: Path, given: dict[str, str]) -> None:
    assert link(tmp_path, **given) == [10]


@pytest.mark.parametrize("given", [
    {"back": "if (Age > 100) Limit.valid = 0;"},
    {"back": "if (Age > 100) { LIMIT none = {0, 0, 0}; Limit = none; }"},
    {"back": "Kill(&Limit);", "helper": "static void Kill(LIMIT *l) { l->valid = 0; }"},
    {"back": "Kill(&Limit.valid);", "helper": "static void Kill(Uint16 *v) { *v = 0; }"},
    # The age is known by a stamp, by a count that is set back, by a count in the structure.
    {"more": "ms, ", "set": "Limit.most = Word >> 1; Limit.ms = Ms; Limit.valid = 1;",
     "test": "Out = Limit.valid && Ms - Limit.ms < 100 ? Limit.most : 0;"},
    {"set": "Limit.most = Word >> 1; Age = 0; Limit.valid = 1;"},
    {"more": "count, ", "set": "Limit.most = Word >> 1; Limit.count = Limit.count + 1; Limit.valid = 1;"},
    # Once: under a test of the mark; a constant beside it; in main, before its loop; nothing tests it.
    {"set": "if (!Limit.valid) { Limit.most = Word >> 1; Limit.valid = 1; }"},
    {"set": "Limit.most = 5; Limit.valid = 1;"},
    {"test": "Out = Limit.most;"},
    {"start": " = {5, 5, 1}"},
])  # fmt: skip
def test_a_mark_that_is_taken_back_or_beside_an_age_is_silent(tmp_path: Path, given: dict[str, str]) -> None:
    assert link(tmp_path, **given) == []


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


UP = """typedef unsigned int Uint16;
typedef enum {{ CALIBRATE, RUN }} MODE;
static volatile MODE mode = CALIBRATE;
static Uint16 bad = 0;
Uint16 Raw = 0, Out = 0, Sum = 0, Log[9];
static void Send(Uint16 a) {{ Out = a; }}
static void Step(void)
{{
    {count}
    {back}
    {test}
}}
int main(void)
{{
    for (;;) {{ Step(); }}
}}
"""
NOW_AND_THEN = "if (Raw > 9) bad++;"


def up(folder: Path, *, count: str = NOW_AND_THEN, back: str = "", test: str = "if (bad >= 4) Out = 1;") -> list[str]:
    """The objects of which a program is told that they only go up."""
    file = folder / "a.c"
    file.write_text(UP.format(count=count, back=back, test=test), encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [f.object.rpartition(".")[2] for f in found if f.rule == "one-sided" and "goes up" in f.message]


@pytest.mark.parametrize("given", [
    {},
    {"count": "if (Raw > 9) { if (bad < 4) bad++; }", "test": "Send(bad >= 4);"},
    {"count": "if (Raw > 9) bad += Raw;", "test": "Out = bad + Raw >= 400;"},
    {"count": "switch (mode) { case RUN: bad++; break; default: break; }", "back": "if (Raw == 5) mode = RUN;"},
    {"count": "if (Raw == 3) Sum |= 1u << bad++;"},
    {"count": "Uint16 *at = Log; if (at[Raw & 7] > 9) bad++;"},
    {"count": "{ const volatile Uint16 *in = &Raw; if (*in > 9) bad++; }"},
])  # fmt: skip
def test_a_count_with_a_limit_that_nothing_begins_again_is_told(tmp_path: Path, given: dict[str, str]) -> None:
    assert up(tmp_path, **given) == ["bad"]


@pytest.mark.parametrize("given", [
    {"back": "if (Raw == 0) bad = 0;"}, {"back": "if (Raw == 0 && bad > 0) bad--;"},
    # A delay after the start: always, up to its own limit, in a state that nothing enters again.
    {"count": "bad++;"}, {"count": "if (bad < 4) bad++;"}, {"count": "if (++Sum >= 10) { Sum = 0; bad++; }"},
    {"count": "if (mode == CALIBRATE) { Sum += Raw; bad++; }", "test": "if (bad >= 4) mode = RUN;"},
    {"count": "switch (mode) { case CALIBRATE: bad++; break; default: break; }", "test": "if (bad >= 4) mode = RUN;"},
    # An index, a clock, a number that goes out.
    {"count": "if (Raw > 9) Log[bad++] = Raw;"}, {"test": "if (Raw - bad >= 4) Out = 1;"}, {"back": "Send(bad);"},
    # No limit.
    {"test": "if (bad) Out = 1;"}, {"test": "if (bad != Out) Out = 1;"},
])  # fmt: skip
def test_a_count_that_is_begun_again_or_counts_once_is_silent(tmp_path: Path, given: dict[str, str]) -> None:
    assert up(tmp_path, **given) == []


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
