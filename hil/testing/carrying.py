"""Converts findings to plain data and back.  An xdist worker sends them to the process that writes the report."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place


def pack(finding: Finding) -> dict[str, Any]:
    """A finding as numbers, texts, lists and dictionaries."""
    data = asdict(finding)
    data["place"] = finding.place and finding.place._asdict()
    data["call_path"] = [place._asdict() for place in finding.call_path]
    if not isinstance(finding.value, int | float | str | None):
        data["value"] = str(finding.value)
    return data


def unpack(data: dict[str, Any]) -> Finding:
    """The finding that `pack` has converted."""
    place = data["place"]
    return Finding(
        **{
            **data,
            "place": None if place is None else Place(**place),
            "call_path": tuple(Place(**p) for p in data["call_path"]),
            "details": tuple(data["details"]),
        }
    )
