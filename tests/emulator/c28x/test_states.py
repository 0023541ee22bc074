"""States that never end, steps past a goal, ages the wrong way round: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files
from tests.emulator.drivers import with_ticks

PROGRAM = """#include "F28x_Project.h"
enum DOOR {{ SHUT, OPENING, WIDE }};
volatile enum DOOR Door = SHUT;
volatile Uint16 Now, Seen, Rest, Level = 100, Pulls, Goal = 40, Ends, Pushed;
typedef struct {{ Uint16 value; Uint32 taken; }} SAMPLE;
typedef struct {{ enum DOOR state; Uint16 rest; }} GATE;
GATE Gate = {{SHUT, 0}};
static void Run(GATE *gate)
{{
    if (gate->state == SHUT && Pushed) gate->state = WIDE;
    if (gate->state == WIDE) {{ {gate}
        if (gate->rest == 0) gate->state = SHUT; else gate->rest--; }}
}}
SAMPLE Last;
volatile Uint32 Millis;
static Uint16 Pushed_Now(void) {{ return Pushed; }}
interrupt void Tick(void)
{{
    Now++;
    Millis++;
    {tick}
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}}
void main(void)
{{
""" + with_ticks(100) + """    {start}
    for (;;) {{
        {turn}
        DELAY_US(50);
    }}
}}
"""
RULES = ("state-stuck", "stepped-over", "stamp-backwards")


def told(folder: Path, tick: str = "", turn: str = "", start: str = "", gate: str = "") -> list[tuple[str, str]]:
    """Rule and line of what is told of a program."""
    text = PROGRAM.format(tick=tick, turn=turn, start=start, gate=gate)
    (folder / "door.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles([folder / "door.c"], calls=1, board=load("bare"), seconds=0.002)
    lines = text.splitlines()
    return [
        (f.rule, lines[f.place.line - 1].strip()) for f in check_files(wanted).findings if f.rule in RULES and f.place
    ]  # fmt: skip


WAIT = "switch (Door) {{ case WIDE:\n if (Rest > 0) {0}\n else Door = SHUT;\n break; default: break; }}"
OPEN = "if (Pushed_Now()) { Rest = 20; Door = WIDE; }"


@pytest.mark.parametrize(("tick", "line"), [
    # Set anew by each pass.
    (OPEN + WAIT.format("Rest = 20;"), "if (Rest > 0) Rest = 20;"),
    # Counted, and set anew before it can end.
    (OPEN + "if (Door == WIDE) {\n if (Rest < 20) Rest = 20;\n if (Rest == 0) Door = SHUT; else Rest--; }",
     "if (Rest < 20) Rest = 20;"),
    # Counted away from the test.
    (OPEN + WAIT.format("{ if (Rest < 30) Rest++; }"), "if (Rest > 0) { if (Rest < 30) Rest++; }"),
])  # fmt: skip
def test_a_state_that_keeps_its_own_end_from_coming_is_told(tick: str, line: str, tmp_path: Path) -> None:
    assert told(tmp_path, tick) == [("state-stuck", line)]


@pytest.mark.parametrize(("tick", "turn"), [
    (OPEN + WAIT.format("Rest--;"), ""),
    # Another routine counts.
    (OPEN + WAIT.format("Ends++;"), "if (Rest > 0) { DINT; Rest--; EINT; }"),
    # A rest state: another statement ends it, on something else; so does another thread.
    (OPEN + WAIT.format("Rest = 20;"), "if (Pushed_Now()) Door = SHUT;"),
    (OPEN + WAIT.format("Rest = 20;") + "if (Door == WIDE && Pushed_Now()) Door = SHUT;", ""),
    # The way out hangs on a function as well.
    (OPEN + "if (Door == WIDE) { if (Pushed_Now()) Door = SHUT; Rest = 20; }", ""),
    # Nothing in the state touches it: a state that only another one ends.
    (OPEN + WAIT.format("Ends++;"), "Rest = 0;"),
    # Set anew, but on an event.
    (OPEN + "if (Door == WIDE) { if (Pushed_Now()) Rest = 20; if (Rest == 0) Door = SHUT; else Rest--; }", ""),
])  # fmt: skip
def test_a_state_that_can_end_is_silent(tick: str, turn: str, tmp_path: Path) -> None:
    assert told(tmp_path, tick, turn) == []


@pytest.mark.parametrize(("first", "stuck"), [("", True), ("if (Pulls) Door = SHUT; else ", False)])
def test_a_state_that_is_left_only_to_come_back_is_told(first: str, stuck: bool, tmp_path: Path) -> None:
    tick = (
        f"switch (Door) {{ case OPENING: {first}{{ Rest = 20; Door = WIDE; }} break;\n"
        "case WIDE:\nif (Rest < 20) Rest = 20;\nif (Rest == 0) Door = SHUT; else Rest--;\nbreak; default: break; }"
    )
    found = told(tmp_path, tick, "if (Pushed_Now()) Door = OPENING;")
    assert found == [("state-stuck", "if (Rest < 20) Rest = 20;")] * stuck


@pytest.mark.parametrize(("gate", "found"), [
    ("gate->rest = 20;", [("state-stuck", "if (gate->state == WIDE) { gate->rest = 20;")]),
    ("if (Seen) gate->rest = 20;", []),
])  # fmt: skip
def test_a_state_in_a_structure_that_a_pointer_gives_is_one_too(
    gate: str, found: list[tuple[str, str]], tmp_path: Path
) -> None:  # fmt: skip
    assert told(tmp_path, "Pushed = Now & 1;", "Seen = Now & 7; Run(&Gate);", gate=gate) == found


RAMP = "if (Level != 250) Level += {0};\n else {{ Level = 250; Door = WIDE; }}"
TRIES = "Uint16 n = {0};\n while (Pushed_Now() == 0) {{\n n++;\n if (n == 3) break;\n }}"


@pytest.mark.parametrize(("tick", "turn", "line"), [
    (RAMP.format(40), "", "if (Level != 250) Level += 40;"),
    ("", "{ " + TRIES.format(5) + " }", "if (n == 3) break;"),
    ("", "{ Uint16 k = 1;\n while (k != 10) { Ends++; k += 2; } if (Ends > 4) Ends = 0; }",
     "while (k != 10) { Ends++; k += 2; } if (Ends > 4) Ends = 0; }"),
])  # fmt: skip
def test_a_goal_that_steps_go_past_is_told(tick: str, turn: str, line: str, tmp_path: Path) -> None:
    assert told(tmp_path, f"Pushed = Now & 1;\n{tick}", turn) == [("stepped-over", line)]


@pytest.mark.parametrize(("goal", "found"), [(210, True), (140, False), (60, False), (251, True)])
def test_a_goal_beside_the_steps_up_and_down_is_told(goal: int, found: bool, tmp_path: Path) -> None:
    line = f"if (Level == {goal}) Door = SHUT;"
    tick = f"if (Pushed) {{ if (Level < 900) Level += 40; }} else {{\n{line}\nelse if (Level > 40) Level -= 40; }}"
    assert told(tmp_path, f"Pushed = Now & 1;\n{tick}") == [("stepped-over", line)] * found


@pytest.mark.parametrize(("tick", "turn"), [
    (RAMP.format(50), ""),
    ("if (Level < 250) Level += 40; else { Level = 250; Door = WIDE; }", ""),
    # Whoever wishes sets it to the goal.
    (RAMP.format(40) + " if (Pushed_Now()) Level = 210;", ""),
    ("", "{ " + TRIES.format(0) + " }"),
    # A second bound.
    ("", "{ Uint16 k = 1; while (k != 10 && k < 20) { Ends++; k += 2; } }"),
    # Once only: no step is chosen by it.
    ("Pulls += 2; if (Pulls == 7) Ends++;", ""),
    # Computed.
    ("if (Level != 250) Level += 40; else Level = 250; if (Pushed) Level = Now;", ""),
])  # fmt: skip
def test_a_goal_that_is_met_is_silent(tick: str, turn: str, tmp_path: Path) -> None:
    assert not told(tmp_path, f"Pushed = Now & 1; {tick}", turn)


@pytest.mark.parametrize(("turn", "found"), [
    ("if (Pushed) Seen = Now; if ((Uint16)(Seen - Now) > 30) Ends++;", True),
    ("if (Pushed) Seen = Now - 5; if ((Uint16)(Seen - Now) < 30) Ends++;", True),
    ("if (Pushed) Seen = Now; if ((Uint16)(Now - Seen) > 30) Ends++;", False),
    # A time that lies ahead.
    ("if (Pushed) Seen = Now + 30; if ((Uint16)(Seen - Now) > 10) Ends++;", False),
    # Its sign is asked for.
    ("if (Pushed) Seen = Now; if ((int16)(Seen - Now) > 10) Ends++;", False),
])  # fmt: skip
def test_an_age_the_wrong_way_round_is_told(turn: str, found: bool, tmp_path: Path) -> None:
    assert [rule for rule, _ in told(tmp_path, turn=turn)] == ["stamp-backwards"] * found


FRESH = """SAMPLE sample; Uint32 now, late = 0, gone = 0;
{before}
for (;;) {{
    Pulls = Pushed_Now() + (gone > 9);
    {first}
    {second}
    {between}
    switch (Door) {{
    case SHUT: if (Pulls) Door = WIDE; break;
    case WIDE: default: Ends++; {more} if ({test} && Pulls < 7) {{ late = now; Door = SHUT; }} break;
    }}
    DELAY_US(50);
}}"""
TAKEN = "Last.value = 3; Last.taken = Millis;"


def fresh(**given: str) -> str:
    usual = {
        "before": "late = Millis;", "first": "sample = Last;", "second": "now = Millis;", "between": "", "more": "",
        "test": "sample.taken > now",
    }  # fmt: skip
    return FRESH.format(**(usual | given))


@pytest.mark.parametrize("given", [
    {}, {"test": "now < sample.taken"},
    {"first": "gone = Last.taken;", "test": "gone > now"},
])  # fmt: skip
def test_a_state_whose_exit_wants_a_stamp_from_the_future_is_told(given: dict[str, str], tmp_path: Path) -> None:
    test = given.get("test", "sample.taken > now")
    line = f"case WIDE: default: Ends++;  if ({test} && Pulls < 7) {{ late = now; Door = SHUT; }} break;"
    assert told(tmp_path, TAKEN, fresh(**given)) == [("state-stuck", line)]


@pytest.mark.parametrize(("tick", "given"), [
    # An age; equal times, in one count; a stamp of the next pass, or that changes behind the reading.
    (TAKEN, {"test": "now - sample.taken < 5"}), (TAKEN, {"test": "sample.taken >= now"}),
    (TAKEN, {"first": "now = Millis;", "second": "sample = Last;"}),
    (TAKEN, {"between": "if (Pulls) sample = Last;"}), (TAKEN, {"between": "now = late;"}),
    # A time in the future; of somebody else; of another clock.
    ("Last.taken = Millis + 20;", {}), (TAKEN, {"before": "Last.taken = Level;"}),
    (TAKEN + "Last.taken = Rest;", {}), ("Last.taken = Now;", {}),
    # Another way out.
    (TAKEN, {"more": "if (Pulls == 5) Door = SHUT;"}), (TAKEN, {"between": "if (Pulls == 5) Door = SHUT;"}),
    (TAKEN, {"test": "(sample.taken > now || Pulls == 3)"}),
])  # fmt: skip
def test_a_state_that_a_stamp_can_end_is_silent(tick: str, given: dict[str, str], tmp_path: Path) -> None:
    assert told(tmp_path, tick, fresh(**given)) == []
