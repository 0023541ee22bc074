"""Times that a driver is given, compared with an end that wraps before they do; and right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

DRIVER = """#include "F28x_Project.h"
#define PERIOD 1000
static Uint16 last = 0, next = 0, lines = 0; static Uint32 longLast = 0;
int Due(%s)
{
    %s
    return 1;
}
"""


def told(folder: Path, text: str) -> bool:
    """Whether a comparison is told."""
    file = folder / "a.c"
    file.write_text(text, encoding="utf-8")
    return "stamp-compare" in {f.rule for f in Build([str(file)]).compiled.findings}


@pytest.mark.parametrize(
    "body",
    [
        "if (now < last + PERIOD) return 0; last = now;",
        "if (last + PERIOD > now) return 0; last = now;",
        "if (now >= last + 20u) { last = now; lines++; return 1; } return 0;",
        "if (now - PERIOD < last) return 0; last = now;",
        "if (now < next) return 0; next = now + PERIOD;",
    ],
)
def test_an_end_that_wraps(tmp_path: Path, body: str) -> None:
    assert told(tmp_path, DRIVER % ("Uint16 now", body))


def test_a_time_that_is_passed_on(tmp_path: Path) -> None:
    text = DRIVER % ("Uint16 now", "if (now < last + PERIOD) return 0; last = now;")
    assert told(tmp_path, text + "void Status(Uint16 ticks) { if (Due(ticks)) lines++; }")


@pytest.mark.parametrize(
    ("given", "body"),
    [
        ("Uint16 now", "if ((Uint16)(now - last) < PERIOD) return 0; last = now;"),
        ("Uint16 now", "if (now - last < PERIOD) return 0; last = now;"),
        ("Uint16 now", "if ((int16)(now - next) < 0) return 0; next = now + PERIOD;"),
        ("Uint16 now", "if (now < last) last = 0; if (now < last + PERIOD) return 0; last = now;"),
        ("Uint32 now", "if (now < longLast + PERIOD) return 0; longLast = now;"),
        ("Uint16 level", "if (level < last + PERIOD) return 0; last = level;"),
        ("Uint16 now_s", "if (now_s < last + PERIOD) return 0; last = now_s;"),
        ("Uint16 now", "if (now < PERIOD) return 0; last = now;"),
        ("Uint16 now, Uint16 level", "if (now < last + PERIOD) return 0; last = now; last = level;"),
    ],
)
def test_right_twins(tmp_path: Path, given: str, body: str) -> None:
    assert not told(tmp_path, DRIVER % (given, body))
