"""Rules of SYS/BIOS mailboxes (knl/Mailbox.c 6.83), as C uses them."""

from __future__ import annotations

import pytest

from tests.emulator.sysbios.c_program import CProgram, seen

MESSAGE = """
typedef struct { int code; float value; Semaphore_Handle done; int *place; char text[3]; } Message;
Mailbox_Handle box;
int target = 0;
"""


def test_messages_are_copied_with_what_they_point_to_and_keep_their_order() -> None:
    # A handle and a pointer in a message are those of the sender; the sender's own copy may change at once.
    assert seen(MESSAGE + """
Semaphore_Handle done;
void reader(UArg a, UArg b)
{
    Message m;
    while (Mailbox_pend(box, &m, 10)) {
        note(m.code);
        *m.place = (int)m.value;
        note(m.text[2]);
        Semaphore_post(m.done);
    }
    note(target);
    note(Semaphore_getCount(done));
}
void writer(UArg a, UArg b)
{
    Message m;
    int i;
    m.done = done;
    m.place = &target;
    for (i = 0; i < 3; i++) {
        m.code = 10 + i;
        m.value = 2.5f * i;
        m.text[2] = 'a' + i;
        Mailbox_post(box, &m, BIOS_WAIT_FOREVER);
        m.code = -1;
    }
}
int main(void)
{
    done = Semaphore_create(0, NULL, NULL);
    box = Mailbox_create(sizeof(Message), 2, NULL, NULL);
    note((int)Mailbox_getMsgSize(box));
    task(writer, 4);
    task(reader, 2);
    BIOS_start();
    return 0;
}
""") == [12, 10, 97, 11, 98, 12, 99, 5, 3]
    # 12 words: int and padding 2, float 2, two pointers 4, three char and padding 4.  Value of the last: 2.5 * 2.


def test_a_full_box_holds_the_writer_and_an_empty_one_the_reader() -> None:
    assert seen(MESSAGE + """
void writer(UArg a, UArg b)
{
    int i;
    for (i = 0; i < 5; i++) { note(Mailbox_post(box, &i, 3)); note(Mailbox_getNumFreeMsgs(box)); }
}
void reader(UArg a, UArg b)
{
    int m;
    Task_sleep(8);
    note(100 + Mailbox_getNumPendingMsgs(box));
    while (Mailbox_pend(box, &m, 2)) note(10 * m);
    note((int)Clock_getTicks());
}
int main(void)
{
    box = Mailbox_create(1, 2, NULL, NULL);
    task(writer, 4);
    task(reader, 2);
    BIOS_start();
    return 0;
}
""", watch=False) == [1, 1, 1, 0, 0, 0, 0, 0, 102, 1, 0, 0, 10, 40, 10]
    # Two messages fit; the third gives up at tick 3, the fourth at tick 6 (0, 0 each); the fifth gets its place at
    # tick 8 within the reader's first pend, which then gives 0, 10 and 40, and ends at tick 10.


def test_the_reader_frees_a_place_for_the_writer_that_waits() -> None:
    # Ticks: the writer fills two places at once, waits for the third from 0 on; the reader takes one at tick 2, and the
    # writer, which is higher, runs within that pend.
    assert seen(MESSAGE + """
void writer(UArg a, UArg b)
{
    int i;
    for (i = 1; i < 4; i++) { note(Mailbox_post(box, &i, BIOS_WAIT_FOREVER)); note((int)Clock_getTicks()); }
}
void reader(UArg a, UArg b)
{
    int m;
    Task_sleep(2);
    Mailbox_pend(box, &m, BIOS_NO_WAIT);
    note(100 + m);
}
int main(void)
{
    box = Mailbox_create(1, 2, NULL, NULL);
    task(writer, 4);
    task(reader, 2);
    BIOS_start();
    return 0;
}
""") == [1, 0, 1, 0, 1, 2, 101]


def test_events_of_reader_and_writer_say_what_can_be_had() -> None:
    # A new box has places and no message: the writer's bit is posted at once, the reader's is not.
    assert seen(MESSAGE + """
Event_Handle event;
int main(void)
{
    Mailbox_Params params;
    int m = 7;
    event = Event_create(NULL, NULL);
    Mailbox_Params_init(&params);
    params.readerEvent = event;
    params.readerEventId = Event_Id_04;
    params.writerEvent = event;
    params.writerEventId = Event_Id_09;
    box = Mailbox_create(1, 1, &params, NULL);
    note(Event_getPostedEvents(event));
    Mailbox_post(box, &m, BIOS_NO_WAIT);
    note(Event_getPostedEvents(event));
    note(Mailbox_post(box, &m, BIOS_NO_WAIT));
    m = 0;
    Mailbox_pend(box, &m, BIOS_NO_WAIT);
    note(m);
    note(Event_getPostedEvents(event));
    return 0;
}
""") == [0x200, 0x10, 0, 7, 0x200]


def test_a_message_larger_than_its_object_and_none_at_all_are_findings() -> None:
    program = CProgram(MESSAGE + """
int single = 0;
int main(void)
{
    box = Mailbox_create(3, 2, NULL, NULL);
    Mailbox_post(box, &single, BIOS_NO_WAIT);
    Mailbox_post(box, NULL, BIOS_NO_WAIT);
    return 0;
}
""").run()
    assert program.rules() == [
        ("memcpy-outside", "Mailbox_post(box, &single, BIOS_NO_WAIT);"),
        ("null-dereference", "Mailbox_post(box, NULL, BIOS_NO_WAIT);"),
    ]


@pytest.mark.parametrize(("size", "sent", "rules"), [
    ("sizeof(TRIPLE)", 7, []),
    ("1", 7, [("message-cut", "box = Mailbox_create(1, 2, NULL, NULL);")]),
    # Nobody sends the rest.
    ("1", 0, []),
])  # fmt: skip
def test_a_message_that_is_smaller_than_its_structure_is_told(
    size: str, sent: int, rules: list[tuple[str, str]]
) -> None:
    program = CProgram(MESSAGE + """
typedef struct { int first, second, third; } TRIPLE;
int main(void)
{
    TRIPLE out, in;
    int n;
    box = Mailbox_create(SIZE, 2, NULL, NULL);
    for (n = 1; n <= 3; n++) {
        out.first = n;
        out.second = out.third = SENT * n;
        in.second = in.third = 0;
        Mailbox_post(box, &out, BIOS_NO_WAIT);
        Mailbox_pend(box, &in, BIOS_NO_WAIT);
    }
    return in.first;
}
""".replace("SIZE", size).replace("SENT", str(sent))).run()
    assert program.rules() == rules


def test_a_buffer_that_is_too_small_asserts() -> None:
    # Mailbox_MbxElem is two pointers, 4 words: two messages of 3 take 14.
    text = MESSAGE + """
int buffer[14];
int main(void)
{
    Mailbox_Params params;
    Mailbox_Params_init(&params);
    params.buf = buffer;
    params.bufSize = SIZE;
    box = Mailbox_create(3, 2, &params, NULL);
    return 0;
}
"""
    assert CProgram(text.replace("SIZE", "14")).run().stopped == ""
    assert CProgram(text.replace("SIZE", "13")).run().stopped == "Mailbox_A_invalidBufSize"
