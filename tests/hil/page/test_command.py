"""`hil run --page`: what cannot be is told in one line, and the file is whole or as it was."""

from __future__ import annotations

import errno
import re
import shlex
import signal
from pathlib import Path
from typing import Any

import pytest

from hil.cli import invoke
from hil.cli.run import _Display
from hil.extras import EXTRAS
from hil.page import page as module
from tests.hil.page.test_replay import data_of
from tests.hil.test_extras import without

RUN = ("run", "--no-port", "--pace", "max", "--for", "0.1", "--order", "mission")


def told(capsys: pytest.CaptureFixture[str]) -> str:
    """The one line on stderr."""
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("hil: error: ")
    return line


def test_it_says_what_ran(tmp_path: Path) -> None:
    page = tmp_path / "run.html"
    assert invoke([*RUN, "--seed", "5", "--world", "room", "--fault", "gyro-reset:at=0.05", "--page", str(page)]) == 0
    found = data_of(page.read_text(encoding="utf-8"))
    assert found["about"] == {
        "title": "mission in room, seed 5", "orders": "mission", "world": "room", "seed": "5",
        "faults": "gyro-reset:at=0.05",
    }  # fmt: skip
    assert page.read_text(encoding="utf-8").count("<h1>mission in room, seed 5</h1>") == 1


def test_the_core_makes_pages(tmp_path: Path) -> None:
    done = without(tuple(EXTRAS), tmp_path, *RUN, "--page", "run.html")
    assert (done.returncode, done.stderr) == (0, "")
    assert data_of((tmp_path / "run.html").read_text(encoding="utf-8"))["findings"]


def test_the_commands_of_the_documentation_make_what_they_say(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = Path(module.__file__).with_name("README.md").read_text(encoding="utf-8").partition("## Pages for the doc")[2]
    mission, speed = re.findall(r"^hil (.*)$", text, re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    assert invoke([*shlex.split(mission), "--for", "0.5"]) == 0
    assert invoke(shlex.split(speed)) == 0
    found = data_of(Path("speed.html").read_text(encoding="utf-8"))
    real, believed = (sum(found["scene"][name]["x"]) / found["units"] for name in ("robot", "believed"))
    assert believed > 20 > 4 > real  # in a room of 5 m
    assert "float-to-int" in {each["rule"] for each in found["findings"]}
    assert data_of(Path("mission.html").read_text(encoding="utf-8"))["lines"]["text"]


def test_the_same_seed_gives_the_same_bytes(tmp_path: Path) -> None:
    pages = [tmp_path / "a.html", tmp_path / "b.html"]
    for page in pages:
        assert invoke([*RUN, "--page", str(page)]) == 0
    assert pages[0].read_bytes() == pages[1].read_bytes()


def test_its_trace_makes_the_same_page(tmp_path: Path) -> None:
    page, again, trace = (tmp_path / name for name in ("run.html", "again.html", "run.trace"))
    assert invoke([*RUN, "--page", str(page), "--trace", str(trace)]) == 0
    assert invoke(["export", str(trace), str(again)]) == 0
    assert again.read_bytes() == page.read_bytes()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--page", "."], "it is a folder; expected the name of a file"),
        (["--page", "missing/run.html"], "missing/run.html: there is no folder"),
        (["--page", "run.html", "--view"], "--view runs until Ctrl-C: leave out"),
        (["--channel", "pins"], "--channel is for --trace FILE and --page FILE"),
        (["--page", "run.html", "--channel", "nothing"], "no channel 'nothing'"),
    ],
)
def test_what_cannot_be_is_told_before_anything_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], options: list[str], said: str
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    arguments = [*RUN[:4], *options] if "--view" in options else [*RUN, *options]
    assert invoke(arguments) == 2
    assert said in told(capsys)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("target", "said"), [("/dev/full", "No space left"), ("/proc/run.html", "No such file")])
def test_a_place_that_takes_nothing_is_told_after_the_summary(
    capsys: pytest.CaptureFixture[str], target: str, said: str
) -> None:  # fmt: skip
    assert invoke([*RUN, "--page", target]) == 2
    captured = capsys.readouterr()
    assert "virtual time 0.100 s" in captured.out
    (line,) = captured.err.splitlines()
    assert line.startswith(f"hil: error: {target}: {said}")


def test_a_full_disk_leaves_the_page_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    page = tmp_path / "run.html"
    page.write_text("an older one")

    def half(path: Path, content: str) -> None:
        path.write_text(content[:1000])
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr(module, "_write", half)
    assert invoke([*RUN, "--page", str(page)]) == 2
    assert told(capsys) == f"hil: error: {page}: No space left on device"
    assert page.read_text() == "an older one"
    assert list(tmp_path.iterdir()) == [page]


def test_a_run_that_is_ended_has_its_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "run.html"

    def tick(_self: Any, _session: Any) -> None:
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(_Display, "tick", tick)
    assert invoke([*RUN[:4], "--for", "60", "--page", str(page)]) == 130
    assert 440_000_000 <= data_of(page.read_text(encoding="utf-8"))["end"] < 500_000_000  # start-up, and little more
