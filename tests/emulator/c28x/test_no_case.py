"""`no-case`: values that no case of a switch over an enumeration takes, and switches that mean to leave some out."""

from __future__ import annotations

from typing import Final

import pytest

from tests.emulator.c28x.specimens import Pair
from tests.emulator.c28x.test_specimens import marked_line, run
from tests.emulator.c28x.workshop import Workshop

_MODES: Final = """
class MODE(enum):
    OFF = 0
    SLOW = 1
    FAST = 2
"""

PAIRS: Final = (
    Pair(
        "no-case",
        "a mode that is none",
        (("Speed", (7,)),),
        _MODES
        + """def Speed(turn: int16) -> int16:
    speed: int16 = 0
    match turn % 4:  # <-
        case MODE.OFF:
            speed = 0
        case MODE.SLOW:
            speed = 100
        case MODE.FAST:
            speed = 400
    return speed
""",
        _MODES
        + """def Speed(turn: int16) -> int16:
    speed: int16 = 0
    match turn % 3:
        case MODE.OFF:
            speed = 0
        case MODE.SLOW:
            speed = 100
        case MODE.FAST:
            speed = 400
    return speed
""",
    ),
    Pair(
        "no-case",
        "a constant that was forgotten",
        (("Speed", (2,)),),
        _MODES
        + """def Speed(mode: int16) -> int16:
    speed: int16 = 0
    match mode:  # <-
        case MODE.OFF:
            speed = 0
        case MODE.SLOW:
            speed = 100
    return speed
""",
        _MODES
        + """def Speed(mode: int16) -> int16:
    speed: int16 = 0
    match mode:
        case MODE.SLOW:
            speed = 100
        case MODE.OFF:
            speed = 50
    return speed
""",
    ),
    Pair(
        "no-case",
        "a mode that is none, where a case falls through",
        (("Turns", (3,)),),
        _MODES
        + """def Turns(mode: int16) -> int16:
    turns: int16 = 0
    match mode:  # <-
        case MODE.OFF:
            turns = 3
            fallthrough()
        case MODE.SLOW | MODE.FAST:
            turns += 1
    return turns
""",
        _MODES
        + """def Turns(mode: int16) -> int16:
    turns: int16 = 0
    match mode:
        case MODE.OFF:
            turns = 3
            fallthrough()
        case MODE.SLOW | MODE.FAST:
            turns += 1
        case _:
            turns = -1
    return turns
""",
    ),
)


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.id)
def test_a_value_without_a_case_is_told_at_the_switch_and_the_correct_twin_is_silent(pair: Pair) -> None:
    found = [(f.rule, f.place.line if f.place else 0) for f in run(pair, pair.defect, static=True)[0].findings]
    assert found == [("no-case", marked_line(pair.defect))]
    assert [f.message for f in run(pair, pair.correct, static=True, watch=True)[0].findings] == []


@pytest.mark.parametrize(("mode", "told"), [(0, []), (5, []), (2, ["no-case"]), (6, ["no-case"]), (-1, [])])
def test_a_value_between_the_constants_is_none_of_them(mode: int, told: list[str]) -> None:
    source = """
class MODE(enum):
    STOP = 0
    GO = 5
def Speed(mode: int16) -> int16:
    speed: int16 = 0
    match mode:
        case MODE.STOP:
            speed = 1
        case MODE.GO:
            speed = 2
    return speed
"""
    shop, _ = run(Pair("", "", (("Speed", (mode,)),), "", ""), source)
    assert [f.rule for f in shop.findings] == told


@pytest.mark.parametrize(("last", "mode", "told"), [
    ("MODES_COUNT", 4, ["no-case"]), ("MODES_COUNT", 3, ["no-case"]), ("MODES_COUNT", 2, []), ("BROKEN", 4, []),
    ("MODES_COUNT", 255, []),
])  # fmt: skip
def test_a_last_constant_that_counts_the_others_needs_no_case(last: str, mode: int, told: list[str]) -> None:
    source = PAIRS[0].correct.replace("FAST = 2", f"FAST = 2\n    {last} = 3").replace("turn % 3", "turn")
    shop, _ = run(Pair("", "", (("Speed", (mode,)),), "", ""), source)
    assert [f.rule for f in shop.findings] == told


@pytest.mark.parametrize("value", [-1, 255])
def test_a_number_that_says_none_is_not_told(value: int) -> None:
    calls = (("Speed", (value,)),)
    (complete,) = (pair.correct for pair in PAIRS[:1])
    shop, results = run(Pair("", "", calls, "", ""), complete.replace("turn % 3", "turn"))
    assert results == [0]
    assert [f.message for f in shop.findings] == []


_LOCK: Final = """
class KEY(enum):
    UP = 0
    DOWN = 1
    HELD = 2
    LET_GO = 3
class LOCK(enum):
    CLOSED = 0
    OPENING = 1
    OPEN = 2
class PARTS(enum):
    LEFT = 1
    RIGHT = 2
    TOP = 8
Lock: LOCK = LOCK.CLOSED
Key: KEY = KEY.UP
Parts: PARTS = PARTS.LEFT
def Turn() -> void:
    Lock = LOCK.OPENING
    Key = KEY.LET_GO
    Parts = PARTS.LEFT | PARTS.RIGHT | PARTS.TOP
    Lock = 0xFF
"""


@pytest.mark.parametrize(("was", "now", "what"), [
    ("", "", ""),
    ("Lock = LOCK.OPENING", "Lock = KEY.LET_GO", "Lock is set to 3, no constant of its enumeration (0 to 2)"),
    ("Key = KEY.LET_GO", "Key = 4", "Key is set to 4, no constant of its enumeration (0 to 3)"),
])  # fmt: skip
def test_a_constant_above_those_of_the_objects_enumeration_is_told_unrun(was: str, now: str, what: str) -> None:
    findings = [f for f in Workshop(_LOCK.replace(was, now), static=True).findings if f.rule == "no-case"]
    assert [f.message for f in findings] == [what] * bool(what)
    assert all(f.place is not None and f.place.function == "Turn" for f in findings)
