"""``hil build``: compile the emulator for speed, or remove what was compiled."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from emulator.compiled import ROOT, STORE
from hil import build as builder
from hil.cli import show
from hil.cli.show import UserError, user_errors


def build(
    clean: Annotated[bool, typer.Option("--clean", help="Remove the compiled build. Plain Python runs again.")] = False,
    why: Annotated[
        bool, typer.Option("--why", help="Build nothing: list the functions that stay interpreted, and why.")
    ] = False,
    firmware: Annotated[
        list[Path] | None,
        typer.Option("--firmware", metavar="DIR", help="Compile the robot with your C files too; repeatable."),
    ] = None,
    wheel: Annotated[
        Path | None,
        typer.Option(
            "--wheel",
            metavar="FOLDER",
            show_default=False,
            file_okay=False,
            help="Build nothing: put a wheel with the build into this folder, for computers without a C compiler.",
        ),
    ] = None,
    json_output: Annotated[bool, typer.Option("--json", help="With --why: print one JSON object on stdout.")] = False,
) -> None:
    """Compile the emulator: the same results, about five times as fast.  It needs a C compiler and some minutes.

    A build belongs to the sources that it was made from.  When one of them changes, plain Python runs until the next
    [bold]hil build[/bold].  Of firmware, the files that have changed are compiled alone, in some seconds.

    [bold]Examples[/bold]
      hil build
      hil build --firmware my_robot
      hil build && hil build --wheel dist
      hil build --clean
      hil build --why | grep Read_Distance
    """
    if clean and why:
        raise UserError("--clean removes a build, --why builds none: give one of them")
    if firmware and (clean or why):
        raise UserError("--firmware compiles; --clean and --why do not: give one of them")
    if wheel is not None and (firmware or clean or why):
        raise UserError("--wheel takes the build that is there: give it alone")
    if json_output and not why:
        raise UserError("--json needs --why")
    with user_errors():
        if why:
            _why(json_output=json_output)
        elif wheel is not None:
            with show.busy("making the wheel"):
                made = builder.wheel(wheel)
            print(made)
        elif clean:
            print("removed" if builder.clean() else "there was no compiled build")
        else:
            modules = _build(firmware or [])
            if modules:
                print(f"{modules} modules compiled into {STORE}" if modules > 1 else f"1 module compiled into {STORE}")
            else:
                print(f"nothing to compile: {STORE} has it all")


def _why(*, json_output: bool) -> None:
    """What stays interpreted: a heading for each reason, a line for each source."""
    from firmware_model.image import link
    from hil.robot.board import RobotBoard

    with show.busy("linking the firmware", quiet=json_output):
        stays = builder.interpreted(link(RobotBoard()).linked.program.modules.values())
    compiled = len([name for source in builder.listed() for name in builder.functions_of(ROOT / source)])
    if json_output:
        show.print_json({"compiled": compiled, "interpreted": [asdict(each) for each in stays]})
        return
    for reason in (*builder.STAYS, builder.FIRMWARE_STAYS):
        print(f"{reason}:")
        for each in (each for each in stays if each.reason == reason):
            print(f"  {each.file}: {', '.join(each.functions)}")
        print()
    print(f"{sum(len(each.functions) for each in stays)} functions stay interpreted, {compiled} are compiled")


def _build(own: list[Path]) -> int:
    """The number of modules, with a progress bar in a terminal."""
    terminal = show.console()
    bar = Progress(
        TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), console=terminal, transient=True,
        disable=not terminal.is_terminal,
    )  # fmt: skip
    with bar:
        task = bar.add_task("translating", total=1.0)
        return builder.build(own, progress=lambda done: bar.update(task, completed=done, description="compiling"))
