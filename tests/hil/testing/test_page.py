"""The plugin's page tells the truth: its files are written as they stand, its commands run, its output comes."""

from __future__ import annotations

import re
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

import matplotlib.backends.backend_svg
import matplotlib.figure  # noqa: F401
import pytest

# Imported here, so that a run within a test finds everything in memory.
import hil.bench
import hil.testing.machines.gates
import hil.testing.outside
import hil.testing.session
import hil.testing.tasks
import hil.testing.timeline
import hil.testing.uart

PAGE = Path(hil.testing.__file__).with_name("README.md")
_BLOCK = re.compile(r"^```(\w+)\n(.*?)^```\n", re.MULTILINE | re.DOTALL)
_FILE = re.compile(r"(?:# |/\* )([\w./]+)(?: \*/)?\n")


class Block(NamedTuple):
    kind: str
    text: str


def sections() -> dict[str, list[Block]]:
    """The blocks of each section with commands, by its title."""
    parts = PAGE.read_text(encoding="utf-8").split("\n## ")[1:]
    found = {part.partition("\n")[0]: [Block(*b) for b in _BLOCK.findall(part)] for part in parts}
    return {title: blocks for title, blocks in found.items() if any(b.kind == "console" for b in blocks)}


SECTIONS = sections()
#: No plugin but ours, by its entry point, and those that the page speaks of; a warning is an error.
ALONE = ("-p", "c2000_hil", "-p", "xdist", "-p", "hypothesispytest", "-p", "no:cacheprovider", "-W", "error")
#: Files that later sections use.
EARLIER = ("blink.py", "test_blink.py", "test_division.py")


def files(blocks: list[Block]) -> dict[str, str]:
    named = {_FILE.match(block.text): block.text for block in blocks if block.kind in ("python", "toml", "c")}
    assert None not in named, "every file begins with its name"
    return {match[1]: text for match, text in named.items() if match}


def lines_in_order(output: list[str], wanted: list[str]) -> None:
    """Each wanted line (a pattern) is the beginning of, or stands alone in, a later line than the one before."""
    rest = iter(output)
    for pattern in wanted:
        hard = re.sub(r"([\[\]])", r"[\1]", pattern)
        assert any(fnmatchcase(line, f"*{hard}*") for line in rest), f"{pattern!r} is not in\n" + "\n".join(output)


def test_every_section_has_commands() -> None:
    parts = PAGE.read_text(encoding="utf-8").split("\n## ")[1:]
    assert len(parts) == len(SECTIONS)


@pytest.mark.parametrize("title", SECTIONS)
def test_section(title: str, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "300")
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    everything = {name: text for blocks in SECTIONS.values() for name, text in files(blocks).items()}
    for name in EARLIER:
        (pytester.path / name).write_text(everything[name], encoding="utf-8")
    for block in SECTIONS[title]:
        if block.kind != "console":
            match = _FILE.match(block.text)
            assert match is not None
            if block.kind == "c":
                pytest.importorskip("pycparser")
            (pytester.path / match[1]).parent.mkdir(exist_ok=True)
            (pytester.path / match[1]).write_text(block.text, encoding="utf-8")
            continue
        for run in block.text.split("$ pytest ")[1:]:
            command, *wanted = run.splitlines()
            result = pytester.runpytest(*command.split(), *ALONE)
            lines_in_order(result.outlines + result.errlines, wanted)
