"""Ages of stamps that an interrupt routine sets: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include "F28x_Project.h"
#define LIMIT 500UL
volatile Uint32 Millis = 0, Heard = 0;
volatile Uint16 Lamp = 0, Enabled = 1, Chars = 0;
static struct {{ Uint16 n; volatile Uint32 at; }} line = {{ 0, 0 }};
interrupt void Tick(void) {{ Millis++; }}
interrupt void Rx(void) {{ {routine} PieCtrlRegs.PIEACK.all = PIEACK_GROUP9; }}
static Uint32 Now(void) {{ Uint32 now; DINT; now = Millis; EINT; return now; }}
static void Check(void) {{ {check} }}
void main(void)
{{
    Uint32 t = 0;
    InitSysCtrl();
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    PieVectTable.SCIA_RX_INT = &Rx;
    EDIS;
    EINT;
    for (;;) {{ {loop} if (t) Lamp++; }}
}}
"""
ROUTINE = "Heard = Millis;"
CHECK = "Uint32 now = Millis; if (now - Heard > LIMIT) Lamp = 0;"


def told(tmp_path: Path, routine: str, check: str, loop: str) -> list[str]:
    """The messages of `stamp-compare`."""
    file = tmp_path / "a.c"
    file.write_text(PROGRAM.format(routine=routine, check=check, loop=loop), encoding="utf-8")
    return [f.message for f in Build([str(file)]).compiled.findings if f.rule == "stamp-compare"]


@pytest.mark.parametrize(("routine", "check", "loop"), [
    (ROUTINE, CHECK, "Check();"),
    (ROUTINE, "Uint32 age; age = Now() - Heard; if (age >= LIMIT) Lamp = 0;", "Check();"),
    ("Uint32 now = Millis; if (Chars < 9) Heard = now;", CHECK, "Check();"),
    ("line.at = Millis;", "Uint32 now = Now(); Lamp = now - line.at < LIMIT;", "Check();"),
    ("Heard = ECap1Regs.TSCTR;", "if (ECap1Regs.TSCTR - Heard > LIMIT) Lamp = 0;", "Check();"),
])  # fmt: skip
def test_an_age_that_a_routine_makes_negative_is_told(tmp_path: Path, routine: str, check: str, loop: str) -> None:
    assert ["later than the clock" in message for message in told(tmp_path, routine, check, loop)] == [True]


@pytest.mark.parametrize(("routine", "check", "loop"), [
    (ROUTINE, "Uint32 heard = Heard, now = Millis; if (now - heard > LIMIT) Lamp = 0;", "Check();"),
    (ROUTINE, "Uint32 age; DINT; age = Millis - Heard; EINT; if (age > LIMIT) Lamp = 0;", "Check();"),
    (ROUTINE, CHECK, "DINT; Check(); EINT;"),
    (ROUTINE, "Uint32 now = Millis; if ((int32)(now - Heard) > 500L) Lamp = 0;", "Check();"),
    (ROUTINE, "Uint32 now = Millis; if (Heard < now && now - Heard > LIMIT) Lamp = 0;", "Check();"),
    (ROUTINE, "Uint32 age = Now() - Heard; if (age < 0x80000000UL && age > LIMIT) Lamp = 0;", "Check();"),
    (ROUTINE, "Uint32 now = Millis; if (now - Heard != 0) Lamp = 0;", "Check();"),
    (ROUTINE, "Uint32 age = Now() - Heard; if (age > LIMIT && age < 10 * LIMIT) Lamp = 0;", ""),
    # It stamps nothing while main has not taken the last one; main sets its own stamp; another clock.
    ("if (!Enabled) { Heard = Millis; Enabled = 1; }", CHECK, "Check(); Enabled = 0;"),
    ("Chars++;", CHECK, "Check(); Heard = Millis;"),
    ("Heard = ECap1Regs.TSCTR;", CHECK, "Check();"),
    ("Heard = Millis + 20;", CHECK, "Check();"),
])  # fmt: skip
def test_an_age_that_is_never_negative_is_silent(tmp_path: Path, routine: str, check: str, loop: str) -> None:
    assert told(tmp_path, routine, check, loop) == []
