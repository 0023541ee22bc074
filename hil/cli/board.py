"""``hil board``: the parts of a board, their pins, and what the world does to them."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.markup import escape
from rich.table import Table

from hil.cli import show

#: The option of all commands that make a board.
Option = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME,...",
        help="Add parts to the robot: five-sonars, accelerometer, lidar; repeatable.",
    ),
]


def board(
    name: Annotated[
        str,
        typer.Argument(metavar="[NAME|FILE]", help="The board: robot (default), bare, or a file of your own (*.py)."),
    ] = "robot",
    option: Option = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Show the parts on a board, their pins, and the inputs that a test or the world sets.

    [bold]Examples[/bold]
      hil board
      hil board --option five-sonars,accelerometer,lidar
      hil board my_board.py --json
    """
    with show.user_errors():
        from hil.board import load, made, optional
        from hil.robot.options.names import checked

        kind = load(name)
        parts = made(kind, **optional(kind, checked(option or ()))).parts.values()
        if json_output:
            show.print_json({
                "board": kind.__name__,
                "parts": [
                    {
                        "name": part.name, "kind": part.kind, "pins": part.pins,
                        "faces": [
                            {"name": face.name, "unit": face.unit, "low": face.low, "high": face.high}
                            for face in part.faces
                        ],
                    }
                    for part in parts
                ],
            })  # fmt: skip
            return
        table = Table(title=kind.__name__, title_justify="left")
        for heading in ("part", "what", "pins", "set from outside"):
            table.add_column(heading)
        for part in parts:
            pins = ", ".join(f"{signal} {pin}" for signal, pin in part.pins.items())
            faces = ", ".join(f"{face.name} ({face.unit})" for face in part.faces)
            table.add_row(*map(escape, (part.name, part.kind, pins, faces)))
        show.console().print(table)
