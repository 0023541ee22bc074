"""``hil audit``: demonstrates each known defect in the original firmware, and that its correction removes it."""

from __future__ import annotations

import difflib
import os
from collections import Counter
from contextlib import closing, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.markup import escape
from rich.panel import Panel
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from emulator.rules import RULES
from hil.cli import own_c, show
from hil.ending import EXIT_INTERRUPTED
from hil.reports.excerpt import shown

if TYPE_CHECKING:
    from hil.audit.evidence import Evidence
    from hil.audit.run import DemonstrationOutcome

EXAMPLES: Final = """
[bold]Examples[/bold]
  hil audit
  hil audit US-accumulator --plot accumulator.png
  hil audit --file GYRO.c --json
  hil audit --firmware my_robot   (your us.c, GYRO.c, ... of that folder)
  hil audit --compare

[bold]Exit status[/bold]
  0  every entry is demonstrated
  1  an entry is not demonstrated
  2  bad input
  130  interrupted
"""


def complete_id(incomplete: str) -> list[tuple[str, str]]:
    """Ids of the catalogue for the shell."""
    from firmware_model.catalogue import CATALOGUE

    return [(d.id, d.where) for d in CATALOGUE.values() if d.id.startswith(incomplete)]


def audit(
    ids: Annotated[
        list[str] | None, typer.Argument(metavar="[ID]...", help="The entries to demonstrate (default: all).",
                                         autocompletion=complete_id),
    ] = None,
    c_file: Annotated[
        str | None, typer.Option("--file", metavar="NAME", help="Select the entries of one C file: us.c, GYRO.c, ...")
    ] = None,
    compare: Annotated[
        bool, typer.Option("--compare", help="Compare with host tools: which tool finds which class of defect.")
    ] = False,
    markdown: Annotated[
        bool, typer.Option("--markdown", help="With --compare, print the table as Markdown.")
    ] = False,
    only_list: Annotated[bool, typer.Option("--list", help="List the entries and run nothing.")] = False,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the evidence of one entry.")] = None,
    all_but_one: Annotated[
        bool, typer.Option("--all-but-one", help="Also run each entry without its own correction (twice as long).")
    ] = False,
    jobs: Annotated[int, typer.Option(min=1, max=1024, help="Run this many in parallel.")] = os.cpu_count() or 1,
    firmware: own_c.Firmware = None,
    project: own_c.Project = None,
    include: own_c.Include = None,
    define: own_c.Define = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:  # fmt: skip
    """Demonstrate the known defects: original firmware, one correction, all corrections.

    A detector's finding or a measured property must show the defect in the original firmware, and must not show it with
    the correction.  Entries about numbers of the text are only read.  With --all-but-one, the defect must show again
    when only its own correction is missing.
    """
    with show.user_errors():
        if markdown and (json_output or not compare):
            raise ValueError("--markdown is a form of --compare, instead of --json")
        if compare:
            if firmware:
                raise ValueError("--compare is about classes of defects, not about --firmware")
            if ids or c_file or plot:
                raise ValueError("--compare takes no entries: it is about classes of defects")
            from hil.cli.compare_tools import compare_tools

            compare_tools(json_output=json_output, markdown=markdown)
            return
        names = _chosen(ids or [], c_file)
        if only_list:
            if plot or firmware:
                raise ValueError("--list runs nothing: it takes no --plot and no --firmware")
            _print_list(names, json_output=json_output)
            return
        if plot is not None:
            from hil.audit.picture import save_picture
            from hil.client.plot import check_plot_file

            if len(names) != 1:
                raise ValueError("--plot needs one entry: hil audit ID --plot FILE")
            check_plot_file(plot)
        own = own_c.own_c(firmware, project, include, define)
        outcomes = _run(names, jobs, own, but_one=all_but_one, quiet=json_output)
    interrupted = len(outcomes) < len(names)
    if json_output:
        entries = [outcome.as_dict() for outcome in outcomes]
        show.print_json({"entries": entries, "proven": sum(o.proven for o in outcomes), "of": len(outcomes),
                         "by": _by_kind(outcomes), "interrupted": interrupted})
    elif ids and len(outcomes) <= 5:
        for outcome in outcomes:
            show.console().print(_page(outcome))
    else:
        _print_table(outcomes)
    for outcome in outcomes:
        if outcome.error:
            show.print_line(f"{outcome.id}: {outcome.error}", to_stderr=True)
    if plot is not None and outcomes:
        with show.user_errors():
            save_picture(outcomes[0], plot)
    if interrupted:
        show.print_line(f"{len(names) - len(outcomes)} of {len(names)} entries were not examined", to_stderr=True)
        raise typer.Exit(EXIT_INTERRUPTED)
    if not all(outcome.shown for outcome in outcomes):
        raise typer.Exit(show.EXIT_FAILED)


audit.__doc__ = f"{audit.__doc__}\n\n{EXAMPLES}"


def _chosen(ids: list[str], c_file: str | None) -> list[str]:
    from firmware_model.catalogue import CATALOGUE

    for name in ids:
        if name not in CATALOGUE:
            near = difflib.get_close_matches(name, list(CATALOGUE), 3, 0.4)
            hint = f"did you mean {', '.join(near)}?" if near else "`hil audit` lists them"
            raise ValueError(f"the catalogue has no entry {name!r}: {hint}")
    names = ids or list(CATALOGUE)
    if c_file is not None:
        files = sorted({defect.c_file for defect in CATALOGUE.values()})
        if c_file not in files:
            raise ValueError(f"the catalogue has no entries of {c_file!r}: it has {', '.join(files)}")
        names = [name for name in names if CATALOGUE[name].c_file == c_file]
    return names


def _run(names: list[str], jobs: int, own: own_c.OwnC, *, but_one: bool, quiet: bool) -> list[DemonstrationOutcome]:
    """The outcomes in the order of `names`, with a progress bar in a terminal; after Ctrl-C those that are there."""
    from hil.audit.rig import Variant
    from hil.audit.run import audit as demonstrated

    bar = Progress(
        TextColumn("audit"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("{task.description}"),
        console=show.console(), transient=True, disable=quiet, auto_refresh=False,  # a thread: it would prevent forks
    )  # fmt: skip
    done: dict[str, DemonstrationOutcome] = {}
    at_once, variant = min(jobs, len(names)), Variant(**own.as_dict())
    with bar, closing(demonstrated(names, processes=at_once, own=variant, but_one=but_one)) as running:
        task = bar.add_task("", total=len(names))
        with suppress(KeyboardInterrupt):
            for outcome in running:
                done[outcome.id] = outcome
                bar.update(task, advance=1, description=outcome.id, refresh=True)
    return [done[name] for name in names if name in done]


def _mark(evidence: Evidence | None) -> str:
    if evidence is None:
        return "[red]?[/red]"
    return "seen" if evidence.seen else "-"


def _print_list(names: list[str], *, json_output: bool) -> None:
    """What the catalogue says of the entries, a line each."""
    from firmware_model.catalogue import CATALOGUE

    defects = [CATALOGUE[name] for name in names]
    if json_output:
        show.print_json({"entries": [defect.as_dict() for defect in defects]})
        return
    for d in defects:
        section = "" if d.section in d.where else f"  {d.section}"
        depends = f"  depends on {d.depends_on}" if d.depends_on else ""
        show.print_line(f"{d.id}  {d.where}{section}  {d.severity.value}{depends}")


def _print_table(outcomes: list[DemonstrationOutcome]) -> None:
    table = Table(title=f"Catalogue: {len(outcomes)} entries", title_justify="left")
    but_one = any(outcome.all_but_one for outcome in outcomes)
    legs = ("faithful", "corrected", "all", *(("all but it",) if but_one else ()))
    for heading in ("id", "severity", "where", "rule", *legs, "what the demonstration saw"):
        table.add_column(heading, overflow="fold", no_wrap=heading == "id")
    for outcome in outcomes:
        d = outcome.defect
        line = outcome.error or (outcome.faithful.line if outcome.faithful else "")
        table.add_row(
            d.id, d.severity.value, escape(d.where), d.rule, _mark(outcome.faithful), _mark(outcome.corrected),
            _mark(outcome.all_corrected), *((_mark(outcome.all_but_one),) if but_one else ()), escape(line),
            style=None if outcome.shown else "red",
        )  # fmt: skip
    console = show.console()
    console.print(table)
    by, proven = _by_kind(outcomes), sum(outcome.proven for outcome in outcomes)
    console.print(
        f"{proven} of {len(outcomes)} proven, {by['detector']} by a detector's finding, {by['property']} by a measured "
        f"property; {by['read']} only read"
    )


def _by_kind(outcomes: list[DemonstrationOutcome]) -> dict[str, int]:
    """How many are shown by each kind of evidence."""
    from hil.audit.evidence import EvidenceKind

    kinds = Counter(outcome.faithful.by for outcome in outcomes if outcome.shown and outcome.faithful)
    return {by.value: kinds[by] for by in EvidenceKind}


def _page(outcome: DemonstrationOutcome) -> Panel:
    d = outcome.defect
    table = Table.grid(padding=(0, 2))
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    rule = RULES.get(d.rule)
    rows = [
        ("where", f"{d.where}: {d.place}"), ("thesis", d.section), ("severity", d.severity.value),
        ("depends on", d.depends_on or "nothing: it follows from the sources"), ("wrong", d.wrong),
        ("because", d.source), ("on the robot", d.symptom),
        ("seen by", f"{d.rule}{f' ({rule.how}): {rule.title}' if rule else ''}"), ("correction", d.correction),
    ]  # fmt: skip
    if d.covered_by:
        rows.append(("also gone with", ", ".join(d.covered_by)))
    for name, evidence in (
        ("faithful", outcome.faithful), ("corrected", outcome.corrected), ("all corrected", outcome.all_corrected),
        ("all but it", outcome.all_but_one),
    ):  # fmt: skip
        if evidence is not None:
            rows.append((name, f"{'seen' if evidence.seen else 'not seen'} ({evidence.by.value}): {evidence.line}"))
            for finding in evidence.findings[:5]:
                where = shown(finding.place) if finding.place else finding.object
                when = f"{finding.time_us / 1e3:.3f} ms, {finding.count} times"
                rows.append(("", f"{where}, task {finding.task}, {when}"))
    if outcome.error:
        rows.append(("error", outcome.error))
    for name, text in rows:
        table.add_row(name, escape(text))
    return Panel(table, title=d.id, title_align="left", border_style="green" if outcome.shown else "red")
