"""Recipes for who changes this project are followed to the letter, each in a copy of the tree."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests import pages

REPOSITORY = Path(__file__).parents[1]
PART = (REPOSITORY / "emulator" / "devices" / "README.md", "A new part: two files")
DETECTOR = (REPOSITORY / "emulator" / "rules" / "README.md", "A new detector: three files")


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A copy of what the recipes may touch."""
    for name in ("emulator", "firmware_model", "hil", "tests"):
        shutil.copytree(REPOSITORY / name, tmp_path / name, ignore=shutil.ignore_patterns("_compiled"))
    shutil.copy(REPOSITORY / "pyproject.toml", tmp_path)
    return tmp_path


def in_the(tree: Path, command: str) -> list[str]:
    """What a command prints that imports everything from the copy."""
    program, *arguments = command.split()
    done = subprocess.run(
        [sys.executable, "-m", program, *arguments, *(("-p", "c2000_hil", "-n0") if program == "pytest" else ())],
        cwd=tree, env={**os.environ, "PYTHONPATH": str(tree), "COLUMNS": "300"}, capture_output=True, text=True,
        timeout=300, check=False,
    )  # fmt: skip
    return [*done.stdout.splitlines(), *done.stderr.splitlines()]


def follow(tree: Path, *recipes: tuple[Path, str]) -> None:
    for page, title in recipes:
        pages.do(pages.sections(page)[title], tree, lambda command: in_the(tree, command))


def changed(page: Path, title: str) -> set[str]:
    """The files of the project that a recipe makes or changes; what tests of a user's are is none."""
    blocks = pages.sections(page)[title]
    named = {*pages.files(blocks), *(b.text.split()[1].removeprefix("a/") for b in blocks if b.kind == "diff")}
    return {name for name in named if not name.startswith("test_") and not name.endswith(".c")}


@pytest.mark.slow
def test_a_new_part_and_a_new_detector(tree: Path) -> None:
    follow(tree, PART, DETECTOR)
    if find_spec("importlinter"):
        code = "from importlinter.cli import lint_imports_command as c; c()"
        done = subprocess.run(
            [sys.executable, "-c", code, "--no-cache"], cwd=tree, env={**os.environ, "PYTHONPATH": str(tree)},
            capture_output=True, text=True, timeout=300, check=False,
        )  # fmt: skip
        assert "0 broken" in done.stdout, done.stdout + done.stderr


def test_the_recipes_take_as_many_files_as_they_say() -> None:
    assert changed(*PART) == {"emulator/devices/max6675.py", "kiln.py"}
    # The board of the other recipe says who hears the part, and is nobody's detector.
    assert changed(*DETECTOR) - {"kiln.py"} == {
        "emulator/rules/device_time.py", "emulator/devices/max6675.py", "tests/emulator/devices/test_max6675.py",
    }  # fmt: skip
