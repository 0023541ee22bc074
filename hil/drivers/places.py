"""Moves findings to lines of the files that were named, and finds those that are about another board."""

from __future__ import annotations

import re
from collections.abc import Iterable, Set
from dataclasses import replace
from pathlib import Path
from typing import Final

from emulator.c28x.findings import Finding
from emulator.signals import Wire
from hil.reports.model import rule_of

#: Rules about what is wired to the chip, and names of the parts on the board of the robot.
_WIRED: Final = (
    "adc-input-open", "burst-repeats", "contention", "device-clock", "device-register", "serial-rate", "spi-mode",
    "spi-no-device", "spi-transaction-cut",
)  # fmt: skip
_PARTS: Final = re.compile(r"sonar |AN of sonar |L3G4200D|XBee")
#: Interrupts of trip zones.
_TRIP: Final = re.compile(r"EPWM\d+_TZ")
#: What files say that drive the gyro of the robot, or one like it.
_GYRO: Final = re.compile(r"L3G|gyro", re.IGNORECASE)


def anchored(finding: Finding, others: Set[str]) -> Finding | None:
    """A finding at the innermost place of its call path that lies in the named files, or in one of their headers.

    `others` are the files of what the named files need, such as a library with its headers.  Where the finding itself
    was seen stays as a detail.  Returns None for a finding that occurs without the named files.
    """
    if finding.place is None or finding.place.file not in others:
        return finding
    for depth, place in enumerate(finding.call_path):
        if place.file not in others and not place.file.startswith("<"):
            seen = f"seen in {finding.place}"
            return replace(
                finding, place=place, call_path=finding.call_path[depth:], details=(*finding.details, seen)
            )
    return None


def of_parts(finding: Finding) -> bool:
    """Whether a finding is about the parts around the chip.  A user's board has other parts than the robot's."""
    about = _PARTS.match(finding.object) or _PARTS.match(finding.message)
    return finding.rule in _WIRED or rule_of(finding.rule).family == "device-time" or about is not None


def of_open_trip(finding: Finding, trips: Iterable[Wire]) -> bool:
    """Whether a finding is about trips that never end because nothing drives a pin: `trips` are those of trip zones.

    The user's board has something there.
    """
    return finding.rule == "interrupt-storm" and _TRIP.match(finding.object) is not None and not all(
        wire.driven() for wire in trips
    )  # fmt: skip


def mentions_gyro(files: Iterable[str]) -> bool:
    """Whether one of these files speaks of a gyro, in its name, its code or its comments."""
    return any(_GYRO.search(file) or _GYRO.search(Path(file).read_text(errors="replace")) for file in files)


def of_unused_part(
    finding: Finding, sonar_starts: Iterable[Wire], chip_selects: Iterable[Wire], *, gyro: bool
) -> bool:  # fmt: skip
    """Whether a finding is about a part that the program does not use.  Its board need not have such a part.

    A program that uses the sonars starts them, and one that uses a part on an SPI selects it: `sonar_starts` and
    `chip_selects` are these wires.  Another driver of a pin than the chip is a part of the board in any case.  What the
    program selects is another part than the gyro if its files never mention one (`gyro`).
    """
    if not gyro and any(text.startswith("L3G4200D") for text in (finding.object, finding.message)):
        return True
    if finding.object.startswith("sonar "):
        return not any(start.driven() for start in sonar_starts)
    if finding.rule == "spi-no-device":
        return not any(select.driven() for select in chip_selects)
    # A program of its own may have another peer, or a part at another input.
    return finding.rule in ("adc-input-open", "contention", "serial-rate")
