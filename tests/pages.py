"""A page of Markdown that tells the truth: its files are written as they stand, its commands run, its output comes.

A block of C, Python, TOML or CSV is a file, and begins with its name in a comment.  A block `diff` changes one: the
lines that stay and that go must stand there, together and once.  A block `console` has commands (`$ pytest`, `$ hil`,
`$ cd`) and below each the lines that must come, in this order; `...` in a line stands for anything, and a line may
stand within a longer one.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import matplotlib.backends.backend_svg
import matplotlib.figure  # noqa: F401
import pytest

# Imported here, so that a run within a test finds everything in memory: what it imports itself it takes along.
import emulator.c28x.compile
import emulator.c28x.readers.python.source  # noqa: F401
import hil.audit.run
import hil.bench
import hil.testing.machines.gates
import hil.testing.outside
import hil.testing.session
import hil.testing.tasks
import hil.testing.timeline
import hil.testing.uart  # noqa: F401
from hil.cli import invoke

if find_spec("pycparser"):
    import_module("emulator.c28x.readers.c.source")

_BLOCK = re.compile(r"^```(\w+)\n(.*?)^```\n", re.MULTILINE | re.DOTALL)
_FILE = re.compile(r"(?:# |/\* )([\w./]+)(?: \*/)?\n")
#: The kinds of blocks that are files.
_FILES = ("python", "toml", "c", "csv")
#: A file that a page changes, and the changes.
_CHANGED = re.compile(r"--- a/[\w./]+\n\+\+\+ b/([\w./]+)\n@@\n(.*)", re.DOTALL)
#: No plugin but ours, by its entry point, and those that pages speak of; a warning is an error.
ALONE = ("-p", "c2000_hil", "-p", "xdist", "-p", "hypothesispytest", "-p", "no:cacheprovider", "-W", "error")


class Block(NamedTuple):
    """A fenced block: what kind it says it is, and its lines."""

    kind: str
    text: str


def all_sections(page: Path) -> dict[str, list[Block]]:
    """The blocks of each section of a page, by its title."""
    parts = page.read_text(encoding="utf-8").split("\n## ")[1:]
    return {part.partition("\n")[0]: [Block(*block) for block in _BLOCK.findall(part)] for part in parts}


def sections(page: Path) -> dict[str, list[Block]]:
    """Those sections that have commands."""
    return {t: blocks for t, blocks in all_sections(page).items() if any(b.kind == "console" for b in blocks)}


def files(blocks: list[Block]) -> dict[str, str]:
    """The files of some blocks, by name."""
    named = {_FILE.match(block.text): block.text for block in blocks if block.kind in _FILES}
    assert None not in named, "every file begins with its name"
    return {match[1]: text for match, text in named.items() if match}


def lines_in_order(output: list[str], wanted: list[str]) -> None:
    """Each wanted line, in which `...` stands for anything, stands in a later line than the one before."""
    rest = iter(output)
    for pattern in wanted:
        like = re.compile(".*".join(map(re.escape, pattern.split("..."))))
        assert any(map(like.search, rest)), f"{pattern!r} is not in\n" + "\n".join(output)


def _change(folder: Path, diff: str) -> None:
    """Change a file as a block says."""
    match = _CHANGED.fullmatch(diff)
    assert match is not None, f"no diff of one file:\n{diff}"
    path = folder / match[1]
    text = path.read_text(encoding="utf-8")
    for part in match[2].split("@@\n"):
        lines = [(line[:1], line[1:]) for line in part.splitlines(keepends=True)]
        assert {sign for sign, _ in lines} <= {"+", "-", " ", "\n"}, f"no diff:\n{part}"
        old, new = ("".join(line or "\n" for sign, line in lines if sign != without) for without in "+-")
        assert text.count(old) == 1, f"{match[1]} has not, or not once:\n{old}"
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")


def _output(command: str, pytester: pytest.Pytester, capsys: pytest.CaptureFixture[str]) -> list[str]:
    """The lines that a command prints."""
    program, *arguments = command.split()
    if program == "pytest":
        result = pytester.runpytest(*arguments, *ALONE)
        return [*result.outlines, *result.errlines]
    assert program == "hil", f"{command}: a page has commands of pytest and hil"
    capsys.readouterr()
    invoke(arguments)
    printed = capsys.readouterr()
    return [*printed.out.splitlines(), *printed.err.splitlines()]


def run(
    blocks: list[Block], pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    """Do what a section says, in the folder of `pytester`."""
    monkeypatch.setenv("COLUMNS", "300")
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    do(blocks, pytester.path, lambda command: _output(command, pytester, capsys))


def do(blocks: list[Block], folder: Path, output: Callable[[str], list[str]]) -> None:
    """Do what blocks say, in a folder; `output` gives the lines that a command prints."""
    if any(block.kind == "c" for block in blocks):
        pytest.importorskip("pycparser")
    for block in blocks:
        if block.kind == "console":
            for told in re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]:
                command, *wanted = told.splitlines()
                if command.startswith("cd "):
                    folder /= command.removeprefix("cd ")
                    os.chdir(folder)  # the test's own fixture goes back
                    continue
                lines_in_order(output(command), wanted)
        elif block.kind == "diff":
            _change(folder, block.text)
        for name, text in files([block]).items():
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_text(text, encoding="utf-8")
