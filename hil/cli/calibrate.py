"""``hil calibrate``: slope and offset of `Calibrate_US` from distances and raw values."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.markup import escape
from rich.progress import Progress
from rich.table import Table as Shown

from emulator.seed import MAX_SEED
from hil.cli import show
from hil.files import at_last, check_target, replacing

if TYPE_CHECKING:
    from hil.procedures.calibrate import Table

EXAMPLES: Final = """
[bold]Examples[/bold]
  hil calibrate measured.csv --plot measured.png
  hil calibrate --thesis                       (the tables of annex A.3.1)
  hil calibrate --emulate --write table.csv   (the emulated robot)

[bold]The table[/bold]
  A header, then a row a measurement; an empty cell was not measured:
  distance_cm,LEFT,FRONT,RIGHT
  20,354,313,341
  The raw value is what Read_Distance gives after Calibrate_US(sonar, 1, 0).
"""


def calibrate(
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE.csv]", help="A table of distances and raw values.")
    ] = None,
    thesis: Annotated[bool, typer.Option("--thesis", help="Use the 54 rows of annex A.3.1 of the thesis.")] = False,
    emulate: Annotated[
        bool, typer.Option("--emulate", help="Measure with the emulated robot in front of a wall.")
    ] = False,
    seed: Annotated[int, typer.Option(min=0, max=MAX_SEED, help="The seed of the emulated sonars.")] = 1,
    ideal: Annotated[bool, typer.Option("--ideal", help="Emulate sonars without noise.")] = False,
    fix: Annotated[
        list[str] | None,
        typer.Option(metavar="ID", help="With --emulate, link a correction of the catalogue; repeatable."),
    ] = None,
    write: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the table as CSV.")] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw rows, lines, residuals (PNG, SVG).")] = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Compute slope and offset of `Calibrate_US` from distances and raw values, with and without suspect rows."""
    with show.user_errors(), at_last() as writes:
        from hil.client.plot import check_plot_file
        from hil.procedures import calibrate as procedure

        if (file is not None) + thesis + emulate != 1:
            raise show.UserError("give one of FILE.csv, --thesis and --emulate")
        if (fix or ideal) and not emulate:
            raise show.UserError("--fix and --ideal are for --emulate")
        if write is not None:
            check_target(write)
        if plot is not None:
            check_plot_file(plot)
        if file is not None:
            table, title = procedure.read(file), str(file)
        elif thesis:
            table, title = procedure.of_the_thesis(), "annex A.3.1"
        else:
            console = show.console()
            with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
                task = progress.add_task("measuring", total=1.0)
                table = procedure.emulate(
                    seed=None if ideal else seed, fixes=fix or (),
                    progress=lambda fraction: progress.update(task, completed=fraction),
                )  # fmt: skip
            title = "emulated, ideal sonars" if ideal else f"emulated, seed {seed}"
        found = procedure.calibrate(table)
        if write is not None:
            writes.append(partial(_write, write, table))
        if plot is not None:
            writes.append(partial(procedure.plot, plot, found, title))
        if json_output:
            show.print_json({"source": title, "sonars": [one.as_dict() for one in found]})
            return
        console = show.console()
        shown = Shown(title=title, title_justify="left")
        for heading in ("sonar", "slope (cm)", "offset (cm)", "rms (cm)", "without suspects", "rms (cm)", "in the C"):
            shown.add_column(heading, justify="left" if heading == "sonar" else "right")
        for one in found:
            without = one.without
            in_c = procedure.FIRMWARE.get(one.sonar)
            shown.add_row(
                escape(one.sonar), f"{one.line.slope_cm:.4f}", f"{one.line.offset_cm:.4f}", f"{one.line.rms_cm:.2f}",
                f"{without.slope_cm:.4f} {without.offset_cm:.4f}" if without else "",
                f"{without.rms_cm:.2f}" if without else "", f"{in_c[0]} {in_c[1]}" if in_c else "",
            )  # fmt: skip
        console.print(shown)
        for one in found:
            for suspect in one.suspects:
                console.print(
                    f"  line {suspect.line}: {escape(one.sonar)} {suspect.raw:g} at {suspect.distance_cm:g} cm is "
                    f"{abs(suspect.off_cm):.1f} cm too {'far' if suspect.off_cm > 0 else 'near'}"
                )
        for one in found:
            console.print(escape(one.sentence()))


calibrate.__doc__ = f"{calibrate.__doc__}\n\n{EXAMPLES}"


def _write(path: Path, table: Table) -> None:
    with replacing(path) as new:
        new.write_text(table.text(), encoding="utf-8")
