"""Rules of SYS/BIOS queues (knl/Queue.c 6.83), as C uses them."""

from __future__ import annotations

import pytest

from tests.emulator.sysbios.c_program import CProgram, seen

RECORDS = """
typedef struct Record { Queue_Elem elem; int number; } Record;
Record records[5];
Queue_Handle queue;
void walk(void)
{
    Queue_Elem *e;
    for (e = Queue_head(queue); e != (Queue_Elem *)queue; e = Queue_next(e)) note(((Record *)e)->number);
}
int begin(void)
{
    int i;
    queue = Queue_create(NULL, NULL);
    for (i = 0; i < 5; i++) { records[i].number = i; Queue_elemClear(&records[i].elem); }
    return 0;
}
"""


def run(body: str) -> list[int]:
    """What a body notes that runs behind `begin`."""
    return seen(RECORDS + f"int main(void) {{ Record *r; begin(); {body} return 0; }}")


PUT = "for (int i = 0; i < 3; i++) Queue_put(queue, &records[i].elem);"


@pytest.mark.parametrize(
    ("body", "noted"),
    [
        (PUT + "walk();", [0, 1, 2]),
        (PUT + "while (!Queue_empty(queue)) { r = Queue_get(queue); note(r->number); }", [0, 1, 2]),
        (PUT + "while (!Queue_empty(queue)) { r = Queue_getTail(queue); note(r->number); }", [2, 1, 0]),
        (PUT + "Queue_putHead(queue, &records[4].elem); walk();", [4, 0, 1, 2]),
        (PUT + "Queue_insert(&records[2].elem, (Queue_Elem *)&records[3]); walk();", [0, 1, 3, 2]),
        (PUT + "Queue_remove(&records[1].elem); walk();", [0, 2]),
        (PUT + "r = Queue_prev((Queue_Elem *)queue); note(r->number);", [2]),
        ("Queue_enqueue(queue, &records[3].elem); r = Queue_dequeue(queue); note(r->number);", [3]),
        ("note(Queue_isQueued(&records[0].elem));" + PUT + "note(Queue_isQueued(&records[0].elem));", [0, 1]),
        # An empty queue gives itself: what a loop without Queue_empty compares with.
        ("note(Queue_get(queue) == queue); note(Queue_head(queue) == (Ptr)queue);", [1, 1]),
        # An element that is put a second time takes its links along: what stood behind it is lost (Queue_enqueue).
        (PUT + "Queue_put(queue, &records[0].elem); Queue_get(queue); note(Queue_empty(queue));", [1]),
    ],
)  # fmt: skip
def test_what_stands_in_a_queue(body: str, noted: list[int]) -> None:
    assert run(body) == noted


def test_records_that_a_handler_fills_reach_the_task_without_a_race() -> None:
    assert seen(RECORDS + """
Semaphore_Handle full;
int next = 0;
void fill(UArg a)
{
    records[next].number = 10 + next;
    Queue_put(queue, &records[next].elem);
    next = next + 1;
    Semaphore_post(full);
}
void work(UArg a, UArg b)
{
    Record *r;
    while (1) { Semaphore_pend(full, BIOS_WAIT_FOREVER); r = Queue_get(queue); note(r->number); }
}
int main(void)
{
    begin();
    full = Semaphore_create(0, NULL, NULL);
    task(work, 2);
    once(fill, 2);
    once(fill, 4);
    BIOS_start();
    return 0;
}
""") == [10, 11]


def test_no_element_and_one_that_was_never_put_are_findings() -> None:
    program = CProgram(RECORDS + """
int main(void)
{
    Record fresh;
    begin();
    Queue_put(queue, NULL);
    Queue_remove(&fresh.elem);
    return 0;
}
""").run()
    assert program.rules()[0] == ("null-dereference", "Queue_put(queue, NULL);")
    assert ("uninitialised", "Queue_remove(&fresh.elem);") in program.rules()
