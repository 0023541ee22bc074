"""``hil blind-spots``: the angles at which the sonars lose a wall."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from hil.cli import show
from hil.files import at_last


def blind_spots(
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the map (PNG, SVG).")] = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Map the angles and distances at which three or five sonars do not detect a wall.

    [bold]Examples[/bold]
      hil blind-spots --plot blind.png
      hil blind-spots --json
    """
    with show.user_errors(), at_last() as writes:
        from hil.client.plot import check_plot_file
        from hil.procedures import blind_spots as procedure

        if plot is not None:
            check_plot_file(plot)
        found = procedure.both()
        if plot is not None:
            writes.append(partial(procedure.plot, plot, found))
        if json_output:
            robots = {one.name: one.as_dict() for one in found}
            show.print_json({"robots": robots, "sentence": procedure.sentence(found)})
            return
        table = Table(title="perpendicular of a wall, degrees left of ahead", title_justify="left")
        for heading in ("sonars", "never heard", "not heard by every turn of the ring"):
            table.add_column(heading)
        for one in found:
            ranges = (", ".join(f"{a}..{b}" for a, b in runs) for runs in (one.lost(), one.uncertain()))
            table.add_row(one.name, *ranges)
        console = show.console()
        console.print(table)
        console.print(procedure.sentence(found))
