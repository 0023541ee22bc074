"""``hil diff``: the port and somebody's own C of the same functions, compared."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn
from rich.table import Table

from emulator.clock import us
from hil.cli import own_c, show

if TYPE_CHECKING:
    from collections.abc import Sequence

    from hil.diff.compare import Result
    from hil.diff.difference import Difference


def diff(
    firmware: Annotated[
        list[Path], typer.Argument(metavar="DIR...", help="Your C files with the robot's file names: folders or files.")
    ],
    project: own_c.Project = None,
    include: own_c.Include = None,
    define: own_c.Define = None,
    cycles: Annotated[bool, typer.Option("--cycles", help="Also compare cycles.")] = False,
    for_s: Annotated[
        float, typer.Option("--for", metavar="SECONDS", min=0.001, help="Run this much virtual time after start-up.")
    ] = 5.0,
    order: show.OrdersOrMission = None,
    calls: Annotated[
        int, typer.Option(min=1, max=10_000, help="Call each function that differs with this many generated inputs.")
    ] = 30,
    world: show.World = "corridor",
    seed: show.Seed = 1,
    fill: Annotated[
        str, typer.Option(help="The content of uninitialised memory: zero, ones, nan, random:SEED, stack, trap.")
    ] = "zero",
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Compare your C with the ported firmware: syntax trees, calls of functions that differ, runs of the robot.

    Functions with equal trees do the same with every input.  The others are called with generated arguments on both
    sides.  Then the robot runs on both; what each thread does is compared by order and payload, cycles are reported.

    [bold]Examples[/bold]
      hil diff my_robot
      hil diff my_robot -I include -D LAB=3 --for 20

    [bold]Exit status[/bold]
      0  equal in what a program can observe
      1  different
      2  bad input
    """
    with show.user_errors():
        from firmware_model.c_files import own
        from hil.diff.compare import ComparisonOptions, compare_firmware

        show.policy()
        for file in own(firmware).left_out:
            show.print_line(f"note: {file}: no file of the robot, left out", to_stderr=True)
        folders, defines = own_c.read_as(firmware, project, include, define)
        wanted = ComparisonOptions(
            [str(path) for path in firmware], folders, defines, world=world, seed=seed, fill=fill, calls=calls,
            seconds=for_s, orders=tuple(order) if order else ("mission",), cycles=cycles,
        )  # fmt: skip
        terminal = show.console()
        with Progress(
            TextColumn("{task.description}"), BarColumn(), console=terminal, transient=True,
            disable=json_output or not terminal.is_terminal,
        ) as bar:  # fmt: skip
            task = bar.add_task("translate", total=1.0)
            result = compare_firmware(wanted, lambda what, part: bar.update(task, description=what, completed=part))
    if json_output:
        show.print_json(result.as_dict())
    else:
        _print(result, terminal)
    if result.different:
        raise typer.Exit(show.EXIT_FAILED)


def _print(result: Result, terminal: Console) -> None:
    trees, runs = result.trees, result.runs
    total = len(trees.equal) + len(trees.functions)
    show.print_line(f"trees: {len(trees.equal)} of {total} functions are equal")
    if trees.differences:
        terminal.print(_table(trees.differences, "function"))
    for path, called in result.calls.items():
        told = f"{called.calls} calls of both, {_number(len(called.differences))}"
        show.print_line(f"calls: {path}: {f'not called: {called.reason}' if called.reason else told}")
    observed = [d for called in result.calls.values() for d in called.differences]
    if observed:
        terminal.print(_table(observed, "function"))
    if runs is not None:
        alike = sum(runs.streams.alike.values())
        show.print_line(
            f"runs: {runs.seconds:g} s after start-up: {alike} events alike in {len(runs.streams.alike)} streams, "
            f"{_number(len(runs.differences))}"
        )
        if runs.differences:
            terminal.print(_table(runs.differences, "thread"))
        for which, known in (("first", runs.streams.skew.first), ("largest", runs.streams.skew.largest)):
            if known is not None:
                apart, thread, place = known
                show.print_line(f"cycles: {which} skew {apart:+d} ({us(apart):+.3f} us) in {thread}, {place}")
    show.print_report(result.report)
    show.print_line(result.verdict)


def _number(differences: int) -> str:
    return "no difference" if not differences else f"{differences} difference{'s' if differences > 1 else ''}"


def _table(differences: Sequence[Difference], what: str) -> Table:
    table = Table()
    for heading in (what, "the port", "the C", "cause"):
        table.add_column(heading, overflow="fold")
    for difference in differences:
        table.add_row(
            escape(difference.what), escape(difference.port), escape(difference.own), escape(difference.cause)
        )
    return table
