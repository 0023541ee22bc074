"""Waits that nothing ends, and Clocks that nothing starts: a right program, and the same with a statement missing."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

RIGHT = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Mailbox.h>
#include <ti/sysbios/knl/Event.h>
#include <ti/sysbios/knl/Swi.h>
Semaphore_Handle ready, other;
Mailbox_Handle box;
Event_Handle event;
Clock_Handle timer;
Swi_Handle soon;
Int Done, Beats;
volatile Int Flag = 1;
Void beat(UArg a, UArg b) { Beats = Beats + 1; }
Void tick(UArg a) { Semaphore_post(ready); Swi_post(soon); }
Void worker(UArg a, UArg b)
{
    Int m;
    m = 1;
    for (;;) {
        Semaphore_pend(ready, BIOS_WAIT_FOREVER);
        Flag = 0;
        Mailbox_post(box, &m, BIOS_NO_WAIT);
        Event_post(event, Event_Id_00);
    }
}
Void reader(UArg a, UArg b)
{
    Int m;
    for (;;) {
        Mailbox_pend(box, &m, BIOS_WAIT_FOREVER);
        Done = m;
    }
}
Void waiter(UArg a, UArg b)
{
    for (;;) {
        Event_pend(event, Event_Id_NONE, Event_Id_00, BIOS_WAIT_FOREVER);
    }
}
Int main(Void)
{
    Clock_Params c;
    Task_Params t;
    ready = Semaphore_create(0, NULL, NULL);
    other = Semaphore_create(0, NULL, NULL);
    box = Mailbox_create(sizeof(Int), 4, NULL, NULL);
    event = Event_create(NULL, NULL);
    soon = Swi_create(beat, NULL, NULL);
    Clock_Params_init(&c);
    c.period = 10;
    c.startFlag = TRUE;
    timer = Clock_create(tick, 10, &c, NULL);
    Task_Params_init(&t);
    t.priority = 2;
    Task_create(worker, &t, NULL);
    Task_create(reader, &t, NULL);
    Task_create(waiter, &t, NULL);
    BIOS_start();
    return 0;
}
"""
#: The Swi waits for bits 0 and 1 of its trigger; the clock takes off bit 0, something else the bits of {}.
TRIGGERED = """Swi_Params s;
    Swi_Params_init(&s);
    s.trigger = 3;
    soon = Swi_create(beat, &s, NULL);
    if (Done == 7) Swi_andn(soon, {});"""
RULES = ("always-timeout", "never-posted", "clock-not-started", "post-lost", "endless-poll")


def told(tmp_path: Path, text: str) -> list[tuple[str, str]]:
    """The rules that the check of a program names, each with the statement."""
    if "s.trigger" in text:
        text = text.replace("Swi_post(soon);", "Swi_andn(soon, 1);")
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, board=load("bare"), seconds=0.1))
    lines = text.splitlines()
    return [
        (finding.rule, lines[finding.place.line - 1].strip())
        for finding in checked.findings
        if finding.rule in RULES and finding.place is not None
    ]


@pytest.mark.parametrize(("was", "now", "rule", "at"), [
    ("Semaphore_post(ready);", "Semaphore_post(other);", "never-posted", "Semaphore_pend(ready, BIOS_WAIT_FOREVER);"),
    ("Semaphore_post(ready);", "", "never-posted", "Semaphore_pend(ready, BIOS_WAIT_FOREVER);"),
    ("Mailbox_post(box, &m, BIOS_NO_WAIT);", "", "never-posted", "Mailbox_pend(box, &m, BIOS_WAIT_FOREVER);"),
    ("Mailbox_pend(box, &m, BIOS_WAIT_FOREVER);", "Mailbox_post(box, &m, BIOS_WAIT_FOREVER);", "never-posted",
     "Mailbox_post(box, &m, BIOS_WAIT_FOREVER);"),
    ("Event_post(event, Event_Id_00);", "", "never-posted",
     "Event_pend(event, Event_Id_NONE, Event_Id_00, BIOS_WAIT_FOREVER);"),
    ("Event_post(event, Event_Id_00);", "Event_post(event, Event_Id_03);", "never-posted",
     "Event_pend(event, Event_Id_NONE, Event_Id_00, BIOS_WAIT_FOREVER);"),
    ("Event_pend(event, Event_Id_NONE, Event_Id_00,", "Event_pend(event, Event_Id_00 + Event_Id_01, Event_Id_NONE,",
     "never-posted", "Event_pend(event, Event_Id_00 + Event_Id_01, Event_Id_NONE, BIOS_WAIT_FOREVER);"),
    # The Swi waits for what the worker sets, which cannot run before it ends.
    ("Beats = Beats + 1; }", "Beats = Beats + 1;\n while (Flag)\n ;\n }", "endless-poll", "while (Flag)"),
    ("Swi_post(soon);", "", "never-posted", "soon = Swi_create(beat, NULL, NULL);"),
    # A trigger of two bits, of which one stays.
    ("soon = Swi_create(beat, NULL, NULL);", TRIGGERED.format(1), "never-posted", "soon = Swi_create(beat, &s, NULL);"),
    ("c.startFlag = TRUE;", "", "clock-not-started", "timer = Clock_create(tick, 10, &c, NULL);"),
    # It runs once, and the worker waits again.
    ("c.period = 10;", "", "never-posted", "timer = Clock_create(tick, 10, &c, NULL);"),
    # Nobody keeps its handle.
    ("c.startFlag = TRUE;\n    timer = ", "", "clock-not-started", "Clock_create(tick, 10, &c, NULL);"),
])  # fmt: skip
def test_what_no_statement_brings_is_told_where_it_is_waited_for(
    tmp_path: Path, was: str, now: str, rule: str, at: str
) -> None:
    assert RIGHT.count(was) == 1
    assert told(tmp_path, RIGHT.replace(was, now)) == [(rule, at)]


@pytest.mark.parametrize(("was", "now"), [
    ("", ""),
    # It is brought, but on an order that does not come in this run.
    ("Semaphore_post(ready);", "if (Done == 7) Semaphore_post(ready);"),
    # Through a copy of the handle, and by a function whose address is taken.
    ("Semaphore_post(ready);", "Semaphore_Handle copy = ready; if (Done == 7) Semaphore_post(copy);"),
    ("Clock_create(tick, 10,", "Clock_create((Clock_FuncPtr)Semaphore_post, 10,"),
    ("Void tick(UArg a) { Semaphore_post(ready);",
     "Void (*const Post)(Semaphore_Handle) = Semaphore_post;\nVoid tick(UArg a) { if (Done == 7) Post(ready);"),
    ("c.startFlag = TRUE;", "if (Done == 7) Clock_start(timer);"),
    # A Clock that runs once is started again, its function is called, or the worker waits only once.
    ("c.period = 10;", "if (Done == 7) Clock_start(timer);"),
    ("c.period = 10;", "if (Done == 7) tick(0);"),
    ("c.period = 10;\n", "c.period = 0; Flag = 2;\n"),
    ("Event_post(event, Event_Id_00);", "if (Done == 7) Event_post(event, Event_Id_00);"),
    ("Event_post(event, Event_Id_00);", "Event_post(event, Event_Id_03 + Event_Id_00);"),
    ("Event_post(event, Event_Id_00);", "Event_post(event, Done);"),
    ("Event_pend(event, Event_Id_NONE, Event_Id_00,", "Event_pend(event, Event_Id_NONE, Event_Id_00 + Event_Id_05,"),
    ("Swi_post(soon);", "if (Done == 7) Swi_inc(soon);"),
    ("soon = Swi_create(beat, NULL, NULL);", TRIGGERED.format(2)),
    ("soon = Swi_create(beat, NULL, NULL);", TRIGGERED.format("Done")),
    ("Swi_post(soon);", "Swi_Handle copy = soon; if (Done == 7) Swi_post(copy);"),
    # With a timeout the task goes on.
    ("Mailbox_post(box, &m, BIOS_NO_WAIT);", ""),
])  # fmt: skip
def test_what_may_come_still_is_not(tmp_path: Path, was: str, now: str) -> None:
    text = RIGHT.replace(was, now) if was else RIGHT
    if not now:
        text = text.replace("Mailbox_pend(box, &m, BIOS_WAIT_FOREVER)", "Mailbox_pend(box, &m, 5)")
    if "Flag = 2" in now:
        text = text.replace("Semaphore_pend(ready,", "if (Flag == 2) Semaphore_pend(ready,").replace(
            "Flag = 0;", "Flag = 0; Task_sleep(1);"
        )
    assert not told(tmp_path, text)


#: The worker waits for so long that the tick comes once within.
TIMED = RIGHT.replace(
    "Semaphore_pend(ready, BIOS_WAIT_FOREVER);", "if (!Semaphore_pend(ready, 20))\n            continue;"
)


@pytest.mark.parametrize(("was", "now", "found"), [
    ("", "", False),
    ("Semaphore_post(ready);", "", True),
    ("Semaphore_post(ready);", "if (Done == 7) Semaphore_post(ready);", False),
    # It is a pause, and was given once.
    ("if (!Semaphore_pend(ready, 20))\n            continue;", "Semaphore_pend(other, 20);", False),
    ("if (!Semaphore_pend(ready, 20))\n            continue;", "(void)Semaphore_pend(other, 20);", False),
    ("ready = Semaphore_create(0, NULL, NULL);", "ready = Semaphore_create(1, NULL, NULL);", False),
])  # fmt: skip
def test_a_wait_that_always_times_out_is_told(tmp_path: Path, was: str, now: str, found: bool) -> None:
    text = TIMED.replace(was, now) if was else TIMED
    if "create(1" in now:
        text = text.replace("Semaphore_post(ready);", "")
    at = "if (!Semaphore_pend(ready, 20))"
    assert [place for rule, place in told(tmp_path, text) if rule == "always-timeout"] == [at] * found


def test_a_handle_in_a_structure_is_one_of_its_own(tmp_path: Path) -> None:
    text = RIGHT.replace("Semaphore_Handle ready, other;", "").replace("ready", "sem.ready")
    text = text.replace("other =", "sem.other =")
    text = text.replace("Event_Handle", "struct { Semaphore_Handle ready, other; } sem;\nEvent_Handle", 1)
    assert not told(tmp_path, text)
    wait = "Semaphore_pend(sem.ready, BIOS_WAIT_FOREVER);"
    text = text.replace("Semaphore_post(sem.ready)", "Semaphore_post(sem.other)")
    assert told(tmp_path, text) == [("never-posted", wait)]


def test_a_part_of_a_program_is_told_nothing(tmp_path: Path) -> None:
    text = RIGHT.replace("Semaphore_post(ready);", "").replace("Int main(Void)", "Int start(Void)")
    assert not told(tmp_path, text)


#: Five frames come at once; the semaphore keeps one release.
BURST = RIGHT.replace(
    "ready = Semaphore_create(0, NULL, NULL);",
    "Semaphore_Params one;\n Semaphore_Params_init(&one);\n one.mode = Semaphore_Mode_BINARY;\n"
    " ready = Semaphore_create(0, &one, NULL);",
).replace("Void tick(UArg a) { Semaphore_post(ready);", "Void tick(UArg a) { Int i; for (i = 0; i < 5; i++)\n {0}\n")


def test_a_binary_semaphore_that_loses_posts_is_told(tmp_path: Path) -> None:
    assert told(tmp_path, BURST.replace("{0}", "Semaphore_post(ready);")) == [("post-lost", "Semaphore_post(ready);")]
    put = "Void put(Void) {\n Semaphore_post(ready);\n }\n Void tick"
    assert told(tmp_path, BURST.replace("{0}", "put();").replace("Void tick", put)) == [
        ("post-lost", "Semaphore_post(ready);")
    ]


@pytest.mark.parametrize(("post", "was", "now"), [
    # One post a tick, whether the last was taken or not.
    ("if (i == 0) Semaphore_post(ready);", "", ""),
    # A counting semaphore keeps them all.
    ("Semaphore_post(ready);", "one.mode = Semaphore_Mode_BINARY;", ""),
    # The task empties the queue.
    ("{ Done++; Semaphore_post(ready); }", "Flag = 0;", "while (Done > 0) Done--;"),
])  # fmt: skip
def test_a_post_that_nobody_misses_is_silent(tmp_path: Path, post: str, was: str, now: str) -> None:
    text = BURST.replace("{0}", post)
    assert not told(tmp_path, text.replace(was, now) if was else text)


def test_a_task_that_posts_news_and_sleeps_is_silent(tmp_path: Path) -> None:
    wait = "Event_pend(event, Event_Id_NONE, Event_Id_00, BIOS_WAIT_FOREVER);"
    text = BURST.replace("{0}", ";").replace(wait, "Semaphore_post(ready); Task_sleep(1);")
    text = text.replace("Flag = 0;", "Flag = 0; Task_sleep(5);").replace("Event_post(event, Event_Id_00);", "")
    assert not told(tmp_path, text)


#: A ring of slots: the writer waits for a free one, the reader for a used one.
RING = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/knl/Semaphore.h>
Semaphore_Handle unused, used, lock;
Int Slots[4], Put, Got, Taken;
static Void store(Int value)
{
    if (!Semaphore_pend(unused, 5)) {
        return;
    }
    Semaphore_pend(lock, BIOS_WAIT_FOREVER);
    Slots[Put] = value;
    Put = (Put + 1) & 3;
    Semaphore_post(lock);
    Semaphore_post(used);
}
Void writer(UArg a, UArg b)
{
    for (;;) {
        Task_sleep(2);
        store(3);
    }
}
Void reader(UArg a, UArg b)
{
    for (;;) {
        Semaphore_pend(used, BIOS_WAIT_FOREVER);
        Semaphore_pend(lock, BIOS_WAIT_FOREVER);
        Taken = Slots[Got];
        Got = (Got + 1) & 3;
        Semaphore_post(lock);
        Semaphore_post(unused);
    }
}
Int main(Void)
{
    Task_Params t;
    unused = Semaphore_create(4, NULL, NULL);
    used = Semaphore_create(0, NULL, NULL);
    lock = Semaphore_create(1, NULL, NULL);
    Task_Params_init(&t);
    t.priority = 2;
    Task_create(writer, &t, NULL);
    Task_create(reader, &t, NULL);
    BIOS_start();
    return 0;
}
"""


def in_a_ring(tmp_path: Path, text: str) -> list[tuple[str, str, int]]:
    """What is told of waits: the rule, the statement, and how many other waits it names."""
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, board=load("bare"), seconds=0.1))
    lines = text.splitlines()
    return [
        (finding.rule, lines[finding.place.line - 1].strip(), len(finding.details))
        for finding in checked.findings
        if finding.rule in (*RULES, "deadlock") and finding.place is not None
    ]


@pytest.mark.parametrize(("changes", "found"), [
    ({}, []),
    ({"create(4": "create(0"}, [("deadlock", "Semaphore_pend(used, BIOS_WAIT_FOREVER);", 1)]),
    # A lock that is taken before it was ever given is a ring of its own.
    ({"create(1": "create(0"}, [("deadlock", "Semaphore_pend(lock, BIOS_WAIT_FOREVER);", 0)]),
    # Nobody waits for ever.
    ({"create(4": "create(0", "Semaphore_pend(used, BIOS_WAIT_FOREVER);": "if (!Semaphore_pend(used, 7)) continue;"},
     [("always-timeout", "if (!Semaphore_pend(used, 7)) continue;", 1)]),
    # Somebody else gives the first one, though on an order that does not come in this run.
    ({"create(4": "create(0", "Task_sleep(2);": "Task_sleep(2); if (Taken == 9) Semaphore_post(unused);"}, []),
    # The writer goes on without a slot, and so posts.
    ({"create(4": "create(0", "        return;\n": ""}, []),
    # A wait that is not always made does not hold back the post.
    ({"create(4": "create(0", "Semaphore_pend(used, BIOS_WAIT_FOREVER);":
      "if (Taken == 0) {\n Semaphore_pend(used, BIOS_WAIT_FOREVER);\n }"}, []),
])  # fmt: skip
def test_semaphores_that_are_posted_only_behind_each_other_are_told(
    tmp_path: Path, changes: dict[str, str], found: list[tuple[str, str, int]]
) -> None:
    text = RING
    for was, now in changes.items():
        assert text.count(was) == 1
        text = text.replace(was, now)
    assert in_a_ring(tmp_path, text) == found


#: The half of the ring that counts what is used keeps one post only.
BINARY = """Semaphore_Params one;
    Semaphore_Params_init(&one);
    one.mode = Semaphore_Mode_BINARY;
    used = Semaphore_create(0, &one, NULL);"""
PROMPT = {"Task_create(writer, &t, NULL);": "Task_create(writer, &t, NULL);\n t.priority = 3;"}


@pytest.mark.parametrize(("changes", "found"), [
    ({}, True), (PROMPT, True), ({"Taken = Slots[Got];": "Taken = Slots[Got];\n Task_sleep(3);"}, True),
    # One place: there is never more than one post.
    ({"create(4": "create(1"}, False),
    # The reader empties the ring for each post; the writer posts without a place.
    ({"        Semaphore_post(unused);": "while (Taken > 0) { Taken--; Semaphore_post(unused); }"}, False),
    ({"    if (!Semaphore_pend(unused, 5)) {\n        return;\n    }\n": ""}, False),
    # The reader runs at once after each post, and waits for nothing else.
    ({**PROMPT, "        Semaphore_pend(lock, BIOS_WAIT_FOREVER);\n        Taken": "        Taken",
      "        Semaphore_post(lock);\n        Sem": "        Sem"}, False),
])  # fmt: skip
def test_a_binary_semaphore_beside_one_that_counts_places_is_told(
    tmp_path: Path, changes: dict[str, str], found: bool
) -> None:
    text = RING.replace("used = Semaphore_create(0, NULL, NULL);", BINARY)
    for was, now in changes.items():
        assert text.count(was) == 1
        text = text.replace(was, now)
    assert in_a_ring(tmp_path, text) == [("post-lost", "Semaphore_post(used);", 0)] * found
    if not changes:
        assert in_a_ring(tmp_path, RING) == []


EVENTS = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Event.h>
#define TICK Event_Id_00
#define START Event_Id_01
#define BOTH (TICK | START)
Event_Handle event;
Int Ticks, Starts;
Void machine(UArg a, UArg b)
{
    UInt events, more;
    for (;;) {
        events = Event_pend(event, Event_Id_NONE, BOTH, 100);
        more = 0;
        if (events & TICK) Ticks++;
        if ((START & events) != 0) Starts++;
        Ticks += more;
    }
}
"""
PEND = "Event_Id_NONE, BOTH"


@pytest.mark.parametrize(("changes", "found"), [
    ({}, False), ({PEND: "BOTH, Event_Id_NONE"}, True),
    # One is enough too; one test, of all that have come; a local that something else is given as well.
    ({PEND: "BOTH, START"}, False), ({PEND: "BOTH, Event_Id_NONE", "START & events": "BOTH & events"}, False),
    ({PEND: "BOTH, Event_Id_NONE", "if (events & TICK)": "if (events)"}, False),
    ({PEND: "BOTH, Event_Id_NONE", "more = 0": "events = Ticks"}, False), ({PEND: "TICK, Event_Id_NONE"}, False),
    # Another wait takes any one of the same events; of others; both wait for all.
    ({"events = E": "if (Ticks) events = Event_pend(event, BOTH, Event_Id_NONE, 5); else events = E",
      "if (events & TICK)": "if (events & BOTH)"}, True),
    ({"events = E": "if (Ticks) events = Event_pend(event, 4 | TICK, Event_Id_NONE, 5); else events = E"}, False),
    ({"events = E": "if (Ticks) events = Event_pend(event, BOTH, Event_Id_NONE, 5); else events = E",
      PEND: "BOTH, Event_Id_NONE", "if (events & TICK)": "if (events & BOTH)"}, False),
])  # fmt: skip
def test_events_that_must_all_come_and_are_tested_one_by_one_are_told(
    tmp_path: Path, changes: dict[str, str], found: bool
) -> None:
    text = EVENTS
    for was, now in changes.items():
        assert text.count(was) == 1
        text = text.replace(was, now)
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "drv.c"], calls=0, board=load("bare"), seconds=0.001))
    assert [f.place.line for f in checked.findings if f.rule == "event-mask" and f.place] == [13] * found


#: A task of three sources: two Clocks, and a key.
SOURCES = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Event.h>
#include <ti/sysbios/knl/Task.h>
#define FAST Event_Id_00
#define SLOW Event_Id_01
#define KEY Event_Id_02
Event_Handle event;
Int Fasts, Slows, Keys;
Void fast(UArg a) { Event_post(event, FAST); }
Void slow(UArg a) { Event_post(event, SLOW); }
Void key(UArg a) { if (Slows == 9) Event_post(event, KEY); }
static Void every(Clock_FuncPtr f, UInt ticks)
{
    Clock_Params c;
    Clock_Params_init(&c);
    c.period = ticks;
    c.startFlag = TRUE;
    Clock_create(f, ticks, &c, NULL);
}
Void machine(UArg a, UArg b)
{
    for (;;) {
        UInt events = Event_pend(event, Event_Id_NONE, FAST | SLOW | KEY, BIOS_WAIT_FOREVER);
        if (events & KEY) {
            Keys++;
        }
        if (events & FAST) {
            Fasts++;
        }
        else if (events & SLOW) {
            Slows++;
        }
    }
}
Int main(Void)
{
    Task_Params t;
    event = Event_create(NULL, NULL);
    every(fast, 2);
    every(slow, 10);
    every(key, 7);
    Task_Params_init(&t);
    Task_create(machine, &t, NULL);
    BIOS_start();
    return 0;
}
"""


@pytest.mark.parametrize(("changes", "found"), [
    ({}, True), ({"if (events & FAST)": "if ((events & FAST) == FAST)"}, True),
    ({"every(slow, 10);": "Clock_create(slow, 10, NULL, NULL);"}, True),
    # Both are looked at.
    ({"else if (events & SLOW)": "if (events & SLOW)"}, False),
    # A key that comes now and then may rightly come first, and what is put aside may be posted again.
    ({"if (events & FAST)": "if (events & KEY)", "if (events & KEY)": "if (events & FAST)"}, False),
    ({"Slows == 9) Event_post(event, KEY)": "Slows == 9) Event_post(event, SLOW)"}, False),
    # The bits that were not looked at are kept.
    ({"UInt events =": "static UInt events = 0; events = events |"}, False),
    ({"if (events & FAST)": "if (events & (FAST | KEY))"}, False),
    ({"Fasts++;": "Fasts++; if (events & SLOW) Slows++;"}, False), ({"Fasts++;": "Fasts += events;"}, False),
])  # fmt: skip
def test_a_regular_event_that_another_one_hides_is_told(
    tmp_path: Path, changes: dict[str, str], found: bool
) -> None:
    text = SOURCES
    for was, now in changes.items():
        assert text.count(was) >= 1
        text = text.replace(was, now, 1)
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "drv.c"], calls=0, board=load("bare"), seconds=0.001))
    lines = text.splitlines()
    at = [lines[f.place.line - 1].strip() for f in checked.findings if f.rule == "event-mask" and f.place]
    assert at == ["else if (events & SLOW) {"] * found


#: The Swi runs at each fourth tick: its trigger counts down.
FOURTH = RIGHT.replace("Swi_post(soon);", "Swi_dec(soon);").replace(
    "    soon = Swi_create(beat, NULL, NULL);",
    "    Swi_Params s;\n    Swi_Params_init(&s);\n    s.trigger = 4;\n    soon = Swi_create(beat, &s, NULL);",
)
CREATED = "soon = Swi_create(beat, &s, NULL);"
POSTED = "Void tick(UArg a) { Semaphore_post(ready); Swi_post(soon); }"
SECOND = "Swi_Handle next;\nVoid tick"


@pytest.mark.parametrize(("changes", "at"), [
    ([("Swi_dec", "Swi_post")], [POSTED]),
    ([("Swi_dec", "Swi_post"), ("Done = m;", "Done = m; if (Done == 7) Swi_post(soon);")], [CREATED]),
    ([("Swi_dec(soon)", "Swi_Handle copy = soon; Swi_post(copy)")], [CREATED]),
    # The parameters of the first Swi serve for another one, which nobody wants to wait.
    ([("Swi_dec(soon)", "Swi_post(soon)"), ("Void tick", SECOND), ("Done = m;", "Done = m; Swi_post(next);"),
      (CREATED, CREATED + " next = Swi_create(beat, &s, NULL);")], [POSTED]),
    ([], []),
    ([("Swi_dec(soon)", "Swi_andn(soon, 4)")], []),
    ([("Swi_dec", "Swi_inc")], []),
    ([("Swi_dec(soon)", "Swi_or(soon, 1)")], []),
    ([("Swi_dec", "Swi_post"), ("s.trigger = 4;", "")], []),
    # It tells the function what it is to do.
    ([("Swi_dec", "Swi_post"), ("Beats = Beats + 1;", "Beats += Swi_getTrigger();")], []),
    # A post for once, beside those that count.
    ([("Done = m;", "Done = m; if (Done == 7) Swi_post(soon);")], []),
    ([("Swi_dec(soon);", "if (Done == 7) Swi_dec(soon); else Swi_post(soon);")], []),
    ([("Swi_dec", "Swi_post"), ("Void reader", "Void (*const Down)(Swi_Handle) = Swi_dec;\nVoid reader"),
      ("Done = m;", "Done = m; if (Done == 7) Down(soon);")], []),
    ([("Swi_dec(soon);", "")], []),
])  # fmt: skip
def test_a_trigger_that_nothing_changes_is_told(tmp_path: Path, changes: list[tuple[str, str]], at: list[str]) -> None:
    text = FOURTH
    for was, now in changes:
        assert was in text
        text = text.replace(was, now, 1)
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, board=load("bare"), seconds=0.1))
    lines = text.splitlines()
    found = [f for f in checked.findings if f.rule == "not-connected"]
    assert [lines[f.place.line - 1].strip().split(" next")[0] for f in found if f.place is not None] == at
