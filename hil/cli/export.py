"""``hil export``: a trace file as a file for another tool."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from hil.cli import show
from hil.files import check_target


def export(
    trace: Annotated[Path | None, typer.Argument(metavar="TRACE", help="A trace file of hil run --trace.")] = None,
    target: Annotated[
        Path | None, typer.Argument(metavar="OUT", help="The file to write. Its suffix selects the format.")
    ] = None,
    channel: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Export only this channel of the trace; repeatable."),
    ] = None,
    channels: Annotated[bool, typer.Option("--channels", help="List the channels and formats.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Convert a trace file: VCD, Perfetto, MCAP, CSV, NumPy, Parquet, text, HTML page.

    [bold]Examples[/bold]
      hil run --no-port --pace max --for 5 --order mission --trace run.trace
      hil export run.trace run.pftrace    (open it in ui.perfetto.dev)
      hil export run.trace run.html       (plays the run again in any browser)
      hil export run.trace run.vcd        (GTKWave)
      hil export run.trace pins.vcd --channel pins   (PulseView)
      hil export --channels
    """
    with show.user_errors():
        from hil.instruments.export import FORMATS, writer_of
        from hil.instruments.export import export as write
        from hil.instruments.trace_file import CHANNELS, read

        if channels:
            if json_output:
                show.print_json({"channels": CHANNELS, "formats": {s: opens for s, (_, opens) in FORMATS.items()}})
                return
            for title, rows in (("channels", CHANNELS), ("formats", {s: opens for s, (_, opens) in FORMATS.items()})):
                table = Table("name", "what", title=title, title_justify="left")
                for name, what in rows.items():
                    table.add_row(name, what)
                show.console().print(table)
            return
        if trace is None or target is None:
            raise show.UserError("give a trace file and a file to write: hil export run.trace run.vcd")
        writer_of(target)
        check_target(target)
        with show.busy(f"reading {trace}", quiet=json_output) as told:
            found = read(trace)
            if channel:
                try:
                    found = found.only(channel)
                except ValueError as error:
                    raise show.UserError(f"{trace}: {error}") from None
            told(f"writing {target}")
            write(found, target)
        if json_output:
            show.print_json({"file": str(target), "events": len(found.events), "channels": list(found.channels)})
        else:
            show.print_line(f"{target}: {len(found.events)} events")
