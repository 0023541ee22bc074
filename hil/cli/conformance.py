"""``hil conformance``: golden vectors of the C text against the model."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from rich.table import Table

from hil.cli import own_c, show

if TYPE_CHECKING:
    from hil.conformance import FileResult

#: How many differences are shown unless told otherwise.
FIRST_DIFFERENCES: Final = 10


def conformance(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...", help="Golden-vector files (JSON).")],
    differences: Annotated[
        int, typer.Option(min=0, max=1_000_000, help="Show this many differences.")
    ] = FIRST_DIFFERENCES,
    firmware: own_c.Firmware = None,
    project: own_c.Project = None,
    include: own_c.Include = None,
    define: own_c.Define = None,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Run golden-vector files against the model, or against C files (--firmware); exit 1 if a vector fails.

    [bold]Examples[/bold]
      hil conformance tests/golden/*.json
      hil conformance --json average.json
      hil conformance --firmware my_robot tests/golden/*.json
    """
    with show.user_errors():
        from hil.conformance import run_file
        from hil.golden.bench import VectorBench

        own = own_c.own_c(firmware, project, include, define)
        bench = VectorBench(firmware=own.firmware, include=own.include, defines=own.defines)
        results = []
        with show.progress("vectors", quiet=json_output) as told:
            for path in files:
                results.append((path, run_file(path, bench)))
                told(len(results) / len(files))
    passed = sum(result.passed for _, result in results)
    failed = sum(result.failed for _, result in results)
    if json_output:
        show.print_json({"passed": passed, "failed": failed, "files": [_as_dict(*pair) for pair in results]})
    else:
        _print(results, passed, failed, differences)
    if failed:
        raise typer.Exit(show.EXIT_FAILED)


def _as_dict(path: Path, result: FileResult) -> dict[str, Any]:
    return {
        "file": str(path),
        "function": result.function,
        "passed": result.passed,
        "failed": result.failed,
        "failures": [
            {"id": miss.id, "field": miss.field, "expected": miss.expected, "actual": miss.actual}
            for miss in result.failures
        ],
    }


def _print(results: list[tuple[Path, FileResult]], passed: int, failed: int, differences: int) -> None:
    by_function: dict[str, tuple[int, int]] = {}
    for _, result in results:
        good, bad = by_function.get(result.function, (0, 0))
        by_function[result.function] = (good + result.passed, bad + result.failed)
    table = Table()
    table.add_column("function")
    table.add_column("passed", justify="right")
    table.add_column("failed", justify="right")
    for function, (good, bad) in by_function.items():
        table.add_row(function, str(good), str(bad), style="red" if bad else None)
    terminal = show.console()
    terminal.print(table)
    if failed and differences:
        misses = [(path, miss) for path, result in results for miss in result.failures]
        shown = Table(title=f"First differences (of {len(misses)})", title_justify="left")
        for heading in ("file", "vector", "field", "expected", "actual"):
            shown.add_column(heading, overflow="fold")
        for path, miss in misses[:differences]:
            shown.add_row(path.name, str(miss.id), miss.field, str(miss.expected), str(miss.actual))
        terminal.print(shown)
    show.print_line(f"{passed} passed, {failed} failed")
