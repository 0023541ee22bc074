"""Rules of SYS/BIOS events (knl/Event.c 6.83), from Python and in C."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.sysbios.core import KernelError
from tests.emulator.sysbios.bench import FOREVER, Bench
from tests.emulator.sysbios.c_program import CProgram, seen


@pytest.mark.parametrize(
    ("posted", "and_mask", "or_mask", "got", "left"),
    [
        (0b0111, 0b0011, 0, 0b0011, 0b0100),  # all of the and mask: consumed, the rest stays
        (0b0101, 0b0011, 0, 0, 0b0101),  # one of them is missing: nothing is consumed
        (0b0101, 0, 0b0110, 0b0100, 0b0001),  # any of the or mask
        (0b1101, 0b0011, 0b1100, 0b1100, 0b0001),  # the or mask alone matches: the and mask consumes nothing
        (0b1111, 0b0011, 0b0100, 0b0111, 0b1000),  # both match, both are consumed
        (0x8000, 0, 0x8000, 0x8000, 0),  # Event_Id_15, the highest of a 16-bit UInt
    ],
)
def test_a_pend_consumes_what_matched(posted: int, and_mask: int, or_mask: int, got: int, left: int) -> None:
    k = Bench().kernel
    event = k.Event_create(None, None)
    k.Event_post(event, posted)
    assert (k.Event_pend(event, and_mask, or_mask, 0), k.Event_getPostedEvents(event)) == (got, left)


def test_a_sync_sets_and_clears_and_wakes_nobody() -> None:
    b = Bench()
    k = b.kernel
    event = k.Event_create(None, None)
    b.boot(lambda: b.task(lambda: b.note(k.Event_pend(event, 0, 3, 4)), 1), lambda: b.timer(lambda: sync(3), 2))

    def sync(count: int) -> None:
        k.Event_sync(event, 1, count)

    b.run_ticks(6)
    # The bit came at tick 2 without waking: the pend ended by its timeout, which does not look at the bits again.
    assert b.log == [0]
    assert k.Event_getPostedEvents(event) == 1
    sync(0)
    assert k.Event_getPostedEvents(event) == 0


def test_posts_that_do_not_complete_the_mask_leave_the_task_waiting() -> None:
    b = Bench()
    k = b.kernel
    event = k.Event_create(None, None)
    b.boot(
        lambda: b.task(lambda: b.note((k.Event_pend(event, 3, 0, FOREVER), k.Clock_getTicks())), 1),
        lambda: b.timer(lambda: k.Event_post(event, 1), 2),
        lambda: b.timer(lambda: k.Event_post(event, 2), 5),
    )
    b.run_ticks(4)
    assert (b.log, k.Event_getPostedEvents(event)) == ([], 1)
    b.run_ticks(6)
    assert (b.log, k.Event_getPostedEvents(event)) == ([(3, 5)], 0)


@pytest.mark.parametrize(("timeout", "ticks"), [(1, 1), (3, 3)])
def test_a_timeout_gives_0_after_its_ticks(timeout: int, ticks: int) -> None:
    b = Bench()
    k = b.kernel
    event = k.Event_create(None, None)
    b.boot(lambda: b.task(lambda: b.note((k.Event_pend(event, 0, 1, timeout), k.Clock_getTicks())), 1))
    b.run_ticks(10)
    assert b.log == [(0, ticks)]


def test_a_higher_task_runs_within_the_post() -> None:
    b = Bench()
    k = b.kernel
    event = k.Event_create(None, None)
    b.boot(
        lambda: b.task(lambda: b.note(k.Event_pend(event, 0, 1, FOREVER)), 5),
        lambda: b.task(lambda: (k.Event_post(event, 1), b.note("posted")), 2),
    )
    b.run_ticks(1)
    assert b.log == [1, "posted"]


@pytest.mark.parametrize(
    ("identifier", "wrong"),
    [
        ("Event_A_nullEventMasks", lambda k, event: k.Event_pend(event, 0, 0, 0)),
        ("Event_A_nullEventId", lambda k, event: k.Event_post(event, 0)),
        ("Event_A_badContext", lambda k, event: k.Event_pend(event, 0, 1, 1)),  # main cannot wait
    ],
)
def test_assertions_in_main(identifier: str, wrong: Any) -> None:
    k = Bench().kernel
    with pytest.raises(KernelError, match=identifier):
        wrong(k, k.Event_create(None, None))


def test_only_one_task_can_wait() -> None:
    b = Bench()
    k = b.kernel
    event = k.Event_create(None, None)
    b.boot(*(lambda: b.task(lambda: k.Event_pend(event, 0, 1, FOREVER), 1) for _ in range(2)))
    with pytest.raises(KernelError, match="Event_A_eventInUse"):
        b.run_ticks(1)


def test_a_pend_with_the_scheduler_disabled_asserts_only_if_it_would_wait() -> None:
    b = Bench()
    k = b.kernel
    event = k.Event_create(None, None)
    k.Event_post(event, 1)

    def body() -> None:
        k.Task_disable()
        b.note(k.Event_pend(event, 0, 1, FOREVER))
        k.Event_pend(event, 0, 1, FOREVER)

    b.boot(lambda: b.task(body, 1))
    with pytest.raises(KernelError, match="Event_A_pendTaskDisabled"):
        b.run_ticks(1)
    assert b.log == [1]


# In C, with semaphores that keep a bit up to date


def test_an_event_of_semaphores_follows_their_counts() -> None:
    # Semaphore.c: a post of one that nobody waits for posts the bit, a pend sets it as the count then says; the bits
    # that Event_pend consumed come back with a pend that leaves a count.
    assert seen("""
Event_Handle event;
Semaphore_Handle full, spare;
void work(UArg a, UArg b)
{
    note(Event_pend(event, Event_Id_NONE, Event_Id_00 | Event_Id_03, BIOS_WAIT_FOREVER));
    note(Event_getPostedEvents(event));
    Semaphore_pend(full, BIOS_NO_WAIT);
    note(Event_getPostedEvents(event));
    Semaphore_pend(full, BIOS_NO_WAIT);
    note(Event_getPostedEvents(event));
    note(Event_pend(event, Event_Id_00, Event_Id_NONE, 2));
    Semaphore_reset(full, 7);
    note(Event_getPostedEvents(event));
}
void release(UArg a) { Semaphore_post(full); Semaphore_post(full); }
int main(void)
{
    Semaphore_Params params;
    event = Event_create(NULL, NULL);
    Semaphore_Params_init(&params);
    params.event = event;
    params.eventId = Event_Id_00;
    full = Semaphore_create(0, &params, NULL);
    params.eventId = Event_Id_03;
    spare = Semaphore_create(1, &params, NULL);
    note(Event_getPostedEvents(event));
    Semaphore_registerEvent(spare, NULL, Event_Id_03);
    Semaphore_pend(spare, BIOS_NO_WAIT);
    note(Event_getPostedEvents(event));
    Event_sync(event, Event_Id_03, 0);
    task(work, 3);
    once(release, 4);
    BIOS_start();
    return 0;
}
""") == [8, 8, 1, 1, 1, 0, 0, 1]
    # 8: spare begins with 1; 8: it is no longer tied.  1: two posts, the first of which woke the task within the Swi;
    # the second posted the bit anew before the task ran, hence 1; a pend leaves 1 (count 1), then 0; the wait for bit 0
    # ends by its timeout; a reset to 7 sets it.


def test_a_copy_of_events_between_tasks_is_no_race() -> None:
    # The post orders what was written before it ahead of what the task reads behind its pend.
    assert seen("""
Event_Handle event;
long value = 0;
void high(UArg a, UArg b)
{
    while (1) { Task_sleep(3); value = value + 1; Event_post(event, Event_Id_02); Task_sleep(3); }
}
void low(UArg a, UArg b)
{
    while (count < 4) { Event_pend(event, Event_Id_02, Event_Id_NONE, BIOS_WAIT_FOREVER); note((int)value); }
}
int main(void) { event = Event_create(NULL, NULL); task(high, 4); task(low, 2); BIOS_start(); return 0; }
""", 40) == [1, 2, 3, 4]


def test_a_swi_that_waits_for_an_event_is_told_so_and_ends() -> None:
    program = CProgram("""
Event_Handle event;
void tick(UArg a) { Event_pend(event, Event_Id_01, 0, 3); }
int main(void) { event = Event_create(NULL, NULL); once(tick, 2); BIOS_start(); return 0; }
""").run(5)
    assert ("blocking-in-interrupt", "void tick(UArg a) { Event_pend(event, Event_Id_01, 0, 3); }") in program.rules()
    assert program.stopped == "Event_A_badContext"
