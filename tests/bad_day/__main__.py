"""Try each figure of the bad day for a while, and print what came of it.

    python -m tests.bad_day --seconds 600
    python -m tests.bad_day --only signals --first 1000
"""

from __future__ import annotations

import argparse
import time
from contextlib import redirect_stdout
from io import StringIO

from rich.console import Console
from rich.table import Table

from tests.bad_day import view
from tests.bad_day.family import FIGURES, tried


def main() -> int:
    """The table; 1 if anything failed."""
    parser = argparse.ArgumentParser(prog="python -m tests.bad_day", description="the bad day, by the clock")
    parser.add_argument("--seconds", type=float, default=120, help="real time for all figures together")
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--only", action="append", choices=[figure.name for figure in FIGURES], help="these figures")
    arguments = parser.parse_args()
    terminal = Console()
    table = Table("figure", "what", title=f"The bad day, from seed {arguments.first}", title_justify="left")
    for heading in ("tried", "failures"):
        table.add_column(heading, justify="right")
    chosen = [figure for figure in FIGURES if arguments.only is None or figure.name in arguments.only]
    failures = 0
    for figure in chosen:
        if why := figure.missing():
            table.add_row(figure.name, figure.about, "", why)
            continue
        end, seed, failed = time.monotonic() + arguments.seconds / len(chosen), arguments.first, 0
        while seed == arguments.first or time.monotonic() < end:
            try:
                with redirect_stdout(StringIO()):
                    found = tried(figure, seed)
            except Exception as error:  # of the figure itself: the others are tried all the same
                found = f"{type(error).__name__}: {error}"
            if found:
                failed += 1
                terminal.print(f"{figure.name} {seed}: {found}", markup=False, highlight=False)
            seed += 1
        if figure.case is view.case:
            for found in view.ended():
                failed += 1
                terminal.print(f"{figure.name}: {found}", markup=False, highlight=False)
        table.add_row(figure.name, figure.about, f"{seed - arguments.first:,}", str(failed))
        failures += failed
    terminal.print(table)
    return 1 if failures else 0


if __name__ == "__main__":
    raise SystemExit(main())
