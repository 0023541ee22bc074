"""The pin table against one written from TI's pin map, both ways."""

from __future__ import annotations

import csv
from pathlib import Path

from emulator.pin_functions import PIN_FUNCTIONS

TABLE = Path(__file__).parents[1] / "facts" / "pins.csv"


def test_every_signal_reaches_the_pins_of_the_pin_map_and_no_others() -> None:
    with TABLE.open(newline="") as file:
        facts = {(row["signal"], int(row["pin"]), int(row["function"])) for row in csv.DictReader(file)}
    declared = {(signal, pin, function) for signal, pins in PIN_FUNCTIONS.items() for pin, function in pins.items()}
    assert sorted(declared - facts) == [], "declared, but not in the pin map"
    assert sorted(facts - declared) == [], "in the pin map, but not declared"


def test_no_pin_has_two_signals_in_one_function() -> None:
    owner: dict[tuple[int, int], str] = {}
    for signal, pins in PIN_FUNCTIONS.items():
        for place in pins.items():
            assert owner.setdefault(place, signal) == signal, f"GPIO{place[0]} function {place[1]}"
