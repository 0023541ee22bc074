"""The recipe for a new block (`emulator/peripherals/README.md`) is followed to the letter, in a copy of the tree."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from fnmatch import fnmatchcase
from importlib.util import find_spec
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[1]
PAGE = REPOSITORY / "emulator" / "peripherals" / "README.md"
TITLE = "A new block: four files"
_BLOCK = re.compile(r"^```(\w+)\n(.*?)^```\n", re.MULTILINE | re.DOTALL)
_FILE = re.compile(r"(?:# |/\* )([\w./]+)(?: \*/)?\n")
_CHANGED = re.compile(r"--- a/[\w./]+\n\+\+\+ b/([\w./]+)\n@@\n(.*)", re.DOTALL)


def blocks() -> list[tuple[str, str]]:
    """Kind and text of each fenced block of the section."""
    [section] = [s for s in PAGE.read_text(encoding="utf-8").split("\n## ") if s.startswith(TITLE)]
    return [(kind, text) for kind, text in _BLOCK.findall(section)]


def named(kind: str, text: str) -> str:
    """The file that a block makes or changes; a command has none."""
    found = (_CHANGED.fullmatch if kind == "diff" else _FILE.match)(text)
    return found[1] if found is not None else ""


def change(tree: Path, diff: str) -> None:
    """Change a file as a block says: what stays and what goes must stand there once."""
    match = _CHANGED.fullmatch(diff)
    assert match is not None
    path = tree / match[1]
    text = path.read_text(encoding="utf-8")
    for part in match[2].split("@@\n"):
        lines = [(line[:1], line[1:]) for line in part.splitlines(keepends=True)]
        old, new = ("".join(line or "\n" for sign, line in lines if sign != without) for without in "+-")
        assert text.count(old) == 1, f"{match[1]} has not, or not once:\n{old}"
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")


def printed(tree: Path, *arguments: str) -> list[str]:
    """What Python prints that imports everything from the copy."""
    done = subprocess.run(
        [sys.executable, *arguments], cwd=tree, env={**os.environ, "PYTHONPATH": str(tree), "COLUMNS": "300"},
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    return [*done.stdout.splitlines(), *done.stderr.splitlines()]


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A copy of the sources and tests."""
    for name in ("emulator", "firmware_model", "hil", "tests"):
        shutil.copytree(REPOSITORY / name, tmp_path / name, ignore=shutil.ignore_patterns("_compiled"))
    shutil.copy(REPOSITORY / "pyproject.toml", tmp_path)
    return tmp_path


def test_a_new_block_takes_four_files() -> None:
    files = {named(kind, text) for kind, text in blocks() if kind != "console"}
    assert files - {"beat.c", "test_beat.py"} == {
        "emulator/registers/beat.py", "emulator/peripherals/beat.py", "emulator/blocks.py", "tests/facts/registers.csv",
    }  # fmt: skip


@pytest.mark.slow
def test_a_new_block(tree: Path) -> None:
    pytest.importorskip("pycparser")
    for kind, text in blocks():
        if kind == "diff":
            change(tree, text)
        elif kind == "console":
            command, wanted = text.splitlines()
            program = command.removeprefix("$ ").split()
            output = printed(tree, "-m", *program, "-p", "c2000_hil", "-p", "no:cacheprovider", "-n0")
            assert any(fnmatchcase(line, f"*{wanted}*") for line in output), "\n".join(output)
        else:
            (tree / named(kind, text)).write_text(text, encoding="utf-8")
    # Whoever reads the table holds for this line too: headers in C, addresses, contracts of imports.
    lists = ("tests/emulator/c28x/readers/c/test_headers.py", "tests/emulator/test_chip.py")
    output = printed(tree, "-m", "pytest", "-p", "no:cacheprovider", "-n0", *lists)
    assert any(fnmatchcase(line, "*[0-9] passed*") for line in output), "\n".join(output)
    assert not any("failed" in line for line in output), "\n".join(output)
    if find_spec("importlinter"):
        code = "from importlinter.cli import lint_imports_command as check; check()"
        output = printed(tree, "-c", code, "--no-cache")
        assert any("0 broken" in line for line in output), "\n".join(output)
