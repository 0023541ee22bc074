"""What takes longer than a second shows how far it is, in a terminal; a pipe gets nothing of it."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from rich.console import Console

from hil.cli import invoke, show

GOLDEN = sorted((Path(__file__).parents[2] / "golden").glob("*.json"))[0]


def log(folder: Path) -> str:
    path = str(folder / "run.wire")
    assert invoke(["run", "--no-port", "--pace", "max", "--for", "0.3", "--wire", path]) == 0
    return path


@pytest.mark.parametrize(
    ("command", "told"),
    [
        (["tasks", "--for", "0.3"], ("start-up", "run")), (["conformance", str(GOLDEN)], ("vectors",)),
        (["replay", "LOG"], ("start-up", "replay")), (["check", "--for", "0.1", "--fail-on", "never"], ("run",)),
    ],
)  # fmt: skip
def test_progress_is_shown_in_a_terminal_and_not_in_a_pipe(
    command: list[str], told: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    command = [log(tmp_path) if word == "LOG" else word for word in command]
    capsys.readouterr()
    assert invoke(command) == 0
    piped = capsys.readouterr()
    assert "\x1b" not in piped.out + piped.err
    screen = io.StringIO()
    monkeypatch.setattr(
        show, "console", lambda: Console(file=screen, force_terminal=True, width=100, highlight=False, emoji=False)
    )
    assert invoke(command) == 0
    shown = screen.getvalue()
    assert all(f"{what} " in shown and "━" in shown for what in told)


def test_work_of_unknown_length_shows_in_a_terminal_what_it_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    trace = tmp_path / "[red]run.trace"
    drive = ["run", "--no-port", "--pace", "max", "--for", "0.3", "--json", "--trace"]
    assert invoke([*drive, str(trace)]) == 0
    capsys.readouterr()
    command = ["export", str(trace), str(tmp_path / "run.csv")]
    assert invoke(command) == 0
    piped = capsys.readouterr()
    assert "reading" not in piped.out + piped.err
    screen = io.StringIO()
    monkeypatch.setattr(show, "console", lambda: Console(file=screen, force_terminal=True, width=1000))
    assert invoke(command) == 0
    assert f"reading {trace}" in screen.getvalue()
