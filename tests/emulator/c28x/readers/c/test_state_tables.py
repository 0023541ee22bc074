"""Tables that lack an element for a state, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """typedef enum { OFF, RAMP, HOLD, FAULT } STATE;
typedef struct { int level; STATE state; } KILN;
static const char *const Names[] = { "OFF", "RAMP", "FAULT" };
static const int Lamps[4] = { 0, 1, 2, 3 };
volatile unsigned int in, shown;
static STATE State = OFF;
static int ready;
static KILN Kiln = { 0, OFF };
static void Show(const char *text) { shown = *text; }
static STATE Now(void) { return State; }
static void Enter(STATE next) { State = next; Kiln.level = 0; }
static void Copy(KILN *to) { *to = Kiln; }
"""
STEP = """static void Step(void)
{
    switch (State) { case OFF: Enter(RAMP); break; case RAMP: State = in ? HOLD : FAULT; break; default: Enter(OFF); }
    Kiln.state = State;
}
"""
MAIN = "int main(void) { for (;;) { Step(); if (in & 1) Report(); } }"


def told(report: str, step: str = STEP, main: str = MAIN) -> bool:
    """Whether a report is told that its table is too short."""
    text = f"{HEAD}{step}{report}\n{main}\n"
    lines = [line for rule, line in findings_of(text) if rule == "table-short"]
    assert set(lines) <= {(HEAD + step).count("\n") + 1}
    return bool(lines)


WRONG = "static void Report(void) { Show(Names[State]); }"
#: A state that begins beyond the table, and never comes back.
STARTS = STEP.replace("FAULT", "OFF")


@pytest.mark.parametrize(
    "report",
    [
        WRONG,
        "static void Report(void) { STATE s = Now(); if (shown) return; Show(Names[s]); }",
        "static void Report(void) { KILN k; Copy(&k); Show(Names[k.state]); }",
        "static void Report(void) { KILN k = Kiln; Show(Names[k.state]); }",
        "static void Report(void) { State = in > 9 ? FAULT : State; Show(Names[State]); }",
        "static void Report(void) { Enter(FAULT); Show(Names[State]); }",
        "static void Report(void) { KILN k = Kiln; Show(Names[k.state]), Show(k.level ? Names[0] : Names[1]); }",
        "static void Write(int s) { Show(Names[s]); } static void Report(void) { Write(State); }",
    ],
)
def test_a_table_that_lacks_the_last_state_is_told(report: str) -> None:
    assert told(report)


@pytest.mark.parametrize(
    ("report", "step", "main"),
    [
        ("static void Report(void) { Show(Lamps[State] ? Names[0] : Names[1]); }", STEP, MAIN),
        ("static void Report(void) { if (State == FAULT) return; Show(Names[State]); }", STEP, MAIN),
        ("static void Report(void) { Show(State < 3 ? Names[State] : Names[2]); }", STEP, MAIN),
        ("static void Report(void) { STATE s = State; if (s > 2) s = 2; Show(Names[s]); }", STEP, MAIN),
        (WRONG, STEP, MAIN.replace("in & 1", "State != FAULT")),
        (WRONG, STEP, MAIN.replace("Step();", "Step(); if (State > HOLD) continue;")),
        # What is set beside a state, or computed from it, may say which one it is.
        (WRONG, STEP.replace("State = in ?", "ready = !in; State = in ?"), MAIN.replace("in & 1", "ready")),
        (WRONG, STEP.replace("}\n", "    ready = State != FAULT;\n}\n"), MAIN.replace("in & 1", "ready")),
        # It was set just before.
        (WRONG, STEP, MAIN.replace("if (in & 1)", "State = in ? OFF : RAMP;")),
        (WRONG, STEP, MAIN.replace("if (in & 1)", "Enter(RAMP);")),
        ("static void Report(void) { STATE s = RAMP; if (in) s = OFF; Show(Names[s]); }", STEP, MAIN),
        # It begins beyond the table, and leaves that before anything is reported.
        (WRONG, STARTS, MAIN.replace("{ for", "{ Enter(FAULT); Step(); for")),
        (WRONG, STEP.replace("HOLD : FAULT", "HOLD : (STATE)(in & 3)"), MAIN),
        # Another object of the same structure has the state.
        (
            "static KILN Old; static void Report(void) { Old.state = FAULT; Show(Names[Kiln.state]); }",
            STARTS.replace("OFF : OFF", "OFF : HOLD"),
            MAIN.replace("Step();", "Step(); Copy(&Old);"),
        ),
    ],
)
def test_a_state_that_the_table_has_or_the_program_knows_is_silent(report: str, step: str, main: str) -> None:
    assert not told(report, step, main)
