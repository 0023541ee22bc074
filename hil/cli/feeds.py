"""The option ``--feed`` of the commands that run something."""

from __future__ import annotations

from typing import Annotated

import typer

#: The option of all commands that make a machine.
Feed = Annotated[
    list[str] | None,
    typer.Option(
        metavar="[INPUT=]SOURCE",
        help="Replace sensor inputs: a trace, a CSV file, INPUT=NUMBER (hil docs feeds); repeatable.",
    ),
]
