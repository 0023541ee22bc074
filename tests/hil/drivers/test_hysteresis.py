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
