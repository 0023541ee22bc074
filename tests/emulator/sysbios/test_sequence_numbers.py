"""Numbers of messages, which are no time: a gap is right; an end that is only met by chance is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

#: A message of four is repeated and one of four is lost.
PROGRAM = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Mailbox.h>
#include <ti/sysbios/knl/Task.h>
typedef struct {{ UInt number; UInt value; }} Message;
static Mailbox_Handle box;
static UInt number = 0, turn = 0, last = 4, odd = 0;
{sender}
static Void receiver(UArg a, UArg b)
{{
    Message message;
    for (;;) {{
        Mailbox_pend(box, &message, BIOS_WAIT_FOREVER);
        {test}
    }}
}}
Int main(Void)
{{
    Task_Params params;
    Clock_Params clock;
    box = Mailbox_create(sizeof(Message), 4, NULL, NULL);
    Task_Params_init(&params);
    params.priority = 2;
    Task_create(receiver, &params, NULL);
    {start}
    BIOS_start();
    return 0;
}}
"""
NUMBERED = """
    Message message;
    turn++;
    if (turn % 4)
        number++;
    message.number = number;
    message.value = 3 * turn;
    if (turn % 4 != 1)
        Mailbox_post(box, &message, BIOS_NO_WAIT);
"""
BY_CLOCK = (
    f"static Void send(UArg unused) {{{NUMBERED}}}",
    "Clock_Params_init(&clock); clock.period = 1; clock.startFlag = TRUE; Clock_create(send, 1, &clock, NULL);",
)
BY_TASK = (
    f"static Void sender(UArg a, UArg b) {{ for (;;) {{ Task_sleep(1); {NUMBERED} }} }}",
    "params.priority = 3; Task_create(sender, &params, NULL);",
)
GAP = "if (message.number != (UInt)(last + 1)) odd++; last = message.number;"
EXPECTED = "odd += message.number != last; last = message.number + 1;"
#: `last` is set only when its time has come, and then it is too late.
AWAITED = "if (message.number == last) { odd++; last = message.number + 4; }"


def told(tmp_path: Path, test: str, sender: tuple[str, str]) -> list[str]:
    """The messages of `stamp-compare`."""
    file = tmp_path / "a.c"
    file.write_text(PROGRAM.format(test=test, sender=sender[0], start=sender[1]), encoding="utf-8")
    found = check_files(DriverFiles([file], seconds=0.1, board=load("bare"))).findings
    return [finding.message for finding in found if finding.rule == "stamp-compare"]


@pytest.mark.parametrize("sender", [BY_CLOCK, BY_TASK])
@pytest.mark.parametrize("test", [GAP, EXPECTED])
def test_a_gap_in_a_sequence_is_right(tmp_path: Path, test: str, sender: tuple[str, str]) -> None:
    assert told(tmp_path, test, sender) == []


def test_what_a_task_counts_is_no_time(tmp_path: Path) -> None:
    assert told(tmp_path, AWAITED, BY_TASK) == []


def test_a_time_that_is_only_met_by_chance_is_told(tmp_path: Path) -> None:
    found = told(tmp_path, AWAITED, BY_CLOCK)
    assert ["they were equal 1 counts ago" in message for message in found] == [True]
