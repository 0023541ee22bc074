"""The table of single faults: what each row says is so on the running robot, and the page says the same."""

from __future__ import annotations

import json
import os

import pytest

from hil.cli import invoke
from hil.safety.page import PAGE, page, row_cells
from hil.safety.single_faults import (
    LASTS_S,
    RESET,
    ROWS,
    SEEN,
    MeasuredFault,
    SingleFault,
    mission,
    missions,
    places,
    table,
)

#: Of a run of the tests: every so many rows; `HIL_SAFETY=all` takes all of them, and the missions.
EVERY = 1 if os.environ.get("HIL_SAFETY") == "all" else 7
#: A contact that does not close while nothing touches the robot.
SILENT = "bumper-stuck:state=released"


def of(fault: str) -> MeasuredFault:
    (row,) = (row for row in ROWS if row.fault == fault)
    return next(table([row]))


@pytest.mark.slow
def test_a_row_is_noticed_or_says_why_nothing_can_and_the_page_says_so() -> None:
    text = PAGE.read_text(encoding="utf-8")
    wanted = ROWS[::EVERY]
    told = list(table(wanted))
    assert [one.row for one in told] == list(wanted)
    for one in told:
        holds(one.row, one)
        assert f"| {' | '.join(row_cells(one))} |" in text, "python -m hil.safety.page"
    if EVERY == 1:
        assert text == page(told, missions()), "python -m hil.safety.page"


def holds(row: SingleFault, one: MeasuredFault) -> None:
    assert bool(one.fired) is (row.fault != SILENT)
    assert bool(one.noticed) is not bool(row.blind), one
    assert not one.collisions
    if one.noticed:
        # What it knows to be wrong it does not drive on: it brakes within 0.3 s of having noticed; after a reset
        # nothing brakes, and the wheels roll for 0.6 s.
        assert one.noticed_ms is not None
        assert one.does_ms is not None
        assert one.does_ms <= max(one.noticed_ms + (600 if one.noticed == SEEN[RESET] else 300), 500)
        assert one.does.startswith(("stops", "slows"))
    if one.does.startswith("stops"):
        assert one.goes_on, "nothing that is over keeps the robot from driving when it is told to"
        assert one.goes_on != "stands"


def test_the_link_is_silent_after_2_5_s() -> None:
    # 50 periods of TaskNAVIGATION, 50 ms each, from the last order: up to 100 ms before the fault.
    one = of("serial-break")
    assert one.noticed == "link silent"
    assert one.noticed_ms is not None
    assert 2400 <= one.noticed_ms <= 2600
    assert one.noticed_ms / 1000 < LASTS_S
    assert one.goes_on == "drives on"


def test_a_gyro_that_was_reset_is_set_up_again() -> None:
    # TaskGYRO asks every 5 ms, TaskNAVIGATION tells every 50 ms; 300 ms to turn on, and some 50 ms to get its speed.
    one = of("gyro-reset:for=0.01")
    assert (one.noticed, one.does, one.goes_on) == ("gyro silent", "stops", "drives on")
    assert one.noticed_ms is not None
    assert one.goes_on_ms is not None
    assert one.noticed_ms <= 60
    assert 300 <= one.goes_on_ms <= 450


def test_a_wheel_that_is_blocked_stays_wrong_until_it_is_told_to_stand() -> None:
    # 16 periods of TaskSERVO, 25 ms each, and one of TaskNAVIGATION.
    one = of("wheel-blocked:side=left")
    assert (one.noticed, one.goes_on) == ("a wheel does not follow", "drives when told to stand and to drive")
    assert one.noticed_ms is not None
    assert 400 <= one.noticed_ms <= 525


def test_a_mission_before_a_wall() -> None:
    # Square to it the mission slows at some 60 cm; at 45 degrees the front sonar loses it, and the robot meets it.
    worlds = places()
    square, slanted = (mission(name, worlds[name]) for name in ("wall at 0 degrees", "wall at 45 degrees"))
    assert not square.touched
    assert square.goes_on_m > 0.5
    assert slanted.touched


def test_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["faults", "gyro-miso-stuck", "--table", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["faults"]
    assert [row["fault"] for row in rows] == ["gyro-miso-stuck:level=1", "gyro-miso-stuck:level=0"]
    assert all(row["noticed"] == "gyro silent" for row in rows)
    assert invoke(["faults", "radio-loss", "--table"]) == 0
    assert "link silent" in " ".join(capsys.readouterr().out.split())
