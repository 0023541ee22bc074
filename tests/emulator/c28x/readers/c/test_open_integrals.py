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


LIMITED = """#include <math.h>
#define LIMIT(x, most) ((x) > (most) ? (most) : (x) < -(most) ? -(most) : (x))
#define U 0.95f
typedef int int16;
typedef struct {{ float ki, kp, max, integral, out; }} Pi;
volatile int16 target, measured, go; static float Shown; static int16 Saturated;
extern void *memset(void *to, int value, unsigned long size);
static float limit(float value, float most)
{{
    {limit}
}}
static void drive(float u) {{ if (u >= 0.0f) Shown = u; else Shown = -u; }}
{other}
static void control(void)
{{
    float error, u, raw;
    {local} float integral = 0.0f;
    {before}
    for (;;)
    {{
        int16 far = target - measured;
        error = (float)far;
        {body}
    }}
}}
int main(void) {{ {main} control(); return 0; }}
"""
BOTH = "if (value > most) return most; if (value < -most) return -most; return value;"
SUM = "integral = integral + 0.002f * error;"
OUT = "u = limit(0.1f * error + integral, U);"


def told_of_limited(folder: Path, **given: str) -> list[str]:
    """The lines at which `wind-up` is told of a regulator whose output a function limits."""
    file = folder / "a.c"
    default = {"limit": BOTH, "other": "", "local": "", "before": "", "body": f"{SUM}\n{OUT} drive(u);", "main": ""}
    text = LIMITED.format(**{**default, **given})
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "wind-up"]


STEP = """static float step(Pi *p, float error)
{
    p->integral += p->ki * error;
    return limit(p->kp * error + p->integral, p->max);
}
static Pi pi = {0.002f, 0.1f, 0.95f, 0.0f, 0.0f};
"""


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"local": "static"},
        {"before": "integral = 0.0f;"},
        {"body": f"{SUM}\nu = 0.1f * error + integral; u = limit(u, U); drive(u);"},
        {"body": f"{SUM}\nraw = 0.1f * error + integral; u = limit(raw, U); drive(u);"},
        {"body": f"{SUM}\nu = LIMIT(0.1f * error + integral, U); drive(u);"},
        {"body": f"{SUM}\nu = 0.1f * error + integral; u = LIMIT(u, U); drive(u);"},
        {"body": f"{SUM}\ndrive(limit(integral + 0.1f * error, U));"},
        {"limit": "if (value > most) value = most; else if (value < -most) value = -most; return value;"},
        {"limit": "if (value > most) { return most; } else if (-most > value) { return -most; } else return value;"},
        {"limit": "return value > most ? most : value < -most ? -most : value;"},
        {"limit": "return value < most ? (value > -most ? value : -most) : most;"},
        {"limit": "if (most < 0) most = 0; if (value < 0) return 0; if (value > most) return most; return value;"},
    ],
)
def test_an_output_that_a_function_limits_and_an_integral_without_a_limit_is_told(
    tmp_path: Path, given: dict[str, str]
) -> None:  # fmt: skip
    assert told_of_limited(tmp_path, **given) == [SUM]


def test_a_structure_of_a_regulator_whose_integral_nothing_limits_is_told(tmp_path: Path) -> None:
    told = told_of_limited(tmp_path, other=STEP, body="drive(step(&pi, error));")
    assert told == ["p->integral += p->ki * error;"]


@pytest.mark.parametrize(
    "given",
    [
        # Limited.
        {"body": f"integral = limit(integral + 0.002f * error, U); {OUT} drive(u);"},
        {"body": f"{SUM} integral = limit(integral, U); {OUT} drive(u);"},
        {"body": f"{SUM} if (integral > U) integral = U; if (integral < -U) integral = -U; {OUT} drive(u);"},
        {"body": f"{SUM} integral = LIMIT(integral, U); {OUT} drive(u);"},
        {"body": f"{SUM} integral = integral > U ? U : integral < -U ? -U : integral; {OUT} drive(u);"},
        {"body": f"{SUM} integral = fminf(fmaxf(integral, -U), U); {OUT} drive(u);"},
        {"body": f"{SUM} if (fabsf(integral) > U) integral -= 0.002f * error; {OUT} drive(u);"},
        {"other": "static void clamp(float *x) { if (*x > U) *x = U; }",
         "body": f"{SUM} clamp(&integral); {OUT} drive(u);"},
        # Added to under a condition.
        {"body": f"u = limit(0.1f * error + integral, U); if (u < U && u > -U) {SUM} drive(u);"},
        {"body": f"if (!Saturated) {SUM} raw = 0.1f * error + integral; u = limit(raw, U); Saturated = u != raw;"},
        {"body": f"{OUT} drive(u); if (u >= U || u <= -U) continue; {SUM}"},
        {"body": f"if (fabsf(error) < 20.0f) {SUM} {OUT} drive(u);"},
        {"body": f"integral += fabsf(error) < 20.0f ? 0.002f * error : 0.0f; {OUT} drive(u);"},
        {"body": f"float gain = 0.0f; if (!Saturated) gain = 0.002f; integral += gain * error; {OUT} drive(u);"},
        {"body": f"if (Saturated) error = 0.0f; {SUM} raw = 0.1f * error + integral; u = limit(raw, U); "
                 "Saturated = raw > U; drive(u);"},
        {"body": "integral += Saturated * error; raw = 0.1f * error + integral; u = limit(raw, U); "
                 "Saturated = raw < U; drive(u);"},
        {"body": f"if (far > 20) {{ drive(U); continue; }} {SUM} {OUT} drive(u);"},
        # Calculated back.
        {"body": f"{SUM} raw = 0.1f * error + integral; u = limit(raw, U); integral += 0.5f * (u - raw); drive(u);"},
        {"body": f"{SUM} raw = 0.1f * error + integral; u = limit(raw, U); integral = u - 0.1f * error; drive(u);"},
        {"body": "raw = 0.1f * error + integral; u = limit(raw, U); integral += 0.002f * error + 0.1f * (u - raw);"},
        {"before": "float over = 0.0f;",
         "body": "integral += 0.002f * error - over; raw = 0.1f * error + integral; u = limit(raw, U); "
                 "over = 0.1f * (raw - u); drive(u);"},
        {"body": f"{SUM} raw = 0.1f * error + integral; u = limit(raw, U); if (u != raw) integral -= 0.002f * error;"},
        # Reset, or a filter.
        {"body": f"if (!go) {{ integral = 0.0f; drive(0.0f); continue; }} {SUM} {OUT} drive(u);"},
        {"body": f"{SUM} {OUT} drive(u); if (target == 0) integral = 0.0f;"},
        {"body": f"integral *= 0.99f; {SUM} {OUT} drive(u);"},
        {"local": "", "body": f"float integral = 0.0f; {SUM} {OUT} drive(u);"},
        # No limit of the output on both sides.
        {"limit": "if (value > most) return most; return value;"},
        {"limit": "return value > most ? most : value;"},
        {"limit": "if (value > most) Saturated = 1; if (value < -most) Saturated = 1; return value;"},
        {"body": f"{SUM} u = 0.1f * error + integral; drive(u); Shown = limit(error, U);"},
        {"body": f"{SUM} Shown = limit(integral, U); drive(0.1f * error);"},  # a meter
        # The loop of a phase follows its own output.
        {"before": "float angle = 0.0f;",
         "body": f"error = target - angle; {SUM} {OUT} angle += u;"},
        # A structure that something sets.
        {"other": STEP, "body": "if (!go) pi.integral = 0.0f; drive(step(&pi, error));"},
        {"other": STEP + "static const Pi NONE = {0.002f, 0.1f, 0.95f, 0.0f, 0.0f};",
         "body": "if (!go) pi = NONE; drive(step(&pi, error));"},
        {"other": STEP, "body": "if (!go) memset(&pi, 0, sizeof pi); drive(step(&pi, error));"},
        {"other": STEP + "static struct { int16 on; Pi pi; } axis;",
         "body": "if (!go) axis.pi.integral = 0.0f; drive(step(&axis.pi, error));"},
        {"other": STEP, "body": "if (far < 20 && far > -20) drive(step(&pi, error)); else drive(U);"},
        {"other": STEP, "body": "if (target < 20) drive(step(&pi, error));"},
        {"other": STEP, "body": "if (!Saturated) u = step(&pi, error); Saturated = u >= U; drive(u);"},
    ],
)  # fmt: skip
def test_what_keeps_an_integral_beside_a_limited_output_is_silent(tmp_path: Path, given: dict[str, str]) -> None:
    assert told_of_limited(tmp_path, **given) == []
