"""``hil faults``: the faults that can be injected; and the option ``--fault`` of the commands that run something."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape
from rich.table import Table

from hil.cli import show
from hil.ending import EXIT_INTERRUPTED

if TYPE_CHECKING:
    from hil.faults import FaultParameter
    from hil.machine import Machine

#: The option of all commands that make a machine.
Fault = Annotated[
    list[str] | None,
    typer.Option(
        metavar="KIND[:NAME=VALUE,...]", help="Inject a fault (hil faults), such as gyro-reset:at=2; repeatable."
    ),
]


def checked_faults(texts: Sequence[str] | None) -> tuple[str, ...]:
    """Faults as they were declared, with names and values checked.  Raises ValueError."""
    if not texts:
        return ()
    from hil.faults import parse

    return tuple(str(parse(text)) for text in texts)


def watched(texts: Sequence[str]) -> bool:
    """Whether one of them needs a watched image, to know its first access."""
    if not texts:
        return False
    from hil.faults import parse

    return any(parse(text).kind.watch for text in texts)


def report_silent_faults(machine: Machine) -> bool:
    """Print an error for each fault that never fired.  Returns whether there was one."""
    silent = [mounted.fault for mounted in getattr(machine, "faults", ()) if not mounted.count]
    for fault in silent:
        show.print_error(f"the fault {fault} never fired")
    return bool(silent)


def faults(
    name: Annotated[str | None, typer.Argument(metavar="[KIND]", help="Describe one kind and its parameters.")]
    = None,
    table: Annotated[
        bool, typer.Option("--table", help="Measure how the corrected robot reacts to each single fault (a minute).")
    ] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """List the faults that can be injected: kinds, parameters, units, defaults.

    [bold]Examples[/bold]
      hil faults
      hil faults encoder-edge-lost
      hil faults --table
      hil run --order mission --fault encoder-edge-lost:side=left,rate=0.1,at=2

    A run fails if a fault that it declares never fires.
    """
    with show.user_errors():
        from hil.faults import FAULTS

        if name is not None and name not in FAULTS:
            raise ValueError(f"no fault {name!r}: there are {', '.join(FAULTS)}")
        kinds = [kind for kind in FAULTS.values() if name in (None, kind.name)]
        if table:
            _measure(name, json_output=json_output)
            return
        if json_output:
            show.print_json({"faults": [kind.as_dict() for kind in kinds]})
            return
        if name is not None:
            (kind,) = kinds
            one = Table(title=escape(f"{kind.name}: {kind.sentence} Needs {kind.needs}."), title_justify="left")
            for heading in ("parameter", "unit", "default", "range", "what"):
                one.add_column(heading)
            for each in kind.parameters:
                one.add_row(*map(escape, (each.name, each.unit, _default(each), each.range, each.what)))
            show.console().print(one)
            return
        from hil.faults.kinds import COMMON

        listed = Table(title="Faults that can be injected", title_justify="left")
        for heading in ("fault", "what", "parameters", "needs"):
            listed.add_column(heading)
        for kind in kinds:
            own = ", ".join(_parameter_text(each) for each in kind.parameters if each not in COMMON)
            listed.add_row(*map(escape, (kind.name, kind.sentence, own, kind.needs)))
        show.console().print(listed)
        show.print_line(f"Every fault also has: {', '.join(_parameter_text(each) for each in COMMON)}.")


def _measure(name: str | None, *, json_output: bool) -> None:
    """The table of single faults, and the missions where nothing is broken."""
    from rich.progress import BarColumn, Progress, TextColumn

    from hil.safety import single_faults
    from hil.safety.page import MISSION_HEADINGS, ROW_HEADINGS, mission_cells, row_cells

    rows = [row for row in single_faults.ROWS if name in (None, row.fault.partition(":")[0])]
    places = single_faults.places() if name is None else {}
    terminal = show.console()
    bar = Progress(
        TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed} of {task.total} runs"),
        console=terminal, transient=True, disable=json_output or not terminal.is_terminal,
    )  # fmt: skip
    told, missions = [], []
    interrupted = True
    with bar, suppress(KeyboardInterrupt):
        task = bar.add_task("measuring", total=len(rows) + len(places))
        for one in single_faults.table(rows):
            told.append(one)
            bar.advance(task)
        for place, world in places.items():
            missions.append(single_faults.mission(place, world))
            bar.advance(task)
        interrupted = False
    if json_output:
        show.print_json({"faults": [one.as_dict() for one in told], "missions": [one.as_dict() for one in missions]})
    else:
        for title, headings, cells in (
            ("The corrected robot (--fix all) under single faults; times in ms from the fault's begin, or its end",
             ROW_HEADINGS, [row_cells(one) for one in told]),
            ("Its missions where nothing is broken", MISSION_HEADINGS, [mission_cells(one) for one in missions]),
        ):  # fmt: skip
            if cells:
                table = Table(title=title, title_justify="left")
                for heading in headings:
                    table.add_column(heading, overflow="fold")
                for row in cells:
                    table.add_row(*map(escape, row))
                terminal.print(table)
    if interrupted:
        raise typer.Exit(EXIT_INTERRUPTED)


def _default(parameter: FaultParameter) -> str:
    default = parameter.default
    if default is None:
        return "must be given"
    return f"{default:g}" if isinstance(default, float) else str(default)


def _parameter_text(parameter: FaultParameter) -> str:
    """`rate=0.05`, `over=1 s`, `input=...`."""
    default = "..." if parameter.default in (None, "") else _default(parameter)
    return f"{parameter.name}={default}{f' {parameter.unit}' if parameter.unit else ''}"
