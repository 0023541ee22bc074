"""Watchdogs that are serviced on signs of life that nothing takes back, and right twins: `watchdog-in-vain`."""

from __future__ import annotations

import pytest

from emulator.c28x.passes.checks import check
from emulator.c28x.passes.stamps import Stamps
from tests.emulator.c28x.readers.c.workshop import read

#: Two tasks of a loop set their bits; the supervisor is called every 100 ms.
PROGRAM = """#include "F28x_Project.h"
#define CONTROL 1
#define COMM    2
#define ALL     (CONTROL | COMM)
volatile Uint16 Alive = 0, Ready, Turns, LastTurns, Failures, Kicked, Seconds;
volatile Uint32 Ms, Last;
static struct { Uint16 alive, failures; } Dog;
static void SignOfLife(Uint16 bit) { DINT; Alive |= bit; EINT; }
static void Kick(void) { EALLOW; WdRegs.WDKEY.bit.WDKEY = 0x55; WdRegs.WDKEY.bit.WDKEY = 0xAA; EDIS; }
static void Control(void) { Alive |= CONTROL; }
static void Comm(void) { Alive |= COMM; }
static void Supervise(void)
{
    if ((Alive & ALL) == ALL)
        ServiceDog();
}
interrupt void tick(void) { Ms++; }
void main(void)
{
    Alive = 0;
    Ready = 1;
    ServiceDog();
    for (;;) {
        Turns++;
        Control();
        Comm();
        if (Ms - Last >= 100) {
            Last = Ms;
            Supervise();
        }
    }
}
"""
TEST = """    if ((Alive & ALL) == ALL)
        ServiceDog();
"""
SERVICED = """    if ((Alive & ALL) == ALL) {
        ServiceDog();
"""


def told(text: str) -> list[tuple[int, str]]:
    """Line and object of each finding of the rule."""
    modules = read({"drv.c": text}).translate()
    found = check(modules, {v: v.initial for m in modules for v in m.variables}, Stamps(modules, frozenset()))
    return [(f.place.line, f.object.rsplit(".", 1)[-1]) for f in found if f.rule == "watchdog-in-vain"]


def line(text: str, of: str) -> int:
    """The line of the only place of a text."""
    assert text.count(of) == 1
    return text[: text.index(of)].count("\n") + 1


def test_signs_of_life_that_nothing_takes_back_are_told_at_the_test() -> None:
    assert told(PROGRAM) == [(line(PROGRAM, "if ((Alive & ALL) == ALL)"), "Alive")]


@pytest.mark.parametrize("test", [
    # Other tests that stay true, another branch, a copy, a function that services, the two keys.
    "    if (Alive == ALL) ServiceDog();\n",
    "    if (Alive != ALL) Failures++; else ServiceDog();\n",
    "    if ((Alive & ALL) != ALL) return;\n    ServiceDog();\n",
    "    if (!((Alive & ALL) == ALL)) { Failures++; } else { ServiceDog(); }\n",
    "    if ((Alive & CONTROL) && (Alive & COMM)) ServiceDog();\n",
    "    if ((Alive & CONTROL) && (Alive & COMM) != 0) Kick();\n",
    "    Uint16 seen = Alive;\n    if ((seen & ALL) == ALL) { ServiceDog(); }\n",
    "    Uint16 seen;\n    DINT;\n    seen = Alive;\n    EINT;\n    if ((seen & ALL) == ALL) ServiceDog();\n",
    "    if ((Alive & ALL) == ALL) { WdRegs.WDKEY.bit.WDKEY = 0x55; WdRegs.WDKEY.bit.WDKEY = 0xAA; }\n",
    # A time, and a count of its own, are no signs of life.
    "    static Uint16 calls;\n    if (++calls >= 5) { calls = 0; if (Alive == ALL) ServiceDog(); }\n",
    "    if (Ms > 1000 && Alive == ALL) ServiceDog();\n",
])  # fmt: skip
def test_a_test_that_stays_true_is_told(test: str) -> None:
    text = PROGRAM.replace(TEST, test)
    assert text != PROGRAM
    assert [name for _, name in told(text)] == ["Alive"]


@pytest.mark.parametrize(("was", "now", "name"), [
    # By a parameter; members; a single sign that the loop sets in each turn, or that its name says.
    ("{ Alive |= CONTROL; }", "{ SignOfLife(CONTROL); }", "Alive"),
    ("Alive", "Dog.alive", "Dog"),
    ("{ Alive |= COMM; }", "{ SignOfLife(COMM); }", "Alive"),
    ("        Comm();\n", "        Comm();\n        Kicked = 1;\n", "Kicked"),
])  # fmt: skip
def test_other_signs_of_life_are_told(was: str, now: str, name: str) -> None:
    text = PROGRAM.replace(was, now)
    if name == "Dog":
        text = text.replace("volatile Uint16 Dog.alive = 0, ", "volatile Uint16 ")
    if name == "Kicked":
        text = text.replace(TEST, "    if (Kicked) ServiceDog();\n")
    ((_, found),) = told(text)
    assert name in (found, "Dog")


@pytest.mark.parametrize(("was", "now"), [
    # Taken back: after the service, always, by a task, a single bit, by a copy, through a pointer, by a function.
    (TEST, SERVICED + "        Alive = 0;\n    }\n"),
    (TEST, TEST + "    Alive = 0;\n"),
    (TEST, SERVICED + "        Alive &= ~ALL;\n    }\n"),
    (TEST, SERVICED + "        Alive ^= ALL;\n    }\n"),
    ("{ Alive |= COMM; }", "{ if (Failures) Alive &= ~COMM; else Alive |= COMM; }"),
    (TEST, SERVICED + "        volatile Uint16 *p = &Alive; *p = 0;\n    }\n"),
    ("        Turns++;\n", "        Turns++; if (Failures > 9) { Alive = 0; }\n"),
    ("interrupt void tick(void) { Ms++; }", "interrupt void tick(void) { Ms++; if (Ms % 500 == 0) Alive = 0; }"),
    # One real sign of life is enough: in the test, around it, around the call, and a wait for one.
    (TEST, "    if (Alive == ALL && Turns != LastTurns) { LastTurns = Turns; ServiceDog(); }\n"),
    (TEST, "    if (Turns != LastTurns) { LastTurns = Turns; if (Alive == ALL) ServiceDog(); }\n"),
    (TEST, "    if (Turns == LastTurns) return;\n    LastTurns = Turns;\n    if (Alive == ALL) ServiceDog();\n"),
    ("if (Ms - Last >= 100) {", "if (Kicked) { Kicked = 0;"),
    (TEST, "    static Uint16 last; int n = Failures;\n    if (n != last) { last = n; if (Alive == ALL) Kick(); }\n"),
    # The start-up sets a flag, or bits: services begin behind it.
    (TEST, "    if (Ready) ServiceDog();\n"),
    ("        Control();\n        Comm();\n", ""),
    # It becomes false again, or is not meant to hold: another bit, the other way round.
    ("{ Alive |= COMM; }", "{ Alive |= COMM; Alive |= 8; }\n#define X"),
    (TEST, "    if ((Alive & 0x10) == 0) ServiceDog();\n"),
    # A service without a condition.
    (TEST, "    ServiceDog();\n"),
    # Counters that are set back.
    (TEST, "    if (Turns > 3) { Turns = 0; ServiceDog(); }\n"),
    # A command that lets the service begin, set once on an order.
    (TEST, "    if (Failures == 7) Ready = 1;\n    if (Ready) ServiceDog();\n"),
    # Not a whole program.
    ("void main(void)", "void run(void)"),
])  # fmt: skip
def test_signs_of_life_that_are_taken_back_are_not_told(was: str, now: str) -> None:
    assert PROGRAM.count(was) == 1
    text = PROGRAM.replace(was, now)
    if "Kicked" in now:
        text = text.replace("Ms++;", "Ms++; Kicked = 1;")
    if "n = Failures" in now:
        text = text.replace("Ms++;", "Ms++; Failures++;")
    if "#define X" in now:
        text = text.replace("if ((Alive & ALL) == ALL)", "if (Alive == ALL)")
    if not now:
        text = text.replace("    Ready = 1;\n", "    Ready = 1;\n    Control();\n    Comm();\n")
    assert not told(text)


#: Tasks of the kernel.
TASKS = """#include "F28x_Project.h"
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/knl/Semaphore.h>
volatile Uint16 Alive = 0;
Semaphore_Handle Beat;
void TaskA(UArg a, UArg b) { while (1) { Task_sleep(10); Alive |= 1; } }
void TaskB(UArg a, UArg b) { while (1) { Task_sleep(20); Alive |= 2; } }
void TaskDog(UArg a, UArg b)
{
    while (1) {
        Task_sleep(100);
        if (Alive == 3)
            ServiceDog();
    }
}
int main(void)
{
    Task_create(TaskA, NULL, NULL);
    Task_create(TaskB, NULL, NULL);
    Task_create(TaskDog, NULL, NULL);
    BIOS_start();
    return 0;
}
"""


@pytest.mark.parametrize(("was", "now", "told_"), [
    ("", "", True),
    ("            ServiceDog();", "        { ServiceDog(); Alive = 0; }", False),
    # A task that others wake.
    ("Task_sleep(100);", "Semaphore_pend(Beat, BIOS_WAIT_FOREVER);", False),
    # Set before the loops: the start-up of the tasks.
    ("while (1) { Task_sleep(10); Alive |= 1; }", "Alive |= 1; while (1) { Task_sleep(10); }", False),
])  # fmt: skip
def test_tasks(was: str, now: str, told_: bool) -> None:
    assert bool(told(TASKS.replace(was, now) if was else TASKS)) == told_


@pytest.mark.parametrize(("supervise", "found"), [
    ("    Alive = 0;\n    ServiceDog();\n", True), ("    ServiceDog();\n    Alive = 0;\n", True),
    ("    if (Ready) {\n        Alive = 0;\n        Kick();\n    }\n", True),
    ("    if (Alive == ALL) {\n        Alive = 0;\n        ServiceDog();\n    }\n", False),
    ("    Turns = Alive;\n    Alive = 0;\n    if (Turns == ALL) ServiceDog();\n", False),
    ("    Alive = 0;\n", False),
    ("    Seconds = 0;\n    ServiceDog();\n", False),  # no sign that others set
])  # fmt: skip
def test_signs_that_nothing_reads(supervise: str, found: bool) -> None:
    """They are taken back beside the service."""
    text = PROGRAM.replace(TEST, supervise)
    service = "Kick();" if "Kick" in supervise else "ServiceDog();"
    at = supervise[: supervise.index(service)].count("\n") if service in supervise else 0
    first = PROGRAM[: PROGRAM.index(TEST)].count("\n") + 1
    assert told(text) == [(first + at, "Alive")] * found
