"""Waits that only time ends: with a gate held, or for a message that nobody misses."""

from __future__ import annotations

import pytest

from tests.emulator.sysbios.watched import Watched, two_tasks

EVENT = "happened: Event_Handle\n"
MAKE = "happened = Event_create(NULL, NULL)"
HIGH = "key = GateMutexPri_enter(gate)\nGateMutexPri_leave(gate, key)"
ENTER, LEAVE = "key = GateMutexPri_enter(gate)\n", "\nGateMutexPri_leave(gate, key)"


@pytest.mark.parametrize(("low", "told"), [
    (f"{ENTER}Event_pend(happened, 0, 1, 40){LEAVE}", True),
    (f"Event_pend(happened, 0, 1, 40)\n{ENTER}{LEAVE}", False),
    (f"{ENTER}Event_pend(happened, 0, 1, 10){LEAVE}", False),
    (f"{ENTER}Task_sleep(130){LEAVE}", True),
    (f"{ENTER}Task_sleep(60){LEAVE}", False),  # a sonar that measures
    (f"Task_sleep(40)\n{ENTER}{LEAVE}", False),
    # A driver that waits for its interrupt, whether that comes or not.
    (f"{ENTER}Semaphore_pend(semC, 40){LEAVE}", False),
])  # fmt: skip
def test_a_gate_is_held_while_time_passes(low: str, told: bool) -> None:
    specimen = Watched(two_tasks(EVENT, HIGH, low, start=MAKE)).run(180)
    assert specimen.rules() & {"gate-across-wait"} == ({"gate-across-wait"} if told else set())
    if told:
        finding = specimen.one("gate-across-wait")
        assert "pend" in specimen.statement(finding) or "sleep" in specimen.statement(finding)
        assert (finding.object, "High (priority 3)" in finding.message) == ("gate", True)


def test_nobody_stands_at_the_gate() -> None:
    low = f"{ENTER}Event_pend(happened, 0, 1, 40){LEAVE}"
    assert "gate-across-wait" not in Watched(two_tasks(EVENT, "pass", low, start=MAKE)).run(120).rules()


BOX = "box: Mailbox_Handle\nsteered: int16 = 0\n"
FILL = "box = Mailbox_create(sizeof(int16), 4, NULL, NULL)"
SENDS = "if steered < 3:\n    Mailbox_post(box, addressof(n), BIOS_NO_WAIT)"


@pytest.mark.parametrize(("low", "sends", "told"), [
    ("Mailbox_pend(box, addressof(n), 10)\nsteered += 1", SENDS, True),
    ("if Mailbox_pend(box, addressof(n), 10):\n    steered += 1", SENDS, False),
    ("Mailbox_pend(box, addressof(n), BIOS_NO_WAIT)\nsteered += 1", SENDS, False),  # the last one holds until a new one
    ("Mailbox_pend(box, addressof(n), 10)\nsteered += 1", SENDS.replace("steered < 3", "n < 3"), False),
])  # fmt: skip
def test_a_message_that_did_not_come(low: str, sends: str, told: bool) -> None:
    specimen = Watched(two_tasks(BOX, f"n = 1\n{sends}", f"n = 0\n{low}", start=FILL)).run(120)
    assert specimen.rules() & {"timeout-ignored"} == ({"timeout-ignored"} if told else set())
    if told:
        assert specimen.statement(specimen.one("timeout-ignored")) == low.splitlines()[0]
