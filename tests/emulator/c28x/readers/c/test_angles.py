"""Differences of headings that are not brought back into one turn: wrong programs, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import CWorkshop

PROGRAM = """#include <math.h>
float read(void);
void drive(float turn);
static float heading = 0.0f, wanted = 0.0f, yaw = 0.0f, last = 0.0f;
static float wrap(float degrees)
{{
    if (degrees > 180.0f) return degrees - 360.0f;
    if (degrees < -180.0f) return degrees + 360.0f;
    return degrees;
}}
static float limit(float value) {{ return value > 0.3f ? 0.3f : value; }}
static void Order(void) {{ {order} }}
static void Step(void)
{{
    float error, turn;
    heading = wrap(heading + read() * 0.01f);
    {step}
}}
int main(void) {{ for (;;) {{ Order(); Step(); }} }}
"""
WANTED = "wanted = read();"
ERROR = "error = wanted - heading; "
USE = "turn = 0.02f * error; drive(limit(turn));"


def told(step: str, order: str = WANTED, **other: str) -> list[str]:
    """The differences that are told of."""
    text = PROGRAM.format(step=step, order=order)
    for old, new in other.items():
        text = text.replace({"first": "return degrees - 360.0f", "name": "heading"}[old], new)
    shop = CWorkshop(text, static=True, externs={"read": lambda: 1.0, "drive": lambda _: None})
    return [f.object for f in shop.findings if f.rule == "angle-unwrapped"]


@pytest.mark.parametrize(("step", "text"), [
    (ERROR + USE, "wanted - heading"),
    ("error = heading - wanted; " + USE, "heading - wanted"),
    ("float fehler = wanted - heading; turn = fehler * 0.02f; drive(turn);", "wanted - heading"),
    (ERROR + "turn = 0.02f * error; if (turn > 0.3f) turn = 0.3f; drive(turn);", "wanted - heading"),
])  # fmt: skip
def test_a_difference_that_is_multiplied(step: str, text: str) -> None:
    assert told(step) == [text]


@pytest.mark.parametrize("step", [
    "error = wrap(wanted - heading); " + USE,
    ERROR + "error = wrap(error); " + USE,
    ERROR + "drive(0.02f * wrap(error));",
    ERROR + "if (error > 180.0f) error -= 360.0f; if (error < -180.0f) error += 360.0f; " + USE,
    ERROR + "while (error > 180.0f) { error -= 360.0f; } " + USE,
    ERROR + "if (error > 90.0f || error < -90.0f) drive(0.0f); else drive(0.02f * error);",
    "if (wanted - heading > 180.0f) wanted -= 360.0f; " + ERROR + USE,
    "error = heading - 3.0f; " + USE,
    "turn = wanted - heading; drive(turn);",
    "float goal = heading + wrap(wanted - heading); error = goal - heading; " + USE,
    "last = heading + wrap(wanted - heading); error = last - heading; " + USE,
    "turn = wanted - last; drive(0.02f * turn);",
    ERROR + "drive(error);",
    ERROR + "drive(error * 0.0174533f);",  # a sine needs no wrap
    ERROR + "turn = error * 0.0174533f; drive(sinf(turn));",
    ERROR + "turn = error * 1.0f; drive(0.02f * wrap(turn));",
    ERROR + "int n = (int)(error * 0.002777f); drive(0.02f * (error - n * 360.0f));",
    ERROR + "turn = error * 182.04f; drive((int)(long)turn * 0.001f);",
    ERROR + "turn = error - 360.0f * roundf(error / 360.0f); drive(0.02f * turn + error * 0.0f);",
    ERROR + "last = error * 0.0174533f;",
    ERROR + "if (fabsf(error) > 3.14159265f) drive(0.0f); " + USE,
    ERROR + "drive(0.02f * atan2f(sinf(error * 0.0174533f), cosf(error * 0.0174533f)));",
    "if (fabsf(wanted - heading) < 90.0f) { " + ERROR + USE + " }",
    "turn = wrap(wanted - heading); last = heading + turn; error = last - heading; " + USE,
    "error = heading - last; last = heading; " + USE,
    "error = wanted - heading; if (heading > 45.0f || heading < -45.0f) return; " + USE,
    "yaw = wrap(read() - 3.0f); error = wanted - yaw; " + USE,  # it has an end, and its own zero
    "yaw = yaw + read(); error = wanted - yaw; " + USE,
    "heading += read(); " + ERROR + USE,
])  # fmt: skip
def test_a_difference_that_is_brought_back(step: str) -> None:
    assert told(step) == []


def test_angles_that_do_not_go_round() -> None:
    assert told(ERROR + USE, order="wanted = 0.0f;") == []
    assert told(ERROR + USE, name="pitch") == []
    assert told(ERROR + USE, first="return 180.0f") == []
