"""``hil build``: compile the emulator for speed, or remove what was compiled."""

from __future__ import annotations

from typing import Annotated

import typer

from emulator.compiled import STORE
from hil import build as builder
from hil.cli.show import user_errors


def build(
    clean: Annotated[bool, typer.Option("--clean", help="Remove the compiled build: plain Python again.")] = False,
) -> None:
    """Compile the emulator: the same bytes, two to three times as fast.  Wants a C compiler; takes two minutes.

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
            print(f"{builder.build()} modules compiled into {STORE}")
