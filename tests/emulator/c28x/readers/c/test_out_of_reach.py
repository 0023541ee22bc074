"""Tests of counters against values that they never have: wrong programs, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import CWorkshop
from tests.emulator.c28x.workshop import Workshop

PROGRAM = """typedef unsigned Uint16;
#define LIMIT 5
Uint16 ready(void);
void assert_failed(void);
Uint16 late = 0, valid = 1, copied;
{objects}
{functions}
void Step(void) {{ {step} }}
{main}
"""
MAIN = "int main(void) { for (;;) { Step(); Again(); } }"


def told(objects: str, step: str, functions: str = "", main: str = "") -> list[str]:
    """What is always false or true, in a program of these parts."""
    text = PROGRAM.format(objects=objects, step=step, functions=functions, main=main)
    shop = CWorkshop(text, static=True, externs={"ready": lambda: 1, "assert_failed": lambda: None})
    return [f.message for f in shop.findings if f.rule == "constant-condition"]


AGE = "static volatile Uint16 age = LIMIT;"
AGAIN = "void Again(void) { age = 0; }"
COUNT = "if (age < LIMIT) age++;"
WAITED = "static Uint16 waited = 0;"
BEGUN = "void Again(void) { waited = 0; }"
MISSED = "static Uint16 missed = LIMIT;"
OVEN = "static struct oven { Uint16 state, steps; } oven = {1, 0};"
ENTER = "void enter(Uint16 next) { oven.state = next; oven.steps = 0; }"


@pytest.mark.parametrize(("parts", "message"), [
    ((AGE, f"{COUNT} if (age > LIMIT) late = 1;", AGAIN), "age > 5 is always false: age is counted to 5 at most"),
    ((AGE, f"{COUNT} if (age > LIMIT) late = 1;", f"{AGAIN} void Stop(void) {{ age = LIMIT; }}"),
     "age > 5 is always false: age is counted to 5 at most"),
    ((AGE, f"{COUNT} late = LIMIT < age;", AGAIN), "5 < age is always false: age is counted to 5 at most"),
    ((AGE, f"{COUNT} if (age == LIMIT + 1) late = 1;", AGAIN),
     "age == 6 is always false: age is counted to 5 at most"),
    ((AGE, f"{COUNT} if (age <= LIMIT) valid = 1; else late = 1;", AGAIN),
     "age <= 5 is always true: age is counted to 5 at most"),
    ((AGE, COUNT, f"{AGAIN} Uint16 Late(void) {{ return ready() && age > LIMIT; }}"),
     "age > 5 is always false: age is counted to 5 at most"),
    (("", f"static Uint16 age; if (ready()) age = 0; else {COUNT} if (age >= 10) late = 1;"),
     "age >= 10 is always false: age is counted to 5 at most"),
    (("Uint16 age = 0;", f"{COUNT} if (age > LIMIT) late = 1;", AGAIN, MAIN),
     "age > 5 is always false: age is counted to 5 at most"),
    ((WAITED, "if (ready()) late = 0; else if (waited >= LIMIT) late = 1;", BEGUN),
     "waited >= 5 is always false: no statement counts waited, it is always 0"),
    ((MISSED, "missed = 0; if (ready()) { if (missed < LIMIT) missed++; if (missed >= LIMIT) valid = 0; }"),
     "missed >= 5 is always false: missed is set anew before it in each pass, and is at most 1 here"),
    ((MISSED, "missed = 0; if (ready()) { missed++; if (missed >= LIMIT) { missed = 0; valid = 0; } }"),
     "missed >= 5 is always false: missed is set anew before it in each pass, and is at most 1 here"),
    # Members of a structure, of one in another, and of one that is an element.
    ((OVEN, "if (oven.steps >= LIMIT) enter(2);", ENTER),
     "oven.steps >= 5 is always false: no statement counts oven.steps, it is always 0"),
    ((OVEN, "if (oven.steps < LIMIT) oven.steps++; if (oven.steps > LIMIT) late = 1;", ENTER),
     "oven.steps > 5 is always false: oven.steps is counted to 5 at most"),
    (("static struct { struct { Uint16 waited; } link; Uint16 sent; } bus;", "if (bus.link.waited > LIMIT) late = 1;",
      "void Again(void) { bus.link.waited = 0; bus.sent++; }"),
     "bus.link.waited > 5 is always false: no statement counts bus.link.waited, it is always 0"),
    (("struct wheel { Uint16 still; Uint16 speed; }; static struct wheel wheels[2];",
      "if (wheels[1].still >= LIMIT) late = 1;", "void Again(void) { wheels[1].still = 0; wheels[0].still++; }"),
     "wheels[1].still >= 5 is always false: no statement counts wheels[1].still, it is always 0"),
    (("struct oven { Uint16 state, steps; }; struct oven oven = {1, 0};", "if (oven.steps >= LIMIT) enter(2);", ENTER,
      "int main(void) { for (;;) { Step(); enter(1); } }"),
     "oven.steps >= 5 is always false: no statement counts oven.steps, it is always 0"),
])  # fmt: skip
def test_no_statement_counts_so_far(parts: tuple[str, ...], message: str) -> None:
    """It is told at the test."""
    assert told(*parts) == [message]


@pytest.mark.parametrize("parts", [
    # It gets there.
    (AGE, f"{COUNT} if (age >= LIMIT) late = 1;", AGAIN),
    (AGE, f"{COUNT} if (age < LIMIT) valid = 1; else late = 1;", AGAIN),
    (AGE, "if (age <= LIMIT) age++; if (age > LIMIT) late = 1;", AGAIN),
    (AGE, "age++; if (age > LIMIT) late = 1;", AGAIN),
    (AGE, "if (age < LIMIT) age += 2; if (age > LIMIT) late = 1;", AGAIN),
    (AGE, f"if (age > LIMIT) late = 1; {COUNT}", f"{AGAIN} void Lost(void) {{ age = LIMIT + 1; }}"),
    ("static Uint16 age = 10;", f"{COUNT} if (age > LIMIT) late = 1;", AGAIN),
    (WAITED, "if (ready()) waited = 0; else if (waited >= LIMIT) late = 1; else waited++;"),
    (MISSED, "if (ready()) { if (missed < LIMIT) missed++; if (missed >= LIMIT) valid = 0; } else missed = 0;"),
    (MISSED, "missed = 0; while (ready()) missed++; if (missed >= LIMIT) valid = 0;"),
    (MISSED, "missed = 0; do { missed++; } while (ready() && missed < LIMIT); if (missed >= LIMIT) valid = 0;"),
    (MISSED, "Uint16 i; missed = 0; for (i = 0; i < 9; i++) if (ready()) missed++; if (missed >= LIMIT) valid = 0;"),
    (MISSED, "switch (valid) { case 0: missed = 0; break; default: missed++; } if (missed >= LIMIT) valid = 0;"),
    # It is counted down too, and wraps.
    ("static Uint16 level;", "if (ready()) { if (level < LIMIT) level++; } else level--; if (level > LIMIT) late = 1;"),
    # Somebody else counts, or sets it.
    (MISSED, "missed = 0; Poll(); if (missed >= LIMIT) valid = 0;", "void Poll(void) { while (ready()) missed++; }"),
    ("static volatile Uint16 ticks;", "ticks = 0; while (ready()) {} if (ticks >= LIMIT) late = 1;",
     "interrupt void Tick(void) { if (ticks < LIMIT) ticks++; }"),
    ("static volatile Uint16 ticks;", "if (ticks < 3) { while (ready()) {} if (ticks >= LIMIT) late = 1; }",
     "interrupt void Tick(void) { if (ticks < LIMIT) ticks++; }"),
    (MISSED, "missed = 0; missed++; Force(); if (missed >= LIMIT) valid = 0;",
     "void Force(void) { if (ready()) missed = LIMIT; }"),
    (MISSED, "if (missed < LIMIT && Force()) missed++; if (missed > LIMIT) valid = 0;",
     "Uint16 Force(void) { missed = LIMIT; return 1; }"),
    (AGE, f"{COUNT} if (age > LIMIT) late = 1;", "interrupt void Lost(void) { age = LIMIT; }"),
    (AGE, f"{COUNT} if (age > LIMIT) late = 1;", "void Set(Uint16 to) { age = to; }"),
    (AGE, f"{COUNT} if (age > LIMIT) late = 1;", "void Set(void) { age = ready(); }"),
    (AGE, f"{COUNT} if (age > LIMIT) late = 1;", "volatile Uint16 *Where(void) { return &age; }"),
    ("Uint16 age = 0;", f"{COUNT} if (age > LIMIT) late = 1;", AGAIN),
    ("volatile Uint16 age = 0;", f"{COUNT} if (age > LIMIT) late = 1;", AGAIN, MAIN),
    # A precaution.
    (AGE, f"{COUNT} if (age > LIMIT) age = LIMIT;", AGAIN),
    (AGE, f"{COUNT} if (age > LIMIT) assert_failed();", AGAIN),
    (AGE, f"{COUNT} if (age > LIMIT) for (;;) {{}}", AGAIN),
    ("static Uint16 n, ring[LIMIT];", "if (n < LIMIT) { ring[n] = ready(); n++; } if (n > LIMIT) late = 1;"),
    # Switched off, by the build or for the time being.
    ("#define RETRIES 0\nstatic Uint16 tried;", "if (tried > RETRIES) late = 1; if (ready()) tried = 0;"),
    ("#define NEVER 0xFFFF\nstatic Uint16 age;", f"{COUNT} if (age >= NEVER) late = 1;", AGAIN),
    (WAITED, "if (waited >= LIMIT) late = 1;\n#ifdef WAITS\nwaited++;\n#endif\n", BEGUN),
    (AGE, f"{COUNT} if (age > LIMIT) late = 1;\n#ifdef FAST\nage += 10;\n#endif\n", AGAIN),
    ("#define LEVEL 0\nstatic Uint16 level;", "if (level >= 2) late = 1;", "void Again(void) { level = LEVEL; }"),
    ("static Uint16 level;", "if (level >= 2) late = 1;", "void Step_Init(void) { level = 0; }"),
    ("static Uint16 level;", "if (level >= 2) late = 1;"),
    ("static volatile Uint16 level;", "if (level >= 2) late = 1;", "void Again(void) { level = 0; }"),
    # A member that is counted, by its name, through a pointer, by an interrupt, or with the whole structure.
    (OVEN, "oven.steps++; if (oven.steps >= LIMIT) enter(2);", ENTER),
    (OVEN, "count(&oven); if (oven.steps >= LIMIT) enter(2);", f"{ENTER} void count(struct oven *o) {{ o->steps++; }}"),
    (OVEN, "if (oven.steps >= LIMIT) enter(2);", f"{ENTER} void Set(const struct oven *to) {{ oven = *to; }}"),
    (OVEN, "if (oven.steps >= LIMIT) enter(2);", f"{ENTER} interrupt void Tick(void) {{ oven.steps += 1; }}"),
    (OVEN, "Uint16 *p = &oven.steps; (*p)++; if (oven.steps >= LIMIT) enter(2);", ENTER),
    (OVEN, "if (oven.steps >= LIMIT) enter(2);\n#ifdef COUNTS\noven.steps++;\n#endif\n", ENTER),
    (OVEN, "if (oven.steps >= LIMIT) enter(2);", "void enter(Uint16 next) { oven.state = next; }"),
    (OVEN, "if (oven.steps >= LIMIT) enter(2);",
     "void enter(Uint16 next) { oven.state = next; } void Oven_Init(void) { oven.steps = 0; }"),
    ("struct oven { Uint16 state, steps; }; struct oven oven = {1, 0};", "if (oven.steps >= LIMIT) enter(2);", ENTER),
    ("static volatile struct oven { Uint16 state, steps; } oven;", "if (oven.steps >= LIMIT) enter(2);", ENTER),
    ("static union { struct { Uint16 state, steps; } of; unsigned long all; } u;",
     "u.all += 0x10000ul; if (u.of.steps >= LIMIT) late = 1;", "void Again(void) { u.of.steps = 0; }"),
    ("struct wheel { Uint16 still; Uint16 speed; }; static struct wheel wheels[2];",
     "Uint16 i; for (i = 0; i < 2; i++) wheels[i].still++; if (wheels[1].still >= LIMIT) late = 1;",
     "void Again(void) { wheels[1].still = 0; }"),
])  # fmt: skip
def test_right_programs(parts: tuple[str, ...]) -> None:
    """The counter gets there, or it need not."""
    assert told(*parts) == []


@pytest.mark.parametrize(("name", "count", "messages"), [
    ("_Waited", "", ["_Waited >= 5 is always false: no statement counts _Waited, it is always 0"]),
    ("_Waited", "_Waited += 1", []),
    ("Waited", "", []),  # another file may count it
])  # fmt: skip
def test_in_python(name: str, count: str, messages: list[str]) -> None:
    """A name with an underscore in front is known in its file alone."""
    shop = Workshop(f"""
LIMIT = 5
{name}: uint16 = 0
_Busy: uint16 = 0

def Ping() -> void:
    {name} = 0
    _Busy = 1

def Tick() -> void:
    if _Busy and {name} >= LIMIT:
        _Busy = 0
    {count}
""", static=True)  # fmt: skip
    assert [f.message for f in shop.findings if f.rule == "constant-condition"] == messages
