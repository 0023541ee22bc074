"""What ``hil console`` refuses before anything is opened."""

from __future__ import annotations

import pytest

from hil.cli import invoke


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--wire", "log"], "--wire, --dir and --python belong to --app: hil console --app main.py"),
        (["--view"], "--view here is for a robot at --port; for an emulated one: hil run --view"),
        (["--view", "--port", "x", "--json"], "--view runs until Ctrl-C: leave out --json"),
        (["--view", "--app", "main.py"], "--app and --view are two consoles: choose one"),
    ],
)
def test_wishes_that_contradict_each_other_are_one_line(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert invoke(["console", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err == f"hil: error: {message}\n"
