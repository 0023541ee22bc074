"""``hil audit --compare``: specimens of the defect classes through the usual host tools, and through this one."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
from rich.table import Table

from hil.audit.compare.ours import seen
from hil.audit.compare.specimen import SPECIMENS
from hil.audit.compare.tools import TOOLS
from hil.cli import show


def compare_tools(*, json_output: bool) -> None:
    """Print which tool points at the marked line of which specimen.  Tools that are not installed are named."""
    tools = [tool for tool in TOOLS if not tool.missing]
    columns = [tool.name for tool in tools] + ["hil"]
    rows: dict[str, dict[str, bool]] = {}
    bar = Progress(
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), console=show.console(), transient=True,
        disable=json_output,
    )  # fmt: skip
    with TemporaryDirectory(prefix="hil-compare-") as folder, bar:
        task = bar.add_task("", total=len(SPECIMENS))
        for specimen in SPECIMENS:
            bar.update(task, description=specimen.name)
            rows[specimen.name] = {tool.name: tool.sees(specimen, Path(folder)) for tool in tools}
            rows[specimen.name]["hil"] = seen(specimen)
            bar.advance(task)
    missing = {tool.name: tool.package for tool in TOOLS if tool.missing}
    if json_output:
        show.print_json(
            {
                "specimens": [
                    {"name": s.name, "about": s.about, "rule": s.rule, "seen": rows[s.name]} for s in SPECIMENS
                ],
                "not_installed": missing,
            }
        )
        return
    table = Table(title="Who points at the line of the defect", title_justify="left")
    table.add_column("defect", no_wrap=True)
    table.add_column("rule", no_wrap=True)
    for name in columns:
        table.add_column(name, justify="center", overflow="fold")
    for s in SPECIMENS:
        table.add_row(s.about, s.rule, *("●" if rows[s.name][name] else "" for name in columns))
    table.add_section()
    table.add_row(f"of {len(SPECIMENS)}", "", *(str(sum(row[name] for row in rows.values())) for name in columns))
    show.console().print(table)
    for name, package in missing.items():
        show.say(f"not installed: {name} (package {package})")
