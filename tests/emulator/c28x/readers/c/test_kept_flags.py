"""Flags of interrupts that nothing clears: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import CWorkshop

PROGRAM = """volatile unsigned due = 0, runs = 0;
unsigned ms = 0, pressed = 0;
volatile unsigned sample = 0;
unsigned long sum = 0;
__interrupt void Tick(void) {{ {interrupt} }}
void Delay(void);
static void Work(void) {{ {work} }}
int main(void)
{{
    {before}
    for (;;) {{ {turn} }}
}}
"""


def found(turn: str, *, interrupt: str = "due = 1;", work: str = "ms++;", before: str = "") -> list[str]:
    """What is told of a loop that does `turn`."""
    text = PROGRAM.format(turn=turn, interrupt=interrupt, work=work, before=before)
    return told(text)


def told(text: str) -> list[str]:
    """The messages about what is not begun again."""
    shop = CWorkshop(text, static=True, externs={"Delay": lambda: None})
    return [f.message for f in shop.findings if f.rule == "not-begun-again"]


@pytest.mark.parametrize(("turn", "more", "change"), [
    ("if (due) { ms++; }", {}, "changes ms"),
    ("if (due == 1) Work();", {}, "changes ms"),
    ("if (!due) continue; Work();", {}, "changes ms"),
    ("if (due) { sum += sample; }", {"interrupt": "sample += 3; due = 1;"}, "changes sum"),
    ("Work();", {"work": "if (due) ms++;"}, "changes ms"),
    ("if (due) ms++;", {"before": "due = 0;"}, "changes ms"),
    ("if (due) ms++;", {"interrupt": "if (++runs >= 10) { runs = 0; due = 1; }"}, "changes ms"),
])  # fmt: skip
def test_a_loop_that_counts_its_turns(turn: str, more: dict[str, str], change: str) -> None:
    """Nothing clears the flag, so that each turn counts."""
    (message,) = found(turn, **more)
    assert message.startswith("nothing clears due: once Tick has set it, each turn of the loop ")
    assert change in message


@pytest.mark.parametrize(("turn", "more"), [
    ("if (due) { due = 0; ms++; }", {}),
    ("if (due) Work();", {"work": "ms++; due = 0;"}),
    ("if (due) { ms++; } due = 0;", {}),
    ("if (due) { ms = sample; }", {}),  # each turn does the same
    ("if (due) { if (pressed) continue; ms++; }", {}),
    ("if (due) { ms++; Delay(); }", {}),  # it has begun, and the delay sets the pace
    ("while (!sample) ; sample = 0; if (due) ms++;", {}),
    ("if (!sample) continue; sample = 0; if (due) ms++;", {}),
    ("if (sample) { sample = 0; if (due) ms++; }", {}),
    ("if (due) ms++;", {"interrupt": "if (pressed) due = 1;"}),  # something has happened
    ("if (due) ms++;", {"interrupt": "due = !due;"}),
    ("if (due) pressed = 1;", {}),
])  # fmt: skip
def test_right_loops(turn: str, more: dict[str, str]) -> None:
    """The flag is cleared, or says only that something has begun."""
    assert found(turn, **more) == []


def test_a_pin_that_toggles(tmp_path: Path) -> None:
    """A register is changed in each turn, too."""
    file = tmp_path / "toggle.c"
    file.write_text("""#include "F28x_Project.h"
volatile Uint16 due = 0;
__interrupt void Tick(void) { due = 1; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
int main(void)
{
    for (;;) { if (due) { GpioDataRegs.GPATOGGLE.bit.GPIO3 = 1; } }
}
""", encoding="utf-8")
    (message,) = [f.message for f in Build([str(file)]).compiled.findings if f.rule == "not-begun-again"]
    assert message == "nothing clears due: once Tick has set it, each turn of the loop writes GPATOGGLE again"


@pytest.mark.parametrize("declared", ["unsigned faultSeen = 0;", "unsigned seen = 0; // latched until reset"])
def test_flags_that_are_meant_to_stay(tmp_path: Path, declared: str) -> None:
    """The name or the comment says so."""
    name = "faultSeen" if "fault" in declared else "seen"
    text = PROGRAM.format(turn=f"if ({name}) ms++;", interrupt=f"{name} = 1;", work="", before="")
    file = tmp_path / "kept.c"
    file.write_text(text.replace("unsigned ms", f"volatile {declared}\nunsigned ms"), encoding="utf-8")
    assert "not-begun-again" not in [f.rule for f in Build([str(file)]).compiled.findings]


def test_turns_that_are_counted_on_purpose(tmp_path: Path) -> None:
    """The load of the CPU is measured so."""
    text = PROGRAM.format(turn="if (due) idleTurns++;", interrupt="due = 1;", work="", before="")
    text = text.replace("unsigned ms", "unsigned long idleTurns = 0;\nunsigned ms")
    assert told(text) == []


BLOCKS = """typedef unsigned Uint16;
typedef struct {{ Uint16 {mark}; Uint16 value; }} Block;
static Block blocks[2] = {{{{0, 0}}, {{0, 0}}}};
static volatile Uint16 filling = 0, lost = 0;
__interrupt void Fill(void)
{{
    Uint16 other = (filling + 1) % 2;
    Block *block = &blocks[filling];
    block->value = 3;
    if (blocks[other].{mark}) lost++;
    else {{ block->{mark} = 1; filling = other; }}
}}
int main(void)
{{
    Uint16 next = 0, sum = 0;
    for (;;) {{
        if (blocks[next].{mark}) {{ sum ^= blocks[next].value; {after} next = (next + 1) % 2; }}
        lost = sum;
    }}
}}
"""


@pytest.mark.parametrize(("mark", "after", "count"), [
    ("full", "", 1), ("isBusy", "", 1), ("full", "blocks[next].full = 0;", 0),
    ("used", "", 0),  # a place that was given away for good
    ("full", "memset(blocks, 0, sizeof blocks);", 0), ("full", "blocks[next] = blocks[1 - next];", 0),
])  # fmt: skip
def test_a_mark_of_an_element_is_taken_back(mark: str, after: str, count: int) -> None:
    """Else each element is used once."""
    text = BLOCKS.format(mark=mark, after=after)
    messages = told(("#include <string.h>\n" if "memset" in after else "") + text)
    assert messages == [f"nothing takes blocks[other].{mark} back: once it is set, it stands for good"] * count
