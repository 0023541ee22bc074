"""``python -m tests.calibration``: how sure the times of the emulator are.

Each model of the constants is fitted to everything that the thesis measured, then once without each task, which is
predicted.  ``--float-division`` does so with the division of another build; ``--write`` puts the tolerance of code that
was not calibrated into `emulator/c28x/passes/costs.py`, and the table of all models and builds into `hil/README.md`.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable
from pathlib import Path

from rich.console import Console
from rich.table import Table

from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION, FLOAT_DIVISIONS
from emulator.c28x.passes import costs
from tests.calibration.fit import LEFT_OUT, MODELS, NEVER_FITTED, TARGETS, Robot, fit, left_out, tolerance
from tests.calibration.fit import worst as worst_of
from tests.calibration.page import BUILDS, PAGE, TABLE, cells, rows

_LINE = re.compile(r"^(UNCALIBRATED_FACTOR: Final = ).*$", re.MULTILINE)


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m tests.calibration", description=__doc__)
    parser.add_argument("--float-division", choices=list(FLOAT_DIVISIONS), default=DEFAULT_FLOAT_DIVISION)
    parser.add_argument("--write", action="store_true", help="put what comes out into costs.py and README.md")
    asked = parser.parse_args()
    if asked.write and asked.float_division != DEFAULT_FLOAT_DIVISION:
        parser.error("--write: the constants of the port were fitted with the default division")
    console = Console(width=200)
    robot = Robot(asked.float_division)
    if not asked.write:
        console.print(_table(robot))
    if asked.float_division == DEFAULT_FLOAT_DIVISION:
        factor = tolerance(robot)
        console.print(f"Code that was not calibrated: within a factor of {factor}")
        if asked.write:
            file = Path(costs.__file__)
            file.write_text(_LINE.sub(rf"\g<1>{factor}", file.read_text(encoding="utf-8")), encoding="utf-8")
            table = rows([cells(Robot(build)) for build in BUILDS])
            page = TABLE.sub(lambda found: found[1] + table + found[3], PAGE.read_text(encoding="utf-8"))
            PAGE.write_text(page, encoding="utf-8")


def _table(robot: Robot) -> Table:
    table = Table(
        title=f"Predicted against measured, %; float division: {robot.float_division}; -: task left out of the fit",
        title_justify="left",
    )
    table.add_column("model")
    for heading in ("constants", "worst", *TARGETS, *NEVER_FITTED):
        table.add_column(heading, justify="right")
    for model in MODELS:
        found = fit(model, robot)
        fitted = {what: found.ratio(what) for what in (*TARGETS, *NEVER_FITTED)}
        table.add_row(model.name, str(len(model.constants)), _worst(fitted[t] for t in TARGETS), *_percents(fitted))
        without = left_out(model, robot)
        worst = _worst(without[target] for task in LEFT_OUT for target in LEFT_OUT[task] if task != "TaskODO")
        table.add_row("-", "", worst, *_percents(without), style="dim", end_section=True)
    return table


def _worst(ratios: Iterable[float]) -> str:
    return f"x {worst_of(ratios):.2f}"


def _percents(ratios: dict[str, float]) -> list[str]:
    return [f"{(ratios[what] - 1) * 100:+.0f}" if what in ratios else "" for what in (*TARGETS, *NEVER_FITTED)]


if __name__ == "__main__":
    main()
