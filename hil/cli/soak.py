"""``hil soak``: hours of virtual time with faults and orders at random."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn
from rich.table import Table

from hil.cli import show
from hil.ending import EXIT_INTERRUPTED

if TYPE_CHECKING:
    from hil.scenarios.soak import SoakResult

EXAMPLES: Final = """
[bold]Examples[/bold]
  hil soak
  hil soak --for 3600 --seed 7
  hil soak --faithful --json > soak.json

[bold]Exit status[/bold]
  0  the run is complete
  2  bad input
  130  interrupted

  The same options give the same digests.
"""


def soak(
    for_s: Annotated[
        float, typer.Option("--for", metavar="SECONDS", min=1, max=1e6, help="Run this much virtual time.")
    ] = 600,
    seed: show.Seed = 1,
    world: Annotated[
        str, typer.Option(help="The robot's environment: corridor, room, box, paddock, or a TOML map.")
    ] = "paddock",
    faithful: Annotated[bool, typer.Option("--faithful", help="Run the original firmware, without corrections.")]
    = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Let the robot drive for hours, inject a random fault every few seconds, and count the effects."""
    with show.user_errors():
        from hil.scenarios.soak import soak as run

        show.policy()
        terminal = show.console()
        bar = Progress(
            TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed:.0f} of {task.total:.0f} s"),
            console=terminal, transient=True, disable=json_output or not terminal.is_terminal,
        )  # fmt: skip
        with bar:
            task = bar.add_task("soak", total=for_s)

            def on_progress(soaked: SoakResult) -> None:
                bar.update(task, completed=soaked.seconds, description=f"{sum(soaked.mounted.values())} faults")

            soaked = run(for_s, seed=seed, fixes=() if faithful else ("all",), world=world, on_progress=on_progress)
        if json_output:
            show.print_json(soaked.as_dict())
        else:
            _print(soaked)
    if soaked.interrupted:
        raise typer.Exit(EXIT_INTERRUPTED)


def _print(soaked: SoakResult) -> None:
    terminal = show.console()
    table = Table(title="Faults", title_justify="left")
    for heading, justify in (("kind", "left"), ("so often", "right"), ("fired", "right"), ("met", "right")):
        table.add_column(heading, justify=justify)  # type: ignore[arg-type]
    for kind, count in sorted(soaked.mounted.items()):
        table.add_row(kind, str(count), str(soaked.fired[kind]), str(soaked.met[kind]))
    terminal.print(table)
    show.print_findings(soaked.findings)
    for what, why in (("the firmware ended", soaked.ended), ("the robot did not come back", soaked.stranded)):
        for one in why:
            show.print_line(f"{escape(one)}: {what}; switched off and on")
    show.print_line(
        f"{soaked.seconds:.0f} virtual s, {soaked.travelled_m:.0f} m, {soaked.collisions} collisions, "
        f"{soaked.orders} orders, {soaked.frames} frames, switched on {soaked.switched_on} times"
    )
    if soaked.objects:
        (begin_s, first), (end_s, last) = soaked.objects[0], soaked.objects[-1]
        most = max(count for _, count in soaked.objects)
        show.print_line(f"objects of Python: {first} at {begin_s:.0f} s, {last} at {end_s:.0f} s, at most {most}")
    show.print_line(f"uart {soaked.uart_sha256}")
    show.print_line(f"trace {soaked.trace_sha256}")


soak.__doc__ = f"{soak.__doc__}\n\n{EXAMPLES}"
