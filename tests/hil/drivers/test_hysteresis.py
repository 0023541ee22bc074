"""Limits that a hysteresis should part, and does not; and right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import source_findings
from hil.image import Build

THERMOSTAT = """#define SET 220
#define HYST 5
#define HISTERESIS_C (2)
int Dead_Band = 4;
int Celsius = 0, Heater = 0, Wanted = 0;
void Regulate(void)
{{
    if ({on}) {{ Heater = 1; }}
    if ({off}) {{ Heater = 0; }}
}}
"""


def told(folder: Path, on: str, off: str) -> list[tuple[str, int]]:
    """The messages of `no-hysteresis`, each with its line."""
    file = folder / "heat.c"
    file.write_text(THERMOSTAT.format(on=on, off=off), encoding="utf-8")
    found = source_findings(Build([str(file)]))
    return [(f.message, f.place.line) for f in found if f.rule == "no-hysteresis" and f.place is not None]


@pytest.mark.parametrize(("on", "off", "limit", "name"), [
    ("Celsius < SET - HYST", "Celsius > SET - HYST", "SET - HYST", "HYST"),
    ("Celsius <= SET - HYST", "(SET - HYST) < Celsius", "SET - HYST", "HYST"),
    ("Celsius < Wanted - HISTERESIS_C", "Heater && Celsius >= Wanted - HISTERESIS_C", "Wanted - HISTERESIS_C",
     "HISTERESIS_C"),
    ("Celsius < Wanted + Dead_Band", "Celsius > Wanted + Dead_Band", "Wanted + Dead_Band", "Dead_Band"),
])  # fmt: skip
def test_one_limit_for_both_directions_is_told(tmp_path: Path, on: str, off: str, limit: str, name: str) -> None:
    assert told(tmp_path, on, off) == [(
        f"Celsius is compared with {limit} in both directions (the other test is in line 8): {name} does not part the "
        "two limits", 9,
    )]  # fmt: skip


@pytest.mark.parametrize(("on", "off"), [
    ("Celsius < SET - HYST", "Celsius > SET + HYST"), ("Celsius < SET - HYST", "Celsius > SET"),
    # Without a hysteresis; in one direction twice; of two values; with two of them.
    ("Celsius < SET", "Celsius > SET"), ("Celsius < SET - HYST", "Celsius < SET - HYST && Wanted"),
    ("Celsius < SET - HYST", "Wanted > SET - HYST"), ("Celsius < Wanted - HYST", "Celsius > Wanted - Dead_Band"),
    # Inside of a dead band, and outside of it.
    ("Celsius < HYST", "Celsius > HYST"), ("Celsius < -Dead_Band", "Celsius > Dead_Band"),
    # A window.
    ("Celsius >= SET - HYST && Celsius <= SET - HYST", "Celsius > SET"),
])  # fmt: skip
def test_limits_that_are_two_or_meant_as_one_are_silent(tmp_path: Path, on: str, off: str) -> None:
    assert told(tmp_path, on, off) == []


ALARM = """#include "F28x_Project.h"
#define SET 300
#define HYST 20
#define MS 100
Uint16 Deadband = 20;
int Hyst_Back = -20, Mode = 0, Step = 0;
volatile Uint16 Alarm = 0, Above = 0, Ready = 0;
int Celsius = 0;
int Read(int channel) { return AdcaResultRegs.ADCRESULT0 + channel; }
void Supervise(int t, int limit)
{
    %s
}
"""


def told_of(folder: Path, body: str) -> list[tuple[str, int]]:
    """The messages of `no-hysteresis` about a body, each with its line in this."""
    file = folder / "alarm.c"
    file.write_text(ALARM % body, encoding="utf-8")
    found = source_findings(Build([str(file)]))
    return [(f.message, f.place.line - 11) for f in found if f.rule == "no-hysteresis" and f.place is not None]


@pytest.mark.parametrize(("body", "above", "below", "name"), [
    ("if (t > limit) Alarm = 1;\nif (t < limit + HYST) Alarm = 0;", "limit", "limit + HYST", "HYST"),
    ("if (!Alarm) { if (t > limit) { if (++Above >= MS) Alarm = 1; } else { Above = 0; } }\n"
     "else if (t < limit + HYST) { Alarm = 0; Above = 0; }", "limit", "limit + HYST", "HYST"),
    ("if (limit < t && Alarm == 0) Alarm = 1;\nelse if (Alarm && t <= limit + Deadband) Alarm = 0;", "limit",
     "limit + Deadband", "Deadband"),
    ("if (t > SET) Alarm = 1;\nelse if (t < SET + HYST) Alarm = 0;", "SET", "SET + HYST", "HYST"),
    ("if (t > SET - HYST) Alarm = 1;\nif (t < SET || Mode) Alarm = 0;", "SET - HYST", "SET", "HYST"),
])  # fmt: skip
def test_limits_that_cross_are_told(tmp_path: Path, body: str, above: str, below: str, name: str) -> None:
    ((message, _),) = told_of(tmp_path, body)
    assert message == (
        f"Alarm becomes 1 where t is above {above} (line 12), and 0 where it is below {below} (line 13): "
        f"between the two both hold, and {name} makes it go to and fro"
    )


def test_a_pin_that_two_crossed_limits_switch_is_told(tmp_path: Path) -> None:
    for on, off in (
        ("GpioDataRegs.GPASET.bit.GPIO12 = 1;", "GpioDataRegs.GPACLEAR.bit.GPIO12 = 1;"),
        ("GPIO_WritePin(12, 1);", "GPIO_WritePin(12, 0);"),
    ):
        (told,) = told_of(tmp_path, f"if (t > limit) {{ {off} }}\nif (t < limit + HYST) {{ {on} }}")
        assert told[0].startswith("GPIO12 becomes 0 where t is above limit (line 12), and 1 where")
        assert told[1] == 2


@pytest.mark.parametrize("body", [
    # Parted as they should be; of two objects; both for the same outcome.
    "if (t > limit) Alarm = 1;\nif (t < limit - HYST) Alarm = 0;",
    "if (t > limit + HYST) Alarm = 1;\nelse if (t < limit) Alarm = 0;",
    "if (t < limit - HYST) Alarm = 1;\nif (t > limit + HYST) Alarm = 0;",
    "if (t > limit) Alarm = 1;\nif (t < limit + HYST) Ready = 1;",
    "if (t > limit - HYST) Alarm = 0;\nif (t < limit + HYST) Alarm = 0;",
    # A window.
    "Ready = 0;\nif (t > SET - HYST && t < SET + HYST) Ready = 1;",
    "Ready = 0;\nif (t > SET - HYST) { if (t < SET + HYST) Ready = 1; else Ready = 0; }",
    "if (t < SET + HYST) { if (t > SET - HYST) Ready = 1; else Ready = 0; } else Ready = 0;",
    # An oven: it heats up until it is nearly hot, and has cooled down when it is nearly cold.
    "switch (Step) { case 0: if (t > SET - HYST) Step = 1; break; case 1: Step = 2; break;\n"
    "case 2: if (t < SET + HYST) Step = 3; break; }",
    "if (Step == 0) { if (t > SET - HYST) { Ready = 1; Step = 1; } }\n"
    "else if (Step == 2) { if (t < SET + HYST) { Ready = 0; Step = 3; } }",
    "if (Step == 0 && t > SET - HYST) Step = 1;\nelse if (Step == 2 && t < SET + HYST) Step = 3;",
    "if (Mode && t > SET - HYST) Ready = 1;\nif (!Mode && t < SET + HYST) Ready = 0;",
    # Another value between the tests; a limit that moves; a third value; a hysteresis that is below 0.
    "t = Read(1);\nif (t > limit) Alarm = 1;\nt = Read(2);\nif (t < limit + HYST) Alarm = 0;",
    "limit = 10;\nif (t > limit) Alarm = 1;\nlimit = -90;\nif (t < limit + HYST) Alarm = 0;",
    "if (t > limit) Alarm = 1;\nif (t < limit + HYST) Alarm = 0;\nif (Mode) Alarm = 2;",
    "if (t > limit) Alarm = 1;\nif (t < limit + Hyst_Back) Alarm = 0;",
])  # fmt: skip
def test_limits_that_do_not_cross_are_silent(tmp_path: Path, body: str) -> None:
    assert told_of(tmp_path, body) == []
