"""Branches for the end of a wait that has none: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include <xdc/std.h>
#include <xdc/runtime/System.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Event.h>
#include <ti/sysbios/knl/Mailbox.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Task.h>
#define ORDER_WAIT BIOS_WAIT_FOREVER
typedef struct { Int16 speed, turn; } Order;
static Mailbox_Handle box;
static Semaphore_Handle ready;
static Event_Handle event;
static UInt errors = 0, wait = BIOS_WAIT_FOREVER;
static Bool lastError = FALSE;
static volatile Int16 speed = 0;
static Void Stop(Void) { speed = 0; }
static Void Work(UArg a, UArg b)
{
    Order order = { 0, 0 };
    for (;;) {
        BODY
        speed = order.speed;
        Mailbox_post(box, &order, BIOS_NO_WAIT);
        Semaphore_post(ready);
        Event_post(event, Event_Id_00);
    }
}
Int main(Void)
{
    box = Mailbox_create(sizeof(Order), 4, NULL, NULL);
    ready = Semaphore_create(1, NULL, NULL);
    event = Event_create(NULL, NULL);
    Task_create(Work, NULL, NULL);
    if (lastError) { Stop(); wait++; }
    BIOS_start();
    return 0;
}
"""
PEND = "Mailbox_pend(box, &order, BIOS_WAIT_FOREVER)"
TAKE = "Semaphore_pend(ready, BIOS_WAIT_FOREVER)"
EVENT = "Event_pend(event, Event_Id_NONE, Event_Id_00, BIOS_WAIT_FOREVER)"
ZERO = "order.speed = 0;"


@pytest.mark.parametrize(("body", "told"), [
    (f"if (!{PEND}) {{ order.speed = 0; order.turn = 0; }}", True),
    (f"if ({PEND} == FALSE) {{ {ZERO} }}", True),
    (f"if ({PEND} != TRUE) {{ {ZERO} }}", True),
    (f"if ({PEND}) {{ order.turn++; }} else {{ {ZERO} }}", True),
    (f"if (!{TAKE}) {ZERO}", True),
    (f"if ({EVENT} == 0) {ZERO}", True),
    # Caution: the branch leaves, ends the program, prints, or notes an error.
    (f"if (!{PEND}) {{ {ZERO} continue; }}", False),
    (f"if (!{PEND}) {{ {ZERO} return; }}", False),
    (f"if (!{PEND}) break;", False),
    (f"if (!{PEND}) {{ {ZERO} goto out; }} speed++; out:", False),
    (f"if (!{PEND}) System_abort(\"box\");", False),
    (f"if (!{PEND}) {{ {ZERO} System_printf(\"box\"); }}", False),
    (f"if (!{TAKE}) {{ {ZERO} while (1); }}", False),
    (f"if (!{TAKE}) {{ errors++; }}", False),
    (f"if (!{TAKE}) {{ lastError = TRUE; }}", False),
    (f"if (!{TAKE}) Stop();", False),
    (f"if (!{TAKE}) {{ }}", False),
    # It has come; a time that ends, or may end; the result is kept.
    (f"if ({PEND}) {{ {ZERO} }}", False),
    (f"if ({EVENT} == 1) {{ {ZERO} }}", False),
    (f"if ({EVENT} != 1) {{ {ZERO} }}", False),
    (f"if (!({EVENT} & Event_Id_01)) {{ {ZERO} }}", False),
    (f"while ({PEND}) {{ {ZERO} }}", False),
    (f"if (!{PEND.replace('BIOS_WAIT_FOREVER', '50')}) {{ {ZERO} }}", False),
    (f"if (!{PEND.replace('BIOS_WAIT_FOREVER', 'BIOS_NO_WAIT')}) {{ {ZERO} }}", False),
    (f"if (!{PEND.replace('BIOS_WAIT_FOREVER', 'wait')}) {{ {ZERO} }}", False),
    (f"if (!{PEND.replace('BIOS_WAIT_FOREVER', 'ORDER_WAIT')}) {{ {ZERO} }}", False),
    (f"order.turn = {PEND}; if (!order.turn) {{ {ZERO} }}", False),
])  # fmt: skip
def test_a_branch_for_the_end_of_a_wait_that_has_none(tmp_path: Path, body: str, told: bool) -> None:
    """It is told at the wait, with what the branch sets."""
    file = tmp_path / "work.c"
    file.write_text(PROGRAM.replace("BODY", body), encoding="utf-8")
    found = [f for f in Build([str(file)]).compiled.findings if f.rule == "constant-condition"]
    assert [f.object for f in found] == (["order.speed"] if told else [])
