"""The table of `hil/README.md`: how well each model does with the float division of each build."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from tests.calibration.fit import MODELS, TARGETS, Model, Robot, fit, worst, worst_left_out

PAGE: Final = Path(__file__).resolve().parents[2] / "hil/README.md"
#: The builds that it shows, by their float division.
BUILDS: Final = ("calibrated", "standard")
#: The table between its marks.
TABLE: Final = re.compile(r"(<!-- calibration -->\n)(.*)(<!-- /calibration -->)", re.DOTALL)
#: Names of models in code -> what the page calls them.
_NAMES: Final = {
    "no factor": "none", "one factor": "one for all code", "drivers": "the three drivers",
    "us | gyro and wheels": "us; gyro and wheels", "us | gyro | wheels": "us; gyro; wheels",
    "as shipped": "**us; gyro and wheels; what tasks share**",
    "each task its factor": "us; gyro; wheels; main; servers",
}  # fmt: skip


def cells(robot: Robot, models: Sequence[Model] = MODELS) -> list[list[str]]:
    """Of each model: factor by which the worst target is off, of all that it was fitted to and of tasks left out."""
    return [
        [f"{worst(map(fit(model, robot).ratio, TARGETS)):.2f}", f"{worst_left_out(model, robot):.2f}"]
        for model in models
    ]


def rows(of_builds: Sequence[list[list[str]]]) -> str:
    """The table, from the cells of each build in the order of `BUILDS`."""
    headings = [f"`{build}`: {what}" for build in BUILDS for what in ("fit", "left out")]
    lines = [["factors on code", "constants", *headings], ["---", *["--:"] * (1 + len(headings))]]
    for number, model in enumerate(MODELS):
        found = [cell for one in of_builds for cell in one[number]]
        lines.append([_NAMES[model.name], str(len(model.constants)), *found])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def cells_of_page(build: str) -> list[list[str]]:
    """What the page shows of a build, as `cells` gives it."""
    found = TABLE.search(PAGE.read_text(encoding="utf-8"))
    assert found is not None, "no table"
    first = 2 + 2 * BUILDS.index(build)
    table = [[cell.strip() for cell in line.strip("|").split("|")] for line in found[2].splitlines()[2:]]
    return [line[first : first + 2] for line in table]
