"""``hil compare-filters``: compares ways to compute a distance from several sonar samples."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import Progress
from rich.table import Table

from emulator.seed import MAX_SEED
from hil.cli import show
from hil.files import at_last


def compare_filters(
    seed: Annotated[int, typer.Option(min=0, max=MAX_SEED, help="The seed of the emulated robot.")] = 1,
    readings: Annotated[int, typer.Option(min=1, max=10_000, help="The number of readings at each distance.")] = 30,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the errors (PNG, SVG).")] = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Compare filters of the front sonar: us.c's sum, its median, the thesis' text, the corrected driver.

    [bold]Examples[/bold]
      hil compare-filters
      hil compare-filters --seed 3 --readings 100 --plot filters.png
    """
    with show.user_errors(), at_last() as writes:
        from hil.client.plot import check_plot_file
        from hil.procedures import compare_filters as procedure

        if plot is not None:
            check_plot_file(plot)
        console = show.console()
        with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
            task = progress.add_task("measuring", total=1.0)
            found = procedure.compare(
                seed=seed, readings=readings, progress=lambda fraction: progress.update(task, completed=fraction)
            )
        thesis = procedure.of_the_thesis()
        if plot is not None:
            writes.append(partial(procedure.plot, plot, found, thesis))
        if json_output:
            show.print_json({
                "seed": seed, "filters": [one.as_dict() for one in (*thesis, *found)],
                "sentence": procedure.sentence(found),
            })  # fmt: skip
            return
        table = Table(title="read minus real distance (cm)", title_justify="left")
        by_distance = (f"rms at {distance:g}" for distance in procedure.DISTANCES_CM)
        for heading in ("filter", "mean", "deviation", "rms", "worst", *by_distance):
            table.add_column(heading, justify="left" if heading == "filter" else "right")
        for one in (*thesis, *found):
            total = one.errors
            table.add_row(
                one.name, f"{total.mean_cm:+.2f}", f"{total.deviation_cm:.2f}", f"{total.rms_cm:.2f}",
                f"{total.worst_cm:+.2f}", *(f"{one.at(d).rms_cm:.2f}" for d in procedure.DISTANCES_CM),
            )  # fmt: skip
        console.print(table)
        console.print(procedure.sentence(found))
