"""Words that `main` writes before what belongs to them, which an interrupt routine reads too; and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """typedef unsigned int Uint16;
#define SIZE 16
volatile Uint16 in, out, ring[SIZE], Sent, On;
struct {{ volatile Uint16 in, out, data[SIZE]; }} queue;
void Switch_disable(void) {{ On = 0; }}
void Switch_enable(void) {{ On = 1; }}
{more}
interrupt void Sends(void)
{{
    {sends}
}}
static void Put(Uint16 c)
{{
    Uint16 old = in, next = (in + 1) & (SIZE - 1);
    if (next == out) return;
    {put}
}}
int main(void)
{{
    Switch_disable();
    {first}
    for (;;)
    {{
        {turn}
    }}
}}
"""
GIVEN = {
    "more": "", "first": "", "turn": "Put(Sent);",
    "sends": "if (in != out) { Sent = ring[out]; out = (out + 1) & (SIZE - 1); }",
}  # fmt: skip


def told(folder: Path, put: str, **given: str) -> list[str]:
    """The lines at which `published-early` is told."""
    file = folder / "a.c"
    text = PROGRAM.format(**{**GIVEN, "put": put, **given})
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "published-early"]


QUEUE = "if (queue.in != queue.out) { Sent = queue.data[queue.out]; queue.out = (queue.out + 1) % SIZE; }"


@pytest.mark.parametrize(
    ("put", "given"),
    [
        ("in = next; ring[old] = c;", {}),
        ("in = next; ring[(next - 1) & (SIZE - 1)] = c;", {}),
        ("in = next; Switch_enable(); ring[(in + SIZE - 1) % SIZE] = c;", {}),
        ("in = next; ring[(in + 15) & 15] = c;", {}),
        ("in = next; ring[(in + 15) % 16] = c;", {}),
        ("Switch_disable(); Sent = 0; Switch_enable(); in = next; ring[old] = c;", {}),
        ("in = next; ring[old] = c;", {"sends": "while (out < in) { Sent = ring[out]; out++; }"}),
        (
            "{ Uint16 was = queue.in; queue.in = (was + 1) % SIZE; queue.data[was] = c; }", {"sends": QUEUE},
        ),
    ],
)  # fmt: skip
def test_an_index_before_its_element_is_told(tmp_path: Path, put: str, given: dict[str, str]) -> None:
    assert told(tmp_path, put, **given) == [put]


@pytest.mark.parametrize(
    ("put", "given"),
    [
        ("ring[in] = c; in = next;", {}),
        ("ring[old] = c; in = next;", {}),
        ("ring[in++] = c; in &= SIZE - 1;", {}),
        ("in = next; ring[in] = 0;", {}),  # the element behind the last one
        ("ring[in] = c; in = next; ring[(in + 1) % SIZE] = 0;", {}),
        ("Switch_disable(); in = next; ring[old] = c; Switch_enable();", {}),
        ("in = next; ring[old] = c;", {"turn": "Switch_disable(); Put(Sent); Switch_enable();"}),
        ("in = next; ring[old] = c;", {"turn": "Sent = 1;", "first": "Put(1);"}),  # before the interrupts
        ("in = next; ring[old] = c;", {"sends": "Sent = in;"}),
        ("in = next; ring[old] = c;", {"sends": "if (in != out) { out = in; Sent = 1; }"}),
        ("in = next; ring[old] = c;", {"sends": "if (in != out) { Sent = ring[out]; out = in; in = 0; }"}),
        ("in = old; ring[old] = c; in = next;", {}),
    ],
)
def test_an_element_before_its_index_or_a_mask_is_silent(tmp_path: Path, put: str, given: dict[str, str]) -> None:
    assert told(tmp_path, put, **given) == []


#: A routine pulls a valve for some ms, then holds it.
VALVE = """
volatile Uint16 State, pulled_ms, Ticks;
interrupt void Tick(void)
{{
    Ticks++;
    if (State == 1) {{ if ({counted}) State = 2; }}
}}
static void Open(void) {{ if (State == 0) {{ {opened} }} }}
"""
OPENS = {"turn": "Open(); if (Sent) State = 0;", "put": "ring[in] = c; in = next;"}


@pytest.mark.parametrize(
    ("opened", "counted"),
    [
        ("State = 1; pulled_ms = 0;", "++pulled_ms >= 25"),
        ("State = 1; Sent = 1; pulled_ms = 0;", "pulled_ms++ > 25"),
    ],
)
def test_a_state_before_the_count_that_ends_it_is_told(tmp_path: Path, opened: str, counted: str) -> None:
    valve = VALVE.format(opened=opened, counted=counted)
    (line,) = told(tmp_path, **OPENS, more=valve)
    assert opened in line


@pytest.mark.parametrize(
    ("opened", "counted", "given"),
    [
        ("pulled_ms = 0; State = 1;", "++pulled_ms >= 25", {}),
        ("Switch_disable(); State = 1; pulled_ms = 0; Switch_enable();", "++pulled_ms >= 25", {}),
        ("State = 1; pulled_ms = 0;", "++pulled_ms == 25", {}),  # an old count goes on
        ("State = 3; pulled_ms = 0;", "++pulled_ms >= 25", {}),  # a state that nothing ends
        # Nothing old is left in it.
        ("State = 1; pulled_ms = 0;", "++pulled_ms >= 25", {"turn": "Open(); if (Sent) { State = 0; pulled_ms = 0; }"}),
    ],
)
def test_a_count_before_its_state_or_none_that_is_old_is_silent(
    tmp_path: Path, opened: str, counted: str, given: dict[str, str]
) -> None:
    assert told(tmp_path, **{**OPENS, "more": VALVE.format(opened=opened, counted=counted), **given}) == []


def test_a_routine_that_main_starts_comes_when_the_count_is_set(tmp_path: Path) -> None:
    valve = VALVE.format(opened="State = 1; pulled_ms = 0;", counted="++pulled_ms >= 25")
    valve = valve.replace("Ticks++;", "Ticks++; SCI_acknowledge();")
    assert told(tmp_path, **OPENS, more="void SCI_acknowledge(void) {}" + valve) == []
