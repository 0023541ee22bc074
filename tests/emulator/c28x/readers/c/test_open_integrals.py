"""Regulators whose integral is limited on one side only, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """typedef int int16; typedef long int32;
enum {{ OFF, HEAT, HOLD }};
struct {{ int16 wanted, measured, power; int32 integral; }} Oven;
int16 State;
void Power(int16 permille) {{ Oven.power = permille; }}
static void Regulate(void)
{{
    int32 error = (int32)Oven.wanted - Oven.measured;
    int32 power;
    {add}
    {limits}
    power = error / 4 + Oven.integral / 2000;
    if (power > 1000) power = 1000;
    if (power < 0) power = 0;
    Power((int16)power);
}}
int main(void)
{{
    for (;;)
    {{
        {turn}
    }}
}}
"""
LOW = "if (Oven.integral < 0) Oven.integral = 0;"
HIGH = "if (Oven.integral > 2000000L) Oven.integral = 2000000L;"
GIVEN = {"add": "Oven.integral += error;", "limits": LOW, "turn": "if (State != OFF) Regulate();"}


def told(folder: Path, **given: str) -> list[str]:
    """The lines at which `wind-up` is told before the program runs."""
    file = folder / "a.c"
    text = PROGRAM.format(**{**GIVEN, **given})
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "wind-up"]


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"limits": HIGH},
        {"turn": "if (State == OFF) continue; Regulate();"},
        {"turn": "switch (State) { case HEAT: Regulate(); break; case HOLD: Regulate(); break; default: Power(0); }"},
        {"turn": "if (Oven.measured > 2800) { Power(0); State = OFF; } if (State != OFF) Regulate();"},
        {"turn": "if (State == OFF) { State = HEAT; Oven.integral = 0; } Regulate();"},
    ],
)
def test_a_limit_on_one_side_only_is_told(tmp_path: Path, given: dict[str, str]) -> None:
    assert told(tmp_path, **given) == ["Oven.integral += error;"]


@pytest.mark.parametrize(
    "given",
    [
        {"limits": LOW + HIGH},
        {"limits": ""},  # the run decides
        # Added to only while the output is within its limits, or near the wanted value.
        {"add": "if (Oven.power < 1000) Oven.integral += error;"},
        {"add": "if (error < 30) Oven.integral += error;"},
        {"add": "if (error > 30) { Power(1000); return; } Oven.integral += error;"},
        {"limits": LOW + "if (error > 30) Oven.integral = 0;"},
        {"turn": "if (Oven.wanted - Oven.measured < 30) Regulate(); else Power(1000);"},
        {"turn": "if (Oven.wanted - Oven.measured > 30) { Power(1000); continue; } Regulate();"},
        {"turn": "int16 far = Oven.wanted - Oven.measured; if (far > 30) Power(1000); else Regulate();"},
        {"turn": "if (Oven.wanted - Oven.measured > 30) Oven.integral = 0; Regulate();"},
        # In the other state the oven has full power.
        {"turn": "switch (State) { case HEAT: Power(1000); break; case HOLD: Regulate(); break; default: Power(0); }"},
        {"turn": "if (State == HOLD) Regulate(); else Power(State == HEAT ? 1000 : 0);"},
        {"turn": "Power(0);"},  # called by nobody that is known
    ],
)
def test_what_keeps_an_integral_small_is_silent(tmp_path: Path, given: dict[str, str]) -> None:
    assert told(tmp_path, **given) == []
