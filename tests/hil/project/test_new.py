"""`hil new`: what it writes passes at once, fails at the commented line, and editors read what its commands print."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

from hil.cli import invoke
from hil.project import LANGUAGES, make

#: The line that is a comment in the template, by the sign that makes it one.
COMMENTED = {"c": re.compile(r"// (?=sum)"), "python": re.compile(r"# (?=sum)")}
SUFFIX = {"c": ".c", "python": ".py"}


def run(folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", *command], cwd=folder, capture_output=True, text=True, check=False)


def with_the_mistake(folder: Path, language: str) -> int:
    """Make the comment a statement; returns its line."""
    driver = folder / f"{folder.name}{SUFFIX[language]}"
    text, count = COMMENTED[language].subn("", driver.read_text())
    assert count == 1
    driver.write_text(text)
    return next(n for n, line in enumerate(text.splitlines(), 1) if "pytest again" in line)


def problems(task: dict[str, Any], output: str) -> list[dict[str, str]]:
    """What the editor makes of a task's output: its patterns, one for each of as many lines."""
    matcher = task["problemMatcher"]["pattern"]
    patterns = matcher if isinstance(matcher, list) else [matcher]
    lines, found = output.splitlines(), []
    for first in range(len(lines) - len(patterns) + 1):
        parts: dict[str, str] = {}
        for pattern, line in zip(patterns, lines[first:], strict=False):
            match = re.search(pattern["regexp"], line)
            if match is None:
                break
            parts |= {key: match[group] for key, group in pattern.items() if key != "regexp"}
        else:
            found.append(parts)
    return found


@pytest.mark.parametrize("language", LANGUAGES)
def test_it_passes_and_then_fails_at_its_line(language: str, tmp_path: Path) -> None:
    folder = tmp_path / "lidar"
    make(folder, language)
    quiet = ("-q", "-p", "no:cacheprovider", "-p", "no:randomly")
    passed = run(folder, "pytest", *quiet)
    assert passed.returncode == 0, passed.stdout
    assert "4 passed" in passed.stdout
    checked = run(folder, "hil", "check", ".", "--board", "board.py", "--lines")
    assert checked.returncode == 0, checked.stdout + checked.stderr
    tasks = {task["label"]: task for task in json.loads((folder / ".vscode" / "tasks.json").read_text())["tasks"]}
    assert problems(tasks["hil check"], checked.stdout) == problems(tasks["pytest"], passed.stdout) == []

    line = with_the_mistake(folder, language)
    failed = run(folder, "pytest", *quiet)
    assert failed.returncode == 1, failed.stdout
    told = problems(tasks["pytest"], failed.stdout)
    where = {"severity": "error", "code": "index", "file": f"lidar{SUFFIX[language]}", "line": str(line)}
    assert told
    assert all(where.items() <= problem.items() for problem in told)
    assert tasks["hil check"]["command"] == "hil check . --board board.py --lines"
    checked = run(folder, "hil", "check", ".", "--board", "board.py", "--lines")
    assert checked.returncode == 1
    (problem,) = problems(tasks["hil check"], checked.stdout)
    assert where.items() <= problem.items()


@pytest.mark.parametrize("language", LANGUAGES)
def test_nothing_of_the_template_is_left(language: str, tmp_path: Path) -> None:
    files = make(tmp_path / "deep" / "pressure-sensor", language)
    text = "".join(f"{file}\n{file.read_text()}" for file in files)
    assert "ranger" not in text.lower()
    names = {file.name for file in files}
    drivers = {"c": {"pressure_sensor.c", "pressure_sensor.h"}, "python": {"pressure_sensor.py"}}
    assert names & (drivers["c"] | drivers["python"]) == drivers[language]
    project = tomllib.loads((tmp_path / "deep" / "pressure-sensor" / "pyproject.toml").read_text())
    assert project["project"]["name"] == "pressure_sensor"
    editor = {file.name: json.loads(file.read_text()) for file in files if file.suffix == ".json"}
    assert editor.keys() == {"tasks.json", "launch.json", "settings.json", "extensions.json"}
    assert editor["launch.json"]["configurations"]


@pytest.mark.parametrize(
    "name", ["if", "lambda", "math", "board", "main", "test_it", "Über", "a b", "2nd", "x" * 32, "sonar.c", "_a"]
)
def test_a_name_that_a_driver_cannot_have(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["new", str(tmp_path / name)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert repr(name) in error
    assert not list(tmp_path.iterdir())


def test_a_python_driver_hides_no_module_that_python_or_pytest_imports(tmp_path: Path) -> None:
    for name in ("json", "py"):
        with pytest.raises(ValueError, match=f"'{name}' is a module of Python or of an installed package"):
            make(tmp_path / name, "python")
        make(tmp_path / name, "c")


def test_what_is_there_is_left_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "sonar").mkdir()
    (tmp_path / "sonar" / "mine.txt").write_text("mine")
    (tmp_path / "file").write_text("mine")
    for name in ("sonar", "file", "file/below"):
        assert invoke(["new", str(tmp_path / name)]) == 2
        assert name in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["file", "mine.txt", "sonar"]
    (tmp_path / "sonar" / "mine.txt").unlink()
    assert invoke(["new", str(tmp_path / "sonar"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["driver"] == "sonar.c"
    written = {path.relative_to(tmp_path / "sonar").as_posix() for path in (tmp_path / "sonar").rglob("*.*")}
    assert written >= set(told["files"]) >= {"sonar.c", "sonar.h", ".vscode/tasks.json"}


def test_it_says_what_to_do_next(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["new", str(tmp_path / "sonar")]) == 0
    said = capsys.readouterr().out
    for word in ("sonar.c", "test_sonar.py", "pytest", "hil check"):
        assert word in said


@pytest.mark.parametrize(("language", "wanted"), [("c", "pycparser pytest"), ("python", "pytest")])
def test_it_says_what_the_environment_lacks(
    language: str, wanted: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    for lacking in (True, False):
        monkeypatch.setattr("hil.cli.new.has", lambda _package, lacking=lacking: not lacking)
        assert invoke(["new", str(tmp_path / f"sonar{lacking:d}"), "--language", language]) == 0
        said = capsys.readouterr().out
        assert (re.search(rf"^  pip install {wanted} ", said, re.MULTILINE) is not None) is lacking
        assert ("pip install" in said) is lacking
