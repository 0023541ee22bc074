"""The option ``--feed`` of the commands that run something."""

from __future__ import annotations

from typing import Annotated

import typer

#: The option of all commands that make a machine.
Feed = Annotated[
    list[str] | None,
    typer.Option(
        metavar="[INPUT=]SOURCE",
        help="What sensors see instead of the physics: a trace, a CSV, INPUT=NUMBER (hil docs feeds); repeatable.",
    ),
]
