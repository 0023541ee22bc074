"""Mailboxes whose messages are too small for their structure, and right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import CWorkshop

KERNEL = ("Mailbox_create", "Mailbox_post", "Mailbox_pend")
HEAD = """typedef struct BOX *Box;
typedef struct { int kind, cell, value; } EVENT;
extern Box Mailbox_create(int size, int messages, void *params, void *error);
extern int Mailbox_post(Box box, void *message, int wait), Mailbox_pend(Box box, void *message, int wait);
static struct { int spare; Box events; } Kept;
static Box Other;
int Post(int cell) { EVENT e; e.kind = 1; e.cell = cell; e.value = 3; return Mailbox_post(Kept.events, &e, 0); }
"""


def told(take: str, create: str) -> bool:
    """Whether the statement that creates a mailbox is told that it cuts messages."""
    text = f"{HEAD}{take}\nvoid Make(void)\n{{\n{create}\n}}\n"
    shop = CWorkshop(text, static=True, externs=dict.fromkeys(KERNEL, int))
    lines = [finding.place.line for finding in shop.findings if finding.rule == "message-cut" and finding.place]
    assert set(lines) <= {HEAD.count("\n") + 4}
    return bool(lines)


TAKE = "int Take(void) { EVENT e; return Mailbox_pend(Kept.events, &e, 9) ? e.value : 0; }"
BY_POINTER = "int Take(EVENT *e) { return Mailbox_pend(Kept.events, e, 9) ? e->value : 0; }"


@pytest.mark.parametrize(
    ("take", "create"),
    [
        (TAKE, "Kept.events = Mailbox_create(sizeof(EVENT *), 8, 0, 0);"),
        (BY_POINTER, "Kept.events = Mailbox_create(1, 8, 0, 0);"),
    ],
)
def test_a_message_that_lacks_a_member_is_told(take: str, create: str) -> None:
    assert told(take, create)


@pytest.mark.parametrize(
    ("take", "create"),
    [
        (TAKE, "Kept.events = Mailbox_create(sizeof(EVENT), 8, 0, 0);"),
        # Nothing reads what does not arrive.
        (TAKE.replace("e.value", "e.cell"), "Kept.events = Mailbox_create(sizeof(EVENT *), 8, 0, 0);"),
        # The address of an event goes to another box.
        (
            "int Take(EVENT *e) { Mailbox_post(Other, &e, 0); return Mailbox_pend(Other, &e, 9) ? e->value : 0; }",
            "Other = Mailbox_create(sizeof(EVENT *), 8, 0, 0);",
        ),
        # The other side takes something else.
        (TAKE.replace("EVENT e", "struct { EVENT *p; int value; } e"), "Kept.events = Mailbox_create(2, 8, 0, 0);"),
        (TAKE, "Kept.events = Mailbox_create(2, 8, 0, 0); Kept.events = Other;"),
    ],
)
def test_messages_that_arrive_whole_are_silent(take: str, create: str) -> None:
    assert not told(take, create)
