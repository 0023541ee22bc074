"""``hil build``: compile the emulator for speed, or remove what was compiled."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from emulator.compiled import STORE
from hil import build as builder
from hil.cli import show
from hil.cli.show import user_errors


def build(
    clean: Annotated[bool, typer.Option("--clean", help="Remove the compiled build. Plain Python runs again.")] = False,
) -> None:
    """Compile the emulator: the same results, two to three times as fast.  It needs a C compiler and a minute or two.

    A build belongs to the sources that it was made from.  When one of them changes, plain Python runs until the next
    [bold]hil build[/bold].

    [bold]Examples[/bold]
      hil build
      hil build --clean
    """
    with user_errors():
        if clean:
            print("removed" if builder.clean() else "there was no compiled build")
        else:
            print(f"{_build()} modules compiled into {STORE}")


def _build() -> int:
    """The number of modules, with a progress bar in a terminal."""
    terminal = show.console()
    bar = Progress(
        TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), console=terminal, transient=True,
        disable=not terminal.is_terminal,
    )  # fmt: skip
    with bar:
        task = bar.add_task("translating", total=1.0)
        return builder.build(progress=lambda done: bar.update(task, completed=done, description="compiling"))
