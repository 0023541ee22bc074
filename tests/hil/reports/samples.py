"""Findings to report, in a firmware module of their own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from emulator.c28x.findings import Finding, Place

#: Line 3 is `total += v[i]`, line 5 the same statement again.
SOURCE = """\
def f(n):
    total = 0
    total += v[i]
    g()
    total += v[i]
    return total
"""


def module(folder: Path, source: str = SOURCE, name: str = "us.py") -> Path:
    """A firmware module in `folder`."""
    path = folder / name
    path.write_text(source, encoding="utf-8")
    return path


def finding(file: Path | str, line: int, rule: str = "rotation-sign", **more: Any) -> Finding:
    """A finding at a line of the C function f of us.c, called from TaskUS at line 1."""
    place = Place(str(file), line, "f", "us.c")
    values: dict[str, Any] = {
        "message": "it is wrong", "object": "us.f.total", "declaration": "float total", "task": "TaskUS",
        "time_cycles": 2_000_000, "value": 1.5,
        "place": place, "call_path": (place, Place(str(file), 1, "TaskUS", "main_Robot.c")),
    }  # fmt: skip
    return Finding(rule=rule, **{**values, **more})
