"""``hil new``: a project for a driver of one's own."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from shlex import quote
from typing import Annotated, Final

import typer
from rich.table import Table
from rich.text import Text

from hil.cli import show
from hil.extras import has

#: What a file of a project is for, by the end of its path.
_WHAT: Final = {
    "board.py": "what is soldered to the chip",
    "pyproject.toml": "what is installed, the board of all tests",
    "README.md": "these lines again",
    "tasks.json": "tasks of VS Code: findings become problems in the editor",
    "launch.json": "tests in the debugger of VS Code",
    "settings.json": "tests in its panel of tests",
    "extensions.json": "what of its extensions it offers to install",
    "check.yml": "the same tests at each push; findings appear in the pull request",
    ".gitignore": "what a repository does not keep",
    ".h": "its header",
}


class Language(StrEnum):
    """What the driver is written in."""

    C = "c"
    PYTHON = "python"


def new(
    folder: Annotated[
        Path, typer.Argument(metavar="NAME", help="The name of the driver, or a path that ends with it.")
    ],
    language: Annotated[
        Language, typer.Option(help="The language: c, or python (C-shaped Python, hil docs language).")
    ] = Language.C,
    json_output: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")] = False,
) -> None:
    """Create a project for your own driver: driver, board, tests, editor, CI.  Its tests pass.

    [bold]Examples[/bold]
      hil new ranger
      hil new ~/work/pressure-sensor --language python
    """
    with show.user_errors():
        from hil.project import make

        made = [path.relative_to(folder) for path in make(folder, language.value)]
    name = folder.name.replace("-", "_")
    driver = f"{name}.{'c' if language is Language.C else 'py'}"
    if json_output:
        show.print_json({"folder": str(folder), "driver": driver, "files": [path.as_posix() for path in made]})
        return
    table = Table(title=f"{folder}", title_justify="left", show_header=False, box=None)
    table.add_column(no_wrap=True, style="bold")
    table.add_column(overflow="fold")
    for path in made:
        table.add_row(Text(path.as_posix()), _what(path.as_posix(), driver))
    show.console().print(table)
    wanted = ("pycparser", "pytest") if language is Language.C else ("pytest",)
    missing = [package for package in wanted if not has(package)]
    for line in (
        "", "Next:",
        *([f"  {'pip install ' + ' '.join(missing):30} what it needs and this environment lacks"] if missing else []),
        f"  cd {quote(str(folder))}",
        "  pytest                         passes; what the emulator finds would fail the test that caused it",
        "  hil check . --board board.py   the same without a test",
        f"Then make the commented line of {driver} a statement, and run pytest again.",
    ):  # fmt: skip
        show.print_line(line)


def _what(path: str, driver: str) -> str:
    if path == driver:
        return "the driver"
    if path == f"test_{driver.partition('.')[0]}.py":
        return "its tests"
    return next(what for end, what in _WHAT.items() if path.endswith(end))
