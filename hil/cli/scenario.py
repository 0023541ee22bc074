"""``hil scenario``: scenario files, run and judged."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn
from rich.table import Table

from hil.cli import show
from hil.files import at_last, check_target
from hil.reports.json_report import findings_of
from hil.reports.model import Report, merged_by, report_of

if TYPE_CHECKING:
    from hil.scenarios.running import ScenarioOutcome

EXAMPLES: Final = """
[bold]Examples[/bold]
  hil scenario lab.scenario.toml
  hil scenario scenarios --junit scenarios.xml -j 2
  hil scenario --shipped
  hil scenario --schema > scenario.schema.json

[bold]Exit status[/bold]
  0  every expectation is met
  1  an expectation is not met
  2  bad input

  A file with faithful_fails is run twice: with its corrections, where everything must come true, and without those of
  its defects (without any if it names none), where exactly those must not.  A file may name a script in Python, which
  is run.
"""


def scenario(
    files: Annotated[
        list[Path] | None, typer.Argument(metavar="[FILE...]", help="Scenario files, or folders with *.scenario.toml.")
    ] = None,
    shipped: Annotated[bool, typer.Option("--shipped", help="Run the scenarios that come with the tool.")] = False,
    jobs: Annotated[int, typer.Option("-j", "--jobs", min=1, max=64, help="Run this many in parallel.")] = 1,
    junit: Annotated[Path | None, typer.Option(metavar="FILE", help="Write JUnit XML.")] = None,
    schema: Annotated[bool, typer.Option("--schema", help="Print the JSON schema of scenario files.")] = False,
    keys: Annotated[bool, typer.Option("--keys", help="Print the table of keys as Markdown.")] = False,
    json_output: Annotated[
        bool, typer.Option("--json", help="Print the results as one JSON object on stdout.")
    ] = False,
) -> None:
    """Run scenario files: a robot, a world, orders, and the expected results."""
    with show.user_errors(), at_last() as writes:
        from hil.scenarios import keys as table
        from hil.scenarios import running
        from hil.scenarios.junit import write_junit

        if schema or keys:
            print(json.dumps(table.schema(), indent=2) if schema else table.page())
            return
        paths = [*(running.shipped() if shipped else ()), *_of(files or [])]
        if not paths:
            raise ValueError("no scenario given: give FILE..., or --shipped")
        if junit is not None:
            check_target(junit)
        show.policy()
        _readable(paths)
        outcomes = _run(paths, jobs, quiet=json_output)
        if junit is not None:
            writes.append(partial(write_junit, junit, outcomes))
        if json_output:
            show.print_json({
                "scenarios": [outcome.as_dict() for outcome in outcomes], "findings": findings_of(_report(outcomes))
            })  # fmt: skip
        else:
            _print(outcomes)
    if not all(outcome.passed for outcome in outcomes):
        raise typer.Exit(show.EXIT_FAILED)


def _of(files: list[Path]) -> list[Path]:
    from hil.scenarios.running import SUFFIX

    found = []
    for file in files:
        if file.is_dir():
            inside = sorted(file.glob(f"*{SUFFIX}"))
            if not inside:
                raise ValueError(f"{file}: no *{SUFFIX} in this folder")
            found += inside
        else:
            found.append(file)
    return found


def _readable(paths: list[Path]) -> None:
    """Read all files before the first one runs.  Raises ValueError for a wrong one."""
    from hil.reports.policy import Policy
    from hil.scenarios.scenario import load_scenario

    for path in paths:
        load_scenario(path, Policy())


def _run(paths: list[Path], jobs: int, *, quiet: bool) -> list[ScenarioOutcome]:
    from hil.scenarios.running import run_files

    terminal = show.console()
    bar = Progress(
        TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed:.0f} of {task.total:.0f}"),
        console=terminal, transient=True, disable=quiet or not terminal.is_terminal,
    )  # fmt: skip
    with bar:
        task = bar.add_task("scenarios", total=len(paths))
        return list(run_files(
            paths, jobs=jobs, on_file=lambda _index: bar.advance(task, 1),
            progress=lambda index, fraction: bar.update(task, description=paths[index].name, completed=index + fraction)
            if fraction < 1.0 else None,
        ))  # fmt: skip


def _report(outcomes: list[ScenarioOutcome]) -> Report:
    """What was found, and in which scenarios."""
    # Of the first legs: what the second ones find is what they are there for.
    found = merged_by((outcome.name, finding) for outcome in outcomes for finding in outcome.legs[0].findings)
    return report_of([finding for finding, _ in found], "scenarios", [names for _, names in found])


def _print(outcomes: list[ScenarioOutcome]) -> None:
    show.print_report(_report(outcomes))
    terminal = show.console()
    table = Table(title=f"Scenarios: {len(outcomes)}", title_justify="left")
    for heading in ("scenario", "thesis", "run", "expectation", "", "seen"):
        table.add_column(heading, overflow="fold")
    for outcome in outcomes:
        for place, leg in enumerate(outcome.legs):
            which = f"without {', '.join(outcome.defects) or 'corrections'}" if place else \
                ", ".join(leg.fixes) or "as it is"  # fmt: skip
            if leg.stopped:
                table.add_row(escape(outcome.name), escape(outcome.thesis), which, "runs on", "no", escape(leg.stopped))
            for check in leg.checks:
                wanted = not (place and check.name in outcome.faithful_fails)
                verdict = ("true" if wanted else "fails, as it must") if check.ok is wanted else "FALSE" \
                    if wanted else "TRUE, must fail"  # fmt: skip
                table.add_row(
                    escape(outcome.name), escape(outcome.thesis), which, escape(check.name), verdict, escape(check.seen)
                )
    terminal.print(table)
    for outcome in outcomes:
        for failure in outcome.failures:
            show.print_line(f"{outcome.name}: {failure}")
    passed = sum(outcome.passed for outcome in outcomes)
    show.print_line(f"{passed} of {len(outcomes)} scenarios gave what their files expect")


scenario.__doc__ = f"{scenario.__doc__}\n\n{EXAMPLES}"
