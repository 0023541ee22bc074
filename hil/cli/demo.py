"""``hil demo``: shows a mission, without any choices to make."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Final

import typer

from hil.cli import show
from hil.client.orders import parse_timed_order
from hil.extras import has, hint
from hil.machine import Setup

#: A second to look at the robot before it drives.
MISSION: Final = "1:mission"
#: What is drawn where there is neither a browser nor a terminal.
PICTURE: Final = Path("demo.png")
PICTURE_S: Final = 60.0


def demo(
    world: Annotated[
        str, typer.Option(help="The robot's environment: corridor, room, box, paddock, or a TOML map.")
    ] = "corridor",
    seed: show.Seed = 1,
    terminal: Annotated[
        bool, typer.Option("--terminal", help="Draw in this terminal, even if the extra view is installed.")
    ] = False,
    open_page: show.OpenPage = None,
    view_port: Annotated[int, typer.Option(min=0, max=65535, help="The port of the page; 0: any free port.")] = 0,
) -> None:
    """Watch the robot drive a mission: in the browser with the extra `view`, else in this terminal.

    Space stops the robot, Ctrl-C ends the demo.  Without a terminal the demo writes demo.png.

    [bold]Examples[/bold]
      hil demo
      hil demo --world room --terminal
    """
    with show.user_errors():
        setup = Setup(world=world, seed=seed)
        if has("nicegui") and not terminal:
            from hil.cli.run import view_until_stopped

            print_line = show.print_and_open if show.wants_page(open_page) else show.print_line
            view_until_stopped(
                setup, {}, 1.0, [parse_timed_order(MISSION)], lambda machine: None, "127.0.0.1", view_port, print_line
            )
        elif has("textual") and all(stream.isatty() for stream in (sys.stdin, sys.stdout, sys.stderr)):
            from hil.terminal.run import run_terminal

            summary = run_terminal(None, setup, machine=show.open_machine, first=("mission",))
            show.print_line(summary.line)
            show.print_line("hil console drives it; pip install 'c2000-hil[view]' && hil demo shows it in the browser")
            if summary.failure:
                show.print_error(summary.failure)
                raise typer.Exit(show.EXIT_FAILED)
        elif has("matplotlib"):
            from hil.cli.run import run

            show.print_line(
                f"neither a terminal nor the extra view: {PICTURE_S:.0f} s of a mission, drawn into {PICTURE}"
            )
            run(world=world, seed=seed, no_port=True, pace="max", for_s=PICTURE_S, order=[MISSION], plot=PICTURE)
        else:
            raise ValueError("; ".join(map(hint, ("nicegui", "textual", "matplotlib"))))
