"""Findings to report, in a firmware module of their own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hypothesis import strategies as st

from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place
from emulator.rules import RULES

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


texts = st.text(max_size=20)
LINES = st.integers(1, 80)
FILES = st.sampled_from([__file__, "/nowhere/us.py", "us.py"])
places = st.builds(Place, FILES, LINES, texts, texts, st.integers(0, 200), st.just(""))


@st.composite
def findings(draw: st.DrawFn) -> Finding:
    """Any finding at all."""
    path = tuple(draw(st.lists(places, max_size=3)))
    return Finding(
        draw(st.sampled_from([*RULES, "mine"])), draw(texts), draw(texts), draw(texts), path[0] if path else None, path,
        draw(texts), draw(st.integers(0, 10**12)),
        draw(st.one_of(st.none(), st.integers(), st.floats(), texts, st.just(object()))), draw(st.integers(1, 10**6)),
        draw(st.lists(st.one_of(texts, places.map(lambda p: f"written at {p} before")), max_size=2).map(tuple)),
        draw(st.sampled_from(["static", "dynamic"])),
    )  # fmt: skip
