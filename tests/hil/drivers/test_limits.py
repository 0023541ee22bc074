"""Limits, and times and other quantities, that are defined and that nothing applies."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files

HEAD = "#define DUTY_MAX 950\n#define PAUSE 20u\nint duty = 0;\nint level = 0;\n"
USES = "int limit(int v) { return v > DUTY_MAX ? DUTY_MAX : v; }\n"


def told(folder: Path, text: str, name: str = "pump.c") -> list[tuple[str, int]]:
    """Name and line of each limit that is told."""
    file = folder / name
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1)).findings
    return [(f.object, f.place.line) for f in found if f.rule == "limit-unused" and f.place is not None]


@pytest.mark.parametrize("limit", [
    "#define LEVEL_MIN 40", "# define LEVEL_LOW_MV (40L)", "#define REPLY_TIMEOUT_MS 0x28",
    "#define OVERCURRENT_MA 3.5f", "#define SETTLING_US 150", "#define COLD_TENTHS (-50)",
    "#define TRAVEL_LIMIT ((long)-8000)   // steps", "#define LEVEL_MIN 40  // LEVEL_MIN is in mm",
    "#define HOT_C 45",
])  # fmt: skip
def test_a_limit_that_nothing_applies_is_told(tmp_path: Path, limit: str) -> None:
    ((name, line),) = told(tmp_path, f"{HEAD}{limit}\n{USES}")
    assert (line, name in limit) == (5, True)


PYTHON = """from emulator.c28x.language import *

DUTY_MAX = 950
%s
since_ms: uint32 = 0


def limit(v: int16) -> int16:
    return DUTY_MAX if v > DUTY_MAX else v
"""


@pytest.mark.parametrize(("line", "names"), [
    ("HOME_MS = 60000", [("HOME_MS", 4)]), ("LEVEL_MIN: int16 = -40  # LEVEL_MIN is in mm", [("LEVEL_MIN", 4)]),
    ("HOME = 3", []), ("HOME_MS = 5\nHOME_US = HOME_MS * 1000", []),
])  # fmt: skip
def test_constants_in_python_are_limits_too(tmp_path: Path, line: str, names: list[tuple[str, int]]) -> None:
    assert told(tmp_path, PYTHON % line, "home.py") == names


@pytest.mark.parametrize("text", [
    f"{HEAD}#define LEVEL_MIN 40\n{USES}int low(void) {{ return level < LEVEL_MIN; }}\n",
    # Used by another definition, or by the preprocessor.
    f"{HEAD}#define LEVEL_MIN 40\n#define LEVEL_GOOD (LEVEL_MIN + 5)\n{USES}int good(void) {{ return LEVEL_GOOD; }}\n",
    f"{HEAD}#define LEVEL_MIN 40\n#if LEVEL_MIN > 30\n{USES}#endif\n",
    # No limit by its name, no number, a list of what a part can do.
    f"{HEAD}#define FIRST_CHANNEL 3\n#define MAXIMA 4\n#define LOWER(a) ((a) - 1)\n#define MIN_OF level\n{USES}",
    f"{HEAD}#define RATE_MAX 9\n#define RATE_MIN 1\n{USES}",
    f"{HEAD}#define HIGH 1\n{USES}",
    # No other limit is used.
    "#define LEVEL_MIN 40\nint level = 0;\nint get(void) { return level; }\n",
])  # fmt: skip
def test_what_is_used_or_no_limit_is_not_told(tmp_path: Path, text: str) -> None:
    assert told(tmp_path, text) == []
