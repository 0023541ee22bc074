"""``hil campaign``: short runs with random worlds, faults and orders, and what every run must satisfy."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.progress import BarColumn, Progress, TextColumn

from hil.cli import show
from hil.ending import EXIT_INTERRUPTED

if TYPE_CHECKING:
    from hil.safety.campaign import FailedRun

EXAMPLES: Final = """
[bold]Examples[/bold]
  hil campaign
  hil campaign --runs 50 --faithful --keep failed
  hil scenario failed/campaign-1-2.scenario.toml

[bold]Exit status[/bold]
  0  every run passed
  1  a run failed
  2  bad input
  130  interrupted

  The same seed gives the same runs.
"""


def campaign(
    runs: Annotated[int, typer.Option(min=1, max=1_000_000, help="Number of runs.")] = 1000,
    seed: show.Seed = 1,
    jobs: Annotated[int, typer.Option("-j", "--jobs", min=1, max=64, help="Run this many in parallel.")] = 2,
    faithful: Annotated[bool, typer.Option("--faithful", help="Run the original firmware, without corrections.")]
    = False,
    keep: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Write the shortest scenario of each failed run into this folder.")
    ] = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Inject random faults into the corrected robot: it must not drive on data that it can know to be wrong."""
    with show.user_errors():
        from hil.files import replacing
        from hil.reports.json_report import findings_of
        from hil.safety.campaign import campaign as run
        from hil.scenarios.running import SUFFIX

        show.policy()
        if keep is not None:
            keep.mkdir(exist_ok=True)
        terminal = show.console()
        bar = Progress(
            TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed:.0f} of {task.total:.0f} runs"),
            console=terminal, transient=True, disable=json_output or not terminal.is_terminal,
        )  # fmt: skip
        done = wrong = 0
        with bar:
            task = bar.add_task("all held", total=runs)

            def on_run(failed: FailedRun | None) -> None:
                nonlocal done, wrong
                done, wrong = done + 1, wrong + (failed is not None)
                bar.update(task, completed=done, description=f"{wrong} failed" if wrong else "all held")

            found = run(runs, seed=seed, jobs=jobs, faithful=faithful, on_run=on_run)
        files: dict[int, Path] = {}
        unwritten: list[OSError] = []
        for failed in found.failed if keep is not None else ():
            assert keep is not None
            file = keep / f"campaign-{seed}-{failed.number}{SUFFIX}"
            try:
                with replacing(file) as new:
                    new.write_text(failed.text, encoding="utf-8")
                files[failed.number] = file
            except OSError as error:  # what failed is told all the same
                unwritten.append(error)
        if json_output:
            show.print_json({
                "runs": found.runs, "seed": seed, "faithful": faithful, "failed": [
                    {"number": one.number, "broken": list(one.broken), "scenario": one.text} for one in found.failed
                ],
                "findings": findings_of(found.report),
            })  # fmt: skip
        else:
            show.print_report(found.report)
            for one in found.failed:
                where = f", {files[one.number]}" if one.number in files else ""
                show.print_line(f"run {one.number}{where}: {'; '.join(one.broken)}")
            show.print_line(f"{found.runs - len(found.failed)} of {found.runs} runs held, seed {seed}")
        if unwritten:
            more = f" (and {len(unwritten) - 1} more)" if len(unwritten) > 1 else ""
            raise ValueError(f"{unwritten[0].filename}: {unwritten[0].strerror}{more}")
    if found.runs < runs:
        raise typer.Exit(EXIT_INTERRUPTED)
    if found.failed:
        raise typer.Exit(show.EXIT_FAILED)


campaign.__doc__ = f"{campaign.__doc__}\n\n{EXAMPLES}"
