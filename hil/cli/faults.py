"""``hil faults``: what can break on purpose; and the option ``--fault`` of the commands that run something."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape
from rich.table import Table

from hil.cli import show

if TYPE_CHECKING:
    from hil.faults import Parameter
    from hil.machine import Machine

#: The option of all commands that make a machine.
Fault = Annotated[
    list[str] | None,
    typer.Option(
        metavar="KIND[:NAME=VALUE,...]", help="Something that breaks (hil faults): gyro-reset:at=2; repeatable."
    ),
]


def checked_faults(texts: Sequence[str] | None) -> tuple[str, ...]:
    """Faults as they were declared, with names and values checked.  Raises ValueError."""
    if not texts:
        return ()
    from hil.faults import parse

    return tuple(str(parse(text)) for text in texts)


def watched(texts: Sequence[str]) -> bool:
    """Whether who meets one of them is known only of a watched image."""
    if not texts:
        return False
    from hil.faults import parse

    return any(parse(text).kind.watch for text in texts)


def complain_of_silent(machine: Machine) -> bool:
    """Complain of each fault that never fired; whether there was one."""
    silent = [mounted.fault for mounted in getattr(machine, "faults", ()) if not mounted.count]
    for fault in silent:
        show.complain(f"the fault {fault} never fired")
    return bool(silent)


def faults(
    name: Annotated[str | None, typer.Argument(metavar="[KIND]", help="Only this one, with what each parameter is.")]
    = None,
    json_output: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
) -> None:
    """List what can break on purpose: kinds of faults, parameters, units, defaults.

    [bold]Examples[/bold]

      hil faults

      hil faults encoder-edge-lost

      hil run --no-port --pace max --for 8 --order 1:mission --fault encoder-edge-lost:side=left,rate=0.1,at=2

    A fault that never fired fails the run which declared it.
    """
    with show.user_errors():
        from hil.faults import FAULTS

        if name is not None and name not in FAULTS:
            raise ValueError(f"no fault {name!r}: there are {', '.join(FAULTS)}")
        kinds = [kind for kind in FAULTS.values() if name in (None, kind.name)]
        if json_output:
            show.print_json({"faults": [kind.as_dict() for kind in kinds]})
            return
        if name is not None:
            (kind,) = kinds
            table = Table(title=escape(f"{kind.name}: {kind.sentence} Needs {kind.needs}."), title_justify="left")
            for heading in ("parameter", "unit", "default", "range", "what"):
                table.add_column(heading)
            for each in kind.parameters:
                table.add_row(*map(escape, (each.name, each.unit, _default(each), each.range, each.what)))
            show.console().print(table)
            return
        from hil.faults.kinds import COMMON

        table = Table(title="What can break on purpose", title_justify="left")
        for heading in ("fault", "what", "parameters", "needs"):
            table.add_column(heading)
        for kind in kinds:
            own = ", ".join(_said(each) for each in kind.parameters if each not in COMMON)
            table.add_row(*map(escape, (kind.name, kind.sentence, own, kind.needs)))
        show.console().print(table)
        show.say(f"Each has besides: {', '.join(_said(each) for each in COMMON)}.")


def _default(parameter: Parameter) -> str:
    default = parameter.default
    if default is None:
        return "must be given"
    return f"{default:g}" if isinstance(default, float) else str(default)


def _said(parameter: Parameter) -> str:
    """`rate=0.05`, `over=1 s`, `input=...`."""
    default = "..." if parameter.default in (None, "") else _default(parameter)
    return f"{parameter.name}={default}{f' {parameter.unit}' if parameter.unit else ''}"
