"""``hil audit --compare``: specimens of the defect classes through the usual host tools, and through this one."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
from rich.table import Table

from hil.audit.compare.ours import seen
from hil.audit.compare.specimen import SPECIMENS
from hil.audit.compare.table import OURS, VersionComparison
from hil.audit.compare.tools import TOOLS, versions
from hil.cli import show


def compare_tools(*, json_output: bool, markdown: bool) -> None:
    """Print which tool points at the marked line of which specimen.  Tools that are not installed are named."""
    comparison = _compare(quiet=json_output or markdown)
    missing = {tool.name: tool.package for tool in TOOLS if tool.missing}
    if json_output:
        show.print_json(
            {
                "specimens": [
                    {"name": s.name, "about": s.about, "rule": s.rule, "seen": comparison.seen[s.name]}
                    for s in SPECIMENS
                ],
                "versions": comparison.versions,
                "not_installed": missing,
            }
        )
        return
    if markdown:
        show.print_line(comparison.markdown())
    else:
        _print_table(comparison)
    for name, package in missing.items():
        show.print_line(f"not installed: {name} (package {package})", to_stderr=markdown)


def _compare(*, quiet: bool) -> VersionComparison:
    tools = [tool for tool in TOOLS if not tool.missing]
    rows: dict[str, dict[str, bool]] = {}
    bar = Progress(
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), console=show.console(), transient=True,
        disable=quiet,
    )  # fmt: skip
    with TemporaryDirectory(prefix="hil-compare-") as folder, bar:
        task = bar.add_task("", total=len(SPECIMENS))
        for specimen in SPECIMENS:
            bar.update(task, description=specimen.name)
            rows[specimen.name] = {tool.name: tool.sees(specimen, Path(folder)) for tool in tools}
            rows[specimen.name][OURS] = seen(specimen)
            bar.advance(task)
    return VersionComparison([*(tool.name for tool in tools), OURS], rows, versions(tools))


def _print_table(comparison: VersionComparison) -> None:
    table = Table(
        title="Who points at the line of the defect", title_justify="left", caption=comparison.by(),
        caption_justify="left",
    )  # fmt: skip
    table.add_column("defect", no_wrap=True)
    table.add_column("rule", no_wrap=True)
    for name in comparison.tools:
        table.add_column(name, justify="center", overflow="fold")
    for row in comparison.rows():
        table.add_row(*row)
    table.add_section()
    table.add_row(*comparison.total())
    show.console().print(table)
